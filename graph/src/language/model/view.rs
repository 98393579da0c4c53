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
    /// Costs that it allows: several samples, high dynamic range, another size.
    pub allows: Allowances,
    /// The shifts of its picture by parts of a texel; `None`: there are none.
    pub jitter: Option<Jitter>,
    /// The eye that it is seen with; no file says it.
    pub eye: Option<ViewEye>,
}
