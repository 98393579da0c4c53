//! No light, very many lights, and one very bright texel.

use framewright_passes::draw::{MOST_POINT_LIGHTS, SceneDrawSource};
use framewright_passes::scene::{PointLight, Scene};
use framewright_passes::twin::filters::gauss;
use framewright_passes::twin::lighting::{lit_surface, reflect_light};
use framewright_tests::raycast::RayCaster;
use framewright_tests::render::{Setup, device, floats, render, rgb};
use framewright_tests::shapes::{empty_scene, material, scene, square};
use glam::{DVec2, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [24, 18];

fn wall() -> Scene {
    let mut wall =
        scene(vec![square()], vec![material([0.8, 0.5, 0.3, 1.0])], vec![(0, 0, Mat4::from_scale(Vec3::splat(9.0)))]);
    wall.ambient = [0.01, 0.02, 0.03];
    wall
}

/// Lights before the wall, by their number: every one brighter than the one before, from nothing to a million.
fn lights(count: usize) -> Vec<PointLight> {
    let light = |number: usize| {
        let (turn, share) = (number as f32 * 2.399_963, number as f32 / count as f32);
        let position = [turn.cos() * 4.0 * share, turn.sin() * 3.0 * share, 0.4 + share].map(f64::from);
        let intensity = if number == 0 { 0.0 } else { 1e6 * share.powi(9) };
        PointLight {
            position,
            color: [1.0, share, 0.25],
            intensity,
            range: (number > 0).then_some(1.2),
            shadows: false,
        }
    };
    (0..count).map(light).collect()
}

/// NU-4: of no light there is the ambient light, and 4,096 lights of 0 to 10⁶ give their sum, at most 65,504; 10,000 are
/// refused.
#[test]
fn no_lights_and_very_many_give_their_sum_and_more_are_refused() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for (count, brightest) in [(0, 0.008), (1, 0.008), (MOST_POINT_LIGHTS, 65504.0)] {
        let mut wall = wall();
        wall.point_lights = lights(count);
        let setup = Setup { pipeline: "tests/pipelines/lit.ron", set: &[], scene: &wall, extent: EXTENT };
        let found = rgb(&render(device, &setup)?[0]);
        let caster = RayCaster::new(&wall);
        let mut most = 0.0_f64;
        for (at, found) in found.into_iter().enumerate() {
            let middle = DVec2::new((at % EXTENT[0] as usize) as f64, (at / EXTENT[0] as usize) as f64) + 0.5;
            // Drivers snap corners to a 16th of a pixel or finer before they interpolate positions.
            let places = [(0.0, 0.0), (-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
            let twin = |(x, y)| {
                let ray = caster.camera_ray(middle + DVec2::new(x, y) / 16.0, EXTENT);
                let hit = caster.cast(&ray)?;
                let reflected = reflect_light(&wall, ray.origin + ray.direction * hit.depth, hit.normal, 1.0);
                Some(lit_surface(&wall.materials[0], hit.base_color, &reflected))
            };
            let expected: Vec<[f64; 4]> = places.into_iter().filter_map(twin).collect();
            assert_eq!(expected.len(), places.len(), "the wall fills the picture");
            for channel in 0..3 {
                let of = || expected.iter().map(|light| light[channel]);
                let (least, greatest) = (of().fold(f64::INFINITY, f64::min), of().fold(0.0, f64::max));
                let close = (least * 0.999..=greatest * 1.001).contains(&found[channel]);
                assert!(close, "{count} lights, {middle}: {} is not {least} to {greatest}", found[channel]);
                most = most.max(found[channel]);
            }
        }
        assert!(most <= 65504.0 && most > 0.5 * brightest, "{count} lights: {most}");
    }
    let mut wall = wall();
    wall.point_lights = lights(10_000);
    let refusal = SceneDrawSource::new(device, &wall, EXTENT).err().map(|error| error.to_string());
    assert_eq!(refusal.as_deref(), Some("the scene has 10000 point lights, and at most 4096 can be drawn"));
    Ok(())
}

/// NU-4: ten blurs of one texel as bright as a half float can be spread its light, and neither add nor lose any.
#[test]
fn ten_blurs_of_one_hot_texel_keep_its_light() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    const SIDE: usize = 65;
    let along = |weigh: &dyn Fn(&[f64], usize) -> f64| {
        (0..10).fold((0..SIDE).map(|at| f64::from(at == SIDE / 2)).collect::<Vec<_>>(), |row, _| {
            (0..SIDE).map(|at| weigh(&row, at)).collect()
        })
    };
    let tap =
        |row: &[f64], at: usize, step: i32| row.get(at.wrapping_add_signed(step as isize)).copied().unwrap_or(0.0);
    let rows = [
        along(&|row, at| gauss(|step| tap(row, at, step), 3.0)),
        along(&|row, at| 0.25 * tap(row, at, -1) + 0.5 * row[at] + 0.25 * tap(row, at, 1)),
    ];
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/hot_texel.ron", set: &[], scene: &scene, extent: [SIDE as u32; 2] };
    let shown = render(device, &setup)?;
    // A driver's exp() may be off by some steps of 2⁻²⁴, twenty times over. Half floats: each of the draws rounds, or cuts off,
    // to 11 bits.
    for (format, rounding, shown) in [("32 bits", 1e-4, &shown[..2]), ("half floats", 20.0 / 1024.0, &shown[2..])] {
        for (row, shown) in rows.iter().zip(shown) {
            let texels = floats(shown);
            for (at, texel) in texels.as_chunks::<4>().0.iter().enumerate() {
                let expected = 65504.0 * row[at % SIDE] * row[at / SIDE];
                let close = texel[..3].iter().all(|light| (light - expected).abs() <= rounding * expected + 1e-4);
                assert!(close, "{format}, texel {at}: {texel:?} instead of {expected}");
            }
            let light: f64 = texels.iter().step_by(4).sum();
            assert!((light - 65504.0).abs() <= rounding * 65504.0, "{format}: {light} of 65504 are left");
        }
    }
    Ok(())
}
