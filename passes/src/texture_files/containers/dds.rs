//! DDS files of Microsoft ("Programming Guide for DDS").

use super::super::words::damaged;
use super::container::{Container, Place, StoredTexels};
use ddsfile::{Caps2, D3D10ResourceDimension, Dds, Header10, MiscFlag, PixelFormat};
use framewright_graph::frame::{ColorSpace, TextureProblem};
use framewright_graph::vulkan::Format::{self, *};
use framewright_graph::vulkan::Numeric;

/// Bytes of the usual header with its magic number, and of the DX10 header after it.
const HEADERS: [u64; 2] = [128, 20];

/// DXGI's numbers of formats.
const DXGI: [(u32, Format); 58] = [
    (2, R32G32B32A32_SFLOAT),
    (3, R32G32B32A32_UINT),
    (4, R32G32B32A32_SINT),
    (10, R16G16B16A16_SFLOAT),
    (11, R16G16B16A16_UNORM),
    (12, R16G16B16A16_UINT),
    (13, R16G16B16A16_SNORM),
    (14, R16G16B16A16_SINT),
    (16, R32G32_SFLOAT),
    (17, R32G32_UINT),
    (18, R32G32_SINT),
    (24, A2B10G10R10_UNORM_PACK32),
    (26, B10G11R11_UFLOAT_PACK32),
    (28, R8G8B8A8_UNORM),
    (29, R8G8B8A8_SRGB),
    (30, R8G8B8A8_UINT),
    (31, R8G8B8A8_SNORM),
    (32, R8G8B8A8_SINT),
    (34, R16G16_SFLOAT),
    (35, R16G16_UNORM),
    (36, R16G16_UINT),
    (37, R16G16_SNORM),
    (38, R16G16_SINT),
    (41, R32_SFLOAT),
    (42, R32_UINT),
    (43, R32_SINT),
    (49, R8G8_UNORM),
    (50, R8G8_UINT),
    (51, R8G8_SNORM),
    (52, R8G8_SINT),
    (54, R16_SFLOAT),
    (56, R16_UNORM),
    (57, R16_UINT),
    (58, R16_SNORM),
    (59, R16_SINT),
    (61, R8_UNORM),
    (62, R8_UINT),
    (63, R8_SNORM),
    (64, R8_SINT),
    (67, E5B9G9R9_UFLOAT_PACK32),
    (71, BC1_RGBA_UNORM_BLOCK),
    (72, BC1_RGBA_SRGB_BLOCK),
    (74, BC2_UNORM_BLOCK),
    (75, BC2_SRGB_BLOCK),
    (77, BC3_UNORM_BLOCK),
    (78, BC3_SRGB_BLOCK),
    (80, BC4_UNORM_BLOCK),
    (81, BC4_SNORM_BLOCK),
    (83, BC5_UNORM_BLOCK),
    (84, BC5_SNORM_BLOCK),
    (87, B8G8R8A8_UNORM),
    (91, B8G8R8A8_SRGB),
    (95, BC6H_UFLOAT_BLOCK),
    (96, BC6H_SFLOAT_BLOCK),
    (98, BC7_UNORM_BLOCK),
    (99, BC7_SRGB_BLOCK),
    (88, B8G8R8A8_UNORM),
    (93, B8G8R8A8_SRGB),
];

/// DXGI's numbers of formats whose fourth component isn't used.
const UNUSED_ALPHA: [u32; 2] = [88, 93];

/// Formats that a legacy header names by four letters, or by a number of Direct3D 9.
const LETTERS: [(u32, Format); 19] = [
    (letters(b"DXT1"), BC1_RGBA_UNORM_BLOCK),
    (letters(b"DXT2"), BC2_UNORM_BLOCK),
    (letters(b"DXT3"), BC2_UNORM_BLOCK),
    (letters(b"DXT4"), BC3_UNORM_BLOCK),
    (letters(b"DXT5"), BC3_UNORM_BLOCK),
    (letters(b"ATI1"), BC4_UNORM_BLOCK),
    (letters(b"BC4U"), BC4_UNORM_BLOCK),
    (letters(b"BC4S"), BC4_SNORM_BLOCK),
    (letters(b"ATI2"), BC5_UNORM_BLOCK),
    (letters(b"BC5U"), BC5_UNORM_BLOCK),
    (letters(b"BC5S"), BC5_SNORM_BLOCK),
    (36, R16G16B16A16_UNORM),
    (110, R16G16B16A16_SNORM),
    (111, R16_SFLOAT),
    (112, R16G16_SFLOAT),
    (113, R16G16B16A16_SFLOAT),
    (114, R32_SFLOAT),
    (115, R32G32_SFLOAT),
    (116, R32G32B32A32_SFLOAT),
];

/// Formats that a legacy header names by bits of a texel and the masks of red, green and blue.
const MASKS: [([u32; 4], Format); 9] = [
    ([32, 0xFF, 0xFF00, 0x00FF_0000], R8G8B8A8_UNORM),
    ([32, 0x00FF_0000, 0xFF00, 0xFF], B8G8R8A8_UNORM),
    ([24, 0xFF, 0xFF00, 0x00FF_0000], R8G8B8A8_UNORM),
    ([24, 0x00FF_0000, 0xFF00, 0xFF], B8G8R8A8_UNORM),
    ([32, 0x3FF, 0x000F_FC00, 0x3FF0_0000], A2B10G10R10_UNORM_PACK32),
    ([32, 0x3FF0_0000, 0x000F_FC00, 0x3FF], A2R10G10B10_UNORM_PACK32),
    ([32, 0xFFFF, 0xFFFF_0000, 0], R16G16_UNORM),
    ([16, 0xFF, 0xFF00, 0], R8G8_UNORM),
    ([8, 0xFF, 0, 0], R8_UNORM),
];

const fn letters(four: &[u8; 4]) -> u32 {
    u32::from_le_bytes(*four)
}

/// Reads the headers of a file that begins with `head`; `color_space` counts where they name none.
pub(super) fn open(head: &[u8], color_space: ColorSpace) -> Result<Container, TextureProblem> {
    let headers = head.get(..(HEADERS[0] + HEADERS[1]) as usize).unwrap_or(head);
    let dds = Dds::read(headers).map_err(damaged)?;
    let header = &dds.header;
    let (texels, named) = match &dds.header10 {
        Some(newer) => {
            let texels = dxgi(newer)?;
            let srgb = texels.format.numeric() == Numeric::Srgb;
            (texels, Some(if srgb { ColorSpace::Srgb } else { ColorSpace::Linear }))
        }
        None => {
            let texels = legacy(&header.spf)?;
            let [linear, srgb] = [false, true].map(|is_srgb| texels.format.with_srgb(is_srgb));
            let format = if color_space == ColorSpace::Srgb { srgb } else { linear };
            (StoredTexels { format, ..texels }, (linear == srgb).then_some(ColorSpace::Linear))
        }
    };
    let is_deep = match &dds.header10 {
        Some(newer) => newer.resource_dimension == D3D10ResourceDimension::Texture3D,
        None => header.caps2.contains(Caps2::VOLUME),
    };
    let cube = match &dds.header10 {
        Some(newer) => newer.misc_flag.contains(MiscFlag::TEXTURECUBE),
        None => header.caps2.contains(Caps2::CUBEMAP),
    };
    if cube && dds.header10.is_none() && !header.caps2.contains(Caps2::CUBEMAP_ALLFACES) {
        return Err(damaged("it holds a cube without some of its faces"));
    }
    let elements = dds.header10.as_ref().map_or(1, |newer| newer.array_size);
    Ok(Container {
        texels,
        extent: [header.width, header.height, if is_deep { header.depth.unwrap_or(1).max(1) } else { 1 }],
        mips: header.mip_map_count.unwrap_or(1).max(1),
        layers: if cube { elements.saturating_mul(6) } else { elements },
        cube,
        color_space: named,
        place: Place::Layers(HEADERS[0] + if dds.header10.is_some() { HEADERS[1] } else { 0 }),
    })
}

/// The texels that a DX10 header names.
fn dxgi(header: &Header10) -> Result<StoredTexels, TextureProblem> {
    let number = header.dxgi_format as u32;
    let format = DXGI.iter().find(|(known, _)| *known == number).map(|(_, format)| *format);
    match (number, format) {
        (6, _) => Ok(StoredTexels::of_three(R32G32B32A32_SFLOAT, 12)),
        (7, _) => Ok(StoredTexels::of_three(R32G32B32A32_UINT, 12)),
        (_, Some(format)) if UNUSED_ALPHA.contains(&number) => Ok(StoredTexels::of_three(format, 4)),
        (_, Some(format)) => Ok(StoredTexels::whole(format)),
        (_, None) => Err(TextureProblem::OtherFormat { format: format!("DXGI's format {:?}", header.dxgi_format) }),
    }
}

/// The texels that a legacy header describes.
fn legacy(said: &PixelFormat) -> Result<StoredTexels, TextureProblem> {
    let other = |format: String| TextureProblem::OtherFormat { format };
    if let Some(letters) = &said.fourcc {
        let found = LETTERS.iter().find(|(known, _)| *known == letters.0);
        let name = letters.0.to_le_bytes().escape_ascii().to_string();
        return found
            .map(|(_, format)| StoredTexels::whole(*format))
            .ok_or_else(|| other(format!("texels named {name}")));
    }
    let bits = said.rgb_bit_count.unwrap_or(0);
    let [red, green, blue] = [said.r_bit_mask, said.g_bit_mask, said.b_bit_mask].map(|mask| mask.unwrap_or(0));
    // Of luminance the mask isn't read.
    let masks = if bits == 8 && red == 0 { [8, 0xFF, 0, 0] } else { [bits, red, green, blue] };
    let found = MASKS.iter().find(|(known, _)| *known == masks).map(|(_, format)| *format);
    let has_alpha = said.a_bit_mask.unwrap_or(0) != 0;
    match found {
        Some(format @ (R8G8B8A8_UNORM | B8G8R8A8_UNORM)) if bits == 24 || !has_alpha => {
            Ok(StoredTexels::of_three(format, u64::from(bits / 8)))
        }
        Some(format) => Ok(StoredTexels::whole(format)),
        None => Err(other(format!("texels of {bits} bits with the masks {red:#X}, {green:#X}, {blue:#X}"))),
    }
}
