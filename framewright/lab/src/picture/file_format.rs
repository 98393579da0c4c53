//! The formats of picture files.

use super::data::{EncodingError, Picture};
use super::{exr, png, texel, values};
use framewright_graph::vulkan::{Aspects, Encoding, Format, Numeric};
use std::path::Path;

/// The format of a picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileFormat {
    /// Portable Network Graphics.
    Png,
    /// OpenEXR.
    OpenExr,
}

impl FileFormat {
    /// The format that a file's name ends with.
    #[must_use]
    pub fn of(path: &Path) -> Option<FileFormat> {
        let extension = path.extension()?;
        if extension.eq_ignore_ascii_case("png") {
            Some(FileFormat::Png)
        } else {
            extension.eq_ignore_ascii_case("exr").then_some(FileFormat::OpenExr)
        }
    }

    /// Whether it can hold images of the format.
    #[must_use]
    pub fn holds(self, format: Format) -> bool {
        self == FileFormat::Png || exr::holds(format)
    }

    /// Encodes a picture.
    ///
    /// # Errors
    /// If there are too few texels, the file format can't hold the format, or the encoder fails.
    pub fn encode(self, picture: &Picture<'_>) -> Result<Vec<u8>, EncodingError> {
        match self {
            FileFormat::Png => png::write(picture),
            FileFormat::OpenExr => exr::write(picture),
        }
    }

    /// What the file changes in an image or leaves out of it, in words, one after the other.
    #[must_use]
    pub fn losses(self, picture: &Picture<'_>) -> Vec<&'static str> {
        let format = picture.format;
        let mut losses = Vec::new();
        losses.extend(match format.numeric() {
            _ if self == FileFormat::OpenExr => {
                exr::wraps(format, picture.bytes).then_some("negative integers are 2³² more")
            }
            _ if format.is_depth() => Some("the nearest texel is white"),
            Numeric::Sfloat | Numeric::Ufloat => Some("values outside 0…1 are clamped"),
            Numeric::Uint => Some("values above 255 are clamped"),
            Numeric::Sint => Some("values below 0 and above 255 are clamped"),
            Numeric::Snorm => Some("values below 0 are clamped"),
            _ => None,
        });
        if format.aspects().contains(Aspects::DEPTH | Aspects::STENCIL) {
            losses.push("the stencil is left out");
        }
        let see_through = |texel: &[u8]| values::values(format, texel)[3] != 1.0;
        if self == FileFormat::Png
            && values::components(format) == 4
            && picture.bytes.chunks_exact(texel::bytes(format)).any(see_through)
        {
            let is_integer = format.is_integer();
            losses.push(if is_integer {
                "the fourth component is left out"
            } else {
                "alpha is left out, which isn't 1"
            });
        }
        losses
    }
}

/// Steps from black to white in the picture file of an output; `None` if it holds light without an upper end. What isn't encoded is written
/// with 8 bits, as a display shows it.
#[must_use]
pub fn steps(format: Format, encoding: Option<Encoding>) -> Option<u16> {
    match format {
        _ if FileFormat::OpenExr.holds(format) => None,
        Format::A2R10G10B10_UNORM_PACK32 | Format::A2B10G10R10_UNORM_PACK32 if encoding.is_some() => Some(1023),
        Format::R16_UNORM | Format::R16G16_UNORM | Format::R16G16B16A16_UNORM if encoding.is_some() => Some(u16::MAX),
        _ => Some(255),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::vulkan::Format::*;

    fn png(
        format: Format,
        encoding: Option<Encoding>,
        extent: [u32; 2],
        bytes: &[u8],
    ) -> Result<Vec<u8>, EncodingError> {
        FileFormat::Png.encode(&Picture { format, encoding, extent, bytes })
    }

    #[test]
    fn pictures_have_the_steps_of_their_files() {
        for (format, encoding, bits) in [
            (R8G8B8A8_SRGB, None, Some(8)),
            (R8_UNORM, None, Some(8)),
            (A2B10G10R10_UNORM_PACK32, Some(Encoding::Srgb), Some(10)),
            (A2B10G10R10_UNORM_PACK32, None, Some(8)),
            (R16G16B16A16_UNORM, Some(Encoding::Srgb), Some(16)),
            (R16G16B16A16_SFLOAT, None, None),
        ] {
            assert_eq!(steps(format, encoding), bits.map(|bits| u16::MAX >> (16 - bits)), "{format:?}");
        }
    }

    fn decoded(file: &[u8]) -> image::DynamicImage {
        image::load_from_memory(file).expect("a PNG")
    }

    /// The bytes of a chunk; `None` if the file has none of that name.
    fn chunk<'f>(file: &'f [u8], name: &[u8; 4]) -> Option<&'f [u8]> {
        let mut rest = file.strip_prefix(b"\x89PNG\r\n\x1a\n").expect("a PNG");
        while let Some((header, after)) = rest.split_first_chunk::<8>() {
            let length = u32::from_be_bytes([header[0], header[1], header[2], header[3]]) as usize;
            if header[4..] == *name {
                return Some(&after[..length]);
            }
            rest = &after[length + 4..];
        }
        None
    }

    #[test]
    fn the_nearest_depth_is_white_and_infinitely_far_is_black() {
        let depths: Vec<u8> = [0.02_f32, 0.01, 0.0].iter().flat_map(|depth| depth.to_ne_bytes()).collect();
        let file = png(D32_SFLOAT, None, [3, 1], &depths).expect("a picture");
        assert_eq!(decoded(&file).into_luma8().into_raw(), [255, 188, 0]);
        let nothing = png(D32_SFLOAT, None, [1, 1], &[0; 4]).expect("a picture");
        assert_eq!(decoded(&nothing).into_luma8().into_raw(), [0]);
    }

    #[test]
    fn every_format_gives_a_picture_of_its_size_in_every_encoding_that_fits() {
        let all = [Encoding::Srgb, Encoding::Unorm, Encoding::Linear, Encoding::Hdr10];
        for format in Format::ALL.iter().filter(|format| !format.is_compressed()) {
            let texels = vec![0x3f; texel::bytes(*format) * 6];
            for encoding in all.into_iter().filter(|it| it.fits(*format)).map(Some).chain([None]) {
                let file = png(*format, encoding, [3, 2], &texels).expect("a picture");
                let picture = decoded(&file);
                assert_eq!((picture.width(), picture.height()), (3, 2), "{format}");
            }
            let file = FileFormat::OpenExr.encode(&Picture {
                format: *format,
                encoding: None,
                extent: [3, 2],
                bytes: &texels,
            });
            assert_eq!(file.is_ok(), FileFormat::OpenExr.holds(*format), "{format}");
        }
    }

    #[test]
    fn what_is_encoded_stays_as_it_is_and_the_file_says_how() {
        let shown = |format, encoding, bytes: &[u8]| {
            let file = png(format, encoding, [1, 1], bytes).expect("a picture");
            let [srgb, hdr10] = [b"sRGB", b"cICP"].map(|name| chunk(&file, name).map(<[u8]>::to_vec));
            (decoded(&file), srgb.is_some(), hdr10)
        };
        let bytes = |picture: image::DynamicImage| picture.into_rgb8().into_raw();
        let (picture, srgb, hdr10) = shown(R8G8B8A8_SRGB, None, &[1, 2, 3, 4]);
        assert_eq!((bytes(picture), srgb, hdr10), (vec![1, 2, 3], true, None));
        let (picture, srgb, hdr10) = shown(B8G8R8A8_UNORM, Some(Encoding::Srgb), &[1, 2, 3, 4]);
        assert_eq!((bytes(picture), srgb, hdr10), (vec![3, 2, 1], true, None));
        let (picture, srgb, hdr10) = shown(R8G8B8A8_UNORM, Some(Encoding::Unorm), &[1, 2, 3, 4]);
        assert_eq!((bytes(picture), srgb, hdr10), (vec![1, 2, 3], false, None));
        // UNORM without an encoding is linear light, which the picture shows.
        let (picture, srgb, hdr10) = shown(R8G8B8A8_UNORM, None, &[128, 0, 255, 4]);
        assert_eq!((bytes(picture), srgb, hdr10), (vec![188, 0, 255], true, None));
        // ITU-T H.273: primaries 9, transfer 16, matrix 0; PNG: full range 1.
        let word = 1023 | (512 << 10) | (1 << 20) | (3_u32 << 30);
        let (picture, srgb, hdr10) = shown(A2B10G10R10_UNORM_PACK32, Some(Encoding::Hdr10), &word.to_ne_bytes());
        assert_eq!(picture.color(), image::ColorType::Rgb16);
        let expected = [1023.0, 512.0, 1.0].map(|value: f64| (value * 65535.0 / 1023.0).round() as u16);
        assert_eq!(picture.into_rgb16().into_raw(), expected);
        assert_eq!((srgb, hdr10), (false, Some(vec![9, 16, 0, 1])));
        let shorts = [1_u16, 2, 65535, 7].map(u16::to_ne_bytes).concat();
        let (picture, ..) = shown(R16G16B16A16_UNORM, Some(Encoding::Hdr10), &shorts);
        assert_eq!(picture.into_rgb16().into_raw(), [1, 2, 65535]);
    }

    #[test]
    fn too_few_texels_are_refused() {
        assert!(matches!(png(R8G8B8A8_SRGB, None, [2, 2], &[0; 12]), Err(EncodingError::TooFew)));
    }
}
