//! Executes Plans on Vulkan 1.3.
//!
//! # The contract
//!
//! A [`Plan`](framewright_graph::plan::Plan) says everything, and this crate decides nothing. It makes the images that the
//! Plan lists at the offsets that it lists, records the steps in its order with its barriers, and asks a [`DrawSource`] for
//! the draws of objects and sky. What a shader needs is matched by name with what its pass and the draw source give it.
//!
//! - [`ShaderLibrary`] finds, compiles and reflects shaders. It needs no device.
//! - [`Device`] is opened by choice, default or name, or adopted from the program ([`Device::adopt`]); it lists what it can do ([`Device::profile`]) and what images take of
//!   its memory ([`Device::memory`]), which is all that compiling a Plan needs. Everything made from a device keeps it open.
//! - [`Executor`] verifies a Plan, refuses it if it was made for other memory needs, and draws its frames one after
//!   another; several may be in flight.
//! - Errors are data ([`Error`]), and say whether files, machine or program are to blame ([`Error::blame`]). A device that is
//!   lost or doesn't answer is an error like any other. [`Device::cancel_when`] gives up waits before they are over.
//!
//! # The minimum device
//!
//! Vulkan 1.3 with a graphics queue that has timestamps, and the features of [`minimum_features`]: `dynamicRendering`,
//! `synchronization2`, `maintenance4`, `shaderDemoteToHelperInvocation`, `shaderTerminateInvocation`, `timelineSemaphore`,
//! `hostQueryReset`, `separateDepthStencilLayouts`, `robustBufferAccess`,
//! `independentBlend`, `fragmentStoresAndAtomics`, `sampleRateShading`. [`DeviceSummary::missing`] lists all that a device
//! lacks of them. Beyond, shaders and draws may need local reads and some of [`optional_features`], where the device has them.
//!
//! # Validation
//!
//! [`DeviceOptions::validation`] puts the Khronos validation layer between this crate and the driver, with synchronisation
//! validation and, where the layer knows them, the settings that make it look at dynamic rendering. [`layer`] says how the
//! current layer is found. Silence proves something only after [`Device::canary`].
//!
//! # Untrusted shaders and drivers
//!
//! GLSL is compiled and drivers are tested in a helper process, if the program names one: see [`helper`].
//!
//! This crate is the only layer with unsafe code inside. Its interface is safe, but for [`Executor::with_hazards`].

mod base;
mod commands;
mod execute;
mod gpu;
pub mod helper;
mod memory;
mod pipeline;
mod prepare;
mod present;
mod probe;
mod process;
mod record;
mod resources;
pub mod shaders;

/// Vulkan's own types, for programs that record commands of their own or import images and buffers.
pub use ash;
pub use base::{Blame, BrokenPromise, Cache, CachedFiles, Error, INSTALL, end_process};
pub use commands::Texels;
pub use execute::{Executor, ExecutorOptions, ExternalStates, ResourceState, SemaphorePoint, Submission};
pub use framewright_graph::vulkan::OutsideOwner;
/// The faces that draws leave out, and which side is the front.
pub use framewright_graph::vulkan::{CullMode, FrontFace};
pub use gpu::{
    AdoptedDevice, BufferBounds, DeadImages, Device, DeviceChoice, DeviceFeatures, DeviceOptions, DeviceSummary,
    LocalReads, MINIMUM_VERSION, Message, MessageKind, Messages, PipelineCounts, RenderDoc, SamplerDescriptor,
    ScopeFormats, Severity, layer, minimum_features, optional_features, rotation_of_surface,
};
/// The allocator of device memory, for programs whose own one serves an [adopted](AdoptedDevice) device.
pub use gpu_allocator;
pub use helper::Helper;
pub use memory::{LiveMemory, MemoryInUse};
pub use present::{Overlay, PresentMode, Presentation, Surface, Swapchain, SwapchainOptions};
pub use probe::Canary;
pub use process::LARGEST_SPIRV;
/// The handles of windows and displays, for programs that show pictures.
pub use raw_window_handle;
pub use record::{
    CustomImage, CustomRecorder, DispatchRecorder, DrawSource, EyeTarget, FrameReport, IndexType, PassReport, Recorder,
    SecondaryRecorder, StepReport,
};
pub use resources::{
    BindGroup, Buffer, BufferUsage, DynamicBuffer, ProgramBuffer, ProgramView, RawSet, Resource, Texture,
};
pub use shaders::{BadCompiler, PrecompiledShaders, SetLayouts, ShaderCompilers, ShaderLibrary};
