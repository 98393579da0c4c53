//! How a stage chooses among the elements of arrays of images, read off its SPIR-V: the compiler names no capability for numbers that
//! are the same for a whole draw.

use super::module::{IndexedModule, id, number, storage_class};
use super::needs::Feature;
use super::text::Words;
use rspirv::dr::Instruction;
use rspirv::spirv::{Op, StorageClass};

/// The feature for elements of arrays of sampled images, by a number that changes.
pub(super) const SAMPLED: &str = "shaderSampledImageArrayDynamicIndexing";
/// The same of storage images.
pub(super) const STORAGE: &str = "shaderStorageImageArrayDynamicIndexing";

/// The features that a device must have for it: those of arrays that are indexed by anything but constants.
pub(super) fn features(module: &IndexedModule<'_>) -> Vec<Feature> {
    let chains = module.code().filter(|it| matches!(it.class.opcode, Op::AccessChain | Op::InBoundsAccessChain));
    let chosen = chains.filter(|it| chooses(module, it)).filter_map(|it| {
        let array = it.operands.first()?.id_ref_any().map_or("", |array| module.name(array));
        Some(Feature { name: feature(module, it)?, words: Words::Whole(array.to_owned()) })
    });
    chosen.collect()
}

/// Whether an index isn't a constant.
fn chooses(module: &IndexedModule<'_>, chain: &Instruction) -> bool {
    let mut indices = chain.operands.iter().skip(1).filter_map(|it| it.id_ref_any());
    indices.any(|index| module.global(index).is_none())
}

/// The feature that indexing such images takes; `None`: it is no image that is chosen.
fn feature(module: &IndexedModule<'_>, chain: &Instruction) -> Option<&'static str> {
    let pointer = module.global(chain.result_type?)?;
    storage_class(pointer).filter(|class| *class == StorageClass::UniformConstant)?;
    let element = module.global(id(pointer, 1)?)?;
    match element.class.opcode {
        Op::TypeSampledImage => Some(SAMPLED),
        Op::TypeImage if element.operands.get(5).and_then(number) == Some(2) => Some(STORAGE),
        _ => None,
    }
}
