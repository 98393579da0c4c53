//! How a pass names the images and buffers that it uses: sampled, as storage, as attachment, as buffer, by transfer.

use super::{BlendEquation, BufferIndex, BufferRole, Eye, ImageIndex, Resource};
use crate::base::Span;
use crate::vulkan::{
    Aspects, ColorComponents, CompareOp, Filter, Format, ImageShape, Sampler, Stages, StencilOp, Subresources,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// An image that a pass samples.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledImage {
    /// The name by which the shader knows it; of an element of an array its name and number, `taps[0]`.
    pub binding: Arc<str>,
    /// Which image.
    pub image: ImageIndex,
    /// Which part of it. Counts of mip levels and layers may be [`Subresources::REMAINING`]; shaders see one plane: no planes,
    /// or all, mean depth where there is stencil beside it.
    pub range: Subresources,
    /// How many frames ago: 0 is this frame. More than 0 only for images with history.
    pub frames_ago: u32,
    /// Where the image was named.
    pub span: Span,
    /// The eye whose part is sampled, of an image that holds both eyes' parts. `None`: the pass draws for both eyes, and
    /// samples for each eye the part of that eye.
    pub eye: Option<Eye>,
    /// The values that the shader reads of each texel.
    pub face: Face,
    /// The texture type that the shader declares, if the shader leaves the type to the pass. It is multisampled only if
    /// single samples are read. If the image gets one sample in the end, the declared type is not multisampled.
    pub texture: Option<ImageShape>,
    /// Whether each fragment reads only the texel at its own position: then, where the device has local reads, the pass
    /// can share the rendering scope of the one that drew it.
    pub own_pixel: bool,
    /// How it is looked up between its texels and beyond its edges.
    pub sampler: Sampler,
    /// Shader stages that sample it.
    pub stages: Stages,
}

impl SampledImage {
    /// All of an image of this frame, sampled by its nearest texels, one value each; no file names it.
    #[must_use]
    pub fn new(binding: impl Into<Arc<str>>, image: ImageIndex, stages: Stages) -> SampledImage {
        SampledImage {
            binding: binding.into(),
            image,
            range: Subresources::WHOLE,
            frames_ago: 0,
            span: Span::NONE,
            eye: None,
            face: Face::Resolved,
            texture: None,
            own_pixel: false,
            sampler: Sampler::new(Filter::Nearest),
            stages,
        }
    }
}

/// The values that a shader reads of each texel of a sampled image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Face {
    /// One value: several samples are combined by [`Image::resolve`](super::Image::resolve).
    #[default]
    Resolved,
    /// Each sample by itself.
    Samples,
    /// One value of depth. If the image has several samples, it is drawn again with one sample, whatever the image's
    /// `resolve` is.
    DepthOnly,
}

/// An image that a pass accesses as storage.
#[derive(Debug, Clone, PartialEq)]
pub struct Storage {
    /// The name by which the shader knows it; of an element of an array its name and number, `taps[0]`.
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
    /// The eye whose layer is accessed, of an image that has a layer for each eye. A write that is not `read` leaves the other eye's
    /// layer undefined.
    pub eye: Option<Eye>,
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
    /// Clear value (linear), if the pass starts from a cleared image: numbers that the image's format holds. In 64 bits,
    /// which hold integers of 32 bits exactly.
    pub clear: Option<[f64; 4]>,
    /// How new colour meets old.
    pub blend: Blend,
    /// The channels that it writes; the others keep what they held.
    pub write_mask: ColorComponents,
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
    /// By factors and operations.
    Equation(BlendEquation),
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
    pub clear: Option<f64>,
    /// The comparison.
    pub test: CompareOp,
    /// Whether passing fragments write depth.
    pub write: bool,
    /// Stencil test and update, if the pass uses the stencil plane.
    pub stencil: Option<StencilState>,
}

impl DepthTarget {
    /// The planes of an image with the format `format` that it uses: each with whether the pass starts from a cleared
    /// plane, and whether it writes it. A plane that is neither tested nor written is none of them, if the other one is.
    pub fn planes(&self, format: Format) -> impl Iterator<Item = (Aspects, bool, bool)> + use<> {
        let depth = (Aspects::DEPTH, self.clear.is_some(), self.write || self.clear.is_some());
        let uses_depth = depth.2 || self.test != CompareOp::Always;
        let stencil = self.stencil.filter(|_| format.aspects().contains(Aspects::STENCIL));
        let uses_stencil =
            stencil.is_some_and(|it| it.clear.is_some() || it.test != CompareOp::Always || it.pass != StencilOp::Keep);
        let stencil = stencil.filter(|_| uses_stencil || !uses_depth).map(|stencil| {
            (Aspects::STENCIL, stencil.clear.is_some(), stencil.clear.is_some() || stencil.pass != StencilOp::Keep)
        });
        (uses_depth || !uses_stencil).then_some(depth).into_iter().chain(stencil)
    }
}

/// Stencil test and update, the same for both faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StencilState {
    /// Clear value, if the pass starts from a cleared plane.
    pub clear: Option<u8>,
    /// The comparison of the reference with the stencil value.
    pub test: CompareOp,
    /// The reference value.
    pub reference: u8,
    /// The operation where both tests pass; where one fails, the stencil value stays.
    pub pass: StencilOp,
}

/// A buffer that a pass reads or writes.
#[derive(Debug, Clone, PartialEq)]
pub struct BufferUse {
    /// The name by which the shader knows it; `None` for buffers that no shader names (vertices, indices, indirect counts).
    pub binding: Option<Arc<str>>,
    /// Which buffer.
    pub buffer: BufferIndex,
    /// How many frames ago: 0 is this frame. More than 0 only for buffers with history.
    pub frames_ago: u32,
    /// Where the buffer was named.
    pub span: Span,
    /// The role of the buffer.
    pub role: BufferRole,
    /// Shader stages that access it; empty for buffers that no shader names.
    pub stages: Stages,
}

/// An image or buffer that a copy, blit, fill or custom pass reads or writes by transfer.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferUse {
    /// Image or buffer.
    pub resource: Resource,
    /// Which part of an image. Copies and blits take one mip level.
    pub range: Subresources,
    /// How many frames ago: 0 is this frame. More than 0 only for reads of images and buffers with history.
    pub frames_ago: u32,
    /// Where it was named.
    pub span: Span,
    /// Whether it is written; else it is read.
    pub write: bool,
    /// Whether a write leaves a part of it as it was. A copy into a buffer that has more bytes must say so.
    pub keeps: bool,
}
