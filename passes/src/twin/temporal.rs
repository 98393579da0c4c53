//! Twin of `shaders/include/temporal.glsl`: what the frames before have left of a picture, mixed with this one.

use super::weighted_resolve::{compressed, expanded};

type Color = [f64; 3];

/// A difference from the mean that is always allowed, also where all texels are equal.
const EVEN_DEVIATION: f64 = 1e-3;

/// Luma and two differences of colour (ITU-T H.273, YCgCo).
fn to_ycocg([r, g, b]: Color) -> Color {
    [0.25 * r + 0.5 * g + 0.25 * b, 0.5 * (r - b), 0.5 * g - 0.25 * (r + b)]
}

fn from_ycocg([y, co, cg]: Color) -> Color {
    [y + co - cg, y + cg, y - co - cg]
}

/// Clips history to the 3 × 3 texels around it: to this number of standard deviations from their mean and an allowance, in YCgCo
/// of tone-mapped radiance.
#[must_use]
pub fn allowed_history(history: Color, around: &[Color; 9], deviations: f64, allowance: f64) -> Color {
    let seen = around.map(|radiance| to_ycocg(compressed(radiance)));
    let mean = |value: &dyn Fn(&Color) -> f64| seen.iter().map(value).sum::<f64>() / 9.0;
    let middle = [0, 1, 2].map(|part| mean(&|color| color[part]));
    let reach = [0, 1, 2].map(|part| {
        let variance = mean(&|color| (color[part] - middle[part]).powi(2));
        deviations * variance.sqrt() + allowance + EVEN_DEVIATION
    });
    let found = to_ycocg(compressed(history));
    let most = (0..3).map(|part| (found[part] - middle[part]).abs() / reach[part]).fold(0.0, f64::max);
    if most <= 1.0 {
        return history;
    }
    let nearer = [0, 1, 2].map(|part| middle[part] + (found[part] - middle[part]) / most);
    expanded(from_ycocg(nearer).map(|channel| channel.max(0.0)))
}

/// Luma of a radiance as it is compared, 0 to 1.
#[must_use]
pub fn compared_luma(radiance: Color) -> f64 {
    to_ycocg(compressed(radiance))[0]
}

/// By how much history may differ from all colours around: twice the mean change of luma between frames at rest, and nothing from a
/// quarter of a texel a frame on.
#[must_use]
pub fn change_allowed(change: f64, speed: f64) -> f64 {
    2.0 * change * (1.0 - 4.0 * speed).max(0.0)
}

/// How much a frame counts after one that counted `last`: as much as each frame before, at least `share`, and at least a quarter at a
/// texel a frame.
#[must_use]
pub fn share_after(last: f64, share: f64, speed: f64) -> f64 {
    let frames_before = 1.0 / last;
    (1.0 / (frames_before + 1.0)).max(share).max(0.25 * speed.min(1.0))
}

/// The mean of the new colour, with weight `share`, and of history; bright colours weigh less.
#[must_use]
pub fn mixed(drawn: Color, history: Color, share: f64) -> Color {
    let weight = |radiance: Color| 1.0 / (1.0 + radiance.into_iter().fold(0.0, f64::max));
    let (of_drawn, of_history) = (share * weight(drawn), (1.0 - share) * weight(history));
    [0, 1, 2].map(|at| (of_drawn * drawn[at] + of_history * history[at]) / (of_drawn + of_history))
}
