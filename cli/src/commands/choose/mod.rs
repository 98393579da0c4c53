//! `framewright choose`: the best settings under a budget, of those that were measured.

mod answer;
mod settings;
mod settings_file;

use crate::command_line::choosing::ChooseArguments;
use crate::command_line::values::AnswerFormat;
use crate::error::Error;
use crate::files::outputs;
use crate::measure::store;
use crate::system::{Exit, text};
use answer::Answer;
use framewright_graph::base::ReadFiles;
use framewright_lab::choosing::{Candidates, Limit, Quantity, SettingsAnswer};
use framewright_lab::metric::Metric;
use framewright_lab::results::{Part, Results, joined};
use std::path::PathBuf;

/// Prints the best settings, and writes them.
///
/// # Errors
/// If results can't be read or joined, or the settings file can't be written.
pub(crate) fn choose(arguments: &ChooseArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    outputs::prepare(arguments.output.as_deref().into_iter(), &read)?;
    // The command line asks for at least one folder.
    let Some(results) = all(&arguments.folders, &read)? else { return Ok(Exit::Fine) };
    if arguments.max_flicker.is_some() && results.subject.flicker_frames.is_none() {
        return Err(Error::NoFlicker { folder: arguments.folders.first().cloned().unwrap_or_default() });
    }
    let (candidates, limits) = (Candidates::of(&results), limits(arguments));
    if arguments.max_ratio.is_some()
        && let Some(group) = candidates.without_baseline()
    {
        return Err(Error::NoBaseline { baseline: results.shown(&results.subject.baseline), group: group.name() });
    }
    let chosen = candidates.choose(&limits);
    if let (SettingsAnswer::Best { best, .. }, Some(file)) = (&chosen, &arguments.output) {
        let contents = settings::file(&results, &best.settings, &read)?;
        outputs::write(&[(file, contents.as_bytes())], &read)?;
    }
    let answer = Answer { results: &results, candidates: &candidates, limits: &limits, chosen: &chosen };
    let shown = match arguments.format {
        AnswerFormat::Human => answer.words(arguments.output.as_deref()),
        AnswerFormat::Json => text::json(&answer.json())?,
    };
    text::print(&shown).map_err(Error::Print)?;
    Ok(if matches!(chosen, SettingsAnswer::Best { .. }) { Exit::Fine } else { Exit::Found })
}

/// The results of all folders.
fn all(folders: &[PathBuf], read: &ReadFiles) -> Result<Option<Results>, Error> {
    let mut parts = Vec::with_capacity(folders.len());
    for folder in folders {
        let mut results = store::read(folder, read)?;
        // Pictures decide nothing here, and needn't be there.
        results.forget_pictures();
        parts.push(Part { folder: folder.clone(), results });
    }
    Ok(joined(parts)?)
}

/// The limits that are stated.
fn limits(arguments: &ChooseArguments) -> Vec<Limit> {
    let figures = [
        (Quantity::Milliseconds, arguments.max_ms),
        (Quantity::Ratio, arguments.max_ratio),
        (Quantity::Mebibytes, arguments.max_mib),
        (Quantity::MovedMebibytes, arguments.max_moved_mib),
        (Quantity::Flicker, arguments.max_flicker),
    ];
    let errors = Metric::ALL.map(|metric| (Quantity::Error(metric), arguments.errors.of(metric)));
    let limits = figures.into_iter().chain(errors);
    limits.filter_map(|(quantity, value)| Some(Limit { quantity, value: value? })).collect()
}
