//! Images and buffers by their full descriptors, and the memory that they need.

use super::profile_rules;
use crate::vulkan::{BufferUsage, Format, Shape, Sharing, Subresources, Usage, extent_at};
use serde::{Deserialize, Serialize};

/// The full descriptor of an image: compatibility, aliasing and caches compare all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
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
    /// The usages of the image.
    pub usage: Usage,
    /// Which queues may use it.
    pub sharing: Sharing,
}

impl ImageDescriptor {
    /// Width, height and depth of a mip level in texels.
    pub(crate) fn extent_at(&self, mip: u32) -> [u32; 3] {
        extent_at(self.extent, mip)
    }

    /// Width, height and depth of a mip level in what is stored together: texels, or blocks of a compressed format.
    pub(crate) fn blocks_at(&self, mip: u32) -> [u32; 3] {
        let ([width, height, depth], [wide, high]) = (self.extent_at(mip), self.format.block());
        [width.div_ceil(wide), height.div_ceil(high), depth]
    }

    /// Bytes of the texels of a part of it, all samples among them: what reading or writing that part moves.
    pub(crate) fn bytes(&self, part: Subresources) -> u64 {
        let texel = self.format.plane_bytes(part.aspects).unwrap_or_else(|| self.format.texel_bytes());
        let mips = part.mips.min(self.mips.saturating_sub(part.base_mip));
        let layers = part.layers.min(self.layers.saturating_sub(part.base_layer));
        let texels = |mip| self.blocks_at(mip).into_iter().map(u64::from).fold(1, u64::saturating_mul);
        let texels = (part.base_mip..part.base_mip.saturating_add(mips)).map(texels).fold(0, u64::saturating_add);
        [texel, layers.into(), self.samples.into()].into_iter().fold(texels, u64::saturating_mul)
    }
}

/// The full descriptor of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BufferDescriptor {
    /// Bytes.
    pub bytes: u64,
    /// The usages of the buffer.
    pub usage: BufferUsage,
    /// Which queues may use it.
    pub sharing: Sharing,
}

/// The memory needs of an image or buffer (`VkMemoryRequirements`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MemoryNeeds {
    /// Bytes.
    pub bytes: u64,
    /// Alignment of the offset, a power of two.
    #[serde(deserialize_with = "profile_rules::alignment")]
    pub alignment: u64,
    /// Which memory types will do, one bit each (`memoryTypeBits`).
    #[serde(deserialize_with = "profile_rules::type_bits")]
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
