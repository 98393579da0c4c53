//! The device: instance, validation layer, features, queues, and the handle that everything made from it holds on to.

mod adopted_device;
mod buffer_bounds;
mod cached_objects;
mod dead_images;
mod device;
mod device_features;
mod enabled_features;
mod extension_features;
pub(crate) mod features;
mod handle;
mod instance;
mod labels;
pub mod layer;
mod limits;
mod minimum;
mod needed_features;
mod object_cache;
mod pipeline_cache;
mod portability;
pub(crate) mod queues;
mod renderdoc;
mod summary;
mod surface;
pub(crate) mod switched_off;
mod validation;
mod words;

pub use adopted_device::AdoptedDevice;
pub use buffer_bounds::BufferBounds;
pub use cached_objects::{LocalReads, SamplerDescriptor, ScopeFormats};
pub use dead_images::DeadImages;
pub use device::{Device, DeviceOptions};
pub use device_features::DeviceFeatures;
pub use features::{minimum_features, optional_features};
pub use minimum::MINIMUM_VERSION;
pub use pipeline_cache::PipelineCounts;
pub use renderdoc::RenderDoc;
pub use summary::{DeviceChoice, DeviceSummary};
pub use surface::rotation_of_surface;
pub use validation::{Message, MessageKind, Messages, Severity};

pub(crate) use cached_objects::{
    GraphicsDescriptor, LayoutBinding, PipelineDescriptor, PipelineHold, RotationConstants, VertexAttribute,
    VertexBinding,
};
pub(crate) use device::TestedDevice;
pub(crate) use handle::{Gpu, PendingWork};
pub(crate) use labels::c_string;
pub(crate) use queues::QueueFamily;
