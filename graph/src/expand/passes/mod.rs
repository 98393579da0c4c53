//! Passes of the frame: each is lowered and checked against its images, buffers and shader.
//!
//! ```text
//! targets ─► lower (transfers ─► work, shader/*) ─► state ─► depth_only ─► casters, views
//! ```
//! `lower` makes one pass, `state` is that pass or what stands in for one that is off. The files behind it look at all passes.

pub(super) mod casters;
pub(super) mod depth_only;
mod lower;
mod raster;
mod state;
pub(super) mod targets;
mod transfers;
pub(super) mod views;
pub(super) mod work;

pub(super) use lower::{draft, lower, stand_ins};
pub(super) use state::State;
