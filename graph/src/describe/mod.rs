//! What a file can say: one type per concept, names with source spans, diagnostics.

mod diagnostic;

pub use diagnostic::{Diagnostic, Label, render};
