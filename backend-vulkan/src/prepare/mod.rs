//! A Plan turned into what recording walks: images and buffers, views, descriptor sets, pipelines.

mod batches;
mod check;
mod check_steps;
mod descriptions;
mod history;
mod initial_ownership;
mod pass;
mod pass_set;
mod physical;
mod prepared;
mod textures;
mod uses;
mod variant;

pub(crate) use batches::{Batch, batches};
pub(crate) use check::{Refuse, check};
pub(crate) use descriptions::{buffer_descriptor, cycle, descriptor, part};
pub(crate) use history::Turns;
pub(crate) use initial_ownership::{FirstOwner, before_first_frame, first_owners};
pub(crate) use pass::{Compute, Drawn, PassState, WorkgroupCount, groups};
pub(crate) use pass_set::{PassSet, SetTemplate};
pub(crate) use physical::Physical;
pub(crate) use prepared::{Prepared, Scope, Step, Views};
pub(crate) use textures::{Staged, staged};
pub(crate) use uses::Uses;
pub(crate) use variant::view_mask;
