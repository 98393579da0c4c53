//! A file's text as a tree: what stands in which brackets, and where.
//!
//! One pass over the text makes it (`syntax`); everything else reads it through [`Leaf`]s. It keeps no copies of the
//! text: a node is a kind and a range of bytes.

use super::leaf::Leaf;
use super::{Diagnostic, syntax};
use std::sync::Arc;

/// The values of one file. Owns what it needs, so it outlives the reading.
#[derive(Debug, Clone)]
pub struct Tree {
    pub(super) file: u32,
    pub(super) text: Arc<str>,
    /// In the order of the text: after each node come its children, then whatever follows it.
    pub(super) nodes: Vec<Node>,
}

/// A value, a word or a broken place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub(super) start: u32,
    pub(super) end: u32,
    /// The node after this one and all that is in it.
    pub(super) after: u32,
    pub(super) kind: Kind,
}

/// What a node is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// `"text"` without escapes.
    Text,
    /// `"te\"xt"`
    Escaped,
    /// `r#"text"#`
    Raw,
    /// `1`, `-0.5`, `0xff`
    Number,
    /// `word`; also the name of a field.
    Word,
    /// `Word(…)`: a `Word`, then its `Fields` or `Tuple`.
    Named,
    /// `(name: value, …)`: names and values by turns.
    Fields,
    /// `(value, …)`
    Tuple,
    /// `[value, …]`
    List,
    /// `{key: value, …}`: keys and values by turns.
    Map,
    /// Bytes and characters.
    Other,
    /// What could not be read and was reported.
    Broken,
}

impl Tree {
    /// Reads the text of the file numbered `file`, which has less than 4 GiB. Mistakes are added to `errors`; where one
    /// left no doubt about how the text goes on, the tree holds the rest, so that other mistakes can be found too.
    pub fn read(file: u32, text: Arc<str>, errors: &mut Vec<Diagnostic>) -> Option<Tree> {
        let nodes = syntax::nodes(file, &text, errors)?;
        Some(Tree { file, text, nodes })
    }

    /// The file's one value.
    #[must_use]
    pub const fn root(&self) -> Leaf<'_> {
        Leaf::new(self, 0)
    }
}
