//! `framewright diff`: the differences between two Plans, without a GPU.

use crate::command_line::differing::{DiffArguments, DifferenceFormat};
use crate::command_line::values::{self, Assignment};
use crate::error::Error;
use crate::files::inputs;
use crate::files::outputs;
use crate::planning::{self, plan_file};
use crate::system::{Exit, text};
use framewright_graph::base::{ReadFiles, Sources};
use framewright_graph::difference::Differences;
use framewright_graph::plan::{Detail, Plan};
use framewright_viewer::{Page, ShownPlan};
use std::path::Path;
use std::sync::Arc;

/// Prints or writes the differences.
///
/// # Errors
/// If a pipeline, a Plan, the scene or a profile is wrong, or the result can't be written.
pub(crate) fn diff(arguments: &DiffArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    inputs::expect(&arguments.pipeline, &read);
    let spare = || outputs::prepare(arguments.output.as_deref().into_iter(), &read);
    spare()?;
    let first = &arguments.pipeline.file;
    let second = arguments.other.as_ref().unwrap_or(first);
    if plan_file::is_one(first) && plan_file::is_one(second) {
        plan_file::nothing_chosen(&arguments.pipeline, &arguments.subject, None)?;
    }
    let [name_a, name_b] = [first, second].map(|file| file.to_string_lossy().into_owned());
    let (a, sources_a) = plan(arguments, first, "--a", &arguments.a, &read)?;
    let (b, sources_b) = plan(arguments, second, "--b", &arguments.b, &read)?;
    spare()?;
    let differences = Differences::between((&name_a, &a), (&name_b, &b));
    let shown = match arguments.format {
        DifferenceFormat::Human => text::escape_lines(&differences.text()) + "\n",
        DifferenceFormat::Json => text::json(&differences)?,
        DifferenceFormat::Markdown => text::escape_lines(&differences.markdown()) + "\n",
        DifferenceFormat::Html => {
            let detail = Detail { verbose: true, ..Detail::default() };
            let plans = vec![
                ShownPlan { name: name_a, plan: &a, detail, sources: sources_a.as_deref(), times: None },
                ShownPlan { name: name_b, plan: &b, detail, sources: sources_b.as_deref(), times: None },
            ];
            framewright_viewer::page(&Page { plans, differences: Some(&differences), devices: &[], captures: &[] })?
        }
    };
    match &arguments.output {
        Some(file) => outputs::write(&[(file, shown.as_bytes())], &read)?,
        None => text::print(&shown).map_err(Error::Print)?,
    }
    Ok(Exit::Fine)
}

/// The Plan in a file, or that of a pipeline with the texts that it was read from.
fn plan(
    arguments: &DiffArguments,
    file: &Path,
    option: &'static str,
    own: &[Assignment],
    read: &ReadFiles,
) -> Result<(Plan, Option<Arc<Sources>>), Error> {
    if plan_file::is_one(file) {
        return match own.is_empty() {
            true => Ok((plan_file::read(file, read)?, None)),
            false => Err(Error::ChoiceForPlan { option, path: file.to_owned() }),
        };
    }
    let (mut pipeline, mut subject) = (arguments.pipeline.clone(), arguments.subject.clone());
    pipeline.file = file.to_owned();
    for Assignment { name, value } in own {
        let wrong = |problem: String| Error::OwnChoice { option, name: name.clone(), problem };
        match &**name {
            "@device" => subject.device = Some(value.into()),
            "@scene" => subject.scene = Some(value.into()),
            "@size" => subject.size = value.parse().map_err(wrong)?,
            "@stereo" => pipeline.stereo = values::stereo(value).map_err(wrong)?,
            other if other.starts_with('@') => {
                return Err(wrong("expected a setting, @device, @scene, @size or @stereo".to_owned()));
            }
            _ => pipeline.set.push(Assignment { name: name.clone(), value: value.clone() }),
        }
    }
    let (loaded, planned) = planning::planned(&pipeline, &subject, read)?;
    Ok((planned.plan, Some(Arc::clone(&loaded.sources))))
}
