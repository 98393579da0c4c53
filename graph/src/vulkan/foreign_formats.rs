//! Texel formats by the names that GLSL and other interfaces give them.

use super::Format;

/// Names of Vulkan's formats elsewhere (GLSL, OpenGL, Direct3D, Metal, WebGPU), in capitals, without `_` and `-`.
const NAMES: &[(Format, &[&str])] = &[
    (Format::R8_UNORM, &["R8"]),
    (Format::R8_UINT, &["R8UI"]),
    (Format::R8G8_UNORM, &["RG8", "RG8UNORM"]),
    (Format::R8G8B8A8_UNORM, &["RGBA8", "RGBA8UNORM"]),
    (Format::R8G8B8A8_UINT, &["RGBA8UI", "RGBA8UINT"]),
    (Format::R8G8B8A8_SRGB, &["SRGB8ALPHA8", "SRGB8A8", "RGBA8SRGB", "RGBA8UNORMSRGB", "R8G8B8A8UNORMSRGB"]),
    (Format::B8G8R8A8_UNORM, &["BGRA8", "BGRA8UNORM"]),
    (Format::B8G8R8A8_SRGB, &["BGRA8SRGB", "BGRA8UNORMSRGB", "B8G8R8A8UNORMSRGB"]),
    (
        Format::A2B10G10R10_UNORM_PACK32,
        &["RGB10A2", "RGB10A2UNORM", "R10G10B10A2", "R10G10B10A2UNORM", "A2B10G10R10UNORM"],
    ),
    (Format::R16_SFLOAT, &["R16F", "R16FLOAT"]),
    (Format::R16G16_SFLOAT, &["RG16F", "RG16FLOAT", "R16G16FLOAT"]),
    (Format::R16G16B16A16_UNORM, &["RGBA16", "RGBA16UNORM"]),
    (Format::R16G16B16A16_SFLOAT, &["RGBA16F", "RGBA16FLOAT", "R16G16B16A16FLOAT"]),
    (Format::R32_UINT, &["R32UI"]),
    (Format::R32_SFLOAT, &["R32F", "R32FLOAT"]),
    (Format::R32G32_SFLOAT, &["RG32F", "RG32FLOAT", "R32G32FLOAT"]),
    (Format::R32G32B32A32_UINT, &["RGBA32UI", "RGBA32UINT"]),
    (Format::R32G32B32A32_SFLOAT, &["RGBA32F", "RGBA32FLOAT", "R32G32B32A32FLOAT"]),
    (
        Format::B10G11R11_UFLOAT_PACK32,
        &["R11FG11FB10F", "R11G11B10F", "R11G11B10FLOAT", "RG11B10FLOAT", "RG11B10UFLOAT", "B10G11R11UFLOAT"],
    ),
    (Format::R8_SNORM, &[]),
    (Format::R8_SINT, &["R8I"]),
    (Format::R8G8_SNORM, &["RG8SNORM"]),
    (Format::R8G8_UINT, &["RG8UI", "RG8UINT"]),
    (Format::R8G8_SINT, &["RG8I", "RG8SINT"]),
    (Format::R8G8B8A8_SNORM, &["RGBA8SNORM"]),
    (Format::R8G8B8A8_SINT, &["RGBA8I", "RGBA8SINT"]),
    (Format::R16_UNORM, &["R16"]),
    (Format::R16_SNORM, &[]),
    (Format::R16_UINT, &["R16UI"]),
    (Format::R16_SINT, &["R16I"]),
    (Format::R16G16_UNORM, &["RG16", "RG16UNORM"]),
    (Format::R16G16_SNORM, &["RG16SNORM"]),
    (Format::R16G16_UINT, &["RG16UI", "RG16UINT"]),
    (Format::R16G16_SINT, &["RG16I", "RG16SINT"]),
    (Format::R16G16B16A16_SNORM, &["RGBA16SNORM"]),
    (Format::R16G16B16A16_UINT, &["RGBA16UI", "RGBA16UINT"]),
    (Format::R16G16B16A16_SINT, &["RGBA16I", "RGBA16SINT"]),
    (Format::R32_SINT, &["R32I"]),
    (Format::R32G32_UINT, &["RG32UI", "RG32UINT"]),
    (Format::R32G32_SINT, &["RG32I", "RG32SINT"]),
    (Format::R32G32B32A32_SINT, &["RGBA32I", "RGBA32SINT"]),
    (Format::D16_UNORM, &["D16", "DEPTH16UNORM", "DEPTHCOMPONENT16"]),
    (Format::X8_D24_UNORM_PACK32, &["D24", "X8D24UNORM", "DEPTH24PLUS", "DEPTHCOMPONENT24"]),
    (Format::D32_SFLOAT, &["D32", "D32F", "D32FLOAT", "DEPTH32FLOAT", "DEPTHCOMPONENT32F"]),
    (Format::D24_UNORM_S8_UINT, &["D24S8", "DEPTH24STENCIL8", "DEPTH24PLUSSTENCIL8", "DEPTH24UNORMSTENCIL8"]),
    (Format::D32_SFLOAT_S8_UINT, &["D32S8", "D32FS8", "DEPTH32FSTENCIL8", "DEPTH32FLOATSTENCIL8", "D32FLOATS8X24UINT"]),
];

/// Beginnings of the names of whole lists of formats, in the same writing.
const BEGINNINGS: [&str; 4] = ["VKFORMAT", "DXGIFORMAT", "MTLPIXELFORMAT", "GL"];

/// Vulkan's name for the format that is called so elsewhere, if there is one that a pipeline can name: `R16G16_SFLOAT` for
/// `rg16f`. Vulkan's own name in another writing counts too.
#[must_use]
pub(crate) fn vulkans_name(name: &str) -> Option<&'static str> {
    // No name is longer by far.
    if name.len() > 64 {
        return None;
    }
    let plain = |text: &str| -> String {
        text.chars().filter(|c| !matches!(c, '_' | '-')).map(|c| c.to_ascii_uppercase()).collect()
    };
    let name = plain(name);
    let name = BEGINNINGS.iter().find_map(|beginning| name.strip_prefix(beginning)).unwrap_or(&name);
    let vulkans = Format::ALL.iter().find(|format| plain(format.name()) == name);
    let others = || NAMES.iter().find(|(_, names)| names.contains(&name)).map(|(format, _)| format);
    vulkans.or_else(others).map(|format| format.name())
}

#[cfg(test)]
mod tests {
    use super::Format;
    use super::NAMES;
    use super::vulkans_name;

    #[test]
    fn every_format_has_a_name_elsewhere_and_no_name_has_two_formats() {
        for format in Format::ALL {
            assert_eq!(NAMES.iter().filter(|(known, _)| known == format).count(), 1, "{format}");
            assert_eq!(vulkans_name(format.name()), Some(format.name()));
        }
        for (format, names) in NAMES {
            for name in *names {
                assert_eq!(vulkans_name(name), Some(format.name()), "{name}");
            }
        }
    }

    #[test]
    fn names_are_known_with_beginnings_and_in_any_case() {
        for name in ["rg16f", "RG16F", "GL_RG16F", "DXGI_FORMAT_R16G16_FLOAT", "MTLPixelFormatRG16Float", "rg16float"] {
            assert_eq!(vulkans_name(name), Some("R16G16_SFLOAT"), "{name}");
        }
        assert_eq!(vulkans_name("bgra8unorm-srgb"), Some("B8G8R8A8_SRGB"));
        assert_eq!(vulkans_name("VK_FORMAT_D32_SFLOAT"), Some("D32_SFLOAT"));
        for name in ["", "GL_", "RG", "color", "RGB8"] {
            assert_eq!(vulkans_name(name), None, "{name}");
        }
    }
}
