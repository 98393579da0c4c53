//! The names of one level of a file, and the values of texts in quotes: references and expressions.
//!
//! A [`Context`] reads a value of an entry, as [`FieldValue`]: expressions are parsed, their names found and their types checked.
//! An [`Evaluator`] finds it at a lowering.

mod asked;
mod context;
mod evaluator;
mod expressions;
mod field_value;
mod level;
mod lookup;
mod parameter;
mod references;
mod symbols;

pub(crate) use asked::{Answers, Asked};
pub(crate) use context::{Context, Quoted, decided};
pub(crate) use evaluator::{Evaluator, ScopeValues, joined, within_view};
pub(crate) use field_value::{FieldContents, FieldValue, FieldValueTuple, ReadableValue, all, combined, reported};
pub(crate) use level::{DecidedValue, Elements, LevelValues, Properties};
pub(crate) use lookup::Scope;
pub(crate) use parameter::{Parameter, ParameterKind};
pub(crate) use symbols::{Symbols, fixed};
