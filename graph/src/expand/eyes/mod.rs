//! A pipeline is taken apart for two eyes: passes that draw into images of each eye run for each eye.
//!
//! ```text
//! split (eyes of each pass) ─► at_once (images of both eyes) ─► split (images, views, passes, outputs)
//! ```

mod at_once;
mod split;

pub(super) use split::split;
