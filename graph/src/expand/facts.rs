//! What a scene is made of, as far as conditions may ask.

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
}
