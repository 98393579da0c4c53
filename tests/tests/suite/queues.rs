//! Random frames on devices with queues for compute and transfer: `verify` and the brute-force judge find nothing in their
//! Plans, and what leaves them is made as on one queue.

use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues, SHIPPED_PROFILES};
use framewright_graph::frame::Frame;
use framewright_graph::plan::{Plan, Queue};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Sharing;
use framewright_tests::happens_before::judge;
use framewright_tests::mutation::Tally;
use framewright_tests::random_pipelines;

/// A desktop GPU with these queues.
fn device(compute: bool, transfer: bool, sharing: Sharing) -> Profile {
    let (_, text) = SHIPPED_PROFILES.iter().find(|(name, _)| *name == "lavapipe").expect("it is shipped");
    Profile {
        queues: Queues { compute, transfer, sharing, wait_bytes: 0 },
        ..Profile::from_ron(text).expect("it is sound")
    }
}

fn plan(frame: &Frame, device: &Profile, options: &Options) -> Plan {
    compile(frame, device, &mut MemoryEstimate(device), options).expect("random frames are valid")
}

/// Steps beside graphics, waits, images that change hands.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
struct Seen {
    compute: usize,
    transfer: usize,
    waits: usize,
    waits_for_earlier_frames: usize,
    releases: usize,
    concurrent: usize,
}

impl Seen {
    fn add(&mut self, plan: &Plan) {
        let on = |queue| plan.steps.iter().filter(|step| step.queue == queue).count();
        let waits = || plan.steps.iter().flat_map(|step| &step.waits);
        self.compute += on(Queue::Compute);
        self.transfer += on(Queue::Transfer);
        self.waits += waits().count();
        self.waits_for_earlier_frames += waits().filter(|wait| wait.frames_ago > 0).count();
        self.releases += plan.steps.iter().map(|step| step.releases.len()).sum::<usize>();
        self.concurrent += plan.images.iter().filter(|image| image.sharing == Sharing::Concurrent).count();
    }
}

fn check(seeds: std::ops::Range<u64>, most: u32, judged: bool) -> Seen {
    let mut seen = Seen::default();
    let devices = [
        device(true, true, Sharing::Exclusive),
        device(true, true, Sharing::Concurrent),
        device(true, false, Sharing::Exclusive),
        device(false, true, Sharing::Concurrent),
    ];
    for seed in seeds {
        let frame = random_pipelines::frame(seed, random_pipelines::passes(seed, most));
        for (number, device) in devices.iter().enumerate() {
            for order in [Order::File, Order::Default, Order::LowMemory, Order::Random(seed)] {
                let alias = seed % 4 != u64::from(number as u32);
                let options = Options { alias, order, ..Options::default() };
                let [one, several] = [false, true].map(|queues| plan(&frame, device, &Options { queues, ..options }));
                seen.add(&several);
                let what = format!("seed {seed}, device {number}, {options:?}");
                assert_eq!(verify(&one), [], "{what}\n{}", one.tree());
                if several == one {
                    continue;
                }
                assert_eq!(verify(&several), [], "{what}\n{}", several.tree());
                if judged {
                    let [before, after] = [&one, &several].map(judge);
                    assert_eq!(before.harms, [], "{what}\n{}", one.tree());
                    assert_eq!(after.harms, [], "{what}\n{}", several.tree());
                    assert!(after.outcome == before.outcome, "{what}: something else is made\n{}", several.tree());
                }
            }
        }
    }
    seen
}

#[test]
fn plans_for_several_queues_are_right() {
    let seen = check(0..1000, 40, false);
    println!("{seen:?}");
    let Seen { compute, transfer, waits, waits_for_earlier_frames, releases, concurrent } = seen;
    let rare = [compute, transfer, waits, waits_for_earlier_frames, releases, concurrent].into_iter().min();
    assert!(rare > Some(500), "hardly ever: {seen:?}");
}

#[test]
fn plans_for_several_queues_do_no_harm_and_make_what_plans_for_one_make() {
    let seen = check(5000..5400, 14, true);
    println!("{seen:?}");
    assert!(seen.waits > 300 && seen.releases > 50 && seen.concurrent > 50, "hardly ever: {seen:?}");
}

/// Every mistake that can be planted in Plans for several queues: no semaphore, no half of a transfer goes without notice.
#[test]
fn no_mistake_in_plans_for_several_queues_is_missed() {
    let (mut tally, mut plans_of) = (Tally::default(), [0; 2]);
    for sharing in [Sharing::Exclusive, Sharing::Concurrent] {
        let device = device(true, true, sharing);
        let plans = (0..200).map(|seed| (seed, plan(&random_pipelines::frame(seed, 6), &device, &Options::default())));
        for (seed, plan) in plans.filter(|(_, plan)| plan.totals.waits > 1).take(6) {
            tally.add(&format!("seed {seed}, {sharing:?}"), &plan);
            plans_of[usize::from(sharing == Sharing::Concurrent)] += 1;
        }
    }
    assert_eq!(plans_of, [6, 6], "hardly ever do queues wait");
    println!("{tally}");
    assert_eq!(tally.missed, Vec::<String>::new());
}
