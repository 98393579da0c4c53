//! Values of a file's tree, read one by one so that one mistake doesn't hide the next.

use super::node::{Kind, Node, Text};
use super::numbers::Number;
use super::{Spanned, Tree, escapes, numbers};
use crate::base::Span;
use std::borrow::Cow;

/// One value of a [`Tree`]. A handle, copied freely.
#[derive(Debug, Clone, Copy)]
pub struct Leaf<'t> {
    tree: &'t Tree,
    node: u32,
}

/// The shape of a value.
#[derive(Debug, Clone, Copy)]
pub enum Shape<'t> {
    /// `"text"`
    Text,
    /// `1`, `-0.5`
    Number,
    /// `Word` or `Word(…)`, with the parentheses by themselves.
    Word(&'t str, Option<Leaf<'t>>),
    /// `(…)`
    Parentheses,
    /// `[…]`
    List,
    /// `{…}`
    Map,
    /// Bytes and characters, which a pipeline has no use for.
    Other,
}

impl Shape<'_> {
    /// The name in messages.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Shape::Text => "a text in quotes".to_owned(),
            Shape::Number => "a number".to_owned(),
            Shape::Word(word @ ("true" | "false"), None) => format!("`{word}`"),
            Shape::Word(word, None) => format!("the word `{word}`"),
            Shape::Word(word, Some(_)) => format!("`{word}(…)`"),
            Shape::Parentheses => "`(…)`".to_owned(),
            Shape::List => "a list".to_owned(),
            Shape::Map => "a map".to_owned(),
            Shape::Other => "something else".to_owned(),
        }
    }
}

impl<'t> Leaf<'t> {
    pub(crate) const fn new(tree: &'t Tree, node: u32) -> Leaf<'t> {
        Leaf { tree, node }
    }

    fn node(self) -> Node {
        self.tree.nodes[self.node as usize]
    }

    /// The text that it stands in.
    pub(crate) fn home(self) -> &'t Text {
        &self.tree.texts[self.node().text as usize]
    }

    /// The number of its node.
    pub(crate) const fn at(self) -> u32 {
        self.node
    }

    /// Itself and all that is in it, in the order of nodes.
    pub(crate) fn nodes(self) -> &'t [Node] {
        &self.tree.nodes[self.node as usize..self.node().after as usize]
    }

    /// The texts without escapes that are in it.
    pub(crate) fn texts(self) -> impl Iterator<Item = &'t str> {
        (self.node..self.node().after).filter_map(move |node| Leaf::new(self.tree, node).plain())
    }

    /// The shape.
    #[must_use]
    pub fn shape(self) -> Shape<'t> {
        match self.node().kind {
            Kind::Text | Kind::Escaped | Kind::Raw => Shape::Text,
            Kind::Number => Shape::Number,
            Kind::Word => Shape::Word(self.text(), None),
            Kind::Named => {
                let word = Leaf::new(self.tree, self.node + 1);
                Shape::Word(word.text(), Some(Leaf::new(self.tree, self.node + 2)))
            }
            Kind::Fields | Kind::Tuple => Shape::Parentheses,
            Kind::List => Shape::List,
            Kind::Map => Shape::Map,
            Kind::Other | Kind::Broken => Shape::Other,
        }
    }

    /// Whether it could not be read, which was reported already.
    #[must_use]
    pub fn is_broken(self) -> bool {
        self.node().kind == Kind::Broken
    }

    /// The text of the whole value, as it stands in the file.
    #[must_use]
    pub fn text(self) -> &'t str {
        let Node { start, end, .. } = self.node();
        &self.home().text[start as usize..end as usize]
    }

    /// The bytes of its text.
    fn length(self) -> usize {
        let Node { start, end, .. } = self.node();
        (end - start) as usize
    }

    /// Where it stands.
    #[must_use]
    pub fn span(self) -> Span {
        let Node { start, end, .. } = self.node();
        Span::new(self.home().file, start, end)
    }

    /// Where it begins: its first character.
    #[must_use]
    pub fn start(self) -> Span {
        let text = self.text();
        self.span_of(&text[..text.chars().next().map_or(0, char::len_utf8)])
    }

    /// Where a part of [`text`](Leaf::text) stands. Only addresses are compared.
    #[must_use]
    pub fn span_of(self, part: &str) -> Span {
        let node = self.node();
        let before = (part.as_ptr() as usize).saturating_sub(self.text().as_ptr() as usize);
        let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX).min(node.end);
        let start = node.start as usize + before;
        Span::new(self.home().file, offset(start), offset(start + part.len()))
    }

    /// A value with its place.
    pub(crate) fn spanned<T>(self, value: T) -> Spanned<T> {
        Spanned { value, span: self.span() }
    }

    /// The text between the quotes, if this is a text without escapes.
    #[must_use]
    pub fn plain(self) -> Option<&'t str> {
        let text = self.text();
        match self.node().kind {
            Kind::Text => text.get(1..text.len() - 1),
            Kind::Raw => {
                let hashes = text.bytes().skip(1).take_while(|byte| *byte == b'#').count();
                text.get(hashes + 2..text.len() - hashes - 1)
            }
            _ => None,
        }
    }

    /// The text between the quotes with its escapes undone, if this is a text.
    #[must_use]
    pub fn words(self) -> Option<Cow<'t, str>> {
        if self.node().kind != Kind::Escaped {
            return self.plain().map(Cow::Borrowed);
        }
        let text = self.text();
        escapes::undo(text.get(1..text.len() - 1)?).ok().map(Cow::Owned)
    }

    /// The number, if this is a number.
    #[must_use]
    pub fn number(self) -> Option<Number> {
        if self.node().kind == Kind::Number { numbers::parse(self.text()) } else { None }
    }

    /// The values in `[…]` or in `(…)` without names of fields, in file order.
    #[must_use]
    pub fn values(self) -> Option<impl Iterator<Item = Leaf<'t>>> {
        matches!(self.node().kind, Kind::List | Kind::Tuple).then(|| self.children())
    }

    /// The values of `(…)` if there are exactly `N`.
    #[must_use]
    pub fn tuple<const N: usize>(self) -> Option<[Leaf<'t>; N]> {
        if self.node().kind != Kind::Tuple {
            return None;
        }
        let mut values = self.children();
        let mut tuple = [self; N];
        for slot in &mut tuple {
            *slot = values.next()?;
        }
        values.next().is_none().then_some(tuple)
    }

    /// Names and values of the fields in `(…)` or `Word(…)`, in file order. `()` has none.
    #[must_use]
    pub fn fields(self) -> Option<impl Iterator<Item = (Leaf<'t>, Leaf<'t>)>> {
        match self.node() {
            Node { kind: Kind::Named, .. } => Leaf::new(self.tree, self.node + 2).own_fields(),
            _ => self.own_fields(),
        }
    }

    fn own_fields(self) -> Option<Pairs<'t>> {
        let node = self.node();
        let empty = node.kind == Kind::Tuple && node.after == self.node + 1;
        (empty || node.kind == Kind::Fields).then(|| Pairs(self.children()))
    }

    /// The value of the field called `name`, if there is one.
    #[must_use]
    pub fn field(self, name: &str) -> Option<Leaf<'t>> {
        let is_named = |field: Leaf<'t>| field.length() == name.len() && field.text() == name;
        self.fields()?.find_map(|(field, value)| is_named(field).then_some(value))
    }

    /// Keys and values of `{…}` in file order, doubles included.
    #[must_use]
    pub fn entries(self) -> Option<impl Iterator<Item = (Leaf<'t>, Leaf<'t>)>> {
        (self.node().kind == Kind::Map).then(|| Pairs(self.children()))
    }

    fn children(self) -> Children<'t> {
        Children { tree: self.tree, at: self.node + 1, after: self.node().after }
    }
}

struct Children<'t> {
    tree: &'t Tree,
    at: u32,
    after: u32,
}

impl<'t> Iterator for Children<'t> {
    type Item = Leaf<'t>;

    fn next(&mut self) -> Option<Leaf<'t>> {
        if self.at >= self.after {
            return None;
        }
        let leaf = Leaf::new(self.tree, self.at);
        self.at = leaf.node().after;
        Some(leaf)
    }
}

struct Pairs<'t>(Children<'t>);

impl<'t> Iterator for Pairs<'t> {
    type Item = (Leaf<'t>, Leaf<'t>);

    fn next(&mut self) -> Option<(Leaf<'t>, Leaf<'t>)> {
        Some((self.0.next()?, self.0.next()?))
    }
}
