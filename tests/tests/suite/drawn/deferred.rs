//! Deferred lighting is held against forward lighting, pixel by pixel, and the way of a normal through the G-buffer against
//! its twin (NU-5).

use framewright_passes::scene::{Scene, load};
use framewright_passes::twin::g_buffer::{from_octahedral, octahedral};
use framewright_passes::twin::tone_mapping::reinhard;
use framewright_tests::render::{Setup, device, in_repository, render};
use framewright_tests::shapes::{self, material, square};
use glam::{DVec2, DVec3, Mat4, Vec3};
use std::error::Error;
use std::path::Path;

/// A normal in two half floats is at most this far astray, radians: coordinates near 1 are cut off to 2⁻¹¹ by drivers that
/// round towards zero, and the octahedron's corners magnify that by √3 times √2.
const ASTRAY: f64 = 2.5 / 2048.0;
/// How far apart forward and deferred pictures are at most, shown by Reinhard's curve in 8-bit steps: base colour is rounded
/// to 8 bits, which is half a step, and the highlight takes a 64th power of a normal that is [`ASTRAY`].
const STEPS: f64 = 1.0;
/// And in linear light: base colour is rounded by at most 1/510 in its encoding, whose slope is at most 2.28, which light
/// multiplies; emitted light by 2⁻¹⁰ of itself.
const ROUNDED: f64 = 0.0046;

struct Pictures {
    forward: Vec<[f32; 4]>,
    deferred: Vec<[f32; 4]>,
    normals: Vec<[f32; 4]>,
}

const EXTENT: [u32; 2] = [200, 120];

fn pictures(scene: &Scene) -> Result<Option<Pictures>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let setup = Setup { pipeline: "tests/pipelines/deferred.ron", set: &[], scene, extent: EXTENT };
    let outputs = render(device, &setup)?;
    let texels = |output: usize| -> Vec<[f32; 4]> {
        let (words, _) = outputs[output].bytes.as_chunks::<4>();
        let floats: Vec<f32> = words.iter().map(|word| f32::from_ne_bytes(*word)).collect();
        floats.as_chunks::<4>().0.to_vec()
    };
    Ok(Some(Pictures { forward: texels(0), deferred: texels(1), normals: texels(2) }))
}

/// The encoding of the screen (IEC 61966-2-1), in 8-bit steps.
fn shown(radiance: f32) -> f64 {
    let linear = reinhard(f64::from(radiance));
    255.0 * if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn demand_agreement(name: &str, scene: &Scene) -> Result<(), Box<dyn Error>> {
    let Some(Pictures { forward, deferred, .. }) = pictures(scene)? else { return Ok(()) };
    let (mut apart, mut share, mut seen) = (0.0_f64, 0.0_f64, 0);
    for (index, (forward, deferred)) in forward.iter().zip(&deferred).enumerate() {
        seen += usize::from(forward[..3] != [0.0; 3]);
        for (forward, deferred) in forward[..3].iter().zip(&deferred[..3]) {
            let steps = (shown(*forward) - shown(*deferred)).abs();
            assert!(steps <= STEPS, "{name}, pixel {index}: {forward} and {deferred} are {steps} steps apart");
            apart = apart.max(steps);
            share = share.max(f64::from((forward - deferred).abs() / forward.max(0.05)));
        }
    }
    assert!(seen > 1000, "{name}: only {seen} pixels show an object");
    println!("{name}: at most {apart} steps, {share} of the radiance, over {seen} pixels");
    Ok(())
}

#[test]
fn the_shipped_scene_lit_deferred_is_the_scene_lit_forward() -> Result<(), Box<dyn Error>> {
    demand_agreement("spheres_and_cubes", &load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?)
}

#[test]
fn real_models_lit_deferred_are_the_models_lit_forward() -> Result<(), Box<dyn Error>> {
    for name in ["CesiumMilkTruck.glb", "AlphaBlendModeTest.glb", "Duck.glb"] {
        let path = in_repository(&Path::new("../shared/models").join(name).to_string_lossy());
        if !path.exists() {
            eprintln!("skipped: {} is not here", path.display());
            continue;
        }
        demand_agreement(name, &load(&path)?)?;
    }
    Ok(())
}

#[test]
fn an_evenly_lit_surface_differs_by_no_more_than_its_base_colour_is_rounded() -> Result<(), Box<dyn Error>> {
    let mut scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    // Without a sun nothing is mirrored.
    scene.sun.color = [0.0; 3];
    scene.point_lights.clear();
    scene.ambient = [1.0; 3];
    let Some(Pictures { forward, deferred, .. }) = pictures(&scene)? else { return Ok(()) };
    for (forward, deferred) in forward.iter().zip(&deferred) {
        for (forward, deferred) in forward[..3].iter().zip(&deferred[..3]) {
            let bound = ROUNDED + f64::from(*forward) / 1024.0;
            assert!(f64::from((forward - deferred).abs()) <= bound, "{forward} and {deferred}");
        }
    }
    Ok(())
}

#[test]
fn normals_go_into_the_g_buffer_as_their_twin_says_and_hardly_go_astray() -> Result<(), Box<dyn Error>> {
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    let Some(Pictures { normals, .. }) = pictures(&scene)? else { return Ok(()) };
    for (index, texel) in normals.iter().enumerate() {
        let (x, y) = (index % EXTENT[0] as usize, index / EXTENT[0] as usize);
        let [u, v] = [(x, EXTENT[0]), (y, EXTENT[1])].map(|(at, side)| (at as f64 + 0.5) / f64::from(side));
        let height = 1.0 - 2.0 * v;
        let (sine, cosine) = (std::f64::consts::TAU * u).sin_cos();
        let unit = (DVec2::new(cosine, sine) * (1.0 - height * height).sqrt()).extend(height);
        let expected = octahedral(unit);
        let found = DVec2::new(texel[0].into(), texel[1].into());
        // The driver's own sine and cosine are within 2⁻¹¹ by Vulkan's rules.
        assert!((found - expected).abs().max_element() < 2e-3, "{unit}: {found} instead of {expected}");
        assert!(f64::from(texel[3]) <= ASTRAY, "{unit} goes {} astray", texel[3]);
    }
    Ok(())
}

#[test]
fn the_octahedron_leads_everywhere_and_back() {
    for step in 0..20_000 {
        let height = 1.0 - (f64::from(step) + 0.5) / 10_000.0;
        let (sine, cosine) = (2.399_963 * f64::from(step)).sin_cos();
        let unit = (DVec2::new(cosine, sine) * (1.0 - height * height).sqrt()).extend(height);
        let point = octahedral(unit);
        assert!(point.abs().max_element() <= 1.0 + 1e-12);
        assert!((from_octahedral(point) - unit).length() < 1e-12, "{unit}");
    }
    for axis in [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z] {
        assert_eq!(from_octahedral(octahedral(axis)), axis);
    }
}

/// Of the shipped pipeline for devices with slow memory: along the upper edge of a slanted square that shines, brightness goes
/// from column to column by small steps, where without smoothing it jumps by the height of a texel.
#[test]
fn edges_of_half_the_size_are_smoothed_before_they_are_made_larger() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut glow = material([0.0, 0.0, 0.0, 1.0]);
    glow.emissive = [2.0; 3];
    let place = Mat4::from_rotation_z(0.12) * Mat4::from_scale(Vec3::splat(1.5));
    let scene = shapes::scene(vec![square()], vec![glow], vec![(0, 0, place)]);
    let jumps = |set: &[(&str, &str)]| -> Result<u32, Box<dyn Error>> {
        let setup = Setup { pipeline: "examples/pipelines/deferred_mobile.ron", set, scene: &scene, extent: EXTENT };
        let picture = render(device, &setup)?.swap_remove(0);
        let [width, height] = EXTENT.map(|side| side as usize);
        let sum = |x: usize| -> u32 { (0..height / 2).map(|y| u32::from(picture.bytes[4 * (y * width + x)])).sum() };
        let middle = width / 2 - 25..width / 2 + 25;
        Ok(middle.map(|x| sum(x + 1).abs_diff(sum(x))).max().unwrap_or(0))
    };
    let [smooth, rough] = [jumps(&[("bloom", "0")])?, jumps(&[("bloom", "0"), ("anti_aliasing", "false")])?];
    println!("from column to column at most {smooth} steps, {rough} without anti-aliasing");
    assert!(2 * smooth < rough, "{smooth} steps from column to column, {rough} without anti-aliasing");
    Ok(())
}
