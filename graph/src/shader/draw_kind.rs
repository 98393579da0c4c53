//! The kinds of draws for which a draw source brings something along, and compute passes.

use crate::frame::{Cascade, Draw, DrawList, Share};
use std::fmt;
use std::sync::Arc;

/// A kind of draw that a draw source records, or of passes that it brings resources for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DrawKind {
    /// One of the scene's draw lists.
    Objects(DrawList),
    /// Objects of a draw list that cast the sun's shadow; light goes through transparent ones.
    Casters(DrawList),
    /// The sky.
    Sky,
    /// The full screen.
    FullScreen,
    /// Draws whose vertices are the pass's own (`Vertices`, `Indirect`). The draw source draws nothing of them: they see resources of its.
    Vertices,
    /// Draws of custom passes.
    Custom,
    /// Compute passes. They draw nothing, and see resources of the draw source.
    Compute,
}

impl DrawKind {
    /// All of them.
    pub const ALL: [DrawKind; 10] = [
        DrawKind::Objects(DrawList::Opaque),
        DrawKind::Objects(DrawList::Masked),
        DrawKind::Objects(DrawList::Transparent),
        DrawKind::Casters(DrawList::Opaque),
        DrawKind::Casters(DrawList::Masked),
        DrawKind::Sky,
        DrawKind::FullScreen,
        DrawKind::Vertices,
        DrawKind::Custom,
        DrawKind::Compute,
    ];

    /// The kind of a draw.
    #[must_use]
    pub const fn of(draw: Draw) -> DrawKind {
        match draw {
            Draw::Objects(list) => DrawKind::Objects(list),
            Draw::Casters(Cascade { list, .. }) => DrawKind::Casters(list),
            Draw::Sky => DrawKind::Sky,
            Draw::FullScreen => DrawKind::FullScreen,
            Draw::Custom => DrawKind::Custom,
            Draw::Vertices { .. } | Draw::Indirect | Draw::Indirects(_) => DrawKind::Vertices,
        }
    }

    /// A draw of this kind; `None` for compute passes.
    pub(super) const fn example(self) -> Option<Draw> {
        Some(match self {
            DrawKind::Objects(list) => Draw::Objects(list),
            DrawKind::Casters(list) => {
                Draw::Casters(Cascade { list, index: 0, of: 1, reach: None, logarithmic: Share::OF_CASCADES })
            }
            DrawKind::Sky => Draw::Sky,
            DrawKind::FullScreen => Draw::FullScreen,
            DrawKind::Vertices => Draw::Vertices { count: 3, instances: 1 },
            DrawKind::Custom => Draw::Custom,
            DrawKind::Compute => return None,
        })
    }
}

/// What an entry of an interface file is for.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum InterfaceOf {
    /// A kind of draw, or compute passes.
    Kind(DrawKind),
    /// The draws of the custom pass of this name.
    Custom(Arc<str>),
}

impl fmt::Display for InterfaceOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            InterfaceOf::Kind(kind) => kind.fmt(f),
            InterfaceOf::Custom(name) => write!(f, "Custom({name:?})"),
        }
    }
}

/// As files write it: `Objects(Opaque)`.
impl fmt::Display for DrawKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}
