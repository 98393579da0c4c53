//! What a Plan looks like: as a graph in DOT, Mermaid or SVG, as a page to explore, and as a page that a server keeps up to date.
//!
//! ```text
//! Plan ─► dataflow ─► graph ─► DOT, Mermaid, SVG
//!            └──────► page ─► a file, or the server's answers
//! ```

mod graph;
mod history;
pub mod html;
mod page;
mod program;
mod server;
mod times;
mod trace;
mod xml;

pub use graph::{dot, mermaid, svg};
pub use history::{History, KeptState};
pub use page::{DeviceDifferences, MOST_NODES, Page, ShownPlan, Thumbnail, live_page, page, page_data};
pub use program::Viewer;
pub use server::{Choice, Controls, LiveState, Output, PublishedState, Server, SourceText};
pub use times::{LastFrames, Spread, StepTimes, TimedDevice, Times};
pub use trace::{TracedFrame, trace};
pub use xml::escaped as escape_xml;
