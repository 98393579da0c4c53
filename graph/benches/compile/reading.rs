//! Reading pipeline files of a thousand and of a hundred thousand passes, and putting them together with their shaders'
//! interfaces.

use crate::files;
use crate::timing::{Timing, beside, microseconds};

pub(crate) fn run(timing: &Timing) {
    for (passes, goal) in [(1_000, 5), (100_000, 600)] {
        if timing.wants(&format!("reading {passes}")) {
            let text = files::written_out(passes);
            let time = timing.least(|| files::frame(text.clone()));
            let figure = beside(format!("{:.2}", microseconds(time) / 1000.0), Some(goal.to_string()));
            println!("\nreading a file of {passes} passes, {} KiB: {figure} ms", text.len() / 1024);
        }
    }
    if timing.wants("putting in 1000 again") {
        let mut expand = files::with_other_gains(files::of_setting(1_000));
        let mut gain = 0.5;
        let time = timing.least(|| {
            gain = 2.0 - gain;
            expand(gain)
        });
        let figure = beside(format!("{:.2}", microseconds(time) / 1000.0), Some("1.5".to_owned()));
        println!("\nputting in 1000 passes of fragments again, with another value of a setting: {figure} µs a pass");
    }
    for (passes, goal) in [(1_000, 20), (100_000, 2_000)] {
        if timing.wants(&format!("putting in {passes}")) {
            let text = files::of_fragments(passes);
            let time = timing.least(|| {
                let frame = files::frame(text.clone());
                assert_eq!(frame.passes.len(), passes as usize + 1, "every pass is put in");
                frame
            });
            let figure = beside(format!("{:.2}", microseconds(time) / 1000.0), Some(goal.to_string()));
            println!("\nputting in {passes} passes of fragments, each with an expression or two: {figure} ms");
        }
    }
}
