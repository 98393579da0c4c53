//! What a Plan looks like: as a graph in DOT, Mermaid or SVG, as a page to explore, and as a page that a server keeps up to date.
//!
//! ```text
//! Plan ─► dataflow ─► graph ─► DOT, Mermaid, SVG
//!            └──────► page ─► a file, or the server's answers
//! ```

mod graph;
mod history;
pub mod html;
mod open_questions;
mod page;
mod program;
mod server;
mod times;
mod trace;
mod what_if;
mod xml;

pub use graph::{dot, mermaid, svg};
pub use history::{History, KeptState};
pub use page::{
    DeviceDifferences, MOST_NODES, Page, PictureSize, PictureTexels, ShownPlan, Thumbnail, live_page, page, page_data,
};
pub use program::{SaveError, Viewer};
pub use server::{
    About, AskedPicture, AskedPictures, Choice, Controls, LiveProgram, LiveRenderer, LiveState, Output, PictureAnswer,
    PublishedState, Question, Server, ShownFinding, ShownMistakes, SourceText,
};
pub use times::{LastFrames, Spread, StepTimes, TimedDevice, Times};
pub use trace::{TracedFrame, trace};
pub use what_if::{BadModule, WhatIf, page_with_what_if};
pub use xml::escaped as escape_xml;
