//! An expression whose names were found.

use super::environment::Bound;
use super::program::Program;
use super::types::Type;

/// An expression with the meaning of its names: evaluated as often as there are values.
#[derive(Debug, Clone)]
pub struct Expression {
    pub(super) program: Program,
    /// The bindings of the program's names.
    pub(super) bound: Vec<Bound>,
    pub(super) ty: Type,
}
