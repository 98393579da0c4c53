//! A pipeline is taken apart for two eyes: passes that draw into images of each eye run for each eye.
//!
//! ```text
//! pass_eyes ─► separate_images ─► split: images, views, passes, outputs
//! ```

mod pass_eyes;
mod separate_images;
mod split;

use crate::frame::{EyeForm, Stereo};
use crate::language::Pass;

pub(super) use split::split;

/// How a frame is drawn for the eyes.
pub(super) struct Eyes<'e> {
    /// The way.
    pub(super) stereo: Stereo,
    /// How images hold both eyes' parts; `None`: none does.
    pub(super) form: Option<EyeForm>,
    /// Whether what a pass draws has attributes by instance.
    pub(super) by_instance: &'e dyn Fn(&Pass) -> bool,
}
