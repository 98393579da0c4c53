//! A pipeline is taken apart for two eyes: passes that draw into images of each eye run for each eye.
//!
//! ```text
//! pass_eyes ─► separate_images ─► split: images, views, passes, outputs
//! ```

mod pass_eyes;
mod separate_images;
mod split;

pub(super) use split::split;
