//! The smallest and the largest pictures.

use super::outputs;
use framewright_passes::scene::{Scene, Sky};
use framewright_passes::twin::tone_mapping::modified_reinhard;
use framewright_tests::raycast::texture::encode;
use framewright_tests::render::{Setup, device, floats, in_repository, render};
use framewright_tests::shapes::empty_scene;
use std::error::Error;
use std::path::PathBuf;

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

/// NU-4: each shipped pipeline draws one pixel, and all of its pixels alike. Where snow falls the sky is between the flakes, which are
/// brighter.
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
    let snowing = |extent| -> Result<Vec<[u8; 4]>, Box<dyn Error>> {
        let setup = Setup { pipeline: "examples/pipelines/snow.ron", set: &[], scene: &scene, extent };
        Ok(render(device, &setup)?.swap_remove(0).bytes.as_chunks::<4>().0.to_vec())
    };
    let large = snowing([64, 64])?;
    let sky = [0, 1, 2, 3].map(|channel| large.iter().map(|pixel| pixel[channel]).min().unwrap_or(0));
    assert!(sky[1] > sky[2] && sky[2] > sky[0] && sky[0] > 0 && large.iter().any(|pixel| *pixel != sky), "{sky:?}");
    for extent in [[1, 1], [1, 5], [5, 1]] {
        for pixel in snowing(extent)? {
            let no_darker = pixel.iter().zip(sky).all(|(one, sky)| one.saturating_add(1) >= sky);
            assert!(no_darker && pixel[3] == 255, "snow, {extent:?}: {pixel:?}, not {sky:?} or brighter");
        }
    }
    let mut names: Vec<String> =
        plain.iter().map(|(name, _)| format!("{name}.ron")).chain(["snow.ron".to_owned()]).collect();
    names.sort();
    let files = std::fs::read_dir(in_repository("examples/pipelines"))?.map(|file| Ok(file?.path()));
    let files: Vec<PathBuf> = files.collect::<std::io::Result<Vec<PathBuf>>>()?;
    let mut shipped: Vec<String> = files
        .iter()
        .filter(|path| path.is_file())
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    shipped.sort();
    assert_eq!(names, shipped, "each shipped pipeline was drawn");
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
                (name: "again", draw: FullScreen("fetch"), sample: {{"source": "places"}}, color: ["again"]),
            ],
            outputs: ["again"],
        )"#,
        extent[0], extent[1]
    )
}

/// NU-4: images as wide or as high as the device can draw hold every texel's own number; of larger ones the error tells the
/// limit. Texels are fetched by their number: Vulkan says nothing of how exact the coordinates are that a rasterizer interpolates
/// along 32,768 texels.
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
    // As wide and as high at once, a byte a texel.
    let square = format!(
        r#"Pipeline(
            version: 1,
            images: [(name: "places", format: R8_UNORM, size: Fixed({most}, {most}))],
            passes: [(name: "places", draw: FullScreen("texel_numbers"), color: ["places"])],
            outputs: ["places"],
        )"#
    );
    let Some(shown) = outputs(&square, &empty_scene(), [8, 8])? else { return Ok(()) };
    assert_eq!(shown[0].bytes.len() as u64, u64::from(most) * u64::from(most));
    let rows = shown[0].bytes.chunks(most as usize);
    // The first column is 0, and all others are 1 or more.
    let wrong = rows.enumerate().find(|(_, row)| row[0] != 0 || row[1..].iter().any(|texel| *texel != 255));
    assert!(wrong.is_none(), "row {:?}", wrong.map(|(y, _)| y));
    for extent in [[most + 1, 1], [1, most + 1]] {
        let refusal = outputs(&stripe(extent), &empty_scene(), [8, 8]).err().map(|error| error.to_string());
        let refusal = refusal.ok_or("an image beyond the limit is drawn")?;
        assert!(refusal.contains("places") && refusal.contains(&most.to_string()), "{refusal}");
    }
    Ok(())
}
