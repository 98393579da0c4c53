//! Claims about the lists of point lights: no place lacks a light that reaches it, and the lists are short.

use framewright_passes::draw::clusters::Clusters;
use framewright_passes::scene::{Camera, PointLight, Scene, load};
use glam::DVec3;
use proptest::prelude::*;
use std::path::Path;

fn scene(point_lights: Vec<PointLight>) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes/spheres_and_cubes.ron");
    Scene { point_lights, ..load(&path).expect("it is shipped") }
}

fn light(position: [f32; 3], range: Option<f32>) -> PointLight {
    PointLight { position: position.map(f64::from), color: [1.0; 3], intensity: 1.0, range, shadows: false }
}

/// A place that the camera sees: `x` and `y` of the picture from −1 to 1, and metres along its axis.
fn seen(camera: &Camera, aspect: f64, [x, y]: [f64; 2], depth: f64) -> DVec3 {
    let tangent = (f64::from(camera.vertical_fov) * 0.5).tan();
    let from_camera = DVec3::new(x * tangent * aspect, y * tangent, -1.0) * depth;
    camera.transform.transform_vector3(from_camera)
}

prop_compose! {
    fn lights()(
        places in prop::collection::vec((prop::array::uniform3(-12.0_f32..12.0), prop::option::weighted(0.9, 0.01_f32..6.0)), 1..60)
    ) -> Vec<PointLight> {
        places.into_iter().map(|(position, range)| light(position, range)).collect()
    }
}

prop_compose! {
    fn cameras()(
        eye in prop::array::uniform3(-9.0_f64..9.0), target in prop::array::uniform3(-9.0_f64..9.0),
        fov in 0.2_f32..2.8, near in 0.001_f32..2.0,
    ) -> Option<Camera> {
        Camera::look_at(eye.into(), target.into(), DVec3::Y, fov, near)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn no_place_that_is_seen_lacks_a_light_that_reaches_it(
        lights in lights(), camera in cameras(), aspect in 0.3_f64..3.0,
        // Beyond the picture's borders too: samples at edges of triangles may lie there.
        places in prop::collection::vec((prop::array::uniform2(-1.1_f64..1.1), 0.0_f64..1.0), 200),
        // Where an eye sees that stands farther back: to the right, up and back, in near planes and in metres.
        others in prop::collection::vec((prop::array::uniform3(-3.0_f64..3.0), any::<bool>()), 100),
    ) {
        let Some(camera) = camera else { return Ok(()) };
        let scene = scene(lights);
        let clusters = Clusters::new(&scene, &camera, aspect);
        let mut once = clusters.order.clone();
        once.sort_unstable();
        prop_assert!(once.iter().copied().eq(0..scene.point_lights.len() as u32), "not each light once: {once:?}");
        let near = f64::from(camera.near);
        // From the near plane to far behind everything.
        let before = places.into_iter().map(|(at, depth)| seen(&camera, aspect, at, near * (1e5_f64).powf(depth)));
        let back = others.into_iter().map(|([right, up, back], metres)| {
            let back = back.max(-1.0) * if metres && back > 0.0 { 1.0 } else { near };
            camera.transform.transform_vector3(DVec3::new(right, up, back))
        });
        for place in before.chain(back) {
            let found = clusters.at(place);
            for (order, number) in clusters.order.iter().enumerate().skip(clusters.everywhere as usize) {
                let light = &scene.point_lights[*number as usize];
                let from_camera = DVec3::from(light.position) - camera.position();
                let reaches = light.falloff(from_camera.distance(place), 0.01) > 0.0;
                prop_assert!(!reaches || found.contains(&(order as u32)), "{place}: {light:?} is missing");
            }
        }
    }
}

#[test]
fn lights_without_a_range_are_looked_at_everywhere_and_so_are_those_that_reach_nearly_everything() {
    let scene = scene(vec![
        light([0.0, 1.0, 0.0], Some(0.5)),
        light([0.0, 1.0, 0.0], None),
        light([2.0, 1.0, 0.0], Some(0.4)),
        light([0.0, 9.0, 0.0], Some(1e30)),
    ]);
    let clusters = Clusters::new(&scene, &scene.camera, 1.5);
    assert_eq!((clusters.everywhere, &clusters.order[..]), (2, &[1, 3, 0, 2][..]));
}

#[test]
fn a_thousand_lights_of_small_range_are_few_at_any_place() {
    let at = |number: u32| {
        let turn = f64::from(number) * 2.399_963;
        let out = f64::from(number).sqrt() * 0.3;
        light([(turn.cos() * out) as f32, 0.4, (turn.sin() * out) as f32], Some(0.6))
    };
    let scene = scene((0..1000).map(at).collect());
    let clusters = Clusters::new(&scene, &scene.camera, 1.5);
    assert_eq!(clusters.everywhere, 0);
    let (mut looked_at, mut reaching, mut places) = (0, 0, 0);
    for step in 0..4000 {
        let (x, y) = (f64::from(step % 63) / 31.5 - 1.0, f64::from(step / 63) / 32.0 - 1.0);
        let eye = scene.camera.position();
        let towards = seen(&scene.camera, 1.5, [x, y], 1.0);
        // Where the floor is seen.
        let along = -eye.y / towards.y;
        if towards.y < 0.0 && along < 30.0 {
            let place = towards * along;
            let distance = |light: &&PointLight| (DVec3::from(light.position) - eye).distance(place);
            looked_at += clusters.at(place).len();
            reaching += scene.point_lights.iter().filter(|light| light.falloff(distance(light), 0.01) > 0.0).count();
            places += 1;
        }
    }
    assert!(places > 1000 && reaching > places, "{reaching} lights reach {places} places");
    assert!(looked_at < 10 * reaching, "{looked_at} lights are looked at for the {reaching} that reach a place");
    assert!(looked_at < 16 * places, "{looked_at} lights are looked at in {places} places");
}
