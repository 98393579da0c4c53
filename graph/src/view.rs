//! The views of a frame: from where, and how large, each of its parts is drawn.

use crate::jitter::Jitter;
use crate::source::Span;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Index of a view in [`crate::frame::Frame::views`]; 0, the main one, also where a frame lists none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct ViewIndex(pub u32);

/// One view of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Unique name.
    pub name: Arc<str>,
    /// Where it was declared.
    pub span: Span,
    /// Width and height of its picture in texels, each at least 1. What draws from a camera takes the ratio from here.
    pub extent: [u32; 2],
    /// The scene's camera of that name; `None`: the scene's default camera.
    pub camera: Option<Arc<str>>,
    /// What its passes may cost.
    pub allows: Allowances,
    /// How what its camera sees is shifted from frame to frame; `None`: not at all.
    pub jitter: Option<Jitter>,
}

/// What may be spent on a view. Conditions of a pipeline ask for it; the compiler only hands it on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Allowances {
    /// Several samples a texel.
    pub msaa: bool,
    /// Light beyond what a display shows.
    pub hdr: bool,
    /// Drawing in another size than that of its picture.
    pub scale: bool,
}

impl Default for Allowances {
    fn default() -> Allowances {
        Allowances { msaa: true, hdr: true, scale: true }
    }
}
