//! What a shader in its pass asks of a device, and how many resources the pass binds, where not every device allows as many.

use super::{
    BindingKind, DrawInterface, PASS_SET, ProgramBinding, ProgramSet, ShaderInterface, SuppliedKind, SuppliedResource,
    binding_name, bindings_of_read_sets, push_needs, set_needs, vertex_needs,
};
use crate::device::{Limit, Need, NeedKind};
use crate::vulkan::Stages;

/// A kind of resources that devices limit: what it is called, whether a binding is one, what a draw source brings along of it, and its
/// limits.
type CountedKind = (&'static str, fn(&BindingKind) -> bool, Option<SuppliedKind>, &'static [Limit]);

const COUNTED: [CountedKind; 5] = [
    (
        "sampled images",
        |it| matches!(it, BindingKind::SampledImage(_) | BindingKind::ComparedDepth(_)),
        Some(SuppliedKind::SampledImage),
        &[Limit::StageSampledImages, Limit::StageSamplers, Limit::SetSampledImages, Limit::SetSamplers],
    ),
    (
        "storage images",
        |it| matches!(it, BindingKind::StorageImage { .. }),
        None,
        &[Limit::StageStorageImages, Limit::SetStorageImages],
    ),
    (
        "uniform blocks",
        |it| matches!(it, BindingKind::UniformBlock(_)),
        Some(SuppliedKind::UniformBlock),
        &[Limit::StageUniformBlocks, Limit::SetUniformBlocks],
    ),
    (
        "storage blocks",
        |it| matches!(it, BindingKind::StorageBlock { .. }),
        Some(SuppliedKind::StorageBlock),
        &[Limit::StageStorageBlocks, Limit::SetStorageBlocks],
    ),
    (
        "input attachments",
        |it| matches!(it, BindingKind::InputAttachment { .. }),
        None,
        &[Limit::StageInputAttachments, Limit::SetInputAttachments],
    ),
];

/// All that a shader in its pass asks of a device: what it needs itself, for the vertices and push constants that it reads of those that
/// the draw source brings along (`None`: nothing is bound of it), for the resources that are bound beside the pass's `targets`, and
/// for what it reads of the program's sets.
#[must_use]
pub fn needs_in_pass(
    shader: &ShaderInterface,
    brought: Option<&DrawInterface>,
    sets: &[ProgramSet],
    targets: usize,
) -> Vec<Need> {
    let mut needs = shader.needs.clone();
    if let Some(brought) = brought {
        needs.append(&mut vertex_needs(&shader.vertex_inputs, brought));
        needs.extend(push_needs(brought).filter(|_| !shader.pushed.is_empty()));
    }
    let supplied = brought.into_iter().flat_map(|brought| &brought.supplied);
    needs.append(&mut resource_needs(shader, supplied, bindings_of_read_sets(&shader.program, sets), targets));
    needs.append(&mut set_needs(&shader.program, sets));
    needs
}

/// The resources of a pass that are more than every device allows: of each kind and of all kinds with the pass's `targets`, where each
/// element of an array counts. All stages together are held to what one may see. Resources that the draw source brings along count
/// whether the shader reads them or not. So do the bindings of the program's sets: `program` has them with the numbers of their sets.
pub fn resource_needs<'s>(
    shader: &ShaderInterface,
    brought: impl Iterator<Item = &'s SuppliedResource> + Clone,
    program: impl Iterator<Item = (u32, &'s ProgramBinding)> + Clone,
    targets: usize,
) -> Vec<Need> {
    let mut needs = Vec::new();
    let own = || shader.bindings.iter().filter(|it| it.set == PASS_SET);
    let counts = own().map(|it| u64::from(it.count())).chain(brought.clone().map(|it| u64::from(it.count)));
    let bound = program.clone().filter(|(_, it)| !it.flags.update_after_bind).map(|(_, it)| u64::from(it.count));
    let all = counts.chain(bound).sum::<u64>().saturating_add(targets as u64);
    // Most passes have so few that no kind is worth a look.
    if all <= Limit::StageStorageBlocks.least() {
        return needs;
    }
    let mut need = |limit: Limit, value: u64, what: &dyn Fn() -> String| {
        if value > limit.least() {
            needs.push(Need { kind: NeedKind::Limit { limit, value, what: what().into() }, place: "".into() });
        }
    };
    // Of images without samplers the samplers count by themselves.
    let separate: u64 = own().filter(|it| it.separate).map(|it| u64::from(it.count())).sum();
    let samplers = own().filter(|it| it.kind.is_sampler()).count() as u64;
    for (what, is_own, supplied, limits) in COUNTED {
        let own = own().filter(|it| is_own(&it.kind)).map(|it| (&*it.name, it.count()));
        let brought = brought.clone().filter(|it| Some(it.kind) == supplied).map(|it| (&*it.name, it.count));
        let all = own.chain(brought);
        let count: u64 = all.clone().map(|(_, count)| u64::from(count)).sum();
        for limit in limits {
            let of_samplers = matches!(limit, Limit::StageSamplers | Limit::SetSamplers);
            let of_sets = || program.clone().map(|(set, it)| (set, it.binding, it.counts_for(*limit)));
            let in_sets: u64 = of_sets().map(|(.., count)| count).sum();
            let words = || {
                let tables = of_sets().map(|(set, binding, count)| (binding_name(set, binding), count));
                let named = all.clone().map(|(name, count)| (name.to_owned(), u64::from(count)));
                let array = named.chain(tables).max_by_key(|(_, count)| *count).filter(|(_, count)| *count > 1);
                let array = array.map_or_else(String::new, |(name, count)| format!(", {count} of them as `{name}`"));
                format!("{} {what} are bound{array}", count + in_sets)
            };
            need(*limit, in_sets + if of_samplers { count - separate + samplers } else { count }, &words);
        }
    }
    need(Limit::StageResources, all, &|| format!("{all} resources and colour targets are bound"));
    let is_stored =
        |it: &BindingKind| matches!(it, BindingKind::StorageImage { .. } | BindingKind::StorageBlock { .. });
    let stored = shader.bindings.iter().filter(|it| is_stored(&it.kind) && it.stages.contains(Stages::FRAGMENT_SHADER));
    let stored = stored.map(|it| u64::from(it.count())).sum::<u64>();
    if stored > 0 {
        let all = stored + targets as u64;
        need(Limit::FragmentResources, all, &|| {
            format!("its fragment stage uses {all} storage blocks, storage images and colour targets")
        });
    }
    needs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{Abilities, Limits};

    fn refused(limits: &Limits, textures: u32) -> String {
        refused_with(limits, textures, 0)
    }

    /// Why a device of these limits doesn't bind a sky and an array of textures.
    fn refused_with(limits: &Limits, textures: u32, targets: usize) -> String {
        let brought = [
            SuppliedResource::new(1, 0, "sky", SuppliedKind::SampledImage),
            SuppliedResource::new(2, 0, "textures", SuppliedKind::SampledImage).with_count(textures),
        ];
        let abilities =
            Abilities { device: "this device", limits: Some(limits), has: &|_| false, reads_vertices: &|_| false };
        let needs = resource_needs(&ShaderInterface::default(), brought.iter(), [].into_iter(), targets);
        needs.iter().find_map(|need| need.unmet(&abilities)).unwrap_or_default()
    }

    /// A device of the least that Vulkan demands (EM-5): 16 sampled images in a stage, 96 in all sets.
    #[test]
    fn each_element_of_an_array_counts_and_the_limit_has_its_name() {
        assert_eq!(refused(&Limits::LEAST, 15), "");
        let said = "17 sampled images are bound, 16 of them as `textures`; this device allows 16 ";
        assert_eq!(refused(&Limits::LEAST, 16), format!("{said}(maxPerStageDescriptorSampledImages)"));
        let few_samplers = Limits { stage_sampled_images: 128, ..Limits::LEAST };
        assert_eq!(refused(&few_samplers, 16), format!("{said}(maxPerStageDescriptorSamplers)"));
        let few_in_sets = Limits { stage_samplers: 128, ..few_samplers };
        assert_eq!(
            refused(&few_in_sets, 96),
            "97 sampled images are bound, 96 of them as `textures`; this device allows 96 (maxDescriptorSetSampledImages)"
        );
    }

    #[test]
    fn resources_of_all_kinds_count_together_with_colour_targets() {
        let many = Limits {
            stage_samplers: 1000,
            stage_sampled_images: 1000,
            set_samplers: 1000,
            set_sampled_images: 1000,
            ..Limits::LEAST
        };
        assert_eq!(refused_with(&many, 123, 4), "");
        let said = "129 resources and colour targets are bound; this device allows 128 (maxPerStageResources)";
        assert_eq!(refused_with(&many, 124, 4), said);
    }

    #[test]
    fn arrays_longer_than_any_number_are_refused_too() {
        assert!(refused(&Limits::LEAST, u32::MAX).starts_with("4294967296 sampled images are bound"));
    }

    #[test]
    fn what_a_fragment_stage_stores_counts_together_with_its_targets() {
        use crate::shader::Binding;
        let block = |binding: u32| Binding {
            set: PASS_SET,
            binding,
            name: format!("b{binding}"),
            kind: BindingKind::StorageBlock { readable: true, writable: true, bytes: 4 },
            length: None,
            adapts: false,
            separate: false,
            stages: Stages::FRAGMENT_SHADER,
        };
        let shader = ShaderInterface { bindings: (0..4).map(block).collect(), ..ShaderInterface::default() };
        let abilities = Abilities {
            device: "this device",
            limits: Some(&Limits::LEAST),
            has: &|_| false,
            reads_vertices: &|_| false,
        };
        let unmet = |targets| {
            let needs = resource_needs(&shader, [].iter(), [].into_iter(), targets);
            needs.iter().find_map(|need| need.unmet(&abilities)).unwrap_or_default()
        };
        assert_eq!(unmet(0), "");
        assert_eq!(
            unmet(1),
            "its fragment stage uses 5 storage blocks, storage images and colour targets; this device allows 4 \
             (maxFragmentCombinedOutputResources)"
        );
    }
}
