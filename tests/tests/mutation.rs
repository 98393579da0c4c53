//! Mistakes planted in Plans, one at a time: `verify` reports each of them, or the brute-force judge shows that it does no
//! harm. None may be missed; how many do no harm is pinned.
//!
//! What does no harm, kind by kind:
//! - a stage or access that something else says too: a logically earlier stage of the same mask, the read of an attachment
//!   that its scope clears or forgets anyway, a later barrier that makes the same write available;
//! - an old layout that keeps what nobody reads, instead of `UNDEFINED`;
//! - a load or store of contents that every later draw covers.

use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{Estimated, Profile, SHIPPED_PROFILES};
use framewright_graph::frame::{Frame, Work};
use framewright_tests::frames::device;
use framewright_tests::mutation::{Kind, Tally};
use framewright_tests::{random_pipelines, shipped};

/// Random frames, and how many passes each has at most.
const RANDOM: (u64, u32) = (300, 12);

fn add(tally: &mut Tally, name: &str, frame: &Frame, device: &Profile) {
    let plan = compile(frame, device, &mut Estimated(device), &Options::default())
        .unwrap_or_else(|wrong| panic!("{name}: {wrong:?}"));
    let discards = |name: &str| {
        let pass = frame.passes.iter().find(|pass| &*pass.name == name);
        pass.is_some_and(|pass| matches!(pass.work, Work::Draw { discards: true, .. }))
    };
    tally.add(name, &plan, &discards);
}

/// Prints what became of all mutants; none may have been missed, and so many did no harm.
#[track_caller]
fn check(tally: &Tally, harmless: &[(Kind, usize)]) {
    println!("{tally}");
    tally.harmless.iter().for_each(|(kind, change)| println!("harmless {kind:?} {change}"));
    assert!(tally.missed.is_empty(), "missed {}:\n{}", tally.missed.len(), tally.missed.join("\n"));
    assert_eq!(tally.harmless_counts(), harmless, "what does no harm has changed: look at each, then pin it");
}

#[test]
fn no_mistake_in_a_plan_of_a_shipped_pipeline_is_missed() {
    let profile = Profile::from_ron(SHIPPED_PROFILES[0].1).expect("shipped profiles are read");
    let mut tally = Tally::default();
    for shipped::ShippedFrame { how, frame } in shipped::frames([333, 187]) {
        add(&mut tally, &how, &frame, &profile);
    }
    check(&tally, &[]);
}

#[test]
fn no_mistake_in_a_plan_of_a_random_frame_is_missed() {
    let device = device();
    let mut tally = Tally::default();
    for seed in 0..RANDOM.0 {
        let passes = 1 + (seed % u64::from(RANDOM.1)) as u32;
        let frame = random_pipelines::frame(seed, passes);
        add(&mut tally, &format!("seed {seed}, {passes} passes"), &frame, &device);
    }
    check(&tally, &[]);
}
