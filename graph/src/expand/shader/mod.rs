//! What a pass gives meets what its shader declares.
//!
//! ```text
//! variant ─► interfaces ─► sampled_images (arrays, compared_depth), samplers ─► local ─► storage ─► supplied_resources ─► params, constants
//! ```
//! `variant` says how the shader is compiled, `interfaces` finds it. The files behind them check one kind of
//! declaration each. `coverage`, `rotation` and `stereo` find out what else the frame must know of a shader.

mod arrays;
mod compared_depth;
pub(super) mod constants;
pub(super) mod coverage;
mod interfaces;
pub(super) mod local;
pub(super) mod params;
mod parts_in_use;
pub(super) mod rotation;
pub(super) mod sampled_images;
pub(super) mod samplers;
pub(super) mod stereo;
pub(super) mod storage;
pub(super) mod supplied_resources;
pub(super) mod variant;

pub(super) use interfaces::{CheckedShaders, missing};
