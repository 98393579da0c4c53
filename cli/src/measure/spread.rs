//! Figures of many frames.

use super::results::Spread;

/// Median and quartiles; all 0 of no figures.
#[must_use]
pub(crate) fn spread(mut figures: Vec<f64>) -> Spread {
    figures.sort_unstable_by(f64::total_cmp);
    // Between the two figures that are nearest to the share.
    let at = |share: f64| {
        let place = share * figures.len().saturating_sub(1) as f64;
        let (below, above) = (place.floor() as usize, place.ceil() as usize);
        match (figures.get(below), figures.get(above)) {
            (Some(below), Some(above)) => below + (above - below) * place.fract(),
            _ => 0.0,
        }
    };
    Spread { median: at(0.5), low: at(0.25), high: at(0.75) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_lies_between_the_nearest_figures() {
        let Spread { median, low, high } = spread(vec![4.0, 1.0, 3.0, 2.0]);
        assert_eq!([low, median, high], [1.75, 2.5, 3.25]);
        assert_eq!(spread(vec![7.0]), Spread { median: 7.0, low: 7.0, high: 7.0 });
        assert_eq!(spread(Vec::new()), Spread { median: 0.0, low: 0.0, high: 0.0 });
    }
}
