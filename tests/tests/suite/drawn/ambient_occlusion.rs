//! Ambient occlusion is held against its twin (NU-5), and does what it is for: corners are darker than what lies open.

use framewright_passes::scene::Scene;
use framewright_passes::twin::ambient_occlusion::Surfaces;
use framewright_tests::render::{Setup, device, render};
use framewright_tests::shapes::{material, scene, sphere, square};
use glam::{DMat3, DMat4, DVec2, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [100, 76];
/// How far a texel may be from its twin: places and angles are rounded to 32 bits.
const NEAR: f64 = 2e-3;
/// How far the quotient of a number and itself may be from 1: Vulkan allows a division 2.5 units in the last place.
const DIVISION: f64 = 2.5 / 8_388_608.0;

/// A floor that meets a wall, and a ball on it.
fn corner() -> Scene {
    let floor = Mat4::from_translation(Vec3::new(0.0, -1.0, 0.0)) * Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let wall = Mat4::from_translation(Vec3::new(0.0, 0.0, -2.0));
    let ball = Mat4::from_translation(Vec3::new(1.2, -0.5, 0.6)) * Mat4::from_scale(Vec3::splat(0.5));
    let wide = Mat4::from_scale(Vec3::new(5.0, 2.0, 1.0));
    let objects = vec![(0, 0, floor * wide), (0, 0, wall * wide), (1, 0, ball)];
    let mut corner = scene(vec![square(), sphere(24)], vec![material([1.0; 4])], objects);
    corner.ambient = [1.0; 3];
    corner
}

struct Drawn {
    surfaces: Surfaces,
    found: Vec<f64>,
    open: Vec<f64>,
    lit: Vec<f64>,
}

impl Drawn {
    fn texels(&self) -> impl Iterator<Item = (usize, [i32; 2])> {
        let [width, height] = self.surfaces.extent;
        (0..height).flat_map(move |y| (0..width).map(move |x| [x, y])).enumerate()
    }
}

fn drawn(scene: &Scene, radius: &str, strength: &str) -> Result<Option<Drawn>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let set = [("radius", radius), ("strength", strength)];
    let setup = Setup { pipeline: "tests/pipelines/ambient_occlusion.ron", set: &set, scene, extent: EXTENT };
    let outputs = render(device, &setup)?;
    let channel = |output: usize, channel: usize| -> Vec<f64> {
        let words = outputs[output].bytes.as_chunks::<4>().0.iter();
        words.skip(channel).step_by(4).map(|word| f64::from(f32::from_ne_bytes(*word))).collect()
    };
    let camera = &scene.camera;
    let turned = DMat4::from_mat3(DMat3::from_mat4(camera.transform).inverse());
    let aspect = f64::from(EXTENT[0]) / f64::from(EXTENT[1]);
    let normal = channel(1, 0).into_iter().zip(channel(1, 1)).map(|(x, y)| DVec2::new(x, y)).collect();
    let surfaces = Surfaces {
        extent: EXTENT.map(|side| side as i32),
        depth: channel(0, 0),
        normal,
        world_to_clip: camera.projection(aspect).as_dmat4() * turned,
    };
    Ok(Some(Drawn { surfaces, found: channel(2, 0), open: channel(3, 0), lit: channel(4, 0) }))
}

#[test]
fn each_texel_is_its_twin_unless_rounding_makes_it_look_beside() -> Result<(), Box<dyn Error>> {
    for (radius, strength) in [("0.5", "1.0"), ("2.0", "0.6"), ("0.25", "4.0")] {
        let Some(drawn) = drawn(&corner(), radius, strength)? else { return Ok(()) };
        let (mut beside, mut dark) = (0, 0);
        for (at, texel) in drawn.texels() {
            let expected = drawn.surfaces.openness(texel, radius.parse()?, strength.parse()?);
            beside += usize::from((drawn.found[at] - expected).abs() > NEAR);
            dark += usize::from(expected < 0.9);
            let blurred = drawn.surfaces.blurred(&drawn.found, texel);
            let apart = (drawn.open[at] - blurred).abs();
            assert!(apart < NEAR, "radius {radius}, {texel:?}: {} instead of {blurred}", drawn.open[at]);
        }
        let all = drawn.found.len();
        assert!(beside * 100 <= all, "radius {radius}: {beside} of {all} texels are not their twins");
        assert!(dark > 100, "radius {radius}: only {dark} texels are occluded");
    }
    Ok(())
}

#[test]
fn corners_are_darker_than_what_lies_open_and_the_sky_is_bright() -> Result<(), Box<dyn Error>> {
    let Some(drawn) = drawn(&corner(), "0.5", "1.0")? else { return Ok(()) };
    let column = EXTENT[0] as usize / 4;
    let down: Vec<f64> = (0..EXTENT[1] as usize).map(|row| drawn.open[row * EXTENT[0] as usize + column]).collect();
    let darkest = down.iter().copied().fold(1.0, f64::min);
    assert!((0.2..0.75).contains(&darkest), "the corner is {darkest} open: {down:?}");
    let corner = down.iter().position(|open| *open == darkest).ok_or("a corner")?;
    let height = EXTENT[1] as usize;
    assert!((height / 2..height * 4 / 5).contains(&corner), "the corner lies in row {corner}");
    for open in [down[height - 1], down[corner - 14]] {
        assert!(open > 0.98, "floor and wall lie open: {down:?}");
    }
    let empty = drawn.texels().filter(|(at, _)| drawn.surfaces.depth[*at] == 0.0);
    let sky: Vec<f64> = empty.map(|(at, _)| drawn.open[at]).collect();
    assert!(sky.len() > 50 && sky.iter().all(|open| (open - 1.0).abs() <= DIVISION), "{sky:?}");
    Ok(())
}

#[test]
fn surfaces_show_so_much_of_the_ambient_light_as_reaches_them() -> Result<(), Box<dyn Error>> {
    let Some(drawn) = drawn(&corner(), "0.5", "1.0")? else { return Ok(()) };
    for (at, texel) in drawn.texels().filter(|(at, _)| drawn.surfaces.depth[*at] > 0.0) {
        let (lit, open) = (drawn.lit[at], drawn.open[at]);
        assert!((lit - open).abs() < 1e-6, "{texel:?} shows {lit} and is {open} open");
    }
    Ok(())
}

#[test]
fn without_strength_all_lies_open() -> Result<(), Box<dyn Error>> {
    let Some(drawn) = drawn(&corner(), "0.5", "0.0")? else { return Ok(()) };
    assert!(drawn.found.iter().all(|found| *found == 1.0), "nothing is occluded before the blur");
    assert!(drawn.open.iter().all(|open| (open - 1.0).abs() <= DIVISION), "nor after it");
    Ok(())
}
