//! The values of one level's names.

use crate::expression::{Decision, Value};
use crate::language::model::Area;

/// The value of a setting or parameter, and the decisions behind it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DecidedValue {
    pub(crate) value: Value,
    /// The decisions that the argument of a parameter read; empty for a setting, which decides by itself.
    pub(crate) decided: Vec<Decision>,
}

impl From<Value> for DecidedValue {
    /// A value that nothing decided.
    fn from(value: Value) -> DecidedValue {
        DecidedValue { value, decided: Vec::new() }
    }
}

/// Where in the pipeline a declared image, buffer or list of them stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Elements {
    /// Not known yet: it stands further below.
    Below,
    /// A mistake in it was reported.
    Failed,
    /// `count` of them, from the index `first` on.
    At { first: u32, count: u32 },
}

/// The values of one level's names.
#[derive(Debug, Default)]
pub(crate) struct LevelValues {
    /// Settings or parameters; `None` where one has no value, which was reported.
    pub(crate) values: Vec<Option<DecidedValue>>,
    pub(crate) images: Vec<Elements>,
    pub(crate) buffers: Vec<Elements>,
}

/// Properties of an image that was evaluated; `None`: it follows an image further below.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Properties {
    pub(crate) area: Option<Area>,
    pub(crate) mips: Option<u32>,
    pub(crate) layers: Option<u32>,
    pub(crate) samples: Option<u32>,
}
