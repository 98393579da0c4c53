//! `emit`: puts the stages' decisions into a [`Plan`](crate::plan::Plan), or brings a Plan up to date.

mod attachments;
mod barriers;
mod notes;
mod outputs;
mod ownership;
mod parts;
mod passes;
mod plan;
mod resources;
mod revise;
mod values;

pub(super) use parts::Parts;
pub(super) use plan::emit;
pub(super) use resources::resources;
pub(super) use revise::{barriers, sizes, values};
