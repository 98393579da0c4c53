//! The best settings under a budget, of those that were measured.

use super::naming::Group;
use super::results::{Outcome, Results, Row};
use crate::metric::Metric;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// A thing that is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// Milliseconds on the device.
    Milliseconds,
    /// The time on the device relative to the baseline's.
    Ratio,
    /// MiB of transient memory.
    Mebibytes,
    /// MiB that loads, stores, resolves and copies move.
    MovedMebibytes,
    /// The mean flicker over frames of the moving scene.
    Flicker,
    /// An error beside the reference.
    Error(Metric),
}

/// A limit that the user states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limit {
    pub(crate) quantity: Quantity,
    pub(crate) value: f64,
}

/// Settings that can be chosen, with their worst figures over all groups in which they were measured.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Candidate {
    /// All settings of the pipeline, by name.
    pub(crate) settings: BTreeMap<String, String>,
    pub(crate) milliseconds: f64,
    /// The time relative to the baseline's.
    pub(crate) ratio: f64,
    pub(crate) transient_bytes: u64,
    pub(crate) moved_bytes: u64,
    /// `None`: it wasn't measured.
    pub(crate) flicker: Option<f64>,
    /// In the order of [`Metric::ALL`].
    errors: [f64; Metric::ALL.len()],
    /// Where they were measured.
    pub(crate) groups: BTreeSet<Group>,
}

/// Settings that can't be chosen: how many there are, for which reason.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct LeftOut {
    /// A row of theirs failed.
    pub(crate) failed: usize,
    /// A row of theirs has pixels that aren't finite.
    pub(crate) non_finite: usize,
    /// A row of theirs has no reference.
    pub(crate) without_errors: usize,
}

/// What can be chosen from.
#[derive(Debug, Default)]
pub(crate) struct Candidates {
    pub(crate) all: Vec<Candidate>,
    pub(crate) left_out: LeftOut,
}

/// The answer.
#[derive(Debug)]
pub(crate) enum Chosen<'a> {
    /// Settings hold all limits.
    Best {
        best: &'a Candidate,
        /// For each limit, the settings that would be chosen without it, if they are better: then it binds.
        without: Vec<Option<&'a Candidate>>,
        /// Of the better settings those that miss the limits by least.
        next: Option<&'a Candidate>,
    },
    /// None does; these miss by least.
    Nearest(Option<&'a Candidate>),
}

impl Quantity {
    /// The option that limits it.
    #[must_use]
    pub(crate) fn option(self) -> &'static str {
        match self {
            Quantity::Milliseconds => "--max-ms",
            Quantity::Ratio => "--max-ratio",
            Quantity::Mebibytes => "--max-mib",
            Quantity::MovedMebibytes => "--max-moved-mib",
            Quantity::Flicker => "--max-flicker",
            Quantity::Error(Metric::Flip) => "--max-flip",
            Quantity::Error(Metric::Rmse) => "--max-rmse",
            Quantity::Error(Metric::MaxError) => "--max-error",
            Quantity::Error(Metric::RelativeMse) => "--max-relative-mse",
            Quantity::Error(Metric::Psnr) => "--min-psnr",
            Quantity::Error(Metric::Ssim) => "--min-ssim",
        }
    }

    fn is_cost(self) -> bool {
        !matches!(self, Quantity::Error(_) | Quantity::Flicker)
    }
}

impl Limit {
    /// How far settings are beyond the limit, as a part of it; of a limit of 0 the distance itself. 0 or below: they hold it.
    #[must_use]
    pub(crate) fn overshoot(&self, candidate: &Candidate) -> f64 {
        let figure = candidate.of(self.quantity);
        let beyond = match self.quantity {
            Quantity::Error(metric) if metric.is_likeness() => self.value - figure,
            _ => figure - self.value,
        };
        if self.value == 0.0 { beyond } else { beyond / self.value.abs() }
    }
}

impl Candidate {
    fn new(row: &Row) -> Candidate {
        Candidate {
            settings: row.settings.clone(),
            milliseconds: 0.0,
            ratio: 0.0,
            transient_bytes: 0,
            moved_bytes: 0,
            flicker: None,
            errors: Metric::ALL.map(|metric| if metric.is_likeness() { f64::INFINITY } else { 0.0 }),
            groups: BTreeSet::new(),
        }
    }

    /// A figure: the worst of all groups.
    #[must_use]
    pub(crate) fn of(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Milliseconds => self.milliseconds,
            Quantity::Ratio => self.ratio,
            Quantity::Mebibytes => mebibytes(self.transient_bytes),
            Quantity::MovedMebibytes => mebibytes(self.moved_bytes),
            Quantity::Flicker => self.flicker.unwrap_or(f64::INFINITY),
            Quantity::Error(metric) => {
                let at = Metric::ALL.iter().position(|one| *one == metric);
                at.map_or(f64::NAN, |at| self.errors[at])
            }
        }
    }

    /// The order of preference, the best first. With a limit of cost error decides, else time.
    fn compare(&self, other: &Candidate, by_error: bool) -> Ordering {
        let (error, time, memory) = (Quantity::Error(Metric::Flip), Quantity::Milliseconds, Quantity::Mebibytes);
        let order = if by_error { [error, time, memory] } else { [time, memory, error] };
        let figures = |candidate: &Candidate| order.map(|quantity| candidate.of(quantity));
        figures(self).partial_cmp(&figures(other)).unwrap_or(Ordering::Equal)
    }
}

impl Candidates {
    /// Those of results.
    #[must_use]
    pub(crate) fn of(results: &Results) -> Candidates {
        let mut rows: BTreeMap<&BTreeMap<String, String>, Vec<&Row>> = BTreeMap::new();
        for row in &results.rows {
            rows.entry(&row.settings).or_default().push(row);
        }
        let mut candidates = Candidates::default();
        for rows in rows.into_values() {
            candidates.put(&rows);
        }
        candidates
    }

    /// Adds the settings of some rows, if none of them forbids it.
    fn put(&mut self, rows: &[&Row]) {
        let Some(first) = rows.first() else { return };
        let mut candidate = Candidate::new(first);
        for row in rows {
            let Outcome::Measured(measured) = &row.outcome else {
                self.left_out.failed += 1;
                return;
            };
            let Some(errors) = &measured.errors else {
                self.left_out.without_errors += 1;
                return;
            };
            let flicker = measured.flicker.as_ref();
            if errors.non_finite != [0, 0] || flicker.is_some_and(|flicker| flicker.non_finite > 0) {
                self.left_out.non_finite += 1;
                return;
            }
            let cost = &measured.cost;
            candidate.milliseconds = candidate.milliseconds.max(cost.gpu_milliseconds.median);
            candidate.ratio = candidate.ratio.max(cost.gpu_ratio.median);
            candidate.transient_bytes = candidate.transient_bytes.max(cost.transient_bytes);
            candidate.moved_bytes = candidate.moved_bytes.max(cost.moved_bytes);
            candidate.flicker = candidate.flicker.into_iter().chain(flicker.map(|it| it.mean)).reduce(f64::max);
            for (worst, metric) in candidate.errors.iter_mut().zip(Metric::ALL) {
                let figure = errors.of(metric);
                *worst = if metric.is_likeness() { worst.min(figure) } else { worst.max(figure) };
            }
            candidate.groups.insert(row.group());
        }
        self.all.push(candidate);
    }

    /// Chooses: with a limit of cost the least error, of equal ones the fastest, then the smallest; with limits of error alone
    /// the fastest, of equal ones the smallest, then the one of least error.
    #[must_use]
    pub(crate) fn choose(&self, limits: &[Limit]) -> Chosen<'_> {
        let by_error = limits.iter().any(|limit| limit.quantity.is_cost());
        let all: Vec<&Limit> = limits.iter().collect();
        let Some(best) = self.best(&all, by_error) else {
            return Chosen::Nearest(nearest(self.all.iter(), limits, by_error));
        };
        let is_better = |candidate: &&Candidate| candidate.compare(best, by_error).is_lt();
        let without = |left_out: usize| {
            let others: Vec<&Limit> =
                limits.iter().enumerate().filter(|(at, _)| *at != left_out).map(|it| it.1).collect();
            self.best(&others, by_error).filter(is_better)
        };
        Chosen::Best {
            best,
            without: (0..limits.len()).map(without).collect(),
            next: nearest(self.all.iter().filter(is_better), limits, by_error),
        }
    }

    /// The best that holds some limits. Settings of equal figures keep the order of their values.
    fn best(&self, limits: &[&Limit], by_error: bool) -> Option<&Candidate> {
        let fits = |candidate: &&Candidate| limits.iter().all(|limit| limit.overshoot(candidate) <= 0.0);
        self.all.iter().filter(fits).min_by(|a, b| a.compare(b, by_error))
    }
}

#[allow(clippy::cast_precision_loss, reason = "beyond 2^53 bytes nobody counts single ones")]
fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// The candidate whose largest overshoot is least, of equal ones the best.
fn nearest<'a>(among: impl Iterator<Item = &'a Candidate>, limits: &[Limit], by_error: bool) -> Option<&'a Candidate> {
    let largest =
        |candidate: &Candidate| limits.iter().map(|limit| limit.overshoot(candidate)).fold(f64::NEG_INFINITY, f64::max);
    among.min_by(|a, b| {
        let overshoots = largest(a).partial_cmp(&largest(b)).unwrap_or(Ordering::Equal);
        overshoots.then_with(|| a.compare(b, by_error))
    })
}
