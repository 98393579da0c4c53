//! What two eyes see, held against what one sees that stands where they are.
//!
//! | row | test | what turns it red |
//! |---|---|---|
//! | ST-1 | `each_eye_sees_what_a_camera_in_its_place_sees` | `draw/eyes.rs`: the other eye's place |
//! | ST-1 | `graph/tests/language/eyes.rs` | `expand/eyes.rs`: `of` gives the left eye's image |
//! | ST-3 | `what_both_eyes_share_is_drawn_once` | `expand/eyes.rs`: `For::Both` runs for each |
//! | ST-3 | `passes/tests/eyes.rs` | `draw/eyes.rs`: no step back |
//! | ST-3 | `shadow_maps_of_each_eyes_own_give_what_shared_ones_give` | `draw/cascades.rs`: no maps of eyes' views |
//! | ST-1 | `point_lights_reach_what_an_eye_sees_behind_the_camera_between_both` | `point_lights.glsl`: tiles as ahead |
//! | NU-4 | `eyes_far_from_the_origin_see_what_they_see_near_it` | `draw/eyes.rs`: an eye's place in 32 bits |

use framewright_graph::compile::Options;
use framewright_graph::frame::Draw;
use framewright_graph::plan::{Plan, Work};
use framewright_graph::root::Root;
use framewright_graph::rotation::Rotation;
use framewright_graph::view::Stereo;
use framewright_passes::draw::{Eyes, SceneDrawSource, interface};
use framewright_passes::scene::{Camera, PointLight, Scene, load};
use framewright_passes::shipped::SHADERS;
use framewright_tests::render::{Setup, Ways, device, in_repository, plan_for, silent};
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderLibrary};
use glam::{DMat3, DVec3};
use std::error::Error;

type Set<'a> = &'a [(&'a str, &'a str)];

/// The Plan, and what it showed each eye.
type Shown = Result<(Plan, Vec<Vec<u8>>), Box<dyn Error>>;

/// Pipelines whose images each eye has of its own, and a scene for each.
const PIPELINES: [(&str, &str, Set<'_>); 7] = [
    ("forward", "spheres_and_cubes", &[]),
    ("image_quality", "spheres_and_cubes", &[]),
    ("image_quality", "spheres_and_cubes", &[("render_scale", "0.7"), ("depth_stripes", "copied"), ("blur", "3")]),
    ("post", "spheres_and_cubes", &[]),
    ("soft_focus", "spheres_and_cubes", &[]),
    ("temporal", "passing", &[]),
    ("shadows", "courtyard", &[]),
];
/// Odd, so that halves would be of different widths.
const EXTENT: [u32; 2] = [97, 61];
const FRAMES: u32 = 3;
const TWO: Ways = Ways { stereo: Stereo::MultiPass, rotation: Rotation::Identity };

/// A pipeline file that is shipped.
fn shipped(name: &str) -> String {
    format!("examples/pipelines/{name}.ron")
}

/// The first output of the last frame; for two eyes what each has, output by output.
fn shown(device: &Device, (pipeline, set): (&str, Set<'_>), scene: &Scene, ways: Ways, eyes: &Eyes) -> Shown {
    let mut shaders = ShaderLibrary::new(vec![Root::new(in_repository("tests/shaders"))], SHADERS, interface);
    let setup = Setup { pipeline, set, scene, extent: EXTENT };
    let plan = plan_for(device, &setup, ways, &mut shaders, &Options::default())?;
    let mut draws = SceneDrawSource::for_eyes(device, scene, EXTENT, &plan, eyes)?;
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    for _ in 0..FRAMES {
        executor.frame(&mut draws)?;
    }
    let count = plan.outputs.iter().filter(|output| output.eye.is_some()).count().max(1);
    let pictures = (0..count).map(|at| Ok(executor.read(at)?.bytes)).collect::<Result<_, Box<dyn Error>>>()?;
    silent(device)?;
    Ok((plan, pictures))
}

/// A scene whose camera has gone so far to its right.
fn beside(scene: &Scene, metres: f64) -> Scene {
    let mut scene = scene.clone();
    let right = DMat3::from_mat4(scene.camera.transform.as_dmat4()) * DVec3::new(metres, 0.0, 0.0);
    scene.camera.transform.w_axis += right.as_vec3().extend(0.0);
    scene
}

/// How many pixels differ by more than one step in any channel.
fn apart(one: &[u8], other: &[u8]) -> usize {
    assert_eq!(one.len(), other.len());
    let pixels = one.as_chunks::<4>().0.iter().zip(other.as_chunks::<4>().0);
    pixels.filter(|(one, other)| one.iter().zip(*other).any(|(one, other)| one.abs_diff(*other) > 1)).count()
}

#[test]
fn each_eye_sees_what_a_camera_in_its_place_sees() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    // A binary fraction, and no small one, so that neither place is rounded much.
    let eyes = Eyes::apart(0.25);
    for (pipeline, scene, set) in PIPELINES {
        let scene = load(&in_repository(&format!("examples/scenes/{scene}.ron")))?;
        let file = shipped(pipeline);
        let (_, both) = shown(device, (&file, set), &scene, TWO, &eyes)?;
        let [left, right] = &both[..] else { return Err(format!("{pipeline} has {} pictures", both.len()).into()) };
        let pixels = left.len() / 4;
        assert!(apart(left, right) > pixels / 20, "{pipeline}: both eyes see the same");
        for (picture, place) in [(left, -0.125), (right, 0.125)] {
            let there = beside(&scene, place);
            let (_, alone) = shown(device, (&file, set), &there, Ways::default(), &eyes)?;
            let apart = apart(picture, &alone[0]);
            // Edges fall on the other side of a pixel's middle; shadows are drawn from a place between the eyes, and history that
            // hardly fits is taken or left.
            println!("{pipeline} {set:?} {place}: {apart} of {pixels}");
            let bound = if ["shadows", "temporal"].contains(&pipeline) { pixels / 200 } else { pixels / 1000 };
            assert!(apart <= bound, "{pipeline} {set:?}, {place}: {apart} of {pixels} differ");
        }
    }
    Ok(())
}

#[test]
fn what_both_eyes_share_is_drawn_once() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/courtyard.ron"))?;
    let eyes = Eyes::default();
    let [one, two] = [Ways::default(), TWO]
        .map(|ways| shown(device, (&shipped("shadows"), &[]), &scene, ways, &eyes).map(|(plan, _)| casters(&plan)));
    let (one, two) = (one?, two?);
    assert!(one > 0 && one == two, "{one} and {two}");
    Ok(())
}

/// How many passes draw what casts shadows.
fn casters(plan: &Plan) -> usize {
    let passes = plan.steps.iter().filter_map(|step| match &step.work {
        Work::Render(scope) => Some(&scope.passes),
        _ => None,
    });
    passes.flatten().filter(|pass| matches!(pass.draw, Some(Draw::Casters(_)))).count()
}

#[test]
fn shadow_maps_of_each_eyes_own_give_what_shared_ones_give() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/courtyard.ron"))?;
    let [shared, own] = [&shipped("shadows"), "tests/pipelines/shadows_per_eye.ron"]
        .map(|pipeline| shown(device, (pipeline, &[]), &scene, TWO, &Eyes::default()));
    let ((shared, as_shared), (own, as_own)) = (shared?, own?);
    assert_eq!(casters(&own), 2 * casters(&shared));
    assert!(as_own == as_shared, "another picture");
    Ok(())
}

#[test]
fn point_lights_reach_what_an_eye_sees_behind_the_camera_between_both() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    scene.camera = Camera::look_at(DVec3::new(0.3, 0.5, 6.0), DVec3::new(0.0, 0.5, -9.0), DVec3::Y, 1.0, 0.05)
        .ok_or("no direction")?;
    // All over the floor around the camera.
    let light = |number: u32| {
        let position = [(number % 40) as f32 * 0.1 - 2.0, 0.05, (number / 40) as f32 * 0.08 + 5.5];
        PointLight { position, color: [0.5, 0.4, 1.0], intensity: 0.3, range: Some(0.15), shadows: false }
    };
    scene.point_lights = (0..1600).map(light).collect();
    let mut eyes = Eyes::apart(0.25);
    (eyes.left.place.z, eyes.right.place.z) = (3.0, 2.0);
    let (_, pictures) = shown(device, ("tests/pipelines/point_lights_per_eye.ron", &[]), &scene, TWO, &eyes)?;
    let [left, right, all_of_left, all_of_right] = &pictures[..] else { return Err("no four pictures".into()) };
    for (eye, by_clusters, one_by_one) in [("left", left, all_of_left), ("right", right, all_of_right)] {
        // Alpha is how many lights were looked at.
        let colors = |texels: &[u8]| texels.as_chunks::<16>().0.iter().map(|it| it[..12].to_vec()).collect::<Vec<_>>();
        let (found, expected) = (colors(by_clusters), colors(one_by_one));
        assert!(found.iter().filter(|color| color.iter().any(|byte| *byte != 0)).count() > 1000, "{eye}: no light");
        let apart = found.iter().zip(&expected).filter(|(found, expected)| found != expected).count();
        assert_eq!(apart, 0, "{eye}: pixels that lack light");
    }
    Ok(())
}

#[test]
fn eyes_far_from_the_origin_see_what_they_see_near_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut far = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    // A million metres away places are rounded to 6 centimetres, as much as the eyes are apart.
    let by = 1_048_576.0;
    let shift = |scene: &mut Scene, by: f32| {
        scene.camera.transform.w_axis.x += by;
        scene.objects.iter_mut().for_each(|object| object.transform.w_axis.x += by);
        scene.point_lights.iter_mut().for_each(|light| light.position[0] += by);
    };
    shift(&mut far, by);
    // The way back rounds nothing: everything stands as it does there.
    let mut near = far.clone();
    shift(&mut near, -by);
    let [(_, far), (_, near)] = [
        shown(device, (&shipped("forward"), &[]), &far, TWO, &Eyes::default())?,
        shown(device, (&shipped("forward"), &[]), &near, TWO, &Eyes::default())?,
    ];
    assert!(apart(&near[0], &near[1]) > near[0].len() / 4 / 50, "both eyes see the same");
    for (eye, (far, near)) in ["left", "right"].iter().zip(far.iter().zip(&near)) {
        assert!(far == near, "the {eye} eye: {} differ", apart(far, near));
    }
    Ok(())
}

#[test]
fn on_a_rotated_screen_each_eye_sees_the_same() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    for (pipeline, set) in [("forward", &[][..]), ("image_quality", &[("render_scale", "0.7")][..])] {
        let file = shipped(pipeline);
        let (_, upright) = shown(device, (&file, set), &scene, TWO, &Eyes::default())?;
        for rotation in [Rotation::Rotate90, Rotation::Rotate180, Rotation::Rotate270] {
            let (plan, turned) = shown(device, (&file, set), &scene, Ways { rotation, ..TWO }, &Eyes::default())?;
            assert_eq!(plan.images.iter().filter(|image| image.rotation == rotation).count(), 2, "both eyes' screens");
            for (upright, turned) in upright.iter().zip(&turned) {
                let apart = apart(upright, turned);
                assert!(apart <= upright.len() / 4 / 1000, "{pipeline:?} turned by {rotation:?}: {apart} differ");
            }
        }
    }
    Ok(())
}
