//! Outside owners that a renderer's executor was told, and Plans that can't have them (DO-11).

use super::Renderer;
use crate::{Change, RendererOptions};
use framewright_graph::device::{Profile, Queues};
use framewright_graph::frame::Draw;
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::Sharing;
use framewright_tests::render;
use framewright_vulkan::{DrawSource, Error, OutsideOwner, Recorder};
use std::collections::BTreeSet;
use std::sync::Arc;

/// A copy of `words` runs beside draws, on a queue of its own. With `again` the queue for graphics reads them too.
const PIPELINE: &str = r#"Pipeline(
    version: 1,
    settings: [(name: "again", value: Bool(default: false))],
    images: [
        (name: "color", format: R16G16B16A16_SFLOAT, size: Output),
        (name: "screen", format: R16G16B16A16_SFLOAT, size: Output),
    ],
    buffers: [
        (name: "words", bytes: 262144, lifetime: Imported(before: (stages: [COPY], accesses: [TRANSFER_WRITE]))),
        (name: "list", bytes: 262144), (name: "kept", bytes: 262144), (name: "more", bytes: 262144),
    ],
    passes: [
        (name: "take", copy: (from: "words", to: "list")),
        (name: "paint", draw: Objects(Opaque), shader: "lit", color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: "show", draw: FullScreen("copy"), sample: {"source": "color"}, color: ["screen"]),
        (name: "keep", copy: (from: "list", to: "kept")),
        (name: "again", when: "again", copy: (from: "words", to: "more"), side_effect: true),
    ],
    outputs: ["screen", "kept"],
)"#;

struct Nothing;

impl DrawSource for Nothing {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }
}

/// The queues that use `words` in the frame that is next.
fn users(renderer: &mut Renderer) -> BTreeSet<Queue> {
    let plan = renderer.prepare().expect("it is right").plan;
    let words = plan.buffers.iter().find(|buffer| *buffer.name == *"words").expect("it is used").id;
    let uses = plan.steps.iter().filter(|step| {
        step.touched().any(|it| it == framewright_graph::plan::Resource::Buffer(words))
    });
    uses.map(|step| step.queue).collect()
}

#[test]
fn do_11_a_told_owner_that_a_plan_can_not_have_is_an_error_and_the_plan_before_stays() {
    const WANTED: &str = "several queues use `words`: its pipeline must say that it has an outside owner";
    let Some(device) = render::device() else { return };
    let mut renderer =
        Renderer::carried(device, "owners.ron", PIPELINE, RendererOptions::default()).expect("it is right");
    let queues = Queues { compute: true, transfer: true, sharing: Sharing::Concurrent, wait_bytes: 0 };
    renderer.profile = Arc::new(Profile { queues, ..device.profile() });
    renderer.set_extent([640, 360]).expect("allowed");

    // The owner is told first, and the Plan can't have it.
    renderer.set("again", true).expect("allowed");
    assert_eq!(users(&mut renderer).len(), 2);
    let tell = |renderer: &mut Renderer, owner| renderer.executor_mut().expect("planned").set_owner("words", owner);
    let said = tell(&mut renderer, Some(OutsideOwner::External)).expect_err("two queues use it");
    assert_eq!(said.to_string(), WANTED);
    renderer.frame(&mut Nothing).expect("drawn as before");

    // A Plan has it, and the next one can't.
    renderer.set("again", false).expect("allowed");
    assert_eq!(users(&mut renderer).len(), 1);
    tell(&mut renderer, Some(OutsideOwner::External)).expect("one queue uses it");
    let plan = renderer.plan().cloned();
    for _ in 0..2 {
        renderer.set("again", true).expect("allowed");
        let said = renderer.prepare().map(drop).expect_err("two queues use it");
        assert_eq!(said.to_string(), WANTED);
        // The choice is taken back, and what was drawn before is drawn.
        assert_eq!(renderer.plan().cloned(), plan);
        assert_eq!(renderer.prepare().expect("nothing is new").change, Change::Nothing);
        renderer.frame(&mut Nothing).expect("drawn as before");
    }

    // Without the owner it can.
    tell(&mut renderer, None).expect("it is external");
    renderer.set("again", true).expect("allowed");
    assert_eq!(users(&mut renderer).len(), 2);
    renderer.frame(&mut Nothing).expect("drawn");
}
