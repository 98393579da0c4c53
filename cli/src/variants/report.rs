//! The report for programs.

use super::axes::Axes;
use super::axis::AxisSubject;
use super::causes::Cause;
use super::checker::CheckedPipeline;
use super::run::Findings;
use super::space::{Choice, Space};
use crate::command_line::args::CheckArguments;
use crate::command_line::options;
use crate::command_line::values::Assignment;
use framewright_graph::base::{self, Diagnostic, Sources};
use framewright_graph::plan::Totals;
use serde::Serialize;
use serde_json::Value;

/// The answer.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    pub(crate) format_version: u32,
    /// The file, as it was named.
    pub(crate) pipeline: String,
    /// Whether nothing is wrong with any variant that was checked.
    pub(crate) fine: bool,
    /// Mistakes that every variant has; then none was checked.
    pub(crate) diagnostics: Value,
    /// Settings that the command line chose, itself or by a preset or settings files.
    pub(crate) chosen: Vec<Assignment>,
    pub(crate) axes: Vec<AxisEntry>,
    /// Presets that are among the variants, as they are on each device.
    pub(crate) presets: Vec<String>,
    /// Whether `variants` are not all combinations, but enough for each pair of values.
    pub(crate) pairwise: bool,
    /// Variants to check.
    pub(crate) variants: usize,
    /// Variants that were checked: all, unless `interrupted`.
    pub(crate) checked: usize,
    /// Whether the user stopped it.
    pub(crate) interrupted: bool,
    /// Variants that are wrong.
    pub(crate) failing: usize,
    /// Mistakes, those of most variants first.
    pub(crate) failures: Vec<FailureEntry>,
    /// Mistakes beyond those.
    pub(crate) further_failures: usize,
    /// Number of `plans`.
    pub(crate) distinct_plans: usize,
    /// Distinct Plans, those nearest to the defaults first.
    pub(crate) plans: Vec<PlanEntry>,
}

/// An axis with its values, the default first.
#[derive(Debug, Serialize)]
pub(crate) struct AxisEntry {
    /// `setting`, `fact` or `device`.
    pub(crate) kind: &'static str,
    /// The name of a setting or fact; a device has none.
    pub(crate) name: Option<String>,
    pub(crate) values: Vec<String>,
}

/// A variant by its departures from the defaults.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Variant {
    /// Settings that don't have their defaults, but for those that the command line chose.
    pub(crate) settings: Vec<Assignment>,
    /// Facts that are not as they are without a scene.
    pub(crate) facts: Vec<Assignment>,
    /// The device, if it isn't the first.
    pub(crate) device: Option<String>,
}

/// A mistake that variants have in common.
#[derive(Debug, Serialize)]
pub(crate) struct FailureEntry {
    /// The mistake as in the answers of `check`, in the variant `breaks_with`.
    pub(crate) diagnostic: Value,
    /// The mistake as people read it.
    #[serde(skip)]
    pub(crate) shown: String,
    /// Variants that have it.
    pub(crate) variants: usize,
    /// Devices on which it was found.
    pub(crate) devices: Vec<String>,
    /// The variant with the fewest departures from the defaults that has it.
    pub(crate) breaks_with: Variant,
    /// Whether without any one of these departures the mistake is another or none: each was left out to see.
    pub(crate) each_is_needed: bool,
}

/// A Plan that variants have in common.
#[derive(Debug, Serialize)]
pub(crate) struct PlanEntry {
    /// Variants that have it.
    pub(crate) variants: usize,
    /// One of them with the fewest departures from the defaults.
    pub(crate) example: Variant,
    /// The Plan's sums.
    pub(crate) totals: Totals,
    /// A hash that is equal for Plans that differ in values alone.
    #[serde(skip)]
    pub(crate) shape: u64,
}

impl Report {
    /// The report when no variant was checked.
    #[must_use]
    pub(crate) fn of_nothing(arguments: &CheckArguments) -> Report {
        Report {
            format_version: 1,
            pipeline: arguments.pipeline.file.to_string_lossy().into_owned(),
            diagnostics: Value::Array(Vec::new()),
            chosen: arguments.pipeline.set.clone(),
            pairwise: arguments.pairwise,
            ..Report::default()
        }
    }

    /// The report of all findings.
    #[must_use]
    pub(crate) fn new(
        arguments: &CheckArguments,
        subject: &CheckedPipeline<'_>,
        space: &Space,
        found: Findings,
        causes: Vec<Cause>,
    ) -> Report {
        let axes = &subject.axes;
        let Findings { checked, failing, plans, failures: _ } = found;
        let mut plans: Vec<_> = plans.into_iter().collect();
        plans.sort_by_key(|(_, plan)| plan.example);
        let told = plans.into_iter().map(|(identity, plan)| PlanEntry {
            variants: plan.variants,
            example: Variant::of(axes, &space.choice(plan.example.number)),
            totals: plan.totals,
            shape: identity.shape,
        });
        let plans: Vec<PlanEntry> = told.collect();
        Report {
            fine: failing == 0,
            chosen: axes.fixed.iter().cloned().map(|(name, value)| Assignment { name, value }).collect(),
            axes: axes.list.iter().map(|axis| axis_entry(&axis.varied, &axis.values[..axis.combined])).collect(),
            presets: axes.presets.iter().map(|(name, _)| name.clone()).collect(),
            pairwise: !space.is_all(),
            variants: space.len(),
            checked,
            interrupted: checked < space.len(),
            failing,
            failures: causes.into_iter().map(|cause| failure_entry(subject, cause)).collect(),
            distinct_plans: plans.len(),
            plans,
            ..Report::of_nothing(arguments)
        }
    }
}

impl Variant {
    fn of(axes: &Axes, choice: &Choice) -> Variant {
        let mut variant = Variant::default();
        for (varied, value) in axes.departures(choice) {
            let chosen = |name: &str| Assignment { name: name.to_owned(), value: value.to_owned() };
            match varied {
                AxisSubject::Setting(name) => variant.settings.push(chosen(name)),
                AxisSubject::Fact(fact) => variant.facts.push(chosen(fact.name())),
                AxisSubject::Device => variant.device = Some(value.to_owned()),
            }
        }
        variant
    }
}

fn axis_entry(varied: &AxisSubject, values: &[String]) -> AxisEntry {
    let (kind, name) = match varied {
        AxisSubject::Setting(name) => ("setting", Some(name.clone())),
        AxisSubject::Fact(fact) => ("fact", Some(fact.name().to_owned())),
        AxisSubject::Device => ("device", None),
    };
    AxisEntry { kind, name, values: values.to_vec() }
}

fn failure_entry(subject: &CheckedPipeline<'_>, cause: Cause) -> FailureEntry {
    let Cause { diagnostic, variants, devices, choice, least } = cause;
    let diagnostic = options::named_one(diagnostic);
    let all = subject.axes.list.last().map_or(&[][..], |axis| &axis.values[..]);
    FailureEntry {
        diagnostic: as_json(subject.sources, &diagnostic),
        shown: base::render(subject.sources, std::slice::from_ref(&diagnostic)),
        variants,
        devices: devices.into_iter().filter_map(|device| all.get(device).cloned()).collect(),
        breaks_with: Variant::of(&subject.axes, &choice),
        each_is_needed: least,
    }
}

fn as_json(sources: &Sources, diagnostic: &Diagnostic) -> Value {
    match base::to_json(sources, std::slice::from_ref(diagnostic)) {
        Value::Array(mut all) => all.pop().unwrap_or_default(),
        other => other,
    }
}
