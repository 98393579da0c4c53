//! What a scene is made of, as far as conditions may ask.

use crate::describe::Fact;

/// Facts of a scene, named `scene.…` in conditions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Facts {
    /// Whether anything opaque is drawn.
    pub has_opaque: bool,
    /// Whether anything with alpha-clipped holes is drawn.
    pub has_alpha_clip: bool,
    /// Whether anything transparent is drawn.
    pub has_transparent: bool,
}

impl Facts {
    /// What is assumed of a scene that isn't there: it may hold everything.
    pub const UNKNOWN: Facts = Facts { has_opaque: true, has_alpha_clip: true, has_transparent: true };

    /// The same facts, but for `fact`.
    #[must_use]
    pub const fn with(mut self, fact: Fact, holds: bool) -> Facts {
        match fact {
            Fact::HasOpaque => self.has_opaque = holds,
            Fact::HasAlphaClip => self.has_alpha_clip = holds,
            Fact::HasTransparent => self.has_transparent = holds,
        }
        self
    }

    /// Whether `fact` holds.
    #[must_use]
    pub const fn holds(&self, fact: Fact) -> bool {
        match fact {
            Fact::HasOpaque => self.has_opaque,
            Fact::HasAlphaClip => self.has_alpha_clip,
            Fact::HasTransparent => self.has_transparent,
        }
    }
}
