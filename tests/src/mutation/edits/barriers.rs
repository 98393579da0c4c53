//! Barriers and waits: left out, weakened, of other layouts, of fewer parts.

use super::Edit;
use crate::mutation::Kind;
use framewright_graph::plan::{ImageBarrier, Plan, Step};
use framewright_graph::vulkan::{Aspects, Layout, Subresources};

/// Everything around the work of a step.
pub(super) fn of_step(plan: &Plan, number: usize, step: &Step, edits: &mut Vec<Edit>) {
    memory_barriers(number, step, edits);
    image_barriers(plan, number, step, edits);
    waits(number, step, edits);
}

fn memory_barriers(number: usize, step: &Step, edits: &mut Vec<Edit>) {
    for (at, barrier) in step.memory_barriers.iter().enumerate() {
        let place = format!("memory barrier {at} of step {number}");
        edits.push(Edit::new(Kind::MemoryBarrierDropped, place.clone(), move |plan| {
            plan.steps[number].memory_barriers.remove(at);
        }));
        for (side, stages) in [barrier.src_stages, barrier.dst_stages].into_iter().enumerate() {
            edits.extend(stages.iter().map(|stage| {
                Edit::new(Kind::StageDropped, format!("{stage:?} of {place}, side {side}"), move |plan| {
                    let barrier = &mut plan.steps[number].memory_barriers[at];
                    *[&mut barrier.src_stages, &mut barrier.dst_stages][side] -= stage;
                })
            }));
        }
        for (side, accesses) in [barrier.src_accesses, barrier.dst_accesses].into_iter().enumerate() {
            edits.extend(accesses.iter().map(|access| {
                Edit::new(Kind::AccessDropped, format!("{access:?} of {place}, side {side}"), move |plan| {
                    let barrier = &mut plan.steps[number].memory_barriers[at];
                    *[&mut barrier.src_accesses, &mut barrier.dst_accesses][side] -= access;
                })
            }));
        }
    }
}

/// The barriers before a step, then the releases after it.
fn barrier_of(plan: &mut Plan, number: usize, at: usize) -> &mut ImageBarrier {
    let step = &mut plan.steps[number];
    let before = step.image_barriers.len();
    if at < before { &mut step.image_barriers[at] } else { &mut step.releases[at - before] }
}

fn image_barriers(plan: &Plan, number: usize, step: &Step, edits: &mut Vec<Edit>) {
    let before = step.image_barriers.len();
    for (at, barrier) in step.image_barriers.iter().chain(&step.releases).enumerate() {
        let name = &plan.image(barrier.image).name;
        let place = format!("barrier {at} of step {number} on `{name}`");
        let kind = if at < before { Kind::ImageBarrierDropped } else { Kind::ReleaseDropped };
        edits.push(Edit::new(kind, place.clone(), move |plan| {
            let step = &mut plan.steps[number];
            if at < before {
                step.image_barriers.remove(at);
            } else {
                step.releases.remove(at - before);
            }
        }));
        for (side, stages) in [barrier.src_stages, barrier.dst_stages].into_iter().enumerate() {
            edits.extend(stages.iter().map(|stage| {
                Edit::new(Kind::StageDropped, format!("{stage:?} of {place}, side {side}"), move |plan| {
                    let barrier = barrier_of(plan, number, at);
                    *[&mut barrier.src_stages, &mut barrier.dst_stages][side] -= stage;
                })
            }));
        }
        for (side, accesses) in [barrier.src_accesses, barrier.dst_accesses].into_iter().enumerate() {
            edits.extend(accesses.iter().map(|access| {
                Edit::new(Kind::AccessDropped, format!("{access:?} of {place}, side {side}"), move |plan| {
                    let barrier = barrier_of(plan, number, at);
                    *[&mut barrier.src_accesses, &mut barrier.dst_accesses][side] -= access;
                })
            }));
        }
        edits.extend(smaller(barrier.range).into_iter().map(|range| {
            Edit::new(Kind::RangeShrunk, format!("to {range} of {place}"), move |plan| {
                barrier_of(plan, number, at).range = range;
            })
        }));
        for (side, layout) in [barrier.old_layout, barrier.new_layout].into_iter().enumerate() {
            let others =
                others(plan.image(barrier.image).format.aspects()).into_iter().filter(|other| *other != layout);
            // Nothing may become UNDEFINED.
            let others = others.filter(|other| side == 0 || *other != Layout::Undefined);
            edits.extend(others.map(|other| {
                let change = format!("{layout:?} → {other:?} of {place}, side {side}");
                Edit::new(Kind::LayoutChanged, change, move |plan| {
                    let barrier = barrier_of(plan, number, at);
                    *[&mut barrier.old_layout, &mut barrier.new_layout][side] = other;
                })
            }));
        }
    }
}

/// A range without its first or last mip level or layer, or without one of its planes.
fn smaller(range: Subresources) -> Vec<Subresources> {
    let mut all = Vec::new();
    if range.mips > 1 {
        all.push(Subresources { base_mip: range.base_mip + 1, mips: range.mips - 1, ..range });
        all.push(Subresources { mips: range.mips - 1, ..range });
    }
    if range.layers > 1 {
        all.push(Subresources { base_layer: range.base_layer + 1, layers: range.layers - 1, ..range });
        all.push(Subresources { layers: range.layers - 1, ..range });
    }
    let planes = range.aspects.iter().filter(|plane| range.aspects != *plane);
    all.extend(planes.map(|plane| Subresources { aspects: range.aspects - plane, ..range }));
    all
}

/// Layouts that an image with these planes may be in.
pub(super) fn others(aspects: Aspects) -> Vec<Layout> {
    let any = [
        Layout::Undefined,
        Layout::General,
        Layout::ShaderReadOnlyOptimal,
        Layout::TransferSrcOptimal,
        Layout::TransferDstOptimal,
    ];
    let own: &[Layout] = if aspects.contains(Aspects::COLOR) {
        &[Layout::ColorAttachmentOptimal, Layout::RenderingLocalReadKhr]
    } else {
        &[Layout::DepthStencilAttachmentOptimal, Layout::DepthStencilReadOnlyOptimal, Layout::DepthReadOnlyOptimal]
    };
    any.iter().chain(own).copied().collect()
}

fn waits(number: usize, step: &Step, edits: &mut Vec<Edit>) {
    for (at, wait) in step.waits.iter().enumerate() {
        let place = format!("wait {at} of step {number}");
        edits.push(Edit::new(Kind::WaitDropped, place.clone(), move |plan| {
            plan.steps[number].waits.remove(at);
        }));
        edits.push(Edit::new(Kind::WaitWeakened, format!("{place}, for a frame earlier"), move |plan| {
            plan.steps[number].waits[at].frames_ago += 1;
        }));
        edits.extend(wait.stages.iter().map(|stage| {
            Edit::new(Kind::WaitWeakened, format!("{stage:?} of {place}"), move |plan| {
                plan.steps[number].waits[at].stages -= stage;
            })
        }));
    }
}
