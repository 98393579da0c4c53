//! What is wrong with the sets of a program.

use super::{BINDINGS, DescriptorType, DrawInterfaces, PASS_SET, ProgramBinding};
use crate::vulkan::Stages;
use std::collections::HashMap;

/// The sets of a program are numbered below this: every device has as many.
const SETS: u32 = 4;
/// Descriptors of one kind that every device allows in bindings that are updated after they were bound, where it has them at all.
const MOST_UPDATED: u64 = 500_000;
/// The same of uniform buffers.
const MOST_UPDATED_UNIFORM: u64 = 12;
/// Acceleration structures that every device allows that has them, `maxPerStageDescriptorAccelerationStructures`.
const MOST_STRUCTURES: u64 = 16;

/// A part of a program's sets that no device need be able to bind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SetFault {
    /// The number of the set in the list of sets.
    pub set: usize,
    /// The number of the binding in its list; `None`: the set as a whole.
    pub binding: Option<usize>,
    /// What is wrong, in words.
    pub message: String,
}

/// Whether a binding counts.
type Counts<'a> = &'a dyn Fn(&ProgramBinding) -> bool;

impl DrawInterfaces {
    /// All that is wrong with the sets of the program: what not every device can bind, or where a draw source has its own.
    #[must_use]
    pub fn set_faults(&self) -> Vec<SetFault> {
        let mut faults = Vec::new();
        for (at, (number, set)) in self.sets().iter().map(|it| (it.set, it)).enumerate() {
            let mut whole = |message| faults.push(SetFault { set: at, binding: None, message });
            if number == PASS_SET || number >= SETS {
                whole(format!("set {number} can't be the program's: those are 1 to {}", SETS - 1));
            }
            let brings = self.all_of_file().find(|(_, it)| it.supplied.iter().any(|supplied| supplied.set == number));
            if let Some((kind, _)) = brings {
                whole(format!("set {number} is the draw source's: it brings resources in it along for `{kind}`"));
            }
            let mut seen = HashMap::new();
            let last = set.bindings.iter().map(|it| it.binding).max();
            let updated = set.bindings.iter().any(|it| it.flags.update_after_bind);
            for (number, it) in set.bindings.iter().enumerate() {
                let twice = seen.insert(it.binding, number).is_some();
                let message = if let Some(message) = fault(it) {
                    message
                } else if twice {
                    format!("binding {} stands here twice", it.binding)
                } else if it.flags.variable_count && Some(it.binding) != last {
                    format!("binding {} has a variable count, as only the last one can", it.binding)
                } else if it.kind.is_dynamic() && updated {
                    let what = "which a set has not if some of it is updated after it was bound";
                    format!("binding {} is {}, {what}", it.binding, it.kind.words())
                } else {
                    continue;
                };
                faults.push(SetFault { set: at, binding: Some(number), message });
            }
        }
        if faults.is_empty() {
            faults.extend(self.too_many());
        }
        faults
    }

    /// More descriptors in all sets than every device allows, where no field of a profile tells how many it allows.
    fn too_many(&self) -> Option<SetFault> {
        use DescriptorType as Is;
        let all = || self.sets().iter().flat_map(|set| &set.bindings);
        let count = |counts: Counts<'_>| {
            all().filter(|it| counts(it)).map(|it| u64::from(it.count)).fold(0, u64::saturating_add)
        };
        let updated = |it: &ProgramBinding| it.flags.update_after_bind;
        let uniform = |it: &ProgramBinding| it.kind == Is::UniformBuffer;
        let structure = |it: &ProgramBinding| it.kind == Is::AccelerationStructure;
        let rules: [(&str, Counts<'_>, u64); 5] = [
            ("uniform blocks with dynamic offsets", &|it| it.kind == Is::UniformBufferDynamic, 8),
            ("storage blocks with dynamic offsets", &|it| it.kind == Is::StorageBufferDynamic, 4),
            ("acceleration structures", &|it| !updated(it) && structure(it), MOST_STRUCTURES),
            (
                "uniform blocks that are updated after they were bound",
                &|it| updated(it) && uniform(it),
                MOST_UPDATED_UNIFORM,
            ),
            ("descriptors that are updated after they were bound", &|it| updated(it), MOST_UPDATED),
        ];
        rules.iter().find_map(|(what, counts, most)| {
            let found = count(counts);
            let set = self.sets().iter().position(|set| set.bindings.iter().any(counts))?;
            let message = format!("the program's sets have {found} {what}; every device that has such allows {most}");
            (found > *most).then_some(SetFault { set, binding: None, message })
        })
    }
}

/// What is wrong with a binding by itself.
fn fault(it: &ProgramBinding) -> Option<String> {
    let ProgramBinding { binding, kind, count, stages, flags } = *it;
    if binding >= BINDINGS {
        return Some(format!("binding {binding}: bindings go up to {}", BINDINGS - 1));
    }
    if count == 0 {
        return Some(format!("binding {binding} has no descriptors; one is the least"));
    }
    if stages.is_empty() || !Stages::all_of_sets().contains(stages) {
        return Some(format!("binding {binding} is for no stage; there are vertex, fragment and compute shaders"));
    }
    if kind.is_dynamic() && (flags.update_after_bind || flags.variable_count) {
        let what = "can neither be updated after it was bound nor have a variable count";
        return Some(format!("binding {binding} is {}, which {what}", kind.words()));
    }
    None
}
