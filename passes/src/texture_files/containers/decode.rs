//! Texels of a file in another format: blocks are decoded, and numbers converted.

use super::super::pack::pack;
use crate::srgb;
use astc_decode::Footprint;
use framewright_graph::frame::TextureProblem;
use framewright_graph::vulkan::Format::{self, *};
use framewright_graph::vulkan::Numeric;
use half::f16;
use texture2ddecoder::{decode_etc2_rgb_block, decode_etc2_rgba1_block, decode_etc2_rgba8_block};

/// Texels of the largest block.
const LARGEST: usize = 144;

/// What EAC adds to the base of a block, by table and index (Khronos Data Format Specification, "ETC2 alpha modifiers").
const MODIFIERS: [[i32; 8]; 16] = [
    [-3, -6, -9, -15, 2, 5, 8, 14],
    [-3, -7, -10, -13, 2, 6, 9, 12],
    [-2, -5, -8, -13, 1, 4, 7, 12],
    [-2, -4, -6, -13, 1, 3, 5, 12],
    [-3, -6, -8, -12, 2, 5, 7, 11],
    [-3, -7, -9, -11, 2, 6, 8, 10],
    [-4, -7, -8, -11, 3, 6, 7, 10],
    [-3, -5, -8, -11, 2, 4, 7, 10],
    [-2, -6, -8, -10, 1, 5, 7, 9],
    [-2, -5, -8, -10, 1, 4, 7, 9],
    [-2, -4, -8, -10, 1, 3, 7, 9],
    [-2, -5, -7, -10, 1, 4, 6, 9],
    [-3, -4, -7, -10, 2, 3, 6, 9],
    [-1, -2, -3, -10, 0, 1, 2, 9],
    [-4, -6, -8, -9, 3, 5, 7, 8],
    [-3, -5, -7, -9, 2, 4, 6, 8],
];

/// Adds a slice of texels in the format `to`.
pub(super) fn convert(
    from: Format,
    slice: &[u8],
    [width, height]: [u32; 2],
    to: Format,
    bytes: &mut Vec<u8>,
) -> Result<(), TextureProblem> {
    let [width, height] = [width, height].map(|side| side as usize);
    let decodes = from.numeric() == Numeric::Srgb && to.numeric() != Numeric::Srgb;
    for color in texels(from, slice, [width, height]) {
        let [red, green, blue, alpha] = color;
        let color = [red, green, blue].map(|value| if decodes { srgb::decode(value.into()) as f32 } else { value });
        pack([color[0], color[1], color[2], alpha], to, bytes)?;
    }
    Ok(())
}

/// Red, green, blue and alpha of a slice, row after row; encoded colours stay encoded.
fn texels(format: Format, slice: &[u8], [width, height]: [usize; 2]) -> Vec<[f32; 4]> {
    let one = format.texel_bytes() as usize;
    if !format.is_compressed() {
        return slice.chunks_exact(one).map(|texel| plain(format, texel)).collect();
    }
    let [wide, high] = format.block().map(|side| side as usize);
    let mut all = vec![[0.0; 4]; width * height];
    let mut decoded = [[0.0; 4]; LARGEST];
    for (number, data) in slice.chunks_exact(one).enumerate() {
        block(format, data, &mut decoded);
        let across = width.div_ceil(wide);
        let [left, top] = [number % across * wide, number / across * high];
        for (row, texels) in decoded.chunks_exact(wide).take(high).enumerate().take(height.saturating_sub(top)) {
            let count = wide.min(width - left);
            let start = (top + row) * width + left;
            all[start..start + count].copy_from_slice(&texels[..count]);
        }
    }
    all
}

/// Decodes a block, row after row.
fn block(format: Format, data: &[u8], texels: &mut [[f32; 4]; LARGEST]) {
    let unorm = |byte: u8| f32::from(byte) / 255.0;
    let mut bytes = [0; 64];
    let mut words = [0; 16];
    let signed = matches!(format.numeric(), Numeric::Snorm | Numeric::Sfloat);
    match format {
        BC1_RGB_UNORM_BLOCK | BC1_RGB_SRGB_BLOCK | BC1_RGBA_UNORM_BLOCK | BC1_RGBA_SRGB_BLOCK => {
            bcdec_rs::bc1(data, &mut bytes, 16);
        }
        BC2_UNORM_BLOCK | BC2_SRGB_BLOCK => bcdec_rs::bc2(data, &mut bytes, 16),
        BC3_UNORM_BLOCK | BC3_SRGB_BLOCK => bcdec_rs::bc3(data, &mut bytes, 16),
        BC7_UNORM_BLOCK | BC7_SRGB_BLOCK => bcdec_rs::bc7(data, &mut bytes, 16),
        BC4_UNORM_BLOCK | BC4_SNORM_BLOCK => {
            let mut red = [0.0; 16];
            bcdec_rs::bc4_float(data, &mut red, 4, signed);
            texels.iter_mut().zip(red).for_each(|(texel, red)| *texel = [red, 0.0, 0.0, 1.0]);
            return;
        }
        BC5_UNORM_BLOCK | BC5_SNORM_BLOCK => {
            let mut both = [0.0; 32];
            bcdec_rs::bc5_float(data, &mut both, 8, signed);
            texels.iter_mut().zip(both.chunks_exact(2)).for_each(|(texel, it)| *texel = [it[0], it[1], 0.0, 1.0]);
            return;
        }
        BC6H_UFLOAT_BLOCK | BC6H_SFLOAT_BLOCK => {
            let mut halves = [0; 48];
            bcdec_rs::bc6h_half(data, &mut halves, 12, signed);
            let half = |bits: u16| f16::from_bits(bits).to_f32();
            for (texel, it) in texels.iter_mut().zip(halves.chunks_exact(3)) {
                *texel = [half(it[0]), half(it[1]), half(it[2]), 1.0];
            }
            return;
        }
        EAC_R11_UNORM_BLOCK | EAC_R11_SNORM_BLOCK | EAC_R11G11_UNORM_BLOCK | EAC_R11G11_SNORM_BLOCK => {
            texels[..16].fill([0.0, 0.0, 0.0, 1.0]);
            for (component, half) in data.chunks_exact(8).enumerate() {
                eac(half, signed, |at, value| texels[at][component] = value);
            }
            return;
        }
        ETC2_R8G8B8_UNORM_BLOCK | ETC2_R8G8B8_SRGB_BLOCK => decode_etc2_rgb_block(data, &mut words),
        ETC2_R8G8B8A1_UNORM_BLOCK | ETC2_R8G8B8A1_SRGB_BLOCK => decode_etc2_rgba1_block(data, &mut words),
        ETC2_R8G8B8A8_UNORM_BLOCK | ETC2_R8G8B8A8_SRGB_BLOCK => decode_etc2_rgba8_block(data, &mut words),
        _astc => {
            let [wide, high] = format.block();
            let Some(data) = data.first_chunk() else { return };
            astc_decode::astc_decode_block(data, Footprint::new(wide, high), |x, y, color| {
                texels[(y * wide + x) as usize] = color.map(unorm);
            });
            return;
        }
    }
    if format.feature() == Some("textureCompressionETC2") {
        for (texel, word) in texels.iter_mut().zip(words) {
            let [blue, green, red, alpha] = word.to_le_bytes();
            *texel = [red, green, blue, alpha].map(unorm);
        }
    } else {
        for (texel, bytes) in texels.iter_mut().zip(bytes.chunks_exact(4)) {
            *texel = [0, 1, 2, 3].map(|at| unorm(bytes[at]));
        }
    }
    if format.components() == 3 {
        texels.iter_mut().for_each(|texel| texel[3] = 1.0);
    }
    // The decoder keeps colours of texels that are transparent, which are black.
    if matches!(format, ETC2_R8G8B8A1_UNORM_BLOCK | ETC2_R8G8B8A1_SRGB_BLOCK) {
        texels.iter_mut().filter(|texel| texel[3] == 0.0).for_each(|texel| *texel = [0.0; 4]);
    }
}

/// Decodes one component of a block of EAC, with 11 bits; `set` is told the number of a texel, row after row.
fn eac(data: &[u8], signed: bool, mut set: impl FnMut(usize, f32)) {
    let indices = data[2..8].iter().fold(0_u64, |all, byte| all << 8 | u64::from(*byte));
    let (multiplier, table) = (i32::from(data[1] >> 4), MODIFIERS[usize::from(data[1] & 15)]);
    let step = if multiplier == 0 { 1 } else { multiplier * 8 };
    let (base, range, most) = if signed {
        (i32::from(data[0].cast_signed().max(-127)) * 8, -1023..=1023, 1023.0)
    } else {
        (i32::from(data[0]) * 8 + 4, 0..=2047, 2047.0)
    };
    for texel in 0..16_usize {
        let index = (indices >> (45 - 3 * texel)) & 7;
        let value = (base + table[index as usize] * step).clamp(*range.start(), *range.end());
        // They are stored column after column.
        set(texel % 4 * 4 + texel / 4, value as f32 / most);
    }
}

/// Red, green, blue and alpha of one texel that isn't compressed.
fn plain(format: Format, texel: &[u8]) -> [f32; 4] {
    let word = || texel.first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes));
    let cut = |shift: u32, bits: u32| (word() >> shift) & ((1 << bits) - 1);
    let share = |shift: u32, bits: u32| cut(shift, bits) as f32 / ((1_u32 << bits) - 1) as f32;
    // A half without a sign, cut short to 6 or 5 bits of mantissa.
    let small = |shift: u32, bits: u32| f16::from_bits((cut(shift, bits) << (15 - bits)) as u16).to_f32();
    match format {
        A2B10G10R10_UNORM_PACK32 => [share(0, 10), share(10, 10), share(20, 10), share(30, 2)],
        A2R10G10B10_UNORM_PACK32 => [share(20, 10), share(10, 10), share(0, 10), share(30, 2)],
        B10G11R11_UFLOAT_PACK32 => [small(0, 11), small(11, 11), small(22, 10), 1.0],
        E5B9G9R9_UFLOAT_PACK32 => {
            let scale = 2_f32.powi(cut(27, 5).cast_signed() - 24);
            [cut(0, 9) as f32 * scale, cut(9, 9) as f32 * scale, cut(18, 9) as f32 * scale, 1.0]
        }
        B8G8R8A8_UNORM | B8G8R8A8_SRGB => [2, 1, 0, 3].map(|at| f32::from(texel[at]) / 255.0),
        _ => {
            let components = format.components() as usize;
            let mut color = [0.0, 0.0, 0.0, 1.0];
            for (value, bytes) in color.iter_mut().zip(texel.chunks_exact(texel.len() / components)) {
                *value = component(format.numeric(), bytes);
            }
            color
        }
    }
}

/// One component by itself.
fn component(numeric: Numeric, bytes: &[u8]) -> f32 {
    match (bytes, numeric) {
        (&[byte], Numeric::Snorm) => (f32::from(byte.cast_signed()) / 127.0).max(-1.0),
        (&[byte], _) => f32::from(byte) / 255.0,
        (&[low, high], Numeric::Snorm) => (f32::from(i16::from_le_bytes([low, high])) / 32767.0).max(-1.0),
        (&[low, high], Numeric::Sfloat) => f16::from_le_bytes([low, high]).to_f32(),
        (&[low, high], _) => f32::from(u16::from_le_bytes([low, high])) / 65535.0,
        (&[a, b, c, d], _) => f32::from_le_bytes([a, b, c, d]),
        _ => 0.0,
    }
}
