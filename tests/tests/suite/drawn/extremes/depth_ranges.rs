//! Near and far planes twelve powers of ten apart, in every depth format: reversed depth with and without a far plane, and
//! standard depth, for which a pipeline has a vertex shader, clear value and test of its own.

use super::outputs;
use framewright_graph::vulkan::Format;
use framewright_passes::scene::Scene;
use framewright_passes::twin::distance::depth_at;
use framewright_tests::render::{device, floats};
use framewright_tests::shapes::{material, scene, square};
use glam::{DMat4, DVec3};
use std::error::Error;

const NEAR: f64 = 1e-4;
const FAR: f64 = 1e8;
const COLUMNS: u32 = 48;
/// The squares of a pair lie this share of their distance apart.
const APART: f64 = 1.0 / 64.0;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Projection {
    Infinite,
    Reversed,
    Standard,
}

fn distance(column: u32) -> f64 {
    let share = f64::from(column) / f64::from(COLUMNS - 1);
    NEAR * 1.01 * (FAR / NEAR / 1.2).powf(share)
}

/// A pair of squares in each column: the nearer one first, red, and a green one behind it. The farther one is drawn over the
/// nearer one if their depth is the same.
fn pairs(far: Option<f32>) -> Scene {
    let mut red = material([0.0, 0.0, 0.0, 1.0]);
    red.emissive = [1.0, 0.0, 0.0];
    let mut green = red.clone();
    green.emissive = [0.0, 1.0, 0.0];
    let mut pairs = scene(vec![square()], vec![red, green], Vec::new());
    pairs.camera.transform = DMat4::IDENTITY;
    (pairs.camera.near, pairs.camera.far) = (NEAR as f32, far);
    let up = (f64::from(pairs.camera.vertical_fov) * 0.5).tan();
    let object = scene(Vec::new(), Vec::new(), vec![(0, 0, glam::Mat4::IDENTITY)]).objects.remove(0);
    for (column, material) in (0..COLUMNS).flat_map(|column| [(column, 0), (column, 1)]) {
        let away = distance(column) * if material == 0 { 1.0 } else { 1.0 + APART };
        // The picture is as wide as there are columns, and 4 texels high.
        let texel = away * up * 2.0 / 4.0;
        let x = (f64::from(column) + 0.5 - 0.5 * f64::from(COLUMNS)) * texel;
        let size = DVec3::new(texel * 0.5, texel * 2.0, 1.0);
        let mut square = object.clone();
        square.material = material;
        square.transform = DMat4::from_translation(DVec3::new(x, 0.0, -away)) * DMat4::from_scale(size);
        pairs.objects.push(square);
    }
    pairs
}

fn is_known(format: Format) -> bool {
    let of = |device: &framewright_vulkan::Device| device.profile().formats;
    device().is_some_and(|device| of(device).iter().any(|known| known.format == format && !known.samples.is_empty()))
}

/// By column, whether the nearer square is seen, and the depth there.
type Columns = Vec<(bool, f64)>;

/// The columns of a picture; `None`: there is no device.
fn drawn(projection: Projection, format: Format) -> Result<Option<Columns>, Box<dyn Error>> {
    let (shader, test) = match projection {
        Projection::Standard => ("standard_depth", "clear: 1.0, test: LessOrEqual"),
        _ => ("lit", "clear: 0.0"),
    };
    let pipeline = format!(
        r#"Pipeline(
            version: 1,
            images: [
                (name: "color", format: R32G32B32A32_SFLOAT, size: Output),
                (name: "depth", format: {format}, size: Output),
                (name: "seen", format: R32_SFLOAT, size: Output),
            ],
            passes: [
                (name: "pairs", draw: Objects(Opaque), shader: "{shader}",
                    color: [(image: "color", clear: (0.0, 0.0, 0.0, 0.0))], depth: (image: "depth", {test})),
                (name: "see", draw: FullScreen("copy"), sample: {{"source": (image: "depth", filter: Nearest)}}, color: ["seen"]),
            ],
            outputs: ["color", "seen"],
        )"#
    );
    let scene = pairs((projection != Projection::Infinite).then_some(FAR as f32));
    let shown = outputs(&pipeline, &scene, [COLUMNS, 4]);
    let Some(shown) = shown? else { return Ok(None) };
    let (colors, depths) = (floats(&shown[0]), floats(&shown[1]));
    // The second row of four.
    let texels = (0..COLUMNS as usize).map(|column| COLUMNS as usize + column);
    Ok(Some(texels.map(|at| (colors[4 * at] > 0.5 && colors[4 * at + 1] < 0.5, depths[at])).collect()))
}

/// NU-4: reversed 32-bit depth, with a far plane or without, tells apart what lies 1/64 of its distance apart from 0.1 mm to
/// 100,000 km. All else does so up to a quarter of near · 2ⁿ / 64, which is 0.1 m with 16 bits and 26 m with 24 bits or with
/// standard depth in 32. Beyond 4 · near · 2ⁿ, 26 m and 6,700 m, reversed depth of 16 and 24 bits tells nothing apart.
#[test]
fn reversed_floating_point_depth_tells_all_distances_apart_and_no_other_depth_does() -> Result<(), Box<dyn Error>> {
    let steps = |format, projection| match (format, projection) {
        (Format::D16_UNORM, _) => 2_f64.powi(16),
        (Format::X8_D24_UNORM_PACK32, _) | (_, Projection::Standard) => 2_f64.powi(24),
        _ => f64::INFINITY,
    };
    for format in [Format::D16_UNORM, Format::X8_D24_UNORM_PACK32, Format::D32_SFLOAT] {
        for projection in [Projection::Infinite, Projection::Reversed, Projection::Standard] {
            let Some(columns) = drawn(projection, format)? else { continue };
            // A device that lacks the format is given the next finer one.
            let steps = steps(if is_known(format) { format } else { Format::D32_SFLOAT }, projection);
            let reach = NEAR * steps * APART;
            let mut lost = 0;
            for (column, (told_apart, depth)) in (0..).zip(columns) {
                let away = distance(column);
                let shown = if told_apart { away } else { away * (1.0 + APART) };
                let reversed = depth_at(shown, NEAR, (projection != Projection::Infinite).then_some(FAR));
                let expected = if projection == Projection::Standard { 1.0 - reversed } else { reversed };
                // Numbers of 24 bits, and a step of the format.
                let bound =
                    1e-6 * NEAR / shown + 1.5 / steps + if projection == Projection::Standard { 2e-7 } else { 0.0 };
                let close = (depth - expected).abs() <= bound;
                assert!(close, "{format}, {projection:?}, {away} m: depth {depth}, not {expected}");
                let case = format!("{format}, {projection:?}, {away} m: told apart is {told_apart}");
                assert!(told_apart || away > reach / 4.0, "{case}");
                // Standard depth is rounded before it is stored: there chance tells some pairs apart.
                let by_chance = projection == Projection::Standard;
                assert!(!told_apart || by_chance || away < 4.0 * NEAR * steps, "{case}");
                lost += usize::from(!told_apart);
            }
            assert_eq!(lost > 5, steps.is_finite(), "{format}, {projection:?}: {lost} of {COLUMNS} pairs are one");
        }
    }
    Ok(())
}
