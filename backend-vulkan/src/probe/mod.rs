//! Facts about a device that only a trial tells: whether it draws as it claims, and whether its validation layer is awake.

mod canary;
mod claims;
mod depth_resolve;
mod draw;
mod integer_resolve;
pub(crate) mod multiview;
mod profile;
pub(crate) mod sample_resolve;
mod self_tests;

pub use canary::Canary;
