//! `emit`: puts the stages' decisions into a [`Plan`](crate::plan::Plan), or brings a Plan up to date.

mod attachments;
mod barriers;
mod header;
mod notes;
mod outputs;
mod owners;
mod ownership;
mod passes;
mod plan;
mod resources;
mod revise;
mod stage_results;

pub(super) use plan::emit;
pub(super) use revise::put_in_values;
