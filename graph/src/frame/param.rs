//! Values for parameters of shaders.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// How many components vectors have, and columns matrices.
pub(crate) const PARAM_COMPONENTS: RangeInclusive<usize> = 2..=4;

/// A value that each frame has its own of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrameValue {
    /// The number of the frame, a `uint` that begins anew with 0 behind its largest.
    Frame,
    /// The time of the frame in seconds, a `float`.
    Time,
}

impl FrameValue {
    /// All of them.
    pub const ALL: [FrameValue; 2] = [FrameValue::Frame, FrameValue::Time];

    /// The word for it in files and Plans.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            FrameValue::Frame => "frame",
            FrameValue::Time => "time",
        }
    }

    /// The value with this word.
    pub(crate) fn named(word: &str) -> Option<FrameValue> {
        FrameValue::ALL.into_iter().find(|value| value.word() == word)
    }
}

/// A value for a shader parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ParamValue {
    /// A truth value, given to the shader as a 32-bit 0 or 1.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// What each frame has its own of, without another Plan.
    OfFrame(FrameValue),
    /// The components of a vector, the columns of a matrix, each a list of components, or the elements of an array, each a value
    /// of one of these.
    List(Arc<[ParamValue]>),
}

impl ParamValue {
    /// A list of values.
    #[must_use]
    pub fn list(values: impl IntoIterator<Item = ParamValue>) -> ParamValue {
        ParamValue::List(values.into_iter().collect())
    }

    /// The brackets around a list: those of an array where it is no vector and no matrix.
    pub(crate) fn brackets(values: &[ParamValue]) -> [&'static str; 2] {
        if PARAM_COMPONENTS.contains(&values.len()) { ["(", ")"] } else { ["[", "]"] }
    }

    /// Whether all its numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        match self {
            ParamValue::Bool(_) | ParamValue::Integer(_) | ParamValue::OfFrame(_) => true,
            ParamValue::Number(number) => number.is_finite(),
            ParamValue::List(values) => values.iter().all(ParamValue::is_finite),
        }
    }

    /// Whether any of it is a value that each frame has its own of.
    pub(crate) fn is_of_frame(&self) -> bool {
        match self {
            ParamValue::OfFrame(_) => true,
            ParamValue::List(values) => values.iter().any(ParamValue::is_of_frame),
            ParamValue::Bool(_) | ParamValue::Integer(_) | ParamValue::Number(_) => false,
        }
    }

    /// Whether it is the other value, bit by bit.
    pub(crate) fn is_same(&self, other: &ParamValue) -> bool {
        match (self, other) {
            (ParamValue::Number(one), ParamValue::Number(other)) => one.to_bits() == other.to_bits(),
            (ParamValue::List(one), ParamValue::List(other)) => {
                one.len() == other.len() && one.iter().zip(&**other).all(|(one, other)| one.is_same(other))
            }
            _ => self == other,
        }
    }
}

/// As pipeline files write it: `(1, 0.5, true)`, and `[…]` where only an array can be meant.
impl fmt::Display for ParamValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ParamValue::Bool(value) => write!(f, "{value}"),
            ParamValue::Integer(value) => write!(f, "{value}"),
            ParamValue::Number(value) => write!(f, "{value}"),
            ParamValue::OfFrame(value) => f.write_str(value.word()),
            ParamValue::List(values) => {
                let [open, close] = ParamValue::brackets(values);
                f.write_str(open)?;
                for (at, value) in values.iter().enumerate() {
                    if at > 0 {
                        f.write_str(", ")?;
                    }
                    write!(f, "{value}")?;
                }
                f.write_str(close)
            }
        }
    }
}
