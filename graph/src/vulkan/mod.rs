//! Vulkan's own words as plain data: formats, layouts, stages, accesses, usages, and properties that follow from them alone.

pub(crate) mod access;
mod compression;
mod encoding;
mod enums;
mod fill_value;
mod foreign_formats;
mod format;
mod image_shape;
pub(crate) mod layout;
mod name;
mod outside_owner;
mod raster;
mod real;
mod rotation;
mod sampler;
mod stage;
pub(crate) mod states;
mod vertex_format;

pub use access::AccessKind;
pub use encoding::Encoding;
pub use enums::{
    Accesses, Aspects, BufferUsage, CompareOp, Filter, Layout, LoadOp, ResolveMode, Shape, Sharing, Stages, State,
    StencilOp, StoreOp, Subresources, Usage,
};
pub use fill_value::FillValue;
pub(crate) use foreign_formats::vulkans_name;
pub use format::{Format, Numeric};
pub(crate) use image_shape::extent_at;
pub use image_shape::{Component, Dimension, ImageShape};
pub(crate) use name::in_plan;
pub use name::name_of;
pub use outside_owner::OutsideOwner;
pub use raster::{BlendFactor, BlendOp, ColorComponents, CullMode, FrontFace, PrimitiveTopology};
pub use real::Real;
pub use rotation::Rotation;
pub use sampler::{AddressMode, BorderColor, Sampler, SamplerReductionMode};
pub use vertex_format::VertexFormat;
