//! Plans with one mistake each: `verify` reports the mistake, or the brute-force judge shows that it does no harm.
//!
//! Every mistake of every kind of [`framewright_tests::mutation::Kind`] is planted in the Plans of all shipped pipelines in
//! all their variants, of the frames after incidents, of random frames on devices with one queue and with three, and in
//! Plans written by hand. How many of each kind are caught, harmless and missed is printed. None may be missed. Where every Plan is
//! tried, the numbers of harmless ones are pinned.

use crate::hand_written_plans;
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues};
use framewright_graph::frame::Frame;
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::Sharing;
use framewright_tests::mutation::{Kind, Tally};
use framewright_tests::{frames, incidents, random_pipelines, shipped, sweep};
use std::collections::HashSet;
use std::path::Path;

/// How a changed number of harmless mistakes is accepted.
const ACCEPT: &str = "INSTA_UPDATE=always cargo test -p framewright-tests --test suite mutation";

/// Seeds of random frames for each device.
const SEEDS: u64 = 200;

/// Most passes of a random frame.
const PASSES: u32 = 24;

fn compiled(name: &str, frame: &Frame, device: &Profile, order: Order) -> Plan {
    let options = Options { order, ..Options::default() };
    let plan = compile(frame, device, &mut MemoryEstimate(device), &options);
    plan.unwrap_or_else(|wrong| panic!("{name}: {:?}", wrong.iter().map(|wrong| &wrong.message).collect::<Vec<_>>()))
}

/// A device with all queues, and local reads.
fn with_queues(sharing: Sharing) -> Profile {
    let queues = Queues { compute: true, transfer: true, sharing, wait_bytes: 0 };
    Profile { queues, local_read: true, ..frames::device() }
}

/// A Plan, and the name of its frame.
type Named = (String, Plan);

/// The Plans of all shipped pipelines, each one once.
fn of_shipped_pipelines() -> Vec<Named> {
    let (mut seen, mut plans) = (HashSet::new(), Vec::new());
    for device in [frames::device(), with_queues(Sharing::Exclusive)] {
        for shipped::ShippedFrame { how, frame } in shipped::frames([333, 187]) {
            let plan = compiled(how, frame, &device, Order::Default);
            if seen.insert(format!("{:?}", plan.steps)) {
                plans.push((how.to_owned(), plan));
            }
        }
    }
    plans
}

fn of_incidents() -> Vec<Named> {
    let mut plans = Vec::new();
    for (name, frame) in incidents::all() {
        for device in [frames::device(), with_queues(Sharing::Exclusive)] {
            plans.push((name.clone(), compiled(&name, &frame, &device, Order::Default)));
        }
    }
    plans
}

fn of_random_frames() -> Vec<Named> {
    let mut plans = Vec::new();
    let devices = [frames::device(), with_queues(Sharing::Exclusive), with_queues(Sharing::Concurrent)];
    for (device, first) in devices.iter().zip([0, 10_000, 20_000]) {
        for seed in first..first + SEEDS {
            let frame = random_pipelines::frame(seed, random_pipelines::passes(seed, PASSES));
            let order = [Order::Default, Order::LowMemory, Order::Random(seed)][seed as usize % 3];
            let name = format!("random frame {seed}");
            let plan = compiled(&name, &frame, device, order);
            plans.push((name, plan));
        }
    }
    plans
}

#[test]
fn every_mistake_that_harms_is_reported() {
    let mut tally = Tally::default();
    let hand_written = hand_written_plans::all().into_iter().map(|(name, plan)| (name.to_owned(), plan));
    let plans = [of_shipped_pipelines(), of_incidents(), hand_written.collect(), of_random_frames()];
    for (name, plan) in sweep::of("Plans with a mistake", plans.into_iter().flatten().collect(), 240) {
        tally.add(&name, &plan);
    }
    println!("{tally}");
    assert!(tally.missed.is_empty(), "missed:\n{}", tally.missed.join("\n"));
    if !sweep::is_long() {
        return;
    }
    for kind in Kind::ALL {
        assert!(tally.of(kind)[0] > 0, "no Plan offers room for {kind:?}:\n{tally}");
    }
    let harmless = tally.harmless_counts();
    let lines: Vec<String> = harmless.iter().map(|(kind, count)| format!("{kind:?} {count}")).collect();
    insta::with_settings!({
        snapshot_path => Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/mutation"),
        prepend_module_to_snapshot => false,
        omit_expression => true,
        description => format!("mistakes that do no harm, by kind; accept with {ACCEPT}"),
    }, { insta::assert_snapshot!("harmless", lines.join("\n")) });
}
