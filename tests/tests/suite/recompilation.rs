//! A compiler that remembers the last frame gives the same Plan, byte for byte, as compiling anew.

use framewright_graph::compile::{Compiler, Options, Order, Reuse, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues, SHIPPED_PROFILES};
use framewright_graph::frame::{Frame, Groups, ParamValue, Work};
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::FillValue;
use framewright_tests::random_pipelines::{frame, passes};
use framewright_tests::shipped;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A compiler held against compiling anew, frame after frame.
struct Held {
    compiler: Compiler,
    device: Arc<Profile>,
    options: Options,
    reused: BTreeMap<Reuse, u32>,
    last: Option<Plan>,
}

impl Held {
    fn new(device: Profile, options: Options) -> Held {
        Held { compiler: Compiler::new(), device: Arc::new(device), options, reused: BTreeMap::new(), last: None }
    }

    /// Compiles one frame both ways, and says how much of the last one served; `None`: it can't be compiled.
    fn hold(&mut self, frame: &Arc<Frame>, what: &str) -> Option<Reuse> {
        let bytes = |plan: &Plan| plan.to_json().expect("a Plan has a JSON form");
        let anew = compile(frame, &self.device, &mut MemoryEstimate(&self.device), &self.options);
        let followed = self.compiler.compile(frame, &self.device, &mut MemoryEstimate(&self.device), &self.options);
        match (anew, followed) {
            (Ok(anew), Ok(followed)) => {
                assert_eq!(&anew, followed, "{what}");
                assert_eq!(bytes(&anew), bytes(followed), "{what}");
                let reuse = self.compiler.reuse();
                *self.reused.entry(reuse).or_default() += 1;
                // What compiles as values alone is drawn with the images and pipelines that are there.
                if let (Some(last), Reuse::Decisions | Reuse::Everything) = (&self.last, reuse) {
                    assert_eq!(last.differs_beyond_values(&anew), None, "{what}");
                }
                self.last = Some(anew);
                Some(reuse)
            }
            (Err(anew), Err(followed)) => {
                assert_eq!(format!("{anew:?}"), format!("{followed:?}"), "{what}");
                None
            }
            (anew, followed) => panic!("{what}: {anew:?} against {followed:?}"),
        }
    }
}

fn device() -> Profile {
    Profile::from_ron(SHIPPED_PROFILES[0].1).expect("a shipped profile")
}

/// The same frame with everything `by` times as large.
fn scaled(frame: &Frame, by: u32) -> Frame {
    let mut frame = frame.clone();
    for image in &mut frame.images {
        let [width, height, depth] = image.extent;
        image.extent = [width * by, height * by, if depth > 1 { depth * by } else { 1 }];
    }
    frame.buffers.iter_mut().for_each(|buffer| buffer.bytes *= u64::from(by * by * by));
    frame
}

/// The same frame with other proportions: what had one size has one size again.
fn reshaped(frame: &Frame, by: u32) -> Frame {
    let mut frame = frame.clone();
    for image in &mut frame.images {
        let [width, height, _] = image.extent;
        let times = 1 + (width.wrapping_mul(31).wrapping_add(height.wrapping_mul(7)) / by) % 5;
        (image.extent[0], image.extent[1]) = (width * times, height * times);
    }
    frame.buffers.iter_mut().for_each(|buffer| buffer.bytes *= 36);
    frame
}

/// The same frame with other values.
fn with_values(frame: &Frame, value: u8) -> Frame {
    let mut frame = frame.clone();
    frame.settings.push(("value".into(), value.to_string()));
    let number = f32::from(value) / 255.0;
    for pass in &mut frame.passes {
        for (_, param) in &mut pass.params {
            *param = match param {
                ParamValue::Bool(_) => ParamValue::Bool(value > 100),
                ParamValue::Integer(_) => ParamValue::Integer(value.into()),
                ParamValue::Number(_) => ParamValue::Number(number.into()),
                ParamValue::OfFrame(which) => ParamValue::OfFrame(*which),
                ParamValue::List(list) => ParamValue::list(list.iter().map(|_| ParamValue::Number(number.into()))),
            };
        }
        for target in &mut pass.color {
            let integers = frame.images[target.image.0 as usize].format.is_integer();
            // Every format of integers holds numbers of seven bits.
            let number = if integers { f64::from(value & 127) } else { f64::from(number) };
            target.clear = target.clear.map(|_| [number; 4]);
        }
        if let Some(depth) = &mut pass.depth {
            depth.clear = depth.clear.map(|_| number.into());
            if let Some(stencil) = &mut depth.stencil {
                stencil.clear = stencil.clear.map(|_| value);
            }
        }
        match &mut pass.work {
            Work::Fill { value: FillValue::Color(color) } => *color = [number; 4],
            Work::Fill { value: FillValue::Bits(bits) } => *bits = [u32::from(value & 127); 4],
            Work::Fill { value: FillValue::Depth(depth, stencil) } => (*depth, *stencil) = (number, value),
            Work::Dispatch { groups: Groups::Count(count) | Groups::Invocations(count), .. } => {
                *count = [value.into(), 1, 1];
            }
            _ => {}
        }
    }
    frame
}

/// Frames that follow each other: the same, other values, other sizes, one other size, another frame.
fn follow(held: &mut Held, first: Frame, other: Frame, what: &str) {
    let first = Arc::new(first);
    if held.hold(&first, &format!("{what}: the first frame")).is_none() {
        return;
    }
    assert_eq!(held.hold(&first, &format!("{what}: the very same frame")), Some(Reuse::Everything));
    let equal = Arc::new(Frame::clone(&first));
    assert_eq!(held.hold(&equal, &format!("{what}: an equal frame")), Some(Reuse::Everything));
    for value in [3, 255] {
        let reuse = held.hold(&Arc::new(with_values(&first, value)), &format!("{what}: the value {value}"));
        assert_eq!(reuse, Some(Reuse::Decisions), "{what}");
    }
    for by in [2, 3, 1] {
        held.hold(&Arc::new(scaled(&first, by)), &format!("{what}: {by} times as large"));
    }
    held.hold(&Arc::new(with_values(&scaled(&first, 2), 7)), &format!("{what}: twice as large, with other values"));
    for by in 1..5 {
        held.hold(&Arc::new(reshaped(&first, by)), &format!("{what}: of other proportions, {by}"));
    }
    for image in 0..first.images.len().min(4) {
        let mut one = Frame::clone(&first);
        one.images[image].extent[0] += 1;
        held.hold(&Arc::new(one), &format!("{what}: image {image} one texel wider"));
    }
    held.hold(&Arc::new(other), &format!("{what}: another frame"));
    held.hold(&first, &format!("{what}: the first frame again"));
}

#[test]
fn random_frames_of_other_values_and_sizes_give_what_compiling_anew_gives() {
    let mut reused = BTreeMap::new();
    let one = [Order::Default, Order::File, Order::LowMemory].map(|order| (order, Queues::default()));
    // Waits that cost nothing, and about as much as what passes move.
    let several = [0, 4 << 10, 64 << 10]
        .map(|wait_bytes| (Order::Default, Queues { compute: true, transfer: true, wait_bytes, ..Queues::default() }));
    let kinds = [&one[..], &several[..]].concat();
    for (number, (order, queues)) in kinds.iter().copied().enumerate() {
        let mut held = Held::new(Profile { queues, ..device() }, Options { order, ..Options::default() });
        for seed in (0..400).filter(|seed| *seed as usize % kinds.len() == number) {
            let other = frame(seed + 1000, passes(seed + 1000, 20));
            follow(&mut held, frame(seed, passes(seed, 30)), other, &format!("seed {seed}, {order:?}, {queues:?}"));
        }
        held.reused.into_iter().for_each(|(reuse, count)| *reused.entry(reuse).or_insert(0) += count);
    }
    let count = |reuse| reused.get(&reuse).copied().unwrap_or(0);
    let (values, frames) = (count(Reuse::Decisions), count(Reuse::Nothing));
    assert!(values > 600 && frames > 4000, "too few frames were compiled: {reused:?}");
}

#[test]
fn shipped_frames_of_other_values_and_sizes_give_what_compiling_anew_gives() {
    let frames = shipped::frames([640, 360]);
    for (at, shipped) in frames.iter().enumerate() {
        // Every other device has more than one queue.
        let several = at % 2 == 1;
        let queues = Queues { compute: several, transfer: several, wait_bytes: 0, ..Queues::default() };
        let mut held = Held::new(Profile { queues, ..device() }, Options::default());
        let other = frames[(at + 1) % frames.len()].frame.clone();
        follow(&mut held, shipped.frame.clone(), other, &shipped.how);
    }
}

#[test]
fn other_options_and_devices_are_compiled_anew() {
    let frame = Arc::new(frame(5, 12));
    let mut held = Held::new(device(), Options::default());
    held.hold(&frame, "first");
    held.options.alias = false;
    assert_eq!(held.hold(&frame, "without sharing memory"), Some(Reuse::Nothing));
    held.device = Arc::new(Profile { name: "another".to_owned(), ..device() });
    assert_eq!(held.hold(&frame, "another device"), Some(Reuse::Nothing));
}

#[test]
fn after_an_error_the_next_frame_is_compiled_anew() {
    let right = Arc::new(frame(5, 12));
    let mut wrong = Frame::clone(&right);
    wrong.images[0].extent[0] = 0;
    let mut held = Held::new(device(), Options::default());
    held.hold(&right, "right");
    assert_eq!(held.hold(&Arc::new(wrong), "wrong"), None);
    assert_eq!(held.hold(&right, "right again"), Some(Reuse::Nothing));
}
