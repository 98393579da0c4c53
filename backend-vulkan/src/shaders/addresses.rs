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

#[cfg(test)]
mod tests {
    use super::*;
    use rspirv::dr::Builder;
    use rspirv::spirv::FunctionControl;

    /// DO-4: the address of an acceleration structure is none that a shader makes up, whatever it declares.
    #[test]
    fn a_structure_is_found_by_an_address_only_where_the_program_hands_them_out() {
        let refused = |converts: bool, handed_out: bool| {
            let mut builder = Builder::new();
            let (void, uint) = (builder.type_void(), builder.type_int(32, 0));
            let structure = builder.type_acceleration_structure_khr();
            let (pair, ty) = (builder.type_vector(uint, 2), builder.type_function(void, []));
            let address = builder.constant_null(pair);
            builder.begin_function(void, None, FunctionControl::NONE, ty).expect("a function");
            builder.begin_block(None).expect("a block");
            if converts {
                builder.convert_u_to_acceleration_structure_khr(structure, None, address).expect("in a block");
            }
            builder.ret().expect("in a block");
            builder.end_function().expect("in a function");
            let module = builder.module();
            check(&IndexedModule::new(&module), handed_out).err().map(|refused| refused.what)
        };
        let what = refused(true, false).expect("refused");
        assert!(what.starts_with("it finds an acceleration structure by its address"), "{what}");
        assert!(what.ends_with(UNSAID), "{what}");
        assert_eq!([refused(true, true), refused(false, false)], [None, None]);
    }
}
