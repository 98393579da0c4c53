//! The checker catches every single thing that can be taken from a Plan in which nothing is superfluous.
//!
//! Caught means: some violation names both steps, the image and the part of it. Totals
//! are made right again after each change, so that they can't give it away.

use crate::hand_written_plans::{self, placement, recount};
use framewright_graph::plan::{Attachment, Image, Plan, Role, Step, Work};
use framewright_graph::verify::{Violation, verify};
use framewright_graph::vocabulary::{Accesses, Layout, LoadOp, Stages, StoreOp};

/// A changed Plan, and what was changed.
pub(crate) struct Mutant {
    pub(crate) change: String,
    pub(crate) plan: Plan,
}

const LAYOUTS: [Layout; 8] = [
    Layout::Undefined,
    Layout::General,
    Layout::ColorAttachmentOptimal,
    Layout::DepthStencilAttachmentOptimal,
    Layout::DepthStencilReadOnlyOptimal,
    Layout::ShaderReadOnlyOptimal,
    Layout::TransferSrcOptimal,
    Layout::TransferDstOptimal,
];

/// Applies `change` at every place that it finds; it is given the number of the place and returns what it did.
fn mutants(plan: &Plan, change: impl Fn(&mut Plan, usize) -> Option<String>) -> Vec<Mutant> {
    let at = |place| {
        let mut plan = plan.clone();
        let change = change(&mut plan, place)?;
        recount(&mut plan);
        Some(Mutant { change, plan })
    };
    (0..).map_while(at).collect()
}

/// The barrier with this number, counted over all steps: step, index in it.
fn nth<T>(plan: &Plan, place: usize, of: impl Fn(&Step) -> &Vec<T>) -> Option<(usize, usize)> {
    let steps = plan.steps.iter().enumerate();
    steps.flat_map(|(step, described)| (0..of(described).len()).map(move |index| (step, index))).nth(place)
}

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

/// Marks a place where there was nothing to change.
const UNCHANGED: &str = " (unchanged)";

/// Whether both live at one step.
fn live_together(one: &Image, other: &Image) -> bool {
    match (placement(one), placement(other)) {
        (Some(one), Some(other)) => one.lifetime[0] <= other.lifetime[1] && other.lifetime[0] <= one.lifetime[1],
        _ => false,
    }
}

fn on_a_live_neighbour(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let images = plan.images.len();
        let (one, other) = (place / images, place % images);
        let (moved, neighbour) = (plan.images.get(one)?.clone(), plan.images[other].clone());
        if one == other || !live_together(&moved, &neighbour) {
            return Some(UNCHANGED.to_owned());
        }
        let offset = placement(&neighbour)?.offset;
        if let Role::Transient(placement) = &mut plan.images[one].role {
            placement.offset = offset;
        }
        plan.heaps[0].bytes *= 2;
        Some(format!("`{}` moved onto `{}`", moved.name, neighbour.name))
    })
}

fn outliving_its_lifetime(plan: &Plan) -> Vec<Mutant> {
    mutants(plan, |plan, place| {
        let image = plan.images.get_mut(place / 2)?;
        let name = image.name.clone();
        match &mut image.role {
            Role::Transient(placement) if placement.lifetime[0] < placement.lifetime[1] => {
                let [first, last] = &mut placement.lifetime;
                if place.is_multiple_of(2) {
                    first.0 += 1
                } else {
                    last.0 -= 1
                }
                Some(format!("lifetime of `{name}` shortened"))
            }
            _ => Some(UNCHANGED.to_owned()),
        }
    })
}

fn attachments(plan: &mut Plan) -> impl Iterator<Item = (usize, &mut Attachment)> {
    plan.steps.iter_mut().enumerate().flat_map(|(step, described)| {
        let scope = match &mut described.work {
            Work::Render(scope) => Some(scope),
            _ => None,
        };
        scope
            .into_iter()
            .flat_map(|scope| scope.color.iter_mut().chain(&mut scope.depth).chain(&mut scope.stencil))
            .map(move |of| (step, of))
    })
}

fn with_lost_contents(plan: &Plan) -> Vec<Mutant> {
    let mut all = mutants(plan, |plan, place| {
        let (step, attachment) = attachments(plan).nth(place)?;
        let loads = attachment.load == LoadOp::Load;
        attachment.load = if loads { LoadOp::DontCare } else { attachment.load };
        Some(format!("LOAD of step {step} → DONT_CARE{}", if loads { "" } else { UNCHANGED }))
    });
    all.extend(mutants(plan, |plan, place| {
        let (step, attachment) = attachments(plan).nth(place)?;
        let stores = attachment.store == StoreOp::Store;
        attachment.store = if stores { StoreOp::DontCare } else { attachment.store };
        Some(format!("STORE of step {step} → DONT_CARE{}", if stores { "" } else { UNCHANGED }))
    }));
    all.extend(mutants(plan, |plan, place| {
        let (step, attachment) = attachments(plan).nth(place)?;
        let resolves = attachment.resolve.take().is_some();
        Some(format!("resolve of step {step} dropped{}", if resolves { "" } else { UNCHANGED }))
    }));
    all
}

/// Whether it names both steps and the part of an image or the bytes of a buffer, in its data and in its sentence.
pub(crate) fn names_all(violation: &Violation) -> bool {
    let Violation { step: Some(step), other: Some(other), resource: Some(resource), .. } = violation else {
        return false;
    };
    let part = match (violation.range, violation.bytes) {
        (Some(range), _) => range.to_string(),
        (None, Some([start, end])) => format!("bytes {start}–{end}"),
        (None, None) => return false,
    };
    let sentence = violation.to_string();
    [step.to_string(), other.to_string(), format!("`{resource}`"), part].iter().all(|part| sentence.contains(part))
}

/// Checks all mutants of all Plans; those named in `harmless` must be accepted, all others caught.
fn catch_all(of: fn(&Plan) -> Vec<Mutant>, harmless: &[(&str, &str)]) {
    let (mut caught, mut missed, mut accepted) = (0, Vec::new(), Vec::new());
    for (name, plan) in hand_written_plans::all() {
        for Mutant { change, plan } in of(&plan).into_iter().filter(|mutant| !mutant.change.ends_with(UNCHANGED)) {
            let violations = verify(&plan);
            let change = format!("{name}: {change}");
            match violations.iter().find(|violation| names_all(violation)) {
                Some(violation) => {
                    caught += 1;
                    println!("caught  {change}\n        {violation}");
                    assert!(harmless.iter().all(|(listed, _)| *listed != change), "listed as harmless: {change}");
                }
                None if harmless.iter().any(|(listed, _)| *listed == change) => accepted.push(change),
                None => {
                    println!("missed  {change}");
                    violations.iter().for_each(|violation| println!("        {violation}"));
                    missed.push(change);
                }
            }
        }
    }
    println!("caught {caught}, missed {}, harmless {}", missed.len(), accepted.len());
    assert!(caught > 0, "nothing was changed");
    assert!(missed.is_empty(), "missed:\n{}", missed.join("\n"));
    assert_eq!(accepted.len(), harmless.len(), "harmless changes that no Plan offers");
}

#[test]
fn every_removed_barrier_is_caught() {
    catch_all(without_a_barrier, &[]);
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

#[test]
fn every_allocation_on_a_live_neighbour_is_caught() {
    catch_all(on_a_live_neighbour, &[]);
}

#[test]
fn every_shortened_lifetime_is_caught() {
    catch_all(outliving_its_lifetime, &[]);
}

#[test]
fn all_lost_contents_are_caught() {
    catch_all(with_lost_contents, &[]);
}
