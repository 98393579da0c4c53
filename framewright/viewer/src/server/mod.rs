//! The live page's server, and what it tells browsers.

mod about;
mod answers;
mod connections;
mod controls;
mod look;
mod mistakes;
mod published_state;
mod saved_frame;

pub use about::About;
pub use answers::Server;
pub use controls::{Choice, Controls};
pub(crate) use look::Look;
pub use mistakes::ShownMistakes;
pub use published_state::{LiveProgram, LiveRenderer, LiveState, Output, PublishedState, ShownFinding, SourceText};
pub(crate) use saved_frame::saved_page;
