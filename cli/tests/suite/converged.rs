//! The reference of `measure` is held against rays: edges of a shining cube before a sky of one colour (NU-1).

use crate::testing::{Place, Vulkan, repository};
use framewright_passes::scene::load;
use framewright_passes::srgb;
use framewright_passes::twin::tone_mapping::modified_reinhard;
use framewright_tests::raycast::RayCaster;
use glam::DVec2;

const EXTENT: [u32; 2] = [48, 27];
/// Rays along each side of a pixel.
const RAYS: u32 = 32;

/// The share of each pixel that the cube covers, after rays.
fn coverage() -> Vec<f64> {
    let scene = load(&repository("examples/sweeps/one_unlit_cube.ron")).expect("the scene");
    let caster = RayCaster::new(&scene);
    let hits = |at: DVec2| caster.cast(&caster.camera_ray(at, EXTENT)).is_some();
    let within = (0..RAYS * RAYS)
        .map(|ray| DVec2::new(f64::from(ray % RAYS) + 0.5, f64::from(ray / RAYS) + 0.5) / f64::from(RAYS));
    let within: Vec<DVec2> = within.collect();
    let pixels = (0..EXTENT[0] * EXTENT[1]).map(|at| DVec2::new((at % EXTENT[0]).into(), (at / EXTENT[0]).into()));
    let share = |pixel: DVec2| within.iter().filter(|offset| hits(pixel + **offset)).count();
    pixels.map(|pixel| share(pixel) as f64 / f64::from(RAYS * RAYS)).collect()
}

/// The light of the reference of a pipeline under some settings.
fn reference_of(
    place: &Place,
    variables: &[(&str, &str)],
    pipeline: &str,
    scene: &str,
    set: &[&str],
) -> image::Rgb32FImage {
    let folder = format!("{pipeline} {}", set.join(" "));
    let mut arguments = vec!["measure", pipeline, "--scene", scene, "--size", "48x27", "--frames", "1"];
    arguments.extend(set.iter().flat_map(|one| ["--set", one]));
    // A sweep of one choice.
    let swept = if pipeline == "deferred" { "anti_aliasing=false" } else { "msaa=1" };
    arguments.extend(["--sweep", swept, "-o", &folder]);
    place.run_with(variables, &arguments).exits(0);
    let pictures = std::fs::read_dir(place.path(&folder).join("pictures")).expect("pictures");
    let mut files = pictures.map(|file| file.expect("a file").path());
    let file = files.find(|path| path.extension().is_some_and(|ending| ending == "exr")).expect("a reference");
    image::open(file).expect("a picture").into_rgb32f()
}

/// The red light of a reference of the shining cube, beside the share of each pixel that the cube covers.
fn of_cube(pipeline: &str, set: &[&str]) -> Option<Vec<(f64, f64)>> {
    let variables = Vulkan::LAVAPIPE.variables()?;
    let scene = repository("examples/sweeps/one_unlit_cube.ron");
    let light = reference_of(&Place::new(), &variables, pipeline, scene.to_str().expect("a path"), set);
    Some(light.pixels().map(|pixel| pixel.0[0].into()).zip(coverage()).collect())
}

/// The mean of the light of pixels of which the cube covers that share.
fn mean_where(pixels: &[(f64, f64)], covered: f64) -> f64 {
    let found: Vec<f64> = pixels.iter().filter(|(_, share)| *share == covered).map(|(light, _)| *light).collect();
    found.iter().sum::<f64>() / found.len() as f64
}

/// How far pixels on edges are from what is expected of a share that is covered, relative to the light between sky and cube.
fn error_on_edges(pixels: &[(f64, f64)], expected: impl Fn(f64) -> f64) -> f64 {
    let range = mean_where(pixels, 1.0) - mean_where(pixels, 0.0);
    let edges = pixels.iter().filter(|(_, covered)| (0.02..0.98).contains(covered));
    let errors: Vec<f64> = edges.map(|(light, covered)| (light - expected(*covered)) / range).collect();
    assert!(errors.len() > 50 && range > 0.4, "{} pixels on edges, {range}", errors.len());
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

/// `forward` has no render scale: what makes its reference converge is how the picture is shifted from frame to frame. That of
/// `image_quality` is drawn at a larger scale: shifts are parts of the texels that are drawn, and not of the output's pixels.
#[test]
fn edges_of_a_reference_are_as_wide_as_rays_find_them() {
    for (pipeline, without_tone_mapping) in [("forward", "tone_mapping=false"), ("image_quality", "tone_mapping=clip")]
    {
        let Some(pixels) = of_cube(pipeline, &[without_tone_mapping]) else { return };
        let [sky, cube] = [0.0, 1.0].map(|covered| mean_where(&pixels, covered));
        let error = error_on_edges(&pixels, |covered| sky + (cube - sky) * covered);
        println!("{pipeline}: {error}");
        assert!(error < 0.015, "{pipeline}: {error}");
    }
}

/// Reinhard's curve, on which the brightness of a white point is white.
fn shown(light: f64, white_point: f64) -> f64 {
    light * (1.0 + light / (white_point * white_point)) / (1.0 + light)
}

/// The light that the curve shows so.
fn light_of(seen: f64, white_point: f64) -> f64 {
    let square = white_point * white_point;
    let half = (1.0 - seen) / 2.0 * square;
    if square.is_infinite() { seen / (1.0 - seen) } else { (half * half + seen * square).sqrt() - half }
}

/// Where pixels are tone-mapped, the reference is the tone-mapped mean of light; where samples are, the mean of what is shown of them.
/// The light of `deferred` is that of single samples, whose mean is complete in no frame but the last ones.
#[test]
fn references_average_light_or_what_is_shown_as_the_tested_pipeline_does() {
    let quality = |mapped| ["tone_mapping=reinhard", "exposure=16", mapped];
    for (pipeline, set, white_point, of_light, limit) in [
        ("image_quality", quality("mapped=pixels"), f64::INFINITY, true, 0.008),
        ("image_quality", quality("mapped=samples"), f64::INFINITY, false, 0.008),
        ("deferred", ["exposure=16", "white_point=100", "bloom=0"], 100.0, true, 0.03),
    ] {
        let Some(pixels) = of_cube(pipeline, &set) else { return };
        let [sky, cube] = [0.0, 1.0].map(|covered| mean_where(&pixels, covered));
        let of_shown = error_on_edges(&pixels, |covered| sky + (cube - sky) * covered);
        let [sky, cube] = [sky, cube].map(|seen| light_of(seen, white_point));
        let of_mean = error_on_edges(&pixels, |covered| shown(sky + (cube - sky) * covered, white_point));
        println!("{pipeline}, {set:?}: {of_mean} from mapped light, {of_shown} from the mean of what is shown");
        let (own, other) = if of_light { (of_mean, of_shown) } else { (of_shown, of_mean) };
        assert!(own < limit && other > 0.1, "{pipeline}, {set:?}: {own} and {other}");
    }
}

/// Shaders of a pipeline that extends a shipped one have other names, and are the same. Here each frame has one sample a pixel: in the
/// first ones an edge is nothing or all, so frames that are drawn before the mean of light is known are no part of the reference.
#[test]
fn the_reference_of_what_extends_a_shipped_pipeline_averages_light_too() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    place.file(
        "bright.ron",
        r#"Pipeline(version: 1, extends: "forward.ron",
            changes: [Set(pass: "tone_map", to: (params: {"exposure": 16.0, "white_point": "white_point"}))])"#,
    );
    let scene = repository("examples/sweeps/one_unlit_cube.ron");
    let scene = scene.to_str().expect("a path");
    let light = reference_of(&place, &variables, "bright.ron", scene, &["white_point=100"]);
    let pixels: Vec<(f64, f64)> = light.pixels().map(|pixel| pixel.0[0].into()).zip(coverage()).collect();
    // The red of the scene's sky and cube.
    let [sky, cube] = [0x20, 0xf0].map(|value| 16.0 * srgb::decode(f64::from(value) / 255.0));
    let error = error_on_edges(&pixels, |covered| modified_reinhard(sky + (cube - sky) * covered, 100.0));
    println!("{error}");
    assert!(error < 0.03, "{error}");
}

/// A screen of 8 bits shows no more than white, in no frame: a reference without rounding doesn't either.
#[test]
fn what_a_screen_cuts_off_is_cut_off_in_every_frame_of_a_reference() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let scene = repository("examples/sweeps/bright_cubes.ron");
    let scene = scene.to_str().expect("a path");
    let light = reference_of(&Place::new(), &variables, "forward", scene, &["tone_mapping=false"]);
    let brightest = light.pixels().flat_map(|pixel| pixel.0).fold(0.0, f32::max);
    assert_eq!(brightest, 1.0);
}

/// An image of one component has a reference of one: the other colours of light are no error.
#[test]
fn a_grey_picture_is_held_against_a_grey_reference() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    place.file(
        "grey.ron",
        r#"Pipeline(version: 1, settings: [(name: "msaa", value: OneOf(default: 1, of: [1]))],
            presets: [(name: "reference", set: {"msaa": 1})],
            images: [(name: "screen", format: R8_UNORM, size: Output)],
            passes: [(name: "sky", draw: Sky, color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))])],
            outputs: ["screen"])"#,
    );
    let words = ["measure", "grey.ron", "--scene", "spheres_and_cubes", "--size", "48x27", "--frames", "1"];
    place.run_with(&variables, &[&words[..], &["--sweep", "msaa=1", "-o", "grey"]].concat()).exits(0);
    let results = std::fs::read_to_string(place.path("grey/results.json")).expect("results");
    let results: serde_json::Value = serde_json::from_str(&results).expect("JSON");
    let rmse = &results["rows"][0]["outcome"]["measured"]["errors"]["rmse"];
    assert!(rmse.as_f64().is_some_and(|rmse| rmse < 0.01), "{rmse}");
}

/// A blur is as wide in the reference as in the picture, which has fewer texels: that of the unblurred reference, in 64 bits.
#[test]
fn a_blur_is_as_wide_in_a_reference_as_on_the_screen() {
    const DRAWS: usize = 5;
    let place = Place::new();
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let [sharp, blurred] =
        ["blur=0", "blur=5"].map(|set| reference_of(&place, &variables, "image_quality", "spheres_and_cubes", &[set]));
    let (width, height) = sharp.dimensions();
    let mut expected: Vec<[f64; 3]> = sharp.pixels().map(|pixel| pixel.0.map(f64::from)).collect();
    for _ in 0..DRAWS {
        let at = |x: i64, y: i64| {
            let [x, y] = [(x, width), (y, height)].map(|(at, size)| at.clamp(0, i64::from(size) - 1));
            expected[(y * i64::from(width) + x) as usize]
        };
        let tent = |x: i64, y: i64| {
            let mut sum = [0.0; 3];
            for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
                let weight = f64::from((2 - i32::abs(dx)) * (2 - i32::abs(dy))) / 16.0;
                let texel = at(x + i64::from(dx), y + i64::from(dy));
                (0..3).for_each(|channel| sum[channel] += weight * texel[channel]);
            }
            sum
        };
        let places = (0..i64::from(height)).flat_map(|y| (0..i64::from(width)).map(move |x| (x, y)));
        expected = places.map(|(x, y)| tent(x, y)).collect();
    }
    let rms = |of: &image::Rgb32FImage| {
        let pairs = of.pixels().zip(&expected).flat_map(|(found, expected)| found.0.into_iter().zip(expected));
        let sum: f64 = pairs.map(|(found, expected)| (f64::from(found) - expected).powi(2)).sum();
        (sum / (3 * expected.len()) as f64).sqrt()
    };
    println!("{} from the blurred reference, {} from the sharp one", rms(&blurred), rms(&sharp));
    assert!(rms(&blurred) < 1e-4 && rms(&sharp) > 0.05, "{} and {}", rms(&blurred), rms(&sharp));
}
