//! The names of one level of a file, and the values of texts in quotes: references and expressions.

mod context;
mod expressions;
mod level;
mod lookup;
mod parameter;
mod references;
mod symbols;

pub(crate) use context::{Context, Evaluated, Quoted};
pub(crate) use level::{DecidedValue, Elements, LevelValues, Properties};
pub(crate) use lookup::{Checked, Scope, joined};
pub(crate) use parameter::{Parameter, ParameterKind};
pub(crate) use symbols::Symbols;
