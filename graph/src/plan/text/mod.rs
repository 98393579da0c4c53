//! A Plan as text for people.

mod changes;
mod decisions;
mod lists;
mod outline;
mod tree;
mod words;

pub use outline::Outline;
pub use tree::{Detail, Text};
pub(crate) use words::{bound, fill_value, size};
