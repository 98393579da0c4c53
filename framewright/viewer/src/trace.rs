//! Frames as a trace: JSON in the Trace Event Format, which Perfetto and Chrome's trace viewer open.
//!
//! The host and the device are two processes of the trace, each with a clock of its own. The host's begins with the first frame, the
//! device's where the host has recorded the first frame.

use crate::times::TimedDevice;
use framewright_graph::plan::{Placement, Plan, Queue, Role, Step};
use framewright_graph::vulkan::name_of;
use framewright_vulkan::{FrameReport, StepReport};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
use std::time::Instant;

/// The process of the host in a trace, and its one track.
const HOST: Track = Track { process: 1, thread: 1 };
/// The process of the device. Each queue has a track.
const DEVICE: u32 = 2;

/// A frame that was drawn and waited for.
#[derive(Debug, Clone)]
pub struct TracedFrame {
    /// When the host began it.
    pub began: Instant,
    /// When the host knew that the device was done with it.
    pub ended: Instant,
    /// Its times.
    pub report: FrameReport,
}

/// The whole file.
#[derive(Serialize)]
struct Trace {
    #[serde(rename = "displayTimeUnit")]
    unit: &'static str,
    #[serde(rename = "traceEvents")]
    events: Vec<Event>,
}

/// An entry of the list of a trace.
#[derive(Serialize)]
struct Event {
    name: String,
    /// `X`: something that takes a while; `C`: a counter's value; `M`: a name.
    ph: &'static str,
    #[serde(flatten)]
    track: Track,
    ts: Time,
    #[serde(skip_serializing_if = "Option::is_none")]
    dur: Option<Time>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    args: BTreeMap<&'static str, serde_json::Value>,
}

/// Where an entry stands.
#[derive(Clone, Copy, Serialize)]
struct Track {
    #[serde(rename = "pid")]
    process: u32,
    #[serde(rename = "tid")]
    thread: u32,
}

/// Nanoseconds. A trace has microseconds, with digits behind the point.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Time(u64);

impl Serialize for Time {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[allow(clippy::cast_precision_loss, reason = "traces are far shorter than 2^53 ns")]
        serializer.serialize_f64(self.0 as f64 / 1e3)
    }
}

impl Time {
    fn of_milliseconds(milliseconds: f64) -> Time {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "durations are positive, and short")]
        Time((milliseconds * 1e6).round() as u64)
    }

    fn between(from: Instant, to: Instant) -> Time {
        Time(u64::try_from(to.saturating_duration_since(from).as_nanos()).unwrap_or(u64::MAX))
    }

    fn plus(self, other: Time) -> Time {
        Time(self.0.saturating_add(other.0))
    }

    fn minus(self, other: Time) -> Time {
        Time(self.0.saturating_sub(other.0))
    }
}

/// The trace of `frames`, which `plan` was drawn in, as JSON. Frames whose steps no device timed have the host's part alone.
///
/// # Errors
/// None that happens.
pub fn trace(plan: &Plan, device: &TimedDevice, frames: &[TracedFrame]) -> serde_json::Result<String> {
    let mut events = vec![
        named("process_name", Track { thread: 0, ..HOST }, "host"),
        named("thread_name", HOST, "frames"),
        named("process_name", Track { process: DEVICE, thread: 0 }, &format!("device: {}", device.name)),
    ];
    let queues = queues(plan);
    for (at, queue) in queues.iter().enumerate() {
        events.push(named("thread_name", queue_track(at), &format!("{} queue", name_of(queue).to_lowercase())));
    }
    let Some(first) = frames.first() else { return written(events) };
    let mut spans = host_spans(first.began, frames);
    spans.extend(device_spans(plan, &queues, recorded_at(first.began, first), frames));
    // Whoever reads a track finds what began first before what is inside it.
    spans.sort_by_key(|event| (event.ts, std::cmp::Reverse(event.dur)));
    events.extend(spans);
    written(events)
}

fn written(events: Vec<Event>) -> serde_json::Result<String> {
    serde_json::to_string(&Trace { unit: "ms", events })
}

/// The name of a process or of a track.
fn named(what: &str, track: Track, name: &str) -> Event {
    let args = BTreeMap::from([("name", name.into())]);
    Event { name: what.to_owned(), ph: "M", track, ts: Time(0), dur: None, args }
}

fn span(name: String, track: Track, [from, to]: [Time; 2], args: BTreeMap<&'static str, serde_json::Value>) -> Event {
    Event { name, ph: "X", track, ts: from, dur: Some(to.minus(from)), args }
}

/// The queues that the steps run on, in the order of their first steps.
fn queues(plan: &Plan) -> Vec<Queue> {
    let mut queues = Vec::new();
    for step in &plan.steps {
        if !queues.contains(&step.queue) {
            queues.push(step.queue);
        }
    }
    queues
}

fn queue_track(at: usize) -> Track {
    Track { process: DEVICE, thread: u32::try_from(at).unwrap_or(u32::MAX).saturating_add(1) }
}

/// When the host had recorded a frame.
fn recorded_at(beginning: Instant, frame: &TracedFrame) -> Time {
    let began = frame.report.recording_began.unwrap_or(frame.began);
    Time::between(beginning, began).plus(Time::of_milliseconds(frame.report.recording_milliseconds))
}

/// What the host does: each frame, in it the recording, and behind that the wait for the device.
fn host_spans(beginning: Instant, frames: &[TracedFrame]) -> Vec<Event> {
    let mut spans = Vec::new();
    for (number, frame) in frames.iter().enumerate() {
        let [began, ended] = [frame.began, frame.ended].map(|at| Time::between(beginning, at));
        let recorded = recorded_at(beginning, frame).min(ended);
        let recording = Time::between(beginning, frame.report.recording_began.unwrap_or(frame.began));
        let about = || BTreeMap::from([("frame", number.into())]);
        spans.push(span(format!("frame {number}"), HOST, [began, ended], about()));
        spans.push(span("record".to_owned(), HOST, [recording.min(recorded), recorded], about()));
        spans.push(span("submit and wait".to_owned(), HOST, [recorded, ended], about()));
    }
    spans
}

/// What the device does: steps on the track of their queue, in them their passes, and the memory that is alive.
fn device_spans(plan: &Plan, queues: &[Queue], offset: Time, frames: &[TracedFrame]) -> Vec<Event> {
    let began = |frame: &TracedFrame| frame.report.steps.iter().filter_map(|step| step.began).min();
    let Some(beginning) = frames.iter().find_map(began) else { return Vec::new() };
    let mut spans = Vec::new();
    let mut ends = vec![Time(0); queues.len()];
    for (number, frame) in frames.iter().enumerate() {
        for (at, (step, timed)) in plan.steps.iter().zip(&frame.report.steps).enumerate() {
            let Some(queue) = queues.iter().position(|queue| *queue == step.queue) else { continue };
            let Some(began) = timed.began else { continue };
            // A queue does one thing at a time. A clock that begins anew, or rounding, doesn't change that.
            let from = Time(began.saturating_sub(beginning)).plus(offset).max(ends[queue]);
            let to = from.plus(Time::of_milliseconds(timed.milliseconds));
            ends[queue] = to;
            let about = BTreeMap::from([("frame", number.into()), ("step", at.into())]);
            spans.push(span(title(plan, at, step), queue_track(queue), [from, to], about));
            spans.extend(pass_spans(timed, queue_track(queue), [from, to], number));
            let args = BTreeMap::from([("bytes", alive(plan, at).into())]);
            let track = Track { process: DEVICE, thread: 0 };
            spans.push(Event { name: "memory alive".to_owned(), ph: "C", track, ts: from, dur: None, args });
        }
    }
    spans
}

/// The passes of a step, one after the other.
fn pass_spans(step: &StepReport, track: Track, [mut from, end]: [Time; 2], frame: usize) -> Vec<Event> {
    let mut spans = Vec::new();
    for pass in &step.passes {
        let to = from.plus(Time::of_milliseconds(pass.milliseconds)).min(end);
        let about =
            BTreeMap::from([("frame", frame.into()), ("draws", pass.draws.into()), ("culled", pass.culled.into())]);
        spans.push(span(pass.name.clone(), track, [from, to], about));
        from = to;
    }
    spans
}

/// A step in words.
fn title(plan: &Plan, at: usize, step: &Step) -> String {
    let work = &step.work;
    let passes: Vec<&str> = work.passes().iter().map(|pass| &*pass.name).collect();
    let sides = || work.sides().map(|side| plan.resource_name(side.resource())).collect::<Vec<_>>().join(" to ");
    let what = match (passes.is_empty(), work.name()) {
        (false, _) => passes.join(", "),
        (true, Some(name)) => name.to_string(),
        (true, None) => format!("{} {}", work.word(), sides()),
    };
    format!("step {at}: {}", what.trim_end())
}

/// The bytes of transient images and buffers that are alive at a step.
fn alive(plan: &Plan, step: usize) -> u64 {
    let roles = plan.images.iter().map(|image| &image.role).chain(plan.buffers.iter().map(|buffer| &buffer.role));
    let is_alive = |place: &&Placement| {
        let [first, last] = place.lifetime.map(|step| step.0 as usize);
        (first..=last).contains(&step)
    };
    roles.filter_map(Role::placement).filter(is_alive).map(|place| place.bytes).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_vulkan::PassReport;
    use serde_json::Value;
    use std::time::Duration;

    /// A Plan with a pass of a name that does its worst.
    fn plan() -> Plan {
        let mut plan = Plan::from_json(include_str!("../../../docs/plan-example.json")).expect("a Plan");
        let pass = plan.steps.iter_mut().find_map(|step| step.work.passes_mut().first_mut()).expect("a pass");
        pass.name = "a\"},{\"ph\":\"X\n\u{1}".into();
        plan
    }

    fn device() -> TimedDevice {
        TimedDevice { name: "some \"device\"".to_owned(), is_processor: false }
    }

    /// Frames whose steps begin when `began` says, by the number of the frame and of the step, and take a millisecond.
    fn frames(plan: &Plan, began: impl Fn(u64, u64) -> Option<u64>) -> Vec<TracedFrame> {
        let start = Instant::now();
        let after = |milliseconds| start + Duration::from_millis(milliseconds);
        let pass = |pass: &framewright_graph::plan::Pass| PassReport {
            name: pass.name.to_string(),
            draws: 1,
            culled: 0,
            // Together they may seem to take longer than their step.
            milliseconds: 0.7,
        };
        let frame = |frame: u64| {
            let step = |(at, step): (usize, &Step)| {
                let began = began(frame, at as u64);
                let passes = step.work.passes().iter().map(pass).collect();
                StepReport { milliseconds: if began.is_some() { 1.0 } else { 0.0 }, began, ran: true, passes }
            };
            let report = FrameReport {
                milliseconds: 1.0,
                recording_milliseconds: 0.5,
                recording_began: Some(after(10 * frame + 1)),
                fragment_invocations: None,
                steps: plan.steps.iter().enumerate().map(step).collect(),
            };
            TracedFrame { began: after(10 * frame), ended: after(10 * frame + 9), report }
        };
        (0..3).map(frame).collect()
    }

    fn events(trace: &str) -> Vec<Value> {
        let trace: Value = serde_json::from_str(trace).expect("JSON");
        trace["traceEvents"].as_array().expect("a list").clone()
    }

    /// A span: begin and end in nanoseconds, and its name.
    type Span = (u64, u64, String);

    /// The spans of each track, by process and thread.
    fn tracks(events: &[Value]) -> BTreeMap<(u64, u64), Vec<Span>> {
        let mut tracks: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for event in events.iter().filter(|event| event["ph"] == "X") {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few milliseconds")]
            let time = |name: &str| (event[name].as_f64().expect("microseconds") * 1e3).round() as u64;
            let number = |name: &str| event[name].as_u64().expect("a number");
            let name = event["name"].as_str().expect("a name").to_owned();
            let begun = time("ts");
            tracks.entry((number("pid"), number("tid"))).or_default().push((begun, begun + time("dur"), name));
        }
        tracks
    }

    /// Makes sure that what begins within another span ends within it.
    fn nest(tracks: &BTreeMap<(u64, u64), Vec<Span>>) {
        for (track, spans) in tracks {
            let mut around: Vec<&Span> = Vec::new();
            for span in spans {
                while around.last().is_some_and(|outer| outer.1 <= span.0) {
                    around.pop();
                }
                let inside = around.last().is_none_or(|outer| outer.0 <= span.0 && span.1 <= outer.1);
                assert!(inside, "{track:?}: {span:?} in {:?}", around.last());
                around.push(span);
            }
        }
    }

    #[test]
    fn lv_10_spans_nest_and_queues_do_one_thing_at_a_time_even_where_the_clock_begins_anew() {
        let plan = plan();
        let [regular, anew, crowded]: [&dyn Fn(u64, u64) -> Option<u64>; 3] = [
            &|frame, step| Some(1_000_000_000 + frame * 50_000_000 + step * 1_500_000),
            &|frame, step| Some((2 - frame) * 50_000_000 + step * 1_500_000),
            &|_, _| Some(7),
        ];
        for began in [regular, anew, crowded] {
            let events = events(&trace(&plan, &device(), &frames(&plan, began)).expect("written"));
            let tracks = tracks(&events);
            nest(&tracks);
            let steps = tracks[&(2, 1)].iter().filter(|(.., name)| name.starts_with("step "));
            let steps: Vec<_> = steps.collect();
            assert!(steps.windows(2).all(|pair| pair[0].1 <= pair[1].0), "{steps:?}");
            let spans = |track| tracks.get(&track).map_or(0, Vec::len);
            let passes: usize = plan.steps.iter().map(|step| step.work.passes().len()).sum();
            assert_eq!((spans((1, 1)), spans((2, 1))), (9, 3 * (plan.steps.len() + passes)));
            let hostile = tracks[&(2, 1)].iter().filter(|(.., name)| name == "a\"},{\"ph\":\"X\n\u{1}").count();
            assert_eq!(hostile, 3, "once in each frame");
            let counted = events.iter().filter(|event| event["ph"] == "C");
            assert!(counted.clone().count() == 3 * plan.steps.len());
            assert!(counted.clone().any(|event| event["args"]["bytes"].as_u64() > Some(0)));
        }
    }

    #[test]
    fn lv_10_where_nothing_is_timed_there_is_the_hosts_part() {
        let plan = plan();
        let events = events(&trace(&plan, &device(), &frames(&plan, |_, _| None)).expect("written"));
        let tracks = tracks(&events);
        assert_eq!(tracks.keys().collect::<Vec<_>>(), [&(1, 1)]);
        let names: Vec<&str> = tracks[&(1, 1)].iter().take(3).map(|(.., name)| name.as_str()).collect();
        assert_eq!(names, ["frame 0", "record", "submit and wait"]);
        assert_eq!(tracks[&(1, 1)][1], (1_000_000, 1_500_000, "record".to_owned()));
    }
}
