//! Reads the report that `run` wrote, for the times in it.

use super::inputs::{self, FileRole};
use crate::error::Error;
use framewright_graph::base::ReadFiles;
use framewright_graph::plan::{Plan, SettingUsed};
use framewright_graph::vulkan::name_of;
use framewright_lab::timings;
use framewright_viewer::Times;
use framewright_vulkan::{FrameReport, PassReport, StepReport};
use serde::Deserialize;
use std::path::Path;

/// A report has at most this many bytes.
const LARGEST: usize = 1 << 28;

/// What of a report tells its Plan, and the times.
#[derive(Deserialize)]
struct RunReport {
    format_version: u32,
    size: [u32; 2],
    settings: Vec<SettingUsed>,
    passes: Vec<WorkDone>,
    times: Option<Times>,
}

/// A pass or inserted work, and where it stands.
#[derive(PartialEq, Deserialize)]
struct WorkDone {
    step: usize,
    kind: String,
    name: String,
}

/// The times of a report of this Plan. The Plan may be made for another device than the one that was timed, if its work is the same.
///
/// # Errors
/// If it can't be read, is no report with times, or one of another Plan.
pub(crate) fn times(path: &Path, plan: &Plan, read: &ReadFiles) -> Result<Times, Error> {
    let text = inputs::text(FileRole::REPORT, path, LARGEST, read)?;
    let wrong = |problem: String| Error::NoReport { path: path.to_owned(), problem };
    let report: RunReport = serde_json::from_str(&text)
        .map_err(|problem| wrong(format!("it is no report that `framewright run --report` wrote: {problem}")))?;
    if report.format_version != 2 {
        return Err(wrong(format!(
            "it is a report of version {}, and this command reads version 2",
            report.format_version
        )));
    }
    if let Some(difference) = difference(&report, plan) {
        return Err(wrong(format!(
            "it is a report of another Plan: {difference}\nhelp: `framewright run … --save-plan PLAN.json --report` keeps both"
        )));
    }
    let times = report.times.ok_or_else(|| wrong("it has no times: the device measured none".to_owned()))?;
    let passes = plan.steps.iter().map(|step| step.work.passes().len());
    if times.steps.iter().map(|step| step.passes.len()).ne(passes) {
        return Err(wrong("its times are of other steps than its passes".to_owned()));
    }
    Ok(times)
}

/// The first thing in which a report isn't one of this Plan.
fn difference(report: &RunReport, plan: &Plan) -> Option<String> {
    let ([width, height], [own_width, own_height]) = (report.size, plan.extent);
    if report.size != plan.extent {
        return Some(format!(
            "it was drawn with {width}×{height} pixels, and the Plan is for {own_width}×{own_height}"
        ));
    }
    let shown = |settings: &[SettingUsed]| {
        let each = settings.iter().map(|setting| format!("{}={}", setting.name, setting.value));
        let all = each.collect::<Vec<_>>().join(", ");
        if all.is_empty() { "no settings".to_owned() } else { all }
    };
    if report.settings != plan.settings {
        return Some(format!(
            "it was drawn with {}, and the Plan has {}",
            shown(&report.settings),
            shown(&plan.settings)
        ));
    }
    let own = work(plan);
    let at = (0..own.len().max(report.passes.len())).find(|at| own.get(*at) != report.passes.get(*at))?;
    let said = |work: Option<&WorkDone>| match work {
        Some(work) => format!("`{}` in step {}", work.name, work.step),
        None => "nothing more".to_owned(),
    };
    Some(format!("it has {} where the Plan has {}", said(report.passes.get(at)), said(own.get(at))))
}

/// The work of a Plan, as a report lists it.
fn work(plan: &Plan) -> Vec<WorkDone> {
    let pass = |name: &str| PassReport { name: name.to_owned(), draws: 0, culled: 0, milliseconds: 0.0 };
    let steps = plan.steps.iter().map(|step| StepReport {
        milliseconds: 0.0,
        began: None,
        ran: true,
        passes: step.work.passes().iter().map(|it| pass(&it.name)).collect(),
    });
    let frame = FrameReport {
        milliseconds: 0.0,
        recording_milliseconds: 0.0,
        recording_began: None,
        fragment_invocations: None,
        steps: steps.collect(),
    };
    let rows = timings::rows(plan, &[frame]).into_iter();
    rows.map(|row| WorkDone { step: row.step, kind: name_of(&row.kind), name: row.name }).collect()
}
