//! `framewright merge`: the results of several sweeps in one folder.

use crate::command_line::merging::MergeArguments;
use crate::error::Error;
use crate::files::outputs;
use crate::measure::pictures::Pictures;
use crate::measure::store;
use crate::system::{Exit, text};
use framewright_graph::base::ReadFiles;
use framewright_lab::results::{Part, Results, joined};
use std::path::Path;

/// Joins results, and copies their pictures. `results.json` is written last: while it is absent, the folder is incomplete.
///
/// # Errors
/// If results can't be read or joined, or a file can't be written.
pub(crate) fn merge(arguments: &MergeArguments) -> Result<Exit, Error> {
    let (read, to) = (ReadFiles::default(), &*arguments.output);
    let mut copies = Pictures::default();
    let mut parts = Vec::with_capacity(arguments.folders.len());
    for folder in &arguments.folders {
        let mut results = store::read(folder, &read)?;
        copies.rename(folder, &mut results, &read)?;
        parts.push(Part { folder: folder.clone(), results });
    }
    // The command line asks for at least one.
    let Some(results) = joined(parts)? else { return Ok(Exit::Fine) };
    outputs::make_folder(to)?;
    let file = to.join(store::FILE);
    outputs::prepare(std::iter::once(&*file), &read)?;
    if file.exists() && loses(to, &results)? {
        return Err(Error::OtherResults { folder: to.to_owned() });
    }
    copies.copy(to, &read)?;
    store::write_all(to, &results)?;
    let rows = text::count(results.rows.len(), "row", "rows");
    text::print(&format!("{rows} in {}\n", text::path(to))).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

/// Whether a folder holds rows that joined results don't.
fn loses(folder: &Path, results: &Results) -> Result<bool, Error> {
    let read = ReadFiles::default();
    let mut there = store::read(folder, &read)?;
    Pictures::default().rename(folder, &mut there, &read)?;
    Ok(there.subject != results.subject || there.rows.iter().any(|row| !results.rows.contains(row)))
}
