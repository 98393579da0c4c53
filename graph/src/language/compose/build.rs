//! One tree of the entries of several files.

use super::draft::{Draft, LISTS, REPLACED};
use super::entry::{Entry, Value};
use crate::ron::node::{Kind as NodeKind, Node, Text};
use crate::ron::{Leaf, Shape, Tree};
use std::collections::HashMap;

/// A tree whose nodes stand in several texts.
struct Builder {
    /// The texts of the nodes; the first holds `words`.
    texts: Vec<Text>,
    words: String,
    /// Texts by their file's number.
    numbers: HashMap<u32, u16>,
    nodes: Vec<Node>,
}

/// The tree of the pipeline in `draft`; `base` is the pipeline that it began with.
pub(crate) fn tree(draft: &Draft<'_>, base: Leaf<'_>) -> Tree {
    let own = Text { file: u32::MAX, text: "".into() };
    let mut builder = Builder { texts: vec![own], words: String::new(), numbers: HashMap::new(), nodes: Vec::new() };
    let pipeline = builder.open(NodeKind::Named, base);
    builder.word("Pipeline");
    let fields = builder.open(NodeKind::Fields, base);
    if let Some(version) = base.field("version") {
        builder.word("version");
        builder.copy(version);
    }
    for (kind, section) in LISTS {
        if let Some(list) = draft.list(kind)
            && let Some(of) = list.written
        {
            builder.list(section.name, of, list.entries.iter().flatten());
        }
    }
    if let Some(of) = draft.passes_written {
        builder.list("passes", of, draft.passes.all());
    }
    if let Some(of) = draft.outputs_written {
        builder.list("outputs", of, draft.outputs.entries.iter().flatten());
    }
    for (section, leaf) in REPLACED.into_iter().zip(draft.replaced) {
        if let Some(leaf) = leaf {
            builder.word(section.name);
            builder.copy(leaf);
        }
    }
    builder.close(fields);
    builder.close(pipeline);
    builder.texts[0].text = builder.words.into();
    Tree { texts: builder.texts, nodes: builder.nodes }
}

impl Builder {
    /// The number of the text that `leaf` stands in.
    fn text(&mut self, leaf: Leaf<'_>) -> u16 {
        let home = leaf.home();
        *self.numbers.entry(home.file).or_insert_with(|| {
            self.texts.push(home.clone());
            // A pipeline is made of far fewer files.
            u16::try_from(self.texts.len() - 1).unwrap_or(u16::MAX)
        })
    }

    /// Begins a node that stands where `leaf` does.
    fn open(&mut self, kind: NodeKind, leaf: Leaf<'_>) -> usize {
        let text = self.text(leaf);
        let span = leaf.span();
        self.nodes.push(Node { start: span.start, end: span.end, after: 0, text, kind });
        self.nodes.len() - 1
    }

    /// The node ends with all that was added since.
    fn close(&mut self, node: usize) {
        self.nodes[node].after = place(self.nodes.len());
    }

    /// A word that no file need hold: it stands in a text of its own, the first.
    fn word(&mut self, word: &str) {
        let start = self.words.len();
        self.words.push_str(word);
        let [start, end, after] = [start, start + word.len(), self.nodes.len() + 1].map(place);
        self.nodes.push(Node { start, end, after, text: 0, kind: NodeKind::Word });
    }

    /// A value as it was written.
    fn copy(&mut self, leaf: Leaf<'_>) {
        let text = self.text(leaf);
        let (nodes, first) = (leaf.nodes(), leaf.at());
        let to = place(self.nodes.len());
        self.nodes.extend(nodes.iter().map(|node| Node { text, after: node.after - first + to, ..*node }));
    }

    fn pairs<'t>(&mut self, pairs: impl IntoIterator<Item = &'t (Leaf<'t>, Leaf<'t>)>) {
        for (key, value) in pairs {
            self.copy(*key);
            self.copy(*value);
        }
    }

    fn list<'e, 't: 'e>(&mut self, word: &str, of: Leaf<'t>, entries: impl IntoIterator<Item = &'e Entry<'t>>) {
        self.word(word);
        let list = self.open(NodeKind::List, of);
        entries.into_iter().for_each(|entry| self.entry(entry));
        self.close(list);
    }

    fn entry(&mut self, entry: &Entry<'_>) {
        let Some(fields) = &entry.fields else { return self.copy(entry.leaf) };
        // A word before the parentheses is a mistake that is still to be found.
        let named = matches!(entry.leaf.shape(), Shape::Word(_, Some(_))).then(|| {
            let named = self.open(NodeKind::Named, entry.leaf);
            self.first_word(entry.leaf);
            named
        });
        let node = self.open(NodeKind::Fields, entry.leaf);
        for (name, value) in fields.pairs() {
            self.copy(*name);
            match value {
                Value::Plain(value) => self.copy(*value),
                Value::Map { of, entries } => {
                    let map = self.open(NodeKind::Map, *of);
                    self.pairs(entries.pairs());
                    self.close(map);
                }
                Value::Parts { of, fields } => {
                    let named = self.open(NodeKind::Named, *of);
                    self.first_word(*of);
                    let parts = self.open(NodeKind::Fields, *of);
                    self.pairs(fields.pairs());
                    self.close(parts);
                    self.close(named);
                }
            }
        }
        self.close(node);
        if let Some(named) = named {
            self.close(named);
        }
    }

    /// The word before the parentheses of `leaf`.
    fn first_word(&mut self, leaf: Leaf<'_>) {
        let text = self.text(leaf);
        let after = place(self.nodes.len() + 1);
        self.nodes.extend(leaf.nodes().get(1).map(|word| Node { text, after, ..*word }));
    }
}

/// No more nodes than bytes in all texts.
fn place(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}
