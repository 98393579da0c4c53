//! A view of the frame.

use crate::frame::{Allowances, Jitter, ViewEye};
use crate::ron::Name;

/// A view of the frame.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Unique name.
    pub name: Name,
    /// Width and height in texels.
    pub extent: [u32; 2],
    /// The scene's camera of that name; `None`: the scene's own.
    pub camera: Option<Name>,
    /// What may be spent on it.
    pub allows: Allowances,
    /// How what its camera sees is shifted; `None`: not at all.
    pub jitter: Option<Jitter>,
    /// The eye that it is seen with; no file says it.
    pub eye: Option<ViewEye>,
}
