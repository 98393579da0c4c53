//! The answer, in words and as JSON.

use crate::system::text;
use framewright_lab::choosing::{Binding, Candidate, Candidates, Limit, Quantity, Reason, SettingsAnswer};
use framewright_lab::metric::Metric;
use framewright_lab::results::{Group, Results, Spread};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The answer to a budget.
pub(super) struct Answer<'a> {
    pub(super) results: &'a Results,
    pub(super) candidates: &'a Candidates,
    pub(super) limits: &'a [Limit],
    pub(super) chosen: &'a SettingsAnswer<'a>,
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
    /// The limits that bind only together.
    binding_together: Vec<JointLimits<'a>>,
    /// The groups whose worst figures count.
    groups: Vec<String>,
    /// The groups in which no settings can be chosen, and which don't count.
    left_out_groups: Vec<String>,
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
struct JointLimits<'a> {
    options: Vec<&'static str>,
    /// The settings that would be chosen without these limits.
    without: Entry<'a>,
}

#[derive(Debug, Serialize)]
struct Entry<'a> {
    settings: &'a BTreeMap<String, String>,
    /// `null`: the device doesn't tell times.
    gpu_milliseconds: Option<f64>,
    gpu_ratio: Option<Spread>,
    transient_bytes: u64,
    moved_bytes: u64,
    /// The mean; `null`: it wasn't measured.
    flicker: Option<f64>,
    /// By metric; `null`: no difference.
    errors: BTreeMap<&'static str, f64>,
    /// By option, for each limit that is missed: by what part of it; of a limit of 0 the distance itself.
    overshoot: BTreeMap<&'static str, f64>,
}

impl Answer<'_> {
    /// The answer for programs.
    pub(super) fn json(&self) -> Json<'_> {
        let (best, binding, next, nearest) = match self.chosen {
            SettingsAnswer::Best { best, binding, next } => (Some(*best), &binding[..], *next, None),
            SettingsAnswer::Nearest(nearest) => (None, &[][..], None, *nearest),
        };
        let together = binding.iter().filter(|it| it.limits.len() > 1);
        let limits = self.limits.iter().enumerate().map(|(at, limit)| StatedLimit {
            option: option(limit.quantity),
            limit: limit.value,
            without: alone(binding, at).map(|it| self.entry(it.without)),
        });
        Json {
            format_version: 1,
            pipeline: &self.results.subject.pipeline,
            device: &self.results.subject.device,
            chosen: best.map(|it| self.entry(it)),
            next_better: next.map(|it| self.entry(it)),
            nearest_miss: nearest.map(|it| self.entry(it)),
            limits: limits.collect(),
            binding_together: together
                .map(|it| JointLimits { options: self.options(it), without: self.entry(it.without) })
                .collect(),
            groups: self.candidates.groups.iter().map(Group::name).collect(),
            left_out_groups: self.candidates.left_out_groups.iter().map(Group::name).collect(),
            left_out: self.reasons().map(|(reason, count)| (name(reason), count)).collect(),
        }
    }

    fn entry<'a>(&self, candidate: &'a Candidate) -> Entry<'a> {
        let missed = self.limits.iter().map(|limit| (option(limit.quantity), limit.overshoot(candidate)));
        Entry {
            settings: &candidate.settings,
            gpu_milliseconds: candidate.milliseconds,
            gpu_ratio: candidate.ratio,
            transient_bytes: candidate.transient_bytes,
            moved_bytes: candidate.moved_bytes,
            flicker: candidate.flicker,
            errors: Metric::ALL.map(|metric| (metric.name(), candidate.of(Quantity::Error(metric)))).into(),
            overshoot: missed.filter(|(_, overshoot)| *overshoot > 0.0).collect(),
        }
    }

    /// The answer for people. `written` is the settings file, which is written if settings are chosen.
    pub(super) fn words(&self, written: Option<&Path>) -> String {
        let mut lines = match self.chosen {
            SettingsAnswer::Best { best, binding, next } => {
                let mut lines = self.described("best", best);
                lines.extend((0..self.limits.len()).map(|at| self.limit(at, best, binding)));
                let together = binding.iter().filter(|it| it.limits.len() > 1);
                lines.extend(together.map(|it| self.together(it)));
                lines.push(match next {
                    Some(next) => format!("next better: {}; {}", self.in_short(next), self.missed(next)),
                    None => "nothing better was measured".to_owned(),
                });
                lines.extend(written.map(|file| format!("written to {}", text::path(file))));
                lines
            }
            SettingsAnswer::Nearest(None) => vec!["nothing that was measured can be chosen".to_owned()],
            SettingsAnswer::Nearest(Some(nearest)) => {
                let mut lines = vec!["nothing that was measured holds all limits".to_owned()];
                lines.extend(self.described("nearest miss", nearest));
                lines.push(format!("  {}", self.missed(nearest)));
                lines
            }
        };
        let left_out = self.reasons().filter(|(_, count)| *count > 0);
        lines.extend(left_out.map(|(reason, count)| format!("left out: {count} {}", why(reason))));
        let groups = self.candidates.left_out_groups.iter();
        lines.extend(groups.map(|group| {
            format!("left out: {}, where nothing that was measured can be chosen", text::escape(&group.name()))
        }));
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
        vec![
            format!("{what}: {}", text::escape(&self.results.shown(&candidate.settings))),
            format!("  {}, {} moved", self.cost(candidate), text::bytes(candidate.moved_bytes)),
            format!("  {}", errors.collect::<Vec<_>>().join(", ")),
            format!("  {}", self.groups()),
        ]
    }

    /// Where settings were measured.
    fn groups(&self) -> String {
        let names: Vec<String> = self.candidates.groups.iter().map(|group| text::escape(&group.name())).collect();
        let worst = if names.len() > 1 { "the worst figures of " } else { "measured with " };
        format!("{worst}{}", names.join("; "))
    }

    fn cost(&self, candidate: &Candidate) -> String {
        let memory = text::bytes(candidate.transient_bytes);
        let ratio = candidate.ratio.map_or_else(
            || "no times".to_owned(),
            |Spread { median, low, high }| format!("{median:.3} ({low:.3}–{high:.3}) × the baseline's time"),
        );
        let time = candidate.milliseconds.map(|time| format!(", {}", figure(Quantity::Milliseconds, time)));
        format!("{ratio}{}, {memory} transient", time.unwrap_or_default())
    }

    fn in_short(&self, candidate: &Candidate) -> String {
        let flip = figure(Quantity::Error(Metric::Flip), candidate.of(Quantity::Error(Metric::Flip)));
        format!("{}: {}, flip {flip}", text::escape(&self.results.shown(&candidate.settings)), self.cost(candidate))
    }

    /// A limit, and whether it binds.
    fn limit(&self, at: usize, best: &Candidate, binding: &[Binding<'_>]) -> String {
        let limit = &self.limits[at];
        let shown = figure(limit.quantity, best.of(limit.quantity));
        let binds = match (alone(binding, at), binding.iter().any(|it| it.limits.contains(&at))) {
            (Some(alone), _) => format!("binds: without it {}", self.in_short(alone.without)),
            (None, true) => "binds together with others".to_owned(),
            (None, false) => "doesn't bind".to_owned(),
        };
        format!("{} {}: {shown}; {binds}", option(limit.quantity), limit.value)
    }

    /// Limits that bind only together.
    fn together(&self, binding: &Binding<'_>) -> String {
        format!(
            "{} bind together: without them {}",
            self.options(binding).join(" and "),
            self.in_short(binding.without)
        )
    }

    fn options(&self, binding: &Binding<'_>) -> Vec<&'static str> {
        binding.limits.iter().map(|at| option(self.limits[*at].quantity)).collect()
    }

    /// How many settings are left out for each reason.
    fn reasons(&self) -> impl Iterator<Item = (Reason, usize)> + '_ {
        Reason::ALL.into_iter().map(|reason| (reason, self.candidates.left_out.get(&reason).copied().unwrap_or(0)))
    }

    /// The limits that settings miss, and by how much.
    fn missed(&self, candidate: &Candidate) -> String {
        let missed = self.limits.iter().filter_map(|limit| {
            let overshoot = limit.overshoot(candidate);
            let (option, value) = (option(limit.quantity), limit.value);
            let by = match value {
                _ if overshoot.is_infinite() => String::new(),
                0.0 => format!(" by {overshoot:.4}"),
                _ => format!(" by {:.1} %", 100.0 * overshoot),
            };
            let shown = figure(limit.quantity, candidate.of(limit.quantity));
            (overshoot > 0.0).then(|| format!("misses {option} {value}{by} ({shown})"))
        });
        missed.collect::<Vec<_>>().join(", ")
    }
}

/// What a limit by itself excludes.
fn alone<'b, 'a>(binding: &'b [Binding<'a>], at: usize) -> Option<&'b Binding<'a>> {
    binding.iter().find(|it| it.limits == [at])
}

/// A reason's name for programs.
fn name(reason: Reason) -> &'static str {
    match reason {
        Reason::Failed => "failed",
        Reason::NonFinite => "non_finite",
        Reason::WithoutErrors => "without_errors",
        Reason::NotEverywhere => "not_everywhere",
    }
}

/// A reason for people.
fn why(reason: Reason) -> &'static str {
    match reason {
        Reason::Failed => "that can't be drawn",
        Reason::NonFinite => "with pixels that aren't finite",
        Reason::WithoutErrors => "without a reference",
        Reason::NotEverywhere => "that weren't measured with every scene, size and way of stereo",
    }
}

/// The option that limits it.
fn option(quantity: Quantity) -> &'static str {
    match quantity {
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

/// A figure with its unit.
fn figure(quantity: Quantity, value: f64) -> String {
    match quantity {
        Quantity::Milliseconds | Quantity::Ratio | Quantity::Flicker if value.is_infinite() => {
            "not measured".to_owned()
        }
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
