//! The capabilities of SPIR-V that stages may need, and what GLSL to write instead of what needs others.

use super::module::IndexedModule;
use super::needs::Feature;
use super::text::{RefusedStage, Words};
use super::{addresses, indexing};
use crate::base::ShaderStage;
use crate::base::named;
use rspirv::spirv::Capability;

/// Capabilities that every stage may need: those of the minimum device, and the ones with a remark below.
const EVERYWHERE: [Capability; 11] = [
    Capability::Matrix,
    Capability::Shader,
    Capability::Sampled1D,
    Capability::Image1D,
    Capability::SampledBuffer,
    Capability::ImageBuffer,
    Capability::ImageQuery,
    Capability::DerivativeControl,
    // Shaders have it only where they are compiled for a local read, on a device with local reads.
    Capability::InputAttachment,
    // A device whose profile doesn't list the format for storage refuses the image. Vulkan makes the capability itself no
    // device's choice.
    Capability::StorageImageExtendedFormats,
    // It allows what one of `OF_DEVICES` asks for.
    Capability::ShaderNonUniform,
];

/// Words of GLSL that need numbers of a width.
const INT64: &[&str] = &["int64", "uint64", "i64vec", "u64vec"];
const BITS_16: &[&str] = &["int16", "uint16", "i16vec", "u16vec", "float16", "f16vec", "f16mat"];
const BITS_8: &[&str] = &["int8", "uint8", "i8vec", "u8vec"];
const WITHOUT_FORMAT: &[&str] = &["image1D", "image2D", "image3D", "imageCube", "uimage", "iimage"];
const DOT_PRODUCTS: (&str, &[&str]) = ("shaderIntegerDotProduct", &["dotEXT", "dotPacked", "dotAccSat"]);

/// Capabilities that every stage may need on devices that have the feature of this name, and how words of GLSL begin that need them.
const OF_DEVICES: [(Capability, &str, &[&str]); 52] = [
    // Of the minimum: a device that the program made itself may lack them.
    (Capability::SampleRateShading, "sampleRateShading", &["gl_SampleID", "gl_SamplePosition", "sample"]),
    (Capability::InterpolationFunction, "sampleRateShading", &["interpolateAt"]),
    (Capability::DemoteToHelperInvocation, "shaderDemoteToHelperInvocation", &["demote", "discard"]),
    // Arrays of cubes.
    (Capability::SampledCubeArray, "imageCubeArray", &["samplerCubeArray", "usamplerCubeArray", "isamplerCubeArray"]),
    (Capability::ImageCubeArray, "imageCubeArray", &["imageCubeArray", "uimageCubeArray", "iimageCubeArray"]),
    // Elements of arrays that are chosen by a number that changes, from draw to draw, or from pixel to pixel.
    (Capability::SampledImageArrayDynamicIndexing, indexing::SAMPLED, &[]),
    (Capability::StorageImageArrayDynamicIndexing, indexing::STORAGE, &[]),
    (Capability::SampledImageArrayNonUniformIndexing, "shaderSampledImageArrayNonUniformIndexing", &["nonuniformEXT"]),
    (Capability::StorageImageArrayNonUniformIndexing, "shaderStorageImageArrayNonUniformIndexing", &["nonuniformEXT"]),
    (Capability::UniformBufferArrayDynamicIndexing, indexing::UNIFORM_BLOCKS, &[]),
    (Capability::StorageBufferArrayDynamicIndexing, indexing::STORAGE_BLOCKS, &[]),
    (Capability::UniformTexelBufferArrayDynamicIndexing, indexing::UNIFORM_TEXELS, &[]),
    (Capability::StorageTexelBufferArrayDynamicIndexing, indexing::STORAGE_TEXELS, &[]),
    (
        Capability::UniformBufferArrayNonUniformIndexing,
        "shaderUniformBufferArrayNonUniformIndexing",
        &["nonuniformEXT"],
    ),
    (
        Capability::StorageBufferArrayNonUniformIndexing,
        "shaderStorageBufferArrayNonUniformIndexing",
        &["nonuniformEXT"],
    ),
    (
        Capability::UniformTexelBufferArrayNonUniformIndexing,
        "shaderUniformTexelBufferArrayNonUniformIndexing",
        &["nonuniformEXT"],
    ),
    (
        Capability::StorageTexelBufferArrayNonUniformIndexing,
        "shaderStorageTexelBufferArrayNonUniformIndexing",
        &["nonuniformEXT"],
    ),
    // Arrays whose length isn't written: a set of the program's can have them.
    (Capability::RuntimeDescriptorArray, "runtimeDescriptorArray", &["GL_EXT_nonuniform_qualifier", "nonuniformEXT"]),
    // Numbers that don't have 32 bits.
    (Capability::Float64, "shaderFloat64", &["double", "dvec", "dmat"]),
    (Capability::Int64, "shaderInt64", INT64),
    // Shared variables need one more feature: see `needs`.
    (Capability::Int64Atomics, "shaderBufferInt64Atomics", &["atomic"]),
    (Capability::Int16, "shaderInt16", BITS_16),
    (Capability::Float16, "shaderFloat16", &["float16", "f16vec", "f16mat"]),
    (Capability::Int8, "shaderInt8", BITS_8),
    (Capability::StorageBuffer16BitAccess, "storageBuffer16BitAccess", BITS_16),
    (Capability::UniformAndStorageBuffer16BitAccess, "uniformAndStorageBuffer16BitAccess", BITS_16),
    (Capability::StorageBuffer8BitAccess, "storageBuffer8BitAccess", BITS_8),
    (Capability::UniformAndStorageBuffer8BitAccess, "uniformAndStorageBuffer8BitAccess", BITS_8),
    // Images and draws.
    (Capability::StorageImageReadWithoutFormat, "shaderStorageImageReadWithoutFormat", WITHOUT_FORMAT),
    (Capability::StorageImageWriteWithoutFormat, "shaderStorageImageWriteWithoutFormat", WITHOUT_FORMAT),
    (Capability::ImageGatherExtended, "shaderImageGatherExtended", &["textureGather"]),
    (Capability::DrawParameters, "shaderDrawParameters", &["gl_BaseVertex", "gl_BaseInstance", "gl_DrawID"]),
    (Capability::Geometry, "geometryShader", &["gl_PrimitiveID", "gl_Layer"]),
    (Capability::ClipDistance, "shaderClipDistance", &["gl_ClipDistance"]),
    (Capability::CullDistance, "shaderCullDistance", &["gl_CullDistance"]),
    (
        Capability::FragmentBarycentricKHR,
        "fragmentShaderBarycentric",
        &["gl_BaryCoord", "GL_EXT_fragment_shader_barycentric"],
    ),
    (Capability::DotProduct, DOT_PRODUCTS.0, DOT_PRODUCTS.1),
    (Capability::DotProductInputAll, DOT_PRODUCTS.0, DOT_PRODUCTS.1),
    (Capability::DotProductInput4x8Bit, DOT_PRODUCTS.0, DOT_PRODUCTS.1),
    (Capability::DotProductInput4x8BitPacked, DOT_PRODUCTS.0, DOT_PRODUCTS.1),
    (Capability::VulkanMemoryModel, "vulkanMemoryModel", &["GL_KHR_memory_scope_semantics"]),
    (
        Capability::VulkanMemoryModelDeviceScope,
        "vulkanMemoryModelDeviceScope",
        &["gl_ScopeDevice", "atomic", "coherent"],
    ),
    // Rays and addresses.
    (Capability::RayQueryKHR, "rayQuery", RAYS),
    // Vulkan lets the same feature bring it.
    (Capability::RayTraversalPrimitiveCullingKHR, "rayQuery", RAYS),
    (Capability::PhysicalStorageBufferAddresses, "bufferDeviceAddress", addresses::WORDS),
    // Subgroups.
    (Capability::GroupNonUniformVote, "subgroupSupportedOperations.VOTE", &["subgroupA"]),
    (Capability::GroupNonUniformArithmetic, "subgroupSupportedOperations.ARITHMETIC", SUBGROUPS),
    (Capability::GroupNonUniformBallot, "subgroupSupportedOperations.BALLOT", SUBGROUPS),
    (Capability::GroupNonUniformShuffle, "subgroupSupportedOperations.SHUFFLE", &["subgroupShuffle"]),
    (
        Capability::GroupNonUniformShuffleRelative,
        "subgroupSupportedOperations.SHUFFLE_RELATIVE",
        &["subgroupShuffleUp", "subgroupShuffleDown"],
    ),
    (Capability::GroupNonUniformClustered, "subgroupSupportedOperations.CLUSTERED", &["subgroupClustered"]),
    (Capability::GroupNonUniformQuad, "subgroupSupportedOperations.QUAD", &["subgroupQuad"]),
];

const RAYS: &[&str] = &["rayQuery", "RayQuery"];
const SUBGROUPS: &[&str] = &["subgroup", "gl_Subgroup", "GL_KHR_shader_subgroup"];

/// More capabilities, of shaders that draw for both eyes at once.
const FOR_BOTH_EYES: [Capability; 3] =
    [Capability::MultiView, Capability::ShaderLayer, Capability::ShaderViewportIndexLayerEXT];

/// A feature that isn't supported: capabilities, how words of GLSL begin that need them, and what to write instead.
type UnsupportedFeature = (&'static [Capability], &'static [&'static str], &'static str);

const UNSUPPORTED: &[UnsupportedFeature] = &[
    (
        &[Capability::ShaderLayer, Capability::ShaderViewportIndexLayerEXT, Capability::MultiViewport],
        &["gl_Layer", "gl_ViewportIndex"],
        "layers and viewports that a vertex shader chooses: draw into each layer by a pass of its own",
    ),
    (
        &[Capability::StorageImageMultisample, Capability::ImageMSArray],
        &["image2DMS", "uimage2DMS", "iimage2DMS"],
        "storage images with several samples: sample them by a `sampler2DMS`",
    ),
    (&[Capability::PhysicalStorageBufferAddresses], addresses::WORDS, addresses::UNSAID),
    (
        &[Capability::FragmentShadingRateKHR],
        &["gl_ShadingRateEXT", "gl_PrimitiveShadingRateEXT"],
        "rates of shading: rendering scopes have no attachment of them",
    ),
];

/// Refuses what isn't supported, with the words that need it and what to write instead. Returns the features that a device must have.
/// `handed_out`: the program hands addresses out.
///
/// # Errors
/// The first capability that a stage needs and may not.
pub(super) fn check_capabilities(
    module: &IndexedModule<'_>,
    stage: ShaderStage,
    both_eyes: bool,
    handed_out: bool,
) -> Result<Vec<Feature>, RefusedStage> {
    let allowed = |it: Capability| EVERYWHERE.contains(&it) || both_eyes && FOR_BOTH_EYES.contains(&it);
    let unsaid = |it: Capability| it == Capability::PhysicalStorageBufferAddresses && !handed_out;
    let mut features = Vec::new();
    for capability in module.capabilities().filter(|it| !allowed(*it)) {
        match of_devices(capability, stage) {
            Some(needed) if !unsaid(capability) => features.extend(needed),
            _ => return Err(refused(capability)),
        }
    }
    Ok(features)
}

/// The features that a device must have for a capability of a stage; `None`: it isn't supported.
fn of_devices(capability: Capability, stage: ShaderStage) -> Option<Vec<Feature>> {
    let row = OF_DEVICES.iter().find(|(known, ..)| *known == capability);
    let feature = |name, words| Feature { name, words: Words::Beginning(words) };
    let facts = stage.facts();
    match (capability, row) {
        (Capability::GroupNonUniform, _) => {
            Some(facts.subgroups.map(|name| feature(name, SUBGROUPS)).into_iter().collect())
        }
        (Capability::GroupNonUniformQuad, Some((_, name, words))) if facts.places_vertices => {
            Some(vec![feature(name, words), feature("subgroupQuadOperationsInAllStages", words)])
        }
        (_, row) => row.map(|(_, name, words)| vec![feature(name, words)]),
    }
}

/// Says that a capability isn't supported, and what to write instead.
fn refused(capability: Capability) -> RefusedStage {
    let needs = |what: &str| format!("it needs SPIR-V's capability {}, which isn't supported{what}", named(capability));
    match UNSUPPORTED.iter().find(|(capabilities, ..)| capabilities.contains(&capability)) {
        Some((_, words, what)) => RefusedStage::beginning(words, needs(&format!(": {what}"))),
        None => needs("").into(),
    }
}
