//! The capabilities of a device.

use super::features::{EVERY_PLAN_USES, SOME_PLANS_USE};
use super::limits::Limits;
use super::memory::MemoryNeeds;
use super::profile_rules;
use crate::vulkan::{Format, ResolveMode, Sharing, Usage, VertexFormat};
use serde::{Deserialize, Serialize};

/// A device's capabilities, as far as a Plan depends on them.
///
/// One that was read from text ([`Profile::from_ron`]) holds no figure that no device has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// The device's own name.
    #[serde(deserialize_with = "profile_rules::name")]
    pub name: String,
    /// Driver and version, and where the figures come from.
    pub source: String,
    /// Largest width and height of an attachment, in texels.
    #[serde(deserialize_with = "profile_rules::extent")]
    pub max_attachment_extent: u32,
    /// Largest width, height and depth of a three-dimensional image, in texels.
    #[serde(default = "least_extent_3d", deserialize_with = "profile_rules::extent")]
    pub max_extent_3d: u32,
    /// Most array layers of an image.
    #[serde(default = "least_layers", deserialize_with = "profile_rules::extent")]
    pub max_layers: u32,
    /// Most colour attachments of one rendering scope.
    #[serde(deserialize_with = "profile_rules::attachments")]
    pub max_color_attachments: u32,
    /// Whether it has lazily allocated memory for transient attachments.
    pub lazily_allocated_memory: bool,
    /// Queues beside the one that does everything.
    #[serde(default)]
    pub queues: Queues,
    /// Whether fragment shaders can read colours that earlier passes of their rendering scope drew at the same position
    /// (`VK_KHR_dynamic_rendering_local_read`).
    #[serde(default)]
    pub local_read: bool,
    /// Most views that a rendering scope draws at once (`maxMultiviewViewCount`).
    #[serde(default = "least_views", deserialize_with = "profile_rules::views")]
    pub max_multiview_views: u32,
    /// Whether the device says that it draws several views at once, and a test showed that it doesn't: then
    /// `max_multiview_views` is 1.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub refuted_multiview: bool,
    /// Whether the device claims to draw several views at once, and that couldn't be tested: then `max_multiview_views` is 1.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub untested_multiview: bool,
    /// Whether vertex shaders can choose the layer that they draw into (`shaderOutputLayer`).
    #[serde(default)]
    pub vertex_layer: bool,
    /// Most clip distances of a shader; 0 if it has none (`shaderClipDistance`), `None` where that isn't known.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "profile_rules::known",
        deserialize_with = "profile_rules::clip_distances"
    )]
    pub max_clip_distances: Option<u32>,
    /// Features beyond the minimum that shaders and draws can need, by Vulkan's names; `None` where they aren't known: then
    /// none is missed.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "profile_rules::known",
        deserialize_with = "profile_rules::where_known"
    )]
    pub features: Option<Vec<String>>,
    /// Features of the minimum ([`SOME_PLANS_USE`](super::SOME_PLANS_USE)) that a program made the device without, by Vulkan's names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<String>,
    /// Limits for shaders and buffers; `None` where they aren't known: then nothing exceeds them.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "profile_rules::known",
        deserialize_with = "profile_rules::where_known"
    )]
    pub limits: Option<Limits>,
    /// Formats of which it reads vertices beside those that every device reads; `None` where they aren't known: then none is missed.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "profile_rules::known",
        deserialize_with = "profile_rules::where_known"
    )]
    pub vertex_formats: Option<Vec<VertexFormat>>,
    /// Modes in which the rendering scope that draws depth can resolve it, without those that a test refuted.
    #[serde(default = "least_depth_resolve")]
    pub depth_resolve: Vec<ResolveMode>,
    /// Modes in which the device claims to resolve depth, and a test showed that it doesn't.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refuted_depth_resolve: Vec<ResolveMode>,
    /// Modes of `depth_resolve` that a test showed to be right for one layer and wrong for several layers, as of images with
    /// a layer for each eye.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refuted_layered_depth_resolve: Vec<ResolveMode>,
    /// Modes in which the device claims to resolve depth, where that couldn't be tested.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub untested_depth_resolve: Vec<ResolveMode>,
    /// Whether integer colours resolve to another sample than sample zero, as a test showed, though the device must resolve to that
    /// one in a rendering scope.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub refuted_integer_resolve: bool,
    /// The support for each format, each format once; absent formats have no support.
    #[serde(deserialize_with = "profile_rules::formats")]
    pub formats: Vec<FormatSupport>,
    /// How much memory images and buffers take.
    pub memory: MemoryModel,
    /// Memory needs of images that were read from the device, sorted by format and sample count; all others are estimated
    /// by the model.
    #[serde(default, deserialize_with = "profile_rules::known_needs")]
    pub known_needs: Vec<KnownNeeds>,
    /// Values above that no public source states, and the assumptions in their place.
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Queues {
    /// A queue for compute and transfer.
    pub compute: bool,
    /// A queue for transfer only.
    pub transfer: bool,
    /// How images that several queues use are shared: handed over, or used by all without a loss.
    pub sharing: Sharing,
    /// What a wait of one queue for another costs: the bytes that passes read and write in the same time.
    #[serde(default = "usual_wait")]
    pub wait_bytes: u64,
}

impl Queues {
    /// The cost of a wait where nothing is known: 20 µs, in which passes move 100 bytes a nanosecond.
    ///
    /// Each wait and each signal ends a submission. Mesa's vkoverhead counts 51,000 submissions of one command buffer a second
    /// for RADV on RDNA 3, and 35,000 for ANV on an Arc GPU: 20 µs and 28 µs each
    /// (<https://gitlab.freedesktop.org/mesa/mesa/-/merge_requests/25352>). NVIDIA advises against asynchronous work of less than
    /// 200 µs on drivers without hardware scheduling
    /// (<https://developer.nvidia.com/blog/advanced-api-performance-synchronization/>). The memory of desktop GPUs moves 400 to
    /// 650 bytes a nanosecond. That passes reach a fifth of this is assumed: they also calculate.
    pub const USUAL_WAIT_BYTES: u64 = 2 << 20;
}

impl Default for Queues {
    /// One queue.
    fn default() -> Queues {
        let (sharing, wait_bytes) = (Sharing::default(), Queues::USUAL_WAIT_BYTES);
        Queues { compute: false, transfer: false, sharing, wait_bytes }
    }
}

/// Where nothing is known.
const fn usual_wait() -> u64 {
    Queues::USUAL_WAIT_BYTES
}

/// The memory needs of flat images with one mip level and one layer, used by one queue at a time.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnownNeeds {
    /// Texel format.
    pub format: Format,
    /// Samples a texel.
    pub samples: u32,
    /// Usages of the images: any one of these sets; the memory needs are the same for each.
    pub usages: Vec<Usage>,
    /// Width and height in texels, rising, and the memory needs of such an image.
    pub sizes: Vec<([u32; 2], MemoryNeeds)>,
}

/// The support of a device for one format (optimal tiling).
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
    /// Whether samplers find the least and greatest of its texels (`samplerFilterMinmax`).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub minmax_filter: bool,
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
    /// Alignment of an image's offset and of a mip level's size, in bytes: a power of two.
    #[serde(deserialize_with = "profile_rules::alignment")]
    pub alignment: u64,
    /// Rows are padded to a multiple of this many texels: a power of two.
    #[serde(default = "no_padding", deserialize_with = "profile_rules::padding")]
    pub row_texels: u32,
    /// Rows are padded to a multiple of this many bytes: a power of two.
    #[serde(default = "no_padding", deserialize_with = "profile_rules::padding")]
    pub row_bytes: u32,
    /// Heights are padded to a multiple of this many rows: a power of two.
    #[serde(default = "no_padding", deserialize_with = "profile_rules::padding")]
    pub rows: u32,
    /// Whether the stencil of depth formats lies in a plane of its own, a byte for each texel, instead of beside the depth.
    #[serde(default)]
    pub separate_stencil: bool,
    /// Alignment of a buffer's offset, in bytes: a power of two.
    #[serde(default = "safe_buffer_alignment", deserialize_with = "profile_rules::alignment")]
    pub buffer_alignment: u64,
    /// Memory types that images and buffers accept, one bit each (`memoryTypeBits`).
    #[serde(default = "first_type", deserialize_with = "profile_rules::type_bits")]
    pub type_bits: u32,
    /// Bytes of the largest heap that images can lie in; `None`: not known.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "profile_rules::known",
        deserialize_with = "profile_rules::heap_bytes"
    )]
    pub heap_bytes: Option<u64>,
}

/// Rows and heights without padding.
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

impl Profile {
    /// Whether the device has a feature, by Vulkan's name. Where its features beyond the minimum aren't known none is missed.
    #[must_use]
    pub fn has_feature(&self, name: &str) -> bool {
        if EVERY_PLAN_USES.contains(&name) || SOME_PLANS_USE.contains(&name) {
            return !self.without.iter().any(|it| it == name);
        }
        // Clip distances have a number of their own.
        if name == "shaderClipDistance" {
            return self.max_clip_distances.is_none_or(|most| most > 0);
        }
        self.features.as_ref().is_none_or(|features| features.iter().any(|it| it == name))
    }

    /// Whether the device reads vertices of a format, or that isn't known.
    #[must_use]
    pub fn reads_vertices(&self, format: VertexFormat) -> bool {
        format.is_on_every_device() || self.vertex_formats.as_ref().is_none_or(|known| known.contains(&format))
    }

    /// The support for `format`; `None` if there is none, or the feature that brings the format isn't switched on.
    #[must_use]
    pub fn format(&self, format: Format) -> Option<&FormatSupport> {
        let is_on = || format.feature().is_none_or(|feature| self.has_feature(feature));
        self.formats.iter().find(|support| support.format == format).filter(|_| is_on())
    }
}
