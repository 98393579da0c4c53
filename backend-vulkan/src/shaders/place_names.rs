//! Names for what a module has none for, or none that a pipeline file could write: resources by their bindings, members of blocks by
//! their offsets, and what goes from stage to stage by its location.

use super::module::{IndexedModule, number, storage_class};
use framewright_graph::shader::{binding_name, element_of, is_place, location_name, offset_name};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass};
use std::collections::{HashMap, HashSet};

/// Names of a pipeline file have at most so many bytes.
const LONGEST: usize = 64;

/// Adds the names. A name that two resources of a set share, or two members of a block, counts for none. Variables at one binding are
/// one resource.
pub(super) fn add(module: &mut Module) {
    let indexed = IndexedModule::new(module);
    let (mut names, mut blocks) = (Vec::new(), HashSet::new());
    let mut of_sets: HashMap<(u32, &str), HashSet<u32>> = HashMap::new();
    let name_of = |variable: u32, it: &Instruction| {
        let own = indexed.name(variable);
        let ty = indexed.pointee(it).and_then(|ty| ty.result_id);
        if own.is_empty() { ty.map_or("", |ty| indexed.name(ty)) } else { own }
    };
    let place = |variable: u32| {
        let number = |decoration| indexed.decoration_number(variable, decoration);
        Some((number(Decoration::DescriptorSet)?, number(Decoration::Binding)?))
    };
    for (variable, it) in indexed.variables() {
        if let Some((set, binding)) = place(variable) {
            of_sets.entry((set, name_of(variable, it))).or_default().insert(binding);
        }
    }
    for (variable, it) in indexed.variables() {
        if let Some((set, binding)) = place(variable) {
            let own = name_of(variable, it);
            if !can_be_written(own) || of_sets[&(set, own)].len() > 1 {
                names.push((variable, None, binding_name(set, binding)));
            }
            let block = indexed.pointee(it).filter(|ty| ty.class.opcode == Op::TypeStruct);
            // One compiler wraps what is bound in a struct of its own.
            let inner = block.and_then(|block| match &block.operands[..] {
                [Operand::IdRef(only)] => indexed.global(*only).filter(|ty| ty.class.opcode == Op::TypeStruct),
                _ => None,
            });
            blocks.extend(block.into_iter().chain(inner).filter_map(|ty| ty.result_id));
        } else if let Some(location) = indexed.decoration_number(variable, Decoration::Location)
            && matches!(storage_class(it), Some(StorageClass::Input | StorageClass::Output))
            && indexed.name(variable).is_empty()
        {
            names.push((variable, None, location_name(location)));
        }
    }
    for block in blocks {
        let Some(structure) = indexed.global(block) else { continue };
        let members = 0..u32::try_from(structure.operands.len()).unwrap_or(0);
        let own = |member| indexed.member_name(block, member);
        let mut seen: HashMap<&str, u32> = HashMap::new();
        members.clone().for_each(|member| *seen.entry(own(member)).or_default() += 1);
        for member in members.filter(|member| !can_be_written(own(*member)) || seen[own(*member)] > 1) {
            let offset = indexed.member_decoration(block, member, Decoration::Offset).flatten().and_then(number);
            names.push((block, Some(member), offset_name(offset.unwrap_or(0))));
        }
    }
    let renamed: HashSet<(u32, Option<u32>)> = names.iter().map(|(id, member, _)| (*id, *member)).collect();
    module.debug_names.retain(|it| match &it.operands[..] {
        [Operand::IdRef(id), Operand::LiteralString(_)] => !renamed.contains(&(*id, None)),
        [Operand::IdRef(id), Operand::LiteralBit32(member), _] => !renamed.contains(&(*id, Some(*member))),
        _ => true,
    });
    names.sort();
    module.debug_names.extend(names.into_iter().map(|(id, member, name)| {
        let (id, name) = (Operand::IdRef(id), Operand::LiteralString(name));
        match member {
            None => Instruction::new(Op::Name, None, None, vec![id, name]),
            Some(member) => Instruction::new(Op::MemberName, None, None, vec![id, Operand::LiteralBit32(member), name]),
        }
    }));
}

/// Whether a pipeline file can write a name.
fn can_be_written(name: &str) -> bool {
    let odd = |letter: char| letter.is_control() || matches!(letter, '"' | '\\');
    !name.is_empty() && name.len() <= LONGEST && !name.contains(odd) && element_of(name).is_none() && !is_place(name)
}
