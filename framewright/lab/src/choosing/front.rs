//! The Pareto front: what nothing else beats in both senses at once.

/// The points that no other one beats, by their numbers, from the least first figure to the greatest. Less is better in both
/// senses. A point beats another if it is nowhere worse and somewhere better; so of equal points all are named.
#[must_use]
pub fn front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|at| points[*at].iter().all(|it| it.is_finite())).collect();
    let by = |a: f64, b: f64| a.partial_cmp(&b).unwrap_or(std::cmp::Ordering::Equal);
    order.sort_by(|&a, &b| by(points[a][0], points[b][0]).then(by(points[a][1], points[b][1])).then(a.cmp(&b)));
    let mut best: Option<[f64; 2]> = None;
    order.retain(|at| {
        let point = points[*at];
        let stays = best.is_none_or(|best| point[1] < best[1] || point == best);
        if stays {
            best = Some(point);
        }
        stays
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every point beside every other.
    fn exhaustive(points: &[[f64; 2]]) -> Vec<usize> {
        let beats = |a: [f64; 2], b: [f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
        let stays = |at: &usize| !points.iter().any(|other| beats(*other, points[*at]));
        (0..points.len()).filter(stays).collect()
    }

    #[test]
    fn the_front_is_what_an_exhaustive_search_finds() {
        let mut state = 1_u64;
        // Few different figures, so that many are equal.
        let mut next = |most: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % most
        };
        for _ in 0..2000 {
            let (count, most) = (next(12), 1 + next(9));
            let points: Vec<[f64; 2]> =
                (0..count).map(|_| [next(most) as f64 / 4.0, next(most) as f64 / 4.0]).collect();
            let found = front(&points);
            assert!(found.windows(2).all(|pair| points[pair[0]][0] <= points[pair[1]][0]), "{points:?} {found:?}");
            let mut sorted = found.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, exhaustive(&points), "{points:?}");
        }
    }

    #[test]
    fn figures_that_are_not_finite_are_no_part_of_it() {
        assert_eq!(front(&[[1.0, f64::NAN], [2.0, 1.0], [f64::INFINITY, 0.0]]), [1]);
        assert_eq!(front(&[[0.0, 1.0], [-0.0, 1.0], [-0.0, 2.0]]), [0, 1]);
    }
}
