//! What whoever draws brings along: buffers and textures.

use crate::buffer::RawBuffer;
use crate::caches::SamplerDescriptor;
use crate::device::{Device, Shared};
use crate::error::Error;
use crate::image::{Image, View, ViewShape};
use crate::memory::Kind;
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::plan::{Queue, Subresources};
use framewright_graph::vulkan::{Format, Shape, Sharing, Usage};
use std::sync::Arc;

/// What a buffer is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BufferUsage {
    /// Vertex attributes.
    Vertex,
    /// Indices.
    Index,
    /// A uniform block.
    Uniform,
    /// A storage block.
    Storage,
}

/// A buffer that shaders read. Clones share it.
#[derive(Clone)]
pub struct Buffer(pub(crate) Arc<RawBuffer>);

/// A texture with its sampler. Clones share it.
#[derive(Clone)]
pub struct Texture(pub(crate) Arc<RawTexture>);

/// A texture's parts. Fields are dropped in this order.
pub(crate) struct RawTexture {
    pub(crate) view: Arc<View>,
    pub(crate) sampler: vk::Sampler,
}

impl Buffer {
    /// Bytes that it holds.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.0.bytes
    }
}

impl Device {
    /// A buffer with these contents. An empty one holds 16 zero bytes, since Vulkan knows no empty buffers.
    ///
    /// # Errors
    /// No memory, or more than a uniform or storage block of this device can hold.
    pub fn buffer(&self, usage: BufferUsage, contents: &[u8]) -> Result<Buffer, Error> {
        let limits = &self.shared.limits;
        let (flags, most) = match usage {
            BufferUsage::Vertex => (vk::BufferUsageFlags::VERTEX_BUFFER, u64::MAX),
            BufferUsage::Index => (vk::BufferUsageFlags::INDEX_BUFFER, u64::MAX),
            BufferUsage::Uniform => (vk::BufferUsageFlags::UNIFORM_BUFFER, u64::from(limits.max_uniform_buffer_range)),
            BufferUsage::Storage => (vk::BufferUsageFlags::STORAGE_BUFFER, u64::from(limits.max_storage_buffer_range)),
        };
        let bytes = contents.len() as u64;
        if bytes > most {
            let what = format!("{usage:?} buffer of {bytes} bytes: {} takes at most {most}", self.shared.summary.name);
            return Err(Error::BadResource { what });
        }
        let contents = if contents.is_empty() { &[0; 16] } else { contents };
        let mut buffer = RawBuffer::new(&self.shared, "buffer", contents.len() as u64, flags, Kind::Upload)?;
        buffer.fill(contents)?;
        Ok(Buffer(Arc::new(buffer)))
    }

    /// A texture of `width` × `height` texels of `format`, rows from the top without padding. With `mips` a whole chain of
    /// smaller levels is made, each by averaging the one before.
    ///
    /// # Errors
    /// An extent that is zero or too large, a number of bytes that doesn't fit it, a format that can't be sampled, or no
    /// memory.
    pub fn texture(
        &self,
        width: u32,
        height: u32,
        format: Format,
        texels: &[u8],
        sampler: &SamplerDescriptor,
        mips: bool,
    ) -> Result<Texture, Error> {
        let bad =
            |what: String| Error::BadResource { what: format!("texture of {width} × {height} {format}: {what}") };
        let largest = self.shared.limits.max_image_dimension2_d;
        if width == 0 || height == 0 || width > largest || height > largest {
            return Err(bad(format!("both must be from 1 to {largest} on this device")));
        }
        let expected = u64::from(width) * u64::from(height) * format.texel_bytes();
        if texels.len() as u64 != expected {
            return Err(bad(format!("{} bytes were given, {expected} are needed", texels.len())));
        }
        let needed = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR
            | vk::FormatFeatureFlags::TRANSFER_DST
            | if mips {
                vk::FormatFeatureFlags::BLIT_SRC | vk::FormatFeatureFlags::BLIT_DST
            } else {
                Default::default()
            };
        if format.is_depth() || !self.shared.format_features(format).contains(needed) {
            return Err(bad("this device can't upload and filter the format".to_owned()));
        }
        let levels = if mips { u32::BITS - width.max(height).leading_zeros() } else { 1 };
        let descriptor = ImageDescriptor {
            format,
            shape: Shape::D2,
            extent: [width, height, 1],
            mips: levels,
            layers: 1,
            samples: 1,
            usage: Usage::SAMPLED | Usage::TRANSFER_DST | if levels > 1 { Usage::TRANSFER_SRC } else { Usage::empty() },
            sharing: Sharing::Exclusive,
        };
        let image = Arc::new(Image::with_own_memory(&self.shared, "texture", &descriptor)?);
        upload(&self.shared, &image, texels)?;
        let view = Arc::new(View::new(&image, Subresources::all(format, levels, 1), ViewShape::Flat)?);
        Ok(Texture(Arc::new(RawTexture { view, sampler: self.shared.sampler(*sampler)? })))
    }

    /// The texels of `texture`, which they share, sampled another way.
    ///
    /// # Errors
    /// If the device has no room for another sampler.
    pub fn sampled(&self, texture: &Texture, sampler: &SamplerDescriptor) -> Result<Texture, Error> {
        let view = texture.0.view.clone();
        Ok(Texture(Arc::new(RawTexture { view, sampler: self.shared.sampler(*sampler)? })))
    }
}

/// Fills the first level of `image`, makes the others, and leaves all of them ready to be sampled.
fn upload(shared: &Arc<Shared>, image: &Image, texels: &[u8]) -> Result<(), Error> {
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let mut staging = RawBuffer::new(shared, "texture upload", texels.len() as u64, usage, Kind::Upload)?;
    staging.fill(texels)?;
    shared.submit_once("uploading a texture", Queue::Graphics, |commands| {
        record_upload(shared, commands, image, &staging, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
    })
}

/// Records the copy of a new image's first level from `staging`, which must live as long as the commands, and of each smaller
/// one from the level before; all of it is in the layout `ready` then, for whatever comes next on the queue.
pub(crate) fn record_upload(
    shared: &Shared,
    commands: vk::CommandBuffer,
    image: &Image,
    staging: &RawBuffer,
    ready: vk::ImageLayout,
) {
    let levels = image.descriptor.mips;
    let extent = image.descriptor.extent;
    let copy = vk::BufferImageCopy::default().image_subresource(level(0)).image_extent(crate::convert::extent(extent));
    let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    transition(shared, commands, image.raw, 0..levels, vk::ImageLayout::UNDEFINED, target);
    // SAFETY: the buffer holds all texels of the level, and both live until the submission was waited for.
    unsafe { shared.raw.cmd_copy_buffer_to_image(commands, staging.raw, image.raw, target, &[copy]) };
    for smaller in 1..levels {
        let corner = |level: u32| {
            let [x, y, z] = extent.map(|side| i32::try_from((side >> level).max(1)).unwrap_or(i32::MAX));
            [vk::Offset3D::default(), vk::Offset3D { x, y, z }]
        };
        let blit = vk::ImageBlit::default()
            .src_subresource(level(smaller - 1))
            .src_offsets(corner(smaller - 1))
            .dst_subresource(level(smaller))
            .dst_offsets(corner(smaller));
        let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        transition(shared, commands, image.raw, smaller - 1..smaller, target, source);
        // SAFETY: both levels exist and are in these layouts.
        unsafe {
            let linear = vk::Filter::LINEAR;
            shared.raw.cmd_blit_image(commands, image.raw, source, image.raw, target, &[blit], linear);
        }
    }
    if levels > 1 {
        transition(shared, commands, image.raw, 0..levels - 1, vk::ImageLayout::TRANSFER_SRC_OPTIMAL, ready);
    }
    transition(shared, commands, image.raw, levels - 1..levels, target, ready);
}

fn level(level: u32) -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        mip_level: level,
        base_array_layer: 0,
        layer_count: 1,
    }
}

/// A barrier between two uses of some levels in one upload.
fn transition(
    shared: &Shared,
    commands: vk::CommandBuffer,
    image: vk::Image,
    levels: std::ops::Range<u32>,
    old: vk::ImageLayout,
    new: vk::ImageLayout,
) {
    let barrier = vk::ImageMemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
        .old_layout(old)
        .new_layout(new)
        .image(image)
        .subresource_range(vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            base_mip_level: levels.start,
            level_count: levels.end - levels.start,
            base_array_layer: 0,
            layer_count: 1,
        });
    let barriers = [barrier];
    let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
    // SAFETY: the command buffer is being recorded, and the levels exist.
    unsafe { shared.raw.cmd_pipeline_barrier2(commands, &info) };
}
