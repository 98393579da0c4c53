//! Facts about a device that only a trial tells: whether it draws as it claims, and whether its validation layer is awake.

mod canary;
mod claims;
pub(crate) mod depth_resolve;
mod draw;
pub(crate) mod multiview;
mod profile;
mod self_tests;

pub use canary::Canary;
