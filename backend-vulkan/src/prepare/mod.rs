//! A Plan turned into what recording walks: images and buffers, views, descriptor sets, pipelines, and a list of commands with
//! Vulkan's own structures.

mod batches;
mod check;
mod check_steps;
mod command_list;
mod descriptions;
mod draw_target;
mod frame;
mod initial_ownership;
mod labels;
mod param_block;
mod pass;
mod pass_set;
mod physical;
mod poison;
mod prepared_step;
mod rings;
mod scope;
mod step;
mod steps;
mod supplied_sets;
mod textures;
mod uses;
mod variant;
mod watch_list;

pub(crate) use batches::{Batch, batches};
pub(crate) use check::{Refusals, check, check_alone, refused_owner};
pub(crate) use command_list::{
    Bindings, Command, CommandList, DispatchCommand, DrawCommand, DrawCounts, DrawnVertices, Faces, OwnDraw,
    ScopeCommand, WorkgroupCount,
};
pub(crate) use descriptions::{buffer_descriptor, cycle, descriptor, part};
pub(crate) use draw_target::{DrawTarget, scissor, viewport};
pub(crate) use frame::{Frame, FrameClock};
pub(crate) use initial_ownership::{InitialOwner, initial_owners, initial_queue};
pub(crate) use param_block::ParamBlock;
pub(crate) use pass::{PassState, PreparedDraw};
pub(crate) use physical::PhysicalResources;
pub(crate) use poison::pattern;
pub(crate) use prepared_step::{Debugging, Preparation, PreparedPlan, Replaced};
pub(crate) use step::{PreparedStep, numbered, numbered_titles};
pub(crate) use supplied_sets::{SuppliedBlock, SuppliedSet, SuppliedSets};
pub(crate) use textures::{StagedTexture, file_of, stage_textures};
pub(crate) use uses::ResourceUses;
pub(crate) use variant::view_mask;
pub(crate) use watch_list::{DeclaredUse, PartPromise, WatchedPart, WatchedStep, declared_uses, watch_list};
