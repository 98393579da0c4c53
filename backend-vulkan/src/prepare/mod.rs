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
pub(crate) use descriptions::{buffer_descriptor, cycle, descriptor, name_and_role, part};
pub(crate) use history::RingCache;
pub(crate) use initial_ownership::{InitialOwner, initial_owners, initial_queue};
pub(crate) use pass::{PassState, PreparedDispatch, PreparedDraw, WorkgroupCount, groups};
pub(crate) use pass_set::{PassSet, SetTemplate};
pub(crate) use physical::PhysicalResources;
pub(crate) use prepared::{AttachmentViews, PreparedPlan, PreparedScope, PreparedStep};
pub(crate) use textures::{StagedTexture, stage_textures};
pub(crate) use uses::ResourceUses;
pub(crate) use variant::view_mask;
