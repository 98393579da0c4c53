//! The files that a pipeline names: where they come from, and why one can't be read.

use crate::base::{Code, Diagnostic, FilePath, OutsideChoice, Span};
use crate::frame::{TextureFile, TextureInfo, TextureProblem};

/// The version of the language that this library reads.
pub const LANGUAGE_VERSION: i64 = 1;

/// A pipeline file has at most this many bytes (16 MiB).
pub const LARGEST_FILE: usize = 16 << 20;

/// Provides the files that a pipeline names. An implementation decides which files may be read.
pub trait Files {
    /// Reads a file. `from` is the [`FoundFile::relative`] of the file that names it, and `path` the path as it stands there.
    ///
    /// # Errors
    /// Why it can't be read.
    fn read(&mut self, from: &FilePath, path: &str) -> Result<FoundFile, ReadFailure>;

    /// Looks at a picture's file: its path is counted from the pipeline's own folder.
    ///
    /// # Errors
    /// [`TextureProblem`] says why it holds no texture.
    fn picture(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        let _ = file;
        Err(TextureProblem::NotProvided)
    }
}

/// Why a file can't be read. Not yet escaped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadFailure {
    /// The rule that is broken.
    pub code: Code,
    /// A sentence without final stop.
    pub why: String,
    /// The help.
    pub help: Option<String>,
    /// The choice outside of all files that would mend it.
    pub choice: Option<OutsideChoice>,
    /// Whether nothing is wrong with the files: the machine doesn't let the file be read.
    pub of_machine: bool,
}

impl From<String> for ReadFailure {
    fn from(why: String) -> ReadFailure {
        ReadFailure { code: Code::FILE_NAMED_UNREAD, why, help: None, choice: None, of_machine: false }
    }
}

/// A file that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundFile {
    /// The path that diagnostics show.
    pub shown: String,
    /// The path that stands in Plans.
    pub relative: FilePath,
    /// Its contents.
    pub bytes: Vec<u8>,
}

/// No files: a pipeline that names any is wrong.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoFiles;

impl Files for NoFiles {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        Err(format!("`{path}` can't be read: this pipeline was given as a text by itself").into())
    }
}

/// The mistake in a text that shows at once that it is no pipeline.
pub(crate) fn no_pipeline(file: u32, text: &str) -> Option<Diagnostic> {
    let span = |start: usize, end: usize| {
        let [start, end] = [start, end].map(|at| u32::try_from(at).unwrap_or(u32::MAX));
        Span::new(file, start, end)
    };
    if text.trim().is_empty() {
        let empty = Diagnostic::new(Code::FILE_EMPTY, span(0, text.len()), "the file is empty");
        return Some(empty.help("a pipeline begins with `Pipeline(version: 1,`"));
    }
    text.find('\0').map(|at| {
        let zero = Diagnostic::new(
            Code::FILE_NOT_TEXT,
            span(at, at + 1),
            format!("this is not a text file: byte {at} is 0x00"),
        );
        zero.help("a pipeline is RON text in UTF-8")
    })
}
