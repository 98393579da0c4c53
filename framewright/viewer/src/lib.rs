//! What a Plan looks like: as a graph in DOT, Mermaid or SVG, as a page to explore, and as a page that a server keeps up to date.
//!
//! ```text
//! Plan ─► dataflow ─► graph ─► DOT, Mermaid, SVG
//!            └──────► page ─► a file, or the server's answers
//! ```

mod graph;
pub mod html;
mod page;
mod program;
mod server;
mod times;
mod xml;

pub use graph::{dot, mermaid, svg};
pub use page::{DeviceDifferences, MOST_NODES, Page, ShownPlan, Thumbnail, live_page, page, page_data};
pub use program::{SaveError, Viewer};
pub use server::{
    About, Choice, Controls, LiveProgram, LiveRenderer, LiveState, Output, PublishedState, Server, ShownFinding,
    ShownMistakes, SourceText,
};
pub use times::{LastFrames, Spread, StepTimes, Times};
pub use xml::escaped as escape_xml;
