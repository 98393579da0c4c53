//! An entry of a list while files change it: a setting, an image, a pass.

use super::keyed_fields::KeyedFields;
use crate::base::Span;
use crate::ron::{Leaf, Name, Shape};
use std::borrow::Cow;

/// An entry.
pub(crate) struct Entry<'t> {
    pub(crate) leaf: Leaf<'t>,
    /// Its name; `None` if that can't be read, which will be reported.
    pub(crate) name: Option<PlacedName<'t>>,
    /// Its fields, once it was changed.
    pub(crate) fields: Option<KeyedFields<'t, Value<'t>>>,
}

/// A name with its place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlacedName<'t> {
    pub(crate) text: &'t str,
    pub(crate) span: Span,
}

/// The value of a field.
pub(crate) enum Value<'t> {
    /// As it was written.
    Plain(Leaf<'t>),
    /// `{…}` with entries of several files; `of` is the first file's.
    Map { of: Leaf<'t>, entries: KeyedFields<'t, Leaf<'t>> },
    /// `Word(…)` with fields of several files; `of` is the first file's.
    Parts { of: Leaf<'t>, fields: KeyedFields<'t, Leaf<'t>> },
}

impl<'t> PlacedName<'t> {
    /// The name in quotes at `leaf`.
    pub(crate) fn of(leaf: Leaf<'t>) -> Option<PlacedName<'t>> {
        Some(PlacedName { text: leaf.plain()?, span: leaf.span() })
    }

    pub(crate) fn name(self) -> Name {
        Name { text: self.text.into(), span: self.span }
    }
}

impl<'t> Entry<'t> {
    /// An entry whose name stands in the field `name`.
    pub(crate) fn of(leaf: Leaf<'t>) -> Entry<'t> {
        Entry { leaf, name: leaf.field("name").and_then(PlacedName::of), fields: None }
    }

    pub(crate) fn fields(&mut self) -> &mut KeyedFields<'t, Value<'t>> {
        let written = || self.leaf.fields().into_iter().flatten().map(|(name, value)| (name, Value::Plain(value)));
        self.fields.get_or_insert_with(|| KeyedFields::new(written(), field))
    }

    /// Gives a field a value. The entries of a map come beside those that are there, or in place of those with the same
    /// keys; any other value takes the place of the whole.
    pub(crate) fn set(&mut self, name: Leaf<'t>, value: Leaf<'t>) {
        let fields = self.fields();
        let Some(there) = fields.find(name.text()) else {
            fields.put(name, Value::Plain(value), field);
            return;
        };
        let Some(new) = value.entries() else {
            *there = Value::Plain(value);
            return;
        };
        if let Value::Plain(of) = *there
            && let Some(entries) = of.entries()
        {
            *there = Value::Map { of, entries: KeyedFields::new(entries, Leaf::words) };
        }
        match there {
            Value::Map { entries, .. } => new.for_each(|(key, value)| entries.put(key, value, Leaf::words)),
            Value::Plain(_) | Value::Parts { .. } => *there = Value::Plain(value),
        }
    }

    /// Gives a field within the parentheses of the field `of` a value: `default` in `value: Bool(default: true)`. Whether
    /// there are such parentheses.
    pub(crate) fn set_part(&mut self, of: &str, name: Leaf<'t>, value: Leaf<'t>) -> bool {
        let Some(there) = self.fields().find(of) else { return false };
        if let Value::Plain(of) = *there
            && let (Shape::Word(_, Some(_)), Some(fields)) = (of.shape(), of.fields())
        {
            *there = Value::Parts { of, fields: KeyedFields::new(fields, field) };
        }
        let Value::Parts { fields, .. } = there else { return false };
        fields.put(name, value, field);
        true
    }

    /// Takes a field away. Whether it was there.
    pub(crate) fn take(&mut self, name: &str) -> bool {
        self.fields().take(name)
    }

    /// Texts without escapes that stand in it as it was written first.
    pub(crate) fn texts(&self) -> impl Iterator<Item = &'t str> + use<'t> {
        self.leaf.texts()
    }
}

/// The key of a field: its name.
fn field(name: Leaf<'_>) -> Option<Cow<'_, str>> {
    Some(name.text().into())
}
