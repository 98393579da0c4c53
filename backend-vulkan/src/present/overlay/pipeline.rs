//! The pipeline that draws an overlay.

use super::shaders;
use super::texture::binding;
use crate::base::{Error, convert};
use crate::gpu::{Gpu, GraphicsDescriptor, PipelineDescriptor, ScopeFormats};
use ash::vk;
use framewright_graph::frame::Blend;
use framewright_graph::vulkan::Format;
use std::sync::Arc;

/// The pipeline for images of one format.
pub(super) struct OverlayPipeline {
    gpu: Arc<Gpu>,
    pub(super) raw: vk::Pipeline,
    pub(super) layout: vk::PipelineLayout,
    pub(super) format: Format,
}

impl OverlayPipeline {
    pub(super) fn new(gpu: &Arc<Gpu>, format: Format) -> Result<OverlayPipeline, Error> {
        let layout = gpu.pipeline_layout(vec![gpu.set_layout(vec![binding()])?])?;
        let formats = ScopeFormats {
            color: vec![convert::format(format)],
            depth: vk::Format::UNDEFINED,
            stencil: vk::Format::UNDEFINED,
            samples: vk::SampleCountFlags::TYPE_1,
            view_mask: 0,
        };
        let descriptor = GraphicsDescriptor {
            vertex: shaders::vertex(),
            fragment: Some(shaders::fragment()),
            layout,
            strides: Vec::new(),
            attributes: Vec::new(),
            formats,
            blend: vec![Some(Blend::Alpha)],
            depth: None,
            stencil: None,
            alpha_to_coverage: false,
            local: None,
            turned: None,
        };
        Ok(OverlayPipeline {
            gpu: gpu.clone(),
            raw: gpu.own_pipeline("overlay", &PipelineDescriptor::Graphics(descriptor.into()))?,
            layout,
            format,
        })
    }
}

impl Drop for OverlayPipeline {
    fn drop(&mut self) {
        if !self.gpu.is_abandoned() {
            // SAFETY: its owner has waited for the device.
            unsafe { self.gpu.raw.destroy_pipeline(self.raw, None) };
        }
    }
}
