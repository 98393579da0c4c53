//! HLSL numbers textures, samplers, constants, and what is written, each from 0 on. In SPIR-V these numbers may meet: here each
//! kind gets numbers of its own.

use super::module::{IndexedModule, id, number, storage_class};
use framewright_graph::shader::{BINDINGS, PASS_SET};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op};
use std::collections::HashMap;

/// A kind of register, which numbers its resources from 0 on. Its number tells it from others.
#[derive(Clone, Copy)]
enum Register {
    Texture,
    Sampler,
    Constants,
    /// A `StructuredBuffer`, which has the numbers of textures in HLSL.
    ReadBuffer,
    /// What has the numbers of `u`: a buffer.
    Buffer,
    /// What has the numbers of `u`: an image.
    Image,
}

/// At least how many kinds there are.
const KINDS: u32 = 8;

/// Puts the resources of a pass's own set at bindings that no other kind has: a pass gives them by name. Other sets stay, as the
/// program that draws knows them by number. High numbers were chosen by somebody who knows that they are all of one kind: then all
/// stay.
pub(super) fn spread(module: &mut Module) {
    let kinds = kinds(module);
    let places = || module.annotations.iter().filter_map(|it| Some((*kinds.get(&id(it, 0)?)?, place(it)?)));
    if places().any(|(_, binding)| binding >= BINDINGS / KINDS) {
        return;
    }
    for it in &mut module.annotations {
        let moved = id(it, 0).and_then(|variable| kinds.get(&variable)).zip(place(it));
        if let (Some((kind, binding)), Some(operand)) = (moved, it.operands.get_mut(2)) {
            *operand = Operand::LiteralBit32(binding * KINDS + *kind as u32);
        }
    }
}

/// The binding that an annotation gives.
fn place(it: &Instruction) -> Option<u32> {
    match it.operands[..] {
        [_, Operand::Decoration(Decoration::Binding), Operand::LiteralBit32(binding)] => Some(binding),
        _ => None,
    }
}

/// The kinds of the variables of a pass's own set.
fn kinds(module: &Module) -> HashMap<u32, Register> {
    let indexed = IndexedModule::new(module);
    let of_pass = |id: u32| indexed.decoration_number(id, Decoration::DescriptorSet) == Some(PASS_SET);
    let of_pass = indexed.variables().filter(|(id, _)| of_pass(*id));
    of_pass.filter_map(|(id, it)| Some((id, register(&indexed, id, it)?))).collect()
}

fn register(module: &IndexedModule<'_>, variable: u32, it: &Instruction) -> Option<Register> {
    let mut ty = module.pointee(it)?;
    // Types are declared before what is made of them: this ends.
    while matches!(ty.class.opcode, Op::TypeArray | Op::TypeRuntimeArray) {
        ty = module.global(id(ty, 0)?)?;
    }
    let is_only_read = |structure: u32| {
        let members = u32::try_from(ty.operands.len()).unwrap_or(0);
        module.decoration(variable, Decoration::NonWritable).is_some()
            || (0..members).all(|at| module.member_decoration(structure, at, Decoration::NonWritable).is_some())
    };
    match ty.class.opcode {
        Op::TypeSampler => Some(Register::Sampler),
        Op::TypeSampledImage => Some(Register::Texture),
        Op::TypeImage if ty.operands.get(5).and_then(number) == Some(2) => Some(Register::Image),
        Op::TypeImage => Some(Register::Texture),
        Op::TypeStruct if !module.is_storage_block(it, ty) => storage_class(it).map(|_| Register::Constants),
        Op::TypeStruct if ty.result_id.is_some_and(is_only_read) => Some(Register::ReadBuffer),
        Op::TypeStruct => Some(Register::Buffer),
        _ => None,
    }
}
