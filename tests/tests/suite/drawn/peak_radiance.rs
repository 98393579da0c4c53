//! The fact `scene.peak_radiance` is held against pictures (NU-6): no pixel of any scene is brighter than it says.

use framewright_passes::scene::{Camera, PointLight, Scene, Sun, load};
use framewright_tests::render::{Setup, device, in_repository, render};
use framewright_tests::shapes::{material, scene, sphere, square};
use framewright_vulkan::Device;
use glam::{DVec3, Mat4, Vec3};
use std::error::Error;

/// 32-bit arithmetic on the way, and the rounding of half floats at its end.
const ROUNDING: f64 = 1.0 + 2e-3;

/// The brightest channel of any pixel.
fn brightest(device: &Device, scene: &Scene) -> Result<f64, Box<dyn Error>> {
    let setup = Setup { pipeline: "tests/pipelines/radiance.ron", set: &[], scene, extent: [96, 64] };
    let outputs = render(device, &setup)?;
    let (words, _) = outputs[0].bytes.as_chunks::<4>();
    let floats = words.iter().map(|word| f64::from(f32::from_ne_bytes(*word)));
    Ok(floats.enumerate().filter(|(at, _)| at % 4 != 3).map(|(_, value)| value).fold(0.0, f64::max))
}

/// The brightest channel of a scene, which its fact must bound.
fn demand_bound(device: &Device, shown: &str, scene: &Scene) -> Result<f64, Box<dyn Error>> {
    let (found, bound) = (brightest(device, scene)?, scene.facts().peak_radiance);
    assert!(found <= bound * ROUNDING, "{shown}: {found} is brighter than {bound}");
    println!("{shown}: brightest {found}, bound {bound}");
    Ok(found)
}

/// The scene as seen from elsewhere: the fact holds for all cameras.
fn seen_from(scene: &Scene, position: DVec3, target: DVec3) -> Scene {
    let camera = Camera::look_at(position, target, DVec3::Y, 1.0, 0.01).unwrap_or(scene.camera);
    Scene { camera, ..scene.clone() }
}

#[test]
fn no_pixel_of_a_real_scene_is_brighter_than_its_peak() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut files = vec![in_repository("examples/scenes/spheres_and_cubes.ron")];
    match std::fs::read_dir(in_repository("../shared/models")) {
        Ok(folder) => files.extend(
            folder
                .filter_map(|file| Some(file.ok()?.path()))
                .filter(|file| file.extension().is_some_and(|end| end == "glb")),
        ),
        Err(error) => eprintln!("skipped: models beside the repository: {error}"),
    }
    files.sort();
    for file in files {
        let shown = file.display().to_string();
        let scene = load(&file)?;
        demand_bound(device, &shown, &scene)?;
        let (middle, radius) = scene.bounds().map_or((DVec3::ZERO, 1.0), |it| (it.center(), it.radius()));
        let to_sun = -Vec3::from(scene.sun.direction).as_dvec3();
        // Against the sun, where surfaces mirror it and the sky shows it.
        let behind = middle - to_sun * DVec3::new(1.0, -0.2, 1.0) * radius;
        demand_bound(device, &shown, &seen_from(&scene, behind, middle))?;
        let sky = demand_bound(
            device,
            &shown,
            &seen_from(&scene, middle + DVec3::Y * 9.0 * radius, middle + DVec3::Y * 9.0 * radius + to_sun),
        )?;
        let sun = scene.sun.color.iter().fold(0.0_f32, |most, channel| most.max(*channel));
        assert!(sky > 2.0 * f64::from(sun), "{shown}: the sun isn't in the picture");
    }
    Ok(())
}

/// Little slack where it can be known exactly: a square that faces a light near by. Glass before a lamp may add what it emits,
/// layer for layer.
#[test]
fn the_peak_is_nearly_reached_by_scenes_made_to_reach_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut lit = scene(vec![square()], vec![material([0.5, 1.0, 0.25, 1.0])], vec![(0, 0, Mat4::IDENTITY)]);
    lit.ambient = [0.1; 3];
    let (position, color) = ([0.0, 0.0, 0.5], [1.0, 2.0, 3.0]);
    lit.point_lights = vec![PointLight { position, color, intensity: 5.0, range: Some(20.0), shadows: false }];
    assert!(demand_bound(device, "a light near a square", &lit)? > 0.95 * lit.facts().peak_radiance);

    let mut lamp = material([0.0, 0.0, 0.0, 1.0]);
    lamp.emissive = [3.0, 0.5, 0.0];
    let mut glass = material([0.0, 0.0, 0.0, 0.5]);
    glass.emissive = [0.5, 0.0, 0.0];
    glass.alpha = framewright_passes::scene::AlphaMode::Blend;
    let at = |z: f32| Mat4::from_translation(Vec3::new(0.0, 0.0, z));
    let glowing = scene(vec![square()], vec![lamp, glass], vec![(0, 0, at(0.0)), (0, 1, at(1.0)), (0, 1, at(2.0))]);
    // 3 behind two panes of half the light each, and what both add.
    assert!((demand_bound(device, "a lamp behind glass", &glowing)? - (0.75 + 0.25 + 0.5)).abs() < 1e-2);
    Ok(())
}

#[test]
fn a_scene_whose_peak_is_at_most_one_shows_nothing_brighter() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut dim = scene(vec![sphere(16)], vec![material([1.0, 0.9, 0.8, 1.0])], vec![(0, 0, Mat4::IDENTITY)]);
    dim.ambient = [0.5; 3];
    dim.sun = Sun { direction: Vec3::new(-1.0, -1.0, -1.0).normalize().to_array(), color: [0.2; 3], shadows: false };
    assert!(dim.facts().peak_radiance <= 1.0);
    let brightest = brightest(device, &dim)?;
    assert!(brightest <= 1.0 && brightest > 0.5, "{brightest}");
    Ok(())
}
