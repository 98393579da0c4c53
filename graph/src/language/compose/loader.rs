//! The texts of files that others name.

use super::files::{Files, FoundFile, LANGUAGE_VERSION, LARGEST_FILE, ReadFailure, no_pipeline};
use super::origins::Origins;
use crate::base::{Code, Diagnostic, FilePath, Sources, Span, text_of};
use crate::frame::{TextureFile, TextureInfo, TextureProblem};
use crate::language::entries::textures::Pictures;
use crate::ron::{Leaf, Reader, Tree};
use std::collections::HashMap;
use std::sync::Arc;

/// A pipeline is made of at most this many files.
const MOST_FILES: usize = 256;

/// Its files name each other at most this often: each time the named file is read, to find out which file it is.
const MOST_NAMED: usize = 1024;

/// Reads files, and keeps where each was named.
pub(crate) struct Loader<'a> {
    pub(super) sources: &'a mut Sources,
    pub(super) files: &'a mut dyn Files,
    read: usize,
    named: usize,
    pub(crate) origins: Origins,
    /// The infos of pictures, each of which is opened once.
    pub(super) looked: HashMap<TextureFile, Result<TextureInfo, TextureProblem>>,
    /// The pictures that textures name.
    pub(crate) pictures: Pictures,
}

impl<'a> Loader<'a> {
    /// A loader that has read the pipeline's own file.
    pub(crate) fn new(sources: &'a mut Sources, files: &'a mut dyn Files) -> Self {
        let (origins, looked, pictures) = (Origins::default(), HashMap::new(), Pictures::new());
        Loader { sources, files, read: 1, named: 0, origins, looked, pictures }
    }

    /// The file that the file `from` names `path`, at `span`.
    pub(crate) fn find(&mut self, reader: &mut Reader, from: &FilePath, path: &str, span: Span) -> Option<FoundFile> {
        self.named += 1;
        if self.named > MOST_NAMED {
            // One answer stands for all that follow.
            if self.named == MOST_NAMED + 1 {
                let message = format!("the files of a pipeline name others at most {MOST_NAMED} times");
                reader.report(
                    Diagnostic::new(Code::TOO_MANY_FILES, span, message).help("each file has to be named only once"),
                );
            }
            return None;
        }
        let found = self.files.read(from, path);
        let wrong = |ReadFailure { code, why, help, choice, of_machine }| Diagnostic {
            help,
            choice,
            of_machine,
            ..Diagnostic::new(code, span, why)
        };
        found.map_err(|unread| reader.report(wrong(unread))).ok()
    }

    /// The tree of a file that was named at `span`; `words` name the purpose: "included here".
    pub(crate) fn tree(
        &mut self,
        reader: &mut Reader,
        found: FoundFile,
        span: Span,
        words: &'static str,
    ) -> Option<Tree> {
        let FoundFile { shown, relative, bytes } = found;
        self.read += 1;
        if self.read > MOST_FILES {
            // One answer stands for all that follow.
            if self.read == MOST_FILES + 1 {
                reader.report(Diagnostic::new(
                    Code::TOO_MANY_FILES,
                    span,
                    format!("a pipeline is made of at most {MOST_FILES} files"),
                ));
            }
            return None;
        }
        if bytes.len() > LARGEST_FILE {
            let message = format!("`{shown}` has {} bytes; a file has at most {LARGEST_FILE}", bytes.len());
            reader.report(Diagnostic::new(Code::FILE_TOO_LARGE, span, message));
            return None;
        }
        let text: Arc<str> = match text_of(&bytes) {
            Ok(text) => text.into(),
            Err(why) => {
                let message = format!("`{shown}` is not a text file: {why}");
                reader.report(Diagnostic::new(Code::FILE_NOT_TEXT, span, message));
                return None;
            }
        };
        let file = self.sources.add(shown, &relative, text.clone());
        self.origins.add(file, span, words);
        if let Some(error) = no_pipeline(file, &text) {
            reader.report(error);
            return None;
        }
        Tree::read(file, text, &mut reader.errors)
    }
}

/// The paths that a list names, and where.
pub(crate) fn paths(reader: &mut Reader, list: Option<Leaf<'_>>, field: &str) -> Vec<(String, Span)> {
    let Some(leaves) = list.and_then(|list| reader.list(list, field)) else { return Vec::new() };
    leaves.into_iter().filter_map(|leaf| path(reader, leaf)).collect()
}

/// The path that stands there, and where.
pub(crate) fn path(reader: &mut Reader, leaf: Leaf<'_>) -> Option<(String, Span)> {
    reader.words(leaf, "the path of a file").map(|path| (path, leaf.span()))
}

/// Whether a file is written in the version of the language that this library reads. Reports another version, and no
/// other mistake.
pub(crate) fn version(reader: &mut Reader, all: Leaf<'_>) -> bool {
    let Some(version) = all.field("version") else { return true };
    match reader.integer(version) {
        Some(LANGUAGE_VERSION) => true,
        Some(number) => {
            let message = format!("this file is written in version {number} of the language");
            reader.wrong(Code::VERSION, version, message, &format!("this program reads version {LANGUAGE_VERSION}"));
            false
        }
        None => false,
    }
}

/// Reports files that name each other in a circle: those of `path` from number `first` on, each with the place that
/// names it, and then at `span` the first again. `verb` and `named` are the words for that: "include" and "included".
pub(crate) fn circle(
    reader: &mut Reader,
    path: &[(FilePath, Span)],
    first: usize,
    span: Span,
    (verb, named): (&str, &str),
) {
    let circle = &path[first..];
    let mut names: Vec<String> = circle.iter().map(|(path, _)| format!("`{path}`")).collect();
    names.extend(names.first().cloned());
    let message = format!("files {verb} each other in a circle: {}", names.join(" → "));
    let mut wrong = Diagnostic::new(Code::FILES_IN_CIRCLE, span, message);
    for (path, span) in &circle[1..] {
        wrong = wrong.label(*span, format!("`{path}` is {named} here"));
    }
    reader.report(wrong.help("one of them must do without the others"));
}
