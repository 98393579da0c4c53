//! `framewright check --device all`: a verdict for every shipped profile.

use super::verdict::{Verdict, fine, print_findings, verdict};
use crate::budget;
use crate::command_line::args::{CheckArguments, CheckFormat};
use crate::error::Error;
use crate::findings::Case;
use crate::planning::{self, device, notes};
use crate::system::{Exit, progress, text};
use framewright_graph::base::{self, ReadFiles};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::plan::{Note, Plan};
use serde::Serialize;
use std::collections::HashSet;

/// The answer for programs.
#[derive(Debug, Serialize)]
struct Answer {
    format_version: u32,
    pipeline: String,
    /// Whether nothing is wrong on any device.
    fine: bool,
    /// Mistakes that don't depend on the device.
    diagnostics: serde_json::Value,
    /// A verdict for each device; empty if there are mistakes that don't depend on the device.
    devices: Vec<Entry>,
}

#[derive(Debug, Serialize)]
struct Entry {
    /// The profile's name, which `--device` takes.
    profile: &'static str,
    #[serde(flatten)]
    verdict: Verdict,
}

/// The result on one device.
struct DeviceCheck {
    profile: &'static str,
    device: String,
    result: Result<Plan, Error>,
}

/// Checks a pipeline for every shipped profile.
///
/// # Errors
/// Mistakes that don't depend on the device; in the form for programs those are the answer.
pub(crate) fn check(arguments: &CheckArguments) -> Result<Exit, Error> {
    let results = compile(arguments);
    match arguments.format {
        CheckFormat::Human => human(arguments, results?),
        CheckFormat::Json => json(arguments, results),
        format => for_ci(arguments, format, results),
    }
}

/// Compiles for each profile.
///
/// # Errors
/// Mistakes that don't depend on the device.
fn compile(arguments: &CheckArguments) -> Result<Vec<DeviceCheck>, Error> {
    let busy = progress::busy("reading");
    let mut pipeline = planning::load(&arguments.pipeline, &ReadFiles::default())?;
    let budget = budget::read(arguments.budget.as_deref(), &mut pipeline)?;
    let options = arguments.planning.options();
    // The device decides whether the images of both eyes are layers or halves.
    let choices = planning::choices(&arguments.pipeline, arguments.size, arguments.planning.rotate);
    let by_device = pipeline.document.asks_device() || choices.stereo.iter().any(|it| *it > Stereo::MultiPass);
    let mut same: Option<Frame> = None;
    let mut all = Vec::new();
    for (name, profile) in device::all()? {
        let frame = match same.take() {
            Some(frame) => Ok(frame),
            None => pipeline.frame(&choices, &profile),
        };
        let result = match frame {
            Ok(frame) => {
                busy.set_message(progress::compiling(&frame, &profile.name));
                let plan = pipeline.compile(&frame, &profile, &mut MemoryEstimate(&profile), &options);
                let result = plan.map_err(Error::from).and_then(|plan| {
                    pipeline.fits(&plan, &frame, &profile)?;
                    budget.holds(&plan, &pipeline.sources)?;
                    Ok(plan)
                });
                same = Some(frame).filter(|_| !by_device);
                result
            }
            Err(wrong) if by_device => Err(wrong.into()),
            Err(wrong) => return Err(wrong.into()),
        };
        all.push(DeviceCheck { profile: name, device: profile.name, result });
    }
    let mut said =
        all.iter().map(|it| it.result.as_ref().err().filter(|it| it.is_about_the_pipeline()).map(Error::shown));
    let first = said.next().flatten();
    if first.is_some()
        && said.all(|other| other == first)
        && let Some(DeviceCheck { result: Err(error), .. }) = all.pop()
    {
        return Err(error);
    }
    Ok(all)
}

fn human(arguments: &CheckArguments, results: Vec<DeviceCheck>) -> Result<Exit, Error> {
    let all = results.len();
    let plans: Vec<&Plan> = results.iter().filter_map(|it| it.result.as_ref().ok()).collect();
    let said: Vec<HashSet<(&str, &str)>> =
        plans.iter().map(|plan| plan.notes.iter().map(subject_and_text).collect()).collect();
    let everywhere = |note: &&Note| said.len() > 1 && said.iter().all(|notes| notes.contains(&subject_and_text(note)));
    let mut answer = String::new();
    for DeviceCheck { profile, result, .. } in &results {
        match result {
            Ok(plan) => {
                answer += &format!("{}\n", fine(arguments, profile, &plan.totals));
                for line in notes::lines(notes::worth_showing(&plan.notes).filter(|note| !everywhere(note))) {
                    answer += &format!("  {line}\n");
                }
            }
            Err(error) => {
                answer += &format!("{}: refused on {profile}\n", text::path(&arguments.pipeline.file));
                answer += &indented(&error.shown());
            }
        }
    }
    for line in
        notes::lines(plans.first().into_iter().flat_map(|plan| notes::worth_showing(&plan.notes)).filter(everywhere))
    {
        answer += &format!("{line} (on every device that takes it)\n");
    }
    answer += &format!("{}: fine on {} of {all} devices\n", text::path(&arguments.pipeline.file), plans.len());
    text::print(&answer).map_err(Error::Print)?;
    Ok(if plans.len() == all { Exit::Fine } else { Exit::Found })
}

/// Subject and text of a note.
fn subject_and_text(note: &Note) -> (&str, &str) {
    (&note.subject, &note.text)
}

fn indented(lines: &str) -> String {
    lines.lines().map(|line| if line.is_empty() { "\n".to_owned() } else { format!("  {line}\n") }).collect()
}

fn for_ci(
    arguments: &CheckArguments,
    format: CheckFormat,
    results: Result<Vec<DeviceCheck>, Error>,
) -> Result<Exit, Error> {
    let (cases, exit) = match results {
        Ok(results) => {
            let cases = results.into_iter().map(|DeviceCheck { profile, device, result }| {
                let Verdict { diagnostics, violations, .. } = verdict(device, result)?;
                Ok(Case::new(profile, &diagnostics).violations(&violations))
            });
            let cases = cases.collect::<Result<Vec<Case>, Error>>()?;
            let exit = if cases.iter().all(|case| case.findings.is_empty()) { Exit::Fine } else { Exit::Found };
            (cases, exit)
        }
        Err(Error::Mistakes { mistakes }) => {
            let case = Case::new("every device", &base::to_json(&mistakes.sources, &mistakes.diagnostics));
            (vec![case], Error::Mistakes { mistakes }.exit())
        }
        Err(other) => return Err(other),
    };
    print_findings(arguments, format, &cases)?;
    Ok(exit)
}

fn json(arguments: &CheckArguments, results: Result<Vec<DeviceCheck>, Error>) -> Result<Exit, Error> {
    let mut answer = Answer {
        format_version: 1,
        pipeline: arguments.pipeline.file.to_string_lossy().into_owned(),
        fine: false,
        diagnostics: serde_json::Value::Array(Vec::new()),
        devices: Vec::new(),
    };
    let exit = match results {
        Ok(results) => {
            for DeviceCheck { profile, device, result } in results {
                answer.devices.push(Entry { profile, verdict: verdict(device, result)? });
            }
            answer.fine = answer.devices.iter().all(|device| device.verdict.fine);
            if answer.fine { Exit::Fine } else { Exit::Found }
        }
        Err(Error::Mistakes { mistakes }) => {
            answer.diagnostics = base::to_json(&mistakes.sources, &mistakes.diagnostics);
            Error::Mistakes { mistakes }.exit()
        }
        Err(other) => return Err(other),
    };
    text::print(&text::json(&answer)?).map_err(Error::Print)?;
    Ok(exit)
}
