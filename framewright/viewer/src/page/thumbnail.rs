//! Small pictures of captured images, with the numbers of their texels: the page draws them with any exposure.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use framewright_graph::vulkan::{Format, Numeric};
use framewright_lab::picture::values::{components, is_light, srgb_byte, texel_bytes, values};
use half::f16;
use serde::Serialize;

/// The longer side of a small picture has at most this many pixels.
const MOST: u32 = 128;

/// A captured image on a page.
#[derive(Serialize)]
pub struct Thumbnail {
    /// The pass that wrote it.
    pub pass: String,
    /// The image.
    pub image: String,
    /// The part that was written, in words; empty for all of it.
    pub part: String,
    /// The whole picture: a file beside the page.
    pub file: String,
    format: Format,
    /// Size of the whole picture.
    size: [u32; 2],
    /// Size of the small one.
    small: [u32; 2],
    /// Channels of a texel.
    channels: usize,
    /// Whether the numbers are light; else they are depth or integers.
    light: bool,
    /// The numbers are `f16`, `f32`, `u8` for 255ths, or `srgb` for 255ths in the curve of sRGB, in which alpha isn't.
    numbers: &'static str,
    /// The texels, row after row, little-endian, in base64.
    data: String,
    /// Smallest and largest finite number of the whole picture.
    range: Option<[f32; 2]>,
    /// Texels of the whole picture with a NaN, and with an infinity and no NaN.
    not_finite: [usize; 2],
}

impl Thumbnail {
    /// The small picture of `bytes`: rows from the top, as they are read back.
    pub fn new(names: [String; 4], format: Format, size: [u32; 2], bytes: &[u8]) -> Thumbnail {
        let [pass, image, part, file] = names;
        let channels = components(format);
        let texels: Vec<[f32; 4]> =
            bytes.chunks_exact(texel_bytes(format)).map(|texel| values(format, texel)).collect();
        let longer = size[0].max(size[1]).max(1);
        let small = size.map(|side| if longer > MOST { (side * MOST / longer).max(1) } else { side });
        let numbers = match format.numeric() {
            Numeric::Srgb => "srgb",
            Numeric::Unorm if !format.is_depth() && format.texel_bytes() <= 4 => "u8",
            Numeric::Sfloat | Numeric::Ufloat if !is_32_bits(format) => "f16",
            _ => "f32",
        };
        let mut data = Vec::new();
        for texel in shrunk(&texels, size, small, is_light(format)) {
            for (channel, value) in texel[..channels].iter().enumerate() {
                match numbers {
                    "srgb" if channel < 3 => data.push(srgb_byte(*value)),
                    "srgb" => data.push((value * 255.0).round() as u8),
                    "u8" => data.push((value * 255.0).round() as u8),
                    "f16" => data.extend(f16::from_f32(*value).to_le_bytes()),
                    _ => data.extend(value.to_le_bytes()),
                }
            }
        }
        let own = || texels.iter().map(|texel| &texel[..channels]);
        let finite = own().flatten().filter(|value| value.is_finite());
        let range = finite.fold(None, |range: Option<[f32; 2]>, value| match range {
            None => Some([*value; 2]),
            Some([low, high]) => Some([low.min(*value), high.max(*value)]),
        });
        let nan = own().filter(|texel| texel.iter().any(|value| value.is_nan())).count();
        let bad = own().filter(|texel| texel.iter().any(|value| !value.is_finite())).count();
        let light = is_light(format);
        let data = BASE64_STANDARD.encode(&data);
        let not_finite = [nan, bad - nan];
        Thumbnail { pass, image, part, file, format, size, small, channels, light, numbers, data, range, not_finite }
    }
}

/// Whether a float of the format may be beyond what half of it holds.
fn is_32_bits(format: Format) -> bool {
    let largest = format.texel_bytes() >= 4 * u64::from(format.components());
    largest || format.is_depth()
}

/// The texels of a smaller picture: means of those that each covers, in which a NaN or an infinity stays one. Means of depth and
/// integers say nothing: there the texel in the middle is taken.
fn shrunk(texels: &[[f32; 4]], size: [u32; 2], small: [u32; 2], light: bool) -> Vec<[f32; 4]> {
    let [width, height] = size.map(|side| side as usize);
    let [columns, rows] = small.map(|side| side as usize);
    let cut = |at: usize, parts: usize, all: usize| at * all / parts.max(1);
    let at = |x: usize, y: usize| texels.get(y * width + x).copied().unwrap_or_default();
    let mut shrunk = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        for column in 0..columns {
            let [left, right] = [column, column + 1].map(|at| cut(at, columns, width));
            let [top, bottom] = [row, row + 1].map(|at| cut(at, rows, height));
            if !light {
                shrunk.push(at((left + right) / 2, (top + bottom) / 2));
                continue;
            }
            let mut sum = [0.0_f64; 4];
            for (x, y) in (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y))) {
                for (sum, value) in sum.iter_mut().zip(at(x, y)) {
                    *sum += f64::from(value);
                }
            }
            let count = ((right - left) * (bottom - top)).max(1) as f64;
            shrunk.push(sum.map(|sum| (sum / count) as f32));
        }
    }
    shrunk
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_picture_keeps_means_and_marks_what_is_not_finite() {
        let mut texels = vec![[1.0, 2.0, 3.0, 4.0]; 512 * 2];
        texels[5] = [f32::NAN; 4];
        texels[9] = [f32::INFINITY, 0.0, 0.0, 0.0];
        let bytes: Vec<u8> = texels.iter().flatten().flat_map(|value| value.to_ne_bytes()).collect();
        let names = || ["p", "i", "", "f"].map(str::to_owned);
        let made = Thumbnail::new(names(), Format::R32G32B32A32_SFLOAT, [512, 2], &bytes);
        assert_eq!((made.small, made.not_finite, made.range), ([128, 1], [1, 1], Some([0.0, 4.0])));
        let data = BASE64_STANDARD.decode(&made.data).expect("base64");
        let value = |at: usize| f32::from_le_bytes([data[at], data[at + 1], data[at + 2], data[at + 3]]);
        assert!(value(16).is_nan() && value(32).is_infinite());
        assert_eq!([0, 4, 8, 12].map(value), [1.0, 2.0, 3.0, 4.0]);
        let depth: Vec<u8> = [0.25_f32, 0.75].iter().flat_map(|value| value.to_ne_bytes()).collect();
        let made = Thumbnail::new(names(), Format::D32_SFLOAT, [2, 1], &depth);
        assert_eq!((made.channels, made.numbers, made.light, made.range), (1, "f32", false, Some([0.25, 0.75])));
        let none = Thumbnail::new(names(), Format::R16_SFLOAT, [1, 1], &f16::NAN.to_ne_bytes());
        assert_eq!((none.range, none.not_finite), (None, [1, 0]));
    }
}
