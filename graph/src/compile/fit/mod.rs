//! `fit`: sample counts, formats and usages meet the device's support.

mod formats;
mod needs;
mod needs_of_shaders;
mod samples;
mod support;

pub(super) use formats::{Formats, formats};
pub(super) use needs_of_shaders::check_needs;
pub(super) use samples::{drawn_together, negotiate, still_holds};
pub(super) use support::check_support;
