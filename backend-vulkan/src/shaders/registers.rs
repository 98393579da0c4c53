//! HLSL numbers textures, samplers, constants, and what is written, each from 0 on. In SPIR-V these numbers may meet: here each
//! kind gets numbers of its own. And compilers number what each stage uses, and know nothing of the other: here they are put together.

use super::module::{IndexedModule, id, number, storage_class};
use super::stages::CompiledStage;
use framewright_graph::shader::{BINDINGS, Binding, PASS_SET};
use rspirv::binary::Assemble;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op};
use std::collections::{BTreeMap, HashMap, HashSet};

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

/// A fragment stage beside whose resources those of its vertex stage lie: a pass gives them by name, so what has one name lies at one
/// binding, and what has two doesn't share one. `None`: they lie so.
///
/// # Errors
/// In words: the stage is no SPIR-V.
pub(super) fn beside(vertex: &CompiledStage, fragment: &CompiledStage) -> Result<Option<CompiledStage>, String> {
    let places = places_beside(&vertex.reflected.interface.bindings, &fragment.reflected.interface.bindings);
    if places.iter().all(|(from, to)| from == to) {
        return Ok(None);
    }
    let mut module = rspirv::dr::load_words(&fragment.spirv).map_err(|error| error.to_string())?;
    let kinds = kinds(&module);
    for it in &mut module.annotations {
        let moved = id(it, 0).filter(|variable| kinds.contains_key(variable)).and_then(|_| place(it));
        if let (Some(to), Some(operand)) = (moved.and_then(|from| places.get(&from)), it.operands.get_mut(2)) {
            *operand = Operand::LiteralBit32(*to);
        }
    }
    let (file, spirv) = (fragment.file.clone(), module.assemble().into());
    let mut moved = CompiledStage { file, shipped: fragment.shipped, spirv, reflected: fragment.reflected.clone() };
    for binding in moved.reflected.interface.bindings.iter_mut().filter(|it| it.set == PASS_SET) {
        binding.binding = places.get(&binding.binding).copied().unwrap_or(binding.binding);
    }
    moved.reflected.interface.bindings.sort_by_key(|it| (it.set, it.binding));
    Ok(Some(moved))
}

/// Where each binding of a fragment stage goes.
fn places_beside(vertex: &[Binding], fragment: &[Binding]) -> BTreeMap<u32, u32> {
    let of_pass = |all: &[Binding]| all.iter().filter(|it| it.set == PASS_SET).cloned().collect::<Vec<_>>();
    let (vertex, fragment) = (of_pass(vertex), of_pass(fragment));
    let mut taken: HashSet<u32> = vertex.iter().chain(&fragment).map(|it| it.binding).collect();
    let mut places = BTreeMap::new();
    for it in &fragment {
        let to = match vertex.iter().find(|other| other.name == it.name) {
            Some(same) => Some(same.binding),
            None if vertex.iter().any(|other| other.binding == it.binding) => {
                (0..BINDINGS).find(|free| taken.insert(*free))
            }
            None => None,
        };
        places.insert(it.binding, to.unwrap_or(it.binding));
    }
    places
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
