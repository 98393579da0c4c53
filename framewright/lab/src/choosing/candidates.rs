//! The settings that can be chosen from, with their worst figures.

use super::limits::Quantity;
use crate::metric::Metric;
use crate::results::{Group, Outcome, Results, Row, RowFigures, Spread};
use crate::sweep::{SCENE, SIZE, STEREO, size_name};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// Settings that can be chosen, with their worst figures over all groups.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// All settings of the pipeline, by name.
    pub settings: BTreeMap<String, String>,
    /// `None`: the device doesn't tell times.
    pub milliseconds: Option<f64>,
    /// The time relative to that of the baseline's settings in the same group, where its median is largest; `None` as above.
    pub ratio: Option<Spread>,
    /// The rank of its time: equal for settings whose times can't be told apart.
    speed: usize,
    /// The rank of its FLIP: equal for settings whose difference is no more than their references' own error.
    error: usize,
    /// The own FLIP of the reference beside which its FLIP is worst.
    doubt: f64,
    /// Bytes of transient memory.
    pub transient_bytes: u64,
    /// Bytes that loads, stores, resolves and copies move.
    pub moved_bytes: u64,
    /// `None`: it wasn't measured.
    pub flicker: Option<f64>,
    /// In the order of [`Metric::ALL`].
    errors: [f64; Metric::ALL.len()],
}

/// The reason for which settings can't be chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
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
    pub const ALL: [Reason; 4] = [Reason::Failed, Reason::NonFinite, Reason::WithoutErrors, Reason::NotEverywhere];
}

/// What can be chosen from.
#[derive(Debug, Default)]
pub struct Candidates {
    /// The settings.
    pub all: Vec<Candidate>,
    /// The groups whose worst figures count: all candidates were measured in each.
    pub groups: BTreeSet<Group>,
    /// The groups in which no settings can be chosen. They don't count.
    pub left_out_groups: BTreeSet<Group>,
    /// The time of the baseline's settings in each group, relative to that of the baseline itself.
    baselines: BTreeMap<Group, f64>,
    /// How many settings are left out for which reason.
    pub left_out: BTreeMap<Reason, usize>,
}

/// A row's figures, if settings can be chosen by them.
fn usable(row: &Row) -> Result<&RowFigures, Reason> {
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
    pub fn of(results: &Results) -> Candidates {
        let groups: BTreeSet<Group> = results.rows.iter().filter(|row| usable(row).is_ok()).map(Row::group).collect();
        let left_out_groups = results.rows.iter().map(Row::group).filter(|group| !groups.contains(group)).collect();
        let baselines = baselines(results);
        let mut candidates = Candidates { groups, left_out_groups, baselines, ..Candidates::default() };
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
        let ties = |first: &Candidate, other: &Candidate| match (first.ratio, other.ratio) {
            (Some(first), Some(other)) => other.ties(&first),
            (first, other) => first.is_none() && other.is_none(),
        };
        rank(&mut candidates.all, Quantity::Ratio, ties, |candidate, rank| candidate.speed = rank);
        let flip = Quantity::Error(Metric::Flip);
        let ties =
            |first: &Candidate, other: &Candidate| other.of(flip) - first.of(flip) <= first.doubt.max(other.doubt);
        rank(&mut candidates.all, flip, ties, |candidate, rank| candidate.error = rank);
        candidates
    }

    /// A group that counts, and in which the baseline's settings weren't measured: its ratios are those to another group's time.
    #[must_use]
    pub fn without_baseline(&self) -> Option<&Group> {
        self.groups.iter().find(|group| !self.baselines.contains_key(group))
    }

    /// The worst figures of some settings' rows.
    fn candidate(&self, rows: &[&Row]) -> Result<Candidate, Reason> {
        let (counting, others): (Vec<&Row>, Vec<&Row>) =
            rows.iter().copied().partition(|row| self.groups.contains(&row.group()));
        let measured = counting.iter().map(|row| usable(row)).collect::<Result<Vec<&RowFigures>, Reason>>()?;
        if counting.is_empty()
            && let Some(row) = others.first()
        {
            usable(row)?;
        }
        let covered: BTreeSet<Group> = counting.iter().map(|row| row.group()).collect();
        if covered != self.groups {
            return Err(Reason::NotEverywhere);
        }
        let baseline = |row: &&Row| self.baselines.get(&row.group()).copied().unwrap_or(1.0);
        let rows: Vec<(&RowFigures, f64)> = measured.into_iter().zip(counting.iter().map(baseline)).collect();
        Ok(Candidate::of_rows(counting.first().map(|row| row.settings.clone()).unwrap_or_default(), &rows))
    }
}

/// The ratio of the baseline's settings in each group in which they were measured. Where the baseline itself was drawn it is 1:
/// ratios are those of frames in the same turn there.
fn baselines(results: &Results) -> BTreeMap<Group, f64> {
    let (surroundings, settings): (BTreeMap<&str, &str>, BTreeMap<&str, &str>) = {
        let all = results.subject.baseline.iter().map(|(name, value)| (&**name, &**value));
        all.partition(|(name, _)| name.starts_with('@'))
    };
    let is_baseline = |row: &Row| {
        let settings_of = row.settings.iter().map(|(name, value)| (&**name, &**value));
        settings_of.eq(settings.iter().map(|(name, value)| (*name, *value)))
    };
    let is_own = |row: &Row| {
        let size = size_name(row.size);
        let of_row = [(SCENE, &row.scene_digest), (SIZE, &size), (STEREO, &row.stereo)];
        of_row.into_iter().all(|(name, value)| surroundings.get(name).is_some_and(|it| *it == value.as_str()))
    };
    let ratio = |row: &Row| match &row.outcome {
        _ if is_own(row) => Some((row.group(), 1.0)),
        Outcome::Measured(measured) if is_baseline(row) => {
            Some((row.group(), measured.cost.gpu_ratio.map_or(1.0, |ratio| ratio.median)))
        }
        _ => None,
    };
    results.rows.iter().filter_map(ratio).filter(|(_, ratio)| *ratio > 0.0).collect()
}

impl Candidate {
    /// Rows with the time of the baseline's settings in their groups.
    fn of_rows(settings: BTreeMap<String, String>, rows: &[(&RowFigures, f64)]) -> Candidate {
        let most = |figure: fn(&RowFigures) -> u64| rows.iter().map(|(row, _)| figure(row)).max().unwrap_or(0);
        // Times that are missing in one row are missing.
        let times: Option<Vec<Spread>> = rows.iter().map(|(row, _)| row.cost.gpu_milliseconds).collect();
        let ratios: Option<Vec<Spread>> =
            rows.iter().map(|(row, baseline)| Some(row.cost.gpu_ratio?.relative_to(*baseline))).collect();
        let slowest = |spreads: Vec<Spread>| spreads.into_iter().max_by(|a, b| a.median.total_cmp(&b.median));
        let worst = |metric: Metric| {
            let figures = rows.iter().filter_map(|(row, _)| Some(row.errors.as_ref()?.of(metric)));
            let worst = if metric.is_likeness() { f64::min } else { f64::max };
            figures.reduce(worst).unwrap_or(f64::NAN)
        };
        let flip = |row: &RowFigures| row.errors.as_ref().map_or(f64::NAN, |errors| errors.flip.mean);
        let worst_row = rows.iter().map(|(row, _)| row).max_by(|a, b| flip(a).total_cmp(&flip(b)));
        let own = worst_row.and_then(|row| row.reference_errors.as_ref());
        Candidate {
            settings,
            milliseconds: times.and_then(slowest).map(|time| time.median),
            ratio: ratios.and_then(slowest),
            speed: 0,
            error: 0,
            doubt: own.map_or(0.0, |own| own.flip.mean),
            transient_bytes: most(|row| row.cost.transient_bytes),
            moved_bytes: most(|row| row.cost.moved_bytes),
            flicker: rows.iter().filter_map(|(row, _)| Some(row.flicker.as_ref()?.mean)).reduce(f64::max),
            errors: Metric::ALL.map(worst),
        }
    }

    /// A figure: the worst of all groups. One that wasn't measured holds no limit.
    #[must_use]
    pub fn of(&self, quantity: Quantity) -> f64 {
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
    /// settings that are equal in all of them those with the smaller ratio are better, then those with the smaller FLIP.
    pub(super) fn compare(&self, other: &Candidate, by_error: bool) -> Ordering {
        let [memory, ratio, flip] = [Quantity::Mebibytes, Quantity::Ratio, Quantity::Error(Metric::Flip)]
            .map(|quantity| self.of(quantity).partial_cmp(&other.of(quantity)).unwrap_or(Ordering::Equal));
        let (speed, error) = (self.speed.cmp(&other.speed), self.error.cmp(&other.error));
        let first = if by_error { error.then(speed) } else { speed.then(error) };
        first.then(memory).then(ratio).then(flip)
    }
}

/// Ranks by a figure: equal for settings that tie with those of the least figure of the rank.
fn rank(
    candidates: &mut [Candidate],
    quantity: Quantity,
    ties: impl Fn(&Candidate, &Candidate) -> bool,
    set: impl Fn(&mut Candidate, usize),
) {
    let mut order: Vec<&mut Candidate> = candidates.iter_mut().collect();
    order.sort_by(|a, b| a.of(quantity).total_cmp(&b.of(quantity)));
    let (mut rank, mut first) = (0, order.first().map(|first| (*first).clone()));
    for candidate in order {
        if first.as_ref().is_some_and(|first| !ties(first, candidate)) {
            (rank, first) = (rank + 1, Some(candidate.clone()));
        }
        set(candidate, rank);
    }
}

#[allow(clippy::cast_precision_loss, reason = "beyond 2^53 bytes nobody counts single ones")]
fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}
