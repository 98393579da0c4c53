//! Barriers that nobody would miss: each barrier of a Plan is left out by itself, and each call, and the checker is asked.
//!
//! On one queue each call is missed, and no memory barrier covers what another barrier of a first use says. Other barriers are spare
//! where several of other images and buffers order the same work together, from frame to frame. They stay: whether they are spare
//! depends on all passes between two frames, and the calls that they stand in are there anyway.

use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues};
use framewright_graph::plan::{Hazard, ImageBarrier, MemoryBarrier, Plan, Role, Totals};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Layout, Sharing};
use framewright_tests::{frames, random_pipelines};
use std::ops::Range;

/// Plans of random frames on a device.
fn plans(device: &Profile, seeds: Range<u64>) -> impl Iterator<Item = (u64, Plan)> + '_ {
    seeds.map(|seed| {
        let frame = random_pipelines::frame(seed, random_pipelines::passes(seed, 24));
        let order = [Order::Default, Order::LowMemory, Order::Random(seed)][seed as usize % 3];
        let options = Options { order, ..Options::default() };
        (seed, compile(&frame, device, &mut MemoryEstimate(device), &options).expect("it is valid"))
    })
}

/// Whether the checker finds nothing wrong with a Plan without something. Sums are counted anew: a wrong sum gives nothing away.
fn does_without(plan: &Plan, leave_out: impl FnOnce(&mut Plan)) -> bool {
    let mut without = plan.clone();
    leave_out(&mut without);
    let Totals { transient_bytes, placed_bytes, live_peak_bytes, kept_bytes, .. } = plan.totals;
    let counted = Totals::count(&without.steps);
    without.totals = Totals { transient_bytes, placed_bytes, live_peak_bytes, kept_bytes, ..counted };
    verify(&without).is_empty()
}

/// The calls that could be left out, by step.
fn spare_calls(plan: &Plan) -> Vec<usize> {
    let calls = (0..plan.steps.len())
        .filter(|step| !plan.steps[*step].image_barriers.is_empty() || !plan.steps[*step].memory_barriers.is_empty());
    let spare = calls.filter(|step| {
        does_without(plan, |plan| {
            plan.steps[*step].image_barriers.clear();
            plan.steps[*step].memory_barriers.clear();
        })
    });
    spare.collect()
}

/// The barriers that could be left out, and how many there are.
fn spare_barriers(plan: &Plan) -> (usize, usize) {
    let (mut spare, mut all) = (0, 0);
    for (number, step) in plan.steps.iter().enumerate() {
        all += step.memory_barriers.len() + step.image_barriers.len();
        let memory = (0..step.memory_barriers.len()).filter(|at| {
            does_without(plan, |plan| {
                plan.steps[number].memory_barriers.remove(*at);
            })
        });
        let images = (0..step.image_barriers.len()).filter(|at| {
            does_without(plan, |plan| {
                plan.steps[number].image_barriers.remove(*at);
            })
        });
        spare += memory.count() + images.count();
    }
    (spare, all)
}

/// Whether a memory barrier says all that an image barrier says.
fn covers(memory: &MemoryBarrier, image: &ImageBarrier) -> bool {
    memory.src_stages.contains(image.src_stages)
        && memory.src_accesses.contains(image.src_accesses)
        && memory.dst_stages.contains(image.dst_stages)
        && memory.dst_accesses.contains(image.dst_accesses)
}

/// Barriers that do no more than wait for earlier frames, in a call with a memory barrier of buffers that says the same.
fn covered(plan: &Plan) -> Vec<String> {
    let mut covered = Vec::new();
    for step in &plan.steps {
        let of_buffers = || step.memory_barriers.iter().filter(|barrier| barrier.hand_overs.is_empty());
        let waits_alone = |barrier: &&ImageBarrier| {
            let before = match &plan.image(barrier.image).role {
                Role::Persistent { before, .. } | Role::External { before, .. } => before.layout,
                Role::Transient(_) => return false,
            };
            let stays = barrier.old_layout == barrier.new_layout;
            barrier.hazard == Hazard::FirstUse
                && barrier.after.is_none()
                && (stays || barrier.old_layout == Layout::Undefined && before == barrier.new_layout)
        };
        for barrier in step.image_barriers.iter().filter(waits_alone) {
            if of_buffers().any(|memory| covers(memory, barrier)) {
                covered.push(format!("{barrier:?}"));
            }
        }
    }
    covered
}

#[test]
fn every_call_of_barriers_on_one_queue_is_missed_and_no_memory_barrier_covers_another_barrier() {
    let device = frames::device();
    let mut wrong = Vec::new();
    for (seed, plan) in plans(&device, 0..400) {
        let (calls, covered) = (spare_calls(&plan), covered(&plan));
        if !calls.is_empty() || !covered.is_empty() {
            wrong.push(format!("seed {seed}: calls of steps {calls:?}, barriers {covered:?}\n{}", plan.tree()));
        }
    }
    assert!(wrong.is_empty(), "{} Plans:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn two_of_a_hundred_barriers_at_most_are_spare_and_one_of_a_hundred_calls_on_several_queues() {
    let queues = |sharing| Profile {
        queues: Queues { compute: true, transfer: true, sharing, wait_bytes: 0 },
        local_read: true,
        ..frames::device()
    };
    let devices = [frames::device(), queues(Sharing::Exclusive), queues(Sharing::Concurrent)];
    let (mut spare, mut all, mut calls, mut all_calls) = (0, 0, 0, 0);
    for (device, first) in devices.iter().zip([0, 10_000, 20_000]) {
        for (_, plan) in plans(device, first..first + 200) {
            let (some, of) = spare_barriers(&plan);
            (spare, all) = (spare + some, all + of);
            calls += spare_calls(&plan).len();
            all_calls += plan.totals.barrier_calls as usize;
        }
    }
    println!("{spare} of {all} barriers and {calls} of {all_calls} calls are spare");
    assert!(50 * spare <= all && 100 * calls <= all_calls, "{spare} of {all} barriers, {calls} of {all_calls} calls");
}
