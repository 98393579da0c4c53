//! A file's text as a tree: the values in their brackets, and their places.
//!
//! One pass over the text makes it (`syntax`); everything else reads it through [`Leaf`]s. It keeps no copies of the
//! text: a node is a kind and a range of bytes. Where a pipeline extends another, the trees of their files become one
//! (`extend`), whose nodes still stand where they were written.

use super::node::{Node, Text};
use super::{Leaf, syntax};
use crate::base::{Diagnostic, Span};
use std::sync::Arc;

/// The values of one file, or of several that were put together. Owns what it needs, so it outlives the reading.
#[derive(Debug, Clone)]
pub struct Tree {
    /// The texts that nodes stand in.
    pub(crate) texts: Vec<Text>,
    /// After each node come its children, then the node that follows it.
    pub(crate) nodes: Vec<Node>,
}

impl Tree {
    /// Reads the text of the file numbered `file`, which has less than 4 GiB. Mistakes are added to `errors`; where one
    /// left no doubt about how the text goes on, the tree holds the rest, so that other mistakes can be found too.
    pub fn read(file: u32, text: Arc<str>, errors: &mut Vec<Diagnostic>) -> Option<Tree> {
        let nodes = syntax::nodes(file, &text, errors)?;
        Some(Tree { texts: vec![Text { file, text }], nodes })
    }

    /// Whether one of its texts holds `words`.
    pub(crate) fn mentions(&self, words: &str) -> bool {
        self.texts.iter().any(|text| text.text.contains(words))
    }

    /// The text at `span`; empty if `span` is in none of its texts.
    pub(crate) fn text_at(&self, span: Span) -> &str {
        let here = |text: &&Text| span.file() == Some(text.file as usize);
        let text = self.texts.iter().find(here).map_or("", |text| &text.text);
        text.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// The file's one value.
    #[must_use]
    pub const fn root(&self) -> Leaf<'_> {
        Leaf::new(self, 0)
    }
}
