//! Twins of `shaders/include/scale.glsl` and of the two filters that samplers have, on one channel of an image.
//!
//! `texel(x, y)` is what a texel of the source holds, also beyond its edges; `pixel` one of the target, and both images have
//! extents in texels.

/// The texels from the first to the last that a pixel covers along one axis, each with how much of it, as a share of all.
fn covered(pixel: u32, source: u32, target: u32) -> impl Iterator<Item = (i32, f64)> + Clone {
    let ratio = f64::from(source) / f64::from(target);
    let (begin, end) = (f64::from(pixel) * ratio, f64::from(pixel + 1) * ratio);
    let texels = begin.floor() as i32..end.ceil() as i32;
    texels.map(move |texel| {
        let within = end.min(f64::from(texel + 1)) - begin.max(f64::from(texel));
        (texel, within / ratio)
    })
}

/// The mean of what a pixel covers: each texel counts by how much of it lies within.
#[must_use]
pub fn area(texel: impl Fn(i32, i32) -> f64, pixel: [u32; 2], source: [u32; 2], target: [u32; 2]) -> f64 {
    let [across, down] = [0, 1].map(|axis| covered(pixel[axis], source[axis], target[axis]));
    down.flat_map(|(y, high)| across.clone().map(move |(x, wide)| (x, y, wide * high)))
        .map(|(x, y, share)| share * texel(x, y))
        .sum()
}

/// The curve of Catmull and Rom (1974): 1 at 0, 0 at every other whole number, nothing beyond 2.
#[must_use]
pub fn catmull_rom(distance: f64) -> f64 {
    match distance.abs() {
        x if x < 1.0 => 1.5 * x.powi(3) - 2.5 * x.powi(2) + 1.0,
        x if x < 2.0 => -0.5 * x.powi(3) + 2.5 * x.powi(2) - 4.0 * x + 2.0,
        _ => 0.0,
    }
}

/// The middle of a pixel along one axis, in texels from the middle of the first.
#[must_use]
pub fn middle(pixel: u32, source: u32, target: u32) -> f64 {
    (f64::from(pixel) + 0.5) * f64::from(source) / f64::from(target) - 0.5
}

/// The source at the middle of a pixel by [`catmull_rom`] along both axes, as much wider as the target is smaller.
#[must_use]
pub fn sharpened(texel: impl Fn(i32, i32) -> f64, pixel: [u32; 2], source: [u32; 2], target: [u32; 2]) -> f64 {
    let taps = [0, 1].map(|axis| {
        let middle = middle(pixel[axis], source[axis], target[axis]);
        let wide = (f64::from(source[axis]) / f64::from(target[axis])).max(1.0);
        let texels = (middle - 2.0 * wide).floor() as i32..=(middle + 2.0 * wide).ceil() as i32;
        let taps: Vec<(i32, f64)> =
            texels.map(|texel| (texel, catmull_rom((f64::from(texel) - middle) / wide))).collect();
        let weights: f64 = taps.iter().map(|(_, weight)| weight).sum();
        taps.into_iter().map(move |(texel, weight)| (texel, weight / weights)).collect::<Vec<_>>()
    });
    let [across, down] = taps;
    let rows = down.iter().map(|(y, high)| across.iter().map(|(x, wide)| wide * texel(*x, *y)).sum::<f64>() * high);
    rows.sum()
}

/// The source at the middle of a pixel, between its four nearest texels.
#[must_use]
pub fn bilinear(texel: impl Fn(i32, i32) -> f64, pixel: [u32; 2], source: [u32; 2], target: [u32; 2]) -> f64 {
    let [x, y] = [0, 1].map(|axis| middle(pixel[axis], source[axis], target[axis]));
    let (left, upper) = (x.floor() as i32, y.floor() as i32);
    let row = |y: i32| texel(left, y) * (1.0 - x.rem_euclid(1.0)) + texel(left + 1, y) * x.rem_euclid(1.0);
    row(upper) * (1.0 - y.rem_euclid(1.0)) + row(upper + 1) * y.rem_euclid(1.0)
}
