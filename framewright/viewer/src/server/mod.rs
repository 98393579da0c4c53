//! The live page's server, and what it tells browsers.

mod about;
mod answers;
mod connections;
mod controls;
mod look;
mod mistakes;
mod published_state;
mod questions;
mod saved_frame;

pub use about::About;
pub use answers::Server;
pub use controls::{Choice, Controls};
pub(crate) use look::Look;
pub use mistakes::ShownMistakes;
pub use published_state::{LiveProgram, LiveRenderer, LiveState, Output, PublishedState, ShownFinding, SourceText};
pub use questions::{AskedPicture, AskedPictures, PictureAnswer, Question};
pub(crate) use saved_frame::saved_page;
