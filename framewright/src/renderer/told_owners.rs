//! Outside owners that a renderer's executor was told, and Plans that can't have them (DO-11).

use super::Renderer;
use crate::{Change, RendererOptions};
use framewright_graph::device::{Profile, Queues};
use framewright_graph::frame::Draw;
use framewright_graph::plan::{Queue, Resource};
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
    let uses = plan.steps.iter().filter(|step| step.touched().any(|it| it == Resource::Buffer(words)));
    uses.map(|step| step.queue).collect()
}

/// Who has `words` between frames, as the Plan that is next says.
fn owner(renderer: &mut Renderer) -> Option<OutsideOwner> {
    let plan = renderer.prepare().expect("it is right").plan;
    plan.buffers.iter().find(|buffer| *buffer.name == *"words").expect("it is used").role.owner()
}

fn tell(renderer: &mut Renderer, name: &str, owner: OutsideOwner) -> Result<(), crate::Error> {
    Ok(renderer.executor_mut()?.set_owner(name, Some(owner))?)
}

#[test]
fn do_11_an_owner_that_can_not_be_had_is_an_error_of_the_renderer_and_changes_nothing() {
    let Some(device) = render::device() else { return };
    let mut renderer =
        Renderer::carried(device, "owners.ron", PIPELINE, RendererOptions::default()).expect("it is right");
    renderer.set_extent([64, 64]).expect("allowed");
    renderer.frame(&mut Nothing).expect("drawn");
    let plan = renderer.plan().cloned();
    // What doesn't exist, and what nobody else can have.
    for name in ["nobody", "list"] {
        let said = tell(&mut renderer, name, OutsideOwner::External).expect_err("it isn't external");
        assert_eq!(said.to_string(), format!("the Plan has no external image or buffer `{name}`"));
    }
    match tell(&mut renderer, "words", OutsideOwner::Foreign) {
        Ok(()) => {
            assert_eq!(owner(&mut renderer), Some(OutsideOwner::Foreign));
            renderer.executor_mut().expect("planned").set_owner("words", None).expect("it is external");
        }
        Err(error) => {
            let lacks = "lacks VK_EXT_queue_family_foreign";
            assert!(error.to_string().contains("`words`") && error.to_string().contains(lacks), "{error}");
        }
    }
    assert_eq!(renderer.plan().cloned(), plan);
    assert_eq!(renderer.prepare().expect("nothing is new").change, Change::Nothing);
    renderer.frame(&mut Nothing).expect("drawn as before");
}

/// The compiler keeps what is imported on one queue, so each Plan can have the owner that was told.
#[test]
fn do_11_a_told_owner_stays_where_another_queue_has_what_it_owns() {
    let Some(device) = render::device() else { return };
    let mut renderer =
        Renderer::carried(device, "owners.ron", PIPELINE, RendererOptions::default()).expect("it is right");
    let queues = Queues { compute: true, transfer: true, sharing: Sharing::Concurrent, wait_bytes: 0 };
    renderer.profile = Arc::new(Profile { queues, ..device.profile() });
    renderer.set_extent([640, 360]).expect("allowed");
    let alone = users(&mut renderer);
    tell(&mut renderer, "words", OutsideOwner::External).expect("it is external");
    let mut queues = BTreeSet::from([alone]);
    for again in [true, false] {
        renderer.set("again", again).expect("allowed");
        queues.insert(users(&mut renderer));
        assert_eq!(owner(&mut renderer), Some(OutsideOwner::External));
        renderer.frame(&mut Nothing).expect("drawn");
    }
    assert!(queues.len() == 2 && queues.iter().all(|of| of.len() == 1), "{queues:?}");
}
