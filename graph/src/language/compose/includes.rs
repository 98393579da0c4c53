//! `include`: files with fragments, each of which is read once, even if it is named twice.

use super::loader::{self, Loader};
use super::tables::LibraryFields;
use crate::base::{FilePath, Span};
use crate::ron::{Reader, Tree};
use std::collections::HashSet;

/// Files that a file wants included.
#[derive(Debug)]
pub(crate) struct WantedFiles {
    /// The path of the file that names them.
    pub(crate) from: FilePath,
    /// Their paths, and where each is named.
    pub(crate) paths: Vec<(String, Span)>,
}

/// The reader of included files.
pub(crate) struct IncludeReader<'l, 'a> {
    loader: &'l mut Loader<'a>,
    known: HashSet<FilePath>,
    /// Files that are being read, and where each is named.
    path: Vec<(FilePath, Span)>,
    /// Trees of the files that were read, each after those of files that it includes.
    trees: Vec<Tree>,
}

/// Reads the files that the files of a pipeline include, and the files that those include.
pub(crate) fn read(reader: &mut Reader, loader: &mut Loader<'_>, wanted: Vec<WantedFiles>) -> Vec<Tree> {
    let known = wanted.iter().map(|wanted| wanted.from.clone()).collect();
    let mut included = IncludeReader { loader, known, path: Vec::new(), trees: Vec::new() };
    for WantedFiles { from, paths } in wanted {
        included.path = vec![(from, Span::NONE)];
        included.files(reader, &paths);
    }
    included.trees
}

impl IncludeReader<'_, '_> {
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
