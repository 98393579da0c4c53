//! Descriptor sets that the program makes and binds itself, as data, and what shaders read of them.

use super::binding_name;
use crate::device::{Limit, Need, NeedKind};
use crate::vulkan::Stages;
use serde::{Deserialize, Serialize};

/// A descriptor set that the program makes and binds itself, such as a table of all textures.
///
/// It is the same for all passes. What the Plan knows of it is its layout: images and buffers in it are the program's business, with
/// their states and their barriers.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ProgramSet {
    /// Its number, 1 to 3.
    pub set: u32,
    /// Its bindings.
    pub bindings: Vec<ProgramBinding>,
}

/// A binding of a program's set, as in `VkDescriptorSetLayoutBinding`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProgramBinding {
    /// Its number.
    pub binding: u32,
    /// The type of its descriptors.
    pub kind: DescriptorType,
    /// How many descriptors it has; of a variable count the most. Shaders declare as many, fewer, or an array of no written length.
    pub count: u32,
    /// The stages that may read it: vertex, fragment and compute shaders.
    pub stages: Stages,
    /// Vulkan's flags.
    pub flags: BindingFlags,
}

/// What may be done with a binding's descriptors: `VkDescriptorBindingFlagBits`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BindingFlags {
    /// Descriptors that no shader reads needn't be valid.
    pub partially_bound: bool,
    /// Descriptors may be written after the set was bound, until the frame is submitted.
    pub update_after_bind: bool,
    /// Descriptors that no shader reads may be written while frames are on their way.
    pub update_unused_while_pending: bool,
    /// The set says how many there are when it is allocated: the last binding only.
    pub variable_count: bool,
}

/// Each type: Vulkan's name as files write it, how it is called, and the feature to write such descriptors after they were bound.
macro_rules! descriptor_types {
    ($($(#[doc = $doc:literal])* $name:ident, $words:literal, $updated:expr;)*) => {
        /// The type of a descriptor: `VkDescriptorType`.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum DescriptorType {
            $($(#[doc = $doc])* $name,)*
        }

        impl DescriptorType {
            /// All of them, by name.
            pub const NAMED: &[(&'static str, DescriptorType)] = &[$((stringify!($name), DescriptorType::$name),)*];

            /// Vulkan's name, as files write it.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(DescriptorType::$name => stringify!($name),)*
                }
            }

            /// The type in words.
            #[must_use]
            pub const fn words(self) -> &'static str {
                match self {
                    $(DescriptorType::$name => $words,)*
                }
            }

            /// The feature to write such descriptors after they were bound; `None`: no device can.
            const fn updated_after_bind(self) -> Option<&'static str> {
                match self {
                    $(DescriptorType::$name => $updated,)*
                }
            }
        }
    };
}

descriptor_types! {
    /// A sampler by itself.
    Sampler, "a sampler", Some(SAMPLED_UPDATED);
    /// A sampled image with its sampler.
    CombinedImageSampler, "a sampled image with its sampler", Some(SAMPLED_UPDATED);
    /// A sampled image without a sampler.
    SampledImage, "a sampled image without a sampler", Some(SAMPLED_UPDATED);
    /// A storage image.
    StorageImage, "a storage image", Some("descriptorBindingStorageImageUpdateAfterBind");
    /// A texel buffer that is read.
    UniformTexelBuffer, "a uniform texel buffer", Some("descriptorBindingUniformTexelBufferUpdateAfterBind");
    /// A texel buffer that is read and written.
    StorageTexelBuffer, "a storage texel buffer", Some("descriptorBindingStorageTexelBufferUpdateAfterBind");
    /// A uniform block.
    UniformBuffer, "a uniform block", Some("descriptorBindingUniformBufferUpdateAfterBind");
    /// A storage block.
    StorageBuffer, "a storage block", Some("descriptorBindingStorageBufferUpdateAfterBind");
    /// A uniform block, whose offset is told when the set is bound.
    UniformBufferDynamic, "a uniform block with a dynamic offset", None;
    /// A storage block, whose offset is told when the set is bound.
    StorageBufferDynamic, "a storage block with a dynamic offset", None;
    /// An acceleration structure that rays are traced through.
    AccelerationStructure, "an acceleration structure", Some("descriptorBindingAccelerationStructureUpdateAfterBind");
}

const SAMPLED_UPDATED: &str = "descriptorBindingSampledImageUpdateAfterBind";

/// Something in a program's set that a shader reads.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ProgramResource {
    /// Its set.
    pub set: u32,
    /// Its binding.
    pub binding: u32,
    /// Its name in the shader.
    pub name: String,
    /// The type of descriptors that it declares; `None`: none of a program's set can be it.
    pub kind: Option<DescriptorType>,
    /// How many it declares: the elements of an array, else 1; `None`: an array of no written length.
    pub count: Option<u32>,
    /// Whether the shader may write it.
    pub writable: bool,
    /// The stages that read it.
    pub stages: Stages,
    /// File and line of its declaration, `FILE:LINE`, if they are known.
    pub place: Option<String>,
}

impl ProgramSet {
    /// A set of this number and these bindings.
    #[must_use]
    pub fn new(set: u32, bindings: impl Into<Vec<ProgramBinding>>) -> ProgramSet {
        ProgramSet { set, bindings: bindings.into() }
    }

    /// How many dynamic offsets are told when it is bound.
    #[must_use]
    pub fn dynamic_offsets(&self) -> u32 {
        self.bindings.iter().filter(|it| it.kind.is_dynamic()).map(|it| it.count).fold(0, u32::saturating_add)
    }

    /// Why a shader that reads `used` doesn't fit the set, in words; `None` if it fits.
    #[must_use]
    pub fn misfit(&self, used: &ProgramResource) -> Option<String> {
        let Some(binding) = self.bindings.iter().find(|it| it.binding == used.binding) else {
            let known: Vec<_> = self.bindings.iter().map(|it| it.binding.to_string()).collect();
            return Some(format!("the program's set has no such binding; it has {}", known.join(", ")));
        };
        if !used.kind.is_some_and(|declared| binding.kind.is_declared(declared)) {
            let declared = used.kind.map_or("something that no set of a program holds", DescriptorType::words);
            return Some(format!("it is declared as {declared}, and is {}", binding.kind.words()));
        }
        if let Some(count) = used.count.filter(|count| *count > binding.count) {
            return Some(format!("it is declared as an array of {count}, and has {}", binding.count));
        }
        let blind = used.stages.difference(binding.stages);
        if !blind.is_empty() {
            let (read, seen) = (stage_words(blind), stage_words(binding.stages));
            return Some(format!("{read} shaders read it, and it is made for {seen} shaders"));
        }
        None
    }

    /// The features that a device must have to make it, for a shader that reads `used` of it.
    fn needs(&self, used: &ProgramResource) -> impl Iterator<Item = Need> {
        let place = used.place.clone().unwrap_or_default();
        let features = self.bindings.iter().flat_map(ProgramBinding::features);
        features.map(move |(name, what)| Need { kind: NeedKind::Feature { name, what }, place: place.as_str().into() })
    }
}

impl ProgramBinding {
    /// A binding of one descriptor, which all stages read.
    #[must_use]
    pub const fn new(binding: u32, kind: DescriptorType) -> ProgramBinding {
        let flags = BindingFlags {
            partially_bound: false,
            update_after_bind: false,
            update_unused_while_pending: false,
            variable_count: false,
        };
        ProgramBinding { binding, kind, count: 1, stages: Stages::all_of_sets(), flags }
    }

    /// An array of this many.
    #[must_use]
    pub const fn with_count(mut self, count: u32) -> ProgramBinding {
        self.count = count;
        self
    }

    /// For these stages.
    #[must_use]
    pub const fn with_stages(mut self, stages: Stages) -> ProgramBinding {
        self.stages = stages;
        self
    }

    /// With these flags.
    #[must_use]
    pub const fn with_flags(mut self, flags: BindingFlags) -> ProgramBinding {
        self.flags = flags;
        self
    }

    /// The features that its type and its flags need, with what needs them.
    fn features(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        let BindingFlags { partially_bound, update_after_bind, update_unused_while_pending, variable_count } =
            self.flags;
        let updated = self.kind.updated_after_bind().filter(|_| update_after_bind);
        let flag = |set: bool, name, what| set.then_some((name, what));
        let traced = self.kind == DescriptorType::AccelerationStructure;
        [
            flag(traced, "accelerationStructure", "an acceleration structure in the program's set"),
            updated.map(|name| (name, "a binding of the program's set that is updated after it was bound")),
            flag(
                partially_bound,
                "descriptorBindingPartiallyBound",
                "a binding of the program's set that is partially bound",
            ),
            flag(
                update_unused_while_pending,
                "descriptorBindingUpdateUnusedWhilePending",
                "a binding of the program's set that is updated while frames are on their way",
            ),
            flag(
                variable_count,
                "descriptorBindingVariableDescriptorCount",
                "a binding of the program's set that has a variable count",
            ),
        ]
        .into_iter()
        .flatten()
    }

    /// How many of its descriptors count for a limit. Those that are updated after they were bound have limits of their own.
    pub(super) fn counts_for(&self, limit: Limit) -> u64 {
        let counts = !self.flags.update_after_bind && self.kind.limits().contains(&limit);
        if counts { self.count.into() } else { 0 }
    }
}

impl DescriptorType {
    /// Whether its offset is told when the set is bound.
    #[must_use]
    pub const fn is_dynamic(self) -> bool {
        matches!(self, DescriptorType::UniformBufferDynamic | DescriptorType::StorageBufferDynamic)
    }

    /// Whether a shader that declares `declared` reads this.
    #[must_use]
    pub fn is_declared(self, declared: DescriptorType) -> bool {
        use DescriptorType as Is;
        let also: &[DescriptorType] = match self {
            Is::CombinedImageSampler => &[Is::SampledImage, Is::Sampler],
            Is::UniformBufferDynamic => &[Is::UniformBuffer],
            Is::StorageBufferDynamic => &[Is::StorageBuffer],
            _ => &[],
        };
        self == declared || also.contains(&declared)
    }

    /// The limits that its descriptors count for.
    const fn limits(self) -> &'static [Limit] {
        use DescriptorType as Is;
        match self {
            Is::Sampler => &[Limit::StageSamplers, Limit::SetSamplers],
            Is::CombinedImageSampler => {
                &[Limit::StageSamplers, Limit::SetSamplers, Limit::StageSampledImages, Limit::SetSampledImages]
            }
            Is::SampledImage | Is::UniformTexelBuffer => &[Limit::StageSampledImages, Limit::SetSampledImages],
            Is::StorageImage | Is::StorageTexelBuffer => &[Limit::StageStorageImages, Limit::SetStorageImages],
            Is::UniformBuffer | Is::UniformBufferDynamic => &[Limit::StageUniformBlocks, Limit::SetUniformBlocks],
            Is::StorageBuffer | Is::StorageBufferDynamic => &[Limit::StageStorageBlocks, Limit::SetStorageBlocks],
            // As many as every device allows that has them: see `set_faults`.
            Is::AccelerationStructure => &[],
        }
    }
}

/// What shaders ask of a device because of the program's sets that they read. Each feature counts once.
pub fn set_needs(used: &[ProgramResource], sets: &[ProgramSet]) -> Vec<Need> {
    let mut needs: Vec<Need> = Vec::new();
    let of_sets = used.iter().filter_map(|used| Some((used, sets.iter().find(|set| set.set == used.set)?)));
    for need in of_sets.flat_map(|(used, set)| set.needs(used)) {
        if !needs.iter().any(|known| known.kind == need.kind) {
            needs.push(need);
        }
    }
    needs
}

/// The bindings of the sets that a shader reads anything of, with the numbers of their sets.
pub fn bindings_of_read_sets<'s>(
    used: &'s [ProgramResource],
    sets: &'s [ProgramSet],
) -> impl Iterator<Item = (u32, &'s ProgramBinding)> + Clone {
    let read = sets.iter().filter(|set| used.iter().any(|it| it.set == set.set));
    read.flat_map(|set| set.bindings.iter().map(|binding| (set.set, binding)))
}

impl ProgramResource {
    /// The resource in words, with its place in the shader.
    #[must_use]
    pub fn words(&self) -> String {
        let ProgramResource { set, binding, name, place, .. } = self;
        let at = place.as_ref().map_or_else(String::new, |place| format!(" ({place})"));
        if *name == binding_name(*set, *binding) {
            return format!("set {set}, binding {binding}{at}");
        }
        format!("`{name}`, set {set}, binding {binding}{at}")
    }
}

fn stage_words(stages: Stages) -> String {
    let named = Stages::of_sets()
        .into_iter()
        .filter(|(_, _, stage)| stages.contains(*stage))
        .map(|(name, ..)| name.to_lowercase());
    named.collect::<Vec<_>>().join(" and ")
}
