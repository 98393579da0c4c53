//! The pictures of two eyes, compared with those of one eye in the same places.

use super::{Case, EXTENT, apart, casters, drawn, shipped};
use framewright_graph::frame::Stereo;
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::Eyes;
use framewright_passes::scene::{Camera, PointLight, Scene, load};
use framewright_tests::render::{Ways, device, in_repository};
use framewright_vulkan::Device;
use glam::{DMat3, DVec3};
use std::error::Error;

pub(super) type Set<'a> = &'a [(&'a str, &'a str)];

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
pub(super) const TWO: Ways = Ways { stereo: Stereo::MultiPass, rotation: Rotation::Identity };

/// The Plan, and what it showed each eye.
pub(super) type Shown = Result<(Plan, Vec<Vec<u8>>), Box<dyn Error>>;

/// The outputs of the third frame, each of both eyes if they have it of their own.
pub(super) fn pictures(
    device: &Device,
    (pipeline, set): (&str, Set<'_>),
    scene: &Scene,
    ways: Ways,
    eyes: &Eyes,
) -> Shown {
    let case = Case { pipeline, set, scene, extent: EXTENT, frames: 3 };
    let mut drawn = drawn(device, &case, ways, eyes)?;
    let last = drawn.frames.pop().ok_or("no frame")?;
    let mono = ways.stereo == Stereo::Off;
    let pictures = last.into_iter().flat_map(|picture| picture.into_iter().take(if mono { 1 } else { 2 }));
    Ok((drawn.plan, pictures.collect()))
}

/// A scene whose camera has gone so far to its right.
fn beside(scene: &Scene, metres: f64) -> Scene {
    let mut scene = scene.clone();
    let right = DMat3::from_mat4(scene.camera.transform) * DVec3::new(metres, 0.0, 0.0);
    scene.camera.transform.w_axis += right.extend(0.0);
    scene
}

#[test]
fn each_eye_sees_what_a_camera_in_its_place_sees() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    // A binary fraction, and no small one, so that neither place is rounded much.
    let eyes = Eyes::apart(0.25);
    for (pipeline, scene, set) in PIPELINES {
        let scene = load(&in_repository(&format!("examples/scenes/{scene}.ron")))?;
        let file = shipped(pipeline);
        let (_, both) = pictures(device, (&file, set), &scene, TWO, &eyes)?;
        let [left, right] = &both[..] else { return Err(format!("{pipeline} has {} pictures", both.len()).into()) };
        let pixels = left.len() / 4;
        assert!(apart(left, right) > pixels / 20, "{pipeline}: both eyes see the same");
        for (picture, place) in [(left, -0.125), (right, 0.125)] {
            let there = beside(&scene, place);
            let (_, alone) = pictures(device, (&file, set), &there, Ways::default(), &eyes)?;
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
        .map(|ways| pictures(device, (&shipped("shadows"), &[]), &scene, ways, &eyes).map(|(plan, _)| casters(&plan)));
    let (one, two) = (one?, two?);
    assert!(one > 0 && one == two, "{one} and {two}");
    Ok(())
}

#[test]
fn shadow_maps_of_each_eyes_own_give_what_shared_ones_give() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/courtyard.ron"))?;
    let [shared, own] = [&shipped("shadows"), "tests/pipelines/shadows_per_eye.ron"]
        .map(|pipeline| pictures(device, (pipeline, &[]), &scene, TWO, &Eyes::default()));
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
        let position = [f64::from(number % 40) * 0.1 - 2.0, 0.05, f64::from(number / 40) * 0.08 + 5.5];
        PointLight { position, color: [0.5, 0.4, 1.0], intensity: 0.3, range: Some(0.15), shadows: false }
    };
    scene.point_lights = (0..1600).map(light).collect();
    let mut eyes = Eyes::apart(0.25);
    (eyes.left.place.z, eyes.right.place.z) = (3.0, 2.0);
    let (_, pictures) = pictures(device, ("tests/pipelines/point_lights_per_eye.ron", &[]), &scene, TWO, &eyes)?;
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
    // A million metres away 32 bits round places to 6 centimetres, as much as the eyes are apart.
    let by = 1_048_576.0;
    let shift = |scene: &mut Scene, by: f64| {
        scene.camera.transform.w_axis.x += by;
        scene.objects.iter_mut().for_each(|object| object.transform.w_axis.x += by);
        scene.point_lights.iter_mut().for_each(|light| light.position[0] += by);
    };
    shift(&mut far, by);
    // The way back rounds nothing: everything stands as it does there.
    let mut near = far.clone();
    shift(&mut near, -by);
    let [(_, far), (_, near)] = [
        pictures(device, (&shipped("forward"), &[]), &far, TWO, &Eyes::default())?,
        pictures(device, (&shipped("forward"), &[]), &near, TWO, &Eyes::default())?,
    ];
    assert!(apart(&near[0], &near[1]) > near[0].len() / 4 / 50, "both eyes see the same");
    for (eye, (far, near)) in ["left", "right"].iter().zip(far.iter().zip(&near)) {
        assert!(far == near, "the {eye} eye: {} differ", apart(far, near));
    }
    Ok(())
}

/// NU-4: sky, motion and stripes of each eye are what they are without a far plane, which lies close behind the scene.
#[test]
fn a_far_plane_changes_nothing_of_what_each_eye_sees_before_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    // So far apart that the direction of the sky would be off by a sixth.
    let eyes = Eyes::apart(20.0);
    for (pipeline, scene, set) in [
        ("image_quality", "spheres_and_cubes", &[("depth_stripes", "copied")] as Set<'_>),
        ("temporal", "passing", &[]),
    ] {
        let mut scene = load(&in_repository(&format!("examples/scenes/{scene}.ron")))?;
        let file = shipped(pipeline);
        let (_, without) = pictures(device, (&file, set), &scene, TWO, &eyes)?;
        scene.camera.far = Some(60.0);
        let (_, with) = pictures(device, (&file, set), &scene, TWO, &eyes)?;
        assert_eq!((without.len(), with.len()), (2, 2), "{pipeline}");
        for (without, with) in without.iter().zip(&with) {
            let apart = apart(without, with);
            assert!(apart <= 12, "{pipeline}: {apart} of {} pixels differ", without.len() / 4);
        }
    }
    Ok(())
}

/// NU-4: eyes at one place see the same, bit by bit; each of two that are a kilometre apart sees what a camera in its place
/// sees.
#[test]
fn eyes_at_one_place_and_a_kilometre_apart_see_what_a_camera_there_sees() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    let set: Set<'_> = &[("msaa", "1")];
    let file = shipped("forward");
    let (_, alone) = pictures(device, (&file, set), &scene, Ways::default(), &Eyes::default())?;
    let (_, together) = pictures(device, (&file, set), &scene, TWO, &Eyes::apart(0.0))?;
    assert!(together.len() == 2 && together.iter().all(|eye| *eye == alone[0]), "eyes at one place differ");

    // The same things stand around each eye.
    let right = DMat3::from_mat4(scene.camera.transform) * DVec3::new(500.0, 0.0, 0.0);
    let things = std::mem::take(&mut scene.objects);
    for side in [-1.0, 1.0] {
        scene.objects.extend(things.iter().cloned().map(|mut thing| {
            thing.transform.w_axis += (right * side).extend(0.0);
            thing
        }));
    }
    let (_, both) = pictures(device, (&file, set), &scene, TWO, &Eyes::apart(1000.0))?;
    for (picture, place) in both.iter().zip([-500.0, 500.0]) {
        let (_, alone) = pictures(device, (&file, set), &beside(&scene, place), Ways::default(), &Eyes::default())?;
        let colors: std::collections::HashSet<_> = picture.chunks(4).collect();
        assert!(colors.len() > 200, "an eye sees {} colours", colors.len());
        // Half a kilometre from the origin of the shaders' world places are rounded to 1/32,768 of a metre.
        let apart = apart(picture, &alone[0]);
        assert!(apart * 100 < picture.len() / 4, "{apart} of {} pixels differ at {place} m", picture.len() / 4);
    }
    Ok(())
}
