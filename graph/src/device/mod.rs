//! What a device can do, as data: read from a live device by a backend, or from a saved profile.

mod estimate;
mod saved;
mod sound;
mod usual;

pub use estimate::Estimated;
pub use saved::{ProfileError, SHIPPED_PROFILES};

use crate::vulkan::{BufferUsage, Format, ResolveMode, Shape, Sharing, Usage, extent_at};
use serde::{Deserialize, Serialize};

/// A device's capabilities, as far as a Plan depends on them.
///
/// One that was read from text ([`Profile::from_ron`]) holds no figure that no device has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// The device's own name.
    #[serde(deserialize_with = "sound::name")]
    pub name: String,
    /// Driver and version, and where the figures come from.
    pub source: String,
    /// Largest width and height of an attachment, in texels.
    #[serde(deserialize_with = "sound::extent")]
    pub max_attachment_extent: u32,
    /// Largest width, height and depth of a three-dimensional image, in texels.
    #[serde(default = "least_extent_3d", deserialize_with = "sound::extent")]
    pub max_extent_3d: u32,
    /// Most array layers of an image.
    #[serde(default = "least_layers", deserialize_with = "sound::extent")]
    pub max_layers: u32,
    /// Most colour attachments of one rendering scope.
    #[serde(deserialize_with = "sound::attachments")]
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
    /// Most views that a rendering scope draws at once (`maxMultiviewViewCount`).
    #[serde(default = "least_views", deserialize_with = "sound::views")]
    pub max_multiview_views: u32,
    /// Whether the device says that it draws several views at once, and a test showed that it doesn't: then
    /// `max_multiview_views` is 1.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub refuted_multiview: bool,
    /// Whether the device says that it draws several views at once, and that couldn't be tested: then `max_multiview_views` is 1.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub untested_multiview: bool,
    /// Whether vertex shaders can choose the layer that they draw into (`shaderOutputLayer`).
    #[serde(default)]
    pub vertex_layer: bool,
    /// Most clip distances of a shader; 0 if it has none (`shaderClipDistance`), `None` where that isn't known.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "sound::known",
        deserialize_with = "sound::clip_distances"
    )]
    pub max_clip_distances: Option<u32>,
    /// How depth can be resolved by the rendering scope that draws it, as far as the device does what it says.
    #[serde(default = "least_depth_resolve")]
    pub depth_resolve: Vec<ResolveMode>,
    /// How the device says that it resolves depth, and a test showed that it doesn't.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refuted_depth_resolve: Vec<ResolveMode>,
    /// Modes of `depth_resolve` that a test showed to be right for one layer and wrong for several: for what has a layer for
    /// each eye.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refuted_layered_depth_resolve: Vec<ResolveMode>,
    /// How the device says that it resolves depth, where that couldn't be tested.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub untested_depth_resolve: Vec<ResolveMode>,
    /// What each format can be, each once; formats that are absent can be nothing.
    #[serde(deserialize_with = "sound::formats")]
    pub formats: Vec<FormatSupport>,
    /// How much memory images and buffers take.
    pub memory: MemoryModel,
    /// Memory needs of images that were read from the device, sorted by format and sample count; all others are estimated
    /// by the model.
    #[serde(default, deserialize_with = "sound::known_needs")]
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

/// The least that Vulkan demands.
const fn least_views() -> u32 {
    6
}

/// The least that Vulkan demands.
fn least_depth_resolve() -> Vec<ResolveMode> {
    vec![ResolveMode::SampleZero]
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

/// The memory needs of flat images with one mip level and one layer, used by one queue at a time.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnownNeeds {
    /// Texel format.
    pub format: Format,
    /// Samples a texel.
    pub samples: u32,
    /// What the images are used for: any one of these sets; what they need is the same.
    pub usages: Vec<Usage>,
    /// Width and height in texels, rising, and what such an image needs.
    pub sizes: Vec<([u32; 2], MemoryNeeds)>,
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
///
/// Each mip level takes `row · rows · depth` bytes, where the width is padded to `row_texels` and the row that it makes to
/// `row_bytes`, the height to `rows`, and the whole to `alignment`. Layers and samples multiply that. Lavapipe takes exactly
/// this much, and so does SwiftShader for flat images; of GPUs it models the tiles that texels lie in, not their compression.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MemoryModel {
    /// Alignment of an image's offset and of what a mip level takes, in bytes: a power of two.
    #[serde(deserialize_with = "sound::alignment")]
    pub alignment: u64,
    /// Rows are padded to a multiple of this many texels: a power of two.
    #[serde(default = "no_padding", deserialize_with = "sound::padding")]
    pub row_texels: u32,
    /// Rows are padded to a multiple of this many bytes: a power of two.
    #[serde(default = "no_padding", deserialize_with = "sound::padding")]
    pub row_bytes: u32,
    /// Heights are padded to a multiple of this many rows: a power of two.
    #[serde(default = "no_padding", deserialize_with = "sound::padding")]
    pub rows: u32,
    /// Whether the stencil of depth formats lies in a plane of its own, a byte for each texel, instead of beside the depth.
    #[serde(default)]
    pub separate_stencil: bool,
    /// Alignment of a buffer's offset, in bytes: a power of two.
    #[serde(default = "safe_buffer_alignment", deserialize_with = "sound::alignment")]
    pub buffer_alignment: u64,
    /// Memory types that images and buffers accept, one bit each (`memoryTypeBits`).
    #[serde(default = "first_type", deserialize_with = "sound::type_bits")]
    pub type_bits: u32,
    /// Bytes of the largest heap that images can lie in; `None`: not known.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "sound::known",
        deserialize_with = "sound::heap_bytes"
    )]
    pub heap_bytes: Option<u64>,
}

/// Rows and heights are what they are.
const fn no_padding() -> u32 {
    1
}

/// The largest alignment of uniform and storage buffers that Vulkan allows a device to ask for.
const fn safe_buffer_alignment() -> u64 {
    256
}

/// The first memory type alone.
const fn first_type() -> u32 {
    1
}

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
    /// What it is used for.
    pub usage: Usage,
    /// Which queues may use it.
    pub sharing: Sharing,
}

impl ImageDescriptor {
    /// Width, height and depth of a mip level in texels.
    pub(crate) fn extent_at(&self, mip: u32) -> [u32; 3] {
        extent_at(self.extent, mip)
    }
}

/// The full descriptor of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BufferDescriptor {
    /// Bytes.
    pub bytes: u64,
    /// What it is used for.
    pub usage: BufferUsage,
    /// Which queues may use it.
    pub sharing: Sharing,
}

/// What an image or buffer needs of memory (`VkMemoryRequirements`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MemoryNeeds {
    /// Bytes.
    pub bytes: u64,
    /// Alignment of the offset, a power of two.
    #[serde(deserialize_with = "sound::alignment")]
    pub alignment: u64,
    /// Which memory types will do, one bit each (`memoryTypeBits`).
    #[serde(deserialize_with = "sound::type_bits")]
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

    /// The profile with the memory needs of the usual images added, as `memory` says them: what it takes to plan for the
    /// device where it is not.
    #[must_use]
    pub fn with_usual_needs(mut self, memory: &mut dyn MemoryProvider) -> Profile {
        self.known_needs = usual::needs(&self.formats, self.max_attachment_extent, memory);
        self
    }
}
