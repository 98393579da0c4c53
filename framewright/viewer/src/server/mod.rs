//! The live page's server, and what it tells browsers.

mod controls;
mod published_state;
mod answers;

pub use controls::{Choice, Controls};
pub use published_state::{LiveState, Output, PublishedState, SourceText};
pub use answers::Server;
