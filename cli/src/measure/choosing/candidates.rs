//! The settings that can be chosen from, with their worst figures.

use super::limits::Quantity;
use crate::measure::naming::Group;
use crate::measure::results::{Measured, Outcome, Results, Row, Spread};
use crate::metric::Metric;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// Settings that can be chosen, with their worst figures over all groups.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Candidate {
    /// All settings of the pipeline, by name.
    pub(crate) settings: BTreeMap<String, String>,
    /// `None`: the device doesn't tell times.
    pub(crate) milliseconds: Option<f64>,
    /// The time relative to the baseline's, in the group where its median is largest; `None` as above.
    pub(crate) ratio: Option<Spread>,
    /// The rank of its time: equal for settings whose times can't be told apart.
    speed: usize,
    pub(crate) transient_bytes: u64,
    pub(crate) moved_bytes: u64,
    /// `None`: it wasn't measured.
    pub(crate) flicker: Option<f64>,
    /// In the order of [`Metric::ALL`].
    errors: [f64; Metric::ALL.len()],
}

/// The reason for which settings can't be chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Reason {
    /// A row of theirs failed.
    Failed,
    /// A row of theirs has pixels that aren't finite.
    NonFinite,
    /// A row of theirs has no reference.
    WithoutErrors,
    /// They weren't measured in a group in which others were.
    NotEverywhere,
}

impl Reason {
    /// All, in the order in which they are told.
    pub(crate) const ALL: [Reason; 4] =
        [Reason::Failed, Reason::NonFinite, Reason::WithoutErrors, Reason::NotEverywhere];
}

/// What can be chosen from.
#[derive(Debug, Default)]
pub(crate) struct Candidates {
    pub(crate) all: Vec<Candidate>,
    /// The groups whose worst figures count: all candidates were measured in each.
    pub(crate) groups: BTreeSet<Group>,
    /// The groups in which no settings can be chosen. They don't count.
    pub(crate) left_out_groups: BTreeSet<Group>,
    /// How many settings are left out for which reason.
    pub(crate) left_out: BTreeMap<Reason, usize>,
}

/// A row's figures, if settings can be chosen by them.
fn usable(row: &Row) -> Result<&Measured, Reason> {
    match &row.outcome {
        Outcome::Failed(_) => Err(Reason::Failed),
        Outcome::Measured(measured) if measured.errors.is_none() => Err(Reason::WithoutErrors),
        Outcome::Measured(measured) if !measured.is_finite() => Err(Reason::NonFinite),
        Outcome::Measured(measured) => Ok(measured),
    }
}

impl Candidates {
    /// Those of results.
    #[must_use]
    pub(crate) fn of(results: &Results) -> Candidates {
        let groups: BTreeSet<Group> = results.rows.iter().filter(|row| usable(row).is_ok()).map(Row::group).collect();
        let left_out_groups = results.rows.iter().map(Row::group).filter(|group| !groups.contains(group)).collect();
        let mut candidates = Candidates { groups, left_out_groups, ..Candidates::default() };
        let mut rows: BTreeMap<&BTreeMap<String, String>, Vec<&Row>> = BTreeMap::new();
        for row in &results.rows {
            rows.entry(&row.settings).or_default().push(row);
        }
        for rows in rows.into_values() {
            match candidates.candidate(&rows) {
                Ok(candidate) => candidates.all.push(candidate),
                Err(reason) => *candidates.left_out.entry(reason).or_default() += 1,
            }
        }
        rank(&mut candidates.all);
        candidates
    }

    /// The worst figures of some settings' rows.
    fn candidate(&self, rows: &[&Row]) -> Result<Candidate, Reason> {
        let (counting, others): (Vec<&Row>, Vec<&Row>) =
            rows.iter().copied().partition(|row| self.groups.contains(&row.group()));
        let measured = counting.iter().map(|row| usable(row)).collect::<Result<Vec<&Measured>, Reason>>()?;
        if counting.is_empty()
            && let Some(row) = others.first()
        {
            usable(row)?;
        }
        let covered: BTreeSet<Group> = counting.iter().map(|row| row.group()).collect();
        if covered != self.groups {
            return Err(Reason::NotEverywhere);
        }
        Ok(Candidate::of_rows(counting.first().map(|row| row.settings.clone()).unwrap_or_default(), &measured))
    }
}

impl Candidate {
    fn of_rows(settings: BTreeMap<String, String>, rows: &[&Measured]) -> Candidate {
        let most = |figure: fn(&Measured) -> u64| rows.iter().map(|row| figure(row)).max().unwrap_or(0);
        // Times that are missing in one row are missing.
        let times: Option<Vec<Spread>> = rows.iter().map(|row| row.cost.gpu_milliseconds).collect();
        let ratios: Option<Vec<Spread>> = rows.iter().map(|row| row.cost.gpu_ratio).collect();
        let slowest = |spreads: Vec<Spread>| spreads.into_iter().max_by(|a, b| a.median.total_cmp(&b.median));
        let worst = |metric: Metric| {
            let figures = rows.iter().filter_map(|row| Some(row.errors.as_ref()?.of(metric)));
            let worst = if metric.is_likeness() { f64::min } else { f64::max };
            figures.reduce(worst).unwrap_or(f64::NAN)
        };
        Candidate {
            settings,
            milliseconds: times.and_then(slowest).map(|time| time.median),
            ratio: ratios.and_then(slowest),
            speed: 0,
            transient_bytes: most(|row| row.cost.transient_bytes),
            moved_bytes: most(|row| row.cost.moved_bytes),
            flicker: rows.iter().filter_map(|row| Some(row.flicker.as_ref()?.mean)).reduce(f64::max),
            errors: Metric::ALL.map(worst),
        }
    }

    /// A figure: the worst of all groups. One that wasn't measured holds no limit.
    #[must_use]
    pub(crate) fn of(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Milliseconds => self.milliseconds.unwrap_or(f64::INFINITY),
            Quantity::Ratio => self.ratio.map_or(f64::INFINITY, |ratio| ratio.median),
            Quantity::Mebibytes => mebibytes(self.transient_bytes),
            Quantity::MovedMebibytes => mebibytes(self.moved_bytes),
            Quantity::Flicker => self.flicker.unwrap_or(f64::INFINITY),
            Quantity::Error(metric) => {
                let at = Metric::ALL.iter().position(|one| *one == metric);
                at.map_or(f64::NAN, |at| self.errors[at])
            }
        }
    }

    /// The order of preference, the best first: with `by_error` by error, speed and memory, else by speed, error and memory. Of
    /// settings that are equal in all of them the faster ones are better.
    pub(super) fn compare(&self, other: &Candidate, by_error: bool) -> Ordering {
        let [error, memory, ratio] = [Quantity::Error(Metric::Flip), Quantity::Mebibytes, Quantity::Ratio]
            .map(|quantity| self.of(quantity).partial_cmp(&other.of(quantity)).unwrap_or(Ordering::Equal));
        let speed = self.speed.cmp(&other.speed);
        let first = if by_error { error.then(speed) } else { speed.then(error) };
        first.then(memory).then(ratio)
    }
}

/// Gives equal ranks to settings whose times can't be told apart from those of the fastest of the rank.
fn rank(candidates: &mut [Candidate]) {
    let mut order: Vec<&mut Candidate> = candidates.iter_mut().collect();
    order.sort_by(|a, b| a.of(Quantity::Ratio).total_cmp(&b.of(Quantity::Ratio)));
    let (mut speed, mut fastest) = (0, order.first().and_then(|first| first.ratio));
    for candidate in order {
        let ties = match (candidate.ratio, fastest) {
            (Some(ratio), Some(fastest)) => ratio.ties(&fastest),
            (ratio, fastest) => ratio.is_none() && fastest.is_none(),
        };
        if !ties {
            (speed, fastest) = (speed + 1, candidate.ratio);
        }
        candidate.speed = speed;
    }
}

#[allow(clippy::cast_precision_loss, reason = "beyond 2^53 bytes nobody counts single ones")]
fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}
