//! Views.

use super::ViewId;
use crate::frame::{Allowances, Eye, Jitter};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A view: from where, and how large, passes draw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// Unique name.
    pub name: Arc<str>,
    /// Width and height of its picture in texels.
    pub extent: [u32; 2],
    /// The scene's camera of that name; `None`: the scene's default camera.
    pub camera: Option<Arc<str>>,
    /// The costs that its passes may have.
    pub allows: Allowances,
    /// How its camera's picture is shifted from frame to frame; `None`: not at all.
    pub jitter: Option<Jitter>,
    /// The eye that it is seen with; `None`: it is seen from between the eyes, or there is one.
    pub eye: Option<ViewEye>,
}

/// The eye that a view is seen with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewEye {
    /// The eye.
    pub eye: Eye,
    /// The view between both eyes, which is none of theirs.
    pub of: ViewId,
}
