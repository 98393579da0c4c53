//! Modules of SPIR-V before 1.5 as modules of 1.5, which layers that a vertex stage chooses take.
//!
//! Two things are told otherwise: an entry point names all variables that it uses, and a storage block is told by the storage class of
//! its variable, and no more by a decoration of its type.

use super::module::{id, storage_class};
use super::text::RefusedStage;
use rspirv::dr::{Builder, Function, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass, Word};
use std::collections::HashSet;

/// Makes a module with one entry point one of SPIR-V 1.5.
///
/// # Errors
/// It hands a storage block to a function.
pub(super) fn raise(builder: &mut Builder) -> Result<(), RefusedStage> {
    if builder.version().is_some_and(|version| version >= (1, 5)) {
        return Ok(());
    }
    let blocks = storage_blocks(builder);
    if !blocks.is_empty() {
        let variables = declared_by_class(builder, &blocks);
        let mut functions = std::mem::take(&mut builder.module_mut().functions);
        let followed = functions.iter_mut().all(|function| follow(builder, function, variables.clone()));
        builder.module_mut().functions = functions;
        if !followed {
            let what = "it hands a storage block to a function, and one draw for both eyes' layers takes it inlined";
            return Err(what.to_owned().into());
        }
    }
    builder.set_version(1, 5);
    let module = builder.module_mut();
    let variables = module.types_global_values.iter().filter(|it| it.class.opcode == Op::Variable);
    let variables: Vec<Word> = variables.filter_map(|it| it.result_id).collect();
    for point in &mut module.entry_points {
        let named: HashSet<Word> = point.operands.iter().filter_map(Operand::id_ref_any).collect();
        point.operands.extend(variables.iter().filter(|it| !named.contains(it)).map(|it| Operand::IdRef(*it)));
    }
    Ok(())
}

/// The types of storage blocks, whose decoration becomes that of all blocks.
fn storage_blocks(builder: &mut Builder) -> HashSet<Word> {
    let mut blocks = HashSet::new();
    for it in &mut builder.module_mut().annotations {
        let marks = it.class.opcode == Op::Decorate
            && it.operands.get(1) == Some(&Operand::Decoration(Decoration::BufferBlock));
        if marks {
            it.operands[1] = Operand::Decoration(Decoration::Block);
            blocks.extend(id(it, 0));
        }
    }
    blocks
}

/// Gives the variables of storage blocks, and the types of pointers to them, the storage class of these. Returns the variables.
fn declared_by_class(builder: &mut Builder, blocks: &HashSet<Word>) -> HashSet<Word> {
    let (mut held, mut pointers, mut variables) = (blocks.clone(), HashSet::new(), HashSet::new());
    for it in &mut builder.module_mut().types_global_values {
        let Some(result) = it.result_id else { continue };
        let is_uniform = storage_class(it) == Some(StorageClass::Uniform);
        let of_class = Operand::StorageClass(StorageClass::StorageBuffer);
        match it.class.opcode {
            Op::TypeArray | Op::TypeRuntimeArray if id(it, 0).is_some_and(|ty| held.contains(&ty)) => {
                held.insert(result);
            }
            Op::TypePointer if is_uniform && id(it, 1).is_some_and(|ty| held.contains(&ty)) => {
                it.operands[0] = of_class;
                pointers.insert(result);
            }
            Op::Variable if it.result_type.is_some_and(|ty| pointers.contains(&ty)) => {
                it.operands[0] = of_class;
                variables.insert(result);
            }
            _ => {}
        }
    }
    variables
}

/// Gives pointers into storage blocks their class. `known`: such pointers. Whether all could be followed.
fn follow(builder: &mut Builder, function: &mut Function, mut known: HashSet<Word>) -> bool {
    for it in function.blocks.iter_mut().flat_map(|block| &mut block.instructions) {
        let of_known = it.operands.iter().filter_map(Operand::id_ref_any).any(|id| known.contains(&id));
        if !of_known {
            continue;
        }
        match it.class.opcode {
            Op::AccessChain | Op::InBoundsAccessChain | Op::CopyObject => {
                let globals = &builder.module_ref().types_global_values;
                let pointee = globals.iter().find(|ty| ty.result_id == it.result_type).and_then(|ty| id(ty, 1));
                let Some(pointee) = pointee else { return false };
                it.result_type = Some(builder.type_pointer(None, StorageClass::StorageBuffer, pointee));
                known.extend(it.result_id);
            }
            Op::FunctionCall | Op::Phi | Op::Select => return false,
            _ => {}
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use rspirv::spirv::FunctionControl;

    /// DO-1: a storage block of an old version that is handed to a function can't be followed there.
    #[test]
    fn a_storage_block_that_is_handed_to_a_function_is_refused() {
        let raised = |hands: bool| {
            let mut builder = Builder::new();
            builder.set_version(1, 0);
            let (void, uint) = (builder.type_void(), builder.type_int(32, 0));
            let block = builder.type_struct([uint]);
            builder.decorate(block, Decoration::BufferBlock, []);
            let pointer = builder.type_pointer(None, StorageClass::Uniform, block);
            let variable = builder.variable(pointer, None, StorageClass::Uniform, None);
            let takes = builder.type_function(void, [pointer]);
            let callee = builder.begin_function(void, None, FunctionControl::NONE, takes).expect("a function");
            builder.function_parameter(pointer).expect("in a function");
            builder.begin_block(None).expect("a block");
            if hands {
                builder.function_call(void, None, callee, [variable]).expect("in a block");
            }
            builder.ret().expect("in a block");
            builder.end_function().expect("in a function");
            raise(&mut builder).err().map(|refused| refused.what)
        };
        let what = "it hands a storage block to a function, and one draw for both eyes' layers takes it inlined";
        assert_eq!(raised(true).as_deref(), Some(what));
        assert_eq!(raised(false), None);
    }
}
