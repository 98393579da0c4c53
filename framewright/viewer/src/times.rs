//! The times of the last frames of a Plan.

use framewright_lab::quantiles::quantile;
use framewright_vulkan::{Device, FrameReport, StepReport};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The reports of the last frames of one Plan: as soon as there are [`LastFrames::MOST`], the oldest makes room.
#[derive(Debug, Default)]
pub struct LastFrames {
    device: Option<TimedDevice>,
    reports: VecDeque<FrameReport>,
}

/// The device that times were measured on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TimedDevice {
    /// Its own name.
    pub name: String,
    /// Whether it is the processor, which a software driver draws on: its times tell parts of a frame apart, and nothing of a GPU.
    pub is_processor: bool,
}

/// Times of a Plan, over its last frames, in milliseconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// How many frames they are of.
    pub frames: usize,
    /// The device; `None`: nobody said.
    pub device: Option<TimedDevice>,
    /// Of the device, for a frame.
    pub frame: Spread,
    /// Of the thread that records a frame.
    pub recording: Spread,
    /// Of the device, step by step.
    pub steps: Vec<StepTimes>,
}

/// Times of a step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StepTimes {
    /// Those of the whole step, its barriers included.
    #[serde(flatten)]
    pub step: Spread,
    /// Those of its passes, in their order. A device that draws in tiles can't tell the passes of one scope apart.
    pub passes: Vec<Spread>,
}

/// Milliseconds over several frames.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The one in the middle.
    pub median: f64,
    /// A tenth of the frames took less.
    pub low: f64,
    /// A tenth of the frames took more.
    pub high: f64,
}

impl LastFrames {
    /// The number of frames that are kept.
    pub const MOST: usize = 300;

    /// Room for those of a device.
    #[must_use]
    pub fn on(device: &Device) -> LastFrames {
        LastFrames { device: Some(TimedDevice::of(device)), reports: VecDeque::new() }
    }

    /// Keeps the report of a frame.
    pub fn add(&mut self, report: FrameReport) {
        if self.reports.len() == LastFrames::MOST {
            self.reports.pop_front();
        }
        self.reports.push_back(report);
    }

    /// Forgets all: another Plan is drawn from now on.
    pub fn clear(&mut self) {
        self.reports.clear();
    }

    /// Their times; `None` before the first frame, and of a device that measures none.
    #[must_use]
    pub fn times(&self) -> Option<Times> {
        times(self.device.clone(), self.reports.iter())
    }
}

impl Times {
    /// Those of frames that `device` drew; `None` if it measures none.
    #[must_use]
    pub fn of(device: &Device, frames: &[FrameReport]) -> Option<Times> {
        times(Some(TimedDevice::of(device)), frames.iter())
    }
}

/// The times of `frames`; `None` of none, and of a device that measures none.
fn times<'r>(
    device: Option<TimedDevice>,
    frames: impl ExactSizeIterator<Item = &'r FrameReport> + DoubleEndedIterator + Clone,
) -> Option<Times> {
    let last = frames.clone().next_back().filter(|report| report.milliseconds > 0.0)?;
    let over = |value: &dyn Fn(&FrameReport) -> Option<f64>| Spread::of(frames.clone().filter_map(value));
    let step = |(at, step): (usize, &StepReport)| StepTimes {
        step: over(&|report| Some(report.steps.get(at)?.milliseconds)),
        passes: (0..step.passes.len())
            .map(|pass| over(&|report| Some(report.steps.get(at)?.passes.get(pass)?.milliseconds)))
            .collect(),
    };
    Some(Times {
        frames: frames.len(),
        device,
        frame: over(&|report| Some(report.milliseconds)),
        recording: over(&|report| Some(report.recording_milliseconds)),
        steps: last.steps.iter().enumerate().map(step).collect(),
    })
}

impl TimedDevice {
    /// A device as times name it.
    #[must_use]
    pub fn of(device: &Device) -> TimedDevice {
        let summary = device.summary();
        TimedDevice { name: summary.name.clone(), is_processor: summary.kind == "cpu" }
    }
}

impl Spread {
    /// That of `times`; zeros of none.
    fn of(times: impl Iterator<Item = f64>) -> Spread {
        let mut sorted: Vec<f64> = times.collect();
        sorted.sort_by(f64::total_cmp);
        let at = |share| quantile(&sorted, share).unwrap_or_default();
        Spread { median: at(0.5), low: at(0.1), high: at(0.9) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(milliseconds: f64) -> FrameReport {
        let step = StepReport { milliseconds: milliseconds / 2.0, began: None, ran: true, passes: Vec::new() };
        let (recording_began, fragment_invocations) = (None, None);
        FrameReport {
            milliseconds,
            recording_milliseconds: 0.25,
            recording_began,
            fragment_invocations,
            steps: vec![step],
        }
    }

    #[test]
    fn lv_2_the_last_frames_have_a_middle_and_tenths() {
        let mut frames = LastFrames::default();
        assert_eq!(frames.times(), None);
        (1..=400).for_each(|at| frames.add(frame(f64::from(at))));
        let times = frames.times().expect("there are frames");
        // Of 101 to 400.
        let near = |one: Spread, other: [f64; 3]| {
            [one.median, one.low, one.high].iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-9)
        };
        assert!(times.frames == 300 && near(times.frame, [250.5, 130.9, 370.1]), "{times:?}");
        assert!(near(times.steps[0].step, [125.25, 65.45, 185.05]), "{times:?}");
        assert_eq!(times.recording, Spread { median: 0.25, low: 0.25, high: 0.25 });
        frames.clear();
        frames.add(frame(3.0));
        assert_eq!(frames.times().expect("one").frame, Spread { median: 3.0, low: 3.0, high: 3.0 });
    }

    #[test]
    fn lv_2_times_are_the_same_after_json() {
        let mut frames = LastFrames {
            device: Some(TimedDevice { name: "d".to_owned(), is_processor: true }),
            ..LastFrames::default()
        };
        frames.add(frame(3.5));
        let times = frames.times().expect("one");
        let json = serde_json::to_string(&times).expect("JSON");
        assert_eq!(serde_json::from_str::<Times>(&json).expect("times"), times, "{json}");
    }

    #[test]
    fn a_device_without_timestamps_has_no_times() {
        let mut frames = LastFrames::default();
        frames.add(frame(0.0));
        assert_eq!(frames.times(), None);
    }
}
