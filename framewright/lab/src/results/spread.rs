//! Figures of many frames.

use super::Spread;
use crate::quantiles::quantile;

/// Median and quartiles; `None` of no figures.
#[must_use]
pub fn spread(mut figures: Vec<f64>) -> Option<Spread> {
    figures.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| quantile(&figures, share);
    Some(Spread { median: at(0.5)?, low: at(0.25)?, high: at(0.75)? })
}

impl Spread {
    /// The figures as parts of another one.
    #[must_use]
    pub fn relative_to(self, other: f64) -> Spread {
        Spread { median: self.median / other, low: self.low / other, high: self.high / other }
    }

    /// Whether two figures can't be told apart: each one's median lies among the middle half of the other's figures.
    #[must_use]
    pub fn ties(&self, other: &Spread) -> bool {
        let holds = |spread: &Spread, figure: f64| (spread.low..=spread.high).contains(&figure);
        holds(self, other.median) && holds(other, self.median)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_the_median_and_both_quartiles() {
        assert_eq!(spread(vec![4.0, 1.0, 3.0, 2.0]), Some(Spread { median: 2.5, low: 1.75, high: 3.25 }));
        assert_eq!(spread(vec![7.0]), Some(Spread { median: 7.0, low: 7.0, high: 7.0 }));
        assert_eq!(spread(Vec::new()), None);
    }

    #[test]
    fn figures_tie_if_each_median_lies_within_the_other_spread() {
        let of = |low: f64, median: f64, high: f64| Spread { median, low, high };
        let one = of(0.9, 1.0, 1.1);
        assert!(one.ties(&one) && one.ties(&of(1.0, 1.1, 1.2)) && of(1.0, 1.1, 1.2).ties(&one));
        // One that spreads widely doesn't tie with all that lie within.
        for other in [of(1.05, 1.06, 1.07), of(0.5, 1.2, 2.0), of(2.0, 2.1, 2.2)] {
            assert!(!one.ties(&other) && !other.ties(&one), "{other:?}");
        }
    }
}
