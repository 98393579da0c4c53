//! What a renderer plans and draws, and when (EM-1).

use crate::testing::{EXTENT, Place, difference, draw, renderer, scene};
use framewright::graph::language::Facts;
use framewright::{Change, Draw, DrawSource, Recorder, Renderer, Rotation, SceneDrawSource, Stereo};
use framewright_tests::render::{self, Setup};
use std::collections::BTreeSet;

fn is_new(change: &Change) -> bool {
    matches!(change, Change::Executor { .. })
}

#[test]
fn its_picture_is_that_of_the_layers_one_by_one() {
    let Some(device) = render::device() else { return };
    let mut renderer = renderer(device, "forward");
    renderer.set("msaa", 4).expect("allowed");
    let (_, picture) = draw(&mut renderer, 1);
    let pipeline = "examples/pipelines/forward.ron";
    let setup = Setup { pipeline, set: &[("msaa", "4")], scene: &scene(), extent: EXTENT };
    assert_eq!(picture, render::render(device, &setup).expect("drawn")[0].bytes);
    render::silent(device).expect("silent");
}

#[test]
fn frames_without_a_change_plan_nothing() {
    let Some(device) = render::device() else { return };
    let mut renderer = renderer(device, "forward");
    assert!(renderer.plan().is_none() && renderer.executor().is_none(), "nothing is planned before it is needed");
    assert_eq!(draw(&mut renderer, 2).0, Change::Executor { carried_over: Vec::new() });
    assert_eq!(renderer.prepare().expect("planned").change, Change::Nothing);
    // What is chosen again is no change.
    renderer.set("msaa", 2).expect("allowed");
    assert!(is_new(&renderer.prepare().expect("planned").change));
    renderer.set("msaa", 2).expect("allowed");
    renderer.set_extent(EXTENT).expect("allowed");
    renderer.set_scene(&scene());
    renderer.set_rotation(Rotation::Identity);
    renderer.set_stereo(Stereo::Off).expect("always");
    renderer.preset(None).expect("always");
    renderer.unset("white_point");
    assert_eq!(renderer.prepare().expect("planned").change, Change::Nothing);
}

/// Draws nothing, and allocates nothing.
struct Nothing;

impl DrawSource for Nothing {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, framewright::vulkan::Error> {
        Ok(0)
    }
}

#[test]
fn a_steady_frame_allocates_nothing() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let text = r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "opaque", draw: Objects(Opaque), shader: "lit", color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))])],
        outputs: ["screen"])"#;
    let mut renderer = renderer(device, place.file("steady.ron", text));
    let frames = |renderer: &mut Renderer| {
        for _ in 0..4 {
            renderer.frame(&mut Nothing).expect("drawn");
        }
    };
    frames(&mut renderer);
    assert_eq!(allocation_counter::measure(|| frames(&mut renderer)).count_total, 0);
}

#[test]
fn values_stay_with_the_executor_and_all_else_gets_a_new_one() {
    let Some(device) = render::device() else { return };
    let mut changing = renderer(device, "forward");
    draw(&mut changing, 1);
    let fresh = |choose: &dyn Fn(&mut Renderer)| {
        let mut fresh = renderer(device, "forward");
        choose(&mut fresh);
        draw(&mut fresh, 1).1
    };
    changing.set("white_point", 2).expect("allowed");
    let (change, picture) = draw(&mut changing, 1);
    assert_eq!(change, Change::Values);
    assert_eq!(picture, fresh(&|it| it.set("white_point", 2).expect("allowed")));

    changing.unset("white_point");
    changing.set("msaa", 1).expect("allowed");
    let (change, picture) = draw(&mut changing, 1);
    assert!(is_new(&change));
    assert_eq!(picture, fresh(&|it| it.set("msaa", 1).expect("allowed")));

    changing.set_extent([32, 48]).expect("allowed");
    let (change, picture) = draw(&mut changing, 1);
    assert!(is_new(&change));
    assert_eq!(picture.len(), 32 * 48 * 4);

    changing.set_extent(EXTENT).expect("allowed");
    changing.preset(Some("reference")).expect("it has one");
    changing.unset("msaa");
    let (_, picture) = draw(&mut changing, 1);
    assert_eq!(picture, fresh(&|it| it.preset(Some("reference")).expect("it has one")));
    render::silent(device).expect("silent");
}

/// EM-9: what a setting will need is made by another thread, and the frame that has the setting makes no pipeline.
#[test]
fn pipelines_for_a_setting_are_made_ahead() {
    // A device of its own: others would make pipelines on it at the same time.
    let Some(device) = render::own_device() else { return };
    let made = || device.pipeline_counts().made;
    let mut renderer = renderer(&device, "forward");
    draw(&mut renderer, 1);
    let first = made();
    assert!(first > 2, "{first}");
    let mut ahead = renderer.try_clone().expect("the files are there");
    let ahead = std::thread::spawn(move || {
        ahead.make_pipelines().expect("made");
        let like_before = ahead.device().pipeline_counts().made;
        ahead.set("msaa", 1).expect("allowed");
        ahead.make_pipelines().expect("made");
        like_before
    });
    draw(&mut renderer, 3);
    assert_eq!(ahead.join().expect("no panic"), first, "the clone has the choices that were made");
    let with_ahead = made();
    assert!(with_ahead > first);
    renderer.set("msaa", 1).expect("allowed");
    draw(&mut renderer, 3);
    assert_eq!(made(), with_ahead);
    renderer.set("hdr", false).expect("allowed");
    draw(&mut renderer, 1);
    assert!(made() > with_ahead, "nobody made these ahead");
}

#[test]
fn passes_follow_the_facts_of_the_scene() {
    let Some(device) = render::device() else { return };
    let mut renderer = renderer(device, "forward");
    let mut glass = |facts: Option<Facts>| {
        renderer.set_facts(facts);
        renderer.prepare().expect("planned").plan.tree().to_string().contains("`transparent` draws")
    };
    let facts = scene().facts();
    assert!(facts.has_transparent);
    assert_eq!(
        [Some(facts), Some(Facts { has_transparent: false, ..facts }), None].map(&mut glass),
        [true, false, true]
    );
}

#[test]
fn the_picture_of_a_turned_screen_is_read_upright() {
    let Some(device) = render::device() else { return };
    let mut turned = renderer(device, "forward");
    let (_, upright) = draw(&mut turned, 1);
    turned.set_rotation(Rotation::Rotate90);
    let (change, picture) = draw(&mut turned, 1);
    assert!(is_new(&change));
    assert!(difference(&upright, &picture) < 1.0, "{}", difference(&upright, &picture));
}

#[test]
fn both_eyes_are_drawn_in_a_way_that_the_device_has() {
    let Some(device) = render::device() else { return };
    let mut renderer = renderer(device, "forward");
    let Ok(stereo) = Stereo::first_fit(&Stereo::FASTEST_FIRST, &device.profile()) else { return };
    renderer.set_stereo(stereo).expect("the device has it");
    let plan = renderer.prepare().expect("planned").plan;
    assert_eq!(plan.stereo, stereo);
    assert!(
        plan.outputs.iter().all(|output| *output.name != *"screen" || output.eye.is_none()) || plan.outputs.len() == 2
    );
}

/// Draws a scene, and notes the numbers of frames.
struct Numbered {
    objects: SceneDrawSource,
    frames: BTreeSet<u64>,
}

impl DrawSource for Numbered {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, framewright::vulkan::Error> {
        self.frames.insert(recorder.frame());
        self.objects.record(draw, recorder)
    }
}

#[test]
fn frames_are_numbered_on_and_waited_for_over_executors() {
    let Some(device) = render::device() else { return };
    let mut renderer = renderer(device, "forward");
    let plan = renderer.prepare().expect("planned").plan;
    let objects = SceneDrawSource::for_plan(device, &scene(), EXTENT, plan).expect("uploaded");
    let mut objects = Numbered { objects, frames: BTreeSet::new() };
    assert_eq!([0; 2].map(|_| renderer.submit(&mut objects).expect("submitted")), [0, 1]);
    renderer.set("msaa", 1).expect("allowed");
    assert_eq!(renderer.submit(&mut objects).expect("submitted"), 2);
    renderer.wait(0).expect("it was waited for when its executor ended");
    renderer.wait(2).expect("waited for");
    renderer.wait(3).expect_err("it was not submitted");
    assert!(renderer.report(2).expect("reported").steps.len() > 1);
    renderer.report(1).expect_err("its executor is gone");
    // The layer below is reachable, and counts the same.
    let executor = renderer.executor_mut().expect("prepared");
    assert_eq!(executor.frame(&mut objects).expect("drawn"), 3);
    assert_eq!(executor.frames(), 4);
    assert_eq!(renderer.submit(&mut objects).expect("submitted"), 4);
    // Over several executors too, of which the last knows those before by number alone.
    renderer.set("msaa", 4).expect("allowed");
    assert_eq!(renderer.submit(&mut objects).expect("submitted"), 5);
    renderer.wait(4).expect("it was waited for");
    let gone = renderer.report(4).expect_err("its executor is gone").to_string();
    assert!(gone.contains("frame 4 was drawn by an earlier Plan"), "{gone}");
    let executor = renderer.executor_mut().expect("prepared");
    executor.read_back_image(4, 0).expect_err("its executor is gone");
    // What moves goes on as well.
    assert_eq!(objects.frames, BTreeSet::from([0, 1, 2, 3, 4, 5]));
}

#[test]
fn a_history_goes_on_with_another_executor() {
    let Some(device) = render::device() else { return };
    let mut renderer = renderer(device, "temporal");
    let (_, steady) = draw(&mut renderer, 16);
    let (_, first) = draw(&mut crate::testing::renderer(device, "temporal"), 1);
    // All that was read is read anew.
    let change = renderer.reload().expect("it is shipped");
    let Change::Executor { carried_over } = change else { panic!("{change:?}") };
    assert!(carried_over.contains(&"steady".to_owned()), "{carried_over:?}");
    let (_, next) = draw(&mut renderer, 1);
    let [from_steady, from_first] = [&steady, &first].map(|other| difference(&next, other));
    assert!(from_steady < from_first / 2.0, "{from_steady}, and {from_first} from a picture without history");
}
