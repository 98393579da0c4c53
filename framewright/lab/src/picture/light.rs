//! Pictures read from files, as linear light.

use framewright_passes::decoder_words;
use framewright_passes::open_exr::OpenExr;
use framewright_passes::srgb;
use png::{BitDepth, ColorType, Decoder, Limits, Reader, Transformations};
use std::io::Cursor;

/// The bytes that a file begins with.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
const OPEN_EXR: [u8; 4] = exr::meta::magic_number::BYTES;

/// A picture has at most this many pixels: 8,192 on each side.
const MOST_PIXELS: u64 = 1 << 26;
/// Bytes that a PNG's decoder may take beside the picture.
const MOST_BESIDE: usize = 1 << 26;

/// A picture of linear light with the primaries of Rec. 709.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// Width and height in pixels.
    pub extent: [usize; 2],
    /// Red, green and blue, in rows from the top.
    pub texels: Vec<[f32; 3]>,
    /// Whether light isn't limited to what a display shows, from 0 to 1.
    pub is_light: bool,
    /// What else the file holds, in words.
    pub left_out: Vec<String>,
}

/// Why a file isn't a picture to compare.
#[derive(Debug, thiserror::Error)]
pub enum DecodingError {
    /// Neither signature.
    #[error("it is neither a PNG nor an OpenEXR file")]
    Neither,
    /// A size that no device draws.
    #[error("it has {width} × {height} pixels, and at most {MOST_PIXELS} are compared")]
    TooLarge {
        /// Its width.
        width: usize,
        /// Its height.
        height: usize,
    },
    /// A signal for HDR displays.
    #[error("it holds an HDR10 signal: write the picture before its encoding as an .exr file, and compare that")]
    Hdr10,
    /// An OpenEXR file of something else, such as depth.
    #[error("it has no colours: an OpenEXR picture has the channels R, G and B, or Y")]
    NoColors,
    /// The PNG decoder's words.
    #[error("{}", decoder_words(.0))]
    Png(#[from] png::DecodingError),
    /// The OpenEXR decoder's words.
    #[error("{0}")]
    OpenExr(String),
}

impl Light {
    /// Reads a file's contents. Alpha is left out, since what lies on a screen is opaque; that is noted where it isn't 1.
    ///
    /// # Errors
    /// If it is no PNG or OpenEXR file, is damaged, or is too large.
    pub fn decode(file: &[u8]) -> Result<Light, DecodingError> {
        if file.starts_with(PNG) {
            of_png(file)
        } else if file.starts_with(&OPEN_EXR) {
            of_exr(file)
        } else {
            Err(DecodingError::Neither)
        }
    }

    /// The width and height that a file's header says, however large. Nothing is decoded.
    ///
    /// # Errors
    /// Those of [`Light::decode`] that show there.
    pub fn extent_of(file: &[u8]) -> Result<[usize; 2], DecodingError> {
        if file.starts_with(PNG) {
            Ok(opened_png(file)?.1)
        } else if file.starts_with(&OPEN_EXR) {
            Ok(opened_exr(file)?.1)
        } else {
            Err(DecodingError::Neither)
        }
    }

    /// The picture rounded to the nearest of `steps` steps from black to white, in the curve of sRGB: as a file of integers holds it.
    #[must_use]
    pub fn in_steps(mut self, steps: u16) -> Light {
        let steps = f64::from(steps);
        #[allow(clippy::cast_possible_truncation, reason = "light is kept with as many bits as shaders have")]
        let rounded = |light: f32| srgb::decode((srgb::encode(light.into()) * steps).round() / steps) as f32;
        self.texels.iter_mut().flatten().for_each(|light| *light = rounded(*light));
        self
    }
}

type Png<'f> = Reader<Cursor<&'f [u8]>>;
type Exr<'f> = OpenExr<Cursor<&'f [u8]>>;

/// A PNG whose header was read, and its size.
fn opened_png(file: &[u8]) -> Result<(Png<'_>, [usize; 2]), DecodingError> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(file), Limits { bytes: MOST_BESIDE });
    decoder.set_transformations(Transformations::EXPAND);
    let reader = decoder.read_info()?;
    let extent = [reader.info().width, reader.info().height].map(|side| side as usize);
    Ok((reader, extent))
}

/// A PNG holds values in the curve of sRGB.
fn of_png(file: &[u8]) -> Result<Light, DecodingError> {
    let (mut reader, extent) = opened_png(file)?;
    sized(extent)?;
    let info = reader.info();
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

/// An OpenEXR file whose header was read, and its size.
fn opened_exr(file: &[u8]) -> Result<(Exr<'_>, [usize; 2]), DecodingError> {
    let opened = OpenExr::open(Cursor::new(file)).map_err(DecodingError::OpenExr)?;
    if !opened.is_color() {
        return Err(DecodingError::NoColors);
    }
    let extent = opened.extent.map(|side| side as usize);
    Ok((opened, extent))
}

/// An OpenEXR file holds linear light. If it has several layers, the first one with colours counts.
fn of_exr(file: &[u8]) -> Result<Light, DecodingError> {
    let (opened, extent) = opened_exr(file)?;
    sized(extent)?;
    sized([usize::try_from(opened.stored).unwrap_or(usize::MAX), 1])?;
    let (mut left_out, integers) = (opened.left_out.clone(), opened.integers);
    let texels = opened.texels().map_err(DecodingError::OpenExr)?;
    let (texels, _) = texels.as_chunks::<4>();
    if texels.iter().any(|texel| texel[3] != 1.0) {
        left_out.push("channel A".to_owned());
    }
    // 32-bit floats hold all integers up to here.
    if integers && texels.iter().flatten().any(|value| *value >= 16_777_216.0) {
        left_out.push("the last bits of integers above 16,777,216".to_owned());
    }
    let texels = texels.iter().map(|[red, green, blue, _]| [*red, *green, *blue]).collect();
    Ok(Light { extent, texels, is_light: true, left_out })
}

/// Makes sure that a picture isn't larger than what is compared.
fn sized([width, height]: [usize; 2]) -> Result<(), DecodingError> {
    let pixels = (width as u64).checked_mul(height as u64).filter(|pixels| *pixels <= MOST_PIXELS);
    if pixels.is_some() { Ok(()) } else { Err(DecodingError::TooLarge { width, height }) }
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
        assert!(matches!(sized([1 << 14, 1 << 13]), Err(DecodingError::TooLarge { .. })));
        assert!(matches!(sized([usize::MAX, 2]), Err(DecodingError::TooLarge { .. })));
    }
}
