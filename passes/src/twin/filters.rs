//! Twins of `shaders/blur.frag`, `shaders/gauss.frag` and `shaders/downsample.frag`, on one channel of an image.

/// Taps of the blur to each side.
pub const BLUR_RADIUS: i32 = 4;
/// Standard deviation of the blur, in steps.
const BLUR_DEVIATION: f64 = 2.0;

/// The blur along one axis: a Gaussian over `tap(-BLUR_RADIUS)` to `tap(BLUR_RADIUS)`, its weights scaled to add up to 1.
#[must_use]
pub fn blur(tap: impl Fn(i32) -> f64) -> f64 {
    let weight = |at: i32| (-0.5 * (f64::from(at) / BLUR_DEVIATION).powi(2)).exp();
    let taps = || -BLUR_RADIUS..=BLUR_RADIUS;
    taps().map(|at| weight(at) * tap(at)).sum::<f64>() / taps().map(weight).sum::<f64>()
}

/// A Gaussian along one axis over taps up to `radius` steps to each side, 0 to 64, which are three standard deviations; its
/// weights are scaled to add up to 1.
#[must_use]
pub fn gauss(tap: impl Fn(i32) -> f64, radius: f64) -> f64 {
    let weight = |at: i32| if at == 0 { 1.0 } else { (-0.5 * (3.0 * f64::from(at) / radius).powi(2)).exp() };
    let reach = radius.ceil() as i32;
    (-reach..=reach).map(|at| weight(at) * tap(at)).sum::<f64>() / (-reach..=reach).map(weight).sum::<f64>()
}

/// The mean of the four texels that one texel of an image of half the size covers.
#[must_use]
pub fn downsample(texels: [f64; 4]) -> f64 {
    texels.iter().sum::<f64>() / 4.0
}
