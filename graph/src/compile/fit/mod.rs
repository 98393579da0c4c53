//! `fit`: sample counts, formats and usages meet the device's support.

mod check_needs;
mod formats;
mod needs;
mod samples;
mod support;

pub(super) use check_needs::check_needs;
pub(super) use formats::formats;
pub(super) use samples::{drawn_together, negotiate};
pub(super) use support::check_support;
