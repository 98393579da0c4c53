//! The effect of samples on edges, and their cost: compared with pictures of 256 samples a pixel.

use crate::drawn::image_quality::{DIRECT, MANY, Picture, Set, picture, shining};
use framewright_graph::compile::Options;
use framewright_passes::scene::{AlphaMode, Material, Sampler, Scene, Texture};
use framewright_tests::raycast::RayCaster;
use framewright_tests::render::{Setup, device, draw, silent};
use framewright_tests::shapes::{empty_scene, material, scene, square};
use glam::{DVec2, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [32, 24];
/// The picture with one sample at a multiple of the size, averaged.
fn converged(set: Set<'_>, light: f32) -> Result<Option<Picture>, Box<dyn Error>> {
    let large = picture(&[set, &[("msaa", "1")]].concat(), &shining([light; 3]), EXTENT.map(|side| side * MANY))?;
    Ok(large.map(|large| large.shrunk(MANY as usize)))
}

/// The reference of the tests below, `converged`, is right itself: rays through the same places show as much of the square.
/// Rays that graze its edge may fall to either side.
#[test]
fn pictures_of_256_samples_show_what_rays_meet() -> Result<(), Box<dyn Error>> {
    const LIGHT: f32 = 0.8;
    let Some(exact) = converged(&DIRECT, LIGHT)? else { return Ok(()) };
    let scene = shining([LIGHT; 3]);
    let caster = RayCaster::new(&scene);
    let many = EXTENT.map(|side| side * MANY);
    let met = |x: u32, y: u32| {
        let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        caster.cast(&caster.camera_ray(at, many)).is_some()
    };
    // Two rays of a pixel, and half an 8-bit step, which at this brightness is less than 1/250.
    let tolerance = f64::from(LIGHT) * 2.0 / f64::from(MANY * MANY) + 0.5 / 125.0;
    let mut partly = 0;
    for (pixel, (x, y)) in exact.pixels.iter().zip((0..EXTENT[1]).flat_map(|y| (0..EXTENT[0]).map(move |x| (x, y)))) {
        let rays = (0..MANY * MANY).filter(|ray| met(x * MANY + ray % MANY, y * MANY + ray / MANY)).count();
        let share = rays as f64 / f64::from(MANY * MANY);
        let expected = f64::from(LIGHT) * share;
        assert!((pixel[0] - expected).abs() <= tolerance, "({x}, {y}): {} instead of {expected}", pixel[0]);
        partly += usize::from(share > 0.0 && share < 1.0);
    }
    assert!(partly > 40, "{partly} pixels hold an edge");
    Ok(())
}

/// IQ-6: by atomic counting, of the one triangle that covers the whole target; without the texels on its diagonals, along which
/// drivers that clip cut it in two.
#[test]
fn a_fragment_shader_runs_once_a_texel_whatever_the_samples() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let all = (0..48).flat_map(|y| (0..64).map(move |x| [3 * (2 * x + 1), 4 * (2 * y + 1)]));
    let texels = all.filter(|[x, y]: &[i32; 2]| (x - y).abs() > 7 && (x + y - 2 * 3 * 64).abs() > 7).count();
    assert!(texels > 64 * 48 * 9 / 10, "nearly all: {texels}");
    for (msaa, samples) in [("1", texels), ("4", 4 * texels)] {
        let (set, scene) = ([("msaa", msaa)], empty_scene());
        let setup = Setup { pipeline: "tests/pipelines/invocations.ron", set: &set, scene: &scene, extent: [8, 8] };
        let (_, mut executor) = draw(device, &setup, &Options { demote: false, ..Options::default() }, 1)?;
        let output = executor.read(0)?;
        silent(device)?;
        let (words, _) = output.bytes.as_chunks::<4>();
        let counted: Vec<f32> = words.iter().map(|word| f32::from_ne_bytes(*word)).collect();
        assert_eq!(
            counted[..2],
            [texels as f32, samples as f32],
            "{msaa}×: once a texel, and once a sample if it asks"
        );
    }
    Ok(())
}

/// IQ-6, IQ-4: the error of an edge falls with samples, and with scale by the area filter, also beyond 2.
#[test]
fn edges_improve_with_samples_and_with_scale() -> Result<(), Box<dyn Error>> {
    let Some(exact) = converged(&DIRECT, 0.8)? else { return Ok(()) };
    let error = |more: Set<'_>| -> Result<f64, Box<dyn Error>> {
        let set = [&DIRECT[1..], more].concat();
        let Some(found) = picture(&set, &shining([0.8; 3]), EXTENT)? else { return Ok(f64::NAN) };
        Ok(found.error_from(&exact))
    };
    let [one, four] = [error(&[("msaa", "1")])?, error(&[("msaa", "4")])?];
    let scaled = |scale| error(&[("msaa", "1"), ("render_scale", scale)]);
    let [two, three, as_many] = [scaled("2")?, scaled("3")?, scaled("4")?];
    println!("1 sample {one:.4}, 4 samples {four:.4}; scale 2 {two:.4}, 3 {three:.4}, 4 {as_many:.4}");
    assert!(four < 0.6 * one, "4 samples: {four}, one: {one}");
    assert!(two < 0.7 * one && three < two && as_many < three, "scale 2: {two}, 3: {three}, 4: {as_many}, 1: {one}");
    Ok(())
}

/// The errors of an edge before a lamp, of what is shown by Reinhard's curve: by the plain average, and otherwise.
fn errors(otherwise: (&'static str, &'static str)) -> Result<Option<[f64; 2]>, Box<dyn Error>> {
    const LAMP: f32 = 60.0;
    let common = [("tone_mapping", "reinhard"), ("msaa", "4")];
    let Some(exact) = converged(&common[..1], LAMP)? else { return Ok(None) };
    let [Some(plain), Some(remedied)] = [
        picture(&[common[0], common[1], ("mapped", "pixels")], &shining([LAMP; 3]), EXTENT)?,
        picture(&[common[0], common[1], ("mapped", "pixels"), otherwise], &shining([LAMP; 3]), EXTENT)?,
    ] else {
        return Ok(None);
    };
    Ok(Some([plain.error_from(&exact), remedied.error_from(&exact)]))
}

/// IQ-20: "MSAA degrades when HDR colours are involved", and the remedy.
#[test]
fn a_lamp_does_not_spoil_edges_where_bright_samples_weigh_less() -> Result<(), Box<dyn Error>> {
    let Some([plain, weighted]) = errors(("light_resolve", "Weighted"))? else { return Ok(()) };
    println!("plain average {plain:.4}, weighted {weighted:.4}");
    assert!(weighted < 0.5 * plain, "weighted {weighted}, plain {plain}");
    Ok(())
}

/// IQ-22.
#[test]
fn a_lamp_does_not_spoil_edges_where_samples_are_tone_mapped() -> Result<(), Box<dyn Error>> {
    let Some([plain, mapped]) = errors(("mapped", "samples"))? else { return Ok(()) };
    println!("plain average {plain:.4}, samples tone-mapped {mapped:.4}");
    assert!(mapped < 0.5 * plain, "mapped {mapped}, plain {plain}");
    Ok(())
}

/// NU-2: as the file stands, samples make edges before a lamp smoother than one sample does.
#[test]
fn samples_smooth_edges_before_a_lamp_without_being_asked() -> Result<(), Box<dyn Error>> {
    const LAMP: f32 = 60.0;
    let Some(exact) = converged(&[], LAMP)? else { return Ok(()) };
    let [Some(one), Some(four)] =
        [picture(&[("msaa", "1")], &shining([LAMP; 3]), EXTENT)?, picture(&[], &shining([LAMP; 3]), EXTENT)?]
    else {
        return Ok(());
    };
    let (one, four) = (one.error_from(&exact), four.error_from(&exact));
    assert!(four < 0.6 * one, "4 samples {four}, one {one}");
    Ok(())
}

/// IQ-20: light in physical units is shown, by an exposure that fits it.
#[test]
fn exposure_brings_bright_light_back() -> Result<(), Box<dyn Error>> {
    for (tone_mapping, mapped) in [("white_point", "samples"), ("white_point", "pixels"), ("clip", "texels")] {
        let set = [("tone_mapping", tone_mapping), ("mapped", mapped)];
        let Some(usual) = picture(&set, &shining([0.5; 3]), EXTENT)? else { return Ok(()) };
        let exposed = [&set[..], &[("exposure", "0.0001")]].concat();
        let Some(bright) = picture(&exposed, &shining([5000.0; 3]), EXTENT)? else { return Ok(()) };
        let error = bright.error_from(&usual);
        assert!(error < 0.01, "{set:?}: {error}");
    }
    Ok(())
}

/// A slanted square with a round hole, whose alpha rises over a few texels around a cutoff of one half.
fn perforated() -> Scene {
    const SIDE: u32 = 32;
    let alpha = |x: u32, y: u32| {
        let [x, y] = [x, y].map(|at| f64::from(at) + 0.5 - f64::from(SIDE) / 2.0);
        let distance = x.hypot(y) - 0.14 * f64::from(SIDE);
        (255.0 * (0.5 + distance / 6.0)).clamp(0.0, 255.0).round() as u8
    };
    let texels = (0..SIDE).flat_map(|y| (0..SIDE).flat_map(move |x| [255, 255, 255, alpha(x, y)]));
    let texture = Texture {
        name: "hole".to_owned(),
        width: SIDE,
        height: SIDE,
        rgba8: texels.collect(),
        sampler: Sampler::default(),
    };
    let mut sieve = Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, ..material([0.0, 0.0, 0.0, 1.0]) };
    sieve.emissive = [0.8; 3];
    sieve.base_color_texture = Some(0);
    let place = Mat4::from_rotation_z(0.3) * Mat4::from_scale(Vec3::splat(6.0));
    Scene { textures: vec![texture], ..scene(vec![square()], vec![sieve], vec![(0, 0, place)]) }
}

/// IQ-6: samples alone do nothing for the edges of holes; alpha that covers as many as it takes does. All other edges lie outside
/// of the picture.
#[test]
fn edges_of_holes_improve_with_samples_only_where_alpha_says_how_many_are_covered() -> Result<(), Box<dyn Error>> {
    let large = picture(&DIRECT, &perforated(), EXTENT.map(|side| side * MANY))?;
    let Some(exact) = large.map(|large| large.shrunk(MANY as usize)) else { return Ok(()) };
    let error = |more: Set<'_>| -> Result<f64, Box<dyn Error>> {
        let Some(found) = picture(&[&DIRECT[1..], more].concat(), &perforated(), EXTENT)? else { return Ok(f64::NAN) };
        Ok(found.error_from(&exact))
    };
    let [one, four] = [error(&[("msaa", "1")])?, error(&[("msaa", "4")])?];
    let covered = error(&[("msaa", "4"), ("alpha_to_coverage", "true")])?;
    let covered_once = error(&[("msaa", "1"), ("alpha_to_coverage", "true")])?;
    println!("hole: 1 sample {one:.4}, 4 samples {four:.4}, 4 samples covered by alpha {covered:.4}");
    // Which samples an alpha covers is up to the driver: SwiftShader's error is 0.3 of that without, lavapipe's 0.8.
    assert!(covered < 0.9 * four, "covered {covered}, 4 samples {four}");
    assert!((four - one).abs() < 0.01 * one, "samples alone: {four}, one {one}");
    assert_eq!(covered_once, one, "with one sample it is off");
    Ok(())
}
