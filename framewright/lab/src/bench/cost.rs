//! The cost of frames that were drawn.

use crate::quantiles::median;
use crate::results::{Cost, PassCost, spread};
use crate::timings;
use framewright_graph::plan::Plan;
use framewright_vulkan::FrameReport;

/// The cost of a choice. `of_baseline` are the baseline's frames in the same turns.
pub(super) fn cost(plan: &Plan, frames: &[FrameReport], of_baseline: &[FrameReport]) -> Cost {
    of_frames(frames, of_baseline, [plan.totals.placed_bytes, plan.moved().sum()])
}

fn of_frames(frames: &[FrameReport], of_baseline: &[FrameReport], [transient_bytes, moved_bytes]: [u64; 2]) -> Cost {
    let timed = |frame: &&FrameReport| frame.milliseconds > 0.0;
    let both = frames.iter().zip(of_baseline).filter(|(frame, baseline)| timed(frame) && timed(baseline));
    let recording = frames.iter().map(|frame| frame.recording_milliseconds).collect();
    #[allow(clippy::cast_precision_loss, reason = "no frame has 2^53 fragments")]
    let fragments = frames.iter().filter_map(|frame| frame.fragment_invocations).map(|count| count as f64).collect();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the middle of counts")]
    let fragment_invocations = median(fragments).map(|middle| middle.round() as u64);
    Cost {
        gpu_milliseconds: spread(frames.iter().filter(timed).map(|frame| frame.milliseconds).collect()),
        gpu_ratio: spread(both.map(|(frame, baseline)| frame.milliseconds / baseline.milliseconds).collect()),
        recording_milliseconds: spread(recording).unwrap_or_default(),
        transient_bytes,
        moved_bytes,
        fragment_invocations,
    }
}

/// The cost of each pass of a choice.
pub(super) fn of_passes(plan: &Plan, frames: &[FrameReport]) -> Vec<PassCost> {
    let timed = frames.iter().filter(|frame| frame.milliseconds > 0.0);
    let timed: Vec<Vec<timings::Row>> = timed.map(|frame| timings::rows(plan, std::slice::from_ref(frame))).collect();
    let any = frames.last().map_or_else(Vec::new, |frame| timings::rows(plan, std::slice::from_ref(frame)));
    let pass = |(at, row): (usize, timings::Row)| PassCost {
        name: row.name,
        gpu_milliseconds: spread(timed.iter().filter_map(|rows| Some(rows.get(at)?.gpu_milliseconds)).collect()),
    };
    any.into_iter().enumerate().map(pass).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Spread;

    fn frame(milliseconds: f64, recording_milliseconds: f64, fragment_invocations: Option<u64>) -> FrameReport {
        let (recording_began, steps) = (None, Vec::new());
        FrameReport { milliseconds, recording_milliseconds, recording_began, fragment_invocations, steps }
    }

    #[test]
    fn a_cost_is_that_of_its_frames_and_the_ratio_is_theirs_to_those_of_the_baseline() {
        let frames = [frame(3.0, 0.25, Some(100)), frame(6.0, 0.75, Some(104)), frame(12.0, 0.5, Some(108))];
        let baseline = [frame(2.0, 9.0, Some(1)), frame(2.0, 9.0, Some(1)), frame(16.0, 9.0, Some(1))];
        let cost = of_frames(&frames, &baseline, [7, 8]);
        assert_eq!(cost.gpu_milliseconds, Some(Spread { median: 6.0, low: 4.5, high: 9.0 }));
        // 1.5, 3 and 0.75: by turns, and not that of the medians.
        assert_eq!(cost.gpu_ratio, Some(Spread { median: 1.5, low: 1.125, high: 2.25 }));
        assert_eq!(cost.recording_milliseconds, Spread { median: 0.5, low: 0.375, high: 0.625 });
        assert_eq!((cost.transient_bytes, cost.moved_bytes, cost.fragment_invocations), (7, 8, Some(104)));
    }

    #[test]
    fn a_device_without_timestamps_has_no_times() {
        let cost = of_frames(&[frame(0.0, 0.5, None)], &[frame(0.0, 0.5, None)], [7, 8]);
        assert_eq!((cost.gpu_milliseconds, cost.gpu_ratio, cost.fragment_invocations), (None, None, None));
        assert_eq!(of_frames(&[frame(2.0, 0.5, None)], &[frame(0.0, 0.5, None)], [7, 8]).gpu_ratio, None);
    }
}
