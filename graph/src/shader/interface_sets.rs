//! The program's sets in the file of a draw source's interfaces.

use super::interface_values::{list, number};
use super::{BindingFlags, DescriptorType, DrawInterfaces, ProgramBinding, ProgramSet};
use crate::base::Code;
use crate::fields;
use crate::ron::{Leaf, Reader};
use crate::vulkan::Stages;
use std::fmt::Write as _;

fields! {
    struct SetFields<'t> {
        set: Leaf<'t>,
        bindings: Leaf<'t>,
    }
}

fields! {
    struct BindingFields<'t> {
        binding: Leaf<'t>,
        kind: Leaf<'t>,
        count: Option<Leaf<'t>>,
        stages: Option<Leaf<'t>>,
        flags: Option<Leaf<'t>>,
    }
}

/// Reaches a flag.
type Flag = fn(&mut BindingFlags) -> &mut bool;

/// The flags, as files name them.
const FLAGS: [(&str, Flag); 4] = [
    ("PartiallyBound", |it| &mut it.partially_bound),
    ("UpdateAfterBind", |it| &mut it.update_after_bind),
    ("UpdateUnusedWhilePending", |it| &mut it.update_unused_while_pending),
    ("VariableDescriptorCount", |it| &mut it.variable_count),
];

/// Writes the sets, if there are any.
pub(super) fn write(sets: &[ProgramSet], text: &mut String) {
    if sets.is_empty() {
        return;
    }
    *text += "    sets: [\n";
    for ProgramSet { set, bindings } in sets {
        // Writing to a text can't fail.
        let _ = writeln!(text, "        (\n            set: {set},\n            bindings: [");
        for ProgramBinding { binding, kind, count, stages, flags } in bindings {
            let _ = write!(text, "                (binding: {binding}, kind: {}", kind.name());
            if *count != 1 {
                let _ = write!(text, ", count: {count}");
            }
            *text += &stage_words(*stages, Stages::all_of_sets());
            let mut flags = *flags;
            let set: Vec<_> = FLAGS.iter().filter(|(_, flag)| *flag(&mut flags)).map(|(name, _)| *name).collect();
            if !set.is_empty() {
                let _ = write!(text, ", flags: [{}]", set.join(", "));
            }
            *text += "),\n";
        }
        *text += "            ],\n        ),\n";
    }
    *text += "    ],\n";
}

/// The field that names stages, behind others; nothing if they are the usual ones.
pub(super) fn stage_words(stages: Stages, usual: Stages) -> String {
    if stages == usual {
        return String::new();
    }
    let named = Stages::of_sets().into_iter().filter(|(_, _, stage)| stages.contains(*stage)).map(|(name, ..)| name);
    format!(", stages: [{}]", named.collect::<Vec<_>>().join(", "))
}

/// The stages of a list.
pub(super) fn stages(reader: &mut Reader, leaf: Leaf<'_>) -> Option<Stages> {
    let named = Stages::of_sets().map(|(name, _, stage)| (name, stage));
    list(reader, Some(leaf), "stages")
        .into_iter()
        .try_fold(Stages::empty(), |all, stage| Some(all | reader.choice(stage, "a stage", &named)?))
}

/// Reads the sets of the program.
pub(super) fn read(reader: &mut Reader, all: Leaf<'_>, mut interfaces: DrawInterfaces) -> Option<DrawInterfaces> {
    let before = reader.errors.len();
    let mut places: Vec<(u32, Leaf<'_>, Vec<Leaf<'_>>)> = Vec::new();
    for entry in reader.list(all, "the program's sets")? {
        let Some(fields) = reader.read::<SetFields<'_>>(entry, "a set of the program") else { continue };
        let set = number(reader, fields.set, "the number of the set");
        let leaves = list(reader, Some(fields.bindings), "bindings");
        let bindings: Vec<_> = leaves.iter().filter_map(|leaf| binding(reader, *leaf)).collect();
        let Some(set) = set else { continue };
        if places.iter().any(|(known, ..)| *known == set) {
            reader.wrong(Code::INTERFACE_FILE, fields.set, format!("set {set} stands here twice"), "");
        }
        places.push((set, fields.set, leaves));
        interfaces = interfaces.with_set(ProgramSet { set, bindings });
    }
    // Numbers of bindings are those of leaves only if all were read.
    if reader.errors.len() > before {
        return Some(interfaces);
    }
    places.sort_by_key(|(set, ..)| *set);
    for fault in interfaces.set_faults() {
        let Some((_, whole, bindings)) = places.get(fault.set) else { continue };
        let leaf = fault.binding.and_then(|binding| bindings.get(binding)).unwrap_or(whole);
        reader.wrong(Code::INTERFACE_FILE, *leaf, fault.message, "");
    }
    Some(interfaces)
}

fn binding(reader: &mut Reader, leaf: Leaf<'_>) -> Option<ProgramBinding> {
    let fields: BindingFields<'_> = reader.read(leaf, "a binding")?;
    let binding = number(reader, fields.binding, "the binding");
    let kind = reader.choice(fields.kind, "a type of descriptors", DescriptorType::NAMED);
    let count = fields.count.map_or(Some(1), |leaf| number(reader, leaf, "the count"));
    let stages = fields.stages.map_or_else(|| Some(Stages::all_of_sets()), |leaf| stages(reader, leaf));
    let mut flags = BindingFlags::default();
    for leaf in list(reader, fields.flags, "flags") {
        if let Some(flag) = reader.choice(leaf, "a flag", &FLAGS) {
            *flag(&mut flags) = true;
        }
    }
    Some(ProgramBinding { binding: binding?, kind: kind?, count: count?, stages: stages?, flags })
}
