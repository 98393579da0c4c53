//! A Plan's dataflow as a graph, in the languages of other programs.
//!
//! ```text
//! Plan ─► dataflow ─► labels ─► dot, mermaid
//!                        └────► layout ─► svg
//! ```

mod dot;
#[cfg(test)]
mod hostile;
mod labels;
mod layout;
mod mermaid;
mod svg;

pub use dot::dot;
pub use mermaid::mermaid;
pub use svg::svg;
