//! Twin of `shaders/luminance_histogram.comp`, `shaders/adapt_exposure.comp` and `shaders/include/luminance.glsl`.
//!
//! Source of average and key: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda, "Photographic Tone Reproduction for Digital
//! Images", SIGGRAPH 2002, equations 1 and 2; of the exponential adaptation: G. Krawczyk, K. Myszkowski, H.-P. Seidel,
//! "Perceptual Effects in Real-Time Tone Mapping", SCCG 2005.

pub use crate::srgb::luminance;

/// Bins of the histogram.
pub const BINS: usize = 256;
const DARKEST_STOP: f64 = -16.0;
const BINS_A_STOP: f64 = 8.0;

/// The place of a luminance among the bins: the whole part is its bin.
#[must_use]
pub fn place_of(luminance: f64) -> f64 {
    let stop = luminance.max(DARKEST_STOP.exp2()).log2();
    ((stop - DARKEST_STOP) * BINS_A_STOP).clamp(0.0, BINS as f64 - 1.0)
}

/// The average logarithm to base 2 of the luminance of counted texels, without the darkest and the brightest of them: two
/// shares, 0 to 0.49.
#[must_use]
pub fn average_stop(bins: &[u32; BINS], darkest: f64, brightest: f64) -> f64 {
    let stop = |bin: usize| DARKEST_STOP + (bin as f64 + 0.5) / BINS_A_STOP;
    let texels = bins.iter().zip(0..).flat_map(|(count, bin)| std::iter::repeat_n(stop(bin), *count as usize));
    let all: u32 = bins.iter().sum();
    let [first, beyond] = [darkest, brightest].map(|share| (share * f64::from(all)) as usize);
    let kept = all as usize - first - beyond;
    texels.skip(first).take(kept).sum::<f64>() / kept.max(1) as f64
}

/// The stop that the eye is used to after `frames` frames over a picture with this average, if it began with `before`.
/// `seconds` lie between two frames; after `adaptation` seconds 1 − 1/e of the change is adapted to.
#[must_use]
pub fn adapted(before: f64, average: f64, frames: u32, seconds: f64, adaptation: f64) -> f64 {
    average + (before - average) * (-f64::from(frames) * seconds / adaptation).exp()
}

/// The factor of radiance for an eye that is adapted to `stop`, if that radiance becomes `key`.
#[must_use]
pub fn scale(key: f64, stop: f64) -> f64 {
    key * (-stop).exp2()
}
