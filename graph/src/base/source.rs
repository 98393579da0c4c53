//! Where something was written: files, byte ranges in them, and places that people read.

use super::FilePath;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A byte range of one source file. Two words, copied freely.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Span {
    /// Index into [`Sources`]; `u32::MAX` for things that no file says.
    file: u32,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The span of something that was built in memory.
    pub const NONE: Span = Span { file: u32::MAX, start: 0, end: 0 };

    /// The bytes `start..end` of file number `file`.
    #[must_use]
    pub const fn new(file: u32, start: u32, end: u32) -> Span {
        Span { file, start, end }
    }

    /// The file's number, if it stands in one.
    #[must_use]
    pub const fn file(self) -> Option<usize> {
        if self.file == u32::MAX { None } else { Some(self.file as usize) }
    }
}

/// One source text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceFile {
    /// As the user named it: shown in diagnostics.
    pub shown: String,
    /// Which one it is.
    pub path: FilePath,
    /// That as a text: it stands in Plans, which must not depend on the working directory.
    pub relative: Arc<str>,
    /// The text.
    pub text: Arc<str>,
    line_starts: Vec<u32>,
}

/// Every text that was read, by number.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Sources {
    files: Vec<SourceFile>,
}

impl Sources {
    /// Adds a text and returns its number.
    pub fn add(&mut self, shown: impl Into<String>, path: impl Into<FilePath>, text: impl Into<Arc<str>>) -> u32 {
        let (path, text) = (path.into(), text.into());
        let next_lines = text.match_indices('\n').map(|(at, _)| u32::try_from(at + 1).unwrap_or(u32::MAX));
        let line_starts = std::iter::once(0).chain(next_lines).collect();
        let (shown, relative) = (shown.into(), path.to_string().into());
        self.files.push(SourceFile { shown, path, relative, text, line_starts });
        u32::try_from(self.files.len() - 1).expect("fewer than 2^32 files")
    }

    /// The file numbered `file`.
    #[must_use]
    pub fn file(&self, file: usize) -> Option<&SourceFile> {
        self.files.get(file)
    }

    /// The place that people read, if the span stands in a file.
    #[must_use]
    pub fn place(&self, span: Span) -> Option<Place> {
        let file = self.files.get(span.file()?)?;
        let line = file.line_starts.partition_point(|start| *start <= span.start).max(1);
        let line_start = file.line_starts[line - 1] as usize;
        let before = file.text.get(line_start..span.start as usize).unwrap_or("");
        let column = u32::try_from(before.chars().count() + 1).unwrap_or(u32::MAX);
        Some(Place { file: file.relative.clone(), line: u32::try_from(line).unwrap_or(u32::MAX), column })
    }
}

/// File, line and column, the last two from 1, columns in characters. Written `file:line:column`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Place {
    /// Path relative to the pipeline's own folder.
    pub file: Arc<str>,
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}:{}", self.file, self.line, self.column)
    }
}

impl From<Place> for String {
    fn from(place: Place) -> String {
        place.to_string()
    }
}

impl TryFrom<String> for Place {
    type Error = String;

    fn try_from(text: String) -> Result<Place, String> {
        let mut parts = text.rsplitn(3, ':');
        let column = parts.next().and_then(|part| part.parse().ok());
        let line = parts.next().and_then(|part| part.parse().ok());
        match (parts.next(), line, column) {
            (Some(file), Some(line), Some(column)) => Ok(Place { file: file.into(), line, column }),
            _ => Err(format!("`{}` is not file:line:column", text.escape_debug())),
        }
    }
}
