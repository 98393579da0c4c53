//! The values of one level's names.

use crate::expression::{Decision, Value};
use crate::language::model::Area;

/// The value of a setting or parameter, and what decided it.
#[derive(Debug, Clone)]
pub(crate) struct Given {
    pub(crate) value: Value,
    /// Of a parameter: what its argument read. A setting decides by itself.
    pub(crate) decided: Vec<Decision>,
}

/// Where in the pipeline a declared image, buffer or list of them stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Block {
    /// Not known yet: it stands further below.
    Below,
    /// A mistake in it was reported.
    Failed,
    /// From `first` on, so many.
    At { first: u32, count: u32 },
}

/// The values of one level's names.
#[derive(Debug, Default)]
pub(crate) struct Level {
    /// Settings or parameters; `None` where one has no value, which was reported.
    pub(crate) given: Vec<Option<Given>>,
    pub(crate) images: Vec<Block>,
    pub(crate) buffers: Vec<Block>,
}

/// What is known of an image that was lowered; `None`: it follows something further below.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Properties {
    pub(crate) area: Option<Area>,
    pub(crate) mips: Option<u32>,
    pub(crate) layers: Option<u32>,
    pub(crate) samples: Option<u32>,
}
