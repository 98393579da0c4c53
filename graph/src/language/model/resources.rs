//! Images and buffers as a pipeline file declares them: their properties and lifetimes.

use super::decisions::{Decided, Decisions};
use super::references::{BufferRef, ImageRef, ResourceRef};
use crate::base::Span;
use crate::expression::Property;
use crate::frame::{EyeForm, ResolveWay, Resource, TextureFile, ViewIndex};
use crate::ron::{Name, Spanned};
use crate::vulkan::{self, AccessKind, OutsideOwner};
use std::sync::Arc;

/// An image.
#[derive(Debug, Clone)]
pub struct Image {
    /// Unique name, among buffers too.
    pub name: Name,
    /// Texel format.
    pub format: Decided<Format>,
    /// Width and height, with the cause of the factor.
    pub size: Decided<Size>,
    /// The number of samples of each texel.
    pub samples: Decided<Samples>,
    /// How several samples become one value, if the file says it.
    pub resolve: Option<Resolves>,
    /// Mip levels.
    pub mips: Decided<Mips>,
    /// Array layers.
    pub layers: Decided<Layers>,
    /// Flat, deep, or a cube.
    pub shape: Decided<Shape>,
    /// How long its contents live.
    pub lifetime: Spanned<Lifetime>,
    /// The settings and facts that decided how often it is repeated.
    pub repeat: Decisions,
    /// Whether each eye has one of its own, if the file says so; `None`: as the image whose size it follows, else not.
    pub per_eye: Option<Spanned<bool>>,
    /// The form in which it holds both eyes' parts, if it does; no file says it.
    pub eyes: Option<EyeForm>,
    /// The view whose size `Output` and plain factors mean.
    pub view: ViewIndex,
    /// The fragment that it came with: an index into [`Pipeline::instances`](super::Pipeline::instances).
    pub instance: Option<u32>,
}

impl Image {
    /// The images that it follows in something.
    pub(crate) fn followed(&self) -> impl Iterator<Item = ImageRef> {
        let lifetime = match self.lifetime.value {
            Lifetime::Like(ResourceRef { resource: Resource::Image(index), span }) => Some(ImageRef { index, span }),
            _ => None,
        };
        let (format, size, samples) = (&self.format.value, &self.size.value, &self.samples.value);
        let properties = [format.follows(), size.follows(), samples.follows(), lifetime];
        properties.into_iter().chain([self.mips.value.follows(), self.layers.value.follows()]).flatten()
    }

    /// The decisions about a property, and the image that it follows in it, if it follows one.
    pub(crate) const fn decided(&self, property: Property) -> (&Decisions, Option<ImageRef>) {
        match property {
            Property::Width | Property::Height => (&self.size.by, self.size.value.follows()),
            Property::Mips => (&self.mips.by, self.mips.value.follows()),
            Property::Layers => (&self.layers.by, self.layers.value.follows()),
            Property::Samples => (&self.samples.by, self.samples.value.follows()),
        }
    }
}

impl Format {
    /// The image that it follows.
    pub(crate) const fn follows(&self) -> Option<ImageRef> {
        if let Format::Like(of) = self { Some(*of) } else { None }
    }
}

impl Size {
    /// The image that it follows.
    pub(crate) const fn follows(&self) -> Option<ImageRef> {
        match self {
            Size::Like(of) | Size::Scaled { of: Some(of), .. } | Size::Dynamic { of: Some(of), .. } => Some(*of),
            _ => None,
        }
    }
}

impl Samples {
    /// The image that it follows.
    pub(crate) const fn follows(&self) -> Option<ImageRef> {
        if let Samples::Like(of) = self { Some(*of) } else { None }
    }
}

impl Mips {
    /// The image that it follows.
    pub(crate) const fn follows(&self) -> Option<ImageRef> {
        if let Mips::Like(of) = self { Some(*of) } else { None }
    }
}

impl Layers {
    /// The image that it follows.
    pub(crate) const fn follows(&self) -> Option<ImageRef> {
        if let Layers::Like(of) = self { Some(*of) } else { None }
    }
}

/// How several samples become one value, and the words that say so.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolves {
    /// The way to resolve.
    pub resolve: Spanned<ResolveWay>,
    /// The words in the file, with their cause: "`resolve: Min` (quality = 'low')".
    pub said: Arc<str>,
}

/// The precision of all images of one purpose, and the words that say so.
#[derive(Debug, Clone, PartialEq)]
pub struct Precisions {
    /// The precision.
    pub precision: Precision,
    /// Where it is said.
    pub span: Span,
    /// The words in the file, with their cause: "`color: Smallest` (quality = 'low')".
    pub said: Arc<str>,
}

/// The precision of a format that is chosen by purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// The fewest bytes that will do.
    Smallest,
    /// As many bytes as are usually enough.
    Balanced,
    /// As many bytes as formats have.
    Exact,
}

/// A texel format, by purpose or by name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Format {
    /// Colour: `R16G16B16A16_SFLOAT` with high dynamic range, else `R8G8B8A8_SRGB`, unless the pipeline says otherwise.
    Color {
        /// Whether values above 1 are kept.
        hdr: bool,
        /// Whether alpha is kept.
        alpha: bool,
    },
    /// Depth: `D32_SFLOAT`, unless the pipeline says otherwise.
    Depth,
    /// Depth and stencil: `D32_SFLOAT_S8_UINT`, unless the pipeline says otherwise.
    DepthStencil,
    /// The format of images that leave the frame: `R8G8B8A8_SRGB`.
    Output,
    /// A format by Vulkan's name.
    Named(vulkan::Format),
    /// The format of another image.
    Like(ImageRef),
}

/// Width and height of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// The size of the image's view.
    Output,
    /// The size of the image's view or of another image, times a factor greater than 0; rounded down, at least 1.
    Scaled {
        /// The factor.
        by: f64,
        /// The image whose size is meant; `None`: the size of the view.
        of: Option<ImageRef>,
    },
    /// As `Scaled`, in an image that has room for a factor as large as `up_to`: the factor may be another one in each frame.
    Dynamic {
        /// The factor, at most `up_to`.
        by: f64,
        /// The greatest factor.
        up_to: f64,
        /// The image whose size is meant; `None`: the size of the view.
        of: Option<ImageRef>,
    },
    /// Width and height in texels, 1 to 16384 each.
    Fixed([u32; 2]),
    /// The size of another image.
    Like(ImageRef),
}

/// The number of samples of each texel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Samples {
    /// A number: 1, 2, 4, 8 or 16.
    Count(u32),
    /// As another image has.
    Like(ImageRef),
}

/// Mip levels of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mips {
    /// A number.
    Count(u32),
    /// Down to a single texel.
    Full,
    /// As another image has.
    Like(ImageRef),
}

/// Array layers of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Layers {
    /// One, or the six of a cube: the file says nothing.
    Default,
    /// A number; of a cube a multiple of 6.
    Count(u32),
    /// As another image has.
    Like(ImageRef),
}

/// The shape of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Two-dimensional, or an array of such layers.
    D2,
    /// Three-dimensional, with this depth in texels.
    D3(u32),
    /// Six square layers that may be sampled as a cube, or several times six.
    Cube,
}

/// A buffer.
#[derive(Debug, Clone)]
pub struct Buffer {
    /// Unique name, among images too.
    pub name: Name,
    /// Size in bytes.
    pub bytes: Decided<Bytes>,
    /// How long its contents live.
    pub lifetime: Spanned<Lifetime>,
    /// The fragment that it came with: an index into [`Pipeline::instances`](super::Pipeline::instances).
    pub instance: Option<u32>,
}

/// Size of a buffer, in bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bytes {
    /// A number, a multiple of 4.
    Count(u64),
    /// Bytes of one element, times a number of elements; rounded up to a multiple of 4.
    Times(u64, u64),
    /// Bytes of one texel, times the texels of an image's first mip level with layers and depth; rounded up to a multiple of 4.
    PerTexel(u64, ImageRef),
    /// As another buffer has.
    Like(BufferRef),
}

/// How long the contents of an image or buffer live.
#[derive(Debug, Clone, PartialEq)]
pub enum Lifetime {
    /// Within the frame.
    Transient,
    /// From frame to frame.
    Persistent {
        /// Contents in the first frame; `None`: zero.
        initial: Option<Spanned<Fill>>,
    },
    /// Contents of earlier frames can be read beside those that this frame writes.
    History {
        /// How many frames back, at least 1.
        frames: u32,
        /// Contents of frames before the first; `None`: zero.
        initial: Option<Spanned<Fill>>,
    },
    /// The embedding program hands it in.
    Imported {
        /// The state in which it is handed in.
        before: Spanned<State>,
        /// The state in which it is to be left, if the file asks for one.
        after: Option<Spanned<State>>,
        /// Who else than the device has it between frames.
        owner: Option<OutsideOwner>,
    },
    /// The contents come from a file: a texture's.
    File(Arc<TextureFile>),
    /// The lifetime of another image or buffer.
    Like(ResourceRef),
}

/// A value for all texels or words; its meaning depends on the image or buffer that it fills.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fill {
    /// Every component, the depth (and no stencil), or the word of a buffer.
    Number(f64),
    /// Depth and stencil.
    DepthStencil(f64, f64),
    /// Red, green, blue and alpha.
    Color([f64; 4]),
}

/// The last or next use of an image or buffer outside of the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum State {
    /// By purpose.
    Word(AccessKind),
    /// In Vulkan's words.
    Named(vulkan::State),
}
