//! Images whose texels come from a file: their description in a frame, and the source of the texels.

use crate::frame::{Image, Lifetime};
use crate::vulkan::{Format, Numeric, Shape};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A file whose picture an image holds. Passes only sample it.
///
/// The picture of a three-dimensional image of N×N×N texels is a strip of N² × N: N squares from left to right, one for each
/// slice. In a colour table red runs to the right within a square, green downwards, and blue from square to square.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextureFile {
    /// Where it lies, from the folder on in which the frame's files are looked for; parts are divided by `/`.
    pub path: Arc<str>,
    /// The colour space of its values.
    pub color_space: ColorSpace,
}

/// The colour space of a picture's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum ColorSpace {
    /// Red, green and blue are encoded with the sRGB curve: pictures for people.
    #[default]
    Srgb,
    /// All components are as they are: light, tables, noise.
    Linear,
}

/// The properties of a picture that are known before its texels are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TextureInfo {
    /// Width and height in texels.
    pub extent: [u32; 2],
    /// The format that holds all of it that can be filtered everywhere, unless the frame chooses another.
    pub format: Format,
}

/// Why a file gives no texture. Text from files inside is not yet escaped.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TextureProblem {
    /// There is no such file, or it can't be read.
    #[error("can't be read: {reason}")]
    Unreadable {
        /// The system's words.
        reason: String,
    },
    /// The machine doesn't let it be read.
    #[error("can't be read: {reason}")]
    Machine {
        /// The system's words.
        reason: String,
    },
    /// The path leads out of the folder.
    #[error("leads out of the folder of the pipeline's files")]
    Outside,
    /// It is no picture of a kind that can be read, or damaged.
    #[error("is no picture that can be read: {reason}")]
    Damaged {
        /// The decoder's words.
        reason: String,
    },
    /// It is larger than textures may be.
    #[error("is {}×{}; a texture has at most {side} texels along a side, and {texels} in all", extent[0], extent[1])]
    TooLarge {
        /// Width and height in texels.
        extent: [u32; 2],
        /// The limit of each.
        side: u32,
        /// The limit of their product.
        texels: u64,
    },
    /// Its size doesn't fit the image's.
    #[error(
        "is {}×{}, and {}×{} are needed{}", found[0], found[1], expected[0], expected[1],
        if *strip { ": a strip of one square for each slice" } else { "" }
    )]
    Size {
        /// Width and height of the picture.
        found: [u32; 2],
        /// Those that the image needs.
        expected: [u32; 2],
        /// Whether the image is three-dimensional.
        strip: bool,
    },
    /// Its picture can't become such texels.
    #[error("can't become {format}: {why}")]
    Format {
        /// The image's format.
        format: Format,
        /// Why not.
        why: &'static str,
    },
    /// No provider of textures was given.
    #[error("can't be read: no textures are provided here")]
    NotProvided,
}

impl TextureProblem {
    /// Whether nothing is wrong with the file: the machine doesn't let it be read.
    #[must_use]
    pub fn is_of_machine(&self) -> bool {
        matches!(self, TextureProblem::Machine { .. })
    }
}

/// Where textures come from: files on disk, or a table in a test.
pub trait Textures {
    /// The properties of the file's picture, without its texels.
    ///
    /// # Errors
    /// [`TextureProblem`] says why it holds no texture.
    fn info(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem>;

    /// The texels of an image of this format and extent, slice after slice, rows from the top, without padding, in the
    /// machine's byte order. Red, green and blue are linear, but encoded in `_SRGB` formats.
    ///
    /// # Errors
    /// Those of [`Textures::info`], and where the picture doesn't fit.
    fn texels(&mut self, file: &TextureFile, format: Format, extent: [u32; 3]) -> Result<Vec<u8>, TextureProblem>;
}

/// Provides nothing, where no frame has textures.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoTextures;

impl Textures for NoTextures {
    fn info(&mut self, _: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        Err(TextureProblem::NotProvided)
    }

    fn texels(&mut self, _: &TextureFile, _: Format, _: [u32; 3]) -> Result<Vec<u8>, TextureProblem> {
        Err(TextureProblem::NotProvided)
    }
}

impl TextureInfo {
    /// Width, height and depth of the image that the picture makes.
    ///
    /// # Errors
    /// [`TextureProblem::Size`] if it is no strip and a three-dimensional image is wanted.
    pub fn image_extent(&self, shape: Shape) -> Result<[u32; 3], TextureProblem> {
        let [width, height] = self.extent;
        if shape != Shape::D3 {
            return Ok([width, height, 1]);
        }
        if u64::from(width) == u64::from(height) * u64::from(height) {
            return Ok([height; 3]);
        }
        Err(TextureProblem::Size { found: self.extent, expected: picture_extent([height; 3]), strip: true })
    }
}

/// Width and height of the picture for an image of this extent.
#[must_use]
pub const fn picture_extent([width, height, depth]: [u32; 3]) -> [u32; 2] {
    [width.saturating_mul(depth), height]
}

/// Why texels of such a file can't be held in `format`.
#[must_use]
pub fn format_problem(file: &TextureFile, format: Format) -> Option<&'static str> {
    if format.is_depth() {
        Some("a picture holds no depth")
    } else if format.is_integer() {
        Some("a picture holds no integers")
    } else if matches!(format, Format::A2B10G10R10_UNORM_PACK32 | Format::B10G11R11_UFLOAT_PACK32)
        || format.numeric() == Numeric::Snorm
    {
        Some("no picture is stored in this format")
    } else if format.numeric() == Numeric::Srgb && file.color_space == ColorSpace::Linear {
        Some("its values are linear, and the format decodes sRGB")
    } else {
        None
    }
}

impl Image {
    /// An image of one mip level, which holds the picture of a file that is like `info`.
    ///
    /// # Errors
    /// [`TextureProblem::Size`] if a three-dimensional image is wanted of a picture that is no strip.
    pub fn of_file(name: &str, file: TextureFile, info: &TextureInfo, shape: Shape) -> Result<Image, TextureProblem> {
        let [width, height, depth] = info.image_extent(shape)?;
        let flat = Image::new(name, info.format, width, height);
        Ok(Image { shape, extent: [width, height, depth], lifetime: Lifetime::File(Arc::new(file)), ..flat })
    }
}
