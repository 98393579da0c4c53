//! A fragment stage whose colours go nowhere: it draws nothing but depth, and decides what is covered.

use super::module::{IndexedModule, id, storage_class};
use rspirv::binary::Assemble;
use rspirv::dr::{Builder, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass};
use std::collections::BTreeSet;

/// The stage with variables of its own in place of its colour outputs. One that hands an output to a function stays as it is.
///
/// # Errors
/// In words: it can't be read.
pub(super) fn none(spirv: &[u32]) -> Result<Vec<u32>, String> {
    let module = rspirv::dr::load_words(spirv).map_err(|error| format!("SPIR-V that can't be read: {error}"))?;
    let indexed = IndexedModule::new(&module);
    let is_color = |id: u32| indexed.decoration(id, Decoration::Location).is_some();
    let outputs = indexed.variables().filter(|(_, it)| storage_class(it) == Some(StorageClass::Output));
    let colors: BTreeSet<u32> = outputs.map(|(id, _)| id).filter(|id| is_color(*id)).collect();
    // SPIR-V names a pointer after what it comes from.
    let mut pointers = colors.clone();
    for it in indexed.code() {
        let of_color = id(it, 0).is_some_and(|base| pointers.contains(&base));
        match it.class.opcode {
            Op::AccessChain | Op::InBoundsAccessChain | Op::CopyObject if of_color => pointers.extend(it.result_id),
            Op::FunctionCall if it.operands.iter().filter_map(Operand::id_ref_any).any(|it| pointers.contains(&it)) => {
                return Ok(spirv.to_vec());
            }
            _ => {}
        }
    }
    if colors.is_empty() {
        return Ok(spirv.to_vec());
    }
    let mut builder = Builder::new_from_module(module);
    let own = |builder: &mut Builder, pointer: u32| {
        let globals = &builder.module_ref().types_global_values;
        let pointee = globals.iter().find(|it| it.result_id == Some(pointer)).and_then(|it| id(it, 1));
        pointee.map_or(pointer, |pointee| builder.type_pointer(None, StorageClass::Private, pointee))
    };
    for color in &colors {
        let globals = &builder.module_ref().types_global_values;
        let Some(at) = globals.iter().position(|it| it.result_id == Some(*color)) else { continue };
        let mut variable = builder.module_mut().types_global_values.remove(at);
        variable.result_type = variable.result_type.map(|pointer| own(&mut builder, pointer));
        if let Some(class) = variable.operands.first_mut() {
            *class = Operand::StorageClass(StorageClass::Private);
        }
        // Behind its type.
        builder.module_mut().types_global_values.push(variable);
    }
    let mut functions = std::mem::take(&mut builder.module_mut().functions);
    for it in functions.iter_mut().flat_map(|it| &mut it.blocks).flat_map(|it| &mut it.instructions) {
        if it.result_id.is_some_and(|result| pointers.contains(&result)) {
            it.result_type = it.result_type.map(|pointer| own(&mut builder, pointer));
        }
    }
    let module = builder.module_mut();
    module.functions = functions;
    module.annotations.retain(|it| {
        let of_output = [Decoration::Location, Decoration::Component, Decoration::Index];
        let of_output = it.operands.get(1).is_some_and(|it| of_output.map(Operand::Decoration).contains(it));
        !(of_output && id(it, 0).is_some_and(|on| colors.contains(&on)))
    });
    Ok(builder.module().assemble())
}
