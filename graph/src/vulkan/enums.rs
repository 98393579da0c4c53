//! Vulkan's own words as plain data: pipeline stages, accesses, layouts, usages, load and store operations.
//!
//! Bit values and names are those of the Vulkan 1.3 specification (`VK_PIPELINE_STAGE_2_*_BIT` and so on, without prefix
//! and suffix), so that a backend converts them without a table and a reader looks them up without a dictionary. Words of
//! extensions keep the suffix of their extension.

use super::Format;
use bitflags::bitflags;
use serde::{Deserialize, Serialize};

bitflags! {
    /// Pipeline stages (`VkPipelineStageFlagBits2`).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct Stages: u64 {
        /// Reading of indirect draw and dispatch parameters.
        const DRAW_INDIRECT = 0x2;
        /// Fetch of indices and vertex attributes.
        const VERTEX_INPUT = 0x4;
        /// Vertex shading.
        const VERTEX_SHADER = 0x8;
        /// Fragment shading.
        const FRAGMENT_SHADER = 0x80;
        /// Depth and stencil tests before the fragment shader, and the load operations of depth attachments.
        const EARLY_FRAGMENT_TESTS = 0x100;
        /// Depth and stencil tests after the fragment shader, and the store operations of depth attachments.
        const LATE_FRAGMENT_TESTS = 0x200;
        /// Writing and blending of colour, load, store and resolve operations of colour attachments, and every
        /// resolve at the end of a rendering scope (depth too).
        const COLOR_ATTACHMENT_OUTPUT = 0x400;
        /// Compute shading.
        const COMPUTE_SHADER = 0x800;
        /// Accesses of the host.
        const HOST = 0x4000;
        /// Everything a queue does.
        const ALL_COMMANDS = 0x1_0000;
        /// Task shading.
        const TASK_SHADER_EXT = 0x8_0000;
        /// Mesh shading.
        const MESH_SHADER_EXT = 0x10_0000;
        /// Shading of rays: every stage of a ray-tracing pipeline.
        const RAY_TRACING_SHADER_KHR = 0x20_0000;
        /// Reading of the shading rate of a region.
        const FRAGMENT_SHADING_RATE_ATTACHMENT_KHR = 0x40_0000;
        /// Building of acceleration structures.
        const ACCELERATION_STRUCTURE_BUILD_KHR = 0x200_0000;
        /// Copying of acceleration structures.
        const ACCELERATION_STRUCTURE_COPY_KHR = 0x1000_0000;
        /// `vkCmdCopy*`.
        const COPY = 0x1_0000_0000;
        /// `vkCmdResolveImage2`.
        const RESOLVE = 0x2_0000_0000;
        /// `vkCmdBlitImage2`.
        const BLIT = 0x4_0000_0000;
        /// `vkCmdClear*Image`.
        const CLEAR = 0x8_0000_0000;
    }
}

bitflags! {
    /// Kinds of memory access (`VkAccessFlagBits2`).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct Accesses: u64 {
        /// Indirect parameters.
        const INDIRECT_COMMAND_READ = 0x1;
        /// Indices.
        const INDEX_READ = 0x2;
        /// Vertex attributes.
        const VERTEX_ATTRIBUTE_READ = 0x4;
        /// Uniform buffers.
        const UNIFORM_READ = 0x8;
        /// Attachments read by fragment shaders at their own position.
        const INPUT_ATTACHMENT_READ = 0x10;
        /// What acceleration structures are built from: vertices, indices, boxes, transforms and instances. What shaders read has words
        /// of its own.
        const SHADER_READ = 0x20;
        /// Blending, load operations.
        const COLOR_ATTACHMENT_READ = 0x80;
        /// Colour writes, clear and don't-care loads, stores, resolves.
        const COLOR_ATTACHMENT_WRITE = 0x100;
        /// Depth and stencil tests, load operations.
        const DEPTH_STENCIL_ATTACHMENT_READ = 0x200;
        /// Depth and stencil writes, clear and don't-care loads, stores.
        const DEPTH_STENCIL_ATTACHMENT_WRITE = 0x400;
        /// Source of a copy, blit or resolve.
        const TRANSFER_READ = 0x800;
        /// Destination of a copy, blit, resolve or clear.
        const TRANSFER_WRITE = 0x1000;
        /// Host reads.
        const HOST_READ = 0x2000;
        /// Host writes.
        const HOST_WRITE = 0x4000;
        /// Any read.
        const MEMORY_READ = 0x8000;
        /// Any write.
        const MEMORY_WRITE = 0x1_0000;
        /// Acceleration structures: traced, built from, copied. Scratch memory of a build.
        const ACCELERATION_STRUCTURE_READ_KHR = 0x20_0000;
        /// Acceleration structures: built, copied into. Scratch memory of a build.
        const ACCELERATION_STRUCTURE_WRITE_KHR = 0x40_0000;
        /// Shading rates.
        const FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR = 0x80_0000;
        /// Sampled images.
        const SHADER_SAMPLED_READ = 0x1_0000_0000;
        /// Reads of storage images and buffers.
        const SHADER_STORAGE_READ = 0x2_0000_0000;
        /// Writes of storage images and buffers.
        const SHADER_STORAGE_WRITE = 0x4_0000_0000;
        /// Shader binding tables.
        const SHADER_BINDING_TABLE_READ_KHR = 0x100_0000_0000;
    }
}

impl Stages {
    /// The stages whose shaders read descriptor sets: the name in files, the bit of `VkShaderStageFlagBits`, and the stage.
    #[must_use]
    pub const fn of_sets() -> [(&'static str, u32, Stages); 3] {
        [
            ("Vertex", 0x1, Stages::VERTEX_SHADER),
            ("Fragment", 0x10, Stages::FRAGMENT_SHADER),
            ("Compute", 0x20, Stages::COMPUTE_SHADER),
        ]
    }

    /// The stages of a draw that have shaders.
    #[must_use]
    pub const fn of_draws() -> Stages {
        Stages::VERTEX_SHADER.union(Stages::FRAGMENT_SHADER)
    }

    /// All of these.
    #[must_use]
    pub const fn all_of_sets() -> Stages {
        Stages::VERTEX_SHADER.union(Stages::FRAGMENT_SHADER).union(Stages::COMPUTE_SHADER)
    }

    /// Every stage of shaders.
    pub const SHADERS: Stages = Stages::VERTEX_SHADER
        .union(Stages::FRAGMENT_SHADER)
        .union(Stages::COMPUTE_SHADER)
        .union(Stages::TASK_SHADER_EXT)
        .union(Stages::MESH_SHADER_EXT)
        .union(Stages::RAY_TRACING_SHADER_KHR);
}

impl Accesses {
    /// Any read, and any write.
    pub const MEMORY: Accesses = Accesses::MEMORY_READ.union(Accesses::MEMORY_WRITE);

    /// Every access that changes memory.
    pub const WRITES: Accesses = Accesses::COLOR_ATTACHMENT_WRITE
        .union(Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE)
        .union(Accesses::TRANSFER_WRITE)
        .union(Accesses::HOST_WRITE)
        .union(Accesses::MEMORY_WRITE)
        .union(Accesses::ACCELERATION_STRUCTURE_WRITE_KHR)
        .union(Accesses::SHADER_STORAGE_WRITE);

    /// The writes among these accesses.
    #[must_use]
    pub const fn writes(self) -> Accesses {
        self.intersection(Accesses::WRITES)
    }
}

bitflags! {
    /// The usages of an image (`VkImageUsageFlagBits`).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct Usage: u32 {
        /// Source of copies, blits and resolves.
        const TRANSFER_SRC = 0x1;
        /// Destination of copies, blits, resolves and clears.
        const TRANSFER_DST = 0x2;
        /// Sampled in shaders.
        const SAMPLED = 0x4;
        /// Read and written in shaders without sampling.
        const STORAGE = 0x8;
        /// Colour or resolve attachment.
        const COLOR_ATTACHMENT = 0x10;
        /// Depth attachment.
        const DEPTH_STENCIL_ATTACHMENT = 0x20;
        /// Never leaves its rendering scope: may live in lazily allocated memory.
        const TRANSIENT_ATTACHMENT = 0x40;
        /// Read by fragment shaders at their own position.
        const INPUT_ATTACHMENT = 0x80;
        /// Says how many texels a fragment covers.
        const FRAGMENT_SHADING_RATE_ATTACHMENT_KHR = 0x100;
    }
}

bitflags! {
    /// The usages of a buffer (`VkBufferUsageFlagBits`).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct BufferUsage: u32 {
        /// Source of copies.
        const TRANSFER_SRC = 0x1;
        /// Destination of copies and fills.
        const TRANSFER_DST = 0x2;
        /// Uniform blocks.
        const UNIFORM_BUFFER = 0x10;
        /// Storage blocks.
        const STORAGE_BUFFER = 0x20;
        /// Indices.
        const INDEX_BUFFER = 0x40;
        /// Vertex attributes.
        const VERTEX_BUFFER = 0x80;
        /// Counts of indirect draws and dispatches.
        const INDIRECT_BUFFER = 0x100;
        /// Shader binding tables.
        const SHADER_BINDING_TABLE_KHR = 0x400;
        /// Has an address.
        const SHADER_DEVICE_ADDRESS = 0x2_0000;
        /// Acceleration structures are built from it.
        const ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR = 0x8_0000;
        /// Holds acceleration structures.
        const ACCELERATION_STRUCTURE_STORAGE_KHR = 0x10_0000;
    }
}

impl BufferUsage {
    /// Those that no extension and no feature brings.
    pub const CORE: BufferUsage = BufferUsage::TRANSFER_SRC
        .union(BufferUsage::TRANSFER_DST)
        .union(BufferUsage::UNIFORM_BUFFER)
        .union(BufferUsage::STORAGE_BUFFER)
        .union(BufferUsage::INDEX_BUFFER)
        .union(BufferUsage::VERTEX_BUFFER)
        .union(BufferUsage::INDIRECT_BUFFER);
}

bitflags! {
    /// Planes of an image (`VkImageAspectFlagBits`).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct Aspects: u32 {
        /// Colour.
        const COLOR = 0x1;
        /// Depth.
        const DEPTH = 0x2;
        /// Stencil.
        const STENCIL = 0x4;
    }
}

/// How an image's texels lie in memory (`VkImageLayout`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum Layout {
    /// Contents are not kept.
    Undefined,
    /// Any use; storage images need it.
    General,
    /// Colour attachment.
    ColorAttachmentOptimal,
    /// Depth attachment, written.
    DepthStencilAttachmentOptimal,
    /// Depth attachment only tested, and sampled at the same time if need be.
    DepthStencilReadOnlyOptimal,
    /// The depth plane of an image that has stencil too, as `DepthStencilAttachmentOptimal`.
    DepthAttachmentOptimal,
    /// The depth plane of an image that has stencil too, as `DepthStencilReadOnlyOptimal`.
    DepthReadOnlyOptimal,
    /// The stencil plane of an image that has depth too: attachment, written.
    StencilAttachmentOptimal,
    /// The stencil plane of an image that has depth too: only tested or sampled.
    StencilReadOnlyOptimal,
    /// Sampled.
    ShaderReadOnlyOptimal,
    /// Source of copies, blits and resolves.
    TransferSrcOptimal,
    /// Destination of copies, blits, resolves and clears.
    TransferDstOptimal,
    /// Presented.
    PresentSrcKhr,
    /// Attachment that fragment shaders read at their own position.
    RenderingLocalReadKhr,
    /// Says how many texels a fragment covers.
    FragmentShadingRateAttachmentOptimalKhr,
}

/// The last accesses of an image or buffer, and an image's layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Stages.
    pub stages: Stages,
    /// Accesses.
    pub accesses: Accesses,
    /// Layout; buffers have none: `UNDEFINED`.
    pub layout: Layout,
}

/// A part of an image (`VkImageSubresourceRange`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subresources {
    /// Planes.
    pub aspects: Aspects,
    /// First mip level.
    pub base_mip: u32,
    /// Number of mip levels.
    pub mips: u32,
    /// First array layer.
    pub base_layer: u32,
    /// Number of array layers.
    pub layers: u32,
}

impl Subresources {
    /// All mip levels or layers from the first on (`VK_REMAINING_MIP_LEVELS`, `VK_REMAINING_ARRAY_LAYERS`).
    pub const REMAINING: u32 = u32::MAX;

    /// The whole of any image, every plane.
    pub const WHOLE: Subresources = Subresources {
        aspects: Aspects::empty(),
        base_mip: 0,
        mips: Subresources::REMAINING,
        base_layer: 0,
        layers: Subresources::REMAINING,
    };

    /// Whether it is [`Subresources::WHOLE`], without a branch for each number.
    pub(crate) const fn is_whole(self) -> bool {
        let Subresources { aspects, base_mip, mips, base_layer, layers } = self;
        (aspects.bits() | base_mip | base_layer) == 0 && (mips & layers) == Subresources::REMAINING
    }

    /// All of an image.
    #[must_use]
    pub const fn all(format: Format, mips: u32, layers: u32) -> Subresources {
        Subresources { aspects: format.aspects(), base_mip: 0, mips, base_layer: 0, layers }
    }

    /// Whether a part of one image has all of another one in it, both with planes and counts.
    pub(crate) const fn contains(self, other: Subresources) -> bool {
        const fn within(a: u32, some: u32, b: u32, others: u32) -> bool {
            a <= b && b + others <= a + some
        }
        self.aspects.contains(other.aspects)
            && within(self.base_mip, self.mips, other.base_mip, other.mips)
            && within(self.base_layer, self.layers, other.base_layer, other.layers)
    }

    /// Whether two parts of one image, both with planes and counts, have anything in common.
    pub(crate) const fn overlaps(self, other: Subresources) -> bool {
        const fn meet(a: u32, some: u32, b: u32, others: u32) -> bool {
            a < b + others && b < a + some
        }
        self.aspects.intersects(other.aspects)
            && meet(self.base_mip, self.mips, other.base_mip, other.mips)
            && meet(self.base_layer, self.layers, other.base_layer, other.layers)
    }
}

/// The operation on a stencil value (`VkStencilOp`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum StencilOp {
    /// It stays.
    Keep,
    /// It becomes 0.
    Zero,
    /// It becomes the reference value.
    Replace,
    /// It grows by 1, up to 255.
    IncrementAndClamp,
    /// It falls by 1, down to 0.
    DecrementAndClamp,
    /// Its bits are turned over.
    Invert,
}

/// Load op: the contents of an attachment when a rendering scope begins (`VkAttachmentLoadOp`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum LoadOp {
    /// Kept.
    Load,
    /// Set to the clear value.
    Clear,
    /// Undefined. Counts as a write.
    DontCare,
}

/// Store op: the contents of an attachment when a rendering scope ends (`VkAttachmentStoreOp`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum StoreOp {
    /// Kept. Counts as a write.
    Store,
    /// Undefined. Counts as a write.
    DontCare,
    /// Left alone: contents from before the scope stay. Not a write.
    None,
}

/// How samples become one value (`VkResolveModeFlagBits`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum ResolveMode {
    /// Mean of all samples.
    Average,
    /// The first sample.
    SampleZero,
    /// The least.
    Min,
    /// The greatest.
    Max,
}

/// How texels between samples are found (`VkFilter`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Weighted mean of the four around.
    Linear,
}

/// Depth comparison (`VkCompareOp`). Depth is reversed: nearer is greater.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum CompareOp {
    /// Never passes.
    Never,
    /// Passes if less.
    Less,
    /// Passes if equal.
    Equal,
    /// Passes if less or equal.
    LessOrEqual,
    /// Passes if greater.
    Greater,
    /// Passes if different.
    NotEqual,
    /// Passes if greater or equal.
    GreaterOrEqual,
    /// Always passes.
    Always,
}

/// Which queues may use an image or buffer (`VkSharingMode`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum Sharing {
    /// One at a time: barriers hand it over.
    #[default]
    Exclusive,
    /// All that use it, at any time.
    Concurrent,
}

/// The shape of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
pub enum Shape {
    /// Two-dimensional, or an array of such layers.
    #[default]
    D2,
    /// Three-dimensional.
    D3,
    /// Six square layers that may be sampled as a cube, or several times six.
    Cube,
}
