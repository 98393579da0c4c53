//! The values of one level's names.

use crate::expression::{Decision, Value};
use crate::language::model::Area;
use std::sync::Arc;

/// A value, and what decided it: "msaa = 4".
#[derive(Debug, Clone)]
pub(crate) struct Decided<T> {
    pub(crate) value: T,
    pub(crate) because: Option<Arc<str>>,
}

impl<T> Decided<T> {
    /// A value that the file says.
    pub(crate) const fn said(value: T) -> Decided<T> {
        Decided { value, because: None }
    }

    /// What is made of the value; the same decided it.
    pub(crate) fn map<U>(self, make: impl FnOnce(T) -> U) -> Decided<U> {
        Decided { value: make(self.value), because: self.because }
    }

    /// What decided it, as remarks have it.
    pub(crate) fn remark(&self) -> &str {
        self.because.as_deref().unwrap_or_default()
    }
}

/// The value of a setting or parameter, and what decided it.
#[derive(Debug, Clone)]
pub(crate) struct DecidedValue {
    pub(crate) value: Value,
    /// Of a parameter: what its argument read. A setting decides by itself.
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
