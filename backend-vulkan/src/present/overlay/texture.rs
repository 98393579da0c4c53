//! The texels of an overlay on the device.

use crate::base::Error;
use crate::commands::{TransferSide, UNUSED, WRITTEN, barriers, copy_between, image_side, state_change};
use crate::gpu::{Gpu, LayoutBinding, SamplerDescriptor};
use crate::memory::{Image, MemoryUse, RawBuffer, ViewShape};
use crate::pipeline::{DescriptorSet, DescriptorTarget};
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::vulkan::{
    Accesses, AddressMode, Filter, Format, Layout, Numeric, Shape, Sharing, Stages, State, Subresources, Usage,
};
use std::sync::Arc;

/// The state in which overlays are drawn.
const SAMPLED: State = State {
    stages: Stages::FRAGMENT_SHADER,
    accesses: Accesses::SHADER_SAMPLED_READ,
    layout: Layout::ShaderReadOnlyOptimal,
};

/// The binding of the texture.
pub(super) fn binding() -> LayoutBinding {
    let ty = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
    LayoutBinding { binding: 0, ty, count: 1, stages: vk::ShaderStageFlags::FRAGMENT }
}

/// The texels of an overlay on the device, and a place for the next ones.
pub(super) struct OverlayTexture {
    pub(super) set: DescriptorSet,
    image: Image,
    staging: RawBuffer,
    /// What the next upload finds the image in.
    state: State,
}

impl OverlayTexture {
    /// Room for texels that are drawn into images of the format `shown`.
    pub(super) fn new(gpu: &Arc<Gpu>, [width, height]: [u32; 2], shown: Format) -> Result<OverlayTexture, Error> {
        let format = format_for(shown);
        let descriptor = ImageDescriptor {
            format,
            shape: Shape::D2,
            extent: [width, height, 1],
            mips: 1,
            layers: 1,
            samples: 1,
            usage: Usage::SAMPLED | Usage::TRANSFER_DST,
            sharing: Sharing::Exclusive,
        };
        let image = Image::with_own_memory(gpu, "overlay", &descriptor)?;
        let bytes = u64::from(width) * u64::from(height) * format.texel_bytes();
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = RawBuffer::new(gpu, "overlay upload", bytes, usage, MemoryUse::Upload)?;
        let sampler = SamplerDescriptor {
            magnify: Filter::Nearest,
            minify: Filter::Nearest,
            mip: Filter::Nearest,
            address: [AddressMode::ClampToEdge; 3],
        };
        let view = image.view(Subresources::all(format, 1, 1), ViewShape::Flat)?;
        let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
        let target = DescriptorTarget::Image(view, layout, gpu.sampler(sampler, None)?);
        let set = DescriptorSet::new(gpu, &[(binding(), vec![target])])?;
        Ok(OverlayTexture { set, image, staging, state: UNUSED })
    }

    /// Whether it has room for texels of this extent, for images of the format `shown`.
    pub(super) fn fits(&self, [width, height]: [u32; 2], shown: Format) -> bool {
        let ImageDescriptor { format, extent, .. } = self.image.descriptor;
        (format, extent) == (format_for(shown), [width, height, 1])
    }

    /// Has other texels uploaded with the next commands. No upload may be on its way.
    pub(super) fn stage(&mut self, texels: &[u8]) -> Result<(), Error> {
        self.staging.fill(texels)
    }

    /// Records the upload of what was staged.
    pub(super) fn record_upload(&self, gpu: &Gpu, commands: vk::CommandBuffer) {
        let whole = Subresources::all(self.image.descriptor.format, 1, 1);
        barriers(gpu, commands, &[], &[state_change(self.image.raw, whole, self.state, WRITTEN)]);
        let source = TransferSide::Buffer { buffer: self.staging.raw, bytes: self.staging.bytes };
        copy_between(gpu, commands, source, TransferSide::Image(image_side(&self.image, whole, 0)));
        barriers(gpu, commands, &[], &[state_change(self.image.raw, whole, WRITTEN, SAMPLED)]);
    }

    /// An upload that was recorded was submitted.
    pub(super) fn uploaded(&mut self) {
        self.state = SAMPLED;
    }
}

/// The format of texels that are drawn into images of this format: light is blended where the images hold light.
fn format_for(shown: Format) -> Format {
    match shown.numeric() {
        Numeric::Srgb => Format::R8G8B8A8_SRGB,
        _ => Format::R8G8B8A8_UNORM,
    }
}
