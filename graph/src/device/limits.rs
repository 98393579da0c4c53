//! How much a device's shaders and buffers may use.

use crate::vulkan::Sampler;
use serde::{Deserialize, Serialize};

/// Each limit: its name, the field with its value, Vulkan's name, and the least that Vulkan demands of every device.
macro_rules! limits {
    ($($(#[doc = $doc:literal])* $limit:ident, $field:ident, $name:literal, $least:expr;)*) => {
        /// The limits of a device for what its shaders use. A limit that is left out in text is the least that Vulkan demands.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct Limits {
            $($(#[doc = $doc])* pub $field: u64,)*
        }

        /// One of the limits.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
        pub enum Limit {
            $($(#[doc = $doc])* $limit,)*
        }

        impl Limit {
            /// All of them.
            pub const ALL: &[Limit] = &[$(Limit::$limit,)*];

            /// Vulkan's name.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Limit::$limit => $name,)*
                }
            }

            /// The least that Vulkan demands of every device.
            #[must_use]
            pub const fn least(self) -> u64 {
                match self {
                    $(Limit::$limit => $least,)*
                }
            }
        }

        impl Limits {
            /// The least that Vulkan demands of every device.
            pub const LEAST: Limits = Limits { $($field: $least,)* };

            /// The value of a limit.
            #[must_use]
            pub const fn of(&self, limit: Limit) -> u64 {
                match limit {
                    $(Limit::$limit => self.$field,)*
                }
            }
        }
    };
}

limits! {
    /// Invocations of a workgroup in x.
    WorkgroupX, workgroup_x, "maxComputeWorkGroupSize[0]", 128;
    /// Invocations of a workgroup in y.
    WorkgroupY, workgroup_y, "maxComputeWorkGroupSize[1]", 128;
    /// Invocations of a workgroup in z.
    WorkgroupZ, workgroup_z, "maxComputeWorkGroupSize[2]", 64;
    /// Invocations of a workgroup.
    WorkgroupInvocations, workgroup_invocations, "maxComputeWorkGroupInvocations", 128;
    /// Bytes that the invocations of a workgroup share.
    SharedBytes, shared_bytes, "maxComputeSharedMemorySize", 16 << 10;
    /// Bytes of a buffer.
    BufferBytes, buffer_bytes, "maxBufferSize", 1 << 30;
    /// Bytes of a buffer that is bound as a uniform block.
    UniformBytes, uniform_bytes, "maxUniformBufferRange", 16 << 10;
    /// Bytes of a buffer that is bound as a storage block.
    StorageBytes, storage_bytes, "maxStorageBufferRange", 1 << 27;
    /// Samplers that a stage sees.
    StageSamplers, stage_samplers, "maxPerStageDescriptorSamplers", 16;
    /// Sampled images that a stage sees.
    StageSampledImages, stage_sampled_images, "maxPerStageDescriptorSampledImages", 16;
    /// Storage images that a stage sees.
    StageStorageImages, stage_storage_images, "maxPerStageDescriptorStorageImages", 4;
    /// Uniform blocks that a stage sees.
    StageUniformBlocks, stage_uniform_blocks, "maxPerStageDescriptorUniformBuffers", 12;
    /// Storage blocks that a stage sees.
    StageStorageBlocks, stage_storage_blocks, "maxPerStageDescriptorStorageBuffers", 4;
    /// Input attachments that a stage sees.
    StageInputAttachments, stage_input_attachments, "maxPerStageDescriptorInputAttachments", 4;
    /// Resources of all kinds that a stage sees, with the colours that it draws into.
    StageResources, stage_resources, "maxPerStageResources", 128;
    /// Samplers of all sets.
    SetSamplers, set_samplers, "maxDescriptorSetSamplers", 96;
    /// Sampled images of all sets.
    SetSampledImages, set_sampled_images, "maxDescriptorSetSampledImages", 96;
    /// Storage images of all sets.
    SetStorageImages, set_storage_images, "maxDescriptorSetStorageImages", 24;
    /// Uniform blocks of all sets.
    SetUniformBlocks, set_uniform_blocks, "maxDescriptorSetUniformBuffers", 72;
    /// Storage blocks of all sets.
    SetStorageBlocks, set_storage_blocks, "maxDescriptorSetStorageBuffers", 24;
    /// Input attachments of all sets.
    SetInputAttachments, set_input_attachments, "maxDescriptorSetInputAttachments", 4;
    /// Storage images and storage blocks that a fragment stage uses, with the colours that it draws into.
    FragmentResources, fragment_resources, "maxFragmentCombinedOutputResources", 4;
    /// Vertex buffers of a draw.
    VertexBuffers, vertex_buffers, "maxVertexInputBindings", 16;
    /// Locations of vertex attributes.
    VertexAttributes, vertex_attributes, "maxVertexInputAttributes", 16;
    /// Bytes from the beginning of a vertex to an attribute.
    VertexOffset, vertex_offset, "maxVertexInputAttributeOffset", 2047;
    /// Bytes from vertex to vertex.
    VertexStride, vertex_stride, "maxVertexInputBindingStride", 2048;
    /// Indirect draws at once.
    IndirectDraws, indirect_draws, "maxDrawIndirectCount", 1;
    /// Bytes of push constants.
    PushConstantBytes, push_constant_bytes, "maxPushConstantsSize", 128;
    /// Texels that a line is wide, as far as they are whole.
    LineWidth, line_width, "lineWidthRange[1]", 1;
    /// Samples of a lookup along the direction of the slant.
    Anisotropy, anisotropy, "maxSamplerAnisotropy", 1;
    /// How far mip levels are moved, as far as that is whole.
    LodBias, lod_bias, "maxSamplerLodBias", 2;
}

impl Limits {
    /// What of a sampler is more than these allow, in words.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "such limits are small")]
    pub fn exceeded_by(&self, sampler: &Sampler) -> Option<String> {
        let bias = f32::from(sampler.lod_bias);
        let wanted = [
            (Limit::Anisotropy, sampler.anisotropy as f32, "the anisotropy", sampler.anisotropy.to_string()),
            (Limit::LodBias, bias.abs(), "the mip level's bias", bias.to_string()),
        ];
        let (limit, _, what, value) = wanted.into_iter().find(|(limit, value, ..)| *value > self.of(*limit) as f32)?;
        Some(format!("{what} is {value}, and {} is allowed ({})", self.of(limit), limit.name()))
    }
}

impl Default for Limits {
    fn default() -> Limits {
        Limits::LEAST
    }
}
