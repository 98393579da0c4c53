//! The views of a frame: from where, and how large, each of its parts is drawn.

use crate::jitter::Jitter;
use crate::source::Span;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Index of a view in [`crate::frame::Frame::views`]; 0, the main one, also where a frame lists none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct ViewIndex(pub u32);

/// An eye of a viewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Eye {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl Eye {
    /// Both, the left one first.
    pub const BOTH: [Eye; 2] = [Eye::Left, Eye::Right];

    /// Its name in lower case.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Eye::Left => "left",
            Eye::Right => "right",
        }
    }
}

/// How a frame is drawn for two eyes. The pipeline file is the same for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Stereo {
    /// It is drawn for one: images that each eye has of its own are there once.
    #[default]
    Off,
    /// Whatever an eye has of its own is drawn for one eye and then for the other, into images of their own.
    MultiPass,
}

/// The eye that a view is seen with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ViewEye {
    /// Which one.
    pub eye: Eye,
    /// The view between both eyes.
    pub of: ViewIndex,
}

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
    /// The eye that it is seen with; `None`: it is seen from between the eyes, or there is one.
    pub eye: Option<ViewEye>,
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
