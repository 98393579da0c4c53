//! The capabilities of SPIR-V that stages may need, and what GLSL to write instead of what needs others.

use super::indexing;
use super::module::IndexedModule;
use super::needs::Feature;
use super::text::{RefusedStage, Words};
use crate::base::ShaderStage;
use crate::base::named;
use rspirv::dr::Operand;
use rspirv::spirv::Capability;

/// Capabilities that every stage may need: those of the minimum device, and the ones with a remark below.
const EVERYWHERE: [Capability; 14] = [
    Capability::Matrix,
    Capability::Shader,
    Capability::Sampled1D,
    Capability::Image1D,
    Capability::SampledBuffer,
    Capability::ImageBuffer,
    Capability::ImageQuery,
    Capability::DerivativeControl,
    Capability::SampleRateShading,
    Capability::InterpolationFunction,
    Capability::DemoteToHelperInvocation,
    // Shaders have it only where they are compiled for a local read, on a device with local reads.
    Capability::InputAttachment,
    // A device whose profile doesn't list the format for storage refuses the image. Vulkan makes the capability itself no
    // device's choice.
    Capability::StorageImageExtendedFormats,
    // It allows what one of `OF_DEVICES` asks for.
    Capability::ShaderNonUniform,
];

/// Capabilities that every stage may need on devices that have the feature of this name, and how words of GLSL begin that need them:
/// arrays of cubes; and elements of arrays that are chosen by a number that changes, from draw to draw, or from pixel to pixel
/// (`nonuniformEXT`).
const OF_DEVICES: [(Capability, &str, &[&str]); 6] = [
    (Capability::SampledCubeArray, "imageCubeArray", &["samplerCubeArray", "usamplerCubeArray", "isamplerCubeArray"]),
    (Capability::ImageCubeArray, "imageCubeArray", &["imageCubeArray", "uimageCubeArray", "iimageCubeArray"]),
    (Capability::SampledImageArrayDynamicIndexing, indexing::SAMPLED, &[]),
    (Capability::StorageImageArrayDynamicIndexing, indexing::STORAGE, &[]),
    (Capability::SampledImageArrayNonUniformIndexing, "shaderSampledImageArrayNonUniformIndexing", &["nonuniformEXT"]),
    (Capability::StorageImageArrayNonUniformIndexing, "shaderStorageImageArrayNonUniformIndexing", &["nonuniformEXT"]),
];

/// Capabilities that only compute shaders may need: Vulkan 1.1 promises them `subgroupElect`, `subgroupBarrier` and the like.
const COMPUTE: [Capability; 1] = [Capability::GroupNonUniform];

/// More capabilities, of shaders that draw for both eyes at once.
const FOR_BOTH_EYES: [Capability; 4] =
    [Capability::MultiView, Capability::ClipDistance, Capability::ShaderLayer, Capability::ShaderViewportIndexLayerEXT];

/// A feature that isn't supported: capabilities, how words of GLSL begin that need them, and what to write instead.
type UnsupportedFeature = (&'static [Capability], &'static [&'static str], &'static str);

const SUBGROUPS: &[&str] = &["subgroup", "gl_Subgroup", "GL_KHR_shader_subgroup"];

const UNSUPPORTED: &[UnsupportedFeature] = &[
    (&[Capability::Float64], &["double", "dvec", "dmat"], "64-bit floating point: write `float`"),
    (
        &[Capability::Int64, Capability::Int16, Capability::Int8],
        &[
            "int64", "uint64", "i64vec", "u64vec", "int16", "uint16", "i16vec", "u16vec", "int8", "uint8", "i8vec",
            "u8vec",
        ],
        "integers of another size than 32 bits: write `int` or `uint`",
    ),
    (&[Capability::Float16], &["float16", "f16vec", "f16mat"], "16-bit floating point: write `float`"),
    (
        &[Capability::StorageImageReadWithoutFormat, Capability::StorageImageWriteWithoutFormat],
        &["image1D", "image2D", "image3D", "imageCube", "uimage", "iimage"],
        "a storage image without a format: name that of the pass's image, such as `layout(rgba16f)`",
    ),
    (
        &[Capability::GroupNonUniform],
        SUBGROUPS,
        "subgroups in a stage that draws, where not every device has them: use them in a compute shader",
    ),
    (
        &[
            Capability::GroupNonUniformVote,
            Capability::GroupNonUniformArithmetic,
            Capability::GroupNonUniformBallot,
            Capability::GroupNonUniformShuffle,
            Capability::GroupNonUniformShuffleRelative,
            Capability::GroupNonUniformClustered,
            Capability::GroupNonUniformQuad,
        ],
        SUBGROUPS,
        "operations of subgroups that not every device has: Vulkan promises `subgroupElect`, `subgroupBarrier` and \
         `subgroupMemoryBarrier` alone; use `shared` variables",
    ),
    (
        &[Capability::Geometry],
        &["gl_PrimitiveID", "gl_Layer"],
        "numbers of primitives and layers: pass what tells them apart from the vertex stage, as `flat`",
    ),
    (
        &[Capability::ShaderLayer, Capability::ShaderViewportIndexLayerEXT, Capability::MultiViewport],
        &["gl_Layer", "gl_ViewportIndex"],
        "layers and viewports that a vertex shader chooses: draw into each layer by a pass of its own",
    ),
    (
        &[Capability::ClipDistance, Capability::CullDistance],
        &["gl_ClipDistance", "gl_CullDistance"],
        "clip and cull distances: use `discard` in the fragment stage",
    ),
    (
        &[Capability::DrawParameters],
        &["gl_BaseVertex", "gl_BaseInstance", "gl_DrawID"],
        "parameters of draws: use `gl_VertexIndex` and `gl_InstanceIndex`",
    ),
    (
        &[Capability::ImageGatherExtended],
        &["textureGather"],
        "gathers with offsets that vary or differ: use `textureGatherOffset` with a constant, or `texelFetch`",
    ),
    (
        &[Capability::RuntimeDescriptorArray],
        &["nonuniformEXT", "GL_EXT_nonuniform_qualifier"],
        "an array of images whose length isn't written: write it, as in `uniform sampler2D textures[64];`",
    ),
    (
        &[
            Capability::UniformBufferArrayDynamicIndexing,
            Capability::UniformBufferArrayNonUniformIndexing,
            Capability::StorageBufferArrayDynamicIndexing,
            Capability::StorageBufferArrayNonUniformIndexing,
        ],
        &["uniform", "buffer"],
        "an array of blocks: write an array into one storage block",
    ),
    (
        &[Capability::StorageImageMultisample, Capability::ImageMSArray],
        &["image2DMS", "uimage2DMS", "iimage2DMS"],
        "storage images with several samples: sample them by a `sampler2DMS`",
    ),
];

/// Refuses what isn't supported, with the words that need it and what to write instead. Returns the features that a device must have.
///
/// # Errors
/// The first capability that a stage needs and may not.
pub(super) fn check_capabilities(
    module: &IndexedModule<'_>,
    stage: ShaderStage,
    both_eyes: bool,
) -> Result<Vec<Feature>, RefusedStage> {
    let needed = module.module.capabilities.iter().filter_map(|it| match it.operands.first() {
        Some(Operand::Capability(capability)) => Some(*capability),
        _ => None,
    });
    let feature = |it: &Capability| {
        let found = OF_DEVICES.iter().find(|(capability, ..)| capability == it);
        found.map(|(_, name, words)| Feature { name, words: Words::Beginning(words) })
    };
    let features = needed.clone().filter_map(|it| feature(&it)).collect();
    let allowed = |it: &Capability| {
        EVERYWHERE.contains(it)
            || feature(it).is_some()
            || stage.facts().has_workgroups && COMPUTE.contains(it)
            || both_eyes && FOR_BOTH_EYES.contains(it)
    };
    // The most exact is said: `subgroupBallot` needs what all operations of subgroups need, too.
    let Some(capability) = needed.filter(|it| !allowed(it)).max_by_key(|it| *it != Capability::GroupNonUniform) else {
        return Ok(features);
    };
    let needs = |what: &str| format!("it needs SPIR-V's capability {}, which isn't supported{what}", named(capability));
    Err(match UNSUPPORTED.iter().find(|(capabilities, ..)| capabilities.contains(&capability)) {
        Some((_, words, what)) => RefusedStage::beginning(words, needs(&format!(": {what}"))),
        None => needs("").into(),
    })
}
