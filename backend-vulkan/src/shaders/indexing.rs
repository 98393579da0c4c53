//! How a stage chooses among the elements of arrays of images, read off its SPIR-V: the compiler names no capability for numbers that
//! are the same for a whole draw.

use super::module::{IndexedModule, id, number, storage_class};
use rspirv::dr::Instruction;
use rspirv::spirv::{Op, StorageClass};

/// The features that a device must have for it, by Vulkan's names: those of arrays that are indexed by anything but constants.
pub(super) fn features(module: &IndexedModule<'_>) -> Vec<&'static str> {
    let chains = module.code().filter(|it| matches!(it.class.opcode, Op::AccessChain | Op::InBoundsAccessChain));
    chains.filter(|it| chooses(module, it)).filter_map(|it| feature(module, it)).collect()
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
        Op::TypeSampledImage => Some("shaderSampledImageArrayDynamicIndexing"),
        Op::TypeImage if element.operands.get(5).and_then(number) == Some(2) => {
            Some("shaderStorageImageArrayDynamicIndexing")
        }
        _ => None,
    }
}
