//! The program's own sources, as tokens: without tests.

use crate::render::in_repository;
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::fs::{read_dir, read_to_string};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The folders of sources that are no tests.
pub const FOLDERS: [&str; 9] = [
    "graph/src",
    "backend-vulkan/src",
    "passes/src",
    "framewright/src",
    "framewright/c/src",
    "framewright/lab/src",
    "framewright/viewer/src",
    "framewright/viewer/what-if/src",
    "cli/src",
];

/// An enumeration or set of flags that grows.
#[derive(Debug)]
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// What the paths begin with of the files in which the name means it.
    pub within: &'static str,
    /// What the paths begin with of the files that own it.
    pub owners: &'static [&'static str],
    /// How many other files name its variants.
    pub others: usize,
}

/// The enumerations.
pub const KINDS: [Kind; 5] = [
    Kind { name: "Work", within: "", owners: &["graph/src/frame/", "graph/src/plan/"], others: 32 },
    Kind { name: "Draw", within: "", owners: &["graph/src/frame/"], others: 14 },
    Kind { name: "Role", within: "graph/src/compile/", owners: &["graph/src/compile/model.rs"], others: 10 },
    Kind { name: "BindingKind", within: "", owners: &["graph/src/shader/", "graph/src/plan/"], others: 8 },
    Kind { name: "BufferRole", within: "", owners: &["graph/src/frame/"], others: 4 },
];

/// The sets of flags.
pub const FLAGS: [Kind; 2] = [
    Kind { name: "Stages", within: "", owners: &["graph/src/vulkan/", "graph/src/verify/"], others: 22 },
    Kind { name: "Accesses", within: "", owners: &["graph/src/vulkan/", "graph/src/verify/"], others: 11 },
];

impl Kind {
    /// Whether its name means it in the file at `path`, which isn't its owner.
    #[must_use]
    pub fn is_foreign_to(&self, path: &str) -> bool {
        path.starts_with(self.within) && !self.owners.iter().any(|owner| path.starts_with(owner))
    }
}

/// A source file.
#[derive(Debug)]
pub struct Source {
    /// Its path in the repository.
    pub path: String,
    /// Its text.
    pub text: String,
    /// What of it is no test.
    pub tokens: Vec<TokenTree>,
}

/// The sources below a folder of the checkout `root`, sorted by path.
///
/// # Panics
/// If a file can't be read, or is no Rust.
#[must_use]
pub fn below(root: &Path, folder: &str) -> Vec<Source> {
    let mut paths = Vec::new();
    list(&root.join(folder), &mut paths);
    paths.sort();
    let read = |path: PathBuf| {
        let text = read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let tokens = TokenStream::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let path = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().into_owned();
        Source { path, text, tokens: without_tests(tokens) }
    };
    paths.into_iter().map(read).collect()
}

/// All sources of this checkout.
#[must_use]
pub fn all() -> Vec<Source> {
    FOLDERS.into_iter().flat_map(|folder| below(&in_repository(""), folder)).collect()
}

fn list(folder: &Path, paths: &mut Vec<PathBuf>) {
    let entries = read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for path in entries.map(|entry| entry.expect("a folder is listed").path()) {
        if path.is_dir() {
            list(&path, paths);
        } else if path.extension().is_some_and(|end| end == "rs") {
            paths.push(path);
        }
    }
}

/// The tokens without what stands behind `#[cfg(test)]` up to the end of its item.
fn without_tests(tokens: TokenStream) -> Vec<TokenTree> {
    let mut kept = Vec::new();
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let hash = matches!(&token, TokenTree::Punct(punct) if punct.as_char() == '#');
        if hash && matches!(tokens.peek(), Some(TokenTree::Group(group)) if is_of_tests(&group.stream().to_string())) {
            let ends = |token: &TokenTree| match token {
                TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
                TokenTree::Punct(punct) => punct.as_char() == ';',
                TokenTree::Ident(_) | TokenTree::Literal(_) => false,
            };
            tokens.by_ref().find(ends);
        } else {
            kept.push(token);
        }
    }
    kept
}

fn is_of_tests(attribute: &str) -> bool {
    attribute.replace(' ', "") == "cfg(test)"
}

/// All tokens, those in groups too, one after the other; a group is the two tokens that enclose it, and what it holds.
pub fn flat(tokens: &[TokenTree], to: &mut Vec<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                to.push("(".to_owned());
                flat(&group.stream().into_iter().collect::<Vec<_>>(), to);
                to.push(")".to_owned());
            }
            TokenTree::Ident(_) | TokenTree::Punct(_) | TokenTree::Literal(_) => to.push(token.to_string()),
        }
    }
}
