//! Buffers and textures that the draw source provides.

use crate::base::Error;
use crate::commands::{record_upload, staged};
use crate::gpu::{Device, Gpu, SamplerDescriptor};
use crate::memory::{Image, MemoryUse, RawBuffer, ViewShape};
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Format, Layout, Shape, Sharing, Subresources, Usage};
use std::sync::Arc;

/// The purpose of a buffer.
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

/// A texture's parts.
pub(crate) struct RawTexture {
    pub(crate) image: Arc<Image>,
    /// A view of all of the image.
    pub(crate) view: vk::ImageView,
    pub(crate) sampler: vk::Sampler,
}

impl Buffer {
    /// Bytes that it holds.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.0.bytes
    }

    /// Vulkan's own buffer, for pipelines and sets of the program's own. It lives as long as this or a clone: the program keeps one until
    /// the frames are done that read the buffer.
    #[must_use]
    pub fn raw(&self) -> vk::Buffer {
        self.0.raw
    }
}

impl Texture {
    /// Vulkan's own view of all of the texture, in the layout `SHADER_READ_ONLY_OPTIMAL`, and its sampler: for pipelines and sets of the
    /// program's own. Both live as long as this or a clone: the program keeps one until the frames are done that read the texture.
    #[must_use]
    pub fn raw(&self) -> (vk::ImageView, vk::Sampler) {
        (self.0.view, self.0.sampler)
    }
}

/// What Vulkan calls the usage of a buffer of `bytes` bytes.
///
/// # Errors
/// [`Error::BadResource`] if they are more than a block of the device can hold.
pub(super) fn flags_of(gpu: &Gpu, usage: BufferUsage, bytes: u64) -> Result<vk::BufferUsageFlags, Error> {
    let limits = &gpu.limits;
    use vk::BufferUsageFlags as Flags;
    let (flags, kind, most) = match usage {
        BufferUsage::Vertex => (Flags::VERTEX_BUFFER, "vertex", u64::MAX),
        BufferUsage::Index => (Flags::INDEX_BUFFER, "index", u64::MAX),
        BufferUsage::Uniform => (Flags::UNIFORM_BUFFER, "uniform", u64::from(limits.max_uniform_buffer_range)),
        BufferUsage::Storage => (Flags::STORAGE_BUFFER, "storage", u64::from(limits.max_storage_buffer_range)),
    };
    if bytes > most {
        let what = format!("a {kind} buffer of {bytes} bytes: {} takes at most {most}", gpu.summary.name);
        return Err(Error::BadResource { what });
    }
    Ok(flags)
}

impl Device {
    /// A buffer with these contents. An empty one holds 16 zero bytes, since Vulkan knows no empty buffers.
    ///
    /// # Errors
    /// No memory, or more than a uniform or storage block of this device can hold.
    pub fn buffer(&self, usage: BufferUsage, contents: &[u8]) -> Result<Buffer, Error> {
        let flags = flags_of(&self.gpu, usage, contents.len() as u64)?;
        let contents = if contents.is_empty() { &[0; 16] } else { contents };
        let mut buffer = RawBuffer::shared(&self.gpu, "buffer", contents.len() as u64, flags, MemoryUse::Upload)?;
        buffer.fill(contents)?;
        Ok(Buffer(Arc::new(buffer)))
    }

    /// A texture of `width` × `height` texels of `format`, rows from the top without padding. With `mips` a whole chain of
    /// smaller levels is made, each by averaging the one before. Texels of compressed formats are blocks, and have no such chain.
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
        let largest = self.gpu.limits.max_image_dimension2_d;
        if width == 0 || height == 0 || width > largest || height > largest {
            return Err(bad(format!("both must be from 1 to {largest} on this device")));
        }
        let expected = format.bytes([width, height, 1]);
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
        let is_on = format.feature().is_none_or(|feature| self.gpu.features.has(feature));
        if format.is_depth() || !is_on || !self.gpu.format_features(format).contains(needed) {
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
            // Compute passes may see it too, on a queue of their own.
            sharing: Sharing::Concurrent,
        };
        let image = Arc::new(Image::with_own_memory(&self.gpu, "texture", &descriptor)?);
        let staging = staged(&self.gpu, "texture upload", texels)?;
        self.gpu.submit_once("uploading a texture", Queue::Graphics, |commands| {
            record_upload(&self.gpu, commands, &image, (&staging, 1), Layout::ShaderReadOnlyOptimal);
        })?;
        let view = image.view(Subresources::all(format, levels, 1), ViewShape::Flat)?;
        Ok(Texture(Arc::new(RawTexture { image, view, sampler: self.gpu.texture_sampler(*sampler)? })))
    }

    /// The texels of `texture`, which they share, sampled another way.
    ///
    /// # Errors
    /// If the device has no room for another sampler.
    pub fn sampled(&self, texture: &Texture, sampler: &SamplerDescriptor) -> Result<Texture, Error> {
        let (image, view) = (texture.0.image.clone(), texture.0.view);
        Ok(Texture(Arc::new(RawTexture { image, view, sampler: self.gpu.texture_sampler(*sampler)? })))
    }
}
