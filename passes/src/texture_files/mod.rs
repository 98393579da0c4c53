//! Textures from files: pictures (PNG, JPEG, Radiance HDR, OpenEXR) and texture files (KTX2, DDS).

mod container;
mod dds;
mod decode;
mod ktx2;
mod limits;
mod pack;

pub use limits::{MOST_BYTES, MOST_SIDE, MOST_TEXELS};

use self::container::{Container, HEAD};
use self::limits::{MOST_DECODED, damaged};
use self::pack::pack;
use crate::open_exr::OpenExr;
use crate::srgb;
use framewright_graph::base::{NoFile, Root, is_of_machine};
use framewright_graph::frame::{
    ColorSpace, TextureFile, TextureInfo, TextureProblem, Textures, WantedTexels, format_problem, picture_extent,
};
use framewright_graph::vulkan::{Format, Numeric};
use image::codecs::hdr::HdrDecoder;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Seek};
use std::path::PathBuf;

/// Textures from files.
///
/// The bytes of a file decide its format, not its name. PNG of 8 bits and JPEG become `R8G8B8A8_SRGB` or `R8G8B8A8_UNORM`, PNG
/// of 16 bits `R16G16B16A16_UNORM`, HDR and EXR `R16G16B16A16_SFLOAT`; a frame may say `R32G32B32A32_SFLOAT` or any other
/// format of colour, of which the picture fills as many components as there are. KTX2 and DDS keep the format, levels and layers that
/// they have; where a device lacks the format, their texels are decoded.
#[derive(Debug, Clone)]
pub struct TextureFiles {
    root: Root,
}

/// A picture's values by texel: red, green, blue, alpha.
enum Texels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
    Floats(Vec<f32>),
}

/// A picture whose size is known, and whose texels aren't decoded yet.
enum OpenedPicture {
    OpenExr(OpenExr<BufReader<File>>),
    Other(Box<dyn ImageDecoder>, ImageFormat),
}

impl TextureFiles {
    /// Files that `root` lets be read.
    #[must_use]
    pub fn new(root: Root) -> TextureFiles {
        TextureFiles { root }
    }

    /// The bytes of a picture's file.
    ///
    /// # Errors
    /// If the file lies outside of the folder, can't be read or is too large.
    pub fn bytes(&self, path: &str) -> Result<Vec<u8>, TextureProblem> {
        let mut bytes = Vec::new();
        let file = self.root.open(&self.locate(path)?).map_err(unreadable)?;
        file.take(MOST_BYTES).read_to_end(&mut bytes).map_err(unreadable)?;
        Ok(bytes)
    }

    /// The file behind a path.
    fn locate(&self, path: &str) -> Result<PathBuf, TextureProblem> {
        let found = self.root.locate(path).map_err(|problem| match problem {
            NoFile::Outside { .. } => TextureProblem::Outside,
            NoFile::Unreadable { reason } => TextureProblem::Unreadable { reason },
            NoFile::Denied { reason } | NoFile::Machine { reason } => TextureProblem::Machine { reason },
            other => TextureProblem::Unreadable { reason: format!("it {other}") },
        })?;
        let bytes = fs::metadata(&found).map_err(unreadable)?.len();
        if bytes > MOST_BYTES {
            let reason = format!("it has {bytes} bytes, more than the {MOST_BYTES} of a texture");
            return Err(TextureProblem::Unreadable { reason });
        }
        Ok(found)
    }

    /// Opens a texture file; `None`: it is a picture, or nothing.
    fn container(&self, file: &TextureFile) -> Result<Option<Container>, TextureProblem> {
        let opened = self.root.open(&self.locate(&file.path)?).map_err(unreadable)?;
        let bytes = opened.metadata().map_err(unreadable)?.len();
        let mut head = Vec::new();
        opened.take(HEAD).read_to_end(&mut head).map_err(unreadable)?;
        let container = if head.starts_with(&::ktx2::MAGIC) {
            ktx2::open(&head)?
        } else if head.starts_with(b"DDS ") {
            dds::open(&head, file.color_space)?
        } else {
            return Ok(None);
        };
        container.check(bytes)?;
        Ok(Some(container))
    }

    /// Opens a picture whose size is within the limits.
    fn open(&self, path: &str) -> Result<OpenedPicture, TextureProblem> {
        let file = self.root.open(&self.locate(path)?).map_err(unreadable)?;
        let mut reader = ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(unreadable)?;
        let format = reader.format();
        let file = reader.into_inner();
        let opened = match format {
            Some(ImageFormat::OpenExr) => OpenedPicture::OpenExr(OpenExr::open(file).map_err(damaged)?),
            Some(format) => {
                reader = ImageReader::with_format(file, format);
                reader.limits(most_memory());
                OpenedPicture::Other(Box::new(reader.into_decoder().map_err(damaged)?), format)
            }
            None => OpenedPicture::Other(radiance(file)?, ImageFormat::Hdr),
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

impl OpenedPicture {
    fn extent(&self) -> [u32; 2] {
        match self {
            OpenedPicture::OpenExr(file) => file.extent,
            OpenedPicture::Other(decoder, _) => decoder.dimensions().into(),
        }
    }

    /// Texels that the file holds, of which not all need be shown.
    fn stored(&self) -> u64 {
        match self {
            OpenedPicture::OpenExr(file) => file.stored,
            OpenedPicture::Other(..) => 0,
        }
    }

    /// Whether it holds light in floating point.
    fn is_light(&self) -> bool {
        matches!(self, OpenedPicture::OpenExr(_) | OpenedPicture::Other(_, ImageFormat::Hdr))
    }

    fn texels(self) -> Result<Texels, TextureProblem> {
        let decoder = match self {
            OpenedPicture::OpenExr(file) => return file.texels().map(Texels::Floats).map_err(damaged),
            OpenedPicture::Other(decoder, _) => decoder,
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

impl Textures for TextureFiles {
    fn info(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        if let Some(container) = self.container(file)? {
            return Ok(container.info());
        }
        let opened = self.open(&file.path)?;
        let format = match (&opened, file.color_space) {
            _ if opened.is_light() => Format::R16G16B16A16_SFLOAT,
            (OpenedPicture::Other(decoder, _), _) if is_of_words(decoder.color_type()) => Format::R16G16B16A16_UNORM,
            (_, ColorSpace::Srgb) => Format::R8G8B8A8_SRGB,
            (_, ColorSpace::Linear) => Format::R8G8B8A8_UNORM,
        };
        check_space(opened.is_light(), file, format)?;
        Ok(TextureInfo::picture(opened.extent(), format))
    }

    fn texels(&mut self, file: &TextureFile, wanted: &WantedTexels) -> Result<Vec<u8>, TextureProblem> {
        if let Some(container) = self.container(file)? {
            return container.wanted(&self.bytes(&file.path)?, file, wanted);
        }
        let WantedTexels { format, extent, mips, layers } = *wanted;
        if mips > 1 || layers > 1 {
            let found = container::parts(extent, 1, 1);
            return Err(TextureProblem::Parts { found, expected: container::parts(extent, mips, layers) });
        }
        let opened = self.open(&file.path)?;
        check_space(opened.is_light(), file, format)?;
        let (found, expected) = (opened.extent(), picture_extent(extent));
        if expected != found {
            return Err(TextureProblem::Size { found, expected, strip: extent[2] > 1 });
        }
        let texels = opened.texels()?;
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

fn is_of_words(color: ColorType) -> bool {
    matches!(color, ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16)
}

fn unreadable(error: io::Error) -> TextureProblem {
    let reason = error.to_string();
    if is_of_machine(&error) { TextureProblem::Machine { reason } } else { TextureProblem::Unreadable { reason } }
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
