//! What every reader of a module relies on. The GLSL compiler keeps these rules; modules of others are checked.

use super::module::id;
use rspirv::dr::{Function, Instruction, Module, Operand};
use rspirv::spirv::Op;
use std::collections::{HashMap, HashSet};

/// Types may be made of others this deep. SPIR-V allows structs 255 deep ("Universal Limits"), and no compiler makes such.
const DEEPEST: u32 = 64;

/// Checks that ids are unique and within the bound, that types, constants and variables follow those that they are made of, and that
/// functions are whole and don't call themselves.
///
/// # Errors
/// In words: the first rule that is broken.
pub(super) fn check(module: &Module) -> Result<(), String> {
    let bound = module.header.as_ref().map_or(0, |header| header.bound);
    let mut seen = HashSet::new();
    for result in module.all_inst_iter().filter_map(|it| it.result_id) {
        if result == 0 || result >= bound {
            return Err(format!("it has the id {result}, and says that all are below {bound}"));
        }
        if !seen.insert(result) {
            return Err(format!("it has the id {result} twice"));
        }
    }
    check_order(module)?;
    let functions: HashMap<u32, &Function> = module.functions.iter().filter_map(|it| Some((of(it)?, it))).collect();
    if functions.len() != module.functions.len() {
        return Err("it has a function without a name".to_owned());
    }
    check_calls(&functions)
}

/// Types, constants and variables follow those that they are made of, and aren't made of each other very deep.
fn check_order(module: &Module) -> Result<(), String> {
    let mut depths: HashMap<u32, u32> = HashMap::new();
    let mut forward = HashSet::new();
    for it in &module.types_global_values {
        let Some(result) = it.result_id else {
            if it.class.opcode == Op::TypeForwardPointer {
                forward.extend(id(it, 0));
            }
            continue;
        };
        let mut depth = 0;
        for part in parts(it) {
            match depths.get(&part) {
                Some(deep) => depth = depth.max(deep + 1),
                None if forward.contains(&part) => {}
                None => return Err(format!("its id {result} is made of {part}, which doesn't stand before it")),
            }
        }
        if depth > DEEPEST {
            return Err(format!("its types are made of each other more than {DEEPEST} deep"));
        }
        // A pointer is as shallow as a number: nothing follows it.
        let shallow = matches!(it.class.opcode, Op::TypePointer | Op::Variable | Op::TypeFunction);
        depths.insert(result, if shallow { 0 } else { depth });
    }
    Ok(())
}

fn parts(it: &Instruction) -> impl Iterator<Item = u32> {
    it.operands.iter().filter_map(Operand::id_ref_any).chain(it.result_type)
}

/// The id of a function.
pub(super) fn of(function: &Function) -> Option<u32> {
    function.def.as_ref()?.result_id
}

/// The functions that a function calls.
pub(super) fn callees(function: &Function) -> impl Iterator<Item = u32> {
    let code = function.blocks.iter().flat_map(|it| &it.instructions);
    code.filter(|it| it.class.opcode == Op::FunctionCall).filter_map(|it| id(it, 0))
}

/// Every function that is called is there, and none calls itself, directly or not.
fn check_calls(functions: &HashMap<u32, &Function>) -> Result<(), String> {
    // Functions whose callees were all looked at, and those that lead to the one that is looked at.
    let (mut done, mut open) = (HashSet::new(), HashSet::new());
    for first in functions.keys() {
        if done.contains(first) {
            continue;
        }
        let mut path = vec![(*first, callees(functions[first]).collect::<Vec<_>>())];
        open.insert(*first);
        while let Some((number, left)) = path.last_mut() {
            let Some(next) = left.pop() else {
                open.remove(number);
                done.insert(*number);
                path.pop();
                continue;
            };
            if open.contains(&next) {
                return Err(format!("its function {next} calls itself"));
            }
            if done.contains(&next) {
                continue;
            }
            let Some(function) = functions.get(&next) else {
                return Err(format!("it calls the function {next}, which isn't there"));
            };
            open.insert(next);
            path.push((next, callees(function).collect()));
        }
    }
    Ok(())
}
