//! `cargo bench --package framewright-vulkan --bench recording`: what it takes to record and submit frames, beside the same frames
//! written by hand in raw Vulkan, with the goals of the project in brackets.
//!
//! Both record the same Plan in turns. Before, the pictures of both are compared. The least time of each counts, since other work
//! on the machine only adds; medians stand beside it. With the same frame by hand on both sides, ratios up to 1.4 were seen,
//! depending on which side was made first. So both sides are made anew several times, and take turns in being first.
//! `-- chain` measures only what has this in its name; `-- --short` draws each frame twice, to see that it runs. The frames by
//! hand are here and not in the crate `framewright-tests`, since only this package may be unsafe.

mod by_hand;
mod ours;
mod workload;

use by_hand::ByHand;
use framewright_vulkan::{Device, DeviceOptions};
use ours::Ours;
use std::time::{Duration, Instant};
use workload::{Workload, chain, deferred, objects};

/// A frame: its name, how often it is drawn, what is drawn, and the goal for encoding and submitting.
type Row = (&'static str, u32, fn() -> Workload, f64);

/// A part of a frame's time: its name, what it is, and its goal.
type Part = (&'static str, fn(&Times) -> Duration, Option<f64>);

const ROWS: [Row; 4] = [
    ("25 full-screen passes, 256×256", 400, || chain(25, 256), 1.15),
    ("deferred, 25 passes", 400, deferred, 1.15),
    ("500 passes, 16×16", 200, || chain(500, 16), 1.15),
    ("1,000 objects", 200, || objects(1_000), 1.2),
];
/// The goal for the time on the device.
const GPU_GOAL: f64 = 1.02;

/// How often both sides are made anew.
const ROUNDS: u32 = 6;

/// The times of a frame.
#[derive(Clone, Copy)]
struct Times {
    encode: Duration,
    submit: Duration,
    /// From the submission until the device is done.
    device: Duration,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let short = arguments.iter().any(|argument| argument == "--short");
    let wanted: Vec<&String> = arguments.iter().filter(|argument| !argument.starts_with('-')).collect();
    let device = Device::open(&DeviceOptions::default()).expect("a device");
    println!("{}, {}; least (median) of each, microseconds", device.summary().name, device.summary().driver);
    println!("| frame | part | ours | by hand | ratio | goal |");
    println!("|---|---|---|---|---|---|");
    for (name, frames, workload, goal) in ROWS {
        if wanted.is_empty() || wanted.iter().any(|wanted| name.contains(&***wanted)) {
            measure(&device, name, if short { 2 } else { frames }, &workload(), goal);
        }
    }
}

fn measure(device: &Device, name: &str, frames: u32, workload: &Workload, goal: f64) {
    let plan = workload.plan(device);
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..ROUNDS {
        // Which side is made first makes a difference.
        let ours_first = round % 2 == 0;
        let made = ours_first.then(|| Ours::new(device, workload, &plan));
        let mut by_hand = ByHand::new(device, workload, &plan);
        let mut ours = made.unwrap_or_else(|| Ours::new(device, workload, &plan));
        // The first frames fill what later ones use again.
        for _ in 0..3 {
            frame_of_ours(&mut ours);
            frame_by_hand(&mut by_hand);
        }
        let pictures = (ours.executor.read(0).expect("a picture").bytes, by_hand.read());
        assert!(pictures.0 == pictures.1, "{name}: the pictures differ");
        assert!(
            pictures.0.chunks_exact(4).any(|texel| texel != &pictures.0[..4]),
            "{name}: the picture has one colour"
        );
        for frame in 0..frames.div_ceil(ROUNDS) as usize {
            // Being first might make a difference, so the sides take turns.
            for side in [frame % 2, 1 - frame % 2] {
                settle();
                let drawn = if side == 0 { frame_of_ours(&mut ours) } else { frame_by_hand(&mut by_hand) };
                times[side].push(drawn);
            }
        }
    }
    let parts: [Part; 4] = [
        ("encode", |it| it.encode, None),
        ("submit", |it| it.submit, None),
        ("encode + submit", |it| it.encode + it.submit, Some(goal)),
        ("device", |it| it.device, Some(GPU_GOAL)),
    ];
    for (part, of, goal) in parts {
        let [ours, hand] = [0, 1].map(|side| {
            let mut all: Vec<f64> = times[side].iter().map(|times| of(times).as_secs_f64() * 1e6).collect();
            all.sort_by(f64::total_cmp);
            (all[0], all[all.len() / 2])
        });
        let goal = goal.map_or(String::new(), |goal| format!("[{goal}]"));
        let (least, median) = (ours.0 / hand.0, ours.1 / hand.1);
        println!(
            "| {name} | {part} | {:.1} ({:.1}) | {:.1} ({:.1}) | {least:.2} ({median:.2}) | {goal} |",
            ours.0, ours.1, hand.0, hand.1
        );
    }
}

/// Lets the driver's threads end what they do after the end of a frame, so that neither side is measured beside it.
fn settle() {
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_micros(200) {
        std::hint::spin_loop();
    }
}

fn frame_of_ours(Ours { executor, source }: &mut Ours) -> Times {
    let begun = Instant::now();
    let frame = executor.submit(source).expect("a frame");
    let submitted = begun.elapsed();
    executor.wait(frame).expect("a frame");
    let all = begun.elapsed();
    let report = executor.report(frame).expect("its report");
    let encode = Duration::from_secs_f64(report.recording_milliseconds / 1e3);
    Times { encode, submit: submitted - encode, device: all - encode }
}

fn frame_by_hand(by_hand: &mut ByHand) -> Times {
    let begun = Instant::now();
    by_hand.encode();
    let encode = begun.elapsed();
    by_hand.submit();
    let submitted = begun.elapsed();
    by_hand.wait();
    Times { encode, submit: submitted - encode, device: begun.elapsed() - encode }
}
