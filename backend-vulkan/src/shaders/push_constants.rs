//! Push constants of other compilers' modules: those that a draw of the program brings, or else the block of parameters, as what a pass
//! gives comes in a uniform block.

use super::bindings::{block, pushed, tells_parts};
use super::module::{IndexedModule, id};
use crate::base::ShaderStage;
use framewright_graph::shader::{BINDINGS, DrawInterface, PARAMS, PASS_SET, PushConstants, offset_name};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass};
use std::sync::Arc;

/// The binding of that block: the last one, which hardly any shader has.
const BINDING: u32 = BINDINGS - 1;

/// What decides whose the push constants of a module are.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub(super) struct PushedBy {
    /// Those that the draw brings.
    pub(super) draw: Vec<PushConstants>,
    /// The names of parameters that the pass gives.
    pub(super) params: Vec<Arc<str>>,
}

impl PushedBy {
    /// Why these variables of a module aren't the draw's, in words, without any where the pass gives one of their members; `None`:
    /// they are.
    fn misfits(&self, module: &Module, stage: ShaderStage, variables: &[u32]) -> Option<Vec<String>> {
        if self.draw.is_empty() {
            return Some(Vec::new());
        }
        let module = IndexedModule::new(module);
        let types =
            module.variables().filter(|(id, _)| variables.contains(id)).filter_map(|(_, it)| module.pointee(it));
        let mut members = types.flat_map(|ty| block(&module, ty).parameters());
        if members.any(|it| self.params.iter().any(|name| **name == it.name || **name == *offset_name(it.offset))) {
            return Some(Vec::new());
        }
        let draw = DrawInterface { push_constants: self.draw.clone(), ..DrawInterface::default() };
        let blocks = pushed(&module, stage, &variables.iter().copied().collect());
        let misfits: Vec<String> = blocks.iter().filter_map(|block| draw.pushed_misfit(block)).collect();
        (!misfits.is_empty()).then_some(misfits)
    }
}

/// Makes a uniform block of push constants that aren't the draw's, `params` unless something else has that name. Returns why those that
/// a draw brings don't fit.
pub(super) fn as_params(module: &mut Module, stage: ShaderStage, by: &PushedBy) -> Vec<String> {
    let is_pushed = |it: &Instruction| it.operands.first() == Some(&Operand::StorageClass(StorageClass::PushConstant));
    let variables = module.types_global_values.iter().filter(|it| it.class.opcode == Op::Variable && is_pushed(it));
    let variables: Vec<u32> = variables.filter_map(|it| it.result_id).collect();
    let told = module.debug_names.iter().any(|it| {
        let of_these = it.class.opcode == Op::Name && id(it, 0).is_some_and(|id| variables.contains(&id));
        of_these && matches!(it.operands.get(1), Some(Operand::LiteralString(name)) if tells_parts(name))
    });
    if variables.is_empty() || told {
        return Vec::new();
    }
    let Some(misfits) = by.misfits(module, stage, &variables) else { return Vec::new() };
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
    misfits
}
