//! A Plan's dataflow as a graph, in the languages of other programs.
//!
//! ```text
//! Plan ─► dataflow ─► labels ─► dot, mermaid
//!                        └────► layout ─► svg, page
//! ```

mod dot;
#[cfg(test)]
mod hostile;
mod labels;
mod layout;
mod mermaid;
mod svg;

pub use dot::dot;
pub(crate) use labels::{Graph, Vertex};
pub(crate) use layout::{Layout, layout};
pub use mermaid::mermaid;
pub use svg::svg;
