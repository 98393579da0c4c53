//! Executes Plans on Vulkan 1.3.
//!
//! The contract: a [`Plan`](framewright_graph::plan::Plan) says everything, and this crate decides nothing. It makes the
//! images that the Plan lists at the offsets that it lists, records the steps in its order with its barriers, and asks a
//! [`DrawSource`] for the draws of objects and sky. What a shader needs is matched by name with what its pass and the
//! draw source give it.
//!
//! This crate alone is unsafe inside; its interface is safe.

mod caches;
mod canary;
mod capabilities;
mod check;
mod convert;
mod descriptors;
mod device;
mod error;
mod executor;
mod image;
mod instance;
mod labels;
pub mod layer;
mod memory;
mod pass_set;
mod pipeline;
mod poison;
mod prepare;
mod readback;
mod record;
mod recorder;
mod resources;
pub mod shaders;
mod submit;
mod timing;
mod validation;

pub use caches::{AddressMode, SamplerDescriptor, TexelFilter};
pub use canary::Canary;
pub use capabilities::MINIMUM_VERSION;
pub use descriptors::{BindGroup, Resource};
pub use device::{Device, DeviceChoice, DeviceOptions, DeviceSummary};
pub use error::{Blame, Error, INSTALL};
pub use executor::{Executor, ExecutorOptions};
pub use memory::LiveMemory;
pub use readback::Texels;
pub use recorder::{CullMode, DrawSource, FrontFace, IndexType, Recorder};
pub use resources::{Buffer, BufferUsage, Texture};
pub use shaders::ShaderLibrary;
pub use timing::{FrameReport, PassReport, StepReport};
pub use validation::{Message, MessageKind, Messages, Severity};
