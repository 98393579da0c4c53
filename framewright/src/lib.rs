//! From a pipeline file to frames: the crate that programs depend on.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use framewright::{Device, DeviceOptions, Renderer, RendererOptions, SceneDrawSource, load_scene};
//!
//! let device = Device::open(&DeviceOptions::default())?;
//! let scene = load_scene("spheres_and_cubes")?;
//! let mut renderer = Renderer::open(&device, "forward", RendererOptions::default())?;
//! renderer.set("msaa", 4)?;
//! renderer.set_scene(&scene);
//! renderer.set_extent([640, 360])?;
//! let mut objects = SceneDrawSource::for_plan(&device, &scene, [640, 360], renderer.prepare()?.plan)?;
//! renderer.frame(&mut objects)?;
//! let texels = renderer.read("screen")?;
//! # drop(texels);
//! # Ok(())
//! # }
//! ```
//!
//! - [`Renderer`] reads a pipeline, has it compiled whenever something changed, and draws its frames. All that the command does with a
//!   pipeline's files works here too: shipped pipelines by name, `extends`, `include`, shaders and pictures of the folder.
//! - A program that draws objects of its own implements [`DrawSource`] in place of [`SceneDrawSource`].
//! - Errors are data ([`Error`]). What a file, a user or a device decides doesn't end the program; nor do shaders and drivers that go wrong,
//!   in a program with a [`Helper`].
//!
//! The layers below are reachable: [`graph`] reads, compiles and verifies, [`vulkan`] executes Plans, [`passes`] has the scene and the
//! shipped shaders, pipelines and scenes. [`PipelineFile`] and [`Pipeline`] are the way from a name to a document, and with [`Choices`] to
//! a Plan, on any device; a [`SceneRenderer`] draws a scene by that Plan.

mod assets;
mod choices;
mod error;
mod files;
mod frame_runs;
mod options;
mod pipeline;
mod renderer;
mod scene_renderer;
mod window;

pub use framewright_graph as graph;
pub use framewright_passes as passes;
pub use framewright_vulkan as vulkan;

pub use assets::Assets;
pub use choices::Choices;
pub use error::{Error, Mistakes};
pub use files::{FileOptions, PipelineFile, Reach, expect_scene, find_scene, folder_of, load_scene};
pub use framewright_graph::base::{Diagnostic, ReadFiles, Root};
pub use framewright_graph::frame::{Draw, DrawList, Stereo};
pub use framewright_graph::language::Facts;
pub use framewright_graph::plan::Plan;
pub use framewright_graph::shader::{
    Attribute, BindingFlags, DescriptorType, DrawInterface, DrawInterfaces, DrawKind, ProgramBinding, ProgramSet,
    SuppliedKind, SuppliedResource,
};
pub use framewright_graph::vulkan::{Format, Rotation};
pub use framewright_passes::draw::SceneDrawSource;
pub use framewright_passes::scene::Scene;
pub use framewright_vulkan::{
    BindGroup, Buffer, BufferBounds, BufferUsage, CullMode, CustomImage, CustomRecorder, Device, DeviceOptions,
    DispatchRecorder, DrawSource, DynamicBuffer, Executor, ExecutorOptions, EyeTarget, FrameReport, FrontFace, Helper,
    IndexType, LocalReads, Overlay, PrecompiledShaders, PresentMode, Presentation, ProgramBuffer, ProgramView, RawSet,
    Recorder, Resource, SamplerDescriptor, ScopeFormats, SecondaryRecorder, SemaphorePoint, SetLayouts,
    ShaderCompilers, ShaderLibrary, Submission, Surface, Swapchain, SwapchainOptions, Texels, Texture,
};
pub use options::RendererOptions;
pub use pipeline::{FileLinks, Pipeline, PlannedFrame};
pub use renderer::{CapturedTexels, Change, PreparedFrame, RefusedChange, Renderer};
pub use scene_renderer::{SceneRenderer, check_cameras};
