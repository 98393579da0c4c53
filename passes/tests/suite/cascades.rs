//! Claims about how the sun sees the parts of a scene (IQ-25): everything is covered, and nothing shimmers.

use framewright_graph::frame::{Cascade, DrawList, Share};
use framewright_passes::draw::cascades::{SunView, sun_view};
use framewright_passes::scene::{Camera, Scene, load};
use glam::{DMat4, DQuat, DVec2, DVec3, Vec3};
use std::path::Path;

const TEXELS: u32 = 1024;
const ASPECT: f64 = 16.0 / 9.0;

fn scene() -> Scene {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes/spheres_and_cubes.ron"))
        .expect("it is shipped")
}

fn cascade(index: u8, of: u8) -> Cascade {
    Cascade { list: DrawList::Opaque, index, of, reach: 30.0.try_into().ok(), logarithmic: Share::OF_CASCADES }
}

fn seen(scene: &Scene, camera: &Camera, index: u8, of: u8) -> SunView {
    sun_view(scene, camera, ASPECT, cascade(index, of), TEXELS)
}

/// The camera, moved by metres and turned by radians.
fn moved(camera: &Camera, by: DVec3, turn: f64) -> Camera {
    let turned = DMat4::from_quat(DQuat::from_axis_angle(DVec3::new(0.2, 0.9, 0.1).normalize(), turn));
    let place = DMat4::from_translation(camera.position());
    let transform = DMat4::from_translation(by) * place * turned * place.inverse() * camera.transform;
    Camera { transform, ..*camera }
}

/// Where a place of the scene lies in the map, in texels, and its depth there.
fn in_map(seen: &SunView, camera: &Camera, place: DVec3) -> (DVec2, f64) {
    let clip = seen.world_to_clip * (place - camera.position()).extend(1.0);
    ((clip.truncate().truncate() * 0.5 + 0.5) * f64::from(TEXELS), clip.z)
}

#[test]
fn a_texel_covers_the_same_place_wherever_the_camera_goes_and_looks() {
    let scene = scene();
    let mut whole_steps = 0;
    for (index, of) in [(0, 1), (0, 2), (1, 2), (0, 4), (3, 4)] {
        let before = seen(&scene, &scene.camera, index, of);
        for step in 1..40 {
            let far = f64::from(step) * 0.037;
            let camera = moved(&scene.camera, DVec3::new(far, 0.3 * far, -0.7 * far), 0.02 * f64::from(step));
            let after = seen(&scene, &camera, index, of);
            assert!((after.texel - before.texel).abs() < 1e-12, "cascade {index} of {of} changes its size");
            for place in [DVec3::ZERO, DVec3::new(1.3, 0.2, -2.1), DVec3::new(-4.0, 2.0, 3.0)] {
                let ((was, depth), (is, now)) = (in_map(&before, &scene.camera, place), in_map(&after, &camera, place));
                let shift = is - was;
                assert!((shift - shift.round()).abs().max_element() < 1e-6, "cascade {index} of {of}: {shift}");
                assert!((now - depth).abs() < 1e-9, "its depth goes from {depth} to {now}");
                whole_steps += u32::from(shift.round() != DVec2::ZERO);
            }
        }
    }
    assert!(whole_steps > 100, "the maps hardly move: {whole_steps}");
}

#[test]
fn every_place_that_is_seen_within_the_reach_lies_in_a_map_with_room_for_the_filter() {
    let scene = scene();
    let camera = &scene.camera;
    let forward = -camera.transform.z_axis.truncate();
    let (right, up) = (camera.transform.x_axis.truncate(), camera.transform.y_axis.truncate());
    let tangent = (f64::from(camera.vertical_fov) * 0.5).tan();
    for of in [1, 2, 4] {
        let maps: Vec<SunView> = (0..of).map(|index| seen(&scene, camera, index, of)).collect();
        let finest_first = maps.windows(2).all(|pair| pair[0].texel < pair[1].texel);
        assert!(finest_first, "{maps:?}");
        for number in 0..300 {
            let ahead = 0.1 + 29.9 * f64::from(number) / 299.0;
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (0.0, 0.0), (-1.0, 1.0), (1.0, 1.0)] {
                let aside = right * (x * ASPECT) + up * y;
                let place = camera.position() + (forward + aside * tangent) * ahead;
                let room = |seen: &SunView| {
                    let (at, _) = in_map(seen, camera, place);
                    at.min_element().min((f64::from(TEXELS) - at).min_element())
                };
                let most = maps.iter().map(room).fold(f64::NEG_INFINITY, f64::max);
                assert!(most >= 4.5, "{ahead} m ahead, {x} {y}: {most} texels from the border, {of} cascades");
            }
        }
    }
}

#[test]
fn everything_that_may_cast_lies_between_the_sun_and_the_end_of_the_map() {
    let scene = scene();
    let seen = seen(&scene, &scene.camera, 0, 4);
    let bounds = scene.bounds().expect("there are objects");
    for corner in 0..8 {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
        let (_, depth) = in_map(&seen, &scene.camera, DVec3::new(pick(0), pick(1), pick(2)));
        assert!((0.0..=1.0).contains(&depth), "{depth}");
    }
    let to_sun = -Vec3::from(scene.sun.direction).as_dvec3();
    let [(_, near), (_, far)] = [1.0, -1.0].map(|way| in_map(&seen, &scene.camera, to_sun * way));
    assert!(near > far, "depth is not reversed");
}

#[test]
fn without_a_reach_shadows_go_through_the_whole_scene_and_keep_their_size_in_small_steps() {
    let scene = scene();
    let whole = |camera: &Camera| sun_view(&scene, camera, ASPECT, Cascade { reach: None, ..cascade(0, 1) }, TEXELS);
    let bounds = scene.bounds().expect("there are objects");
    let reach = whole(&scene.camera).reach;
    let needed = scene.camera.position().distance(bounds.center()) + bounds.radius();
    assert!((needed..needed * 1.5).contains(&reach), "{reach}, {needed}");
    let steps = (0..100).map(|step| whole(&moved(&scene.camera, DVec3::X * (f64::from(step) * 0.01), 0.0)).reach);
    let mut reaches: Vec<f64> = steps.collect();
    reaches.dedup();
    assert!(reaches.len() <= 2, "{reaches:?}");
}

/// The size of a texel in the picture at a distance from the camera: relative to the distance, of the first cascade that covers
/// the picture there.
fn texel_in_picture(scene: &Scene, camera: &Camera, distance: f64, of: u8) -> f64 {
    let up = (f64::from(camera.vertical_fov) * 0.5).tan();
    let corner = |x: f64, y: f64| {
        let seen = DVec3::new(x * up * ASPECT, y * up, -1.0) * distance;
        camera.transform.transform_point3(seen)
    };
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)];
    let texel = (0..of).find_map(|index| {
        let cascade = Cascade { list: DrawList::Opaque, index, of, reach: None, logarithmic: Share::OF_CASCADES };
        let seen = sun_view(scene, camera, ASPECT, cascade, TEXELS);
        let within = |place: &DVec3| {
            let (texel, _) = in_map(&seen, camera, *place);
            texel.min_element() >= 0.0 && texel.max_element() <= f64::from(TEXELS)
        };
        corners.iter().all(within).then_some(seen.texel)
    });
    texel.map_or(0.0, |texel| texel / distance)
}

/// NU-6: with as many cascades as a scene needs, no texel covers more of the picture than with four in a scene of any depth.
#[test]
fn as_many_cascades_as_the_fact_says_are_as_fine_in_the_picture_as_four_in_a_deep_scene() {
    let mut said = [0; 5];
    for near in [1.0_f32, 2.0, 6.0, 10.0, 16.0] {
        let mut scene = scene();
        scene.sun.shadows = true;
        scene.camera.near = near;
        scene.cameras.iter_mut().for_each(|it| it.camera.near = near);
        let of = u8::try_from(scene.facts().shadow_cascades).expect("a small number");
        said[usize::from(of)] += 1;
        if of == Cascade::MOST {
            continue;
        }
        let deep = Camera { near: 1e-4, ..scene.camera };
        let whole = Cascade { list: DrawList::Opaque, index: 0, of: 4, reach: None, logarithmic: Share::OF_CASCADES };
        let reach = sun_view(&scene, &deep, ASPECT, whole, TEXELS).reach;
        let allowed = texel_in_picture(&scene, &deep, reach / 256.0, 4);
        for step in 0..20 {
            let far = f64::from(step) * 0.05;
            let camera = moved(&scene.camera, DVec3::new(-far, 0.0, -far), 0.1 * f64::from(step));
            let mut distance = f64::from(near);
            while distance < reach {
                let found = texel_in_picture(&scene, &camera, distance, of);
                assert!(
                    found <= allowed * 1.001,
                    "near {near}, {of} cascades, {distance} m: {found} and not {allowed}"
                );
                distance *= 1.07;
            }
        }
    }
    assert!(said[1] > 0 && said[2] > 0 && said[4] > 0, "{said:?}");
}

/// NU-6: a scene whose sun casts no shadows needs no cascades.
#[test]
fn without_shadows_of_the_sun_no_cascade_is_needed() {
    let mut scene = scene();
    scene.sun.shadows = false;
    assert_eq!(scene.facts().shadow_cascades, 0);
    scene.sun.shadows = true;
    assert_ne!(scene.facts().shadow_cascades, 0);
    scene.sun.color = [0.0; 3];
    assert_eq!(scene.facts().shadow_cascades, 0);
}

/// The scene with all its lengths and its camera's multiplied.
fn times(scene: &Scene, factor: f64) -> Scene {
    let mut scaled = scene.clone();
    for object in &mut scaled.objects {
        object.transform = DMat4::from_scale(DVec3::splat(factor)) * object.transform;
    }
    scaled.camera.transform.w_axis = (scene.camera.position() * factor).extend(1.0);
    scaled.camera.near = (f64::from(scene.camera.near) * factor) as f32;
    scaled
}

#[test]
fn a_scene_in_another_unit_is_cut_alike() {
    let scene = scene();
    for factor in [1e-5, 1e-3, 0.0254, 3.0, 1e3, 1e6] {
        let scaled = times(&scene, factor);
        for index in 0..4 {
            let whole = Cascade { reach: None, ..cascade(index, 4) };
            let [one, other] = [&scene, &scaled].map(|scene| sun_view(scene, &scene.camera, ASPECT, whole, TEXELS));
            let is_close = |one: f64, other: f64| (one * factor / other - 1.0).abs() < 1e-5;
            assert!(is_close(one.reach, other.reach), "× {factor}: {} and {}", one.reach, other.reach);
            assert!(is_close(one.texel, other.texel), "× {factor}: {} and {}", one.texel, other.texel);
        }
        let (size, expected) = (scaled.size(), scene.size() * factor);
        assert!((size / expected - 1.0).abs() < 1e-9, "× {factor}: {size} and {expected}");
        assert_eq!(scaled.facts().shadow_cascades, scene.facts().shadow_cascades);
    }
}
