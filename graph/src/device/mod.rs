//! What a device can do, as data: read from a live device by a backend, or from a saved profile.

mod saved;

pub use saved::{ProfileError, SHIPPED_PROFILES};

use crate::format::Format;
use crate::frame::Shape;
use crate::plan::Sharing;
use crate::vocabulary::{BufferUsage, Usage};
use serde::{Deserialize, Serialize};

/// A device's capabilities, as far as a Plan depends on them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// The device's own name.
    pub name: String,
    /// Driver and version, and where the figures come from.
    pub source: String,
    /// Largest width and height of an attachment, in texels.
    pub max_attachment_extent: u32,
    /// Largest width, height and depth of a three-dimensional image, in texels.
    #[serde(default = "least_extent_3d")]
    pub max_extent_3d: u32,
    /// Most array layers of an image.
    #[serde(default = "least_layers")]
    pub max_layers: u32,
    /// Most colour attachments of one rendering scope.
    pub max_color_attachments: u32,
    /// Whether it has lazily allocated memory for transient attachments.
    pub lazily_allocated_memory: bool,
    /// Queues beside the one that does everything.
    #[serde(default)]
    pub queues: Queues,
    /// Whether fragment shaders can read what earlier passes of their rendering scope drew at the same position
    /// (`VK_KHR_dynamic_rendering_local_read`).
    #[serde(default)]
    pub local_read: bool,
    /// What each format can be; formats that are absent can be nothing.
    pub formats: Vec<FormatSupport>,
    /// How much memory images take.
    pub memory: MemoryModel,
    /// Memory needs that were read from the device, sorted by descriptor; all others are estimated by the model.
    #[serde(default)]
    pub known_needs: Vec<KnownNeeds>,
    /// Values above that no public source states, and what was assumed.
    #[serde(default)]
    pub unknown: Vec<String>,
}

/// The least that Vulkan demands.
const fn least_extent_3d() -> u32 {
    256
}

/// The least that Vulkan demands.
const fn least_layers() -> u32 {
    256
}

/// Queues beside the one that does graphics, compute and transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Queues {
    /// A queue for compute and transfer.
    pub compute: bool,
    /// A queue for transfer only.
    pub transfer: bool,
    /// How images that several queues use are shared: handed over, or used by all without a loss.
    pub sharing: Sharing,
}

/// The memory needs of one image on a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnownNeeds {
    /// The image.
    pub image: ImageDescriptor,
    /// What it needs.
    pub needs: MemoryNeeds,
}

/// What one format can be on a device (optimal tiling).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FormatSupport {
    /// Which format.
    pub format: Format,
    /// Uses that it supports.
    pub usage: Usage,
    /// Whether linear filtering works.
    pub linear_filter: bool,
    /// Whether blending works.
    pub blend: bool,
    /// Sample counts as an attachment, rising; 1 is among them if it can be an attachment at all.
    pub samples: Vec<u32>,
}

/// A model of how much memory an image takes, for a device that is not here.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MemoryModel {
    /// Alignment of an image's offset, in bytes.
    pub alignment: u64,
    /// Rows are padded to a multiple of this many texels.
    pub row_texels: u32,
    /// Heights are padded to a multiple of this many rows.
    pub rows: u32,
}

/// The full descriptor of an image: compatibility, aliasing and caches compare all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImageDescriptor {
    /// Texel format.
    pub format: Format,
    /// Flat, deep, or a cube.
    pub shape: Shape,
    /// Width, height, depth in texels.
    pub extent: [u32; 3],
    /// Mip levels.
    pub mips: u32,
    /// Array layers.
    pub layers: u32,
    /// Samples a texel.
    pub samples: u32,
    /// What it is used for.
    pub usage: Usage,
    /// Which queues may use it.
    pub sharing: Sharing,
}

/// The full descriptor of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BufferDescriptor {
    /// Bytes.
    pub bytes: u64,
    /// What it is used for.
    pub usage: BufferUsage,
    /// Which queues may use it.
    pub sharing: Sharing,
}

/// What an image needs of memory (`VkMemoryRequirements`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct MemoryNeeds {
    /// Bytes.
    pub bytes: u64,
    /// Alignment of the offset, a power of two.
    pub alignment: u64,
    /// Which memory types will do, one bit each (`memoryTypeBits`).
    pub type_bits: u32,
}

/// Where memory needs come from.
pub trait MemoryProvider {
    /// Whether the needs are those of a real device, or estimated.
    fn exact(&self) -> bool;
    /// The needs of one image.
    fn image(&mut self, descriptor: &ImageDescriptor) -> MemoryNeeds;
    /// The needs of one buffer.
    fn buffer(&mut self, descriptor: &BufferDescriptor) -> MemoryNeeds;
}

impl Profile {
    /// What `format` can be; `None` if nothing.
    #[must_use]
    pub fn format(&self, format: Format) -> Option<&FormatSupport> {
        self.formats.iter().find(|support| support.format == format)
    }
}

/// A profile estimates: what it has read from a device, else padded texels without a driver's own extras.
pub struct Estimated<'p>(pub &'p Profile);

/// Alignment of buffers that is enough for every use on all devices we have figures of.
const BUFFER_ALIGNMENT: u64 = 256;

impl MemoryProvider for Estimated<'_> {
    fn exact(&self) -> bool {
        false
    }

    fn image(&mut self, descriptor: &ImageDescriptor) -> MemoryNeeds {
        let known = &self.0.known_needs;
        if let Ok(at) = known.binary_search_by(|known| known.image.cmp(descriptor)) {
            return known[at].needs;
        }
        let model = &self.0.memory;
        let padded = |texels: u32, to: u32| u64::from(texels).next_multiple_of(u64::from(to.max(1)));
        let bytes = (0..descriptor.mips.min(u32::BITS))
            .map(|mip| {
                let at = |extent: u32| (extent >> mip).max(1);
                let texels = padded(at(descriptor.extent[0]), model.row_texels)
                    .saturating_mul(padded(at(descriptor.extent[1]), model.rows))
                    .saturating_mul(u64::from(at(descriptor.extent[2])));
                texels.saturating_mul(descriptor.format.texel_bytes())
            })
            .fold(0_u64, u64::saturating_add)
            .saturating_mul(u64::from(descriptor.layers))
            .saturating_mul(u64::from(descriptor.samples));
        let alignment = model.alignment.max(1).next_power_of_two();
        MemoryNeeds { bytes: bytes.checked_next_multiple_of(alignment).unwrap_or(u64::MAX), alignment, type_bits: 1 }
    }

    fn buffer(&mut self, descriptor: &BufferDescriptor) -> MemoryNeeds {
        let bytes = descriptor.bytes.checked_next_multiple_of(BUFFER_ALIGNMENT).unwrap_or(u64::MAX);
        MemoryNeeds { bytes, alignment: BUFFER_ALIGNMENT, type_bits: 1 }
    }
}
