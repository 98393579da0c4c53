//! Passes of a frame, and their work.

use super::{
    BufferUse, ColorTarget, DepthTarget, Draw, ImageIndex, ParamValue, Sampled, Storage, TransferUse, ViewIndex,
};
use crate::base::Span;
use crate::device::Need;
use crate::vulkan::{FillValue, Filter};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

#[cfg(doc)]
use super::BufferRole;

/// One pass.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// The view that it draws for.
    pub view: ViewIndex,
    /// The work of the pass.
    pub work: Work,
    /// Images that its shaders sample.
    pub sampled: Vec<Sampled>,
    /// Images that its shaders write (and perhaps read) without attachments.
    pub storage: Vec<Storage>,
    /// Colour attachments by location.
    pub color: Vec<ColorTarget>,
    /// Depth (and stencil) attachment.
    pub depth: Option<DepthTarget>,
    /// Whether the alpha of the first colour says how many samples are covered, where the targets have several.
    pub alpha_to_coverage: bool,
    /// Whether the file promises that it sets every texel of its targets; blending and tests need what is there all the same.
    pub covers: bool,
    /// Why it may leave texels of its targets as they were although it fills the screen, in words; `None`: it sets them all, or it
    /// doesn't fill the screen. If there are any words, a draw doesn't cover.
    pub untouched: Option<Arc<str>>,
    /// Why its shader can't draw its depth alone, for images of fewer samples, if it can't.
    pub no_depth_only: Option<Arc<str>>,
    /// Why its shader can't draw into an image that is turned, if it can't, behind the name of the pass.
    pub no_rotation: Option<Arc<str>>,
    /// What its shader and its resources ask of the device beyond what every device has.
    pub needs: Vec<Need>,
    /// Why the compiler inserted it; in frames that it is given, nothing is.
    pub inserted: Option<Arc<str>>,
    /// Buffers that it reads or writes by anything but a copy or fill.
    pub buffers: Vec<BufferUse>,
    /// Images and buffers that a copy, blit, fill or custom pass reads and writes by transfer: source before target.
    pub transfers: Vec<TransferUse>,
    /// Whether it has an effect that no image or buffer shows: it is never culled.
    pub side_effect: bool,
    /// Values for the shader's parameter block, by member name.
    pub params: Vec<(Arc<str>, ParamValue)>,
}

impl Pass {
    /// A pass that accesses nothing yet, and that no file declares.
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
            alpha_to_coverage: false,
            covers: false,
            untouched: None,
            no_depth_only: None,
            no_rotation: None,
            needs: Vec::new(),
            inserted: None,
            buffers: Vec::new(),
            transfers: Vec::new(),
            side_effect: false,
            params: Vec::new(),
        }
    }
}

/// The work of a pass.
#[derive(Debug, Clone, PartialEq)]
pub enum Work {
    /// Draws into its attachments.
    Draw {
        /// The geometry.
        draw: Draw,
        /// The shader's name.
        shader: Arc<str>,
        /// Whether its fragment shader leaves samples out, as it does where it discards fragments: then a full-screen draw doesn't
        /// cover.
        discards: bool,
        /// Whether it tells the samples of a texel apart, as a fragment shader does that runs once a sample.
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
    /// Stands in for a pass that is off: `to` takes the contents of `from`.
    Forward {
        /// Source.
        from: ImageIndex,
        /// Target.
        to: ImageIndex,
        /// The condition that switched the pass off: "tone_mapping = false".
        because: String,
    },
}

impl Work {
    /// The geometry and the shader's name, if it draws.
    #[must_use]
    pub const fn draw(&self) -> Option<(Draw, &Arc<str>)> {
        match self {
            Work::Draw { draw, shader, .. } => Some((*draw, shader)),
            Work::Dispatch { .. }
            | Work::Copy
            | Work::Blit { .. }
            | Work::Fill { .. }
            | Work::Custom { .. }
            | Work::Forward { .. } => None,
        }
    }

    /// Whether it draws what `is` says of a draw.
    pub fn draws(&self, is: impl FnOnce(Draw) -> bool) -> bool {
        self.draw().is_some_and(|(draw, _)| is(draw))
    }
}

/// How many workgroups a dispatch has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Groups {
    /// This many workgroups in x, y and z.
    Count([u32; 3]),
    /// Enough workgroups for this many invocations in x, y and z: divided by the shader's own workgroup size, rounded up.
    Invocations([u32; 3]),
    /// As many as its buffer of the role [`BufferRole::Indirect`] says, a `VkDispatchIndirectCommand` at this byte.
    Indirect {
        /// Byte offset, a multiple of 4.
        offset: u64,
    },
}
