//! What a shader stage reads of sets that the program binds itself, read off its SPIR-V.

use super::bindings::{may_not_store, name_of, storage_access, too_far};
use super::module::{IndexedModule, id, number, storage_class};
use super::text::RefusedStage;
use crate::base::ShaderStage;
use framewright_graph::shader::{BINDINGS, DescriptorType, ProgramResource, binding_name};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Decoration, Dim, Op, StorageClass};
use std::collections::HashSet;

/// The resources in the sets of these numbers that the stage uses. Several may share a place, as tables of images of different shapes do.
pub(super) fn program_resources(
    module: &IndexedModule<'_>,
    stage: ShaderStage,
    used: &HashSet<u32>,
    sets: &[u32],
) -> Result<Vec<ProgramResource>, RefusedStage> {
    let stage = stage.facts();
    let mut resources = Vec::new();
    for (variable, instruction) in module.variables().filter(|(variable, _)| used.contains(variable)) {
        let set = module.decoration_number(variable, Decoration::DescriptorSet);
        let binding = module.decoration_number(variable, Decoration::Binding);
        let (Some(set), Some(binding)) = (set.filter(|set| sets.contains(set)), binding) else { continue };
        let Some(ty) = module.pointee(instruction) else { continue };
        let own = name_of(module, variable, instruction);
        let name = if own.is_empty() { binding_name(set, binding) } else { own.to_owned() };
        if binding >= BINDINGS {
            return Err(too_far(&name, binding));
        }
        let (element, count) = elements(module, ty);
        let kind = element.and_then(|element| kind(module, instruction, element));
        let block = element.filter(|it| it.class.opcode == Op::TypeStruct);
        let writable = kind.is_some_and(is_stored) && storage_access(module, variable, block).1;
        if writable && !stage.may_store {
            return Err(may_not_store(&name, stage.name));
        }
        let stages = stage.pipeline;
        resources.push(ProgramResource { set, binding, name, kind, count, writable, stages, place: None });
    }
    resources.sort_by(|a, b| (a.set, a.binding, &a.name).cmp(&(b.set, b.binding, &b.name)));
    Ok(resources)
}

/// The type of the elements of an array, however many dimensions it has, and how many they are; `None`: nothing tells how many.
fn elements<'m>(module: &IndexedModule<'m>, ty: &'m Instruction) -> (Option<&'m Instruction>, Option<u32>) {
    let (mut ty, mut count) = (ty, Some(1_u32));
    loop {
        let length = match ty.class.opcode {
            Op::TypeArray => Some(module.array_length(ty)).filter(|length| *length > 0),
            Op::TypeRuntimeArray => None,
            _ => return (Some(ty), count),
        };
        count = count.zip(length).map(|(count, length)| count.saturating_mul(length));
        let Some(element) = id(ty, 0).and_then(|element| module.global(element)) else { return (None, count) };
        ty = element;
    }
}

/// The type of descriptors that such a variable reads; `None`: it is none of these.
fn kind(module: &IndexedModule<'_>, variable: &Instruction, ty: &Instruction) -> Option<DescriptorType> {
    use DescriptorType as Is;
    let dimension = |image: &Instruction| match image.operands.get(1) {
        Some(Operand::Dim(dimension)) => Some(*dimension),
        _ => None,
    };
    match ty.class.opcode {
        Op::TypeSampler => Some(Is::Sampler),
        Op::TypeSampledImage => match dimension(module.global(id(ty, 0)?)?)? {
            Dim::DimBuffer => Some(Is::UniformTexelBuffer),
            _ => Some(Is::CombinedImageSampler),
        },
        Op::TypeImage => match (dimension(ty)?, ty.operands.get(5).and_then(number) == Some(2)) {
            (Dim::DimSubpassData, _) => None,
            (Dim::DimBuffer, true) => Some(Is::StorageTexelBuffer),
            (Dim::DimBuffer, false) => Some(Is::UniformTexelBuffer),
            (_, true) => Some(Is::StorageImage),
            (_, false) => Some(Is::SampledImage),
        },
        Op::TypeAccelerationStructureKHR => Some(Is::AccelerationStructure),
        Op::TypeStruct if module.is_storage_block(variable, ty) => Some(Is::StorageBuffer),
        Op::TypeStruct if storage_class(variable) == Some(StorageClass::Uniform) => Some(Is::UniformBuffer),
        _ => None,
    }
}

/// Whether shaders may store into it.
fn is_stored(kind: DescriptorType) -> bool {
    use DescriptorType as Is;
    matches!(kind, Is::StorageImage | Is::StorageTexelBuffer | Is::StorageBuffer)
}
