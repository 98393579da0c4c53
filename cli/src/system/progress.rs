//! Progress bars, on terminals alone.

use crate::system::text;
use framewright_graph::frame::Frame;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use std::time::Duration;

/// A progress bar over frames.
pub(crate) fn frames(frames: u32) -> ProgressBar {
    let bar = ProgressBar::new(frames.into());
    if let Ok(style) = ProgressStyle::with_template("drawing {wide_bar} {pos}/{len} frames, {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// A line that shows an activity and its duration, until it is dropped.
pub(crate) fn busy(what: &'static str) -> ProgressBar {
    let line = ProgressBar::new_spinner().with_finish(ProgressFinish::AndClear);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {wide_msg} {elapsed}") {
        line.set_style(style);
    }
    line.set_message(what);
    line.enable_steady_tick(Duration::from_millis(200));
    line
}

/// The activity of compiling a frame for a device.
pub(crate) fn compiling(frame: &Frame, device: &str) -> String {
    let passes = text::count(frame.passes.len(), "pass", "passes");
    format!("compiling {passes} for {}", text::escape(device))
}
