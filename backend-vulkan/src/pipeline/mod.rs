//! Samplers, layouts, descriptor sets and pipelines, and whether a shader fits its pass.

mod create;
mod descriptor_set;
mod fit;
mod graphics;
mod layouts;
pub(crate) mod parameters;
mod samplers;
mod shader_module;

pub(crate) use descriptor_set::{DescriptorSet, DescriptorTarget};
pub(crate) use fit::{
    brought_attributes, check_brought, check_needs, check_outputs, check_program, check_pushed, check_supplied,
    own_attributes,
};
pub(crate) use graphics::or_unused;
pub(crate) use layouts::PARTS_STAGES;
