//! Reads and writes the folder of a sweep: `results.json`, and what is made of it for people.

use super::{csv, page, plot};
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::files::outputs;
use framewright_graph::base::ReadFiles;
use framewright_lab::results::Results;
use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// The file of the results, in their folder.
pub(crate) const FILE: &str = "results.json";

/// The file by which a process holds the folder. It is empty, and stays.
const LOCK: &str = "results.lock";

/// The file has at most this many bytes: more than a hundred thousand rows.
const LARGEST: usize = 512 << 20;

/// Reads the results in a folder.
///
/// # Errors
/// If the file can't be read, is of another version, is damaged, or holds figures that no measurement gives.
pub(crate) fn read(folder: &Path, read: &ReadFiles) -> Result<Results, Error> {
    let path = folder.join(FILE);
    let text = inputs::text(FileRole::RESULTS, &path, LARGEST, read)?;
    Results::from_json(&text).map_err(|problem| Error::Results { path, problem })
}

/// Writes `results.json` in a folder, whole or not at all: what [`read`] takes.
///
/// # Errors
/// If a figure is none that a measurement gives, or the file can't be written.
pub(crate) fn write(folder: &Path, results: &Results) -> Result<(), Error> {
    write_files(&[file(folder, results)?])
}

fn file(folder: &Path, results: &Results) -> Result<(PathBuf, String), Error> {
    let path = folder.join(FILE);
    results.possible().map_err(|problem| Error::Results { path: path.clone(), problem })?;
    Ok((path, serde_json::to_string_pretty(results)? + "\n"))
}

/// The files in a folder that are made of `results.json`: a table, a page and a plot.
pub(crate) fn made_of(folder: &Path, results: &Results) -> Result<Vec<(PathBuf, String)>, Error> {
    Ok(vec![
        (folder.join("results.csv"), csv::table(results)?),
        (folder.join("index.html"), page::page(results)?),
        (folder.join("front.svg"), plot::front(results)),
    ])
}

/// Writes a table, a page and a plot beside `results.json`, each whole or not at all.
///
/// # Errors
/// If a file can't be written.
pub(crate) fn write_views(folder: &Path, results: &Results) -> Result<(), Error> {
    write_files(&made_of(folder, results)?)
}

/// Writes a table, a page, a plot and `results.json`, the last one last: all of them, or none if there is no room for all.
///
/// # Errors
/// As [`write()`] and [`write_views`].
pub(crate) fn write_all(folder: &Path, results: &Results) -> Result<(), Error> {
    let mut files = made_of(folder, results)?;
    files.push(file(folder, results)?);
    write_files(&files)
}

fn write_files(files: &[(PathBuf, String)]) -> Result<(), Error> {
    let files: Vec<(&Path, &[u8])> = files.iter().map(|(path, text)| (&**path, text.as_bytes())).collect();
    outputs::write(&files, &ReadFiles::default())
}

/// Holds a folder of results for as long as the answer lives: no other process measures into it.
///
/// # Errors
/// If another process holds it, or its lock can't be written.
pub(crate) fn hold(folder: &Path) -> Result<Option<File>, Error> {
    let path = folder.join(LOCK);
    let problem = |source| Error::Write { path: path.clone(), source };
    let file = File::options().create(true).truncate(false).write(true).open(&path).map_err(problem)?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Err(Error::Held { folder: folder.to_owned() }),
        // Some file systems have no locks: there a folder can't be held.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(None),
        Err(TryLockError::Error(error)) => Err(problem(error)),
    }
}
