//! Clip and cull distances: how many a stage has.

use super::module::IndexedModule;
use super::text::RefusedStage;
use framewright_graph::device::{Need, NeedKind};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{BuiltIn, Capability, Decoration, Op};

/// By Vulkan's "Required Limits", a device that has either has as many of both together (`maxCombinedClipAndCullDistances`).
const MOST: u64 = 8;

/// No more clip and cull distances than each device has that has any.
///
/// # Errors
/// In words, if a stage's input or output has more.
pub(super) fn check(module: &IndexedModule<'_>) -> Result<(), RefusedStage> {
    // Without the capability a block may declare them, but not use them.
    let kinds = [(Capability::ClipDistance, BuiltIn::ClipDistance), (Capability::CullDistance, BuiltIn::CullDistance)];
    let used = kinds.into_iter().filter(|(capability, _)| module.capabilities().any(|it| it == *capability));
    let count: u64 = used.map(|(_, built_in)| u64::from(longest(module, built_in))).sum();
    if count > MOST {
        let what = format!("{count} clip and cull distances: at most {MOST} are allowed");
        return Err(RefusedStage::beginning(&["gl_ClipDistance", "gl_CullDistance"], what));
    }
    Ok(())
}

/// Whether it is the need of a stage with clip or cull distances.
pub(super) fn is_need(need: &Need) -> bool {
    matches!(need.kind, NeedKind::Feature { name: "shaderClipDistance" | "shaderCullDistance", .. })
}

/// The length of the longest array that is this built-in, of a variable's own or a member's.
fn longest(module: &IndexedModule<'_>, wanted: BuiltIn) -> u32 {
    let length = |ty: Option<&Instruction>| {
        ty.filter(|it| it.class.opcode == Op::TypeArray).map_or(0, |it| module.array_length(it))
    };
    let lengths = module.module.annotations.iter().map(|it| match &it.operands[..] {
        [Operand::IdRef(of), Operand::Decoration(Decoration::BuiltIn), Operand::BuiltIn(it)] if *it == wanted => {
            length(module.global(*of).and_then(|it| module.pointee(it)))
        }
        [
            Operand::IdRef(of),
            Operand::LiteralBit32(member),
            Operand::Decoration(Decoration::BuiltIn),
            Operand::BuiltIn(it),
        ] if *it == wanted => {
            let member = module.global(*of).and_then(|it| it.operands.get(*member as usize)?.id_ref_any());
            length(member.and_then(|ty| module.global(ty)))
        }
        _ => 0,
    });
    lengths.max().unwrap_or(0)
}
