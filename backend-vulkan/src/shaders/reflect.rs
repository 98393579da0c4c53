//! Reflection of one shader stage: the interface that its SPIR-V tells.

use super::bindings::{bindings, component_of, pushed};
use super::capabilities::check_capabilities;
use super::constants;
use super::extensions::check_extensions;
use super::eyes::{HANDED_ON, LOCATION};
use super::module::{IndexedModule, id, number, storage_class};
use super::needs::{Needed, needs};
use super::program_resources::program_resources;
use super::program_supply::ProgramSupply;
use super::rotation;
use super::text::RefusedStage;
use super::varyings::{Varying, varyings, vertex_inputs, writes_point_size};
use super::{addresses, coverage, distances};
use crate::base::{ShaderStage, StageFacts};
use framewright_graph::shader::{FragmentOutput, PARAMS, PASS_SET, ShaderInterface};
use rspirv::dr::Operand;
use rspirv::spirv::{BuiltIn, Decoration, ExecutionMode, Op, StorageClass};
use std::collections::HashSet;

/// The interface of a stage: its bindings and constants, its inputs and its outputs.
#[derive(Debug, Clone)]
pub(super) struct StageInterface {
    /// Its share of the shader's interface.
    pub(super) interface: ShaderInterface,
    /// What it asks of a device beyond what every device has.
    pub(super) needs: Vec<Needed>,
    /// Values that come in by location (vertex attributes, or what the vertex stage hands over).
    pub(super) inputs: Vec<Varying>,
    /// Values that go out by location.
    pub(super) outputs: Vec<Varying>,
    /// Input attachments by name, with their index among those of the shader.
    pub(super) input_attachments: Vec<(String, u32)>,
}

/// Locations of vertex attributes are below this, which every device has by Vulkan's "Required Limits" (`maxVertexInputAttributes`), as
/// it has as many buffers of them. 16 bytes each end long before the offset (2,047) and the stride (2,048) that every device allows.
/// So no device is asked. The compiler itself limits those of colour outputs.
const ATTRIBUTES: u32 = 16;
/// A fragment stage declares at most this many outputs, the elements of arrays counted: no device has as many.
const OUTPUTS: u32 = 256;
/// Bytes of the variables of one invocation (64 KiB): a driver keeps them for every fragment that it works on at a time,
/// and a software driver has no limit of its own but the machine's memory.
const OWN_BYTES: u64 = 64 << 10;

/// Reads the interface of `stage` off `spirv`. `in_part`: it is told which parts of images are in use; `both_eyes`: it was made to
/// draw for both eyes at once, for a device that can; `program`: what the program supplies.
///
/// # Errors
/// In words: what it uses that can't be bound.
pub(super) fn reflect(
    stage: ShaderStage,
    spirv: &[u32],
    in_part: bool,
    both_eyes: bool,
    program: &ProgramSupply,
) -> Result<StageInterface, RefusedStage> {
    let module = rspirv::dr::load_words(spirv).map_err(|error| format!("SPIR-V that can't be read: {error}"))?;
    let module = IndexedModule::new(&module);
    check_stage(&module, stage)?;
    let used: HashSet<u32> =
        module.code().flat_map(|it| &it.operands).filter_map(rspirv::dr::Operand::id_ref_any).collect();
    let StageFacts { writes_attachments: fragment, places_vertices: vertex, .. } = stage.facts();
    let features = check_capabilities(&module, stage, both_eyes, program.addresses)?;
    addresses::check(&module, program.addresses)?;
    distances::check(&module)?;
    check_own_memory(&module)?;
    check_extensions(&module)?;
    rotation::check_constants(&module, stage)?;
    let inputs = varyings(&module, StorageClass::Input, &used);
    let outputs = varyings(&module, StorageClass::Output, &used);
    let (most_in, most_out) = if fragment { (LOCATION, u32::MAX) } else { (ATTRIBUTES, LOCATION) };
    check_locations(&module, StorageClass::Input, most_in)?;
    check_locations(&module, StorageClass::Output, most_out)?;
    let bindings = bindings(&module, stage, &used, in_part, program)?;
    check_references(&module, stage)?;
    let program = program_resources(&module, stage, &used, &program.sets)?;
    let workgroup_size = stage.facts().has_workgroups.then(|| workgroup_size(&module));
    if workgroup_size.is_some_and(|size| size.contains(&0)) {
        let words = &["local_size_", "numthreads", "workgroup_size"];
        return Err(RefusedStage::beginning(
            words,
            "its workgroups have no invocations: a side of them is 0".to_owned(),
        ));
    }
    let needs = needs(&module, stage, features, &bindings, &program, workgroup_size);
    let interface = ShaderInterface {
        bindings,
        program,
        pushed: pushed(&module, stage, &used),
        // The module was changed already.
        pushed_misfits: Vec::new(),
        vertex_inputs: if vertex { vertex_inputs(&inputs)? } else { Vec::new() },
        outputs: if fragment { fragment_outputs(&module)? } else { Vec::new() },
        second_source: fragment && has_second_source(&module),
        point_size: vertex && writes_point_size(&module, &used),
        discards: module
            .code()
            .any(|it| matches!(it.class.opcode, Op::Kill | Op::TerminateInvocation | Op::DemoteToHelperInvocation)),
        masks_samples: fragment && coverage::writes_sample_mask(&module, &used),
        // The text says it, not the SPIR-V.
        leaves_out_at: None,
        only_written_at: Vec::new(),
        unset: if fragment { coverage::unset(&module) } else { Vec::new() },
        own_vertices: None,
        uses_frag_coord: built_in_used(&module, &used, &[BuiltIn::FragCoord]),
        uses_derivatives: fragment && module.code().any(|it| takes_derivatives(it.class.opcode)),
        per_sample: fragment && (per_sample(&module, &used) || coverage::uses_sample_mask(&module, &used)),
        writes_depth: module
            .module
            .execution_modes
            .iter()
            .any(|it| matches!(&it.operands[..], [_, Operand::ExecutionMode(ExecutionMode::DepthReplacing), ..])),
        workgroup_size,
        unturned: rotation::unturned(&module, stage),
        // The text says it, not the SPIR-V.
        asks_part: Vec::new(),
        sees_alike: if vertex { matrices(&module, &used) } else { Vec::new() },
        // They are told with their places, which stand in the text too.
        needs: Vec::new(),
        constants: constants::of(&module),
    };
    let input_attachments = module
        .variables()
        .filter_map(|(id, _)| {
            let index = module.decoration_number(id, Decoration::InputAttachmentIndex)?;
            Some((module.name(id).to_owned(), index))
        })
        .collect();
    Ok(StageInterface { interface, needs, inputs, outputs, input_attachments })
}

/// Refuses a stage that stores behind an address where not every device can store.
fn check_references(module: &IndexedModule<'_>, stage: ShaderStage) -> Result<(), RefusedStage> {
    let StageFacts { may_store, name, .. } = stage.facts();
    if may_store || !addresses::stores(module) {
        return Ok(());
    }
    let what = format!("a {name} shader stores behind an address: not every device can; store in a compute pass");
    Err(RefusedStage::beginning(addresses::WORDS, what))
}

/// The pass's blocks with matrices, the parameters left out; none if the stage knows which view the device draws.
fn matrices(module: &IndexedModule<'_>, used: &HashSet<u32>) -> Vec<String> {
    if built_in_used(module, used, &[BuiltIn::ViewIndex]) {
        return Vec::new();
    }
    let of_pass = |variable: u32| module.decoration_number(variable, Decoration::DescriptorSet) == Some(PASS_SET);
    let blocks = module.variables().filter(|(variable, _)| used.contains(variable) && of_pass(*variable));
    let named = blocks.filter_map(|(variable, it)| {
        let ty = module.pointee(it).filter(|ty| holds_matrix(module, ty))?;
        let own = module.name(variable);
        Some(if own.is_empty() { module.name(ty.result_id?) } else { own }.to_owned())
    });
    named.filter(|name| name != PARAMS).collect()
}

/// Whether a type holds a matrix. Types hold only types that were declared before them.
fn holds_matrix(module: &IndexedModule<'_>, ty: &rspirv::dr::Instruction) -> bool {
    let within = |operand: &Operand| {
        operand.id_ref_any().and_then(|ty| module.global(ty)).is_some_and(|ty| holds_matrix(module, ty))
    };
    match ty.class.opcode {
        Op::TypeMatrix => true,
        Op::TypeArray | Op::TypeRuntimeArray => ty.operands.first().is_some_and(within),
        Op::TypeStruct => ty.operands.iter().any(within),
        _ => false,
    }
}

/// That what has a location, used or not, ends below location `most`.
fn check_locations(module: &IndexedModule<'_>, class: StorageClass, most: u32) -> Result<(), RefusedStage> {
    // The eye is the library's own.
    let own = module.variables().filter(|(id, it)| storage_class(it) == Some(class) && module.name(*id) != HANDED_ON);
    for (id, variable) in own {
        let Some(ty) = module.pointee(variable).and_then(|ty| ty.result_id) else { continue };
        let Some(last) = module.last_location(id, ty) else { continue };
        if last >= most {
            // A block without a name of its own has the name of its type.
            let name = Some(module.name(id)).filter(|name| !name.is_empty()).unwrap_or_else(|| module.name(ty));
            let what = format!("`{name}` at location {last}: locations go up to {}", most - 1);
            return Err(RefusedStage::named(name, what));
        }
    }
    Ok(())
}

/// Invocations of a workgroup, as a constant says, or else the entry point.
fn workgroup_size(module: &IndexedModule<'_>) -> [u32; 3] {
    let is_size = |id: u32| {
        matches!(module.decoration(id, Decoration::BuiltIn), Some(Some(Operand::BuiltIn(BuiltIn::WorkgroupSize))))
    };
    let constants = module.module.types_global_values.iter().filter(|it| it.result_id.is_some_and(is_size));
    let parts = |it: &rspirv::dr::Instruction| {
        it.operands.iter().filter_map(|it| module.constant(it.id_ref_any()?)).collect::<Vec<_>>()
    };
    let by_constant = constants.map(parts).find(|size| size.len() == 3);
    let size = by_constant.or_else(|| size_of_entry_point(module)).unwrap_or_default();
    [0, 1, 2].map(|axis| size.get(axis).copied().unwrap_or(1))
}

fn size_of_entry_point(module: &IndexedModule<'_>) -> Option<Vec<u32>> {
    module.module.execution_modes.iter().find_map(|it| match &it.operands[..] {
        [_, Operand::ExecutionMode(ExecutionMode::LocalSize), size @ ..] => {
            Some(size.iter().filter_map(number).collect())
        }
        [_, Operand::ExecutionMode(ExecutionMode::LocalSizeId), size @ ..] => {
            Some(size.iter().filter_map(|it| module.constant(it.id_ref_any()?)).collect())
        }
        _ => None,
    })
}

/// No more memory for variables than an invocation may have.
fn check_own_memory(module: &IndexedModule<'_>) -> Result<(), RefusedStage> {
    let local = module.code().filter(|it| it.class.opcode == Op::Variable);
    let global = module.variables().map(|(_, it)| it).filter(|it| storage_class(it) == Some(StorageClass::Private));
    let mut total: u64 = 0;
    for variable in local.chain(global) {
        let Some(ty) = module.pointee(variable).and_then(|ty| ty.result_id) else { continue };
        total = total.saturating_add(module.own_bytes(ty));
        if total > OWN_BYTES {
            let name = variable.result_id.map_or("", |id| module.name(id));
            let what = format!("with `{name}` its variables take {total} bytes: at most {OWN_BYTES} are allowed");
            return Err(RefusedStage::named(name, what));
        }
    }
    Ok(())
}

/// Whether an output is the second colour of a blend.
fn is_second_source(module: &IndexedModule<'_>, output: u32) -> bool {
    module.decoration_number(output, Decoration::Index).is_some_and(|index| index > 0)
}

/// Whether a fragment stage has a second colour for the target at location 0.
fn has_second_source(module: &IndexedModule<'_>) -> bool {
    let mut outputs = module.variables().filter(|(_, it)| storage_class(it) == Some(StorageClass::Output));
    outputs.any(|(id, _)| is_second_source(module, id) && module.decoration_number(id, Decoration::Location) == Some(0))
}

/// Colour outputs by location; an array takes a location for each element.
fn fragment_outputs(module: &IndexedModule<'_>) -> Result<Vec<FragmentOutput>, RefusedStage> {
    let mut outputs = Vec::new();
    for (id_of, it) in module.variables().filter(|(_, it)| storage_class(it) == Some(StorageClass::Output)) {
        let Some(location) = module.decoration_number(id_of, Decoration::Location) else { continue };
        // The second source of a blend is no output of its own.
        if is_second_source(module, id_of) {
            continue;
        }
        let Some(mut ty) = module.pointee(it) else { continue };
        let mut elements: u32 = 1;
        while ty.class.opcode == Op::TypeArray {
            elements = elements.saturating_mul(module.array_length(ty));
            let Some(element) = id(ty, 0).and_then(|element| module.global(element)) else { break };
            ty = element;
        }
        let Some(ty) = ty.result_id else { continue };
        if location.saturating_add(elements) > OUTPUTS {
            let name = module.name(id_of);
            let most = OUTPUTS - 1;
            let what = format!("output `{name}`: {elements} from location {location} on; locations go up to {most}");
            return Err(RefusedStage::named(name, what));
        }
        outputs.extend((0..elements).map(|element| FragmentOutput {
            location: location + element,
            name: module.name(id_of).to_owned(),
            component: component_of(&module.type_name(ty)),
            components: module.components(ty),
        }));
    }
    outputs.sort_by_key(|output| output.location);
    // Several may share a location, each with components of its own.
    outputs.dedup_by(|next, first| {
        let shares = next.location == first.location;
        if shares {
            first.components += next.components;
        }
        shares
    });
    Ok(outputs)
}

/// Checks that the module is one of `stage`: a file may hold another one than its name says.
fn check_stage(module: &IndexedModule<'_>, stage: ShaderStage) -> Result<(), RefusedStage> {
    let StageFacts { model: wanted, name, .. } = stage.facts();
    let main = |it: &rspirv::dr::Instruction| match &it.operands[..] {
        [Operand::ExecutionModel(model), _, Operand::LiteralString(entry), ..] => *model == wanted && entry == "main",
        _ => false,
    };
    if module.module.entry_points.first().is_some_and(main) {
        return Ok(());
    }
    Err(RefusedStage::from(format!("its SPIR-V has no entry point `main` of a {name} stage")))
}

/// Whether the code uses one of these built-in variables.
fn built_in_used(module: &IndexedModule<'_>, used: &HashSet<u32>, wanted: &[BuiltIn]) -> bool {
    module.variables().filter(|(id, _)| used.contains(id)).any(|(id, _)| {
        matches!(module.decoration(id, Decoration::BuiltIn), Some(Some(Operand::BuiltIn(found))) if wanted.contains(found))
    })
}

/// Vulkan runs a fragment stage once a sample if it reads the sample's number or place, or an input marked `sample`.
fn per_sample(module: &IndexedModule<'_>, used: &HashSet<u32>) -> bool {
    built_in_used(module, used, &[BuiltIn::SampleId, BuiltIn::SamplePosition])
        || module.variables().any(|(id, it)| {
            storage_class(it) == Some(StorageClass::Input)
                && used.contains(&id)
                && module.decoration(id, Decoration::Sample).is_some()
        })
}

/// Whether an instruction compares neighbouring fragments, to differentiate or to choose a mip level.
fn takes_derivatives(opcode: Op) -> bool {
    matches!(
        opcode,
        Op::DPdx
            | Op::DPdy
            | Op::Fwidth
            | Op::DPdxFine
            | Op::DPdyFine
            | Op::FwidthFine
            | Op::DPdxCoarse
            | Op::DPdyCoarse
            | Op::FwidthCoarse
            | Op::ImageSampleImplicitLod
            | Op::ImageSampleDrefImplicitLod
            | Op::ImageSampleProjImplicitLod
            | Op::ImageSampleProjDrefImplicitLod
            | Op::ImageQueryLod
    )
}
