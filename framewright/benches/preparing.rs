//! `cargo bench --package framewright --bench preparing`: how long [`Renderer::prepare`] takes after a setting was changed that is a value
//! of the Plan, for each pass of a shipped pipeline. It needs a device. Blocks of parameters are made anew; images aren't.
//!
//! The time is the least of many runs: other work on the machine only adds. `-- --short` runs each once, to see that it runs.

use framewright::{Change, Renderer, RendererOptions};
use framewright_vulkan::{Device, DeviceOptions};
use std::error::Error;
use std::time::{Duration, Instant};

/// Pipelines, a setting of each, and two of its values.
const ROWS: [(&str, &str, [&str; 2]); 5] = [
    ("forward", "white_point", ["50", "60"]),
    ("auto_exposure", "key", ["0.2", "0.3"]),
    ("image_quality", "white_point", ["10", "30"]),
    ("post", "bloom", ["0.1", "0.2"]),
    ("deferred", "white_point", ["10", "30"]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let runs = if std::env::args().any(|argument| argument == "--short") { 1 } else { 500 };
    let device = Device::open(&DeviceOptions::default())?;
    println!("| pipeline | setting | passes | µs | µs a pass |\n|---|---|---|---|---|");
    for (pipeline, setting, values) in ROWS {
        let mut renderer = Renderer::open(&device, pipeline, RendererOptions::default())?;
        let passes = renderer.prepare()?.plan.steps.iter().map(|step| step.work.passes().len()).sum::<usize>();
        let mut least = Duration::MAX;
        for value in values.iter().cycle().take(runs + 1) {
            renderer.set(setting, value)?;
            let start = Instant::now();
            let change = renderer.prepare()?.change;
            least = least.min(start.elapsed());
            assert_eq!(change, Change::Values, "{pipeline}: {setting}");
        }
        let least = least.as_secs_f64() * 1e6;
        println!("| {pipeline} | `{setting}` | {passes} | {least:.1} | {:.2} |", least / passes as f64);
    }
    Ok(())
}
