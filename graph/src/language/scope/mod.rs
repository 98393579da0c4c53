//! The names of one level of a file, and the values of what stands in quotes.

mod expressions;
mod level;
mod parameter;
mod quoted;
mod symbols;

pub(crate) use level::{Block, Given, Level, Properties};
pub(crate) use parameter::{Parameter, ParameterKind};
pub(crate) use quoted::{Checked, Quoted, Scope, joined};
pub(crate) use symbols::Known;
