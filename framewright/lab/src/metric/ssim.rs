//! Structural similarity: means, variances and covariances within a Gaussian window.
//!
//! Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli: "Image Quality Assessment: From Error Visibility to Structural
//! Similarity", IEEE Transactions on Image Processing 13(4), 2004.

use super::plane::{Edge, Plane};

/// Standard deviation of the window in pixels, and its reach.
const DEVIATION: f64 = 1.5;
/// Pixels on each side of the middle one.
const REACH: usize = 5;
/// The constants that keep quotients of small numbers steady, for values from 0 to 1: squares of 0.01 and 0.03.
const STEADY: [f64; 2] = [1e-4, 9e-4];

/// The similarity of each pixel of two images whose values go from 0 to 1: 1 where they are equal, at least -1. It is the mean
/// over red, green and blue.
pub(super) fn map(reference: &[[f64; 3]], test: &[[f64; 3]], extent: [usize; 2]) -> Plane {
    let window = window();
    let mut mean = vec![0.0; reference.len()];
    for channel in 0..3 {
        let smooth = |number: &dyn Fn(f64, f64) -> f64| {
            let values = reference.iter().zip(test).map(|(a, b)| number(a[channel], b[channel])).collect();
            Plane { extent, values }.filtered(&window, &window, Edge::Mirrored).values
        };
        let (a, b) = (smooth(&|a, _| a), smooth(&|_, b| b));
        let (aa, bb, ab) = (smooth(&|a, _| a * a), smooth(&|_, b| b * b), smooth(&|a, b| a * b));
        for (at, sum) in mean.iter_mut().enumerate() {
            let (mean_a, mean_b) = (a[at], b[at]);
            let (squares, product) = (mean_a * mean_a + mean_b * mean_b, mean_a * mean_b);
            let (variances, covariance) = (aa[at] + bb[at] - squares, ab[at] - product);
            let luminance = (2.0 * product + STEADY[0]) / (squares + STEADY[0]);
            let structure = (2.0 * covariance + STEADY[1]) / (variances + STEADY[1]);
            *sum += luminance * structure / 3.0;
        }
    }
    Plane { extent, values: mean }
}

/// Whether the window of a pixel lies within the image. Only such pixels are part of the mean, unless there is none.
pub(super) fn is_inside([width, height]: [usize; 2], at: usize) -> bool {
    let inside = |at: usize, size: usize| size <= 2 * REACH || (REACH..size - REACH).contains(&at);
    inside(at % width, width) && inside(at / width, height)
}

fn window() -> Vec<f64> {
    let reach = REACH as i32;
    let weights: Vec<f64> =
        (-reach..=reach).map(|at| (-f64::from(at * at) / (2.0 * DEVIATION * DEVIATION)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| weight / sum).collect()
}
