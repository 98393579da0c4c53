//! The answer, in words and as JSON.

use crate::measure::choosing::{Candidate, Candidates, Chosen, LeftOut, Limit, Quantity};
use crate::measure::results::Results;
use crate::metric::Metric;
use crate::system::text;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The answer to a budget.
pub(super) struct Answer<'a> {
    pub(super) results: &'a Results,
    pub(super) candidates: &'a Candidates,
    pub(super) limits: &'a [Limit],
    pub(super) chosen: &'a Chosen<'a>,
}

#[derive(Debug, Serialize)]
pub(super) struct Json<'a> {
    format_version: u32,
    pipeline: &'a str,
    device: &'a str,
    /// The settings that hold all limits.
    chosen: Option<Entry<'a>>,
    /// The better settings that miss the limits by least.
    next_better: Option<Entry<'a>>,
    /// If none are chosen: the settings that miss the limits by least.
    nearest_miss: Option<Entry<'a>>,
    limits: Vec<StatedLimit<'a>>,
    left_out: BTreeMap<&'static str, usize>,
}

#[derive(Debug, Serialize)]
struct StatedLimit<'a> {
    option: &'static str,
    limit: f64,
    /// The settings that would be chosen without this limit, if they are better: then it binds.
    without: Option<Entry<'a>>,
}

#[derive(Debug, Serialize)]
struct Entry<'a> {
    settings: &'a BTreeMap<String, String>,
    gpu_milliseconds: f64,
    gpu_ratio: f64,
    transient_bytes: u64,
    moved_bytes: u64,
    /// The mean; `null`: it wasn't measured.
    flicker: Option<f64>,
    /// By metric; `null`: no difference.
    errors: BTreeMap<&'static str, f64>,
    /// Where they were measured. Figures are the worst of all.
    groups: Vec<String>,
    /// By option, for each limit that is missed: by what part of it; of a limit of 0 the distance itself.
    overshoot: BTreeMap<&'static str, f64>,
}

impl Answer<'_> {
    /// The answer for programs.
    pub(super) fn json(&self) -> Json<'_> {
        let (best, without, next, nearest) = match self.chosen {
            Chosen::Best { best, without, next } => (Some(*best), &without[..], *next, None),
            Chosen::Nearest(nearest) => (None, &[][..], None, *nearest),
        };
        let limits = self.limits.iter().enumerate().map(|(at, limit)| StatedLimit {
            option: limit.quantity.option(),
            limit: limit.value,
            without: without.get(at).copied().flatten().map(|it| self.entry(it)),
        });
        Json {
            format_version: 1,
            pipeline: &self.results.subject.pipeline,
            device: &self.results.subject.device,
            chosen: best.map(|it| self.entry(it)),
            next_better: next.map(|it| self.entry(it)),
            nearest_miss: nearest.map(|it| self.entry(it)),
            limits: limits.collect(),
            left_out: reasons(self.candidates.left_out).map(|(name, _, count)| (name, count)).collect(),
        }
    }

    fn entry<'a>(&self, candidate: &'a Candidate) -> Entry<'a> {
        let missed = self.limits.iter().map(|limit| (limit.quantity.option(), limit.overshoot(candidate)));
        Entry {
            settings: &candidate.settings,
            gpu_milliseconds: candidate.milliseconds,
            gpu_ratio: candidate.ratio,
            transient_bytes: candidate.transient_bytes,
            moved_bytes: candidate.moved_bytes,
            flicker: candidate.flicker,
            errors: Metric::ALL.map(|metric| (metric.name(), candidate.of(Quantity::Error(metric)))).into(),
            groups: candidate.groups.iter().map(|group| group.name()).collect(),
            overshoot: missed.filter(|(_, overshoot)| *overshoot > 0.0).collect(),
        }
    }

    /// The answer for people. `written` is the settings file, which is written if settings are chosen.
    pub(super) fn words(&self, written: Option<&Path>) -> String {
        let mut lines = match self.chosen {
            Chosen::Best { best, without, next } => {
                let mut lines = self.described("best", best);
                lines.extend(self.limits.iter().zip(without).map(|(limit, without)| self.limit(limit, best, *without)));
                lines.push(match next {
                    Some(next) => format!("next better: {}; {}", self.in_short(next), self.missed(next)),
                    None => "nothing better was measured".to_owned(),
                });
                lines.extend(written.map(|file| format!("written to {}", text::path(file))));
                lines
            }
            Chosen::Nearest(None) => vec!["nothing that was measured can be chosen".to_owned()],
            Chosen::Nearest(Some(nearest)) => {
                let mut lines = vec!["nothing that was measured holds all limits".to_owned()];
                lines.extend(self.described("nearest miss", nearest));
                lines.push(format!("  {}", self.missed(nearest)));
                lines
            }
        };
        let left_out = reasons(self.candidates.left_out).filter(|(_, _, count)| *count > 0);
        lines.extend(left_out.map(|(_, why, count)| format!("left out: {count} {why}")));
        lines.join("\n") + "\n"
    }

    /// Settings with all their figures.
    fn described(&self, what: &str, candidate: &Candidate) -> Vec<String> {
        let errors =
            Metric::ALL.map(|metric| (metric.name(), Quantity::Error(metric), candidate.of(Quantity::Error(metric))));
        let flicker = candidate.flicker.map(|flicker| ("flicker", Quantity::Flicker, flicker));
        let errors = errors
            .into_iter()
            .chain(flicker)
            .map(|(name, quantity, value)| format!("{name} {}", figure(quantity, value)));
        let (moved, groups) = (text::bytes(candidate.moved_bytes), self.groups(candidate));
        vec![
            format!("{what}: {}", text::escape(&self.results.shown(&candidate.settings))),
            format!("  {}, {moved} moved, {:.3} × the baseline's time", self.cost(candidate), candidate.ratio),
            format!("  {}", errors.collect::<Vec<_>>().join(", ")),
            format!("  {groups}"),
        ]
    }

    /// Where settings were measured, and where others were.
    fn groups(&self, candidate: &Candidate) -> String {
        let all: std::collections::BTreeSet<_> = self.results.rows.iter().map(|row| row.group()).collect();
        let names: Vec<String> = candidate.groups.iter().map(|group| text::escape(&group.name())).collect();
        let worst = if names.len() > 1 { "the worst figures of " } else { "measured with " };
        let missing = match all.len() - candidate.groups.len() {
            0 => String::new(),
            missing => format!("; not measured with {missing} of {}", all.len()),
        };
        format!("{worst}{}{missing}", names.join("; "))
    }

    fn cost(&self, candidate: &Candidate) -> String {
        let memory = text::bytes(candidate.transient_bytes);
        format!("{}, {memory} transient", figure(Quantity::Milliseconds, candidate.milliseconds))
    }

    fn in_short(&self, candidate: &Candidate) -> String {
        let flip = figure(Quantity::Error(Metric::Flip), candidate.of(Quantity::Error(Metric::Flip)));
        format!("{}: {}, flip {flip}", text::escape(&self.results.shown(&candidate.settings)), self.cost(candidate))
    }

    /// A limit, and whether it binds.
    fn limit(&self, limit: &Limit, best: &Candidate, without: Option<&Candidate>) -> String {
        let shown = figure(limit.quantity, best.of(limit.quantity));
        let binds = match without {
            Some(better) => format!("binds: without it {}", self.in_short(better)),
            None => "doesn't bind".to_owned(),
        };
        format!("{} {}: {shown}; {binds}", limit.quantity.option(), limit.value)
    }

    /// The limits that settings miss, and by how much.
    fn missed(&self, candidate: &Candidate) -> String {
        let missed = self.limits.iter().filter_map(|limit| {
            let overshoot = limit.overshoot(candidate);
            let (option, value) = (limit.quantity.option(), limit.value);
            let by = if value == 0.0 { format!("{overshoot:.4}") } else { format!("{:.1} %", 100.0 * overshoot) };
            let shown = figure(limit.quantity, candidate.of(limit.quantity));
            (overshoot > 0.0).then(|| format!("misses {option} {value} by {by} ({shown})"))
        });
        missed.collect::<Vec<_>>().join(", ")
    }
}

/// The reasons for which settings are left out, and how many are.
fn reasons(left_out: LeftOut) -> impl Iterator<Item = (&'static str, &'static str, usize)> {
    let LeftOut { failed, non_finite, without_errors } = left_out;
    [
        ("failed", "that can't be drawn", failed),
        ("non_finite", "with pixels that aren't finite", non_finite),
        ("without_errors", "without a reference", without_errors),
    ]
    .into_iter()
}

/// A figure with its unit.
fn figure(quantity: Quantity, value: f64) -> String {
    match quantity {
        Quantity::Milliseconds => format!("{value:.3} ms"),
        Quantity::Ratio => format!("{value:.3} × the baseline's time"),
        Quantity::Mebibytes | Quantity::MovedMebibytes => format!("{value:.1} MiB"),
        Quantity::Error(Metric::Psnr) if value.is_infinite() => "no difference".to_owned(),
        Quantity::Error(Metric::Psnr) => format!("{value:.2} dB"),
        Quantity::Error(_) | Quantity::Flicker if value == 0.0 || (1e-4..1e6).contains(&value.abs()) => {
            format!("{value:.5}")
        }
        Quantity::Error(_) | Quantity::Flicker => format!("{value:.3e}"),
    }
}
