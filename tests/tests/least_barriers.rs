//! No barrier of a Plan can be left out: each one is left out in turn, and the brute-force judge, which shares no code with
//! the compiler or the checker, says what harm that does.
//!
//! Two kinds of barriers stay though the judge sees no harm without them, since it asks for no more than the memory model:
//! - between two writes that nothing reads in between, the second one is named too, as the specification's chapter on
//!   hazards asks and the validation layer demands; the memory model is content with the first one being available;
//! - what a frame promises to whoever comes after it is visible to the reads that it promises, though whoever comes
//!   has a barrier of its own.

use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{Estimated, Profile, SHIPPED_PROFILES};
use framewright_graph::plan::{Hazard, Plan};
use framewright_graph::vocabulary::Accesses;
use framewright_tests::happens_before::judge;
use framewright_tests::{frames, random_pipelines, shipped};
use std::collections::HashSet;

/// Random Plans that are looked at.
const SEEDS: u64 = 480;

/// Most passes of a random Plan.
const PASSES: u32 = 24;

/// Barriers that can be left out, and how many were.
#[derive(Debug, Default, PartialEq)]
struct Tally {
    looked_at: usize,
    between_writes: usize,
    promised: usize,
    others: Vec<String>,
}

/// What a barrier says.
struct Said {
    what: String,
    src_accesses: Accesses,
    dst_accesses: Accesses,
    hazards: Vec<Hazard>,
}

/// All barriers before a step, with the Plan without each.
fn without_each(plan: &Plan, step: usize) -> impl Iterator<Item = (Said, Plan)> + '_ {
    let images = plan.steps[step].image_barriers.iter().enumerate().map(move |(at, barrier)| {
        let mut less = plan.clone();
        less.steps[step].image_barriers.remove(at);
        let (src_accesses, dst_accesses) = (barrier.src_accesses, barrier.dst_accesses);
        let what = format!("step {step}: {barrier:?}");
        (Said { what, src_accesses, dst_accesses, hazards: vec![barrier.hazard] }, less)
    });
    let memory = plan.steps[step].memory_barriers.iter().enumerate().map(move |(at, barrier)| {
        let mut less = plan.clone();
        less.steps[step].memory_barriers.remove(at);
        let (src_accesses, dst_accesses) = (barrier.src_accesses, barrier.dst_accesses);
        let hazards = barrier.buffers.iter().map(|buffer| buffer.hazard).collect();
        let what = format!("step {step}: {barrier:?}");
        (Said { what, src_accesses, dst_accesses, hazards }, less)
    });
    images.chain(memory)
}

impl Tally {
    fn add(&mut self, name: &str, plan: &Plan) {
        let whole = judge(plan);
        assert_eq!(whole.harms, [], "{name}\n{}", plan.tree());
        for step in 0..plan.steps.len() {
            for (said, less) in without_each(plan, step) {
                self.looked_at += 1;
                if judge(&less) != whole {
                    continue;
                }
                if said.hazards.contains(&Hazard::Export) {
                    self.promised += 1;
                } else if !said.src_accesses.is_empty() && !said.dst_accesses.writes().is_empty() {
                    self.between_writes += 1;
                } else {
                    self.others.push(format!("{name}, {}", said.what));
                }
            }
        }
    }
}

#[test]
fn no_barrier_of_a_random_plan_can_be_left_out() {
    let mut tally = Tally::default();
    for seed in 0..SEEDS {
        let frame = random_pipelines::frame(seed, random_pipelines::passes(seed, PASSES));
        let order = [Order::Default, Order::LowMemory, Order::Random(seed)][seed as usize % 3];
        let device = Profile { local_read: seed.is_multiple_of(2), ..frames::device() };
        let plan = compile(&frame, &device, &mut Estimated(&device), &Options { order, ..Options::default() });
        tally.add(&format!("seed {seed}"), &plan.expect("random frames are legal"));
    }
    let Tally { looked_at, between_writes, promised, others } = tally;
    println!("of {looked_at}: {between_writes} between writes, {promised} promised, others:\n{}", others.join("\n"));
    assert!(looked_at > 3_000, "{looked_at}");
    assert_eq!((between_writes, promised, others.len()), (24, 8, 2), "{others:?}");
}

#[test]
fn no_barrier_of_a_shipped_pipeline_can_be_left_out_on_any_shipped_device() {
    let mut tally = Tally::default();
    let mut seen = HashSet::new();
    for (name, text) in SHIPPED_PROFILES {
        let profile = Profile::from_ron(text).expect("shipped profiles are read");
        for shipped::ShippedFrame { how, frame } in shipped::frames([333, 187]) {
            for queues in [true, false] {
                let options = Options { queues, ..Options::default() };
                let plan =
                    compile(&frame, &profile, &mut Estimated(&profile), &options).expect("shipped pipelines fit");
                if seen.insert(format!("{:?}", plan.steps)) {
                    tally.add(&format!("{how} on {name}, several queues: {queues}"), &plan);
                }
            }
        }
    }
    println!("{} barriers of {} Plans", tally.looked_at, seen.len());
    assert_eq!(tally, Tally { looked_at: tally.looked_at, between_writes: 32, ..Tally::default() });
    assert!(tally.looked_at > 1000, "{}", tally.looked_at);
}
