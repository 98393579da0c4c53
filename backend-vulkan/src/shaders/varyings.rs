//! Values at locations: vertex attributes, what a vertex stage hands over, and what a fragment stage takes.

use super::module::{IndexedModule, id, number, storage_class};
use super::text::RefusedStage;
use framewright_graph::shader::{VertexInput, VertexLayout};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op, StorageClass};
use std::collections::HashSet;

/// A value at a location: a variable, or a member of a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Varying {
    pub(super) location: u32,
    /// The first of the location's components that it takes.
    pub(super) component: u32,
    pub(super) name: String,
    pub(super) ty: String,
    /// Whether code mentions the variable.
    pub(super) used: bool,
}

/// All values of one storage class that have a location, in order.
pub(super) fn varyings(module: &IndexedModule<'_>, class: StorageClass, used: &HashSet<u32>) -> Vec<Varying> {
    let variables = module.variables().filter(|(_, it)| storage_class(it) == Some(class));
    let mut varyings: Vec<Varying> =
        variables.flat_map(|(id, it)| of_variable(module, id, it, used.contains(&id)).unwrap_or_default()).collect();
    varyings.sort_by_key(|it| (it.location, it.component));
    varyings
}

/// The values of a variable; `None`: it has no location.
fn of_variable(module: &IndexedModule<'_>, id: u32, it: &Instruction, used: bool) -> Option<Vec<Varying>> {
    let pointee = module.pointee(it)?;
    let ty = pointee.result_id?;
    let own = |decoration| module.decoration_number(id, decoration);
    if pointee.class.opcode != Op::TypeStruct || module.decoration(ty, Decoration::Block).is_none() {
        let (location, component) = (own(Decoration::Location)?, own(Decoration::Component).unwrap_or(0));
        let (name, ty) = (module.name(id).to_owned(), module.type_name(ty));
        return Some(vec![Varying { location, component, name, ty, used }]);
    }
    // Members without a location of their own follow the one before.
    let mut next = own(Decoration::Location);
    let mut members = Vec::new();
    for (member, of) in (0_u32..).zip(pointee.operands.iter().filter_map(Operand::id_ref_any)) {
        let said = |decoration| module.member_decoration(ty, member, decoration).flatten().and_then(number);
        let Some(location) = said(Decoration::Location).or(next) else { continue };
        next = Some(location.saturating_add(module.locations(of)));
        let (component, name) = (said(Decoration::Component).unwrap_or(0), module.member_name(ty, member).to_owned());
        members.push(Varying { location, component, name, ty: module.type_name(of), used });
    }
    Some(members)
}

/// Whether a vertex stage mentions the size of its points.
pub(super) fn writes_point_size(module: &IndexedModule<'_>, used: &HashSet<u32>) -> bool {
    let is_size = |it: Option<Option<&Operand>>| matches!(it, Some(Some(Operand::BuiltIn(BuiltIn::PointSize))));
    let outputs = || module.variables().filter(|(_, it)| storage_class(it) == Some(StorageClass::Output));
    if outputs().any(|(output, _)| used.contains(&output) && is_size(module.decoration(output, Decoration::BuiltIn))) {
        return true;
    }
    // GLSL has it as a member of a block.
    let member = |output: u32, member: u32| {
        let block = module.pointee(outputs().find(|(id, _)| *id == output)?.1)?.result_id?;
        Some(is_size(module.member_decoration(block, member, Decoration::BuiltIn)))
    };
    module.code().filter(|it| matches!(it.class.opcode, Op::AccessChain | Op::InBoundsAccessChain)).any(|it| {
        let index = id(it, 1).and_then(|index| module.constant(index));
        id(it, 0).zip(index).and_then(|(base, index)| member(base, index)).unwrap_or(false)
    })
}

/// The vertex attributes that a vertex stage declares: each has its place in a vertex, and Vulkan wants to know of each.
///
/// # Errors
/// In words: an attribute that no buffer can hold.
pub(super) fn vertex_inputs(declared: &[Varying]) -> Result<Vec<VertexInput>, RefusedStage> {
    let input = |it: &Varying| {
        let Varying { location, component, name, ty, used } = it.clone();
        VertexInput { location, component, name, ty, used }
    };
    let inputs: Vec<VertexInput> = declared.iter().map(input).collect();
    match VertexLayout::of(&inputs, 1) {
        Ok(_) => Ok(inputs),
        Err(fault) => Err(RefusedStage::named(&fault.name, fault.message)),
    }
}

/// The SPIR-V of a stage whose entry point doesn't name inputs that its code never mentions: Vulkan wants the stage before to
/// hand over every one that is named.
pub(super) fn without_idle_inputs(spirv: Vec<u32>) -> Vec<u32> {
    let Ok(mut module) = rspirv::dr::load_words(&spirv) else { return spirv };
    let indexed = IndexedModule::new(&module);
    let mentioned: HashSet<u32> = indexed.code().flat_map(|it| &it.operands).filter_map(Operand::id_ref_any).collect();
    let inputs = indexed.variables().filter(|(_, it)| storage_class(it) == Some(StorageClass::Input));
    let idle: HashSet<u32> = inputs.map(|(id, _)| id).filter(|id| !mentioned.contains(id)).collect();
    if idle.is_empty() {
        return spirv;
    }
    for entry in &mut module.entry_points {
        entry.operands.retain(|operand| operand.id_ref_any().is_none_or(|id| !idle.contains(&id)));
    }
    rspirv::binary::Assemble::assemble(&module)
}
