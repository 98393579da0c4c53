//! Pictures read from files, as linear light.

use exr::prelude::{AnyChannels, FlatSamples, Layer, MetaData, ReadChannels, ReadLayers, read};
use framewright_passes::srgb;
use png::{BitDepth, ColorType, Decoder, Limits, Transformations};
use std::io::Cursor;

/// The bytes that a file begins with.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
const OPEN_EXR: [u8; 4] = exr::meta::magic_number::BYTES;

/// A picture has at most this many pixels: 16,384 on each side.
const MOST_PIXELS: u64 = 1 << 28;

/// A picture of linear light with the primaries of Rec. 709.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Light {
    /// Width and height in pixels.
    pub(crate) extent: [usize; 2],
    /// Red, green and blue, in rows from the top.
    pub(crate) texels: Vec<[f32; 3]>,
    /// Whether light isn't limited to what a display shows, from 0 to 1.
    pub(crate) is_light: bool,
    /// What else the file holds, in words.
    pub(crate) left_out: Vec<String>,
}

/// Why a file isn't a picture to compare.
#[derive(Debug, thiserror::Error)]
pub(crate) enum DecodingError {
    /// Neither signature.
    #[error("it is neither a PNG nor an OpenEXR file")]
    Neither,
    /// A size that no device draws.
    #[error("it has {width} × {height} pixels, and at most {MOST_PIXELS} are compared")]
    TooLarge { width: u64, height: u64 },
    /// A signal for HDR displays.
    #[error("it holds an HDR10 signal: write the picture before its encoding as an .exr file, and compare that")]
    Hdr10,
    /// An OpenEXR file of something else, such as depth.
    #[error("it has no colours: an OpenEXR picture has the channels R, G and B, or Y")]
    NoColors,
    /// The PNG decoder's words.
    #[error(transparent)]
    Png(#[from] png::DecodingError),
    /// The OpenEXR decoder's words.
    #[error(transparent)]
    OpenExr(#[from] exr::error::Error),
}

impl Light {
    /// Reads a file's contents. Alpha is left out, since what lies on a screen is opaque; that is noted where it isn't 1.
    ///
    /// # Errors
    /// If it is no PNG or OpenEXR file, is damaged, or is too large.
    pub(crate) fn decode(file: &[u8]) -> Result<Light, DecodingError> {
        if file.starts_with(PNG) {
            of_png(file)
        } else if file.starts_with(&OPEN_EXR) {
            of_exr(file)
        } else {
            Err(DecodingError::Neither)
        }
    }

    /// The picture rounded to the nearest of `steps` steps from black to white, in the curve of sRGB: as a file of integers holds it.
    #[must_use]
    pub(crate) fn in_steps(mut self, steps: u16) -> Light {
        let steps = f64::from(steps);
        #[allow(clippy::cast_possible_truncation, reason = "light is kept with as many bits as shaders have")]
        let rounded = |light: f32| srgb::decode((srgb::encode(light.into()) * steps).round() / steps) as f32;
        self.texels.iter_mut().flatten().for_each(|light| *light = rounded(*light));
        self
    }
}

/// A PNG holds values in the curve of sRGB.
fn of_png(file: &[u8]) -> Result<Light, DecodingError> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(file), Limits { bytes: usize::MAX });
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let info = reader.info();
    let extent = sized(info.width.into(), info.height.into())?;
    if info.coding_independent_code_points.is_some_and(|points| points.transfer_function == 16) {
        return Err(DecodingError::Hdr10);
    }
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or(0)];
    let info = reader.next_frame(&mut bytes)?;
    reader.finish()?;
    let (channels, depth) = (info.color_type.samples(), info.bit_depth);
    let grey = matches!(info.color_type, ColorType::Grayscale | ColorType::GrayscaleAlpha);
    #[allow(clippy::cast_possible_truncation, reason = "light is kept with as many bits as shaders have")]
    let light = |share: f64| srgb::decode(share) as f32;
    let values: Vec<f32> = match depth {
        BitDepth::Sixteen => {
            let samples = bytes.chunks_exact(2).map(|it| u16::from_be_bytes([it[0], it[1]]));
            samples.map(|sample| light(f64::from(sample) / 65535.0)).collect()
        }
        _ => bytes.iter().map(|sample| light(f64::from(*sample) / 255.0)).collect(),
    };
    let texels = values.chunks_exact(channels).map(|it| if grey { [it[0]; 3] } else { [it[0], it[1], it[2]] });
    let opaque = || values.chunks_exact(channels).all(|it| it[channels - 1] == 1.0);
    let left_out = if matches!(channels, 2 | 4) && !opaque() { vec!["alpha".to_owned()] } else { Vec::new() };
    Ok(Light { extent, texels: texels.take(extent[0] * extent[1]).collect(), is_light: false, left_out })
}

/// An OpenEXR file holds linear light. Of several layers the first one counts.
fn of_exr(file: &[u8]) -> Result<Light, DecodingError> {
    let headers = MetaData::read_from_buffered(Cursor::new(file), false)?.headers;
    for header in &headers {
        sized(header.layer_size.width() as u64, header.layer_size.height() as u64)?;
    }
    let layers = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = layers.non_parallel().from_buffered(Cursor::new(file))?;
    let Layer { size, channel_data: AnyChannels { list }, .. } = image.layer_data;
    let channel = |name: &str| list.iter().find(|it| it.name.eq(name)).map(|it| &it.sample_data);
    let values = |samples: &FlatSamples| samples.values_as_f32().collect::<Vec<f32>>();
    let (texels, seen): (Vec<[f32; 3]>, &[&str]) = match (["R", "G", "B"].map(channel), channel("Y")) {
        ([Some(red), Some(green), blue], _) => {
            let (red, green) = (values(red).into_iter(), values(green));
            // An image of two components has no blue.
            let blue = blue.map_or_else(|| vec![0.0; green.len()], values);
            (red.zip(green).zip(blue).map(|((red, green), blue)| [red, green, blue]).collect(), &["R", "G", "B"])
        }
        (_, Some(grey)) => (values(grey).into_iter().map(|grey| [grey; 3]).collect(), &["Y"]),
        _ => return Err(DecodingError::NoColors),
    };
    let is_one = |samples: &FlatSamples| samples.values_as_f32().all(|value| value == 1.0);
    let others = list.iter().filter(|it| seen.iter().all(|name| !it.name.eq(name)));
    let others = others.filter(|it| !(it.name.eq("A") && is_one(&it.sample_data)));
    let mut left_out: Vec<String> = others.map(|it| format!("channel {}", it.name)).collect();
    let rounded = |it: &exr::prelude::AnyChannel<FlatSamples>| match &it.sample_data {
        FlatSamples::U32(values) => values.iter().any(|value| *value > 1 << 24),
        _ => false,
    };
    if list.iter().any(rounded) {
        left_out.push("the last bits of integers above 16,777,216".to_owned());
    }
    if headers.len() > 1 {
        left_out.push(format!("{} of {} layers", headers.len() - 1, headers.len()));
    }
    Ok(Light { extent: [size.width(), size.height()], texels, is_light: true, left_out })
}

fn sized(width: u64, height: u64) -> Result<[usize; 2], DecodingError> {
    let pixels = width.checked_mul(height).filter(|pixels| *pixels <= MOST_PIXELS);
    match (pixels, usize::try_from(width), usize::try_from(height)) {
        (Some(_), Ok(width), Ok(height)) => Ok([width, height]),
        _ => Err(DecodingError::TooLarge { width, height }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Picture};
    use super::*;
    use framewright_graph::vulkan::Format;

    fn written(file_format: FileFormat, format: Format, extent: [u32; 2], bytes: &[u8]) -> Vec<u8> {
        file_format.encode(&Picture { format, encoding: None, extent, bytes }).expect("a file")
    }

    #[test]
    fn what_was_written_is_read_as_the_same_light() {
        let file = written(FileFormat::Png, Format::R8G8B8A8_SRGB, [2, 1], &[0, 188, 255, 9, 255, 0, 10, 9]);
        let light = Light::decode(&file).expect("a picture");
        assert_eq!((light.extent, light.is_light), ([2, 1], false));
        assert!((light.texels[0][1] - 0.503).abs() < 1e-3 && light.texels[1][0] == 1.0, "{light:?}");
        let floats = [0.5_f32, -2.0, f32::INFINITY, 1.0].map(f32::to_ne_bytes).concat();
        let file = written(FileFormat::OpenExr, Format::R32G32B32A32_SFLOAT, [1, 1], &floats);
        let light = Light::decode(&file).expect("a picture");
        assert_eq!(
            light,
            Light { extent: [1, 1], texels: vec![[0.5, -2.0, f32::INFINITY]], is_light: true, left_out: Vec::new() }
        );
        let grey = written(FileFormat::OpenExr, Format::R32_SFLOAT, [1, 1], &0.25_f32.to_ne_bytes());
        assert_eq!(Light::decode(&grey).expect("a picture").texels, [[0.25; 3]]);
        let grey = written(FileFormat::Png, Format::R8_UNORM, [1, 1], &[255]);
        assert_eq!(Light::decode(&grey).expect("a picture").texels, [[1.0; 3]]);
    }

    #[test]
    fn light_is_rounded_to_the_nearest_step() {
        let steps = |light: f64| srgb::decode(light / 255.0) as f32;
        let texels = vec![[steps(10.4), steps(10.6), steps(254.6)], [0.0, 1.0, f32::NAN]];
        let rounded = Light { extent: [2, 1], texels, is_light: false, left_out: Vec::new() }.in_steps(255).texels;
        assert_eq!(rounded[0], [steps(10.0), steps(11.0), steps(255.0)]);
        assert!(rounded[1][..2] == [0.0, 1.0] && rounded[1][2].is_nan(), "{rounded:?}");
        // A file holds what was rounded as it is.
        let bytes: Vec<u8> = rounded[0].iter().chain(&[1.0]).flat_map(|light| light.to_ne_bytes()).collect();
        let file = written(FileFormat::Png, Format::R32G32B32A32_SFLOAT, [1, 1], &bytes);
        assert_eq!(Light::decode(&file).expect("a picture").texels[0], rounded[0]);
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let problem = |file: &[u8]| Light::decode(file).expect_err("no picture").to_string();
        assert_eq!(problem(b"hello"), "it is neither a PNG nor an OpenEXR file");
        assert_eq!(problem(b""), "it is neither a PNG nor an OpenEXR file");
        let depth = written(FileFormat::OpenExr, Format::D32_SFLOAT, [1, 1], &0.25_f32.to_ne_bytes());
        assert!(problem(&depth).starts_with("it has no colours"), "{}", problem(&depth));
        for file in [depth, written(FileFormat::Png, Format::R8_UNORM, [4, 4], &[7; 16])] {
            (0..file.len()).for_each(|length| assert!(Light::decode(&file[..length]).is_err(), "{length}"));
        }
        assert!(matches!(sized(1 << 15, 1 << 14), Err(DecodingError::TooLarge { .. })));
        assert!(matches!(sized(u64::MAX, 2), Err(DecodingError::TooLarge { .. })));
    }
}
