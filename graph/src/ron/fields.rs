//! Values that have a fixed form: `(name: …, …)` with known fields, and `(…, …)` of a known length.

use super::{Leaf, MANY_MISTAKES, Row, Shape, Table};
use crate::base::{Code, Diagnostic, MOST_KEPT, keep, suggestion};
use std::fmt::Display;

/// A form that a value can have. [`fields!`](crate::fields) makes one of a struct.
pub trait FromLeaf<'t>: Sized {
    /// Tells the parts of `leaf` apart, or adds mistakes to `errors`. `what` names the value: "pass `sky`".
    fn from_leaf(leaf: Leaf<'t>, what: &dyn Display, errors: &mut Vec<Diagnostic>) -> Option<Self>;
}

/// A field's value, which may have to be there.
pub trait Field<'t>: Sized {
    /// Whether it has to be there.
    const REQUIRED: bool;

    /// The field of the value that was found. `None` if it is required and missing.
    fn of(found: Option<Leaf<'t>>) -> Option<Self>;
}

impl<'t> Field<'t> for Leaf<'t> {
    const REQUIRED: bool = true;

    fn of(found: Option<Leaf<'t>>) -> Option<Self> {
        found
    }
}

impl<'t> Field<'t> for Option<Leaf<'t>> {
    const REQUIRED: bool = false;

    /// `None` means a field that is left out, and `Some(…)` means the value in it.
    fn of(found: Option<Leaf<'t>>) -> Option<Self> {
        Some(match found.map(|leaf| (leaf, leaf.shape())) {
            None | Some((_, Shape::Word("None", None))) => None,
            Some((leaf, Shape::Word("Some", Some(inside)))) => Some(inside.tuple().map_or(leaf, |[inner]| inner)),
            Some((leaf, _)) => Some(leaf),
        })
    }
}

/// Makes a [`FromLeaf`] of a struct whose fields are [`Leaf`]s, or `Option<Leaf>`s where they may be left out. The word
/// behind `as` may stand before the parentheses. What stands behind `=>` is the [`Form`](super::Form) of the field's
/// value; with the documentation it becomes the struct's [`Table`](super::Table).
#[macro_export]
macro_rules! fields {
    (
        $(#[doc = $about:literal])*
        $(#[derive($($derive:path),*)])?
        $visible:vis struct $struct:ident<$t:lifetime> $(as $word:literal)? {
            $(
                $(#[doc = $note:literal])*
                $(#[expect($($expect:tt)*)])?
                $field_visible:vis $field:ident: $type:ty $(=> $form:expr)?,
            )*
        }
    ) => {
        $(#[doc = $about])*
        $(#[derive($($derive),*)])?
        $visible struct $struct<$t> {
            $($(#[doc = $note])* $(#[expect($($expect)*)])? $field_visible $field: $type,)*
        }

        impl<$t> $crate::ron::FieldTable for $struct<$t> {
            const TABLE: $crate::ron::Table = {
                use $crate::ron::{Field, Form, Leaf, Row, Table};
                let word: &[&'static str] = &[$($word)?];
                Table {
                    name: stringify!($struct),
                    word: word.first().copied(),
                    about: &[$($about),*],
                    rows: &[$(Row {
                        name: $crate::ron::plain_name(stringify!($field)),
                        needed: <$type as Field<$t>>::REQUIRED,
                        about: &[$($note),*],
                        form: [$($form,)? Form::Anything][0],
                    }),*],
                }
            };
        }

        impl<$t> $crate::ron::FromLeaf<$t> for $struct<$t> {
            fn from_leaf(
                leaf: $crate::ron::Leaf<$t>,
                what: &dyn ::std::fmt::Display,
                errors: &mut ::std::vec::Vec<$crate::base::Diagnostic>,
            ) -> ::std::option::Option<Self> {
                use $crate::ron::{FieldTable, Field, Leaf, slots};
                let mut found: [Option<Leaf<$t>>; [$(stringify!($field)),*].len()] = [None; [$(stringify!($field)),*].len()];
                slots(leaf, what, &<Self as FieldTable>::TABLE, &mut found, errors)?;
                let mut found = found.into_iter();
                Some($struct { $($field: Field::of(found.next().flatten())?),* })
            }
        }
    };
}

/// The name of a field whose name is a word of Rust's: `r#use` is `use`.
#[must_use]
pub const fn plain_name(name: &'static str) -> &'static str {
    match name.as_bytes() {
        [b'r', b'#', ..] => name.split_at(2).1,
        _ => name,
    }
}

/// Sorts the fields of `leaf` into the places of those that are known.
pub fn slots<'t>(
    leaf: Leaf<'t>,
    what: &dyn Display,
    known: &Table,
    found: &mut [Option<Leaf<'t>>],
    errors: &mut Vec<Diagnostic>,
) -> Option<()> {
    if leaf.is_broken() {
        return None;
    }
    if let Shape::Word(word, parentheses) = leaf.shape() {
        let wrong = match known.word {
            Some(right) if right != word && parentheses.is_some() => {
                Some(format!("expected `{right}(…)`, found `{word}`"))
            }
            Some(right) if parentheses.is_none() => Some(format!("expected `{right}(…)`")),
            None => Some(format!("expected `(`, found `{word}`")),
            Some(_) => None,
        };
        if let Some(wrong) = wrong {
            keep(errors, written(Diagnostic::new(Code::WRONG_SHAPE, leaf.span_of(word), wrong), what, known));
            return None;
        }
    }
    let Some(fields) = leaf.fields() else {
        let error = match (leaf.shape(), known.word) {
            (Shape::Parentheses | Shape::Word(..), _) => {
                let first = match leaf.shape() {
                    Shape::Word(_, Some(parentheses)) => parentheses,
                    _ => leaf,
                };
                let at = first.values().and_then(|mut values| values.next()).unwrap_or(leaf);
                Diagnostic::new(Code::WRONG_SHAPE, at.span(), "expected the name of a field")
            }
            (_, Some(word)) => Diagnostic::new(Code::WRONG_SHAPE, leaf.start(), format!("expected `{word}(…)`")),
            (_, None) => written(Diagnostic::new(Code::WRONG_SHAPE, leaf.start(), "expected `(`"), what, known),
        };
        keep(errors, error);
        return None;
    };
    sort(fields, what, known, found, errors)?;
    let missing = known.rows.iter().zip(&*found).filter(|(row, found)| row.needed && found.is_none());
    let mut missing: Vec<String> = missing.map(|(row, _)| format!("`{}`", row.name)).collect();
    let last = match missing.pop() {
        None => return Some(()),
        Some(only) if missing.is_empty() => format!("field {only}"),
        Some(last) => format!("fields {} and {last}", missing.join(", ")),
    };
    keep(errors, Diagnostic::new(Code::FIELD_MISSING, leaf.start(), format!("{what} lacks the {last}")));
    None
}

fn written(error: Diagnostic, what: &dyn Display, known: &Table) -> Diagnostic {
    match known.word {
        Some(_) => error,
        None => error.help(format!("{what} is written `(field: value, …)`")),
    }
}

/// Reports every field that is not known or stands twice.
fn sort<'t>(
    fields: impl Iterator<Item = (Leaf<'t>, Leaf<'t>)>,
    what: &dyn Display,
    known: &Table,
    found: &mut [Option<Leaf<'t>>],
    errors: &mut Vec<Diagnostic>,
) -> Option<()> {
    let mut right = true;
    // Fields usually stand in the order of the table: the row behind the last one is compared first.
    let mut next = 0;
    for (name, value) in fields {
        // Fields after the last mistake that is kept aren't looked at.
        if errors.len() >= MOST_KEPT {
            return None;
        }
        let text = name.text();
        let (before, after) = known.rows.split_at(next);
        let is_named = |row: &Row| row.name == text;
        let place = after.iter().position(is_named).map(|at| next + at).or_else(|| before.iter().position(is_named));
        next = place.map_or(next, |place| place + 1);
        let error = match place.and_then(|place| found.get_mut(place)) {
            _ if name.is_broken() => None,
            None => {
                let few = errors.len() <= MANY_MISTAKES;
                let help = few.then(|| suggestion(text, known.rows.iter().map(|row| row.name))).flatten();
                let unknown =
                    Diagnostic::new(Code::UNKNOWN_FIELD, name.span(), format!("{what} has no field `{text}`"));
                Some(Diagnostic { help, ..unknown })
            }
            Some(slot @ None) => {
                *slot = Some(value);
                continue;
            }
            Some(Some(_)) => {
                Some(Diagnostic::new(Code::FIELD_TWICE, name.span(), format!("{what} has the field `{text}` twice")))
            }
        };
        error.into_iter().for_each(|error| keep(errors, error));
        right = false;
    }
    right.then_some(())
}

impl<'t, const N: usize> FromLeaf<'t> for [Leaf<'t>; N] {
    fn from_leaf(leaf: Leaf<'t>, what: &dyn Display, errors: &mut Vec<Diagnostic>) -> Option<Self> {
        let tuple = leaf.tuple();
        if tuple.is_none() && !leaf.is_broken() {
            let found = match (leaf.shape(), leaf.values()) {
                (Shape::Parentheses, Some(found)) => match found.count() {
                    1 => "1 value".to_owned(),
                    several => format!("{several} values"),
                },
                (Shape::Parentheses, None) => "names of fields".to_owned(),
                (found, _) => found.words(),
            };
            let error = format!("expected {what}, found {found}");
            keep(errors, Diagnostic::new(Code::WRONG_SHAPE, leaf.span(), error));
        }
        tuple
    }
}
