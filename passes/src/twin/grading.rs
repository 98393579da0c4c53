//! Twin of `shaders/color_grade.frag` and `shaders/include/grading.glsl`.

use crate::srgb::{decode, encode};

/// What a table makes of a colour: linear red, green and blue of 0 to 1. The table has `size` shades of each channel; `entry` is
/// an encoded colour at a red, green and blue of 0 to `size - 1`. `strength` is the share of the graded colour, 0 to 1.
#[must_use]
pub fn graded(shown: [f64; 3], size: usize, entry: impl Fn([usize; 3]) -> [f64; 3], strength: f64) -> [f64; 3] {
    let place = shown.map(|channel| encode(channel) * (size - 1) as f64);
    let from = place.map(|place| (place as usize).min(size.saturating_sub(2)));
    let mut sum = [0.0; 3];
    for corner in 0..8 {
        let mut at = from;
        let mut weight = 1.0;
        for channel in 0..3 {
            let share = place[channel] - from[channel] as f64;
            let upper = corner >> channel & 1;
            at[channel] = (from[channel] + upper).min(size - 1);
            weight *= if upper == 1 { share } else { 1.0 - share };
        }
        let found = entry(at);
        sum = [0, 1, 2].map(|channel| sum[channel] + weight * found[channel]);
    }
    [0, 1, 2].map(|channel| shown[channel] + strength * (decode(sum[channel]) - shown[channel]))
}
