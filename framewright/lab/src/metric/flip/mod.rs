//! FLIP: how visible the difference of two pictures is to a person who flips between them, from 0 to 1.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild: "FLIP: A Difference Evaluator for
//! Alternating Images", HPG 2020. P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Möller: "Visualizing Errors in Rendered High
//! Dynamic Range Images", Eurographics 2021 (HDR-FLIP).

mod color;
mod exposures;

use super::plane::{Edge, Plane};
use color::{hunt_lab, hyab, rgb_of_ycxcz, ycxcz};
pub use exposures::Exposures;
use std::f64::consts::PI;
use std::ops::RangeInclusive;
use std::thread;

/// Pixels for a degree of sight: a screen of 3,840 pixels and 0.7 m width, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// The pixels for a degree that errors are told for: the reach of filters grows with them.
pub const PIXELS_PER_DEGREE_RANGE: RangeInclusive<f64> = 1.0..=1000.0;

/// Amplitudes and widths (in square degrees) of the eye's contrast sensitivity: lightness, red against green, and the two terms of
/// yellow against blue.
const SENSITIVITY: [(f64, f64); 4] = [(1.0, 0.0047), (1.0, 0.0053), (34.1, 0.04), (13.5, 0.025)];
/// The exponent of colour differences.
const COLOR_EXPONENT: f64 = 0.7;
/// The share of the largest difference that is mapped to [`KNEE_TO`].
const KNEE: f64 = 0.4;
const KNEE_TO: f64 = 0.95;
/// The width of features in degrees.
const FEATURE_WIDTH: f64 = 0.082;
/// The exponent of feature differences.
const FEATURE_EXPONENT: f64 = 0.5;

/// FLIP of two pictures of linear light from 0 to 1.
pub(super) fn of_display(reference: &[[f64; 3]], test: &[[f64; 3]], extent: [usize; 2], pixels: f64) -> Plane {
    let of = |texels: &[[f64; 3]]| {
        let texels: Vec<[f64; 3]> =
            texels.iter().map(|texel| ycxcz(texel.map(|light| light.clamp(0.0, 1.0)))).collect();
        (seen(&texels, extent, pixels), Features::of(&texels, extent, pixels))
    };
    let ((seen_reference, features_reference), (seen_test, features_test)) = thread::scope(|scope| {
        let reference = scope.spawn(|| of(reference));
        let test = of(test);
        // Both do the same: one that fails does so here too.
        (reference.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), test)
    });
    let most = largest_difference();
    let colors = seen_reference.iter().zip(&seen_test).map(|(a, b)| mapped(hyab(*a, *b).powf(COLOR_EXPONENT), most));
    let features = features_reference.differences(&features_test);
    Plane { extent, values: colors.zip(features).map(|(color, feature)| color.powf(1.0 - feature)).collect() }
}

/// HDR-FLIP of two pictures of linear light: at each pixel the largest FLIP over the exposures.
pub(super) fn of_light(
    reference: &[[f64; 3]],
    test: &[[f64; 3]],
    extent: [usize; 2],
    pixels: f64,
    exposures: Exposures,
) -> Plane {
    let mut largest = Plane { extent, values: vec![0.0; reference.len()] };
    for stop in exposures.stops() {
        let shown = |texels: &[[f64; 3]]| texels.iter().map(|texel| exposures::shown(*texel, stop)).collect::<Vec<_>>();
        let flip = of_display(&shown(reference), &shown(test), extent, pixels);
        largest.values.iter_mut().zip(flip.values).for_each(|(largest, flip)| *largest = largest.max(flip));
    }
    largest
}

/// Colours as the eye sees them from its distance, in CIELAB.
fn seen(texels: &[[f64; 3]], extent: [usize; 2], pixels: f64) -> Vec<[f64; 3]> {
    // The reach is that of the widest term.
    let reach = (3.0 * (SENSITIVITY[2].1 / (2.0 * PI * PI)).sqrt() * pixels).ceil() as i32;
    let blur = |channel: usize, (amplitude, width): (f64, f64)| {
        let square = |at: i32| (f64::from(at) / pixels).powi(2);
        let weights: Vec<f64> = (-reach..=reach).map(|at| (-PI * PI * square(at) / width).exp()).collect();
        let sum: f64 = weights.iter().sum();
        let plane = Plane::of(extent, texels, |texel| texel[channel]).filtered(&weights, &weights, Edge::Repeated);
        (plane.values, 1.0 / (sum * sum), amplitude * (PI / width).sqrt() * sum * sum)
    };
    let [y, cx, wide, narrow] =
        [(0, 0), (1, 1), (2, 2), (2, 3)].map(|(channel, term)| blur(channel, SENSITIVITY[term]));
    // Both terms of one channel add up to 1 together, each by its volume.
    let both = wide.2 + narrow.2;
    let weighted = |(values, unit, volume): &(Vec<f64>, f64, f64), at: usize| values[at] * unit * volume / both;
    let seen = |at: usize| {
        let filtered = [y.0[at] * y.1, cx.0[at] * cx.1, weighted(&wide, at) + weighted(&narrow, at)];
        hunt_lab(rgb_of_ycxcz(filtered).map(|light| light.clamp(0.0, 1.0)))
    };
    (0..texels.len()).map(seen).collect()
}

/// The strength of edges and of points at each pixel.
struct Features {
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Features {
    fn of(texels: &[[f64; 3]], extent: [usize; 2], pixels: f64) -> Features {
        let deviation = 0.5 * FEATURE_WIDTH * pixels;
        let reach = (3.0 * deviation).ceil() as i32;
        let list = |weight: &dyn Fn(f64) -> f64| {
            let bell = |at: f64| (-at * at / (2.0 * deviation * deviation)).exp();
            let weights: Vec<f64> =
                (-reach..=reach).map(f64::from).map(|at| weight(at / deviation) * bell(at)).collect();
            let sum = |sign: f64| weights.iter().map(|it| it * sign).filter(|it| *it > 0.0).sum::<f64>();
            let (positive, negative) = (sum(1.0), sum(-1.0));
            weights
                .into_iter()
                .map(|it| it / if it > 0.0 { positive } else { negative.max(f64::MIN_POSITIVE) })
                .collect()
        };
        // A Gaussian and its first and second derivative; what is positive adds up to 1, and what is negative to -1.
        let [bell, slope, bend]: [Vec<f64>; 3] = [list(&|_| 1.0), list(&|at| -at), list(&|at| at * at - 1.0)];
        let light = Plane::of(extent, texels, |texel| (texel[0] + 16.0) / 116.0);
        let strength = |weights: &[f64]| {
            let across = light.filtered(weights, &bell, Edge::Repeated).values;
            let down = light.filtered(&bell, weights, Edge::Repeated).values;
            across.into_iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
        };
        Features { edges: strength(&slope), points: strength(&bend) }
    }

    /// The difference of two pictures' features at each pixel, from 0 to 1.
    fn differences(&self, other: &Features) -> impl Iterator<Item = f64> {
        let edges = self.edges.iter().zip(&other.edges).map(|(a, b)| (a - b).abs());
        let points = self.points.iter().zip(&other.points).map(|(a, b)| (a - b).abs());
        edges.zip(points).map(|(edge, point)| (edge.max(point) / 2.0_f64.sqrt()).powf(FEATURE_EXPONENT))
    }
}

/// The largest difference of two colours: green and blue.
fn largest_difference() -> f64 {
    hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(COLOR_EXPONENT)
}

/// A colour difference from 0 to 1: what is below the knee takes most of the range.
fn mapped(difference: f64, most: f64) -> f64 {
    let knee = KNEE * most;
    if difference < knee {
        difference * KNEE_TO / knee
    } else {
        KNEE_TO + (difference - knee) / (most - knee) * (1.0 - KNEE_TO)
    }
}
