//! The smallest and the largest pictures.

use super::outputs;
use framewright_passes::scene::{Scene, Sky};
use framewright_passes::twin::tone_mapping::modified_reinhard;
use framewright_tests::raycast::texture::encode;
use framewright_tests::render::{Setup, device, floats, render};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// A sky of one colour all around.
fn even_sky() -> Scene {
    let even = [0.25, 4.0, 0.75];
    Scene { sky: Sky { zenith: even, horizon: even, ground: even }, ..empty_scene() }
}

/// NU-4: pictures of one pixel, row or column hold the value that each pixel of a large one holds, at each render scale: a
/// quarter of one pixel is one texel.
#[test]
fn pictures_of_one_pixel_row_or_column_hold_what_large_ones_hold() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = even_sky();
    let white_point = 20.0;
    let expected = [0.25, 4.0, 0.75].map(|light| 255.0 * encode(modified_reinhard(light, white_point)));
    let settings: [&[(&str, &str)]; 6] = [
        &[],
        &[("render_scale", "0.25")],
        &[("render_scale", "0.25"), ("filter", "catmull_rom"), ("mapped", "texels")],
        &[("render_scale", "4"), ("filter", "bilinear")],
        &[("blur", "5"), ("depth_stripes", "copied")],
        &[("render_scale", "0.25"), ("mapped", "samples"), ("blur", "1")],
    ];
    for extent in [[1, 1], [1, 2], [1, 7], [9, 1], [3, 2]] {
        for set in settings {
            let set: Vec<_> = set.iter().copied().chain([("tone_mapping", "white_point")]).collect();
            let setup = Setup { pipeline: "examples/pipelines/image_quality.ron", set: &set, scene: &scene, extent };
            let picture = render(device, &setup)?.swap_remove(0);
            assert_eq!(picture.bytes.len() as u32, 4 * extent[0] * extent[1]);
            for pixel in picture.bytes.as_chunks::<4>().0 {
                let close = (0..3).all(|at| (f64::from(pixel[at]) - expected[at]).abs() <= 1.0);
                assert!(close && pixel[3] == 255, "{extent:?}, {set:?}: {pixel:?}, not {expected:?}");
            }
        }
    }
    Ok(())
}

/// NU-4: each shipped pipeline draws one pixel, and all of its pixels alike.
#[test]
fn every_shipped_pipeline_draws_pictures_of_one_pixel() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = even_sky();
    // An overlay shows depth in a corner.
    let plain: [(&str, &[(&str, &str)]); 11] = [
        ("auto_exposure", &[]),
        ("deferred", &[]),
        ("deferred_mobile", &[]),
        ("dynamic_resolution", &[]),
        ("forward", &[]),
        ("forward_overlay", &[("overlay", "false")]),
        ("image_quality", &[]),
        ("post", &[("overlay", "false")]),
        ("shadows", &[]),
        ("soft_focus", &[]),
        ("temporal", &[]),
    ];
    for (name, set) in plain {
        let pipeline = format!("examples/pipelines/{name}.ron");
        for extent in [[1, 1], [1, 5], [5, 1]] {
            let picture = render(device, &Setup { pipeline: &pipeline, set, scene: &scene, extent })?.swap_remove(0);
            let pixels = picture.bytes.as_chunks::<4>().0;
            let first = pixels.first().ok_or("no pixel")?;
            assert!(first[1] > first[2] && first[2] > first[0] && first[0] > 0, "{name}, {extent:?}: {first:?}");
            let alike =
                pixels.iter().all(|pixel| pixel.iter().zip(first).all(|(one, other)| one.abs_diff(*other) <= 1));
            assert!(alike, "{name}, {extent:?}: {pixels:?}");
        }
    }
    Ok(())
}

fn stripe(extent: [u32; 2]) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            images: [
                (name: "places", format: R32G32B32A32_SFLOAT, size: Fixed({}, {})),
                (name: "again", format: R32G32B32A32_SFLOAT, size: Like("places")),
            ],
            passes: [
                (name: "places", draw: FullScreen("texel_numbers"), color: ["places"]),
                (name: "again", draw: FullScreen("copy"), sample: {{"source": (image: "places", filter: Nearest)}}, color: ["again"]),
            ],
            outputs: ["again"],
        )"#,
        extent[0], extent[1]
    )
}

/// NU-4: images as wide or as high as the device can draw hold every texel's own number; of larger ones the error tells the
/// limit.
#[test]
fn the_largest_images_hold_each_texel_and_larger_ones_are_refused() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let most = device.profile().max_attachment_extent;
    for extent in [[most, 1], [1, most], [most, 2]] {
        let Some(shown) = outputs(&stripe(extent), &empty_scene(), [8, 8])? else { return Ok(()) };
        let texels = floats(&shown[0]);
        assert_eq!(texels.len() as u32, 4 * extent[0] * extent[1]);
        for (at, texel) in texels.as_chunks::<4>().0.iter().enumerate() {
            let place = [at as u32 % extent[0], at as u32 / extent[0]].map(f64::from);
            assert!([texel[0], texel[1]] == place, "{extent:?}: {place:?} holds {texel:?}");
        }
    }
    for extent in [[most + 1, 1], [1, most + 1]] {
        let refusal = outputs(&stripe(extent), &empty_scene(), [8, 8]).err().map(|error| error.to_string());
        let refusal = refusal.ok_or("an image beyond the limit is drawn")?;
        assert!(refusal.contains("places") && refusal.contains(&most.to_string()), "{refusal}");
    }
    Ok(())
}
