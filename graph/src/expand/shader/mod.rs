//! What a pass gives meets what its shader declares.
//!
//! ```text
//! variant ─► interfaces (Checked) ─► sampled ─► local ─► storage ─► params
//!                                    arrays, compared   supplied   coverage, halves, rotation, seen_alike
//! ```
//! `variant` says how the shader is compiled, `interfaces` finds it. Each other file holds one kind of declaration against the pass, or
//! asks the shader one thing that the frame must know.

mod arrays;
mod compared;
pub(super) mod coverage;
pub(super) mod halves;
mod interfaces;
pub(super) mod local;
pub(super) mod params;
pub(super) mod rotation;
pub(super) mod sampled;
pub(super) mod seen_alike;
pub(super) mod storage;
pub(super) mod supplied;
pub(super) mod variant;

pub(super) use interfaces::{Checked, missing};
