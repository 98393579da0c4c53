//! The report for people.

use super::report::{AxisEntry, FailureEntry, PlanEntry, Report, Variant};
use crate::findings::Case;
use crate::planning::totals;
use crate::system::text;
use serde_json::Value;
use std::collections::HashMap;

/// At most this many mistakes and Plans are shown to people. The JSON report has all.
const MOST: usize = 20;

/// Mistakes, then Plans, then how many variants are fine.
#[must_use]
pub(crate) fn human(report: &Report) -> String {
    let mut answer = String::new();
    let devices = report.axes.iter().filter(|axis| axis.kind == "device").map(|axis| axis.values.len()).sum();
    for failure in report.failures.iter().take(MOST) {
        answer += &told(failure, devices);
    }
    let further = report.failures.len().saturating_sub(MOST) + report.further_failures;
    if further > 0 {
        answer += &format!("and {}\n\n", text::count(further, "further mistake", "further mistakes"));
    }
    answer += &plans(report);
    answer += &verdict(report);
    answer
}

/// A case for each mistake, and one for the variants that are fine.
#[must_use]
pub(crate) fn cases(report: &Report) -> Vec<Case> {
    let shared = report.diagnostics.as_array().is_some_and(|all| !all.is_empty());
    if shared {
        return vec![Case::new("every variant", &report.diagnostics)];
    }
    let named = |failure: &FailureEntry| {
        let variants = text::count(failure.variants, "variant", "variants");
        format!("{variants}, first {}, on {}", with(&failure.breaks_with), failure.devices.join(", "))
    };
    let failing = report.failures.iter().zip(1..).map(|(failure, number)| {
        Case::new(format!("mistake {number}: {}", named(failure)), &Value::Array(vec![failure.diagnostic.clone()]))
    });
    let mut cases: Vec<Case> = failing.collect();
    let fine = text::count(report.checked - report.failing, "variant", "variants");
    cases.push(Case { name: format!("{fine} without a mistake"), findings: Vec::new() });
    cases
}

fn told(failure: &FailureEntry, devices: usize) -> String {
    let on = if failure.devices.len() == devices {
        String::new()
    } else {
        format!(" on {}", failure.devices.iter().map(|name| text::escape(name)).collect::<Vec<_>>().join(", "))
    };
    let how = if failure.each_is_needed { "breaks" } else { "seen" };
    format!(
        "{}\n  in {}{on}; {how} {}\n\n",
        failure.shown.trim_end(),
        text::count(failure.variants, "variant", "variants"),
        with(&failure.breaks_with)
    )
}

/// A variant in words: `with --set msaa=8 --device mali-g78`.
fn with(variant: &Variant) -> String {
    let set =
        variant.settings.iter().map(|one| format!("--set {}={}", text::escape(&one.name), text::escape(&one.value)));
    let device = variant.device.iter().map(|name| format!("--device {}", text::escape(name)));
    let words: Vec<String> = set.chain(device).collect();
    let facts: Vec<String> = variant
        .facts
        .iter()
        .map(|fact| format!("{} = {}", text::escape(&fact.name), text::escape(&fact.value)))
        .collect();
    let words = if words.is_empty() { "the defaults".to_owned() } else { words.join(" ") };
    match facts.is_empty() {
        true => format!("with {words}"),
        false => format!("with {words} in a scene where {}", facts.join(" and ")),
    }
}

fn plans(report: &Report) -> String {
    let line = |alike: &PlanGroup<'_>| {
        let variants = match alike.plans {
            1 => text::count(alike.variants, "variant, ", "variants, such as "),
            plans => {
                let variants = text::count(alike.variants, "variant", "variants");
                format!("{variants}, {plans} Plans that differ in values alone, such as ")
            }
        };
        format!("  {variants}{}: {}\n", with(&alike.first.example), totals::estimated(&alike.first.totals))
    };
    let mut answer = text::count(report.distinct_plans, "distinct Plan", "distinct Plans") + "\n";
    let groups = alike(&report.plans);
    answer.extend(groups.iter().take(MOST).map(line));
    let further: usize = groups.iter().skip(MOST).map(|alike| alike.plans).sum();
    if further > 0 {
        answer += &format!("  and {} (`--format json` tells them all)\n", text::count(further, "other", "others"));
    }
    answer
}

/// Plans that differ in values alone.
struct PlanGroup<'r> {
    /// The one that is nearest to the defaults.
    first: &'r PlanEntry,
    plans: usize,
    variants: usize,
}

/// Plans that differ in values alone together, each lot where its first stands.
fn alike(plans: &[PlanEntry]) -> Vec<PlanGroup<'_>> {
    let mut groups: Vec<PlanGroup<'_>> = Vec::new();
    let mut places = HashMap::new();
    for plan in plans {
        let place = *places.entry(plan.shape).or_insert(groups.len());
        if place == groups.len() {
            groups.push(PlanGroup { first: plan, plans: 0, variants: 0 });
        }
        groups[place].plans += 1;
        groups[place].variants += plan.variants;
    }
    groups
}

fn verdict(report: &Report) -> String {
    let pipeline = text::escape(&report.pipeline);
    let axes: Vec<String> = report.axes.iter().filter(|axis| axis.values.len() > 1).map(axis).collect();
    let of = match (axes.is_empty(), report.pairwise) {
        (true, _) => "nothing varies".to_owned(),
        (false, true) => format!("every pair of values of {}", axes.join(", ")),
        (false, false) => axes.join(" × "),
    };
    let of = match report.presets.len() {
        0 => of,
        presets => format!("{of}, and {}", text::count(presets, "preset", "presets")),
    };
    let until = match report.interrupted {
        true => format!(" (interrupted: of {} in all)", report.variants),
        false => String::new(),
    };
    let checked = text::count(report.checked, "variant", "variants");
    match report.failing {
        0 => format!("{pipeline}: fine in {checked}{until}: {of}\n"),
        failing => format!("{pipeline}: wrong in {failing} of {checked}{until}: {of}\n"),
    }
}

fn axis(axis: &AxisEntry) -> String {
    match &axis.name {
        Some(name) => format!("{} ({})", text::escape(name), axis.values.len()),
        None => format!("devices ({})", axis.values.len()),
    }
}
