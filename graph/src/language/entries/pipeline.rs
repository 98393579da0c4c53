//! All entries of a pipeline, as its files say them.

use super::body::Body;
use super::fragments::Fragments;
use super::views::ViewEntries;
use crate::language::model::{Output, Precisions, Resolves};
use crate::language::scope::FieldValue;
use std::fmt;

/// The entries of a pipeline, with the values that its files say; `None` where a field couldn't be read.
pub(crate) struct Entries {
    pub(crate) body: Body,
    pub(crate) fragments: Fragments<Body>,
    pub(crate) views: ViewEntries,
    pub(crate) depth: Option<Option<FieldValue<Option<Resolves>>>>,
    pub(crate) color: Option<Option<FieldValue<Precisions>>>,
    pub(crate) depth_format: Option<Option<FieldValue<Precisions>>>,
    pub(crate) outputs: Option<Vec<Option<FieldValue<Output>>>>,
}

impl fmt::Debug for Entries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Entries").finish_non_exhaustive()
    }
}
