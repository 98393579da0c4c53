//! The cost of both eyes' pictures: images, passes and draws.

use super::{Case, Drawn, EVEN, EXTENT, apart_within, at_once, casters, drawn, form, read, rendered, shipped, upright};
use framewright_graph::compile::Options;
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_graph::plan::{Image, Plan};
use framewright_graph::vulkan::{Aspects, Rotation};
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::{Scene, load};
use framewright_tests::render::{Setup, Ways, device, in_repository, library, plan_for, silent};
use framewright_tests::shapes::empty_scene;
use framewright_tests::sweep;
use framewright_vulkan::{Device, Executor, ExecutorOptions};
use std::error::Error;

const MODES: [Stereo; 2] = [Stereo::DoubleWide, Stereo::Instanced];

fn planned(device: &Device, case: &Case<'_>, ways: Ways) -> Result<Plan, Box<dyn Error>> {
    let Case { pipeline, set, scene, extent, .. } = *case;
    plan_for(device, &Setup { pipeline, set, scene, extent }, ways, &mut library(), &Options::default())
}

/// ST-2, ST-4: of the eye's own width, rounded as without two eyes.
#[test]
fn one_image_for_both_is_twice_as_wide_or_has_two_layers() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    let modes = [&MODES[..], &at_once(device)].concat();
    let cases = [1, 2, 3, 96, 97, 161].into_iter().flat_map(|it| ["0.25", "0.77", "1", "1.5"].map(|s| (it, s)));
    for (width, scale) in sweep::of("widths of both eyes", cases.collect(), 4) {
        let set = &[("render_scale", scale), ("blur", "1")];
        let case = Case { pipeline: &shipped("image_quality"), set, scene: &scene, extent: [width, 61], frames: 1 };
        let alone = planned(device, &case, upright(Stereo::MultiPass))?;
        for stereo in &modes {
            for rotation in [Rotation::Identity, Rotation::Rotate90, Rotation::Rotate180] {
                let plan = planned(device, &case, Ways { stereo: *stereo, rotation })?;
                for image in &plan.images {
                    let [one, other, depth] = image.extent;
                    let expected = match image.eyes.ok_or("an image of one eye")? {
                        EyeForm::Layers => ([one, other, depth], 2),
                        EyeForm::Halves if image.rotation == Rotation::Rotate90 => ([one, 2 * other, depth], 1),
                        EyeForm::Halves => ([2 * one, other, depth], 1),
                    };
                    assert_eq!((image.made(), image.made_layers()), expected, "{}", image.name);
                    let named =
                        |it: &&Image| it.name.contains("(left)") && it.name.replace(" (left)", "") == *image.name;
                    let left = alone
                        .images
                        .iter()
                        .find(named)
                        .ok_or_else(|| format!("no {} of the left eye: {}", image.name, alone.tree()))?;
                    let size = image.rotation.extent([one, other]);
                    assert_eq!(size, [left.extent[0], left.extent[1]], "{} at {width}·{scale}", image.name);
                }
            }
        }
    }
    Ok(())
}

/// Passes by name, with how many draws each made and how many objects it left out.
fn counted(drawn: &Drawn) -> Vec<(&str, u32, u32)> {
    let passes = drawn.report.steps.iter().flat_map(|step| &step.passes);
    passes.map(|pass| (&*pass.name, pass.draws, pass.culled)).collect()
}

/// ST-2, ST-3, ST-15: one pass in place of two; of an object one draw, or one for each half.
#[test]
fn a_pass_draws_for_both_eyes_what_two_draw_for_each() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/courtyard.ron"))?;
    let case = Case { pipeline: &shipped("shadows"), set: &[], scene: &scene, extent: EXTENT, frames: 1 };
    let alone = drawn(device, &case, upright(Stereo::MultiPass), &Eyes::default())?;
    let mono = drawn(device, &case, Ways::default(), &Eyes::default())?;
    assert!(casters(&mono.plan) > 0 && casters(&alone.plan) == casters(&mono.plan));
    for stereo in at_once(device) {
        let both = drawn(device, &case, upright(stereo), &Eyes::default())?;
        assert_eq!(rendered(&both.plan).count(), rendered(&mono.plan).count(), "{}", both.plan.tree());
        assert_eq!(casters(&both.plan), casters(&mono.plan));
        for (name, draws, culled) in counted(&both) {
            let of = |eye: &str| counted(&alone).into_iter().find(|it| it.0 == format!("{name} ({eye})"));
            let (Some(left), Some(right)) = (of("left"), of("right")) else {
                let shared = counted(&alone).into_iter().find(|it| it.0 == name);
                assert_eq!(shared, Some((name, draws, culled)), "what both eyes share, {}", stereo.name());
                continue;
            };
            // Objects that either eye sees; each is one draw of the list.
            let most = left.1.max(right.1);
            assert!(draws >= most && draws + culled == left.1 + left.2, "{name}, {}: {draws}, {culled}", stereo.name());
        }
    }
    Ok(())
}

/// ST-15: what recording a frame takes, counted: draw calls of the objects, and allocations on this side of the driver where
/// the camera moves and all that depends on it is prepared again. Both eyes in one pass take at most half the draw calls and
/// four fifths of the allocations of one eye after the other. On one queue: what it takes to submit to several, and to have them
/// wait for each other, isn't recording, and is the same for any number of passes.
#[test]
fn recording_both_eyes_at_once_takes_a_share_of_the_draw_calls_and_allocations() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/passing.ron"))?;
    let case = Case { pipeline: &shipped("forward"), set: &[], scene: &scene, extent: EVEN, frames: 1 };
    let taken = |stereo| -> Result<[u64; 2], Box<dyn Error>> {
        let Case { pipeline, set, scene, extent, .. } = case;
        let one_queue = Options { queues: false, ..Options::default() };
        let plan =
            plan_for(device, &Setup { pipeline, set, scene, extent }, upright(stereo), &mut library(), &one_queue)?;
        let mut draws = SceneDrawSource::for_eyes(device, scene, EVEN, &plan, &Eyes::default())?;
        let mut executor = Executor::new(device, &plan, &mut library(), &ExecutorOptions::default())?;
        let mut last = None;
        let mut allocations = u64::MAX;
        for _ in 0..6 {
            let mut frame = None;
            let taken = allocation_counter::measure(|| frame = Some(executor.frame(&mut draws)));
            allocations = allocations.min(taken.count_total);
            last = Some(frame.ok_or("no frame")??);
        }
        let report = executor.report(last.ok_or("no frame")?)?;
        let passes = report.steps.iter().flat_map(|step| &step.passes);
        Ok([passes.map(|pass| u64::from(pass.draws)).sum(), allocations])
    };
    let [draws, allocations] = taken(Stereo::MultiPass)?;
    for stereo in at_once(device) {
        let [draws_at_once, allocations_at_once] = taken(stereo)?;
        let name = stereo.name();
        println!("{name}: {draws_at_once} of {draws} draw calls, {allocations_at_once} of {allocations} allocations");
        assert!(2 * draws_at_once <= draws, "{name}: {draws_at_once} draw calls, {draws} for one eye after the other");
        let fewer = 5 * allocations_at_once <= 4 * allocations;
        assert!(fewer, "{name}: {allocations_at_once} allocations, {allocations} for one eye after the other");
    }
    silent(device)
}

/// ST-3: what one eye alone may see is a part of what either may.
#[test]
fn shared_culling_shows_the_same() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    // So near that much lies outside of what is seen.
    let mut scene: Scene = load(&in_repository("examples/scenes/courtyard.ron"))?;
    scene.camera.vertical_fov *= 0.4;
    let case = Case { pipeline: &shipped("forward"), set: &[], scene: &scene, extent: EXTENT, frames: 1 };
    let eyes = Eyes::apart(0.3);
    let plan = planned(device, &case, upright(Stereo::MultiPass))?;
    let shown = |shared| {
        let mut draws = SceneDrawSource::for_eyes(device, &scene, EXTENT, &plan, &eyes)?;
        draws.set_shared_culling(shared);
        let mut executor = Executor::new(device, &plan, &mut library(), &ExecutorOptions::default())?;
        let frame = executor.frame(&mut draws)?;
        let report = executor.report(frame)?;
        let frames = vec![read(&plan, &mut executor)?];
        silent(device)?;
        Ok::<_, Box<dyn Error>>(Drawn { plan: plan.clone(), report, frames })
    };
    let (own, shared) = (shown(false)?, shown(true)?);
    assert!(own.frames == shared.frames, "another picture");
    let opaque =
        |drawn: &Drawn| counted(drawn).into_iter().filter(|it| it.0.starts_with("opaque")).map(|it| it.2).collect();
    let (by_own, by_shared): (Vec<u32>, Vec<u32>) = (opaque(&own), opaque(&shared));
    assert!(by_shared.len() == 2 && by_shared[0] == by_shared[1], "both eyes are given the same: {by_shared:?}");
    assert!(by_shared[0] > 0 && by_own.iter().all(|own| *own >= by_shared[0]), "{by_own:?}, {by_shared:?}");
    assert!(by_own.iter().sum::<u32>() > by_shared.iter().sum(), "nothing is seen by one eye alone: {by_own:?}");
    for stereo in at_once(device) {
        let both = drawn(device, &case, upright(stereo), &eyes)?;
        let culled: Vec<u32> = opaque(&both);
        assert_eq!(culled, by_shared[..1], "{}", stereo.name());
        for (both, own) in both.frames[0][0].iter().zip(&own.frames[0][0]) {
            let [off, within] = apart_within(both, own, EXTENT);
            assert!(off <= both.len() / 4 / 200 && within == 0, "{}: {off}, {within}", stereo.name());
        }
    }
    Ok(())
}

/// ST-2: what is handed in for both eyes is twice the eye's width, so never odd.
#[test]
fn what_is_handed_in_for_both_eyes_is_just_as_large_as_both() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let case =
        Case { pipeline: "tests/pipelines/eyes_handed_in.ron", set: &[], scene: &scene, extent: EXTENT, frames: 1 };
    let [width, height] = EXTENT.map(|side| side as usize);
    let number = |eye: usize, at: usize| [(at % 251) as f32, (at / 251) as f32, eye as f32, 1.0];
    let texel = |eye, at| number(eye, at).into_iter().flat_map(f32::to_ne_bytes);
    let of_eye = |eye: usize| (0..width * height).flat_map(move |at| texel(eye, at)).collect::<Vec<u8>>();
    let mut shown = Vec::new();
    for stereo in [vec![Stereo::MultiPass], at_once(device)].concat() {
        let plan = planned(device, &case, upright(stereo))?;
        let mut executor = Executor::new(device, &plan, &mut library(), &ExecutorOptions::default())?;
        let (left, right) = (of_eye(0), of_eye(1));
        match form(&plan) {
            None => {
                executor.write_image("given (left)", Aspects::COLOR, 0, &left)?;
                executor.write_image("given (right)", Aspects::COLOR, 0, &right)?;
            }
            Some(EyeForm::Layers) => executor.write_image("given", Aspects::COLOR, 0, &[left, right].concat())?,
            Some(EyeForm::Halves) => {
                let rows = left.chunks(16 * width).zip(right.chunks(16 * width));
                let both: Vec<u8> = rows.flat_map(|(left, right)| [left, right].concat()).collect();
                let odd = vec![0; 16 * (2 * width - 1) * height];
                let said =
                    executor.write_image("given", Aspects::COLOR, 0, &odd).expect_err("of odd width").to_string();
                let expected = format!("{} bytes were given, {} are needed", odd.len(), both.len());
                assert!(said.contains(&expected), "{said}");
                executor.write_image("given", Aspects::COLOR, 0, &both)?;
            }
        }
        let mut draws = SceneDrawSource::for_plan(device, &scene, EXTENT, &plan)?;
        executor.frame(&mut draws)?;
        shown.push(read(&plan, &mut executor)?);
        silent(device)?;
    }
    assert!(shown.iter().all(|pictures| *pictures == shown[0]), "not the same");
    assert!(shown[0][0][0] != shown[0][0][1]);
    Ok(())
}
