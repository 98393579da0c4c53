//! Small pictures of captured images, with the numbers of their texels: the page draws them with any exposure.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use framewright_graph::frame::CaptureName;
use framewright_graph::vulkan::{Format, Numeric};
use framewright_lab::picture::values::{components, is_light, srgb_byte, texel_bytes, values};
use half::f16;
use serde::{Deserialize, Serialize};

/// The longer side of a picture that is asked for has at most this many texels.
const MOST_SIDE: u32 = 4096;
/// A picture takes at most this many bytes.
const MOST_BYTES: usize = 64 << 20;

/// A capture on a page: with a picture, or one that can be asked for.
#[derive(Debug, Serialize)]
pub struct Thumbnail {
    /// What was captured.
    #[serde(flatten)]
    pub name: CaptureName,
    /// The part that was written, in words; empty for all of it.
    part: String,
    /// The whole picture: a file beside the page.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(flatten)]
    picture: Option<SmallPicture>,
}

/// A picture, or the part of it that was asked for, with the numbers of its texels.
#[derive(Debug, Serialize)]
struct SmallPicture {
    format: Format,
    /// Size of the whole picture.
    size: [u32; 2],
    /// Pictures that stand in it side by side: layers or slices.
    columns: u32,
    /// The part of it that this is: left, top, width, height.
    region: [u32; 4],
    /// Size of this one.
    small: [u32; 2],
    /// Channels of a texel.
    channels: usize,
    /// Whether the numbers are light; else they are depth or integers.
    light: bool,
    /// The numbers are `f16`, `f32`, `u32`, `i32`, `u8` for 255ths, or `srgb` for 255ths in the curve of sRGB, in which alpha isn't.
    numbers: &'static str,
    /// The texels, row after row, little-endian, in base64.
    data: String,
    /// Smallest and largest finite number of the part.
    range: Option<[f32; 2]>,
    /// Texels of the part with a NaN, and with an infinity and no NaN.
    not_finite: [usize; 2],
}

/// The texels of a whole picture.
#[derive(Debug, Clone, Copy)]
pub struct PictureTexels<'a> {
    /// The format of a texel.
    pub format: Format,
    /// Width and height.
    pub size: [u32; 2],
    /// Pictures that stand in it side by side: layers or slices.
    pub columns: u32,
    /// Rows from the top, as they are read back.
    pub bytes: &'a [u8],
}

/// What of a picture is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PictureSize {
    /// The texels of its longer side, at most. A picture that has no more is shown as it is.
    pub most: u32,
    /// The part of it: left, top, width, height; `None`: all of it.
    #[serde(default)]
    pub region: Option<[u32; 4]>,
}

impl Thumbnail {
    /// One that can be asked for.
    #[must_use]
    pub fn to_ask_for(name: CaptureName) -> Thumbnail {
        Thumbnail { part: part(&name), name, file: None, picture: None }
    }

    /// The same with the whole picture in a file, whose address the page has.
    #[must_use]
    pub fn with_file(self, file: String) -> Thumbnail {
        Thumbnail { file: Some(file), ..self }
    }

    /// The picture of `texels` at this size.
    ///
    /// # Errors
    /// If the part lies beside the picture, in words.
    pub fn new(name: CaptureName, texels: PictureTexels<'_>, size: PictureSize) -> Result<Thumbnail, String> {
        Ok(Thumbnail { part: part(&name), name, file: None, picture: Some(SmallPicture::new(texels, size)?) })
    }
}

/// The part of the image in words; empty for its first level and layers.
fn part(name: &CaptureName) -> String {
    let stencil = name.stencil.then(|| "stencil".to_owned());
    let mip = (name.mip > 0).then(|| format!("mip level {}", name.mip));
    let layer = (name.layer > 0).then(|| format!("layer {}", name.layer));
    stencil.into_iter().chain(mip).chain(layer).collect::<Vec<_>>().join(", ")
}

impl SmallPicture {
    fn new(all: PictureTexels<'_>, wanted: PictureSize) -> Result<SmallPicture, String> {
        let PictureTexels { format, size, columns, .. } = all;
        let region = clipped(size, wanted.region)?;
        let cut = cut(&all, region);
        let channels = components(format);
        let texels: Vec<[f32; 4]> = cut.iter().map(|texel| values(format, texel)).collect();
        let numbers = match format.numeric() {
            Numeric::Srgb => "srgb",
            Numeric::Unorm if is_8_bits(format) => "u8",
            Numeric::Sfloat | Numeric::Ufloat if !is_32_bits(format) => "f16",
            Numeric::Uint if is_32_bits(format) => "u32",
            Numeric::Sint if is_32_bits(format) => "i32",
            _ => "f32",
        };
        let small = within([region[2], region[3]], wanted.most.clamp(1, MOST_SIDE), channels);
        let mut data = Vec::new();
        for texel in shrunk(&texels, [region[2], region[3]], small, is_light(format)) {
            let value = match texel {
                SmallTexel::Mean(value) => value,
                SmallTexel::Texel(at) if matches!(numbers, "u32" | "i32") => {
                    let words = cut.get(at).copied().unwrap_or(&[0; 16]).chunks_exact(4).take(channels);
                    words.for_each(|word| {
                        data.extend(u32::from_ne_bytes([word[0], word[1], word[2], word[3]]).to_le_bytes())
                    });
                    continue;
                }
                SmallTexel::Texel(at) => texels.get(at).copied().unwrap_or_default(),
            };
            for (channel, value) in value[..channels].iter().enumerate() {
                match numbers {
                    "srgb" if channel < 3 => data.push(srgb_byte(*value)),
                    "srgb" | "u8" => data.push((value * 255.0).round() as u8),
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
        let (light, data) = (is_light(format), BASE64_STANDARD.encode(&data));
        let not_finite = [nan, bad - nan];
        Ok(SmallPicture { format, size, columns, region, small, channels, light, numbers, data, range, not_finite })
    }
}

/// The part of a picture that there is of `region`.
fn clipped(size: [u32; 2], region: Option<[u32; 4]>) -> Result<[u32; 4], String> {
    let [width, height] = size;
    let [left, top, wide, high] = region.unwrap_or([0, 0, width, height]);
    if left >= width || top >= height || wide == 0 || high == 0 {
        return Err(format!("a part that begins at {left}, {top} has no texel of a picture of {width}×{height}"));
    }
    Ok([left, top, wide.min(width - left), high.min(height - top)])
}

/// The texels of a part, row after row.
fn cut<'a>(all: &PictureTexels<'a>, [left, top, wide, high]: [u32; 4]) -> Vec<&'a [u8]> {
    let row = (all.size[0] as usize).max(1);
    let texels: Vec<&[u8]> = all.bytes.chunks_exact(texel_bytes(all.format)).collect();
    let of_row = |y: u32| texels.iter().skip(y as usize * row + left as usize).take(wide as usize).copied();
    (top..top + high).flat_map(of_row).collect()
}

/// A size of at most `most` texels at its longer side, whose numbers take no more bytes than a picture may.
fn within(size: [u32; 2], most: u32, channels: usize) -> [u32; 2] {
    let mut most = most;
    loop {
        let longer = size[0].max(size[1]).max(1);
        let small = size.map(|side| {
            let side = if longer > most { u64::from(side) * u64::from(most) / u64::from(longer) } else { side.into() };
            u32::try_from(side).unwrap_or(most).max(1)
        });
        if small[0] as usize * small[1] as usize * channels * 4 <= MOST_BYTES || most <= 1 {
            return small;
        }
        most /= 2;
    }
}

/// Whether each channel of the format is a byte.
fn is_8_bits(format: Format) -> bool {
    let packed = matches!(format, Format::A2B10G10R10_UNORM_PACK32 | Format::A2R10G10B10_UNORM_PACK32);
    !packed && !format.is_depth() && format.texel_bytes() == u64::from(format.components())
}

/// Whether a float of the format may be beyond what half of it holds.
fn is_32_bits(format: Format) -> bool {
    let largest = format.texel_bytes() >= 4 * u64::from(format.components());
    largest || format.is_depth()
}

/// A texel of a smaller picture.
enum SmallTexel {
    /// The mean of those that it covers.
    Mean([f32; 4]),
    /// One of them, by its number.
    Texel(usize),
}

/// The texels of a smaller picture: means of those that each covers, in which a NaN or an infinity stays one. Means of depth and
/// integers say nothing: there the texel in the middle is taken.
fn shrunk(texels: &[[f32; 4]], size: [u32; 2], small: [u32; 2], light: bool) -> Vec<SmallTexel> {
    let [width, height] = size.map(|side| side as usize);
    let [columns, rows] = small.map(|side| side as usize);
    let cut = |at: usize, parts: usize, all: usize| at * all / parts.max(1);
    let at = |x: usize, y: usize| texels.get(y * width + x).copied().unwrap_or_default();
    let mut shrunk = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        for column in 0..columns {
            let [left, right] = [column, column + 1].map(|at| cut(at, columns, width));
            let [top, bottom] = [row, row + 1].map(|at| cut(at, rows, height));
            if !light || size == small {
                shrunk.push(SmallTexel::Texel((top + bottom) / 2 * width + (left + right) / 2));
                continue;
            }
            let mut sum = [0.0_f64; 4];
            for (x, y) in (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y))) {
                for (sum, value) in sum.iter_mut().zip(at(x, y)) {
                    *sum += f64::from(value);
                }
            }
            let count = ((right - left) * (bottom - top)).max(1) as f64;
            shrunk.push(SmallTexel::Mean(sum.map(|sum| (sum / count) as f32)));
        }
    }
    shrunk
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name() -> CaptureName {
        CaptureName { pass: "p".into(), image: "i".into(), mip: 1, layer: 0, stencil: false }
    }

    fn made(format: Format, size: [u32; 2], bytes: &[u8], wanted: PictureSize) -> SmallPicture {
        let texels = PictureTexels { format, size, columns: 1, bytes };
        Thumbnail::new(name(), texels, wanted).expect("a picture").picture.expect("a picture")
    }

    const SMALL: PictureSize = PictureSize { most: 128, region: None };

    #[test]
    fn a_small_picture_keeps_means_and_marks_what_is_not_finite() {
        let mut texels = vec![[1.0, 2.0, 3.0, 4.0]; 512 * 2];
        texels[5] = [f32::NAN; 4];
        texels[9] = [f32::INFINITY, 0.0, 0.0, 0.0];
        let bytes: Vec<u8> = texels.iter().flatten().flat_map(|value| value.to_ne_bytes()).collect();
        let small = made(Format::R32G32B32A32_SFLOAT, [512, 2], &bytes, SMALL);
        assert_eq!((small.small, small.not_finite, small.range), ([128, 1], [1, 1], Some([0.0, 4.0])));
        let data = BASE64_STANDARD.decode(&small.data).expect("base64");
        let value = |at: usize| f32::from_le_bytes([data[at], data[at + 1], data[at + 2], data[at + 3]]);
        assert!(value(16).is_nan() && value(32).is_infinite());
        assert_eq!([0, 4, 8, 12].map(value), [1.0, 2.0, 3.0, 4.0]);
        let depth: Vec<u8> = [0.25_f32, 0.75].iter().flat_map(|value| value.to_ne_bytes()).collect();
        let small = made(Format::D32_SFLOAT, [2, 1], &depth, SMALL);
        assert_eq!((small.channels, small.numbers, small.light, small.range), (1, "f32", false, Some([0.25, 0.75])));
        let none = made(Format::R16_SFLOAT, [1, 1], &f16::NAN.to_ne_bytes(), SMALL);
        assert_eq!((none.range, none.not_finite), (None, [1, 0]));
        assert_eq!(part(&name()), "mip level 1");
    }

    /// LV-5: a part is shown in full, each number as the image has it.
    #[test]
    fn lv_5_a_part_of_a_picture_has_the_bytes_of_its_texels() {
        let words: Vec<u32> = (0..64).map(|at| u32::MAX - at).collect();
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
        let part = made(Format::R32_UINT, [8, 8], &bytes, PictureSize { most: 64, region: Some([6, 1, 9, 2]) });
        assert_eq!((part.region, part.small, part.numbers), ([6, 1, 2, 2], [2, 2], "u32"));
        let expected: Vec<u8> = [14, 15, 22, 23].iter().flat_map(|at| words[*at].to_le_bytes()).collect();
        assert_eq!(BASE64_STANDARD.decode(&part.data).expect("base64"), expected);
        let bytes: Vec<u8> = (0..=255).collect();
        for format in [Format::R8G8B8A8_UNORM, Format::R8G8B8A8_SRGB] {
            let whole = made(format, [8, 8], &bytes, PictureSize { most: u32::MAX, region: None });
            assert_eq!(BASE64_STANDARD.decode(&whole.data).expect("base64"), bytes, "{format}");
        }
        // Ten bits don't fit into a byte.
        let bytes = 513_u32.to_ne_bytes();
        assert_eq!(made(Format::A2B10G10R10_UNORM_PACK32, [1, 1], &bytes, SMALL).numbers, "f32");
    }

    #[test]
    fn a_part_beside_the_picture_is_said_and_no_size_is_too_large() {
        let texels = PictureTexels { format: Format::R8_UNORM, size: [2, 2], columns: 1, bytes: &[1, 2, 3, 4] };
        for region in [[2, 0, 1, 1], [0, 2, 1, 1], [0, 0, 0, 1], [u32::MAX, u32::MAX, u32::MAX, u32::MAX]] {
            let wanted = PictureSize { most: 64, region: Some(region) };
            let why = Thumbnail::new(name(), texels, wanted).expect_err("no texel");
            assert!(why.ends_with("has no texel of a picture of 2×2"), "{why}");
        }
        assert_eq!(within([16384, 16384], MOST_SIDE, 4), [2048, 2048]);
        assert_eq!(within([100_000, 1], 128, 4), [128, 1]);
        assert_eq!(within([3, 5], 0, 1), [1, 1]);
    }
}
