//! Passes as a pipeline file declares them: their work, their images and buffers, and their conditions.

use super::decisions::Decisions;
use super::part::{BufferPart, ImagePart, Part};
use super::references::ImageRef;
use super::resources::Fill;
use crate::base::Span;
use crate::frame::{Blend, Cadence, Draw, ParamValue, RasterState, StencilState, ViewIndex};
use crate::ron::{Name, Spanned};
use crate::vulkan::{self, AddressMode, BorderColor, ColorComponents, CompareOp, Filter, Real, SamplerReductionMode};
use std::sync::Arc;

/// A pass.
#[derive(Debug, Clone)]
pub struct Pass {
    /// Unique name.
    pub name: Name,
    /// Why the pass does not run; `None`: it runs.
    pub off: Option<OffReason>,
    /// The settings and facts that decided about it.
    pub decided: PassDecisions,
    /// The work of the pass.
    pub work: Work,
    /// Images that its shaders sample.
    pub sample: Vec<Sample>,
    /// Images that its shaders would sample, had conditions not left them out.
    pub left_out: Vec<LeftOutSample>,
    /// Images and buffers that its shaders read and write by themselves.
    pub storage: Vec<Storage>,
    /// Buffers that its shaders read as uniform blocks.
    pub uniform: Vec<Uniform>,
    /// The buffer of its vertex attributes.
    pub vertex: Option<BufferPart>,
    /// The buffer of its indices.
    pub index: Option<BufferPart>,
    /// Colour targets by location.
    pub color: Vec<Color>,
    /// Depth (and stencil) target.
    pub depth: Option<Depth>,
    /// How its primitives become fragments, if the file says anything of it.
    pub raster: Option<Spanned<RasterState>>,
    /// The place of `alpha_to_coverage`, if it is on: the alpha of the first colour tells how many samples are covered.
    pub alpha_to_coverage: Option<Span>,
    /// Whether the file promises that it sets every texel of its targets.
    pub covers: bool,
    /// How the commands of a custom pass use what it names, where it says so.
    pub uses: Vec<DeclaredUse>,
    /// Whether a custom pass may be recorded for another queue than that for graphics.
    pub any_queue: bool,
    /// Whether the program records a custom pass for both eyes at once, where the frame is drawn so.
    pub both_eyes: bool,
    /// Values for the shader's block `params`.
    pub params: Vec<Param>,
    /// Values for the shader's specialization constants.
    pub constants: Vec<Param>,
    /// Whether it has an effect that no image or buffer shows.
    pub side_effect: bool,
    /// Stand-ins: contents of its targets when the pass is off.
    pub otherwise: Vec<StandIn>,
    /// The view that it draws for.
    pub view: ViewIndex,
    /// In which frames it runs, if it says so itself or a use that it is within does.
    pub run: Option<Cadence>,
    /// The fragment that it came with: an index into [`Pipeline::instances`](super::Pipeline::instances).
    pub instance: Option<u32>,
}

/// The settings and facts that decided about a pass.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PassDecisions {
    /// They decided whether it runs.
    pub runs: Decisions,
    /// They decided how often it is repeated.
    pub repeat: Decisions,
    /// They decided which images and buffers it uses.
    pub images: Decisions,
}

impl PassDecisions {
    /// Whether there are none.
    pub(crate) const fn is_empty(&self) -> bool {
        self.runs.is_empty() && self.repeat.is_empty() && self.images.is_empty()
    }

    /// The decisions about a pass that runs in a fragment, with those about the use of the fragment first.
    pub(crate) fn within(&self, outer: &PassDecisions) -> PassDecisions {
        PassDecisions {
            runs: outer.runs.and(&self.runs),
            repeat: outer.repeat.and(&self.repeat),
            images: outer.images.and(&self.images),
        }
    }
}

/// Why a pass does not run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OffReason {
    /// Where its condition stands.
    pub span: Span,
    /// The cause of the failed condition: "tone_mapping = false".
    pub because: String,
}

/// A sampled image that a condition leaves out.
#[derive(Debug, Clone)]
pub struct LeftOutSample {
    /// The shader's name for it.
    pub binding: Name,
    /// The image as the pass would sample it; `None` if it has no value while it is left out.
    pub sample: Option<Sample>,
    /// Why it is left out.
    pub off: OffReason,
}

/// The work of a pass.
#[derive(Debug, Clone)]
pub enum Work {
    /// It draws into its targets.
    Draw {
        /// The draw.
        draw: Draw,
        /// The counts of an indirect draw.
        counts: Option<BufferPart>,
        /// The number of draws, if a buffer holds it.
        count: Option<BufferPart>,
        /// The shader's name.
        shader: Name,
    },
    /// It runs a compute shader.
    Dispatch {
        /// The shader's name.
        shader: Name,
        /// The number of workgroups.
        groups: Spanned<Groups>,
    },
    /// It copies.
    Copy {
        /// The source.
        from: Part,
        /// The target.
        to: Part,
    },
    /// It copies an image and scales it.
    Blit {
        /// The source.
        from: Part,
        /// The target.
        to: Part,
        /// Filter, if the file chooses one.
        filter: Option<Spanned<Filter>>,
    },
    /// It sets an image or buffer to a value.
    Fill {
        /// The image or buffer.
        to: Part,
        /// The value.
        value: Spanned<Fill>,
    },
    /// The embedding program records it.
    Custom {
        /// The name by which the program knows it.
        callback: Name,
        /// Parts that it reads by transfer.
        reads: Vec<Part>,
        /// Parts that it writes by transfer.
        writes: Vec<Part>,
    },
}

impl Work {
    /// The draw, if it is one.
    pub const fn draw(&self) -> Option<Draw> {
        match self {
            Work::Draw { draw, .. } => Some(*draw),
            Work::Dispatch { .. } | Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } => {
                None
            }
        }
    }

    /// Whether it draws what `is` says of a draw.
    pub fn draws(&self, is: impl FnOnce(Draw) -> bool) -> bool {
        self.draw().is_some_and(is)
    }

    /// Whether it runs a compute shader.
    pub const fn is_dispatch(&self) -> bool {
        match self {
            Work::Dispatch { .. } => true,
            Work::Draw { .. } | Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } => {
                false
            }
        }
    }

    /// The buffer of the counts of an indirect draw or dispatch.
    pub const fn counts(&self) -> Option<&BufferPart> {
        match self {
            Work::Draw { counts, .. } => counts.as_ref(),
            Work::Dispatch { groups, .. } => match &groups.value {
                Groups::Indirect { buffer, .. } => Some(buffer),
                Groups::Count(_) | Groups::Invocations(_) | Groups::Texels(_) => None,
            },
            Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } => None,
        }
    }

    /// The buffer of the number of draws, if one holds it.
    pub const fn count(&self) -> Option<&BufferPart> {
        match self {
            Work::Draw { count, .. } => count.as_ref(),
            Work::Dispatch { .. } | Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } => {
                None
            }
        }
    }

    /// Source and target, if it copies.
    pub const fn copied(&self) -> Option<[&Part; 2]> {
        match self {
            Work::Copy { from, to } => Some([from, to]),
            Work::Draw { .. } | Work::Dispatch { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } => {
                None
            }
        }
    }

    /// The name by which the embedding program knows it, if that records it.
    pub const fn callback(&self) -> Option<&Name> {
        match self {
            Work::Custom { callback, .. } => Some(callback),
            Work::Draw { .. } | Work::Dispatch { .. } | Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } => {
                None
            }
        }
    }
}

/// How many workgroups a dispatch has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Groups {
    /// A number in x, y and z.
    Count([u32; 3]),
    /// As many as cover a number of invocations in x, y and z.
    Invocations([u32; 3]),
    /// As many as cover one invocation for each texel of an image, its layers or depth in z.
    Texels(ImagePart),
    /// An indirect dispatch: a buffer holds the counts.
    Indirect {
        /// The buffer of the counts.
        buffer: BufferPart,
        /// Offset in the buffer, in bytes.
        offset: u64,
    },
}

/// An image that a shader samples.
#[derive(Debug, Clone)]
pub struct Sample {
    /// The shader's name for it.
    pub binding: Name,
    /// Which part of which image.
    pub part: ImagePart,
    /// The face of the image.
    pub face: Face,
    /// Filter between texels, if the file chooses one.
    pub filter: Option<Spanned<Filter>>,
    /// Filter between mip levels, if the file chooses one.
    pub mip_filter: Option<Spanned<Filter>>,
    /// Address mode beyond the edges, if the file chooses one.
    pub address: Option<Spanned<AddressMode>>,
    /// The rest of its sampler.
    pub state: SamplerState,
    /// How the shader's depth is compared with the image's, if the file says so.
    pub compare: Option<Spanned<CompareOp>>,
    /// Whether each fragment reads only the texel at its own position, if the file says so.
    pub own_pixel: Option<Spanned<bool>>,
}

/// What a file says of a sampler beside filters, address mode and comparison.
#[derive(Debug, Clone, Copy, Default)]
pub struct SamplerState {
    /// The colour beyond the edges.
    pub border: Option<BorderColor>,
    /// What a linear filter makes of texels.
    pub reduction: Option<SamplerReductionMode>,
    /// Most samples along the direction of the slant.
    pub anisotropy: Option<u32>,
    /// What is added to the mip level.
    pub lod_bias: Option<Real>,
    /// The least mip level.
    pub min_lod: Option<Real>,
    /// The greatest mip level.
    pub max_lod: Option<Real>,
}

impl SamplerState {
    pub(crate) fn reaches_out(&self) -> bool {
        let moves = |lod: Option<Real>| lod.is_some_and(|lod| !lod.is_zero());
        self.anisotropy.is_some_and(|samples| samples > 1) || moves(self.lod_bias) || moves(self.min_lod)
    }
}

/// A face of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// The face that the shader's declaration asks for.
    Plain,
    /// Each sample by itself.
    Samples,
    /// One value a texel.
    Resolved,
    /// One value of depth a texel. Where there are several samples, the depth is drawn again with one.
    DepthOnly,
}

/// An image or buffer that a shader reads and writes by itself.
#[derive(Debug, Clone)]
pub struct Storage {
    /// The shader's name for it.
    pub binding: Name,
    /// Which part of which image, or which buffer.
    pub part: Part,
    /// The access; `None`: the access that the shader's declaration allows.
    pub access: Option<Spanned<StorageAccess>>,
}

/// The access of a shader to a storage image or buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StorageAccess {
    /// It is read.
    Read,
    /// All of it is written, and nothing of it is read before.
    Write,
    /// It is read and written, or written in some places and kept in others.
    ReadWrite,
}

impl StorageAccess {
    /// Whether earlier contents are read or kept.
    pub(crate) const fn reads(self) -> bool {
        match self {
            StorageAccess::Read | StorageAccess::ReadWrite => true,
            StorageAccess::Write => false,
        }
    }

    /// Whether it is written.
    pub(crate) const fn writes(self) -> bool {
        match self {
            StorageAccess::Read => false,
            StorageAccess::Write | StorageAccess::ReadWrite => true,
        }
    }
}

/// A buffer that a shader reads as a uniform block.
#[derive(Debug, Clone)]
pub struct Uniform {
    /// The shader's name for it.
    pub binding: Name,
    /// The buffer.
    pub part: BufferPart,
}

/// A colour target.
#[derive(Debug, Clone)]
pub struct Color {
    /// Which part of which image.
    pub part: ImagePart,
    /// Clear value (linear red, green, blue, alpha).
    pub clear: Option<[Spanned<f64>; 4]>,
    /// The blend of new colour with old.
    pub blend: Spanned<Blend>,
    /// The channels that are written.
    pub write_mask: ColorComponents,
}

/// A depth target.
#[derive(Debug, Clone)]
pub struct Depth {
    /// Which part of which image.
    pub part: ImagePart,
    /// Clear value, 0 (infinitely far) to 1.
    pub clear: Option<f64>,
    /// The comparison.
    pub test: CompareOp,
    /// Whether passing fragments write depth.
    pub write: bool,
    /// The stencil state; `None`: nothing happens to the stencil plane.
    pub stencil: Option<Spanned<StencilState>>,
}

/// How the commands of a custom pass use an image or buffer that it names.
#[derive(Debug, Clone, Copy)]
pub struct DeclaredUse {
    /// The part of an image, or the buffer.
    pub part: Part,
    /// Where it is declared.
    pub span: Span,
    /// The stages and accesses, and the layout of an image.
    pub state: vulkan::State,
}

/// A value for a member of the shader's block `params`.
#[derive(Debug, Clone)]
pub struct Param {
    /// The member's name.
    pub name: Name,
    /// Its value.
    pub value: Spanned<ParamValue>,
    /// The words in the file, if they are no plain value: "setting `white_point`".
    pub written: Option<Arc<str>>,
}

/// A stand-in: it fills a target of a pass that is off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StandIn {
    /// Another image is copied into it.
    Forward(Forward),
    /// It is set to a value.
    Clear {
        /// Target, one of the pass's own.
        to: ImageRef,
        /// The value.
        value: Spanned<Fill>,
    },
}

/// A copy in place of a pass that is off: `to` gets the contents of `from`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Forward {
    /// Source.
    pub from: ImageRef,
    /// Target, one of the pass's own.
    pub to: ImageRef,
}

impl StandIn {
    /// The image that it fills.
    #[must_use]
    pub const fn target(&self) -> ImageRef {
        match self {
            StandIn::Forward(forward) => forward.to,
            StandIn::Clear { to, .. } => *to,
        }
    }
}

impl Work {
    /// Parts that it reads by transfer.
    pub(crate) const fn transfer_reads(&self) -> &[Part] {
        match self {
            Work::Copy { from, .. } | Work::Blit { from, .. } => std::slice::from_ref(from),
            Work::Custom { reads, .. } => reads.as_slice(),
            Work::Draw { .. } | Work::Dispatch { .. } | Work::Fill { .. } => &[],
        }
    }

    /// Parts that it writes by transfer.
    pub(crate) const fn transfer_writes(&self) -> &[Part] {
        match self {
            Work::Copy { to, .. } | Work::Blit { to, .. } | Work::Fill { to, .. } => std::slice::from_ref(to),
            Work::Custom { writes, .. } => writes.as_slice(),
            Work::Draw { .. } | Work::Dispatch { .. } => &[],
        }
    }

    /// The image that workgroups are counted by.
    pub(super) const fn measured(&self) -> Option<&ImagePart> {
        match self {
            Work::Dispatch { groups, .. } => match &groups.value {
                Groups::Texels(image) => Some(image),
                Groups::Count(_) | Groups::Invocations(_) | Groups::Indirect { .. } => None,
            },
            Work::Draw { .. } | Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } => None,
        }
    }

    /// The parts of transfers, to be changed.
    pub(super) fn transfers_mut(&mut self) -> Vec<&mut Part> {
        match self {
            Work::Copy { from, to } | Work::Blit { from, to, .. } => vec![from, to],
            Work::Fill { to, .. } => vec![to],
            Work::Custom { reads, writes, .. } => reads.iter_mut().chain(writes).collect(),
            Work::Draw { .. } | Work::Dispatch { .. } => Vec::new(),
        }
    }
}

impl Pass {
    /// Whether the pass draws into images: a custom pass is recorded within a rendering scope then.
    pub(crate) fn is_drawn(&self) -> bool {
        !self.color.is_empty() || self.depth.is_some()
    }

    /// A pass that does nothing.
    pub(crate) fn idle(name: Name) -> Pass {
        let work = Work::Custom { callback: name.clone(), reads: Vec::new(), writes: Vec::new() };
        Pass {
            name,
            off: None,
            decided: PassDecisions::default(),
            work,
            sample: Vec::new(),
            left_out: Vec::new(),
            storage: Vec::new(),
            uniform: Vec::new(),
            vertex: None,
            index: None,
            color: Vec::new(),
            depth: None,
            raster: None,
            alpha_to_coverage: None,
            covers: false,
            uses: Vec::new(),
            any_queue: false,
            both_eyes: false,
            params: Vec::new(),
            constants: Vec::new(),
            side_effect: false,
            otherwise: Vec::new(),
            view: ViewIndex::default(),
            run: None,
            instance: None,
        }
    }

    /// The name of its shader, or of the embedding program's callback; copies, blits and fills have none.
    #[must_use]
    pub const fn shader(&self) -> Option<&Name> {
        match &self.work {
            Work::Draw { shader, .. } | Work::Dispatch { shader, .. } => Some(shader),
            Work::Custom { callback, .. } => Some(callback),
            Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } => None,
        }
    }
}
