//! Vulkan's own words as plain data: formats, layouts, stages, accesses, usages, and what follows from them alone.

mod encoding;
mod enums;
mod foreign_formats;
mod format;
mod image_shape;
mod name;
mod rotation;
pub(crate) mod states;

pub use encoding::*;
pub use enums::*;
pub(crate) use foreign_formats::vulkans_name;
pub use format::*;
pub(crate) use image_shape::extent_at;
pub use image_shape::{Component, Dimension, ImageShape};
pub(crate) use name::name_of;
pub use rotation::*;
