//! `include`: files with fragments, each read once however often it is named.

use super::fragments::LibraryFields;
use super::loader::{self, Loader};
use crate::base::{FilePath, OutsideChoice, Span};
use crate::frame::{TextureFile, TextureInfo, TextureProblem};
use crate::ron::{Reader, Tree};
use std::collections::HashSet;

/// Where files come from that a pipeline names. Whoever implements it decides which may be read.
pub trait Files {
    /// Reads a file. `from` is the [`Found::relative`] of the file that names it, and `path` what stands there.
    ///
    /// # Errors
    /// Why it can't be read.
    fn read(&mut self, from: &FilePath, path: &str) -> Result<Found, Unread>;

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
    /// What can be chosen otherwise outside of all files.
    pub choice: Option<OutsideChoice>,
    /// Whether it is there, and the user has no right to read it: then nothing is wrong with the files.
    pub denied: bool,
}

impl From<String> for Unread {
    fn from(why: String) -> Unread {
        Unread { why, help: None, choice: None, denied: false }
    }
}

/// A file that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// As it is shown in diagnostics.
    pub shown: String,
    /// Which file it is: this stands in Plans.
    pub relative: FilePath,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// No files: a pipeline that names any is wrong.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoFiles;

impl Files for NoFiles {
    fn read(&mut self, _: &FilePath, path: &str) -> Result<Found, Unread> {
        Err(format!("`{path}` can't be read: this pipeline was given as a text by itself").into())
    }
}

/// Files that a file wants included.
#[derive(Debug)]
pub(super) struct Wanted {
    /// The path of the file that names them.
    pub(super) from: FilePath,
    /// Their paths, and where each is named.
    pub(super) paths: Vec<(String, Span)>,
}

/// What reads included files.
pub(super) struct Included<'l, 'a> {
    loader: &'l mut Loader<'a>,
    known: HashSet<FilePath>,
    /// Files that are being read, and where each is named.
    path: Vec<(FilePath, Span)>,
    /// What was read, each file after those that it includes.
    trees: Vec<Tree>,
}

/// Reads what the files of a pipeline want included, and what that includes.
pub(super) fn read(reader: &mut Reader, loader: &mut Loader<'_>, wanted: Vec<Wanted>) -> Vec<Tree> {
    let known = wanted.iter().map(|wanted| wanted.from.clone()).collect();
    let mut included = Included { loader, known, path: Vec::new(), trees: Vec::new() };
    for Wanted { from, paths } in wanted {
        included.path = vec![(from, Span::NONE)];
        included.files(reader, &paths);
    }
    included.trees
}

impl Included<'_, '_> {
    fn files(&mut self, reader: &mut Reader, paths: &[(String, Span)]) {
        for (path, span) in paths {
            self.file(reader, path, *span);
        }
    }

    fn file(&mut self, reader: &mut Reader, path: &str, span: Span) {
        let Some((from, _)) = self.path.last().cloned() else { return };
        let Some(found) = self.loader.find(reader, &from, path, span) else { return };
        if let Some(first) = self.path.iter().position(|(outer, _)| *outer == found.relative) {
            loader::circle(reader, &self.path, first, span, ("include", "included"));
            return;
        }
        if !self.known.insert(found.relative.clone()) {
            return;
        }
        let relative = found.relative.clone();
        let Some(tree) = self.loader.tree(reader, found, span, "included here") else { return };
        if !loader::version(reader, tree.root()) {
            return;
        }
        let library: Option<LibraryFields<'_>> = reader.read(tree.root(), "a file of fragments");
        let paths = loader::paths(reader, library.and_then(|library| library.include), "`include`");
        self.path.push((relative, span));
        self.files(reader, &paths);
        self.path.pop();
        self.loader.look_in_fragments(reader, tree.root());
        self.trees.push(tree);
    }
}
