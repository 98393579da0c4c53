//! Depth that is drawn again with one sample (IQ-13) is held against rays: it keeps what moves or removes fragments of masked
//! objects, which is the place of every instance, the product of the texture's alpha and the object's own, and the share that a
//! fading object is seen to.

use framewright_graph::vulkan::Filter;
use framewright_passes::scene::{AlphaMode, Sampler, Scene, Texture, Wrap};
use framewright_passes::twin::cross_fade::fades_out;
use framewright_tests::raycast::RayCaster;
use framewright_tests::render::{Setup, device, floats, render};
use framewright_tests::shapes::{material, scene, square};
use glam::{DVec2, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [96, 72];

/// Texels whose alpha is 0, 1/3, 2/3 and 1, side by side.
fn steps() -> Texture {
    let [wrap_u, wrap_v] = [Wrap::ClampToEdge; 2];
    let sampler = Sampler { wrap_u, wrap_v, magnify: Filter::Nearest, minify: Filter::Nearest, mip: None };
    let rgba8 = [0, 85, 170, 255].into_iter().flat_map(|alpha| [255, 255, 255, alpha]).collect();
    Texture { name: String::new(), width: 4, height: 1, rgba8, sampler }
}

/// Instances of one square in three columns of another alpha each, 1, 0.7 and 0.4, so that 2, 1 and 0 of 4 texels are beyond a
/// cutoff of a half, and two of 1 beyond one of 0.25; four rows, the lowest one faded.
fn ladder() -> Scene {
    let mut materials = Vec::new();
    let mut objects = Vec::new();
    for (column, alpha) in (0_u8..).zip([1.0, 0.7, 0.4]) {
        for (row, cutoff) in (0_u8..).zip([0.5, 0.25, 0.9, 0.25]) {
            let mut holes = material([1.0, 1.0, 1.0, alpha]);
            holes.base_color_texture = Some(0);
            holes.alpha = AlphaMode::Mask { cutoff };
            let at = Vec3::new(2.2 * (f32::from(column) - 1.0), 1.2 * (f32::from(row) - 1.5), -0.3 * f32::from(row));
            let turned =
                Mat4::from_translation(at) * Mat4::from_rotation_y(0.4) * Mat4::from_scale(Vec3::new(1.0, 0.5, 1.0));
            objects.push((0, materials.len(), turned));
            materials.push(holes);
        }
    }
    let mut ladder = scene(vec![square()], materials, objects);
    ladder.textures = vec![steps()];
    for row in ladder.objects.iter_mut().step_by(4) {
        row.cross_fade = 0.6;
    }
    ladder
}

/// IQ-13: instances beyond the first, texture times the object's own alpha, and alpha below 1: as rays find them, and bit for
/// bit as drawn with one sample from the start.
#[test]
fn depth_drawn_again_keeps_instances_holes_and_fading() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let ladder = ladder();
    let seen = |msaa| {
        let set = [("msaa", msaa)];
        let setup = Setup { pipeline: "tests/pipelines/depth_ladder.ron", set: &set, scene: &ladder, extent: EXTENT };
        Ok::<_, Box<dyn Error>>(render(device, &setup)?.swap_remove(0))
    };
    let again = seen("4")?;
    assert!(again.bytes == seen("1")?.bytes, "depth drawn again is not that of one sample");
    let caster = RayCaster::new(&ladder);
    let mut shown = vec![0; ladder.objects.len()];
    let mut empty = 0;
    for (at, depth) in floats(&again).into_iter().enumerate() {
        let pixel = [at as u32 % EXTENT[0], at as u32 / EXTENT[0]];
        let middle = DVec2::from(pixel.map(f64::from)) + 0.5;
        let met = |x: f64, y: f64| caster.cast(&caster.camera_ray(middle + DVec2::new(x, y), EXTENT));
        let here = met(0.0, 0.0);
        let object = |x, y| met(x, y).map(|hit| (hit.object, hit.base_color[3].to_bits()));
        let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];
        if corners.iter().any(|&(x, y)| object(x, y) != object(0.0, 0.0)) {
            continue;
        }
        // No other object is behind a fading one.
        let here = here.filter(|hit| !fades_out(ladder.objects[hit.object as usize].cross_fade.into(), pixel));
        match here {
            Some(hit) => {
                let expected = f64::from(ladder.camera.near) / hit.depth;
                assert!(
                    (depth - expected).abs() < 0.01 * expected,
                    "{pixel:?}: {depth}, not {expected} of {}",
                    hit.object
                );
                shown[hit.object as usize] += 1;
            }
            None => {
                assert_eq!(depth, 0.0, "{pixel:?} shows something");
                empty += 1;
            }
        }
    }
    // By column and row: how many of 4 texels are left by alpha times 0, 1/3, 2/3 and 1.
    let left = [[2, 3, 1, 3], [1, 2, 0, 2], [0, 2, 0, 2]];
    for (object, count) in shown.iter().enumerate() {
        assert_eq!(*count > 15, left[object / 4][object % 4] > 0, "object {object} shows {count} pixels: {shown:?}");
    }
    assert!(empty > 1000, "{empty} pixels are empty");
    Ok(())
}
