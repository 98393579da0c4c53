//! The live page's server, and what it tells browsers.

mod answers;
mod controls;
mod published_state;
mod questions;

pub use answers::Server;
pub use controls::{Choice, Controls};
pub use published_state::{LiveState, Output, PublishedState, SourceText};
pub use questions::{AskedPicture, AskedPictures, PictureAnswer, Question};
