//! Temporary.
use super::results::Results;
use crate::error::Error;
use crate::files::outputs;
use framewright_graph::base::ReadFiles;
use std::path::Path;
pub(crate) const FILE: &str = "results.json";
pub(crate) fn read(folder: &Path, _read: &ReadFiles) -> Result<Results, Error> {
    Ok(serde_json::from_str(&std::fs::read_to_string(folder.join(FILE)).unwrap())?)
}
pub(crate) fn write(folder: &Path, results: &Results) -> Result<(), Error> {
    outputs::write(&[(&folder.join(FILE), serde_json::to_string_pretty(results)?.as_bytes())], &ReadFiles::default())
}
pub(crate) fn write_views(_: &Path, _: &Results) -> Result<(), Error> {
    Ok(())
}
