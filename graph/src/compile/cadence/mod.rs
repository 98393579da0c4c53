//! Passes that don't run in every frame: what they write stays for the frames in which they don't.
//!
//! `check` refuses frames whose readers would find something else where a pass is left out. `keep` gives memory of its own to what is
//! read in other frames than it is written.

mod check;
mod keep;

pub(super) use check::check;
pub(super) use keep::keep;
