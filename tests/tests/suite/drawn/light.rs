//! Lit surfaces are held against the twin of the lighting formulas (NU-5) where the ray-caster sees them.

use framewright_passes::scene::{AlphaMode, PointLight, Scene, Sun};
use framewright_passes::twin::lighting::{lit_surface, reflect_light};
use framewright_tests::raycast::RayCaster;
use framewright_tests::render::{Setup, device, render};
use framewright_tests::shapes::{material, scene, square};
use glam::{DVec2, DVec3, EulerRot, Mat4, Quat, Vec3};
use std::error::Error;

/// Width and height.
const EXTENT: [u32; 2] = [80, 60];
/// Drivers snap corners to a 16th of a pixel or finer before they interpolate positions.
const SNAP: f64 = 1.0 / 16.0;
/// Largest error of a channel, relative to it, beyond what snapping explains: positions and normals reach the shader in 32
/// bits, and the highlight takes a 64th power.
const RELATIVE: f64 = 2e-4;

/// Flat surfaces, so that the triangle's normal is the surface's: turned, stretched, mirrored, seen from behind.
fn surfaces() -> Scene {
    let mut glass = material([0.9, 0.5, 0.4, 0.3]);
    glass.alpha = AlphaMode::Blend;
    let mut leaf = material([0.3, 0.8, 0.2, 0.9]);
    leaf.alpha = AlphaMode::Mask { cutoff: 0.5 };
    leaf.double_sided = true;
    let mut lamp = material([0.2, 0.2, 0.2, 0.5]);
    lamp.emissive = [0.0, 3.0, 1e6];
    let place = |at: [f32; 3], turn: [f32; 3], scale: [f32; 3]| {
        let turn = Quat::from_euler(EulerRot::XYZ, turn[0], turn[1], turn[2]);
        Mat4::from_scale_rotation_translation(Vec3::from(scale), turn, Vec3::from(at))
    };
    scene(
        vec![square()],
        vec![material([0.8, 0.7, 0.6, 1.0]), glass, leaf, lamp],
        vec![
            (0, 0, place([0.0, -1.0, -2.0], [-1.2, 0.0, 0.0], [4.0, 3.0, 1.0])),
            (0, 0, place([-1.5, 0.4, 0.0], [0.3, 0.5, 0.2], [0.7, 1.4, 0.2])),
            (0, 1, place([0.3, 0.5, 0.5], [0.0, -0.4, 0.0], [-0.6, 0.6, 1.0])),
            (0, 2, place([1.7, 0.6, 0.0], [0.2, 2.8, 0.0], [0.6, 0.9, 1.0])),
            (0, 3, place([0.0, 1.8, -1.0], [0.4, 0.0, 0.0], [1.0, 0.5, 1.0])),
        ],
    )
}

fn demand_twin(scene: &Scene) -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let setup = Setup { pipeline: "tests/pipelines/lit.ron", set: &[], scene, extent: EXTENT };
    let outputs = render(device, &setup)?;
    let (texels, _) = outputs[0].bytes.as_chunks::<16>();
    let caster = RayCaster::new(scene);
    let mut seen = vec![0; scene.objects.len()];
    for (index, texel) in texels.iter().enumerate() {
        let (x, y) = ((index % EXTENT[0] as usize) as f64 + 0.5, (index / EXTENT[0] as usize) as f64 + 0.5);
        let ray = |dx, dy| caster.camera_ray(DVec2::new(x + dx, y + dy), EXTENT);
        let object = |dx, dy| caster.cast(&ray(dx, dy)).map(|hit| hit.object);
        let Some(hit) = caster.cast(&ray(0.0, 0.0)) else { continue };
        let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];
        if corners.iter().any(|&(dx, dy)| object(dx, dy) != Some(hit.object)) {
            continue;
        }
        seen[hit.object as usize] += 1;
        let material = &scene.materials[scene.objects[hit.object as usize].material];
        let twin = |(dx, dy)| {
            let ray = ray(dx, dy);
            let hit = caster.cast(&ray)?;
            let position = ray.origin + ray.direction * hit.depth;
            Some(lit_surface(material, hit.base_color, &reflect_light(scene, position, hit.normal, 1.0)))
        };
        let places = [(0.0, 0.0), (-SNAP, 0.0), (SNAP, 0.0), (0.0, -SNAP), (0.0, SNAP)];
        let expected: Vec<[f64; 4]> = places.into_iter().filter_map(twin).collect();
        for channel in 0..4 {
            let word: [u8; 4] = texel[4 * channel..4 * channel + 4].try_into()?;
            let found = f64::from(f32::from_ne_bytes(word));
            let least = expected.iter().map(|color| color[channel]).fold(f64::INFINITY, f64::min);
            let most = expected.iter().map(|color| color[channel]).fold(0.0, f64::max);
            let close = (least * (1.0 - RELATIVE) - 1e-6..=most * (1.0 + RELATIVE) + 1e-6).contains(&found);
            assert!(close, "({x}, {y}) object {} channel {channel}: {found}, not {least} to {most}", hit.object);
        }
    }
    assert!(seen.iter().all(|pixels| *pixels > 20), "some object hardly shows: {seen:?}");
    Ok(())
}

#[test]
fn the_sun_with_its_highlight_and_ambient_light_are_their_twins() -> Result<(), Box<dyn Error>> {
    let mut scene = surfaces();
    scene.ambient = [0.1, 0.15, 0.2];
    // Object 1 mirrors the sun right to the camera.
    let mirror = scene.objects[1].transform;
    let normal = mirror.transform_vector3(DVec3::Z).normalize();
    let to_camera = (scene.camera.position() - mirror.transform_point3(DVec3::ZERO)).normalize();
    let to_sun = 2.0 * normal.dot(to_camera) * normal - to_camera;
    scene.sun = Sun { direction: (-to_sun).as_vec3().to_array(), color: [30.0, 2.5, 2.0], shadows: false };
    demand_twin(&scene)
}

#[test]
fn point_lights_with_and_without_range_are_their_twins() -> Result<(), Box<dyn Error>> {
    let mut scene = surfaces();
    let light = |position, color, intensity, range| PointLight { position, color, intensity, range, shadows: false };
    scene.point_lights = vec![
        light([0.0, 2.0, 2.0], [1.0, 0.9, 0.8], 100.0, None),
        light([-1.0, 0.5, 1.0], [0.0, 1.0, 0.5], 0.5, Some(1.5)),
        light([2.0, -0.5, 0.5], [1.0, 0.0, 0.0], 2.0, Some(1e30)),
    ];
    demand_twin(&scene)
}
