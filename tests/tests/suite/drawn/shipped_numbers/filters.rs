//! Filters over numbers that go wrong easily, against their twins: an infinite texel is as bright as a texel can be, and one
//! that is no number is black.

use super::outputs;
use super::pipeline::{EXTENT, Pipeline};
use framewright_passes::twin::filters::{blur, downsample};
use framewright_passes::twin::radiance::{guard_alpha, guard_radiance, guard_signed};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const PASSES: &str = r#"
    (name: "across", draw: FullScreen("blur"), sample: {"source": "extremes"}, color: ["across"],
        params: {"direction_x": 1.0, "direction_y": 0.0}),
    (name: "half", draw: FullScreen("downsample"), sample: {"source": "extremes"}, color: ["half"]),
    (name: "copied", draw: FullScreen("copy"), sample: {"source": "extremes"}, color: ["copied"]),
    (name: "smoothed", draw: FullScreen("fxaa"), sample: {"source": "extremes"}, params: {"subpixel": 0.0}, color: ["smoothed"]),
    (name: "halves", draw: FullScreen("copy"), sample: {"source": (image: "extremes", filter: Nearest)}, color: ["halves"]),
    (name: "held", draw: FullScreen("copy"), sample: {"source": (image: "halves", filter: Nearest)}, color: ["held"]),
"#;

/// An image of the extremes' size, channel by channel.
struct Image(Vec<f64>);

impl Image {
    fn at(&self, x: i32, y: i32, channel: usize) -> f64 {
        let [width, height] = EXTENT.map(u32::cast_signed);
        self.0[4 * (y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize + channel]
    }
}

/// The extremes, and what each of [`PASSES`] but the last but one made of them.
fn filtered() -> Result<Option<[Image; 6]>, Box<dyn Error>> {
    let mut pipeline = Pipeline::with_extremes();
    pipeline.image("halves", "R16G16B16A16_SFLOAT");
    for name in ["across", "half", "copied", "smoothed", "held"] {
        pipeline.output(name, "R32G32B32A32_SFLOAT");
    }
    pipeline.pass(PASSES);
    let text = pipeline.text().replace("outputs: [", "outputs: [\"extremes\", ").replace(
        "(name: \"half\", format: R32G32B32A32_SFLOAT, size: Fixed(32, 16))",
        "(name: \"half\", format: R32G32B32A32_SFLOAT, size: Fixed(16, 8))",
    );
    let Some(images) = outputs(&text, &empty_scene())? else { return Ok(None) };
    let images: Vec<Image> = images.into_iter().map(Image).collect();
    Ok(Some(images.try_into().map_err(|_| "not six outputs")?))
}

fn places() -> impl Iterator<Item = (i32, i32, usize)> {
    let [width, height] = EXTENT.map(u32::cast_signed);
    (0..height).flat_map(move |y| (0..width).flat_map(move |x| (0..4).map(move |channel| (x, y, channel))))
}

fn guard(number: f64, channel: usize) -> f64 {
    if channel == 3 { guard_alpha(number) } else { guard_radiance(number) }
}

fn close(found: f64, expected: f64) -> bool {
    // A blur has some 20 roundings of 2⁻²⁴ each; numbers below the smallest normal one may be flushed to zero.
    (found - expected).abs() <= 2e-6 * 65504.0_f64.min(expected.abs().max(1.0))
}

#[test]
fn a_blur_of_infinite_texels_is_bright_and_of_what_is_no_number_black() -> Result<(), Box<dyn Error>> {
    let Some([extremes, across, ..]) = filtered()? else { return Ok(()) };
    for (x, y, channel) in places().filter(|(.., channel)| *channel != 3) {
        let expected = blur(|step| guard(extremes.at(x + step, y, channel), channel));
        let found = across.at(x, y, channel);
        assert!((found - expected).abs() <= 2e-6 * 65504.0, "({x}, {y}) channel {channel}: {found}, not {expected}");
    }
    Ok(())
}

#[test]
fn half_the_size_of_infinite_texels_is_the_mean_of_the_largest_numbers() -> Result<(), Box<dyn Error>> {
    let Some([extremes, _, half, ..]) = filtered()? else { return Ok(()) };
    for (x, y, channel) in places().filter(|(x, y, channel)| *x < 16 && *y < 8 && *channel != 3) {
        let texel = |channel: usize| {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| extremes.at(2 * x + dx, 2 * y + dy, channel))
        };
        // Where one of them isn't finite they are mixed after the guard.
        let finite = texel(channel).into_iter().all(f64::is_finite);
        let texels = if finite { texel(channel) } else { texel(channel).map(guard_signed) };
        let expected = guard_radiance(downsample(texels));
        let found = half.0[(4 * (y * 16 + x)) as usize + channel];
        assert!(close(found, expected), "({x}, {y}) channel {channel}: {found}, not {expected}");
    }
    Ok(())
}

#[test]
fn a_copy_keeps_what_a_half_float_holds_and_cuts_off_the_rest() -> Result<(), Box<dyn Error>> {
    let Some([extremes, _, _, copied, _, held]) = filtered()? else { return Ok(()) };
    for (x, y, channel) in places() {
        let number = extremes.at(x, y, channel);
        // Of alpha what a filter makes is guarded, not what it is given.
        if channel < 3 {
            let (found, expected) = (copied.at(x, y, channel), guard_signed(number));
            assert!(close(found, expected), "({x}, {y}) channel {channel}: {number} became {found}");
        }
        let (found, expected) = (held.at(x, y, channel), guard_signed(number));
        assert!(close(found, expected), "({x}, {y}) channel {channel}: {number} became {found} in half floats");
    }
    Ok(())
}

#[test]
fn fxaa_spreads_no_number_that_is_none() -> Result<(), Box<dyn Error>> {
    let Some([extremes, _, _, _, smoothed, _]) = filtered()? else { return Ok(()) };
    for (x, y, channel) in places() {
        // The mixture is of the texel itself and one of those around it.
        let around = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)]
            .map(|(dx, dy)| guard(extremes.at(x + dx, y + dy, channel), channel));
        let (least, most) = around.into_iter().fold((f64::MAX, 0.0_f64), |(a, b), it| (a.min(it), b.max(it)));
        let found = smoothed.at(x, y, channel);
        // Numbers below the smallest normal one may be flushed to zero.
        let tiny = f64::from(f32::MIN_POSITIVE);
        assert!((least - tiny..=most).contains(&found), "({x}, {y}) channel {channel}: {found} of {around:?}");
    }
    Ok(())
}
