//! What shadow maps show of the sun's light is held against rays, over whole pictures: edges, contacts and distant shadows too
//! (IQ-25, NU-2).

use framewright_passes::scene::{Camera, Scene, Sun, load};
use framewright_passes::twin::lighting::{lit_surface, reflect_light};
use framewright_tests::raycast::RayCaster;
use framewright_tests::raycast::triangle::Ray;
use framewright_tests::render::{Setup, device, in_repository, render, rgb};
use framewright_tests::shapes::{material, scene, square};
use glam::{DVec2, DVec3, Mat4, Vec3};
use std::error::Error;

/// Width and height.
const EXTENT: [u32; 2] = [160, 100];

/// The share of what lies in shadow that is shown in light, and of what is in light that is shown in shadow.
#[derive(Debug, Clone, Copy)]
struct Wrong {
    lost: f64,
    invented: f64,
}

/// The sun's light at a pixel after rays.
struct Sunlight {
    falls: bool,
    /// Colours without and with it.
    dark: [f64; 4],
    bright: [f64; 4],
}

/// Each pixel's, where a surface turns to the sun.
fn by_rays(scene: &Scene) -> Vec<Option<Sunlight>> {
    let caster = RayCaster::new(scene);
    let to_sun = -Vec3::from(scene.sun.direction).as_dvec3();
    let pixels =
        (0..EXTENT[0] * EXTENT[1]).map(|index| DVec2::new(f64::from(index % EXTENT[0]), f64::from(index / EXTENT[0])));
    pixels
        .map(|pixel| {
            let ray = caster.camera_ray(pixel + 0.5, EXTENT);
            let hit = caster.cast(&ray)?;
            if hit.normal.dot(to_sun) < 0.02 {
                return None;
            }
            let position = ray.origin + ray.direction * hit.depth;
            let origin = position + hit.normal * 1e-4;
            let blocked = caster.cast(&Ray { origin, direction: to_sun, spread: [DVec3::ZERO; 2] }).is_some();
            let material = &scene.materials[scene.objects[hit.object as usize].material];
            let color =
                |sunlit| lit_surface(material, hit.base_color, &reflect_light(scene, position, hit.normal, sunlit));
            Some(Sunlight { falls: !blocked, dark: color(0.0), bright: color(1.0) })
        })
        .collect()
}

fn wrong(scene: &Scene, set: &[(&str, &str)]) -> Result<Option<Wrong>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let setup = Setup { pipeline: "tests/pipelines/shadows.ron", set, scene, extent: EXTENT };
    let found = rgb(&render(device, &setup)?[0]);
    let (mut shares, mut pixels) = ([0.0; 2], [0.0; 2]);
    for (found, rays) in found.iter().zip(by_rays(scene)) {
        let Some(Sunlight { falls, dark, bright }) = rays else { continue };
        let channel = |color: &[f64]| color[..3].iter().sum::<f64>();
        let share = (channel(found) - channel(&dark)) / (channel(&bright) - channel(&dark));
        if !(-0.2..1.2).contains(&share) {
            continue;
        }
        let wrong = if falls { 1.0 - share } else { share };
        shares[usize::from(falls)] += wrong.clamp(0.0, 1.0);
        pixels[usize::from(falls)] += 1.0;
    }
    Ok(Some(Wrong { lost: shares[0] / pixels[0], invented: shares[1] / pixels[1] }))
}

/// A scene whose sun casts shadows.
fn sunny(path: &str) -> Result<Scene, Box<dyn Error>> {
    let mut scene = load(&in_repository(path))?;
    scene.sun.shadows = true;
    scene.point_lights.clear();
    Ok(scene)
}

/// With shadows through the whole scene, 400 metres deep: those of a slab of ten centimetres and of posts far away.
#[test]
fn shadows_are_found_in_a_deep_scene() -> Result<(), Box<dyn Error>> {
    let grazing = sunny("tests/scenes/grazing_sun.ron")?;
    for (cascades, taps, lost, invented) in
        [("4", "1", 0.1, 0.025), ("4", "3", 0.1, 0.025), ("4", "7", 0.13, 0.03), ("2", "3", 0.15, 0.03)]
    {
        let set = [("cascades", cascades), ("taps", taps), ("reach", "0")];
        let Some(wrong) = wrong(&grazing, &set)? else { return Ok(()) };
        assert!(wrong.lost < lost && wrong.invented < invented, "{cascades} cascades, {taps} taps: {wrong:?}");
    }
    Ok(())
}

/// A single map through a scene of some twenty metres.
#[test]
fn one_map_through_a_small_scene_keeps_most_shadows() -> Result<(), Box<dyn Error>> {
    let courtyard = sunny("examples/scenes/courtyard.ron")?;
    let set = [("cascades", "1"), ("taps", "3"), ("reach", "0")];
    let Some(wrong) = wrong(&courtyard, &set)? else { return Ok(()) };
    assert!(wrong.lost < 0.17 && wrong.invented < 0.03, "{wrong:?}");
    Ok(())
}

/// Where a map ends, the next one takes over along several pixels: light changes by a part of it from one to the next.
#[test]
fn one_map_fades_into_the_next() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let flat = Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2) * Mat4::from_scale(Vec3::splat(200.0));
    let mut floor = scene(vec![square()], vec![material([1.0; 4])], vec![(0, 0, flat)]);
    floor.camera = Camera::look_at(DVec3::new(0.0, 40.0, 0.0), DVec3::new(0.0, 0.0, -40.0), DVec3::Y, 1.2, 0.1)
        .expect("a direction");
    floor.ambient = [0.0; 3];
    floor.sun = Sun { direction: [0.0, -1.0, 0.0], color: [1.0; 3], shadows: true };
    let setup = Setup { pipeline: "tests/pipelines/cascade_border.ron", set: &[], scene: &floor, extent: EXTENT };
    let found = rgb(&render(device, &setup)?[0]);
    // From the lowest row up.
    let column: Vec<f64> =
        (0..EXTENT[1]).rev().map(|row| found[(row * EXTENT[0] + EXTENT[0] / 2) as usize][0]).collect();
    assert!(column[0] > 0.99, "the nearest are in light: {column:?}");
    let dark = column.iter().position(|light| *light < 0.01).ok_or("none lies in the farther map")?;
    let step = column[..=dark].windows(2).map(|pair| pair[0] - pair[1]).fold(0.0, f64::max);
    assert!(step < 0.4, "{step} from one pixel to the next: {column:?}");
    assert!(column[..=dark].is_sorted_by(|nearer, farther| nearer >= farther), "{column:?}");
    Ok(())
}
