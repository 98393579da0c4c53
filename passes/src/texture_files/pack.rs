//! Texels in the formats that images have.

use framewright_graph::frame::TextureProblem;
use framewright_graph::vulkan::Format;
use half::f16;

/// Adds one texel. NaN becomes 0, and values that are too large become the largest that the format holds.
pub(super) fn pack(color: [f32; 4], format: Format, bytes: &mut Vec<u8>) -> Result<(), TextureProblem> {
    use Format as F;
    let color = color.map(|value| if value.is_nan() { 0.0 } else { value });
    let components = format.components() as usize;
    match format {
        F::R8_UNORM | F::R8G8_UNORM | F::R8G8B8A8_UNORM | F::R8G8B8A8_SRGB => {
            bytes.extend(color.iter().take(components).map(|value| fixed(*value, 255.0).to_ne_bytes()[LOW]));
        }
        F::R8_SNORM | F::R8G8_SNORM => {
            bytes.extend(color.iter().take(components).map(|value| signed(*value)));
        }
        F::A2B10G10R10_UNORM_PACK32 => {
            let [red, green, blue] = [color[0], color[1], color[2]].map(|value| u32::from(fixed(value, 1023.0)));
            let word = u32::from(fixed(color[3], 3.0)) << 30 | blue << 20 | green << 10 | red;
            bytes.extend(word.to_ne_bytes());
        }
        F::B8G8R8A8_UNORM | F::B8G8R8A8_SRGB => {
            bytes.extend([2, 1, 0, 3].map(|at| fixed(color[at], 255.0).to_ne_bytes()[LOW]));
        }
        F::R16_UNORM | F::R16G16_UNORM | F::R16G16B16A16_UNORM => {
            bytes.extend(color.iter().take(components).flat_map(|value| fixed(*value, 65535.0).to_ne_bytes()));
        }
        F::R16_SFLOAT | F::R16G16_SFLOAT | F::R16G16B16A16_SFLOAT => {
            let largest = f32::from(f16::MAX);
            let half = |value: &f32| f16::from_f32(value.clamp(-largest, largest)).to_ne_bytes();
            bytes.extend(color.iter().take(components).flat_map(half));
        }
        F::R32_SFLOAT | F::R32G32_SFLOAT | F::R32G32B32A32_SFLOAT => {
            let float = |value: &f32| value.clamp(f32::MIN, f32::MAX).to_ne_bytes();
            bytes.extend(color.iter().take(components).flat_map(float));
        }
        _ => return Err(TextureProblem::Format { format, why: "no picture is stored in this format" }),
    }
    Ok(())
}

/// The place of the low byte of a 16-bit value in memory.
const LOW: usize = if cfg!(target_endian = "little") { 0 } else { 1 };

/// A value −1…1 in steps of 1 / 127, to the nearest.
#[allow(clippy::cast_possible_truncation, reason = "-127 to 127")]
fn signed(value: f32) -> u8 {
    ((value.clamp(-1.0, 1.0) * 127.0).round() as i8).cast_unsigned()
}

/// A value 0…1 in steps of 1 / `most`, to the nearest.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65535")]
fn fixed(value: f32, most: f32) -> u16 {
    (value.clamp(0.0, 1.0) * most).round() as u16
}
