//! The work of passes, and what is known of each kind.

use super::{Draw, ImageIndex};
use crate::vulkan::{FillValue, Filter, Stages};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

#[cfg(doc)]
use super::BufferRole;

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

/// What is known of a kind of work.
struct WorkRow {
    /// The stages of its shaders.
    shaders: Stages,
    /// The stages of its transfers.
    transfers: Stages,
    /// Whether it is a copy, blit or fill.
    is_transfer: bool,
    /// Whether it takes texels over as they are, sample by sample.
    keeps_samples: bool,
    /// Whether it replaces all of what it writes by transfer, and reads none of it.
    fills: bool,
}

impl Work {
    /// The row of its kind.
    const fn row(&self) -> WorkRow {
        const DRAWN: Stages = Stages::VERTEX_SHADER.union(Stages::FRAGMENT_SHADER);
        const MOVED: Stages = Stages::COPY.union(Stages::BLIT).union(Stages::CLEAR);
        const NONE: WorkRow = WorkRow {
            shaders: Stages::empty(),
            transfers: MOVED,
            is_transfer: false,
            keeps_samples: false,
            fills: false,
        };
        match self {
            Work::Draw { .. } => WorkRow { shaders: DRAWN, ..NONE },
            Work::Dispatch { .. } => WorkRow { shaders: Stages::COMPUTE_SHADER, ..NONE },
            Work::Copy => WorkRow { transfers: Stages::COPY, is_transfer: true, keeps_samples: true, ..NONE },
            Work::Blit { .. } => WorkRow { transfers: Stages::BLIT, is_transfer: true, ..NONE },
            Work::Fill { .. } => WorkRow { transfers: Stages::CLEAR, is_transfer: true, fills: true, ..NONE },
            Work::Custom { .. } => {
                WorkRow { shaders: DRAWN.union(Stages::COMPUTE_SHADER), keeps_samples: true, fills: true, ..NONE }
            }
            Work::Forward { .. } => NONE,
        }
    }

    /// The stages in which its shaders may run.
    #[must_use]
    pub const fn shader_stages(&self) -> Stages {
        self.row().shaders
    }

    /// The stages in which it transfers.
    #[must_use]
    pub const fn transfer_stages(&self) -> Stages {
        self.row().transfers
    }

    /// Whether it is a copy, blit or fill.
    #[must_use]
    pub const fn is_transfer(&self) -> bool {
        self.row().is_transfer
    }

    /// Whether it may take texels over as they are, sample by sample: a copy, or what the program records.
    #[must_use]
    pub const fn keeps_samples(&self) -> bool {
        self.row().keeps_samples
    }

    /// Whether it may write by transfer without reading: a fill, or what the program records.
    #[must_use]
    pub const fn fills(&self) -> bool {
        self.row().fills
    }

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

    /// Whether it draws.
    #[must_use]
    pub const fn is_draw(&self) -> bool {
        self.draw().is_some()
    }

    /// Whether it draws what `is` says of a draw.
    pub fn draws(&self, is: impl FnOnce(Draw) -> bool) -> bool {
        self.draw().is_some_and(|(draw, _)| is(draw))
    }

    /// Whether it draws with a shader that leaves samples out.
    #[must_use]
    pub const fn discards(&self) -> bool {
        matches!(self, Work::Draw { discards: true, .. })
    }

    /// Whether it draws, and doesn't tell the samples of a texel apart.
    #[must_use]
    pub const fn draws_samples_alike(&self) -> bool {
        matches!(self, Work::Draw { per_sample: false, .. })
    }

    /// The shader's name, or that by which the program knows it; copies, blits, fills and forwards have none.
    #[must_use]
    pub const fn shader(&self) -> Option<&Arc<str>> {
        match self {
            Work::Draw { shader, .. } | Work::Dispatch { shader, .. } => Some(shader),
            Work::Custom { callback } => Some(callback),
            Work::Copy | Work::Blit { .. } | Work::Fill { .. } | Work::Forward { .. } => None,
        }
    }

    /// How many workgroups, if it is a dispatch.
    #[must_use]
    pub const fn groups(&self) -> Option<Groups> {
        match self {
            Work::Dispatch { groups, .. } => Some(*groups),
            Work::Draw { .. }
            | Work::Copy
            | Work::Blit { .. }
            | Work::Fill { .. }
            | Work::Custom { .. }
            | Work::Forward { .. } => None,
        }
    }

    /// Whether a buffer of the pass holds its counts.
    #[must_use]
    pub fn is_indirect(&self) -> bool {
        self.draws(Draw::is_indirect) || matches!(self.groups(), Some(Groups::Indirect { .. }))
    }

    /// The value, if it is a fill.
    #[must_use]
    pub const fn filled(&self) -> Option<FillValue> {
        match self {
            Work::Fill { value } => Some(*value),
            Work::Draw { .. }
            | Work::Dispatch { .. }
            | Work::Copy
            | Work::Blit { .. }
            | Work::Custom { .. }
            | Work::Forward { .. } => None,
        }
    }

    /// Whether it is a copy.
    #[must_use]
    pub const fn is_copy(&self) -> bool {
        matches!(self, Work::Copy)
    }

    /// Has a draw or dispatch use another shader.
    pub(crate) fn set_shader(&mut self, found: &Arc<str>) {
        match self {
            Work::Draw { shader, .. } | Work::Dispatch { shader, .. } => shader.clone_from(found),
            Work::Copy | Work::Blit { .. } | Work::Fill { .. } | Work::Custom { .. } | Work::Forward { .. } => {}
        }
    }

    /// Source and target of a forward, to be changed.
    pub(crate) fn forwarded_mut(&mut self) -> Option<[&mut ImageIndex; 2]> {
        match self {
            Work::Forward { from, to, .. } => Some([from, to]),
            Work::Draw { .. }
            | Work::Dispatch { .. }
            | Work::Copy
            | Work::Blit { .. }
            | Work::Fill { .. }
            | Work::Custom { .. } => None,
        }
    }

    /// Source and target, if it stands in for a pass that is off, and the condition that switched the pass off.
    #[must_use]
    pub const fn forward(&self) -> Option<(ImageIndex, ImageIndex, &str)> {
        match self {
            Work::Forward { from, to, because } => Some((*from, *to, because.as_str())),
            Work::Draw { .. }
            | Work::Dispatch { .. }
            | Work::Copy
            | Work::Blit { .. }
            | Work::Fill { .. }
            | Work::Custom { .. } => None,
        }
    }

    /// Source and target, if it stands in for a pass that is off.
    #[must_use]
    pub const fn forwarded(&self) -> Option<[ImageIndex; 2]> {
        match self.forward() {
            Some((from, to, _)) => Some([from, to]),
            None => None,
        }
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
