//! Plans of any length and any size: no recursion, no overflow.

use crate::testing::graphs;
use crate::testing::hand_written_plans;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::plan::{Plan, Role};
use framewright_graph::verify::verify;

/// Nothing grows with the Plan but what stands on the heap: a stack of 128 KiB is enough for 100,000 passes.
#[test]
fn a_hundred_thousand_passes_are_checked_on_a_small_stack() {
    let device = graphs::device();
    let plan = compile(&graphs::chain(100_000), &device, &mut MemoryEstimate(&device), &Options::default());
    let mut plan = plan.expect("a chain is valid");
    let check = |plan: &Plan| {
        std::thread::scope(|scope| {
            let checker = std::thread::Builder::new().stack_size(128 << 10);
            let said = checker.spawn_scoped(scope, || verify(plan)).expect("a thread can be had").join();
            said.expect("nothing panics")
        })
    };
    assert_eq!(check(&plan), []);
    let last = plan.steps.iter().rposition(|step| !step.image_barriers.is_empty()).expect("there are barriers");
    plan.steps[last].image_barriers.clear();
    assert_ne!(check(&plan), []);
}

/// The largest images that there are, of which no two fit into 64 bits of bytes.
#[test]
fn sums_of_the_largest_images_do_not_overflow() {
    for (name, mut plan) in hand_written_plans::all() {
        for image in &mut plan.images {
            (image.extent, image.samples, image.layers) = ([16384, 16384, 1], 16, 2048);
            if let Role::Transient(placement) = &mut image.role {
                (placement.offset, placement.bytes) = (u64::MAX - 4096, u64::MAX / 2);
            }
        }
        let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
        assert!(!said.is_empty(), "{name} is accepted");
    }
}

/// A Plan as text, changed by hand: what is still a Plan is judged like any other.
#[test]
fn a_plan_that_was_edited_as_text_is_judged() {
    let [(_, plan), ..] = hand_written_plans::all();
    let text = plan.to_json().expect("it has a JSON form");
    let edits = [
        (
            "\"src_accesses\": \"COLOR_ATTACHMENT_WRITE\"",
            "\"src_accesses\": \"\"",
            "but no barrier makes that write available",
        ),
        ("\"store\": \"STORE\"", "\"store\": \"DONT_CARE\"", "doesn't store its contents"),
        ("\"offset\": 98304", "\"offset\": 0", "takes memory"),
        ("\"load\": \"CLEAR\"", "\"load\": \"LOAD\"", "has a clear value exactly if its load is CLEAR"),
        ("\"queue\": \"GRAPHICS\"", "\"queue\": \"TRANSFER\"", "does what TRANSFER can't"),
    ];
    for (from, to, expected) in edits {
        let places = text.matches(from).count();
        assert!(places > 0, "{from}");
        let said: Vec<String> = (0..places)
            .flat_map(|place| {
                let (at, _) = text.match_indices(from).nth(place).expect("it was counted");
                let edited = [&text[..at], to, &text[at + from.len()..]].concat();
                match Plan::from_json(&edited) {
                    Ok(plan) => verify(&plan).iter().map(ToString::to_string).collect(),
                    Err(error) => vec![error.to_string()],
                }
            })
            .collect();
        assert!(said.iter().any(|one| one.contains(expected)), "{from} → {to}: {said:#?}");
    }
}
