//! Files that are read: the user's own from disk, else those that the binary carries.

use crate::error::Error;
use crate::shipped::{self, Example};
use crate::text;
use framewright_graph::describe::LARGEST_FILE;
use framewright_graph::source::Sources;
use framewright_passes::scene::{self, Scene, SceneError};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// A pipeline file, not yet read as RON.
#[derive(Debug)]
pub(crate) struct PipelineFile {
    /// Name to show: as the user gave it.
    pub(crate) shown: String,
    /// Name without its folder.
    pub(crate) name: String,
    /// The folder that it lies in; `None`: the binary carries it.
    pub(crate) folder: Option<PathBuf>,
    /// What it holds.
    pub(crate) bytes: Vec<u8>,
}

/// Reads a pipeline file; where there is none, a shipped one of that name, and says so.
///
/// # Errors
/// If there is neither, or it can't be read.
pub(crate) fn pipeline(path: &Path) -> Result<PipelineFile, Error> {
    const WHAT: &str = "pipeline";
    match bytes(WHAT, path, LARGEST_FILE) {
        Ok(bytes) => Ok(PipelineFile {
            shown: path.to_string_lossy().into_owned(),
            name: path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
            folder: Some(match path.parent() {
                Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
                _ => PathBuf::from("."),
            }),
            bytes,
        }),
        Err(Error::Read { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
            let example = carried(WHAT, path, shipped::PIPELINES)?;
            Ok(PipelineFile {
                shown: example.file.to_owned(),
                name: example.file.to_owned(),
                folder: None,
                bytes: example.text.as_bytes().to_vec(),
            })
        }
        Err(error) => Err(error),
    }
}

/// Reads a scene; where there is no such file, a shipped one of that name, and says so. Says too what the file holds that
/// isn't drawn.
///
/// # Errors
/// If there is neither, or the file is no scene.
pub(crate) fn scene(path: &Path) -> Result<Scene, Error> {
    let scene = match path.try_exists() {
        Ok(false) => {
            let example = carried("scene", path, shipped::SCENES)?;
            let mut sources = Sources::default();
            scene::text::read(&mut sources, example.file, example.file, example.text.to_owned())
                .map_err(|mistakes| SceneError::Text { sources, mistakes })
        }
        _ => scene::load(path),
    };
    let scene = scene.map_err(|problem| Error::Scene(Box::new(problem)))?;
    for note in &scene.notes {
        text::say(&format!("note: {}: {}", text::path(path), text::escape(note)));
    }
    Ok(scene)
}

/// Reads a text file of at most `limit` bytes.
///
/// # Errors
/// If it can't be read, is too large or isn't text.
pub(crate) fn text(what: &'static str, path: &Path, limit: usize) -> Result<String, Error> {
    String::from_utf8(bytes(what, path, limit)?).map_err(|error| Error::NotText {
        what,
        path: path.to_owned(),
        at: error.utf8_error().valid_up_to(),
    })
}

fn bytes(what: &'static str, path: &Path, limit: usize) -> Result<Vec<u8>, Error> {
    let problem = |source| Error::Read { what, path: path.to_owned(), source };
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(limit as u64 + 1).read_to_end(&mut bytes)).map_err(problem)?;
    if bytes.len() > limit {
        return Err(Error::TooLarge { what, path: path.to_owned(), limit: limit as u64 });
    }
    Ok(bytes)
}

/// The shipped file that `path` asks for.
fn carried(what: &'static str, path: &Path, examples: &'static [Example]) -> Result<&'static Example, Error> {
    let missing = || Error::Missing {
        what,
        path: path.to_owned(),
        shipped: examples.iter().map(|example| example.name).collect(),
    };
    let example = examples.iter().find(|example| example.is_called(path)).ok_or_else(missing)?;
    text::say(&format!("note: there is no file `{}` here; this is the shipped {what} of that name", text::path(path)));
    Ok(example)
}
