//! Objects that are made once for each description. A key is the whole description.
//!
//! Samplers and layouts live as long as the device. Pipelines do so while an executor is there: it may be using any of them. Those that
//! were not asked for in a while are destroyed when none is left, so that a program whose shaders change again and again doesn't grow.

use super::handle::Gpu;
use super::object_cache::ObjectCache;
use crate::shaders::Spirv;
use ash::vk;
use framewright_graph::frame::{Blend, RasterState, StencilState};
use framewright_graph::plan::DepthState;
use framewright_graph::shader::VertexRate;
use framewright_graph::vulkan::{AddressMode, ColorComponents, Filter, Rotation, Sampler};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The caches of a device.
#[derive(Default)]
pub(crate) struct Caches {
    pub(crate) samplers: ObjectCache<(SamplerDescriptor, Sampler), vk::Sampler>,
    pub(crate) set_layouts: ObjectCache<Vec<LayoutBinding>, vk::DescriptorSetLayout>,
    /// By set layouts, and the bytes of push constants.
    pub(crate) pipeline_layouts: ObjectCache<(Vec<vk::DescriptorSetLayout>, u32), vk::PipelineLayout>,
    pub(crate) pipelines: ObjectCache<PipelineDescriptor, vk::Pipeline>,
    /// How many hold on to pipelines.
    holders: Mutex<u32>,
}

/// A hold on pipelines: none is destroyed while it is there. A round of the cache ends when the last hold goes.
pub(crate) struct PipelineHold(Arc<Gpu>);

impl PipelineHold {
    pub(crate) fn new(gpu: &Arc<Gpu>) -> PipelineHold {
        *gpu.caches.holders() += 1;
        PipelineHold(Arc::clone(gpu))
    }
}

impl Drop for PipelineHold {
    fn drop(&mut self) {
        let Gpu { caches, raw, .. } = &*self.0;
        let mut holders = caches.holders();
        *holders -= 1;
        if *holders > 0 || self.0.is_abandoned() {
            return;
        }
        for pipeline in caches.pipelines.end_round() {
            // SAFETY: pipelines are used by executors and made for them, each with a hold. The last executor has waited for its
            // frames, and no other hold begins while their number is locked.
            unsafe { raw.destroy_pipeline(pipeline, None) };
        }
    }
}

impl Caches {
    fn holders(&self) -> MutexGuard<'_, u32> {
        self.holders.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Destroys everything.
    ///
    /// # Safety
    /// Nothing that uses any of it may be in use, now or later.
    pub(crate) unsafe fn destroy(&self, device: &ash::Device) {
        // SAFETY: the caller's promise.
        unsafe {
            self.pipelines.drain().into_iter().for_each(|it| device.destroy_pipeline(it, None));
            self.pipeline_layouts.drain().into_iter().for_each(|it| device.destroy_pipeline_layout(it, None));
            self.set_layouts.drain().into_iter().for_each(|it| device.destroy_descriptor_set_layout(it, None));
            self.samplers.drain().into_iter().for_each(|it| device.destroy_sampler(it, None));
        }
    }
}

/// How a texture is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SamplerDescriptor {
    /// Filter where the texture is shown enlarged.
    pub magnify: Filter,
    /// Filter where it is shown reduced.
    pub minify: Filter,
    /// Filter between mip levels.
    pub mip: Filter,
    /// Address modes beyond the edges, horizontally, vertically and in depth.
    pub address: [AddressMode; 3],
}

impl Default for SamplerDescriptor {
    /// Linear filters, and the texture again beyond its edges.
    fn default() -> SamplerDescriptor {
        let [magnify, minify, mip] = [Filter::Linear; 3];
        SamplerDescriptor { magnify, minify, mip, address: [AddressMode::Repeat; 3] }
    }
}

/// One binding of a set layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct LayoutBinding {
    pub(crate) binding: u32,
    pub(crate) ty: vk::DescriptorType,
    /// How many descriptors it has: the elements of an array, else one.
    pub(crate) count: u32,
    pub(crate) stages: vk::ShaderStageFlags,
    pub(crate) flags: vk::DescriptorBindingFlags,
}

/// What a graphics pipeline must fit to be bound in a rendering scope: the fields of `VkPipelineRenderingCreateInfo`, and the samples.
/// Scopes that are equal here can share pipelines.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct ScopeFormats {
    /// Formats of the colour attachments. A scope without any has one that is unused, of the format `UNDEFINED`.
    pub color: Vec<vk::Format>,
    /// The format of the depth attachment; `UNDEFINED` if there is none.
    pub depth: vk::Format,
    /// The format of the stencil attachment; `UNDEFINED` if there is none.
    pub stencil: vk::Format,
    /// Samples of each attachment.
    pub samples: vk::SampleCountFlags,
    /// Views that are drawn at once, a bit for each; 0 where there are none.
    pub view_mask: u32,
    /// How the pass sees the colour attachments of its scope, where passes of the scope read what it drew; `None`: output locations and
    /// input attachments have the numbers of the attachments.
    pub local: Option<LocalReads>,
}

/// Everything that a pipeline is made of.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum PipelineDescriptor {
    Graphics(Box<GraphicsDescriptor>),
    Compute { shader: Spirv, layout: vk::PipelineLayout },
}

/// Everything that a graphics pipeline is made of. Viewport, scissor, cull mode and front face are set while recording.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct GraphicsDescriptor {
    pub(crate) vertex: Spirv,
    /// `None`: nothing but depth is drawn.
    pub(crate) fragment: Option<Spirv>,
    pub(crate) layout: vk::PipelineLayout,
    /// The vertex buffers that the attributes are read from.
    pub(crate) vertex_buffers: Vec<VertexBinding>,
    pub(crate) attributes: Vec<VertexAttribute>,
    pub(crate) formats: ScopeFormats,
    /// How each colour attachment is blended, and which channels of it are written. `None`: it isn't written.
    pub(crate) blend: Vec<Option<(Blend, ColorComponents)>>,
    pub(crate) raster: RasterState,
    pub(crate) depth: Option<DepthState>,
    pub(crate) stencil: Option<StencilState>,
    pub(crate) alpha_to_coverage: bool,
    pub(crate) turned: Option<RotationConstants>,
}

/// Specialization constants of shaders that draw a rotated picture: shaders/include/rotation.glsl has the same numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct RotationConstants {
    pub(crate) rotation: Rotation,
    /// Width and height of the turned picture; 0 for shaders that don't ask, which serve for all sizes then.
    pub(crate) extent: [u32; 2],
}

/// How a pass of a rendering scope with local reads sees the scope's colour attachments: what a pipeline chains to fit, and how it blends.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct LocalReads {
    /// The shader's output location of each (`VkRenderingAttachmentLocationInfoKHR`).
    pub locations: Vec<u32>,
    /// The shader's input attachment index of each (`VkRenderingInputAttachmentIndexInfoKHR`).
    pub inputs: Vec<u32>,
    /// Whether the pass draws into each. Of those that it doesn't draw into no channel is written.
    pub drawn: Vec<bool>,
}

/// A vertex buffer of a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct VertexBinding {
    pub(crate) binding: u32,
    /// Bytes from element to element.
    pub(crate) stride: u32,
    pub(crate) rate: VertexRate,
}

/// A vertex attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct VertexAttribute {
    pub(crate) location: u32,
    pub(crate) binding: u32,
    pub(crate) format: vk::Format,
    pub(crate) offset: u32,
}
