//! Barriers: removed, weakened, given other layouts.

use super::{Mutant, UNCHANGED, catch_all, mutants, nth};
use framewright_graph::plan::{Plan, Step, Work};
use framewright_graph::vulkan::{Accesses, Layout, Stages};

const LAYOUTS: [Layout; 14] = [
    Layout::Undefined,
    Layout::General,
    Layout::ColorAttachmentOptimal,
    Layout::DepthStencilAttachmentOptimal,
    Layout::DepthStencilReadOnlyOptimal,
    Layout::DepthAttachmentOptimal,
    Layout::DepthReadOnlyOptimal,
    Layout::StencilAttachmentOptimal,
    Layout::StencilReadOnlyOptimal,
    Layout::ShaderReadOnlyOptimal,
    Layout::TransferSrcOptimal,
    Layout::TransferDstOptimal,
    Layout::PresentSrcKhr,
    Layout::RenderingLocalReadKhr,
];

pub(crate) fn without_a_barrier(plan: &Plan) -> Vec<Mutant> {
    let mut all = mutants(plan, |plan, place| {
        let (step, index) = nth(plan, place, |step| &step.image_barriers)?;
        let barrier = plan.steps[step].image_barriers.remove(index);
        Some(format!("image barrier on `{}` before step {step} removed", plan.image(barrier.image).name))
    });
    all.extend(mutants(plan, |plan, place| {
        let (step, index) = nth(plan, place, |step| &step.memory_barriers)?;
        plan.steps[step].memory_barriers.remove(index);
        Some(format!("memory barrier before step {step} removed"))
    }));
    all
}

fn without_a_local_barrier(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let scopes = plan.steps.iter_mut().filter_map(|step| match &mut step.work {
            Work::Render(scope) => Some(scope),
            _ => None,
        });
        let pass = scopes.flat_map(|scope| &mut scope.passes).filter(|pass| pass.local_barrier).nth(place)?;
        pass.local_barrier = false;
        Some(format!("local barrier before `{}` removed", pass.name))
    })
}

/// The masks of a barrier.
struct Masks<'b> {
    stages: [&'b mut Stages; 2],
    accesses: [&'b mut Accesses; 2],
    name: String,
}

impl Masks<'_> {
    /// Takes one bit away.
    fn weaken(self, bit: usize) -> Option<String> {
        let stages = self.stages.iter().enumerate().flat_map(|(side, set)| set.iter().map(move |one| (side, one)));
        let stages: Vec<_> = stages.collect();
        let accesses = self.accesses.iter().enumerate().flat_map(|(side, set)| set.iter().map(move |one| (side, one)));
        let accesses: Vec<_> = accesses.collect();
        if let Some((side, stage)) = stages.get(bit) {
            self.stages[*side].remove(*stage);
            return Some(format!("{} without {stage:?} in its {} stages", self.name, ["source", "destination"][*side]));
        }
        let (side, access) = accesses.get(bit - stages.len())?;
        self.accesses[*side].remove(*access);
        Some(format!("{} without {access:?} in its {} accesses", self.name, ["source", "destination"][*side]))
    }
}

fn with_a_weaker_mask(plan: &Plan) -> Vec<Mutant> {
    const MOST_BITS: usize = 16;
    let count = |of: fn(&Step) -> usize| plan.steps.iter().map(of).sum::<usize>();
    let mut all = Vec::new();
    for barrier in 0..count(|step| step.image_barriers.len()) {
        all.extend((0..MOST_BITS).filter_map(|bit| {
            mutants(plan, |plan, place| {
                let (step, index) = nth(plan, barrier, |step| &step.image_barriers).filter(|_| place == 0)?;
                let name = plan.image(plan.steps[step].image_barriers[index].image).name.clone();
                let barrier = &mut plan.steps[step].image_barriers[index];
                let stages = [&mut barrier.src_stages, &mut barrier.dst_stages];
                let accesses = [&mut barrier.src_accesses, &mut barrier.dst_accesses];
                Masks { stages, accesses, name: format!("image barrier on `{name}` before step {step}") }.weaken(bit)
            })
            .pop()
        }));
    }
    for barrier in 0..count(|step| step.releases.len()) {
        all.extend((0..MOST_BITS).filter_map(|bit| {
            mutants(plan, |plan, place| {
                let (step, index) = nth(plan, barrier, |step| &step.releases).filter(|_| place == 0)?;
                let barrier = &mut plan.steps[step].releases[index];
                let stages = [&mut barrier.src_stages, &mut barrier.dst_stages];
                let accesses = [&mut barrier.src_accesses, &mut barrier.dst_accesses];
                Masks { stages, accesses, name: format!("release {index} after step {step}") }.weaken(bit)
            })
            .pop()
        }));
    }
    for barrier in 0..count(|step| step.memory_barriers.len()) {
        all.extend((0..MOST_BITS).filter_map(|bit| {
            mutants(plan, |plan, place| {
                let (step, index) = nth(plan, barrier, |step| &step.memory_barriers).filter(|_| place == 0)?;
                let barrier = &mut plan.steps[step].memory_barriers[index];
                let stages = [&mut barrier.src_stages, &mut barrier.dst_stages];
                let accesses = [&mut barrier.src_accesses, &mut barrier.dst_accesses];
                Masks { stages, accesses, name: format!("memory barrier before step {step}") }.weaken(bit)
            })
            .pop()
        }));
    }
    all
}

fn in_another_layout(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let (place, layout) = (place / LAYOUTS.len(), LAYOUTS[place % LAYOUTS.len()]);
        let (step, index) = nth(plan, place / 2, |step| &step.image_barriers)?;
        let barrier = &mut plan.steps[step].image_barriers[index];
        let (side, changed) =
            [("old", &mut barrier.old_layout), ("new", &mut barrier.new_layout)].into_iter().nth(place % 2)?;
        let before = std::mem::replace(changed, layout);
        let same = if before == layout { UNCHANGED } else { "" };
        Some(format!("{side} layout of barrier {index} before step {step} {before:?} → {layout:?}{same}"))
    })
}

#[test]
fn every_removed_barrier_is_caught() {
    catch_all(without_a_barrier, &[]);
}

#[test]
fn every_removed_local_barrier_is_caught() {
    catch_all(without_a_local_barrier, &[]);
}

#[test]
fn every_weakened_mask_is_caught() {
    catch_all(with_a_weaker_mask, &[]);
}

#[test]
fn every_changed_layout_is_caught() {
    let harmless = [(
        "history: old layout of barrier 0 before step 0 Undefined → ShaderReadOnlyOptimal",
        "the frame finds it in that layout, and keeping what nobody reads does no harm",
    )];
    catch_all(in_another_layout, &harmless);
}
