//! Pictures: PNG, JPEG, Radiance HDR, OpenEXR.

use super::limits::{MOST_SIDE, MOST_TEXELS};
use super::pack::pack;
use super::words::{damaged, parts};
use super::{Reader, unreadable};
use crate::open_exr::OpenExr;
use crate::srgb;
use framewright_graph::frame::{
    ColorSpace, TextureFile, TextureInfo, TextureProblem, WantedTexels, format_problem, picture_extent,
};
use framewright_graph::vulkan::{Format, Numeric};
use image::codecs::hdr::HdrDecoder;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek};

/// Bytes that a decoder may take beside the file's own: what the largest picture takes with four 32-bit components.
const MOST_DECODED: u64 = MOST_TEXELS * 16 + (64 << 20);

/// Reads pictures.
pub(super) struct Pictures;

/// A picture's values by texel: red, green, blue, alpha.
enum Texels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
    Floats(Vec<f32>),
}

/// A picture whose size is known, and whose texels aren't decoded yet.
enum Picture {
    OpenExr(OpenExr<BufReader<File>>),
    Other(Box<dyn ImageDecoder>, ImageFormat),
}

impl Reader for Pictures {
    fn info(&self, opened: File, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        let picture = open(opened)?;
        let format = match (&picture, file.color_space) {
            _ if picture.is_light() => Format::R16G16B16A16_SFLOAT,
            (Picture::Other(decoder, _), _) if is_of_words(decoder.color_type()) => Format::R16G16B16A16_UNORM,
            (_, ColorSpace::Srgb) => Format::R8G8B8A8_SRGB,
            (_, ColorSpace::Linear) => Format::R8G8B8A8_UNORM,
        };
        check_space(picture.is_light(), file, format)?;
        Ok(TextureInfo::picture(picture.extent(), format))
    }

    fn texels(&self, opened: File, file: &TextureFile, wanted: &WantedTexels) -> Result<Vec<u8>, TextureProblem> {
        let WantedTexels { format, extent, mips, layers } = *wanted;
        if mips > 1 || layers > 1 {
            let found = parts(extent, 1, 1);
            return Err(TextureProblem::Parts { found, expected: parts(extent, mips, layers) });
        }
        let picture = open(opened)?;
        check_space(picture.is_light(), file, format)?;
        let (found, expected) = (picture.extent(), picture_extent(extent));
        if expected != found {
            return Err(TextureProblem::Size { found, expected, strip: extent[2] > 1 });
        }
        let texels = picture.texels()?;
        // Encoded values stay so where the format decodes them.
        let decodes = file.color_space == ColorSpace::Srgb && format.numeric() != Numeric::Srgb;
        let mut bytes = Vec::new();
        let [across, down, slices] = extent.map(|side| side as usize);
        for slice in 0..slices {
            for row in 0..down {
                for column in 0..across {
                    let at = (row * slices + slice) * across + column;
                    let [red, green, blue, alpha] = texels.at(at);
                    let color =
                        [red, green, blue].map(|value| if decodes { srgb::decode(value.into()) as f32 } else { value });
                    pack([color[0], color[1], color[2], alpha], format, &mut bytes)?;
                }
            }
        }
        Ok(bytes)
    }
}

/// Opens a picture whose size is within the limits.
fn open(file: File) -> Result<Picture, TextureProblem> {
    let mut reader = ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(unreadable)?;
    let format = reader.format();
    let file = reader.into_inner();
    let opened = match format {
        Some(ImageFormat::OpenExr) => Picture::OpenExr(OpenExr::open(file).map_err(damaged)?),
        Some(format) => {
            reader = ImageReader::with_format(file, format);
            reader.limits(most_memory());
            Picture::Other(Box::new(reader.into_decoder().map_err(damaged)?), format)
        }
        None => Picture::Other(radiance(file)?, ImageFormat::Hdr),
    };
    let (stored, [width, height]) = (opened.stored(), opened.extent());
    let texels = u64::from(width) * u64::from(height);
    if width == 0 || height == 0 {
        return Err(damaged("it is empty"));
    }
    if width.max(height) > MOST_SIDE || texels.max(stored) > MOST_TEXELS {
        return Err(TextureProblem::TooLarge { extent: [width, height], side: MOST_SIDE, texels: MOST_TEXELS });
    }
    Ok(opened)
}

/// The memory that a decoder may take.
fn most_memory() -> Limits {
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MOST_DECODED);
    limits
}

/// The decoder of a Radiance file that doesn't begin with `#?RADIANCE`: other programs write their own name there, such as `#?RGBE`.
fn radiance(mut file: BufReader<File>) -> Result<Box<dyn ImageDecoder>, TextureProblem> {
    const LONGEST: u64 = 80;
    let none = || damaged("neither PNG nor JPEG, HDR, EXR, KTX2 or DDS");
    file.rewind().map_err(unreadable)?;
    let mut first = Vec::new();
    file.by_ref().take(LONGEST).read_until(b'\n', &mut first).map_err(unreadable)?;
    let name = first.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&first).strip_prefix(b"#?").ok_or_else(none)?;
    if !name.ends_with(b"\n") {
        return Err(none());
    }
    // It stands behind its first line now.
    let whole = io::Cursor::new(b"#?RADIANCE\n").chain(file);
    let mut decoder = HdrDecoder::new(whole).map_err(damaged)?;
    decoder.set_limits(most_memory()).map_err(damaged)?;
    Ok(Box::new(decoder))
}

impl Picture {
    fn extent(&self) -> [u32; 2] {
        match self {
            Picture::OpenExr(file) => file.extent,
            Picture::Other(decoder, _) => decoder.dimensions().into(),
        }
    }

    /// Texels that the file holds, of which not all need be shown.
    fn stored(&self) -> u64 {
        match self {
            Picture::OpenExr(file) => file.stored,
            Picture::Other(..) => 0,
        }
    }

    /// Whether it holds light in floating point.
    fn is_light(&self) -> bool {
        matches!(self, Picture::OpenExr(_) | Picture::Other(_, ImageFormat::Hdr))
    }

    fn texels(self) -> Result<Texels, TextureProblem> {
        let decoder = match self {
            Picture::OpenExr(file) => return file.texels().map(Texels::Floats).map_err(damaged),
            Picture::Other(decoder, _) => decoder,
        };
        let decoded = DynamicImage::from_decoder(decoder).map_err(damaged)?;
        Ok(match decoded.color() {
            ColorType::L8 | ColorType::La8 | ColorType::Rgb8 | ColorType::Rgba8 => {
                Texels::Bytes(decoded.into_rgba8().into_raw())
            }
            words if is_of_words(words) => Texels::Words(decoded.into_rgba16().into_raw()),
            _ => Texels::Floats(decoded.into_rgba32f().into_raw()),
        })
    }
}

fn is_of_words(color: ColorType) -> bool {
    matches!(color, ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16)
}

/// Light in floating point is never encoded.
fn check_space(is_light: bool, file: &TextureFile, format: Format) -> Result<(), TextureProblem> {
    let why = if is_light && file.color_space == ColorSpace::Srgb {
        Some("HDR and EXR hold linear light: say `color_space: Linear`")
    } else {
        format_problem(file, format)
    };
    why.map_or(Ok(()), |why| Err(TextureProblem::Format { format, why }))
}

impl Texels {
    /// Red, green, blue and alpha of the texel number `at`, fixed-point values as 0…1.
    fn at(&self, at: usize) -> [f32; 4] {
        let four = [0, 1, 2, 3].map(|component| 4 * at + component);
        match self {
            Texels::Bytes(bytes) => four.map(|at| f32::from(bytes[at]) / 255.0),
            Texels::Words(words) => four.map(|at| f32::from(words[at]) / 65535.0),
            Texels::Floats(floats) => four.map(|at| floats[at]),
        }
    }
}
