//! Twin of `shaders/include/weighted_resolve.glsl` and of `shaders/resolve_weighted.frag`, by the steps that the latter
//! leaves out.

/// The largest channel.
fn largest(radiance: [f64; 3]) -> f64 {
    radiance.into_iter().fold(0.0, f64::max)
}

/// A sample made small: `c / (1 + max)`, radiance in 0…65504 to below 1.
#[must_use]
pub fn compressed(radiance: [f64; 3]) -> [f64; 3] {
    radiance.map(|channel| channel / (1.0 + largest(radiance)))
}

/// The inverse of [`compressed`]: `c / (1 − max)`.
#[must_use]
pub fn expanded(color: [f64; 3]) -> [f64; 3] {
    color.map(|channel| channel / (1.0 - largest(color)))
}

/// The mean of all samples, each compressed: 0…1. There is at least one.
#[must_use]
pub fn mean_compressed(samples: &[[f64; 3]]) -> [f64; 3] {
    let small: Vec<_> = samples.iter().copied().map(compressed).collect();
    [0, 1, 2].map(|channel| small.iter().map(|color| color[channel]).sum::<f64>() / small.len() as f64)
}

/// The mean of all samples in which bright ones weigh less, `1 / (1 + max)` each: radiance.
#[must_use]
pub fn weighted_mean(samples: &[[f64; 3]]) -> [f64; 3] {
    let weight = |radiance: &[f64; 3]| 1.0 / (1.0 + largest(*radiance));
    let weights: f64 = samples.iter().map(weight).sum();
    [0, 1, 2].map(|channel| samples.iter().map(|it| weight(it) * it[channel]).sum::<f64>() / weights)
}
