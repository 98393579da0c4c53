//! Images whose texels come from a file: their description in a frame, and the source of the texels.

use crate::frame::{Image, Lifetime};
use crate::vulkan::{Format, Numeric, Shape, extent_at};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A file whose texels an image holds. Passes only sample it.
///
/// A picture (PNG, JPEG, HDR, EXR) is one level of two dimensions, which may be converted. A texture file (KTX2, DDS) holds mip
/// levels, layers, slices and cube faces as an image does. The picture of a three-dimensional image of N×N×N texels is a strip of N² × N: N squares from left to right, one for each
/// slice. In a colour table red runs to the right within a square, green downwards, and blue from square to square.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextureFile {
    /// Where it lies, from the folder on in which the frame's files are looked for; parts are divided by `/`.
    pub path: Arc<str>,
    /// The colour space of its values.
    pub color_space: ColorSpace,
    /// Whether it is a texture file, whose levels and layers are stored as an image's; else it is a picture.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub stored: bool,
}

impl TextureFile {
    /// A picture's file.
    #[must_use]
    pub fn picture(path: &str, color_space: ColorSpace) -> TextureFile {
        TextureFile { path: path.into(), color_space, stored: false }
    }
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

/// The properties of a texture that are known before its texels are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TextureInfo {
    /// Width, height and depth in texels. The depth of a picture is 1.
    pub extent: [u32; 3],
    /// Of a picture the format that holds all of it that can be filtered everywhere, unless the frame chooses another; of a texture
    /// file the format of its texels, in the colour space that was asked for.
    pub format: Format,
    /// Mip levels in the file.
    pub mips: u32,
    /// Array layers; of cubes six for each.
    pub layers: u32,
    /// Whether its layers are the faces of cubes.
    pub cube: bool,
    /// Whether it is a texture file: see [`TextureFile::stored`].
    pub stored: bool,
    /// The colour space that the file itself names, if it does.
    pub color_space: Option<ColorSpace>,
}

/// The texels that an image wants of its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WantedTexels {
    /// The image's format.
    pub format: Format,
    /// Its width, height and depth.
    pub extent: [u32; 3],
    /// Mip levels: 1 of a picture, since the device makes smaller ones.
    pub mips: u32,
    /// Array layers.
    pub layers: u32,
}

impl WantedTexels {
    /// Those of an image of one mip level and one layer.
    #[must_use]
    pub const fn picture(format: Format, extent: [u32; 3]) -> WantedTexels {
        WantedTexels { format, extent, mips: 1, layers: 1 }
    }

    /// Bytes of one layer of a mip level.
    #[must_use]
    pub fn level_bytes(&self, mip: u32) -> u64 {
        self.format.bytes(extent_at(self.extent, mip))
    }

    /// Bytes of all of them.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let levels = (0..self.mips.min(u32::BITS)).map(|mip| self.level_bytes(mip));
        levels.fold(0, u64::saturating_add).saturating_mul(self.layers.into())
    }
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
    /// It is no picture or texture of a kind that can be read, or damaged.
    #[error("is no picture that can be read: {reason}")]
    Damaged {
        /// The decoder's words.
        reason: String,
    },
    /// It is compressed with Basis Universal.
    #[error("holds Basis Universal ({what}), which has to be transcoded first; that isn't done yet")]
    Basis {
        /// The part of Basis Universal.
        what: &'static str,
    },
    /// It names another colour space than it is read in.
    #[error("says that its values are {}: leave `color_space` out", match named {
        ColorSpace::Srgb => "encoded with the sRGB curve",
        ColorSpace::Linear => "linear",
    })]
    ColorSpace {
        /// The colour space that it names.
        named: ColorSpace,
    },
    /// Its texels are in a format that no image can have here.
    #[error("holds {format}, which no image has here")]
    OtherFormat {
        /// The file's name or number of the format.
        format: String,
    },
    /// Its shape isn't the image's.
    #[error("holds {}, and {} is needed", shape_words(*found), shape_words(*expected))]
    Shape {
        /// The shape in the file.
        found: Shape,
        /// The image's.
        expected: Shape,
    },
    /// Its extent, mip levels or layers aren't those that the image has.
    #[error("holds {found}, and {expected} are needed")]
    Parts {
        /// What it holds, in words.
        found: String,
        /// The same words for the image.
        expected: String,
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
    /// It is of a kind whose reader was left out of this program.
    #[error("is {kind}, and this program was built without the feature `{feature}` of Framewright, which reads it")]
    LeftOut {
        /// The kind of the file, in words.
        kind: &'static str,
        /// The feature.
        feature: &'static str,
    },
    /// No provider of textures was given.
    #[error("can't be read: no textures are provided here")]
    NotProvided,
}

impl TextureProblem {
    /// Whether nothing is wrong with the file: the machine doesn't let it be read, or this program has no reader for it.
    #[must_use]
    pub fn is_of_machine(&self) -> bool {
        matches!(self, TextureProblem::Machine { .. } | TextureProblem::LeftOut { .. })
    }
}

/// Where textures come from: files on disk, or a table in a test.
pub trait Textures {
    /// The properties of the file's picture, without its texels.
    ///
    /// # Errors
    /// [`TextureProblem`] says why it holds no texture.
    fn info(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem>;

    /// The texels of an image: mip level after level, in each layer after layer, slice after slice, rows of texels or blocks from the
    /// top, without padding, in the machine's byte order. Red, green and blue are linear, but encoded in `_SRGB` formats.
    ///
    /// # Errors
    /// Those of [`Textures::info`], and where the picture doesn't fit.
    fn texels(&mut self, file: &TextureFile, wanted: &WantedTexels) -> Result<Vec<u8>, TextureProblem>;
}

/// Provides nothing, where no frame has textures.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoTextures;

impl Textures for NoTextures {
    fn info(&mut self, _: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        Err(TextureProblem::NotProvided)
    }

    fn texels(&mut self, _: &TextureFile, _: &WantedTexels) -> Result<Vec<u8>, TextureProblem> {
        Err(TextureProblem::NotProvided)
    }
}

impl TextureInfo {
    /// The properties of a picture.
    #[must_use]
    pub const fn picture([width, height]: [u32; 2], format: Format) -> TextureInfo {
        let extent = [width, height, 1];
        TextureInfo { extent, format, mips: 1, layers: 1, cube: false, stored: false, color_space: None }
    }

    /// The shape of an image that nobody chose another one for.
    #[must_use]
    pub const fn shape(&self) -> Shape {
        match self.extent {
            _ if self.cube => Shape::Cube,
            [_, _, 0 | 1] => Shape::D2,
            _ => Shape::D3,
        }
    }

    /// Width, height and depth of the image that the texture makes.
    ///
    /// # Errors
    /// [`TextureProblem::Size`] if a picture is no strip and a three-dimensional image is wanted, [`TextureProblem::Shape`] if
    /// another shape is wanted than the file has.
    pub fn image_extent(&self, shape: Shape) -> Result<[u32; 3], TextureProblem> {
        let [width, height, _] = self.extent;
        let found = self.shape();
        if shape == found {
            return Ok(self.extent);
        }
        if self.stored || shape == Shape::Cube {
            return Err(TextureProblem::Shape { found, expected: shape });
        }
        if u64::from(width) == u64::from(height) * u64::from(height) {
            return Ok([height; 3]);
        }
        let expected = picture_extent([height; 3]);
        Err(TextureProblem::Size { found: [width, height], expected, strip: true })
    }

    /// Why its texels can't be held in `format`, if `file` is the file that it tells of.
    #[must_use]
    pub fn format_problem(&self, file: &TextureFile, format: Format) -> Option<&'static str> {
        match format_problem(file, format) {
            None if self.stored && !becomes(self.format, format) => Some("the file holds another format"),
            problem => problem,
        }
    }
}

/// Width and height of the picture for an image of this extent.
#[must_use]
pub const fn picture_extent([width, height, depth]: [u32; 3]) -> [u32; 2] {
    [width.saturating_mul(depth), height]
}

/// The words for a texture of a shape.
const fn shape_words(shape: Shape) -> &'static str {
    match shape {
        Shape::Cube => "a cube",
        Shape::D2 => "a two-dimensional texture",
        Shape::D3 => "a three-dimensional texture",
    }
}

/// Whether texels that a file stores in one format can be converted into another one: it is the same, or they are numbers that
/// a picture could have, too.
#[must_use]
pub fn becomes(stored: Format, wanted: Format) -> bool {
    let packed = stored == Format::A2R10G10B10_UNORM_PACK32 && wanted == Format::A2B10G10R10_UNORM_PACK32;
    let is_alike = packed || stored.decoded() == Some(wanted) || not_in_pictures(wanted).is_none();
    stored == wanted || is_alike && !stored.is_integer() && !stored.is_depth()
}

/// Why no picture's texels can be held in `format`.
fn not_in_pictures(format: Format) -> Option<&'static str> {
    let packed = matches!(
        format,
        Format::A2R10G10B10_UNORM_PACK32
            | Format::A2B10G10R10_UNORM_PACK32
            | Format::B10G11R11_UFLOAT_PACK32
            | Format::E5B9G9R9_UFLOAT_PACK32
    );
    if format.is_depth() {
        Some("a picture holds no depth")
    } else if format.is_integer() {
        Some("a picture holds no integers")
    } else if format.is_compressed() {
        Some("only a texture file (KTX2, DDS) holds compressed texels")
    } else if packed || format.numeric() == Numeric::Snorm {
        Some("no picture is stored in this format")
    } else {
        None
    }
}

/// Why texels of such a file can't be held in `format`.
#[must_use]
pub fn format_problem(file: &TextureFile, format: Format) -> Option<&'static str> {
    match not_in_pictures(format) {
        Some(why) if !file.stored || format.is_depth() => Some(why),
        _ if format.numeric() == Numeric::Srgb && file.color_space == ColorSpace::Linear => {
            Some("its values are linear, and the format decodes sRGB")
        }
        _ => None,
    }
}

impl Image {
    /// An image that holds the texture of a file that is like `info`: one mip level of a picture, all of a texture file.
    ///
    /// # Errors
    /// Those of [`TextureInfo::image_extent`].
    pub fn of_file(name: &str, file: TextureFile, info: &TextureInfo, shape: Shape) -> Result<Image, TextureProblem> {
        let extent = info.image_extent(shape)?;
        let flat = Image::new(name, info.format, extent[0], extent[1]);
        let lifetime = Lifetime::File(Arc::new(TextureFile { stored: info.stored, ..file }));
        Ok(Image { shape, extent, mips: info.mips, layers: info.layers, lifetime, ..flat })
    }
}
