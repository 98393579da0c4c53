//! Fading objects are held against the twin of the pattern, pixel by pixel (NU-5, IQ-25).

use framewright_passes::scene::{AlphaMode, Scene};
use framewright_passes::twin::cross_fade::fades_out;
use framewright_tests::render::{Setup, device, render};
use framewright_tests::shapes::{material, scene, square};
use framewright_vulkan::Device;
use glam::{Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [40, 24];

/// Squares that fill the picture, all but black, that are seen to these shares.
fn squares(shares: &[f32], alpha: AlphaMode) -> Scene {
    let materials = (0..shares.len()).map(|number| {
        let mut one = material([0.0, 0.0, 0.0, 1.0]);
        one.emissive[number] = 1.0;
        one.alpha = alpha;
        one
    });
    let place = Mat4::from_scale(Vec3::splat(100.0));
    let objects = (0..shares.len()).map(|number| (0, number, place)).collect();
    let mut squares = scene(vec![square()], materials.collect(), objects);
    for (object, share) in squares.objects.iter_mut().zip(shares) {
        object.cross_fade = *share;
    }
    squares
}

fn drawn(device: &Device, scene: &Scene) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    let setup = Setup { pipeline: "tests/pipelines/lit.ron", set: &[], scene, extent: EXTENT };
    let bytes = render(device, &setup)?.swap_remove(0).bytes;
    let (words, _) = bytes.as_chunks::<4>();
    let floats: Vec<f32> = words.iter().map(|word| f32::from_ne_bytes(*word)).collect();
    Ok(floats.as_chunks::<4>().0.to_vec())
}

#[test]
fn a_fading_object_is_drawn_in_exactly_the_pixels_of_its_twin() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for share in [-1.0_f32, -0.7, -0.3, -0.01, 0.0, 0.01, 0.3, 0.5, 0.99, 1.0] {
        for alpha in [AlphaMode::Opaque, AlphaMode::Mask { cutoff: 0.5 }] {
            for (index, texel) in drawn(device, &squares(&[share], alpha))?.into_iter().enumerate() {
                let pixel = [index as u32 % EXTENT[0], index as u32 / EXTENT[0]];
                let expected = !fades_out(f64::from(share), pixel);
                assert_eq!(texel[0] == 1.0, expected, "{share}, {alpha:?}: {pixel:?} is {texel:?}");
            }
        }
    }
    Ok(())
}

#[test]
fn two_objects_that_fade_into_each_other_leave_no_pixel_out_and_none_twice() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for share in [0.25_f32, 0.4, 0.9] {
        let texels = drawn(device, &squares(&[share, -share], AlphaMode::Opaque))?;
        assert!(texels.iter().all(|texel| texel[0] + texel[1] == 1.0), "{share}");
        assert!(texels.iter().any(|texel| texel[0] == 1.0) && texels.iter().any(|texel| texel[1] == 1.0), "{share}");
    }
    Ok(())
}
