//! What a pipeline file says of an image or a buffer: what it is like, and how long it lives.

use super::decided::Decided;
use super::references::{BufferRef, ImageRef, ResourceRef};
use crate::base::Span;
use crate::frame::{EyeForm, ResolveWay, TextureFile, ViewIndex};
use crate::ron::{Name, Spanned};
use crate::vulkan;
use std::sync::Arc;

/// An image.
#[derive(Debug, Clone)]
pub struct Image {
    /// Unique name, among buffers too.
    pub name: Name,
    /// Texel format.
    pub format: Decided<Format>,
    /// Width and height, with what decided the factor.
    pub size: Decided<Size>,
    /// Samples a texel.
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
    /// Whether each eye has one of its own, if the file says so; `None`: as the image whose size it follows, else not.
    pub per_eye: Option<Spanned<bool>>,
    /// How it holds both eyes' parts, if it does; no file says it.
    pub eyes: Option<EyeForm>,
    /// The view whose size `Output` and plain factors mean.
    pub view: ViewIndex,
    /// The fragment that it came with: an index into [`Pipeline::instances`](super::Pipeline::instances).
    pub instance: Option<u32>,
}

/// How several samples become one value, and who says so.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolves {
    /// How.
    pub resolve: Spanned<ResolveWay>,
    /// What says so, with what decided it: "`resolve: Min` (quality = 'low')".
    pub said: Arc<str>,
}

/// How exactly images of a purpose hold what they are asked to, and who says so.
#[derive(Debug, Clone, PartialEq)]
pub struct Precisions {
    /// How exactly.
    pub precision: Precision,
    /// Where it is said.
    pub span: Span,
    /// What says so, with what decided it: "`color: Smallest` (quality = 'low')".
    pub said: Arc<str>,
}

/// How exactly an image holds what it is asked to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// In as few bytes as will do.
    Smallest,
    /// In as many as are usually enough.
    Balanced,
    /// In as many as there are.
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
    /// What leaves the frame: `R8G8B8A8_SRGB`.
    Output,
    /// Vulkan's name.
    Named(vulkan::Format),
    /// That of another image.
    Like(ImageRef),
}

/// Width and height of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// That of the image's view.
    Output,
    /// That of the image's view or of another image, times a factor greater than 0; rounded down, at least 1.
    Scaled {
        /// The factor.
        by: f64,
        /// Of which image; `None`: of the view.
        of: Option<ImageRef>,
    },
    /// As `Scaled`, in an image that has room for a factor as large as `up_to`: the factor may be another one in each frame.
    Dynamic {
        /// The factor, at most `up_to`.
        by: f64,
        /// The greatest factor.
        up_to: f64,
        /// Of which image; `None`: of the view.
        of: Option<ImageRef>,
    },
    /// Width and height in texels, 1 to 16384 each.
    Fixed([u32; 2]),
    /// That of another image.
    Like(ImageRef),
}

/// Samples a texel.
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
    /// Bytes of one texel, times the number of texels of an image's first mip level, layers and depth included; rounded up to a multiple of 4.
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
        /// What the first frame finds; `None`: zero.
        initial: Option<Spanned<Fill>>,
    },
    /// What earlier frames left can be read beside what this one writes.
    History {
        /// How many frames back, at least 1.
        frames: u32,
        /// What stands for frames before the first; `None`: zero.
        initial: Option<Spanned<Fill>>,
    },
    /// The embedding program hands it in.
    Imported {
        /// In which state.
        before: Spanned<State>,
        /// In which state it is to be left, if the file asks for one.
        after: Option<Spanned<State>>,
    },
    /// They come from a file: a texture's.
    File(Arc<TextureFile>),
    /// As long as those of another image or buffer.
    Like(ResourceRef),
}

/// A value for all texels or words; what it means is up to what it fills.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fill {
    /// Every component, the depth (and no stencil), or the word of a buffer.
    Number(f64),
    /// Depth and stencil.
    DepthStencil(f64, f64),
    /// Red, green, blue and alpha.
    Color([f64; 4]),
}

/// The last or next use of what comes from outside of the frame or leaves it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum State {
    /// By purpose.
    Word(StateWord),
    /// In Vulkan's words.
    Named(vulkan::State),
}

/// The purposes that a state may be named by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateWord {
    /// An image without contents.
    Undefined,
    /// Drawn into as colour.
    ColorAttachment,
    /// Drawn into as depth or stencil.
    DepthAttachment,
    /// Sampled by shaders.
    Sampled,
    /// Read and written by shaders.
    Storage,
    /// Read as a uniform block.
    Uniform,
    /// Read as vertex attributes.
    Vertex,
    /// Read as indices.
    Index,
    /// Read as counts of draws and dispatches.
    Indirect,
    /// Source of copies and blits.
    TransferSource,
    /// Target of copies, blits and clears.
    TransferTarget,
    /// Shown in a window.
    Present,
    /// Written by the host before the frame, or read by it afterwards.
    Host,
}
