//! Holds what our reader makes of a text against what the `ron` crate makes of it.

use crate::tree::ours;
use framewright_graph::ron::{Leaf, Number, Shape};
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;

fn options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

/// The parts of a value as `ron` cuts them.
#[derive(Debug)]
enum Parts<'t> {
    None,
    Values(Vec<&'t str>),
    Fields(Vec<(String, &'t str)>),
}

impl<'de> Deserialize<'de> for Parts<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Cut;
        impl<'de> Visitor<'de> for Cut {
            type Value = Parts<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("brackets")
            }

            fn visit_unit<E>(self) -> Result<Parts<'de>, E> {
                Ok(Parts::None)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Parts<'de>, A::Error> {
                let mut parts = Vec::new();
                while let Some(value) = values.next_element::<&RawValue>()? {
                    parts.push(value.trim().get_ron());
                }
                Ok(Parts::Values(parts))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<Parts<'de>, A::Error> {
                let mut parts = Vec::new();
                while let Some((name, value)) = fields.next_entry::<String, &RawValue>()? {
                    parts.push((name, value.trim().get_ron()));
                }
                Ok(Parts::Fields(parts))
            }
        }
        deserializer.deserialize_any(Cut)
    }
}

/// The entries of a map as `ron` cuts them.
struct Entries<'t>(Vec<(&'t str, &'t str)>);

impl<'de> Deserialize<'de> for Entries<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Cut;
        impl<'de> Visitor<'de> for Cut {
            type Value = Entries<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries<'de>, A::Error> {
                let mut entries = Vec::new();
                while let Some((key, value)) = map.next_entry::<&RawValue, &RawValue>()? {
                    entries.push((key.trim().get_ron(), value.trim().get_ron()));
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(Cut)
    }
}

fn theirs<'t, T: Deserialize<'t>>(text: &'t str) -> T {
    options().from_str(text).unwrap_or_else(|error| panic!("{error}: {text:?}"))
}

/// Every value under `leaf` is what `ron` reads in the same text, and stands where `ron` finds it.
fn agree(leaf: Leaf<'_>) {
    let text = leaf.text();
    match leaf.shape() {
        Shape::Text => assert_eq!(leaf.words().as_deref(), Some(&*theirs::<String>(text))),
        Shape::Number => match leaf.number() {
            Some(Number::Whole(number)) => assert_eq!(number, theirs::<i64>(text), "{text}"),
            Some(Number::Real(number)) => assert_eq!(number, theirs::<f64>(text), "{text}"),
            Some(Number::Huge(number)) if number.is_finite() => assert_eq!(number, theirs::<f64>(text), "{text}"),
            Some(Number::Huge(_)) => {}
            Some(Number::NotFinite) => assert!(!theirs::<f64>(text).is_finite(), "{text}"),
            None => panic!("`{text}` is a number without value"),
        },
        Shape::Word("Some", _) => leaf.values().into_iter().flatten().for_each(agree),
        Shape::Word(word, rest) => {
            assert!(text.starts_with(word));
            rest.into_iter().for_each(agree);
        }
        Shape::List => {
            let same: Vec<&str> = leaf.values().expect("a list").map(Leaf::text).collect();
            assert_eq!(same, theirs::<Vec<&RawValue>>(text).iter().map(|raw| raw.trim().get_ron()).collect::<Vec<_>>());
            leaf.values().expect("a list").for_each(agree);
        }
        Shape::Parentheses => match (theirs::<Parts<'_>>(text), leaf.values()) {
            (Parts::None, Some(mut values)) => assert!(values.next().is_none(), "{text:?}"),
            (Parts::Values(parts), Some(values)) => {
                let values: Vec<Leaf<'_>> = values.collect();
                assert_eq!(values.iter().map(|value| value.text()).collect::<Vec<_>>(), parts, "{text:?}");
                values.into_iter().for_each(agree);
            }
            (Parts::Fields(parts), None) => {
                let fields: Vec<_> = leaf.fields().expect("fields").collect();
                let same = fields.iter().map(|(name, value)| (name.text().to_owned(), value.text()));
                assert_eq!(same.collect::<Vec<_>>(), parts, "{text:?}");
                fields.into_iter().for_each(|(_, value)| agree(value));
            }
            (parts, _) => panic!("{text:?} is {parts:?}"),
        },
        Shape::Map => {
            let entries: Vec<_> = leaf.entries().expect("a map").collect();
            let same: Vec<_> = entries.iter().map(|(key, value)| (key.text(), value.text())).collect();
            assert_eq!(same, theirs::<Entries<'_>>(text).0, "{text:?}");
            entries.into_iter().flat_map(|(key, value)| [key, value]).for_each(agree);
        }
        Shape::Other => {
            options().from_str::<IgnoredAny>(text).unwrap_or_else(|error| panic!("{error}: {text:?}"));
        }
    }
}

/// Whether `ron` has a rule here that we don't, or the other way round.
fn differ(text: &str) -> bool {
    let typed = |at: usize| {
        let before = text[..at].chars().next_back().is_some_and(|c| c.is_ascii_hexdigit() || matches!(c, '.' | '_'));
        before && text[at..].starts_with(['i', 'u', 'f'])
    };
    let exponent = |at: usize| {
        let before = text[..at].chars().next_back().is_some_and(|c| c.is_ascii_digit() || matches!(c, '.' | '_'));
        let after = text[at..].strip_prefix(['e', 'E']);
        before && after.is_some_and(|after| after.trim_start_matches(['+', '-']).starts_with('_'))
    };
    let bytes = text.match_indices('b').any(|(at, _)| text[at + 1..].starts_with(['"', '\'', 'r']));
    text.contains("..")
        || text.match_indices("r#").any(|(at, _)| !text[at + 2..].starts_with(['"', '#']))
        || text.contains("Some")
        || text.contains("inff")
        || text.contains("NaNf")
        || bytes
        || (0..text.len()).filter(|at| text.is_char_boundary(*at)).any(|at| typed(at) || exponent(at))
}

/// Both read a text, and in the same way, or neither does.
pub(crate) fn judge(text: &str) -> bool {
    let read = ours(text);
    let accepted = options().from_str::<IgnoredAny>(text);
    match (&read, &accepted) {
        (Ok(tree), Ok(_)) => agree(tree.root()),
        (Ok(_), Err(error)) => assert!(differ(text), "only we read {text:?}: {error}"),
        (Err(errors), Ok(_)) => assert!(differ(text), "only ron reads {text:?}: {}", errors[0].message),
        (Err(_), Err(_)) => {}
    }
    read.is_ok() && accepted.is_ok()
}
