//! What only trying tells of a device: whether it draws as it says, and whether its validation layer is awake.

mod canary;
mod claims;
pub(crate) mod depth_resolve;
mod draw;
pub(crate) mod multiview;
mod profile;
mod self_tests;

pub use canary::Canary;
