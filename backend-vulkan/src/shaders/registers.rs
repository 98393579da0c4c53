//! HLSL numbers textures, samplers, buffers and what is written each from 0 on. In SPIR-V these numbers may meet: here each
//! kind gets numbers of its own.

use super::module::{IndexedModule, id};
use framewright_graph::shader::PASS_SET;
use rspirv::dr::{Module, Operand};
use rspirv::spirv::{Decoration, Op, StorageClass};
use std::collections::HashMap;

/// How many kinds there are.
const KINDS: u32 = 8;

/// Puts the resources of a pass's own set at bindings that no other kind has: a pass gives them by name. Other sets stay, as the
/// program that draws knows them by number.
pub(super) fn spread(module: &mut Module) {
    let moved: HashMap<u32, u32> = {
        let indexed = IndexedModule::new(module);
        let variables = module.types_global_values.iter().filter(|it| it.class.opcode == Op::Variable);
        let in_set = variables.filter_map(|it| {
            let variable = it.result_id?;
            let set = indexed.decorated(variable, Decoration::DescriptorSet).unwrap_or(0);
            (set == PASS_SET).then(|| Some((variable, kind(&indexed, variable, it.result_type?)?)))?
        });
        in_set.collect()
    };
    for it in &mut module.annotations {
        let kind = id(it, 0).and_then(|variable| moved.get(&variable));
        if let (Some(kind), [_, Operand::Decoration(Decoration::Binding), Operand::LiteralBit32(binding)]) =
            (kind, &mut it.operands[..])
        {
            *binding = binding.saturating_mul(KINDS).saturating_add(*kind);
        }
    }
}
