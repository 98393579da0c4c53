//! The parts of a tree: nodes, and the texts that they stand in.

use std::sync::Arc;

/// A file's text.
#[derive(Debug, Clone)]
pub(crate) struct Text {
    /// The file's number in [`Sources`](crate::base::Sources).
    pub(crate) file: u32,
    pub(crate) text: Arc<str>,
}

/// A value, a word or a broken place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) start: u32,
    pub(crate) end: u32,
    /// The node after this one and all that is in it.
    pub(crate) after: u32,
    /// The text that it stands in: an index into [`Tree::texts`](super::Tree).
    pub(crate) text: u16,
    pub(crate) kind: Kind,
}

/// The kind of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
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
    /// A place that could not be read, which was reported.
    Broken,
}
