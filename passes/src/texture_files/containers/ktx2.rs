//! KTX 2.0 files of Khronos (registry.khronos.org/KTX).

use super::super::words::damaged;
use super::container::{Container, Level, Packing, Place, StoredTexels};
use framewright_graph::frame::{ColorSpace, TextureProblem};
use framewright_graph::vulkan::{Format, Numeric};
use ktx2::dfd::Basic;
use ktx2::{ColorModel, Header, LevelIndex, SupercompressionScheme};

/// Vulkan's numbers of formats with three components, the formats with a fourth one, and bytes of a texel.
const OF_THREE: [(u32, Format, u64); 14] = [
    (23, Format::R8G8B8A8_UNORM, 3),
    (24, Format::R8G8B8A8_SNORM, 3),
    (27, Format::R8G8B8A8_UINT, 3),
    (28, Format::R8G8B8A8_SINT, 3),
    (29, Format::R8G8B8A8_SRGB, 3),
    (30, Format::B8G8R8A8_UNORM, 3),
    (36, Format::B8G8R8A8_SRGB, 3),
    (84, Format::R16G16B16A16_UNORM, 6),
    (85, Format::R16G16B16A16_SNORM, 6),
    (88, Format::R16G16B16A16_UINT, 6),
    (89, Format::R16G16B16A16_SINT, 6),
    (90, Format::R16G16B16A16_SFLOAT, 6),
    (104, Format::R32G32B32A32_UINT, 12),
    (106, Format::R32G32B32A32_SFLOAT, 12),
];

/// Vulkan's numbers of `A8B8G8R8_…_PACK32`, whose bytes are those of `R8G8B8A8_…`.
const PACKED: [(u32, Format); 5] = [
    (51, Format::R8G8B8A8_UNORM),
    (52, Format::R8G8B8A8_SNORM),
    (55, Format::R8G8B8A8_UINT),
    (56, Format::R8G8B8A8_SINT),
    (57, Format::R8G8B8A8_SRGB),
];

/// Reads the header of a file that begins with `head`.
pub(super) fn open(head: &[u8]) -> Result<Container, TextureProblem> {
    let short = || damaged("it is cut off within its header");
    let header = head.first_chunk::<{ Header::LENGTH }>().ok_or_else(short)?;
    let header = Header::from_bytes(header).map_err(damaged)?;
    let packing = match header.supercompression_scheme {
        _ if header.format.is_none() => return Err(undefined(head, &header)),
        None => Packing::None,
        Some(SupercompressionScheme::Zstandard) => Packing::Zstandard,
        Some(SupercompressionScheme::ZLIB) => Packing::Zlib,
        Some(SupercompressionScheme::BasisLZ) => return Err(TextureProblem::Basis { what: "ETC1S" }),
        Some(other) => return Err(damaged(format!("its supercompression has the number {}", other.value()))),
    };
    let texels = texels(header.format.map_or(0, |format| format.value()))?;
    let mips = header.level_count.max(1);
    if mips > u32::BITS {
        return Err(damaged(format!("it says that it has {mips} mip levels")));
    }
    let mut levels = Vec::new();
    for mip in 0..mips as usize {
        let rest = head.get(Header::LENGTH + mip * LevelIndex::LENGTH..).ok_or_else(short)?;
        let index = LevelIndex::from_bytes(rest.first_chunk().ok_or_else(short)?);
        levels.push(Level { offset: index.byte_offset, bytes: index.byte_length, packing });
    }
    let cube = match header.face_count {
        1 => false,
        6 => true,
        faces => return Err(damaged(format!("it says that it has {faces} faces; cubes have 6"))),
    };
    let layers = header.layer_count.max(1).saturating_mul(header.face_count);
    let color_space = if texels.format.numeric() == Numeric::Srgb { ColorSpace::Srgb } else { ColorSpace::Linear };
    Ok(Container {
        texels,
        extent: [header.pixel_width, header.pixel_height.max(1), header.pixel_depth.max(1)],
        mips,
        layers,
        cube,
        color_space: Some(color_space),
        place: Place::Levels(levels),
    })
}

/// The texels of Vulkan's format with this number.
fn texels(number: u32) -> Result<StoredTexels, TextureProblem> {
    if let Some((_, format, bytes)) = OF_THREE.iter().find(|(known, ..)| *known == number) {
        return Ok(StoredTexels::of_three(*format, *bytes));
    }
    let known = Format::ALL.iter().find(|format| i64::from(format.vulkan()) == i64::from(number) && !format.is_depth());
    let packed = || PACKED.iter().find(|(known, _)| *known == number).map(|(_, format)| format);
    let format = known.or_else(packed);
    let other = || TextureProblem::OtherFormat { format: format!("the VkFormat with the number {number}") };
    format.map(|format| StoredTexels::whole(*format)).ok_or_else(other)
}

/// What is wrong with a file that names no format.
fn undefined(head: &[u8], header: &Header) -> TextureProblem {
    if header.supercompression_scheme == Some(SupercompressionScheme::BasisLZ) {
        return TextureProblem::Basis { what: "ETC1S" };
    }
    // The descriptor follows its own length and the header of its block.
    let start = header.index.dfd_byte_offset.saturating_add(12) as usize;
    let end = header.index.dfd_byte_offset.saturating_add(header.index.dfd_byte_length) as usize;
    let described = head.get(start..end).and_then(|bytes| Basic::parse(bytes).ok());
    match described.and_then(|basic| basic.color_model) {
        Some(ColorModel::UASTC) => TextureProblem::Basis { what: "UASTC" },
        _ => TextureProblem::OtherFormat { format: "texels of VK_FORMAT_UNDEFINED".to_owned() },
    }
}
