//! One flat frame: what a pipeline file says once settings, conditions, facts and sizes are put in.
//!
//! This is what [`crate::compile`] reads. It still says only *what*: no barrier, layout, load or store operation, resolve
//! or alias. It is plain data, so an embedding program may also build it without any file.

use crate::format::Format;
use crate::source::{Sources, Span};
use crate::texture::TextureFile;
use crate::view::{View, ViewIndex};
use crate::vocabulary::{Aspects, CompareOp, FillValue, Filter, Sampler, Stages, State, StencilOp, Subresources};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Index of an image in [`Frame::images`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ImageIndex(pub u32);

/// Index of a buffer in [`Frame::buffers`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BufferIndex(pub u32);

/// An image or a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Resource {
    /// An image.
    Image(ImageIndex),
    /// A buffer.
    Buffer(BufferIndex),
}

/// A frame: images, buffers, passes in the order that gives them meaning, outputs.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// The texts that spans point into.
    pub sources: Arc<Sources>,
    /// The settings in force, by name, as they are shown.
    pub settings: Vec<(Arc<str>, String)>,
    /// The views, the main one first. None: one that is the scene's default camera's.
    pub views: Vec<View>,
    /// The images that passes name.
    pub images: Vec<Image>,
    /// The buffers that passes name.
    pub buffers: Vec<Buffer>,
    /// Passes in file order. A pass reads the version of an image that stands *before itself*.
    pub passes: Vec<Pass>,
    /// Images and buffers whose last version the frame is made for.
    pub outputs: Vec<Output>,
    /// Passes that conditions switched off, and why.
    pub switched_off: Vec<SwitchedOff>,
}

/// An image of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// Texel format.
    pub format: Format,
    /// Flat, deep, or a cube.
    pub shape: Shape,
    /// Width, height, depth in texels, each at least 1.
    pub extent: [u32; 3],
    /// Mip levels, at least 1.
    pub mips: u32,
    /// Array layers, at least 1; of a cube 6 for each.
    pub layers: u32,
    /// Samples a texel that were asked for: 1, 2, 4, 8 or 16. `adapt` lowers it to what the device has.
    pub samples: u32,
    /// How long its contents live.
    pub lifetime: Lifetime,
}

impl Image {
    /// A flat transient image of one mip level, one layer and one sample, that no file declares.
    #[must_use]
    pub fn new(name: &str, format: Format, width: u32, height: u32) -> Image {
        Image {
            name: name.into(),
            span: Span::NONE,
            format,
            shape: Shape::D2,
            extent: [width, height, 1],
            mips: 1,
            layers: 1,
            samples: 1,
            lifetime: Lifetime::Transient,
        }
    }
}

/// The shape of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Shape {
    /// Two-dimensional, or an array of such layers.
    #[default]
    D2,
    /// Three-dimensional.
    D3,
    /// Six square layers that may be sampled as a cube, or several times six.
    Cube,
}

/// A buffer of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Buffer {
    /// Unique name, among images too.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// Bytes, at least 1.
    pub bytes: u64,
    /// How long its contents live. A fill value is its bits in the first component.
    pub lifetime: Lifetime,
}

/// How long the contents of an image or a buffer live.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Lifetime {
    /// Within the frame.
    #[default]
    Transient,
    /// From frame to frame: a read before the first write finds what the frame before left.
    Persistent {
        /// What the first frame finds.
        initial: FillValue,
    },
    /// Each frame writes it anew; what earlier frames left can be read beside it (`frames_ago`).
    History {
        /// How many frames back it can be read, at least 1.
        frames: u32,
        /// What stands for frames before the first.
        initial: FillValue,
    },
    /// It belongs to the embedding program, which hands it in for each frame.
    Imported {
        /// The state in which it is handed in. An image in the layout `Undefined` has no contents to read.
        before: State,
        /// The state in which it is to be left; `None`: that of its last use, which the Plan says.
        after: Option<State>,
    },
    /// An image whose contents come from a file before the first frame, and which is only sampled.
    File(Arc<TextureFile>),
}

/// An image or buffer that leaves the frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Which one.
    pub resource: Resource,
    /// Where it was named.
    pub span: Span,
    /// The state in which it is to be left; `None`: that of its last use, which the Plan says.
    pub after: Option<State>,
}

/// A pass that a condition switched off.
#[derive(Debug, Clone, PartialEq)]
pub struct SwitchedOff {
    /// Its name.
    pub name: Arc<str>,
    /// Where the condition stands.
    pub span: Span,
    /// The condition with its value: "tone_mapping = false".
    pub because: String,
}

/// One pass.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// The view that it draws for.
    pub view: ViewIndex,
    /// What it does.
    pub work: Work,
    /// Images that its shaders sample.
    pub sampled: Vec<Sampled>,
    /// Images that its shaders write (and perhaps read) without attachments.
    pub storage: Vec<Storage>,
    /// Colour attachments by location.
    pub color: Vec<ColorTarget>,
    /// Depth (and stencil) attachment.
    pub depth: Option<DepthTarget>,
    /// Buffers that it reads or writes by anything but a copy or fill.
    pub buffers: Vec<BufferUse>,
    /// What a copy, blit, fill or custom pass reads and writes by transfer: source before target.
    pub transfers: Vec<TransferUse>,
    /// Whether it has an effect that no image or buffer shows: it is never culled.
    pub side_effect: bool,
    /// Values for the shader's parameter block, by member name.
    pub params: Vec<(Arc<str>, ParamValue)>,
}

impl Pass {
    /// A pass that touches nothing yet, and that no file declares.
    #[must_use]
    pub fn new(name: &str, work: Work) -> Pass {
        Pass {
            name: name.into(),
            span: Span::NONE,
            view: ViewIndex::default(),
            work,
            sampled: Vec::new(),
            storage: Vec::new(),
            color: Vec::new(),
            depth: None,
            buffers: Vec::new(),
            transfers: Vec::new(),
            side_effect: false,
            params: Vec::new(),
        }
    }
}

/// What a pass does.
#[derive(Debug, Clone, PartialEq)]
pub enum Work {
    /// Draws into its attachments.
    Draw {
        /// What is drawn.
        draw: Draw,
        /// The shader's name.
        shader: Arc<str>,
        /// Whether its fragment shader discards fragments: then a full-screen draw doesn't cover.
        discards: bool,
        /// Whether its fragment shader runs once a sample.
        per_sample: bool,
    },
    /// Runs compute shaders.
    Dispatch {
        /// The shader's name.
        shader: Arc<str>,
        /// How many workgroups.
        groups: Groups,
    },
    /// Copies its first transfer into its second: texel for texel, byte for byte, or rows of texels to or from a buffer.
    Copy,
    /// Scales its first transfer into its second.
    Blit {
        /// Filter between texels.
        filter: Filter,
    },
    /// Sets all of its one transfer to a value.
    Fill {
        /// The value.
        value: FillValue,
    },
    /// The embedding program records it outside of rendering scopes.
    Custom {
        /// The name by which the program knows it.
        callback: Arc<str>,
    },
    /// Stands in for a pass that is off: `to` takes what `from` holds.
    Forward {
        /// Source.
        from: ImageIndex,
        /// Target.
        to: ImageIndex,
        /// The condition that switched the pass off: "tone_mapping = false".
        because: String,
    },
}

/// How many workgroups a dispatch has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Groups {
    /// So many in x, y and z.
    Count([u32; 3]),
    /// As many as cover so many invocations in x, y and z: divided by the shader's own workgroup size, rounded up.
    Invocations([u32; 3]),
    /// As many as its buffer of the role [`BufferRole::Indirect`] says, a `VkDispatchIndirectCommand` at this byte.
    Indirect {
        /// Byte offset, a multiple of 4.
        offset: u64,
    },
}

/// What a raster pass draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Draw {
    /// One of the scene's draw lists.
    Objects(DrawList),
    /// The sky, behind everything.
    Sky,
    /// One triangle that covers every pixel.
    FullScreen,
    /// So many vertices and instances of triangles, whose vertex shader finds its data itself or in the pass's vertex
    /// buffers.
    Vertices {
        /// Vertices, or indices if the pass has an index buffer (32 bits each).
        count: u32,
        /// Instances.
        instances: u32,
    },
    /// As `Vertices`; the counts stand in the pass's buffer of the role [`BufferRole::Indirect`]: a
    /// `VkDrawIndirectCommand`, or `VkDrawIndexedIndirectCommand` if the pass has an index buffer.
    Indirect,
    /// What the embedding program records inside the rendering scope, known to it by the pass's shader name.
    Custom,
}

/// The scene's draw lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum DrawList {
    /// Objects that hide what is behind them.
    Opaque,
    /// Objects with holes: fragments whose alpha is below the material's cut-off are discarded.
    Masked,
    /// Objects that let through what is behind them, sorted back to front.
    Transparent,
}

/// An image that a pass samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// The name by which the shader knows it.
    pub binding: Arc<str>,
    /// Which image.
    pub image: ImageIndex,
    /// Which part of it. Counts of mip levels and layers may be [`Subresources::REMAINING`]; shaders see one plane: no planes,
    /// or all, mean depth where there is stencil beside it.
    pub range: Subresources,
    /// Of which frame: 0 is this one, 1 the one before. More than 0 only for images with history.
    pub frames_ago: u32,
    /// Where the image was named.
    pub span: Span,
    /// Whether the shader reads single samples (the face `Samples`); else it wants one value a texel (`Resolved`).
    pub per_sample: bool,
    /// Whether each fragment reads only the texel at its own position: then, where the device has local reads, the pass
    /// can share the rendering scope of the one that drew it.
    pub own_pixel: bool,
    /// How it is looked up between its texels and beyond its edges.
    pub sampler: Sampler,
    /// Shader stages that sample it.
    pub stages: Stages,
}

/// An image that a pass accesses as storage.
#[derive(Debug, Clone, PartialEq)]
pub struct Storage {
    /// The name by which the shader knows it.
    pub binding: Arc<str>,
    /// Which image.
    pub image: ImageIndex,
    /// Which part of it. Counts of mip levels and layers may be [`Subresources::REMAINING`]; no planes mean all.
    pub range: Subresources,
    /// Where the image was named.
    pub span: Span,
    /// Whether earlier contents are read or kept. A storage write that is not `read` replaces the image whole.
    pub read: bool,
    /// Whether it is written.
    pub write: bool,
    /// Shader stages that access it.
    pub stages: Stages,
}

/// A colour attachment.
#[derive(Debug, Clone, PartialEq)]
pub struct ColorTarget {
    /// Which image.
    pub image: ImageIndex,
    /// Which part of it. Counts of mip levels and layers may be [`Subresources::REMAINING`]; no planes mean all.
    pub range: Subresources,
    /// Where the image was named.
    pub span: Span,
    /// Clear value (linear), if the pass starts from a cleared image.
    pub clear: Option<[f32; 4]>,
    /// How new colour meets old.
    pub blend: Blend,
}

/// How new colour meets old.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Blend {
    /// New replaces old.
    #[default]
    Replace,
    /// `new·a + old·(1 − a)`.
    Alpha,
    /// `new + old·(1 − a)`: colour that was multiplied by its alpha.
    Premultiplied,
    /// `new + old`.
    Additive,
}

/// A depth attachment.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthTarget {
    /// Which image.
    pub image: ImageIndex,
    /// Which part of it. Counts of mip levels and layers may be [`Subresources::REMAINING`]; no planes mean all.
    pub range: Subresources,
    /// Where the image was named.
    pub span: Span,
    /// Clear value (reversed depth: 0 is infinitely far), if the pass starts from a cleared image.
    pub clear: Option<f32>,
    /// The comparison.
    pub test: CompareOp,
    /// Whether passing fragments write depth.
    pub write: bool,
    /// What happens to the stencil plane, if the pass uses it.
    pub stencil: Option<StencilState>,
}

impl DepthTarget {
    /// The planes of an image with the format `format` that it uses: each with whether the pass starts from a cleared
    /// plane, and whether it writes it.
    pub fn planes(&self, format: Format) -> impl Iterator<Item = (Aspects, bool, bool)> + use<> {
        let depth = (Aspects::DEPTH, self.clear.is_some(), self.write || self.clear.is_some());
        let stencil = self.stencil.filter(|_| format.aspects().contains(Aspects::STENCIL)).map(|stencil| {
            (Aspects::STENCIL, stencil.clear.is_some(), stencil.clear.is_some() || stencil.pass != StencilOp::Keep)
        });
        std::iter::once(depth).chain(stencil)
    }
}

/// Stencil test and update, the same for both faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StencilState {
    /// Clear value, if the pass starts from a cleared plane.
    pub clear: Option<u8>,
    /// The comparison of the reference with what is there.
    pub test: CompareOp,
    /// The reference value.
    pub reference: u8,
    /// What is done where both tests pass; what fails keeps its value.
    pub pass: StencilOp,
}

/// A buffer that a pass reads or writes.
#[derive(Debug, Clone, PartialEq)]
pub struct BufferUse {
    /// The name by which the shader knows it; `None` for what no shader names (vertices, indices, indirect counts).
    pub binding: Option<Arc<str>>,
    /// Which buffer.
    pub buffer: BufferIndex,
    /// Of which frame: 0 is this one, 1 the one before. More than 0 only for buffers with history.
    pub frames_ago: u32,
    /// Where the buffer was named.
    pub span: Span,
    /// What for.
    pub role: BufferRole,
    /// Shader stages that access it; empty for what no shader names.
    pub stages: Stages,
}

/// What a pass uses a buffer for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BufferRole {
    /// A uniform block.
    Uniform,
    /// A storage block.
    Storage {
        /// Whether earlier contents are read or kept. A storage write that is not `read` replaces the buffer whole.
        read: bool,
        /// Whether it is written.
        write: bool,
    },
    /// Vertex attributes.
    Vertex,
    /// Indices of 32 bits.
    Index,
    /// Counts of a draw or dispatch.
    Indirect,
}

/// What a copy, blit, fill or custom pass reads or writes by transfer.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferUse {
    /// Image or buffer.
    pub resource: Resource,
    /// Which part of an image. Copies and blits take one mip level.
    pub range: Subresources,
    /// Of which frame: 0 is this one, 1 the one before. More than 0 only for what has history, and is read.
    pub frames_ago: u32,
    /// Where it was named.
    pub span: Span,
    /// Whether it is written, and whole; else it is read.
    pub write: bool,
}

/// A value for a shader parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ParamValue {
    /// A truth value, given to the shader as a 32-bit 0 or 1.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
}
