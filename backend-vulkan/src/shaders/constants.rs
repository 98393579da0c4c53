//! Specialization constants: their values are put in place of their defaults, so that all that is read off a module follows them.

use super::module::IndexedModule;
use framewright_graph::frame::ParamValue;
use framewright_graph::shader::{ConstantValue, ParamType, ShaderConstant, constant_name};
use rspirv::binary::Assemble;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op};
use std::collections::HashMap;
use std::sync::Arc;

/// The values that a pass gives, by its names.
pub(super) type Constants = [(Arc<str>, ConstantValue)];

/// The constants of a module, but for those of `include/rotation.glsl`.
pub(super) fn of(module: &IndexedModule<'_>) -> Vec<ShaderConstant> {
    let all = module.module.types_global_values.iter().filter(|it| is_constant(it));
    let all = all.filter_map(|it| {
        let (id, ty) = (it.result_id?, it.result_type?);
        let number = module.decoration_number(id, Decoration::SpecId)?;
        let name = match module.name(id) {
            "" => constant_name(number),
            name => name.to_owned(),
        };
        Some(ShaderConstant { name, number, ty: module.type_name(ty) })
    });
    all.filter(|constant| !constant.name.starts_with("framewright_")).collect()
}

/// Puts values into SPIR-V.
///
/// # Errors
/// In words: it is none.
pub(super) fn with_values(spirv: Vec<u32>, values: &Constants) -> Result<Vec<u32>, String> {
    if values.is_empty() {
        return Ok(spirv);
    }
    let mut module = rspirv::dr::load_words(&spirv).map_err(|error| error.to_string())?;
    put(&mut module, values);
    Ok(module.assemble())
}

/// Puts values into a module. What it hasn't, and what has another type, is told elsewhere.
pub(super) fn put(module: &mut Module, values: &Constants) {
    if values.is_empty() {
        return;
    }
    let given: HashMap<u32, ConstantValue> = {
        let indexed = IndexedModule::new(module);
        let constants = module.types_global_values.iter().filter(|it| is_constant(it)).filter_map(|it| {
            let id = it.result_id?;
            let number = indexed.decoration_number(id, Decoration::SpecId)?;
            let called = |name: &str| name == indexed.name(id) || name == constant_name(number);
            let (_, value) = values.iter().find(|(name, _)| called(name))?;
            let ty = ParamType::of(&indexed.type_name(it.result_type?))?;
            Some((id, ConstantValue::of(&ty.take(&value.value()).ok()?)?))
        });
        constants.collect()
    };
    for it in &mut module.types_global_values {
        let value = it.result_id.and_then(|id| given.get(&id)).map(|value| value.value());
        match value {
            None | Some(ParamValue::List(_) | ParamValue::OfFrame(_)) => {}
            Some(ParamValue::Bool(value)) if it.class.opcode == Op::SpecConstant => {
                it.operands = vec![Operand::LiteralBit32(value.into())];
            }
            Some(ParamValue::Bool(value)) => {
                let op = if value { Op::SpecConstantTrue } else { Op::SpecConstantFalse };
                *it = Instruction::new(op, it.result_type, it.result_id, Vec::new());
            }
            // The type has taken the value: it fits.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the bits of an int or a uint")]
            Some(ParamValue::Integer(value)) => it.operands = vec![Operand::LiteralBit32(value as u32)],
            #[allow(clippy::cast_possible_truncation, reason = "the number that a float holds")]
            Some(ParamValue::Number(value)) => it.operands = vec![Operand::LiteralBit32((value as f32).to_bits())],
        }
    }
}

/// The value of a constant of 32 bits.
pub(super) fn value_of(module: &Module, constant: u32) -> Option<u32> {
    let it = module.types_global_values.iter().find(|it| it.result_id == Some(constant))?;
    match (it.class.opcode, it.operands.first()) {
        (Op::Constant | Op::SpecConstant, Some(Operand::LiteralBit32(value))) => Some(*value),
        _ => None,
    }
}

/// Whether an instruction may be a constant that has a value of its own.
fn is_constant(it: &Instruction) -> bool {
    matches!(it.class.opcode, Op::SpecConstant | Op::SpecConstantTrue | Op::SpecConstantFalse)
}
