//! Push constants of other compilers' modules become the block of parameters: what a pass gives comes in a uniform block.

use super::bindings::tells_parts;
use super::module::id;
use framewright_graph::shader::{BINDINGS, PARAMS, PASS_SET};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass};

/// The binding of that block: the last one, which hardly any shader has.
const BINDING: u32 = BINDINGS - 1;

/// Makes a uniform block of the push constants, `params` unless something else has that name.
pub(super) fn as_params(module: &mut Module) {
    let is_pushed = |it: &Instruction| it.operands.first() == Some(&Operand::StorageClass(StorageClass::PushConstant));
    let variables = module.types_global_values.iter().filter(|it| it.class.opcode == Op::Variable && is_pushed(it));
    let variables: Vec<u32> = variables.filter_map(|it| it.result_id).collect();
    let told = module.debug_names.iter().any(|it| {
        let of_these = it.class.opcode == Op::Name && id(it, 0).is_some_and(|id| variables.contains(&id));
        of_these && matches!(it.operands.get(1), Some(Operand::LiteralString(name)) if tells_parts(name))
    });
    if variables.is_empty() || told {
        return;
    }
    for it in &mut module.types_global_values {
        let class = match it.class.opcode {
            Op::TypePointer | Op::Variable => it.operands.get_mut(0),
            _ => None,
        };
        if let Some(class) = class.filter(|class| **class == Operand::StorageClass(StorageClass::PushConstant)) {
            *class = Operand::StorageClass(StorageClass::Uniform);
        }
    }
    let params = Operand::LiteralString(PARAMS.to_owned());
    let named = module.debug_names.iter().any(|it| it.class.opcode == Op::Name && it.operands.get(1) == Some(&params));
    for variable in variables {
        for (decoration, value) in [(Decoration::DescriptorSet, PASS_SET), (Decoration::Binding, BINDING)] {
            let operands =
                vec![Operand::IdRef(variable), Operand::Decoration(decoration), Operand::LiteralBit32(value)];
            module.annotations.push(Instruction::new(Op::Decorate, None, None, operands));
        }
        if !named {
            module.debug_names.retain(|it| it.class.opcode != Op::Name || id(it, 0) != Some(variable));
            let operands = vec![Operand::IdRef(variable), params.clone()];
            module.debug_names.push(Instruction::new(Op::Name, None, None, operands));
        }
    }
}
