//! `framewright cache`: the files that are kept from one call to the next.

use crate::command_line::args::CacheArguments;
use crate::command_line::values::AnswerFormat;
use crate::error::Error;
use crate::system::{Exit, text};
use framewright_vulkan::{Cache, CachedFiles};
use serde::Serialize;
use std::path::Path;

#[derive(Debug, Serialize)]
struct Answer {
    format_version: u32,
    /// Where they are kept; `null` if the user has no home folder.
    folder: Option<String>,
    cleared: bool,
    kinds: Vec<Entry>,
}

#[derive(Debug, Serialize)]
struct Entry {
    kind: &'static str,
    files: u64,
    bytes: u64,
}

/// Prints the files of the cache, or removes them.
///
/// # Errors
/// If the cache can't be listed or cleared.
pub(crate) fn cache(arguments: &CacheArguments) -> Result<Exit, Error> {
    let cache = Cache::of_user();
    let found = cache.as_ref().map(|cache| look(cache, arguments.clear)).transpose()?.unwrap_or_default();
    let folder = cache.as_ref().map(Cache::folder);
    let shown = match arguments.format {
        AnswerFormat::Human => words(folder, &found, arguments.clear),
        AnswerFormat::Json => text::json(&Answer {
            format_version: 1,
            folder: folder.map(|folder| folder.to_string_lossy().into_owned()),
            cleared: arguments.clear,
            kinds: found.iter().map(|&CachedFiles { kind, files, bytes }| Entry { kind, files, bytes }).collect(),
        })?,
    };
    text::print(&shown).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

/// The files that the cache holds, or those that are removed from it.
fn look(cache: &Cache, clear: bool) -> Result<Vec<CachedFiles>, Error> {
    let failed = |done| move |source| Error::Cache { folder: cache.folder().to_owned(), done, source };
    if clear { cache.clear().map_err(failed("cleared")) } else { cache.files().map_err(failed("read")) }
}

fn words(folder: Option<&Path>, found: &[CachedFiles], cleared: bool) -> String {
    let Some(folder) = folder else {
        return "nothing is kept: neither `XDG_CACHE_HOME` nor `HOME` is an absolute path\n".to_owned();
    };
    let done = if cleared { "removed from" } else { "kept in" };
    let kinds = found.iter().map(|CachedFiles { kind, files, bytes }| {
        format!("  {kind}: {}, {}\n", text::count(*files as usize, "file", "files"), text::bytes(*bytes))
    });
    format!("{done} {}:\n{}", text::path(folder), kinds.collect::<String>())
}
