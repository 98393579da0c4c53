//! The sky is held against its formula (NU-5) along rays that the ray-caster casts.

use framewright_passes::scene::{Camera, Scene, Sky, Sun};
use framewright_passes::twin::sky::sun_share;
use framewright_tests::raycast::RayCaster;
use framewright_tests::render::{Setup, device, render, rgb};
use framewright_tests::shapes::empty_scene;
use glam::{DVec2, DVec3};
use std::error::Error;

/// Width and height, uneven so that a wrong ratio shows.
const EXTENT: [u32; 2] = [48, 30];

fn scene(target: DVec3) -> Result<Scene, Box<dyn Error>> {
    let position = DVec3::new(1e6, -3.0, 0.25);
    let camera = Camera::look_at(position, position + target, DVec3::Y, 1.2, 0.1);
    let sky = Sky { zenith: [0.1, 0.2, 4.0], horizon: [0.7, 0.75, 0.8], ground: [0.3, 0.05, 0.0] };
    Ok(Scene { camera: camera.ok_or("no view")?, sky, ..empty_scene() })
}

#[test]
fn without_a_sun_the_sky_is_its_gradient_everywhere_in_the_picture() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for target in [DVec3::new(0.3, 0.1, -1.0), DVec3::new(-1.0, 2.0, 0.5), DVec3::new(0.1, -1.0, 0.1)] {
        let scene = scene(target)?;
        let setup = Setup { pipeline: "tests/pipelines/sky.ron", set: &[], scene: &scene, extent: EXTENT };
        let outputs = render(device, &setup)?;
        let (texels, _) = outputs[0].bytes.as_chunks::<16>();
        let caster = RayCaster::new(&scene);
        for (index, texel) in texels.iter().enumerate() {
            let (x, y) = (index % EXTENT[0] as usize, index / EXTENT[0] as usize);
            let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let direction = caster.camera_ray(at, EXTENT).direction.normalize();
            let expected = scene.sky.towards(direction.to_array());
            for (channel, expected) in expected.into_iter().enumerate() {
                let word: [u8; 4] = texel[4 * channel..4 * channel + 4].try_into()?;
                let found = f64::from(f32::from_ne_bytes(word));
                // At the horizon the square root below it magnifies the direction's own error of some 1e-7.
                assert!((found - expected).abs() < 1e-3, "({x}, {y}) channel {channel}: {found} instead of {expected}");
            }
        }
    }
    Ok(())
}

/// The sun high up, at the horizon, and far below it, where no glow is left (NU-5).
#[test]
fn the_sun_and_its_glow_are_their_twins() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for sine in [0.4, 0.01, -0.01, -0.5] {
        let to_sun = DVec3::new(0.3, 0.0, -1.0).normalize() * (1.0_f64 - sine * sine).sqrt() + DVec3::Y * sine;
        let mut scene = scene(DVec3::new(0.3, 0.15, -1.0))?;
        let color = [3.0, 2.0, 0.5];
        scene.sun = Sun { direction: (-to_sun).as_vec3().to_array(), color, shadows: false };
        let setup = Setup { pipeline: "tests/pipelines/sky.ron", set: &[], scene: &scene, extent: EXTENT };
        let found = rgb(&render(device, &setup)?[0]);
        let caster = RayCaster::new(&scene);
        let mut bright = 0;
        for (at, found) in found.into_iter().enumerate() {
            let middle = DVec2::new((at % EXTENT[0] as usize) as f64, (at / EXTENT[0] as usize) as f64) + 0.5;
            let direction = caster.camera_ray(middle, EXTENT).direction.normalize();
            let share = sun_share(direction.y, direction.dot(to_sun));
            let sky = scene.sky.towards(direction.to_array());
            bright += usize::from(share > 0.05);
            for channel in 0..3 {
                let expected = sky[channel] + share * f64::from(color[channel]);
                // A power of 2048 makes 10⁻⁴ of a rounding of 2⁻²⁴; the horizon is a root.
                let close = (found[channel] - expected).abs() <= 2e-3 * (1.0 + expected);
                assert!(close, "sun at {sine}, {middle}: {} instead of {expected}", found[channel]);
            }
        }
        assert_eq!(bright > 20, sine > -0.1, "sun at {sine}: {bright} pixels glow");
    }
    Ok(())
}
