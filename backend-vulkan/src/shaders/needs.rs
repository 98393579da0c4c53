//! What a stage asks of a device beyond what every device has, read off its SPIR-V.

use super::module::{IndexedModule, storage_class};
use super::text::Words;
use super::{addresses, block_layout, indexing};
use crate::base::ShaderStage;
use framewright_graph::device::{Limit, NeedKind};
use framewright_graph::shader::{Binding, ProgramResource};
use rspirv::spirv::{Capability, Op, StorageClass};

/// A feature that a device must have, and the words of the stage's text that show where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Feature {
    /// Vulkan's name.
    pub(super) name: &'static str,
    pub(super) words: Words,
}

/// Something that not every device has or allows, and the words of the stage's text that show where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Needed {
    pub(super) kind: NeedKind,
    pub(super) words: Words,
}

/// All that a stage needs. `features` are those of its capabilities, `program` what it reads of the program's sets, `workgroup` the
/// invocations of a workgroup.
pub(super) fn needs(
    module: &IndexedModule<'_>,
    stage: ShaderStage,
    mut features: Vec<Feature>,
    bindings: &[Binding],
    program: &[ProgramResource],
    workgroup: Option<[u32; 3]>,
) -> Vec<Needed> {
    features.extend(indexing::features(module));
    features.extend(block_layout::features(module));
    features.extend(initialised(module));
    features.extend(wide_and_narrow(module));
    features.extend(ends_invocations(module));
    if stage.facts().writes_attachments {
        features.extend(stores(module, bindings, program));
    }
    features.sort_by_key(|feature| feature.name);
    // Where two ways to tell of a feature agree, the one that knows the words stays.
    features.dedup_by(|later, kept| {
        let same = later.name == kept.name;
        if same && matches!(kept.words, Words::None | Words::Beginning([])) {
            kept.words = later.words.clone();
        }
        same
    });
    let what = stage.facts().subject;
    let features =
        features.into_iter().map(|Feature { name, words }| Needed { kind: NeedKind::Feature { name, what }, words });
    let limits = workgroup.into_iter().flat_map(of_workgroup).chain(shared(module)).chain(blocks(bindings));
    features.chain(limits).collect()
}

/// A limit, if not every device allows as much.
fn need(limit: Limit, value: u64, words: Words, what: impl FnOnce() -> String) -> Option<Needed> {
    let exceeds = value > limit.least();
    exceeds.then(|| Needed { kind: NeedKind::Limit { limit, value, what: what().into() }, words })
}

fn of_workgroup(size: [u32; 3]) -> Vec<Needed> {
    let words = || Words::Beginning(&["local_size_"]);
    let all = size.iter().fold(1_u64, |all, axis| all.saturating_mul(u64::from(*axis)));
    let [x, y, z] = size;
    let together = need(Limit::WorkgroupInvocations, all, words(), || {
        format!("its workgroups of {x}×{y}×{z} have {all} invocations")
    });
    let axes = [("x", Limit::WorkgroupX), ("y", Limit::WorkgroupY), ("z", Limit::WorkgroupZ)];
    let axes = axes.into_iter().zip(size).filter_map(|((axis, limit), size)| {
        need(limit, size.into(), words(), || format!("its workgroups have {size} invocations in {axis}"))
    });
    axes.chain(together).collect()
}

/// The memory that the invocations of a workgroup share.
fn shared(module: &IndexedModule<'_>) -> Option<Needed> {
    let shared = module.variables().filter(|(_, it)| storage_class(it) == Some(StorageClass::Workgroup));
    let bytes = shared.filter_map(|(_, it)| module.pointee(it)?.result_id).map(|ty| module.own_bytes(ty));
    let total = bytes.fold(0, u64::saturating_add);
    let words = Words::Whole("shared".to_owned());
    need(Limit::SharedBytes, total, words, || format!("its shared variables take {total} bytes"))
}

fn blocks(bindings: &[Binding]) -> impl Iterator<Item = Needed> {
    bindings.iter().filter_map(|binding| {
        let (name, bytes) = (&binding.name, binding.kind.uniform_block()?.bytes);
        let what = || format!("the uniform block `{name}` takes {bytes} bytes");
        need(Limit::UniformBytes, bytes.into(), Words::Whole(name.clone()), what)
    })
}

/// Shared variables that begin with a value, which can be 0 alone.
fn initialised(module: &IndexedModule<'_>) -> Option<Feature> {
    let is_initialised = |(_, it): &(u32, &rspirv::dr::Instruction)| {
        it.class.opcode == Op::Variable && storage_class(it) == Some(StorageClass::Workgroup) && it.operands.len() > 1
    };
    let (id, _) = module.variables().find(is_initialised)?;
    let words = Words::Whole(module.name(id).to_owned());
    Some(Feature { name: "shaderZeroInitializeWorkgroupMemory", words })
}

/// What numbers that don't have 32 bits need together with other things that the stage does.
fn wide_and_narrow(module: &IndexedModule<'_>) -> Vec<Feature> {
    let needed = |wanted| module.capabilities().any(|it| it == wanted);
    let mut features = Vec::new();
    let widths = [Capability::Int64, Capability::Float64, Capability::Int16, Capability::Float16, Capability::Int8];
    if needed(Capability::GroupNonUniform) && widths.into_iter().any(needed) {
        features.push(Feature { name: "shaderSubgroupExtendedTypes", words: Words::Beginning(&["subgroup"]) });
    }
    // Which of its atomic operations are on shared variables isn't looked at.
    let shares = || module.variables().any(|(_, it)| storage_class(it) == Some(StorageClass::Workgroup));
    if needed(Capability::Int64Atomics) && shares() {
        features.push(Feature { name: "shaderSharedInt64Atomics", words: Words::Beginning(&["atomic"]) });
    }
    features
}

/// An end of an invocation that no other invocation sees.
fn ends_invocations(module: &IndexedModule<'_>) -> Option<Feature> {
    let ends = module.code().any(|it| it.class.opcode == Op::TerminateInvocation);
    ends.then_some(Feature {
        name: "shaderTerminateInvocation",
        words: Words::Beginning(&["discard", "terminateInvocation"]),
    })
}

/// Images, blocks and addresses that a fragment stage may store into.
fn stores(module: &IndexedModule<'_>, bindings: &[Binding], program: &[ProgramResource]) -> Option<Feature> {
    let own = bindings.iter().find(|it| it.kind.is_written()).map(|it| &it.name);
    let name = own.or_else(|| program.iter().find(|it| it.writable).map(|it| &it.name));
    let behind = || addresses::stores(module).then_some(Words::Beginning(addresses::WORDS));
    let words = name.map(|name| Words::Whole(name.clone())).or_else(behind)?;
    Some(Feature { name: "fragmentStoresAndAtomics", words })
}
