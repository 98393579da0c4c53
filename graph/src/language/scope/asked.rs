//! The values that an entry was evaluated with. While they are the same, it need not be evaluated again.

use super::evaluator::ScopeValues;
use super::level::{DecidedValue, Elements};
use crate::expression::{Decision, MissingValue, Property, Value, Values};
use crate::frame::ImageIndex;
use std::cell::RefCell;

/// A value that was asked for, and the answer.
#[derive(Debug, PartialEq)]
pub(crate) enum Asked {
    /// The setting or parameter with this number.
    Parameter(usize, Option<DecidedValue>),
    /// The property of the scene, the view or the device with this number.
    Surroundings(u32, Option<Value>),
    /// The images of the declaration with this number.
    Images(usize, Option<Elements>),
    /// The buffers of the declaration with this number.
    Buffers(usize, Option<Elements>),
    /// A property of an image, and the decisions behind it.
    Property(ImageIndex, Property, Result<i64, MissingValue>, Vec<Decision>),
}

/// Where values are noted that are asked for.
pub(crate) type Answers = RefCell<Vec<Asked>>;

impl Asked {
    /// Whether the answer is the same in `scope`, which notes none of this.
    pub(crate) fn is_same(&self, scope: &ScopeValues<'_>) -> bool {
        match self {
            Asked::Parameter(at, known) => scope.parameter(*at) == known.as_ref(),
            Asked::Surroundings(number, known) => scope.surroundings.value(*number) == *known,
            Asked::Images(at, known) => scope.level.images.get(*at) == known.as_ref(),
            Asked::Buffers(at, known) => scope.level.buffers.get(*at) == known.as_ref(),
            Asked::Property(image, property, known, by) => {
                scope.known_property(*image, *property) == *known && scope.property_decided_by(*image, *property) == by
            }
        }
    }
}
