//! Sampler filters over numbers that go wrong easily, where the image that is drawn into has another size than the one that is
//! sampled, or a size that floating point divides inexactly.

use super::outputs;
use framewright_passes::twin::radiance::guard_signed;
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTREMES: [i32; 2] = [32, 16];
const DOUBLED: [i32; 2] = [64, 32];
const ODD: [i32; 2] = [41, 19];

const PIPELINE: &str = r#"Pipeline(
    version: 1,
    images: [
        (name: "extremes", format: R32G32B32A32_SFLOAT, size: Fixed(32, 16)),
        (name: "nearest", format: R32G32B32A32_SFLOAT, size: Fixed(64, 32)),
        (name: "linear", format: R32G32B32A32_SFLOAT, size: Fixed(64, 32)),
        (name: "odd", format: R32G32B32A32_SFLOAT, size: Fixed(41, 19)),
        (name: "copied", format: R32G32B32A32_SFLOAT, size: Fixed(41, 19)),
    ],
    passes: [
        (name: "extremes", draw: FullScreen("extremes"), color: ["extremes"]),
        (name: "nearest", draw: FullScreen("copy"), sample: {"source": (image: "extremes", filter: Nearest)}, color: ["nearest"]),
        (name: "linear", draw: FullScreen("copy"), sample: {"source": (image: "extremes", filter: Linear)}, color: ["linear"]),
        (name: "odd", draw: FullScreen("extremes"), color: ["odd"]),
        (name: "copied", draw: FullScreen("copy"), sample: {"source": (image: "odd", filter: Linear)}, color: ["copied"]),
    ],
    outputs: ["extremes", "nearest", "linear", "odd", "copied"],
)"#;

/// An image of four channels.
struct Image {
    numbers: Vec<f64>,
    extent: [i32; 2],
}

impl Image {
    fn at(&self, x: i32, y: i32, channel: usize) -> f64 {
        let [width, height] = self.extent;
        self.numbers[4 * (y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize + channel]
    }

    /// Each place and colour channel. Alpha is left as it is found.
    fn places(&self) -> impl Iterator<Item = (i32, i32, usize)> + use<> {
        let [width, height] = self.extent;
        (0..height).flat_map(move |y| (0..width).flat_map(move |x| (0..3).map(move |channel| (x, y, channel))))
    }
}

fn drawn() -> Result<Option<[Image; 5]>, Box<dyn Error>> {
    let Some(outputs) = outputs(PIPELINE, &empty_scene())? else { return Ok(None) };
    let extents = [EXTREMES, DOUBLED, DOUBLED, ODD, ODD];
    let images: Vec<Image> =
        outputs.into_iter().zip(extents).map(|(numbers, extent)| Image { numbers, extent }).collect();
    Ok(Some(images.try_into().map_err(|_| "not five outputs")?))
}

fn close(found: f64, expected: f64) -> bool {
    // Some roundings of 2⁻²⁴ of the numbers that are mixed; numbers below the smallest normal one may be flushed to zero.
    (found - expected).abs() <= 2e-6 * 65504.0_f64.min(expected.abs().max(1.0))
}

#[test]
fn a_nearest_filter_at_twice_the_size_finds_single_guarded_texels() -> Result<(), Box<dyn Error>> {
    let Some([extremes, nearest, ..]) = drawn()? else { return Ok(()) };
    for (x, y, channel) in nearest.places() {
        let number = extremes.at(x / 2, y / 2, channel);
        let (found, expected) = (nearest.at(x, y, channel), guard_signed(number));
        assert!(close(found, expected), "({x}, {y}) channel {channel}: {number} became {found}, not {expected}");
    }
    Ok(())
}

#[test]
fn a_linear_filter_at_twice_the_size_mixes_guarded_texels() -> Result<(), Box<dyn Error>> {
    let Some([extremes, _, linear, ..]) = drawn()? else { return Ok(()) };
    let mut mended = 0;
    for (x, y, channel) in linear.places() {
        // A quarter of a texel from the centre of the nearest texel.
        let [nearest, beside] = [[x, y].map(|at| at / 2), [x, y].map(|at| at / 2 - 1 + 2 * (at % 2))];
        let mixed = [(nearest, 0.75), (beside, 0.25)];
        let texels =
            mixed.map(|([_, y], down)| mixed.map(|([x, _], across)| (extremes.at(x, y, channel), across * down)));
        let texels = texels.as_flattened();
        if texels.iter().all(|(number, _)| number.is_finite()) {
            continue;
        }
        let expected: f64 = texels.iter().map(|(number, share)| share * guard_signed(*number)).sum();
        let found = linear.at(x, y, channel);
        let largest = texels.iter().map(|(number, _)| guard_signed(*number).abs()).fold(1.0, f64::max);
        assert!((found - expected).abs() <= 2e-6 * largest, "({x}, {y}) channel {channel}: {found}, not {expected}");
        mended += 1;
    }
    assert!(mended > 1000, "only {mended} numbers are mixed with one that isn't finite");
    Ok(())
}

#[test]
fn a_linear_filter_at_the_centers_of_texels_finds_them_at_an_odd_size_too() -> Result<(), Box<dyn Error>> {
    let Some([.., odd, copied]) = drawn()? else { return Ok(()) };
    let mut beside = 0;
    for (x, y, channel) in copied.places() {
        let number = odd.at(x, y, channel);
        let around = [-1, 0, 1].map(|dy| [-1, 0, 1].map(|dx| odd.at(x + dx, y + dy, channel)));
        let around = around.as_flattened();
        // Finite texels say nothing. The place of a look-up may be a little off the centre: much for huge numbers.
        let huge = |it: &f64| it.is_finite() && it.abs() > 65504.0;
        if around.iter().all(|it| it.is_finite()) || around.iter().any(huge) {
            continue;
        }
        let (found, expected) = (copied.at(x, y, channel), guard_signed(number));
        let near = (found - expected).abs() <= 4e-6 * 65504.0;
        assert!(near, "({x}, {y}) channel {channel}: {number} became {found}, not {expected}");
        beside += 1;
    }
    assert!(beside > 300, "only {beside} numbers have one beside them that isn't finite");
    Ok(())
}
