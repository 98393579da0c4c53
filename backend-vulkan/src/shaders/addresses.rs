//! Addresses that a stage follows: references to buffers, and acceleration structures that it finds by an address.
//!
//! Nothing bounds what is behind an address. So a stage may follow one only where the program says that it hands addresses out: a pipeline
//! file by itself has none, and its shaders could make up any.

use super::module::{IndexedModule, id, storage_class};
use super::text::RefusedStage;
use rspirv::dr::Instruction;
use rspirv::spirv::{Op, StorageClass};
use std::collections::HashMap;

/// How words begin that follow addresses: those of GLSL, HLSL and Slang.
pub(super) const WORDS: &[&str] = &["buffer_reference", "RawBufferLoad", "RawBufferStore", "BufferPointer"];

/// What the program has to say.
pub(super) const UNSAID: &str = "nothing bounds what is behind an address, and no program says that it hands addresses out \
    (`DrawInterfaces::with_addresses`, `addresses: true` in its interface file)";

/// Refuses acceleration structures that are found by an address, where the program hands none out.
///
/// # Errors
/// That the stage has one.
pub(super) fn check(module: &IndexedModule<'_>, handed_out: bool) -> Result<(), RefusedStage> {
    let converts = || module.code().any(|it| it.class.opcode == Op::ConvertUToAccelerationStructureKHR);
    if handed_out || !converts() {
        return Ok(());
    }
    let what = format!("it finds an acceleration structure by its address, which isn't supported: {UNSAID}");
    Err(RefusedStage::beginning(&["accelerationStructureEXT", "RaytracingAccelerationStructure"], what))
}

/// The types of what lies behind addresses.
pub(super) fn followed_types<'m>(module: &'m IndexedModule<'m>) -> impl Iterator<Item = &'m Instruction> {
    module.module.types_global_values.iter().filter(|it| is_reference(it)).filter_map(|it| module.global(id(it, 1)?))
}

/// Whether the stage stores anything behind an address.
pub(super) fn stores(module: &IndexedModule<'_>) -> bool {
    if followed_types(module).next().is_none() {
        return false;
    }
    let parameters = module.module.functions.iter().flat_map(|it| &it.parameters);
    let values = module.code().chain(parameters);
    let types: HashMap<u32, u32> = values.filter_map(|it| Some((it.result_id?, it.result_type?))).collect();
    let is_behind = |pointer: u32| types.get(&pointer).and_then(|ty| module.global(*ty)).is_some_and(is_reference);
    module.code().any(|it| stored(it).is_some_and(is_behind))
}

/// Whether a type is that of references to what is behind addresses.
fn is_reference(ty: &Instruction) -> bool {
    ty.class.opcode == Op::TypePointer && storage_class(ty) == Some(StorageClass::PhysicalStorageBuffer)
}

/// The pointer that an instruction stores through, if it may store.
fn stored(it: &Instruction) -> Option<u32> {
    let stores = match it.class.opcode {
        Op::AtomicLoad => false,
        Op::Store | Op::CopyMemory | Op::CopyMemorySized | Op::AtomicFlagTestAndSet | Op::AtomicFlagClear => true,
        // All others are changes.
        _ => it.class.opname.starts_with("Atomic"),
    };
    if stores { id(it, 0) } else { None }
}
