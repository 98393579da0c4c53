//! With the feature `tracing`, a subscriber sees what the host does for each frame (LV-10). This package turns the feature on.

use framewright::{Renderer, RendererOptions, SceneDrawSource, load_scene};
use framewright_tests::render;
use std::fmt::Debug;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread::{self, ThreadId};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::subscriber::Interest;
use tracing::{Dispatch, Event, Metadata, Subscriber, dispatcher};

/// A span that began.
#[derive(Debug, Clone)]
struct Seen {
    name: &'static str,
    frame: Option<u64>,
    /// How many spans were open.
    depth: usize,
    /// Whether it has ended.
    ended: bool,
}

/// Keeps the spans of Framewright's crates.
struct Collector;

/// The thread whose spans are kept: other tests draw on other threads.
static WATCHED: OnceLock<ThreadId> = OnceLock::new();
/// The number of spans of other threads.
const UNWATCHED: u64 = u64::MAX;

static SEEN: Mutex<Vec<Seen>> = Mutex::new(Vec::new());

fn seen<T>(look: impl FnOnce(&mut Vec<Seen>) -> T) -> T {
    look(&mut SEEN.lock().unwrap_or_else(PoisonError::into_inner))
}

#[derive(Default)]
struct FrameNumber(Option<u64>);

impl Visit for FrameNumber {
    fn record_u64(&mut self, field: &Field, value: u64) {
        if field.name() == "frame" {
            self.0 = Some(value);
        }
    }

    fn record_debug(&mut self, _: &Field, _: &dyn Debug) {}
}

impl Subscriber for Collector {
    fn register_callsite(&self, metadata: &'static Metadata<'static>) -> Interest {
        if self.enabled(metadata) { Interest::always() } else { Interest::never() }
    }

    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_span() && metadata.target().starts_with("framewright")
    }

    fn new_span(&self, span: &Attributes<'_>) -> Id {
        let mut number = FrameNumber::default();
        span.record(&mut number);
        if WATCHED.get() != Some(&thread::current().id()) {
            return Id::from_u64(UNWATCHED);
        }
        seen(|seen| {
            let depth = seen.iter().filter(|one| !one.ended).count();
            seen.push(Seen { name: span.metadata().name(), frame: number.0, depth, ended: false });
            Id::from_u64(seen.len() as u64)
        })
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn event(&self, _: &Event<'_>) {}
    fn enter(&self, _: &Id) {}

    fn exit(&self, span: &Id) {
        if span.into_u64() != UNWATCHED {
            seen(|seen| seen[usize::try_from(span.into_u64()).expect("a number") - 1].ended = true);
        }
    }
}

#[test]
fn lv_10_a_subscriber_sees_what_the_host_does_with_the_frames_number() {
    let Some(device) = render::device() else { return };
    let scene = load_scene("spheres_and_cubes").expect("a scene");
    let mut renderer = Renderer::open(device, "forward", RendererOptions::default()).expect("opened");
    renderer.set_scene(&scene);
    renderer.set_extent([64, 48]).expect("a size");
    // The device was tested by now, which draws frames too.
    WATCHED.set(thread::current().id()).expect("nobody else watches");
    dispatcher::set_global_default(Dispatch::new(Collector)).expect("nobody else sets one");
    for _ in 0..2 {
        let plan = renderer.prepare().expect("planned").plan;
        let mut objects = SceneDrawSource::for_plan(device, &scene, [64, 48], plan).expect("uploaded");
        renderer.frame(&mut objects).expect("drawn");
    }
    let own: Vec<Seen> = seen(|seen| seen.clone());
    assert!(own.iter().all(|one| one.ended && one.depth == 0), "they follow one another: {own:?}");
    let of_frames: Vec<_> = own.iter().filter_map(|one| Some((one.name, one.frame?))).collect();
    let each = |frame| ["record", "submit", "wait"].map(|name| (name, frame));
    assert_eq!(of_frames, [each(0), each(1)].concat());
    let before: Vec<&str> = own.iter().map(|one| one.name).take_while(|name| *name != "record").collect();
    assert_eq!(before.first(), Some(&"compile"), "{before:?}");
    assert_eq!(before.iter().filter(|name| **name == "prepare").count(), 1, "{before:?}");
}
