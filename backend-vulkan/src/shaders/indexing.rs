//! How a stage chooses among the elements of arrays of images and blocks, read off its SPIR-V: the compiler names no capability for
//! numbers that are the same for a whole draw.

use super::module::{IndexedModule, id, number, storage_class};
use super::needs::Feature;
use super::text::Words;
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Dim, Op, StorageClass};

/// The feature for elements of arrays of sampled images, by a number that changes.
pub(super) const SAMPLED: &str = "shaderSampledImageArrayDynamicIndexing";
/// The same of storage images.
pub(super) const STORAGE: &str = "shaderStorageImageArrayDynamicIndexing";
/// The same of uniform blocks.
pub(super) const UNIFORM_BLOCKS: &str = "shaderUniformBufferArrayDynamicIndexing";
/// The same of storage blocks.
pub(super) const STORAGE_BLOCKS: &str = "shaderStorageBufferArrayDynamicIndexing";
/// The same of texel buffers that are read.
pub(super) const UNIFORM_TEXELS: &str = "shaderUniformTexelBufferArrayDynamicIndexing";
/// The same of texel buffers that are read and written.
pub(super) const STORAGE_TEXELS: &str = "shaderStorageTexelBufferArrayDynamicIndexing";

/// The features that a device must have for it: those of arrays that are indexed by anything but constants.
pub(super) fn features(module: &IndexedModule<'_>) -> Vec<Feature> {
    let chains = module.code().filter(|it| matches!(it.class.opcode, Op::AccessChain | Op::InBoundsAccessChain));
    let chosen = chains.filter_map(|it| {
        let array = it.operands.first()?.id_ref_any().map_or("", |array| module.name(array));
        Some(Feature { name: feature(module, it)?, words: Words::Whole(array.to_owned()) })
    });
    chosen.collect()
}

/// Whether one of the first indices isn't a constant.
fn varies(module: &IndexedModule<'_>, chain: &Instruction, indices: usize) -> bool {
    let mut indices = chain.operands.iter().skip(1).take(indices).filter_map(Operand::id_ref_any);
    indices.any(|index| module.global(index).is_none())
}

/// The feature that choosing from such an array takes; `None`: nothing is chosen, or by constants.
fn feature(module: &IndexedModule<'_>, chain: &Instruction) -> Option<&'static str> {
    let pointer = module.global(chain.result_type?)?;
    if storage_class(pointer)? == StorageClass::UniformConstant {
        return images(module, module.global(id(pointer, 1)?)?).filter(|_| varies(module, chain, usize::MAX));
    }
    // Of indices into an array of blocks the first one chooses the block.
    let variable = module.global(chain.operands.first()?.id_ref_any()?)?;
    storage_class(variable).filter(|it| matches!(it, StorageClass::Uniform | StorageClass::StorageBuffer))?;
    let array =
        module.pointee(variable).filter(|it| matches!(it.class.opcode, Op::TypeArray | Op::TypeRuntimeArray))?;
    let block = module.global(id(array, 0)?)?;
    let name = if module.is_storage_block(variable, block) { STORAGE_BLOCKS } else { UNIFORM_BLOCKS };
    varies(module, chain, 1).then_some(name)
}

/// The same of images of a type, or samplers.
fn images(module: &IndexedModule<'_>, element: &Instruction) -> Option<&'static str> {
    let texels = |image: &Instruction| matches!(image.operands.get(1), Some(Operand::Dim(Dim::DimBuffer)));
    match element.class.opcode {
        Op::TypeSampler => Some(SAMPLED),
        Op::TypeSampledImage if module.global(id(element, 0)?).is_some_and(texels) => Some(UNIFORM_TEXELS),
        Op::TypeSampledImage => Some(SAMPLED),
        Op::TypeImage => Some(match (element.operands.get(5).and_then(number) == Some(2), texels(element)) {
            (true, true) => STORAGE_TEXELS,
            (true, false) => STORAGE,
            (false, true) => UNIFORM_TEXELS,
            (false, false) => SAMPLED,
        }),
        _ => None,
    }
}
