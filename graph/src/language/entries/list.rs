//! Lists of entries: the fields of each, and the names of all.

use crate::ron::{FromLeaf, Leaf, Name, Names, Reader, Shape};
use std::sync::Arc;

/// Tells the fields of each entry of a list apart, and keeps the entries' names.
pub(crate) fn entries<'t, T: FromLeaf<'t>>(
    reader: &mut Reader,
    list: Option<Leaf<'t>>,
    field: &str,
    what: &'static str,
    names: &mut Names,
) -> Vec<Option<T>> {
    let Some(list) = list else { return Vec::new() };
    let Some(leaves) = reader.list(list, field) else {
        // Any name may be in the list that couldn't be read.
        names.give(reader, None);
        return Vec::new();
    };
    names.reserve(leaves.len());
    leaves.into_iter().map(|leaf| entry(reader, leaf, what, what, names)).collect()
}

/// Tells the fields of an entry apart, and keeps its name.
pub(crate) fn entry<'t, T: FromLeaf<'t>>(
    reader: &mut Reader,
    leaf: Leaf<'t>,
    what: &str,
    shown: &str,
    names: &mut Names,
) -> Option<T> {
    let name = leaf.field("name").and_then(Name::written);
    let text = name.as_ref().map(|name| Arc::clone(&name.text));
    names.give(reader, name);
    if !matches!(leaf.shape(), Shape::Parentheses | Shape::Word(_, Some(_))) {
        reader.expected(leaf, &format!("the {what} as `(name: \"…\", …)`"));
        return None;
    }
    match text {
        Some(text) => reader.read(leaf, format_args!("{shown} `{text}`")),
        None => reader.read(leaf, format_args!("this {shown}")),
    }
}

/// The fields in the parentheses after a word; the defaults if there are no parentheses.
pub(crate) fn within<'src, T: FromLeaf<'src> + Default>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    rest: Option<Leaf<'src>>,
    form: &str,
) -> Option<T> {
    rest.map_or(Some(T::default()), |_| reader.inside(leaf, rest, form))
}
