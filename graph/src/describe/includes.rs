//! `include`: files with fragments, each read once however often it is named.

use super::fragments::LibraryFields;
use super::leaf::Leaf;
use super::origins::Origins;
use super::reader::Reader;
use super::textures::{self, Pictures};
use super::tree::Tree;
use super::{Diagnostic, LANGUAGE_VERSION, LARGEST_FILE};
use crate::source::{Sources, Span};
use crate::texture::{TextureFile, TextureInfo, TextureProblem};
use std::collections::HashSet;
use std::sync::Arc;

/// A pipeline is made of at most this many files.
const MOST_FILES: usize = 256;

/// Where files come from that a pipeline names. Whoever implements it decides which may be read.
pub trait Files {
    /// Reads a file. `from` is the [`Found::relative`] of the file that names it, and `path` what stands there.
    ///
    /// # Errors
    /// Why it can't be read.
    fn read(&mut self, from: &str, path: &str) -> Result<Found, Unread>;

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
pub struct Unread {
    /// A sentence without final stop.
    pub why: String,
    /// What to do.
    pub help: Option<String>,
}

impl From<String> for Unread {
    fn from(why: String) -> Unread {
        Unread { why, help: None }
    }
}

/// A file that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// As it is shown in diagnostics.
    pub shown: String,
    /// The path from the pipeline's own folder: it stands in Plans, and the same path is the same file.
    pub relative: String,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// No files: a pipeline that names any is wrong.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoFiles;

impl Files for NoFiles {
    fn read(&mut self, _: &str, path: &str) -> Result<Found, Unread> {
        Err(format!("`{path}` can't be read: this pipeline was given as a text by itself").into())
    }
}

/// What reads a pipeline's files.
pub(super) struct Included<'a> {
    sources: &'a mut Sources,
    files: &'a mut dyn Files,
    known: HashSet<String>,
    /// Files that are being read, and where each is named.
    path: Vec<(String, Span)>,
    /// What was read, each file after those that it includes.
    pub(super) trees: Vec<Tree>,
    /// Where each file is included.
    pub(super) origins: Origins,
    /// The pictures that textures name.
    pub(super) pictures: Pictures,
}

impl<'a> Included<'a> {
    /// Nothing yet but the pipeline's own file.
    pub(super) fn new(sources: &'a mut Sources, files: &'a mut dyn Files, relative: &str) -> Self {
        let known = HashSet::from([relative.to_owned()]);
        let path = vec![(relative.to_owned(), Span::NONE)];
        let (trees, origins, pictures) = (Vec::new(), Origins::default(), Pictures::new());
        Included { sources, files, known, path, trees, origins, pictures }
    }

    /// Looks at the pictures that a list of textures names.
    pub(super) fn pictures(&mut self, reader: &mut Reader, textures: Option<Leaf<'_>>) {
        textures::look(reader, self.sources, self.files, textures, &mut self.pictures);
    }

    /// Reads the files that a list names, and those that they name.
    pub(super) fn list(&mut self, reader: &mut Reader, list: Option<Leaf<'_>>) {
        let Some(leaves) = list.and_then(|list| reader.list(list, "`include`")) else { return };
        let named: Vec<(String, Span)> = leaves
            .into_iter()
            .filter_map(|leaf| reader.words(leaf, "the path of a file").map(|path| (path, leaf.span())))
            .collect();
        for (path, span) in named {
            self.file(reader, &path, span);
        }
    }

    fn file(&mut self, reader: &mut Reader, path: &str, span: Span) {
        let from = self.path.last().map_or("", |(from, _)| from).to_owned();
        let found = match self.files.read(&from, path) {
            Ok(found) => found,
            Err(Unread { why, help }) => {
                reader.report(Diagnostic { help, ..Diagnostic::new(span, why) });
                return;
            }
        };
        if let Some(first) = self.path.iter().position(|(outer, _)| *outer == found.relative) {
            self.circle(reader, first, span);
            return;
        }
        if !self.known.insert(found.relative.clone()) {
            return;
        }
        if self.known.len() > MOST_FILES {
            reader.report(Diagnostic::new(span, format!("a pipeline is made of at most {MOST_FILES} files")));
            return;
        }
        let Some(tree) = self.tree(reader, found.shown, &found.relative, found.bytes, span) else { return };
        if let Some(version) = tree.root().field("version") {
            match reader.integer(version) {
                Some(LANGUAGE_VERSION) => {}
                Some(number) => {
                    let message = format!("this file is written in version {number} of the language");
                    reader.wrong(version, message, &format!("this program reads version {LANGUAGE_VERSION}"));
                    return;
                }
                None => return,
            }
        }
        let library: Option<LibraryFields<'_>> = reader.read(tree.root(), "a file of fragments");
        let include = library.and_then(|library| library.include);
        self.path.push((found.relative, span));
        self.list(reader, include);
        self.path.pop();
        self.pictures_of_fragments(reader, tree.root());
        self.trees.push(tree);
    }

    /// Looks at the pictures that the fragments of a file name.
    pub(super) fn pictures_of_fragments(&mut self, reader: &mut Reader, all: Leaf<'_>) {
        let fragments = all.field("fragments").and_then(Leaf::values);
        for textures in fragments.into_iter().flatten().filter_map(|fragment| fragment.field("textures")) {
            self.pictures(reader, Some(textures));
        }
    }

    fn tree(&mut self, reader: &mut Reader, shown: String, relative: &str, bytes: Vec<u8>, span: Span) -> Option<Tree> {
        if bytes.len() > LARGEST_FILE {
            let message = format!("`{shown}` has {} bytes; a file has at most {LARGEST_FILE}", bytes.len());
            reader.report(Diagnostic::new(span, message));
            return None;
        }
        let text = match String::from_utf8(bytes) {
            Ok(text) => text,
            Err(error) => {
                let message = format!("`{shown}` is not a text file: {}", super::odd_byte(&error));
                reader.report(Diagnostic::new(span, message));
                return None;
            }
        };
        let text: Arc<str> = text.into();
        let file = self.sources.add(shown, relative, text.clone());
        self.origins.add(file, span, "included here");
        if let Some(error) = super::no_pipeline(file, &text) {
            reader.report(error);
            return None;
        }
        Tree::read(file, text, &mut reader.errors)
    }

    fn circle(&self, reader: &mut Reader, first: usize, span: Span) {
        let circle = &self.path[first..];
        let mut names: Vec<String> = circle.iter().map(|(path, _)| format!("`{path}`")).collect();
        names.extend(names.first().cloned());
        let message = format!("files include each other in a circle: {}", names.join(" → "));
        let mut wrong = Diagnostic::new(span, message);
        for (path, span) in &circle[1..] {
            wrong = wrong.label(*span, format!("`{path}` is included here"));
        }
        reader.report(wrong.help("one of them must do without the others"));
    }
}
