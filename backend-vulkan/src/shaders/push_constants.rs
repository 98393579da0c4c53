//! Push constants of other compilers' modules: those that a draw of the program brings, or else the block of parameters, as what a pass
//! gives comes in a uniform block.

use super::bindings::{block, pushed, tells_parts};
use super::module::{IndexedModule, id, storage_class};
use crate::base::ShaderStage;
use framewright_graph::shader::{BINDINGS, DrawInterface, Member, PARAMS, PASS_SET, PushConstants, offset_name};
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
        let parameters =
            |it: &Instruction| module.pointee(it).map_or_else(Vec::new, |ty| block(&module, ty).parameters());
        // What a uniform block of the shader has of the same name is what the pass gives.
        let others = module.variables().filter(|(variable, it)| is_block_of_pass(&module, *variable, it));
        let taken: Vec<Member> = others.flat_map(|(_, it)| parameters(it)).collect();
        let has = |it: &Member, name: &str| name == it.name || name == offset_name(it.offset);
        let is_given =
            |it: &Member| self.params.iter().any(|name| has(it, name) && !taken.iter().any(|other| has(other, name)));
        let pushed_here = module.variables().filter(|(variable, _)| variables.contains(variable));
        if pushed_here.flat_map(|(_, it)| parameters(it)).any(|it| is_given(&it)) {
            return Some(Vec::new());
        }
        let draw = DrawInterface { push_constants: self.draw.clone(), ..DrawInterface::default() };
        let blocks = pushed(&module, stage, &variables.iter().copied().collect());
        let misfits: Vec<String> = blocks.iter().filter_map(|block| draw.pushed_misfit(block)).collect();
        (!misfits.is_empty()).then_some(misfits)
    }
}

/// Whether a variable is a uniform block in the set of the pass.
fn is_block_of_pass(module: &IndexedModule<'_>, variable: u32, it: &Instruction) -> bool {
    let of_pass = module.decoration_number(variable, Decoration::DescriptorSet) == Some(PASS_SET);
    let is_uniform = storage_class(it) == Some(StorageClass::Uniform);
    let is_block = |ty: &Instruction| ty.class.opcode == Op::TypeStruct && !module.is_storage_block(it, ty);
    of_pass && is_uniform && module.pointee(it).is_some_and(is_block)
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

#[cfg(test)]
mod tests {
    use super::*;
    use rspirv::dr::Builder;

    /// A module with push constants that have the member `strength`, as has a uniform block of the pass if there is one; and their variable.
    fn module(has_block: bool) -> (Module, u32) {
        let mut builder = Builder::new();
        let float = builder.type_float(32, None);
        let structure = builder.type_struct_id(None, [float]);
        builder.member_name(structure, 0, "strength");
        builder.member_decorate(structure, 0, Decoration::Offset, [Operand::LiteralBit32(0)]);
        let mut variable = |class| {
            let pointer = builder.type_pointer(None, class, structure);
            builder.variable(pointer, None, class, None)
        };
        let pushed = variable(StorageClass::PushConstant);
        let of_pass = has_block.then(|| variable(StorageClass::Uniform));
        if let Some(of_pass) = of_pass {
            builder.decorate(of_pass, Decoration::DescriptorSet, [Operand::LiteralBit32(PASS_SET)]);
        }
        (builder.module(), pushed)
    }

    #[test]
    fn a_parameter_that_a_uniform_block_takes_leaves_push_constants_to_the_draw() {
        let by = PushedBy { draw: vec![PushConstants::new(0, 4)], params: vec!["strength".into()] };
        for (has_block, misfits) in [(false, Some(Vec::new())), (true, None)] {
            let (module, pushed) = module(has_block);
            assert_eq!(by.misfits(&module, ShaderStage::Fragment, &[pushed]), misfits, "{has_block}");
        }
    }
}
