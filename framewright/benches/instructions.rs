//! `cargo bench --workspace --profile test --bench dev_instructions`: the instructions that planning takes after a setting was changed,
//! beside the committed ones. It fails if they are 3 % more, and names the command that accepts the new figures. It needs valgrind and a
//! device.
//!
//! The setting is a value of the Plan, so no image is made anew. Only this program counts, and not the Vulkan driver, the loader or the C
//! library. `instructions.txt` holds the committed figures.

#[allow(dead_code, reason = "each bench uses a part of it")]
#[path = "../../graph/benches/shared/counts.rs"]
mod counts;

use counts::{Code, Guard, counted};
use framewright::{Change, Renderer, RendererOptions};
use framewright_vulkan::{Blame, Device, DeviceOptions};
use std::error::Error;
use std::process::ExitCode;

/// The figures, and how new ones are accepted.
const GUARD: Guard = Guard {
    figures: concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.txt"),
    accept: "FRAMEWRIGHT_ACCEPT=framewright cargo bench --workspace --profile test --bench dev_instructions",
};

/// A row of the table, and the pipeline and setting that it is about. A larger pipeline takes valgrind minutes to make.
const ROWS: [(&str, fn()); 1] = [("auto_exposure, another value", || prepare("auto_exposure", "key", ["0.2", "0.3"]))];

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

/// Prepares a frame after one with another value of a setting.
fn prepare(pipeline: &str, setting: &str, values: [&str; 2]) {
    let device = Device::open(&DeviceOptions::default()).expect("a device");
    let mut renderer = Renderer::open(&device, pipeline, RendererOptions::default()).expect("a shipped pipeline");
    for value in [values[0], values[1]] {
        renderer.set(setting, value).expect("a value of the setting");
        renderer.prepare().expect("a shipped pipeline");
    }
    renderer.set(setting, values[0]).expect("a value of the setting");
    let change = counted(|| renderer.prepare().map(|prepared| prepared.change));
    assert_eq!(change.expect("a shipped pipeline"), Change::Values);
}
