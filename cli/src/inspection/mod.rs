//! Pictures of a Plan: as a graph in DOT, Mermaid or SVG, and as a page to explore.
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
mod page;
mod summary;
mod svg;
mod thumbnail;

pub(crate) use dot::dot;
pub(crate) use mermaid::mermaid;
pub(crate) use page::{DeviceDifferences, Page, ShownPlan, live_page, page, page_data};
pub(crate) use svg::svg;
pub(crate) use thumbnail::Thumbnail;

/// A graph of more nodes than this isn't laid out: nobody could read the picture, and a browser could hardly hold it.
pub(crate) const MOST_NODES: usize = 3000;
