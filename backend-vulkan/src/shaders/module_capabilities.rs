//! The capabilities of one entry point: a module declares those of all of its entry points.

use super::module::number;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Capability, Op};
use std::collections::HashSet;

/// Capabilities that an instruction, an operand or a type of numbers asks for, so that it can be told whether one is needed.
const TOLD_BY_CODE: [Capability; 27] = [
    Capability::Float16,
    Capability::Float64,
    Capability::Int8,
    Capability::Int16,
    Capability::Int64,
    Capability::GroupNonUniform,
    Capability::GroupNonUniformVote,
    Capability::GroupNonUniformArithmetic,
    Capability::GroupNonUniformBallot,
    Capability::GroupNonUniformShuffle,
    Capability::GroupNonUniformShuffleRelative,
    Capability::GroupNonUniformClustered,
    Capability::GroupNonUniformQuad,
    Capability::ClipDistance,
    Capability::CullDistance,
    Capability::DrawParameters,
    Capability::MultiView,
    Capability::Geometry,
    Capability::Tessellation,
    Capability::ShaderLayer,
    Capability::ShaderViewportIndex,
    Capability::ShaderViewportIndexLayerEXT,
    Capability::FragmentBarycentricKHR,
    Capability::ImageGatherExtended,
    Capability::InterpolationFunction,
    Capability::RayQueryKHR,
    Capability::MeshShadingEXT,
];

/// Leaves out capabilities that only other entry points need.
pub(super) fn leave_out_foreign(module: &mut Module) {
    let declared: HashSet<Capability> = module.capabilities.iter().filter_map(declared).collect();
    let code = module.types_global_values.iter().chain(&module.annotations).chain(&module.execution_modes);
    let code = code.chain(&module.entry_points).chain(module.functions.iter().flat_map(|it| it.all_inst_iter()));
    let mut needed = HashSet::new();
    for choice in code.flat_map(choices).filter(|choice| !choice.is_empty()) {
        // What another capability implies: which one that is isn't looked for.
        let implied = |it: &Capability| matches!(it, Capability::Shader | Capability::Matrix);
        if !choice.iter().any(|it| declared.contains(it) || implied(it)) {
            return;
        }
        needed.extend(choice);
    }
    module
        .capabilities
        .retain(|it| self::declared(it).is_none_or(|it| !TOLD_BY_CODE.contains(&it) || needed.contains(&it)));
}

fn declared(it: &Instruction) -> Option<Capability> {
    match it.operands.first() {
        Some(Operand::Capability(capability)) => Some(*capability),
        _ => None,
    }
}

/// What an instruction asks for: one of each choice.
fn choices(it: &Instruction) -> Vec<Vec<Capability>> {
    let width = it.operands.first().and_then(number);
    let of_type = match (it.class.opcode, width) {
        (Op::TypeFloat, Some(16)) => vec![Capability::Float16],
        (Op::TypeFloat, Some(64)) => vec![Capability::Float64],
        (Op::TypeInt, Some(8)) => vec![Capability::Int8],
        (Op::TypeInt, Some(16)) => vec![Capability::Int16],
        (Op::TypeInt, Some(64)) => vec![Capability::Int64],
        _ => Vec::new(),
    };
    let of_operands = it.operands.iter().map(Operand::required_capabilities);
    of_operands.chain([it.class.capabilities.to_vec(), of_type]).collect()
}
