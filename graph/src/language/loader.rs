//! The texts of files that others name.

use super::includes::{Files, Found, Unread};
use super::origins::Origins;
use super::textures::{self, Pictures};
use crate::base::{Diagnostic, FilePath, Sources, Span};
use crate::frame::{TextureFile, TextureInfo, TextureProblem};
use crate::ron::{Leaf, Reader, Tree};
use std::collections::HashMap;
use std::sync::Arc;

/// The version of the language that this library reads.
pub const LANGUAGE_VERSION: i64 = 1;

/// A pipeline file has at most this many bytes (16 MiB).
pub const LARGEST_FILE: usize = 16 << 20;

/// A pipeline is made of at most this many files.
const MOST_FILES: usize = 256;

/// Its files name each other at most this often: each time one is read, to see which one it is.
const MOST_NAMED: usize = 1024;

/// Reads files, and keeps where each was named.
pub(super) struct Loader<'a> {
    sources: &'a mut Sources,
    files: &'a mut dyn Files,
    read: usize,
    named: usize,
    pub(super) origins: Origins,
    /// What was found out about pictures, each of which is opened once.
    looked: HashMap<TextureFile, Result<TextureInfo, TextureProblem>>,
    /// The pictures that textures name.
    pub(super) pictures: Pictures,
}

impl<'a> Loader<'a> {
    /// One that has read the pipeline's own file.
    pub(super) fn new(sources: &'a mut Sources, files: &'a mut dyn Files) -> Self {
        let (origins, looked, pictures) = (Origins::default(), HashMap::new(), Pictures::new());
        Loader { sources, files, read: 1, named: 0, origins, looked, pictures }
    }

    /// The file that the file `from` names `path`, at `span`.
    pub(super) fn find(&mut self, reader: &mut Reader, from: &FilePath, path: &str, span: Span) -> Option<Found> {
        self.named += 1;
        if self.named > MOST_NAMED {
            // One answer stands for all that follow.
            if self.named == MOST_NAMED + 1 {
                let message = format!("the files of a pipeline name others at most {MOST_NAMED} times");
                reader.report(Diagnostic::new(span, message).help("each file has to be named only once"));
            }
            return None;
        }
        let found = self.files.read(from, path);
        let wrong = |Unread { why, help, choice, .. }| Diagnostic { help, choice, ..Diagnostic::new(span, why) };
        found.map_err(|unread| reader.report(wrong(unread))).ok()
    }

    /// The text of a file that was named at `span`; `words` say what for: "included here".
    pub(super) fn tree(&mut self, reader: &mut Reader, found: Found, span: Span, words: &'static str) -> Option<Tree> {
        let Found { shown, relative, bytes } = found;
        self.read += 1;
        if self.read > MOST_FILES {
            // One answer stands for all that follow.
            if self.read == MOST_FILES + 1 {
                reader.report(Diagnostic::new(span, format!("a pipeline is made of at most {MOST_FILES} files")));
            }
            return None;
        }
        if bytes.len() > LARGEST_FILE {
            let message = format!("`{shown}` has {} bytes; a file has at most {LARGEST_FILE}", bytes.len());
            reader.report(Diagnostic::new(span, message));
            return None;
        }
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => {
                let message = format!("`{shown}` is not a text file: {}", odd_byte(&error));
                reader.report(Diagnostic::new(span, message));
                return None;
            }
        };
        let text: Arc<str> = text.into();
        let file = self.sources.add(shown, &relative, text.clone());
        self.origins.add(file, span, words);
        if let Some(error) = no_pipeline(file, &text) {
            reader.report(error);
            return None;
        }
        Tree::read(file, text, &mut reader.errors)
    }
}

impl Loader<'_> {
    /// Looks at the pictures that a list of textures names.
    pub(super) fn look(&mut self, reader: &mut Reader, textures: Option<Leaf<'_>>) {
        let Loader { sources, files, looked, pictures, .. } = self;
        let info = |file: &TextureFile| match looked.get(file) {
            Some(known) => known.clone(),
            None => looked.entry(file.clone()).insert_entry(files.picture(file)).get().clone(),
        };
        textures::look(reader, sources, info, textures, pictures);
    }

    /// Looks at the pictures that the fragments of a file name.
    pub(super) fn look_in_fragments(&mut self, reader: &mut Reader, all: Leaf<'_>) {
        let fragments = all.field("fragments").and_then(Leaf::values);
        for textures in fragments.into_iter().flatten().filter_map(|fragment| fragment.field("textures")) {
            self.look(reader, Some(textures));
        }
    }
}

/// The paths that a list names, and where.
pub(super) fn paths(reader: &mut Reader, list: Option<Leaf<'_>>, field: &str) -> Vec<(String, Span)> {
    let Some(leaves) = list.and_then(|list| reader.list(list, field)) else { return Vec::new() };
    leaves.into_iter().filter_map(|leaf| path(reader, leaf)).collect()
}

/// The path that stands there, and where.
pub(super) fn path(reader: &mut Reader, leaf: Leaf<'_>) -> Option<(String, Span)> {
    reader.words(leaf, "the path of a file").map(|path| (path, leaf.span()))
}

/// Whether a file is written in the version of the language that this library reads. That it isn't is reported, and
/// nothing else.
pub(super) fn version(reader: &mut Reader, all: Leaf<'_>) -> bool {
    let Some(version) = all.field("version") else { return true };
    match reader.integer(version) {
        Some(LANGUAGE_VERSION) => true,
        Some(number) => {
            let message = format!("this file is written in version {number} of the language");
            reader.wrong(version, message, &format!("this program reads version {LANGUAGE_VERSION}"));
            false
        }
        None => false,
    }
}

/// Reports files that name each other in a circle: those of `path` from number `first` on, each with the place that
/// names it, and then at `span` the first again. `verb` says what they do to each other, `named` what is done to one.
pub(super) fn circle(
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
    let mut wrong = Diagnostic::new(span, message);
    for (path, span) in &circle[1..] {
        wrong = wrong.label(*span, format!("`{path}` is {named} here"));
    }
    reader.report(wrong.help("one of them must do without the others"));
}

/// Which byte shows that this is no text.
pub(super) fn odd_byte(error: &std::string::FromUtf8Error) -> String {
    let at = error.utf8_error().valid_up_to();
    format!("byte {at} is 0x{:02X}, which is not UTF-8", error.as_bytes().get(at).copied().unwrap_or_default())
}

/// What shows at once that this is not a pipeline.
pub(super) fn no_pipeline(file: u32, text: &str) -> Option<Diagnostic> {
    let span = |start: usize, end: usize| {
        let [start, end] = [start, end].map(|at| u32::try_from(at).unwrap_or(u32::MAX));
        Span::new(file, start, end)
    };
    if text.trim().is_empty() {
        let empty = Diagnostic::new(span(0, text.len()), "the file is empty");
        return Some(empty.help("a pipeline begins with `Pipeline(version: 1,`"));
    }
    if let Some(at) = text.find('\0') {
        let zero = Diagnostic::new(span(at, at + 1), format!("this is not a text file: byte {at} is 0x00"));
        return Some(zero.help("a pipeline is RON text in UTF-8"));
    }
    let mark = text.starts_with('\u{feff}');
    let begins = || Diagnostic::new(span(0, 3), "the file begins with a byte order mark");
    mark.then(|| begins().help("save it as UTF-8 without one"))
}
