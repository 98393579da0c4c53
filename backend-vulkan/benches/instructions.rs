//! `cargo bench --workspace --profile test --bench dev_instructions`: the instructions that recording and submitting a frame
//! takes, beside the committed ones. It fails if a frame takes 3 % more, and names the command that accepts the new figures. It
//! needs valgrind and a device. The profile `dev`, and that of the whole workspace, counts what tests build anyway.
//!
//! The third frame and all later ones are alike: the fourth is counted. Only this program counts, and not the Vulkan driver, the
//! loader or the C library, so that the figures in `instructions.txt` are the same with each version of these.

#[allow(dead_code, reason = "each bench uses a part of it")]
#[path = "../../graph/benches/shared/counts.rs"]
mod counts;
#[path = "recording/ours.rs"]
mod ours;
#[path = "recording/workload.rs"]
mod workload;

use counts::{Code, Guard, counted};
use framewright_vulkan::{Blame, Device, DeviceOptions};
use ours::Ours;
use std::error::Error;
use std::process::ExitCode;
use workload::Workload;

/// The figures, and how new ones are accepted.
const GUARD: Guard = Guard {
    figures: concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.txt"),
    accept: "FRAMEWRIGHT_ACCEPT=backend-vulkan cargo bench --workspace --profile test --bench dev_instructions",
};

/// A row of the table, and the frame that is recorded for it.
const ROWS: [(&str, fn()); 3] = [
    ("25 full-screen passes", || record(&workload::chain(25, 8))),
    ("deferred", || record(&workload::deferred())),
    ("1000 objects", || record(&workload::objects(1_000))),
];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    match Device::open(&DeviceOptions::default()) {
        Err(error) if error.blame() == Blame::Environment && std::env::var_os("CI").is_none() => {
            println!("skipped: {error}");
            Ok(ExitCode::SUCCESS)
        }
        Err(error) => Err(error.into()),
        Ok(_) => GUARD.run_rows(&ROWS, Code::CountedOwn),
    }
}

fn record(workload: &Workload) {
    let device = Device::open(&DeviceOptions::default()).expect("a device");
    let plan = workload.plan(&device);
    let Ours { mut executor, mut source } = Ours::new(&device, workload, &plan);
    for _ in 0..3 {
        executor.frame(&mut source).expect("a frame");
    }
    let frame = counted(|| executor.submit(&mut source));
    executor.wait(frame.expect("a frame")).expect("a frame");
}
