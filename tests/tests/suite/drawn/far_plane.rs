//! A camera with a far plane (NU-4): nothing beyond it is drawn, depth is 0 on it, and every shader that makes distances or
//! places of depth shows what it shows without one.

use framewright_passes::scene::{Scene, load};
use framewright_passes::twin::distance::{depth_at, distance_at};
use framewright_passes::twin::effects::stripe;
use framewright_tests::raycast::RayCaster;
use framewright_tests::render::{Setup, device, floats, in_repository, render};
use framewright_tests::shapes::{material, scene, sphere, square};
use glam::{DVec2, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [67, 45];
/// The error that Vulkan allows a sine, 2⁻¹¹, twice over since it is squared.
const SINE: f64 = 2.0 / 2048.0;

/// A ball 3.4 m away, and a floor that leads from 4 m away far beyond the far plane.
fn floor_and_ball(far: Option<f32>) -> Scene {
    let floor =
        Mat4::from_translation(Vec3::new(0.0, -1.0, -30.0)) * Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let floor = floor * Mat4::from_scale(Vec3::splat(31.0));
    let ball = Mat4::from_translation(Vec3::new(-0.5, 0.4, 0.6));
    let mut scene = scene(vec![square(), sphere(16)], vec![material([1.0; 4])], vec![(0, 0, floor), (1, 0, ball)]);
    scene.camera.far = far;
    scene
}

/// NU-4: depth and stripes are those of the distances at which rays meet the scene; beyond the far plane nothing is drawn.
#[test]
fn depth_and_stripes_are_their_twins_and_nothing_beyond_is_drawn() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for far in [None, Some(1e8), Some(100.0), Some(9.0), Some(4.6)] {
        let scene = floor_and_ball(far);
        let set = [("period", "0.37")];
        let setup = Setup { pipeline: "tests/pipelines/depth_stripes.ron", set: &set, scene: &scene, extent: EXTENT };
        let red: Vec<Vec<f64>> =
            render(device, &setup)?.iter().map(|output| floats(output).into_iter().step_by(4).collect()).collect();
        let [depths, blended, copied] = &red[..] else { return Err("not three outputs".into()) };
        let (near, plane) = (f64::from(scene.camera.near), far.map(f64::from));
        let caster = RayCaster::new(&scene);
        let [mut seen, mut empty] = [0, 0];
        for (at, depth) in depths.iter().enumerate() {
            let middle = DVec2::new((at % EXTENT[0] as usize) as f64, (at / EXTENT[0] as usize) as f64) + 0.5;
            let met =
                |off: DVec2| caster.cast(&caster.camera_ray(middle + off, EXTENT)).map(|hit| (hit.object, hit.depth));
            let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y)| met(DVec2::new(x, y)));
            let Some((object, distance)) = met(DVec2::ZERO) else {
                if corners.iter().all(Option::is_none) {
                    assert!(*depth == 0.0 && blended[at] == 1.0 && copied[at] == 1.0, "{far:?}, {at}: {depth}");
                    empty += 1;
                }
                continue;
            };
            if corners.iter().any(|corner| corner.is_none_or(|(it, _)| it != object)) {
                continue;
            }
            // A 16th of a pixel, to which drivers snap corners.
            let around = corners.iter().flatten().map(|(_, it)| (it - distance).abs()).fold(0.0, f64::max) / 16.0;
            let [least, most] = [distance + around, distance - around].map(|it| depth_at(it, near, plane));
            let slack = 1e-5 * near / distance;
            assert!((least - slack..=most + slack).contains(depth), "{far:?}, {at}: {depth}, not {least} to {most}");
            let found = distance_at(*depth, near, plane);
            let expected = stripe(near / found, near, 0.37);
            // Some roundings of the distance, those of depth magnified by how near the far plane is.
            let roundings = found / 0.37 * (4.0 + plane.map_or(0.0, |plane| found / (plane - found).max(1e-3)));
            let bound = SINE + std::f64::consts::PI * roundings * 2_f64.powi(-22);
            for light in [blended[at], copied[at]] {
                assert!((light - expected).abs() <= bound, "{far:?}, {at}: {light} instead of {expected}");
            }
            seen += 1;
        }
        assert!(seen > 150 && empty > 150, "{far:?}: {seen} texels show something, {empty} nothing");
    }
    Ok(())
}

/// The picture without and with a far plane, of a scene that ends before it.
fn demand_the_same(pipeline: &str, set: &[(&str, &str)], file: &str, far: f32) -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut scene = load(&in_repository(&format!("examples/scenes/{file}.ron")))?;
    let pipeline = format!("examples/pipelines/{pipeline}.ron");
    let mut picture = |far| {
        scene.camera.far = far;
        render(device, &Setup { pipeline: &pipeline, set, scene: &scene, extent: [96, 60] })
    };
    let (without, with) = (picture(None)?, picture(Some(far))?);
    assert_eq!(without.len(), with.len());
    for (without, with) in without.iter().zip(&with) {
        let pixels = without.bytes.as_chunks::<4>().0.iter().zip(with.bytes.as_chunks::<4>().0);
        let apart = pixels.filter(|(one, other)| one.iter().zip(*other).any(|(one, other)| one.abs_diff(*other) > 2));
        let apart = apart.count();
        assert!(apart <= 12, "{pipeline}: {apart} of 5760 pixels differ");
    }
    Ok(())
}

/// Distances and places out of depth: stripes, ambient occlusion, deferred lighting with clusters and shadows; motion and the
/// sky.
#[test]
fn what_is_made_of_depth_is_the_same_with_a_far_plane_close_behind_the_scene() -> Result<(), Box<dyn Error>> {
    demand_the_same("deferred", &[("ambient_occlusion", "4.0"), ("shadow_size", "512")], "courtyard", 60.0)?;
    demand_the_same("image_quality", &[("depth_stripes", "copied")], "spheres_and_cubes", 60.0)?;
    demand_the_same("temporal", &[], "passing", 60.0)
}
