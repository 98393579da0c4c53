//! Twin of `shaders/include/bloom.glsl` and of the shaders that use it. Sources of the filters stand there.

use super::exposure::luminance;

/// Linear light of red, green and blue.
type Light = [f64; 3];

fn add(a: Light, b: Light, weight: f64) -> Light {
    std::array::from_fn(|channel| a[channel] + weight * b[channel])
}

/// The light for a texel of an image of half the size, from `tap`, the light at an offset in texels from its middle. With
/// `partial` bright boxes count less.
#[must_use]
pub fn shrunk(tap: impl Fn(f64, f64) -> Light, partial: bool) -> Light {
    // Middle of each box, how far its four taps lie from there, and its weight.
    let boxes = [(0.0, 0.0, 0.5), (-1.0, -1.0, 0.125), (1.0, -1.0, 0.125), (-1.0, 1.0, 0.125), (1.0, 1.0, 0.125)];
    let (mut sum, mut weights) = ([0.0; 3], 0.0);
    for (x, y, weight) in boxes {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let mean = corners.iter().fold([0.0; 3], |mean, (dx, dy)| add(mean, tap(x + dx, y + dy), 0.25));
        let weight = if partial { weight / (1.0 + luminance(mean)) } else { weight };
        sum = add(sum, mean, weight);
        weights += weight;
    }
    sum.map(|sum| sum / weights)
}

/// The light under a tent of 3 × 3 taps `radius` texels apart, from `tap` as in [`shrunk`].
#[must_use]
pub fn tent(tap: impl Fn(f64, f64) -> Light, radius: f64) -> Light {
    let weights = [(-1.0, 0.25), (0.0, 0.5), (1.0, 0.25)];
    let taps = weights.iter().flat_map(|(x, across)| weights.iter().map(move |(y, down)| (x, y, across * down)));
    taps.fold([0.0; 3], |sum, (x, y, weight)| add(sum, tap(radius * x, radius * y), weight))
}

/// `own` with so much of `below` mixed in, 0 to 1: what `bloom_grow` and `bloom_mix` make of light and the tent over another.
#[must_use]
pub fn mixed(own: Light, below: Light, share: f64) -> Light {
    add(own.map(|light| light * (1.0 - share)), below, share)
}
