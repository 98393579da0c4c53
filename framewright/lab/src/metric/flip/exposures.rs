//! The exposures of HDR-FLIP, and the tone curve under which they are compared.

use super::color::luminance;
use serde::{Deserialize, Serialize};

/// The exposures under which two pictures are compared, in stops.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exposures {
    /// The brightest pixel of the reference is just below white.
    pub first: f64,
    /// Half of the reference is brighter than just below white.
    pub last: f64,
    /// How many are compared, both ends among them.
    pub count: u32,
}

/// Numerator and denominator of the tone curve by powers of light from the second down: K. Narkowicz's fit of ACES, its
/// pre-exposure of 0.6 taken back.
const CURVE: [[f64; 3]; 2] = [[0.36 * 2.51, 0.6 * 0.03, 0.0], [0.36 * 2.43, 0.6 * 0.59, 0.14]];
/// The shown value that counts as just below white.
const BELOW_WHITE: f64 = 0.85;

impl Exposures {
    /// Those for a reference: from the one that shows its brightest pixel to the one that shows its median. Where half of the
    /// reference is black it is the median of the other pixels.
    pub(in crate::metric) fn of(reference: &[[f64; 3]]) -> Exposures {
        let mut light: Vec<f64> = reference.iter().map(|texel| luminance(*texel)).collect();
        light.sort_unstable_by(f64::total_cmp);
        let lit = &light[light.partition_point(|light| *light <= 0.0)..];
        let middle = light.get(light.len() / 2).copied().filter(|light| *light > 0.0);
        let (Some(median), Some(most)) = (middle.or(lit.get(lit.len() / 2).copied()), lit.last()) else {
            return Exposures { first: 0.0, last: 0.0, count: 1 };
        };
        let stops = |light: f64| (light_below_white() / light).log2();
        let (first, last) = (stops(*most), stops(median));
        Exposures { first, last, count: (last - first).ceil().max(2.0) as u32 }
    }

    /// Each exposure in stops.
    pub(super) fn stops(self) -> impl Iterator<Item = f64> {
        let step = (self.last - self.first) / f64::from(self.count.max(2) - 1);
        (0..self.count).map(move |at| self.first + f64::from(at) * step)
    }
}

/// The light that the curve shows as [`BELOW_WHITE`].
fn light_below_white() -> f64 {
    let [a, b, c] = [0, 1, 2].map(|power| CURVE[0][power] - BELOW_WHITE * CURVE[1][power]);
    let half = -0.5 * b / a;
    half + (half * half - c / a).sqrt()
}

/// Light as it is shown under an exposure, from 0 to 1. Negative light is black.
pub(super) fn shown(texel: [f64; 3], stops: f64) -> [f64; 3] {
    texel.map(|light| {
        let light = light.max(0.0) * stops.exp2();
        let [above, below] = CURVE.map(|[a, b, c]| (a * light + b) * light + c);
        (above / below).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposures_reach_from_the_brightest_pixel_to_the_median() {
        let white = light_below_white();
        assert!((shown([white; 3], 0.0)[0] - BELOW_WHITE).abs() < 1e-12);
        let grey = |light: f64| [light; 3];
        let exposures = Exposures::of(&[grey(white), grey(white / 8.0), grey(white / 8.0)]);
        assert!(exposures.first.abs() < 1e-9 && (exposures.last - 3.0).abs() < 1e-9, "{exposures:?}");
        assert_eq!(exposures.stops().count(), exposures.count as usize);
    }

    #[test]
    fn black_references_have_exposures_too() {
        assert_eq!(Exposures::of(&[[0.0; 3]; 4]), Exposures { first: 0.0, last: 0.0, count: 1 });
        let mostly = Exposures::of(&[[0.0; 3], [0.0; 3], [0.0; 3], [1.0; 3]]);
        assert!(mostly.first.is_finite() && mostly.last.is_finite() && mostly.count == 2, "{mostly:?}");
        assert!(shown([-1.0, 1e38, f64::MIN_POSITIVE], 120.0).iter().all(|it| (0.0..=1.0).contains(it)));
    }
}
