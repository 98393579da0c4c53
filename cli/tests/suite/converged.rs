//! The reference of `measure` is held against rays: edges of a shining cube before a sky of one colour (NU-1).

use crate::testing::{Place, Vulkan, repository};
use framewright_passes::scene::load;
use framewright_passes::srgb;
use framewright_tests::raycast::RayCaster;
use glam::DVec2;
use serde_json::Value;

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

/// `forward` has no render scale: what makes its reference converge is how the picture is shifted from frame to frame. That of
/// `image_quality` is drawn at a larger scale: shifts are parts of the texels that are drawn, and not of the output's pixels.
#[test]
fn edges_of_a_reference_are_as_wide_as_rays_find_them() {
    // A reference with larger texels is further from rays.
    for (pipeline, without_tone_mapping, limit) in
        [("forward", "tone_mapping=false", 0.04), ("image_quality", "tone_mapping=clip", 0.008)]
    {
        let Some(rms) = edges(pipeline, without_tone_mapping) else { return };
        assert!(rms < limit, "{pipeline}: {rms}");
    }
}

/// The error of the share of each pixel on an edge that the cube covers.
fn edges(pipeline: &str, without_tone_mapping: &str) -> Option<f64> {
    let place = Place::new();
    let variables = Vulkan::LAVAPIPE.variables()?;
    let scene = repository("examples/sweeps/one_unlit_cube.ron");
    let arguments = [
        "measure",
        pipeline,
        "--scene",
        scene.to_str().expect("a path"),
        "--size",
        "48x27",
        "--frames",
        "1",
        "--set",
        without_tone_mapping,
        "--sweep",
        "msaa=1",
        "-o",
        "swept",
    ];
    place.run_with(&variables, &arguments).exits(0);
    let results = std::fs::read_to_string(place.path("swept/results.json")).expect("results");
    let results: Value = serde_json::from_str(&results).expect("JSON");
    let picture = results["rows"][0]["outcome"]["measured"]["reference"].as_str().expect("a path").to_owned();
    let picture = image::open(place.path("swept").join(picture)).expect("a picture").into_rgb8();
    let red: Vec<f64> = picture.pixels().map(|pixel| srgb::decode(f64::from(pixel.0[0]) / 255.0)).collect();
    let coverage = coverage();
    let mean_where = |covered: f64| {
        let found: Vec<f64> =
            red.iter().zip(&coverage).filter(|(_, at)| **at == covered).map(|(red, _)| *red).collect();
        found.iter().sum::<f64>() / found.len() as f64
    };
    let (sky, cube) = (mean_where(0.0), mean_where(1.0));
    assert!(cube - sky > 0.5, "{cube} beside {sky}");
    let edges = red.iter().zip(&coverage).filter(|(_, covered)| (0.02..0.98).contains(*covered));
    let errors: Vec<f64> = edges.map(|(red, covered)| (red - sky) / (cube - sky) - covered).collect();
    let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
    println!("{pipeline}: {} pixels on edges, {rms}", errors.len());
    assert!(errors.len() > 50, "{} pixels on edges", errors.len());
    Some(rms)
}

/// The light of the reference of `image_quality` under a setting, and its extent.
fn reference_of(place: &Place, variables: &[(&str, &str)], set: &str) -> image::Rgb32FImage {
    let arguments = [
        "measure",
        "image_quality",
        "--scene",
        "spheres_and_cubes",
        "--size",
        "48x27",
        "--frames",
        "1",
        "--set",
        set,
        "--sweep",
        "msaa=1",
        "-o",
        set,
    ];
    place.run_with(variables, &arguments).exits(0);
    let folder = std::fs::read_dir(place.path(set).join("pictures")).expect("pictures");
    let mut files = folder.map(|file| file.expect("a file").path());
    let file = files.find(|path| path.extension().is_some_and(|ending| ending == "exr")).expect("a reference");
    image::open(file).expect("a picture").into_rgb32f()
}

/// A blur is as wide in the reference as in the picture, which has fewer texels: that of the unblurred reference, in 64 bits.
#[test]
fn a_blur_is_as_wide_in_a_reference_as_on_the_screen() {
    const DRAWS: usize = 5;
    let place = Place::new();
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let [sharp, blurred] = ["blur=0", "blur=5"].map(|set| reference_of(&place, &variables, set));
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
