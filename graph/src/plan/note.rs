//! Notes of the compiler's stages: decisions that no step shows.

use crate::base::{FilePath, Place};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A decision that no step shows.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Note {
    /// Which stage decided.
    pub stage: Stage,
    /// The subject of the decision: a pass or an image.
    pub subject: Arc<str>,
    /// The decision in the reader's words.
    pub text: String,
    /// The place that it comes from.
    pub at: Option<Place>,
}

impl Note {
    /// Whether the note tells which passes a shipped fragment switches off by itself: users of the fragment can do nothing
    /// about that, and need not.
    #[must_use]
    pub fn is_of_shipped_fragment(&self) -> bool {
        let shipped =
            self.at.as_ref().is_some_and(|place| matches!(FilePath::of_text(&place.file), FilePath::Shipped(_)));
        shipped && self.subject.contains('.') && self.stage == Stage::Expand
    }
}

/// A stage of the compiler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Settings and conditions.
    Expand,
    /// Versions and dependencies.
    Link,
    /// Passes that reach no output are removed.
    Cull,
    /// Sample counts and formats that the device has, and that hold what the scene and the passes need.
    Fit,
    /// Samples, sizes and formats meet.
    Adapt,
    /// The order.
    Schedule,
    /// Rendering scopes.
    Scope,
    /// Load and store operations.
    Retain,
    /// Memory.
    Place,
    /// Barriers.
    Synchronise,
}
