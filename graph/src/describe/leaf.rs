//! Pieces of the file's text that are values, read one by one so that one mistake doesn't hide the next.

use ron::value::RawValue;
use serde::Deserialize;
use serde::de::{self, Deserializer, MapAccess, Visitor};
use std::fmt;

/// The text of one value, without the blanks and comments around it. It is a slice of the file, so it knows its place.
#[derive(Debug, Clone, Copy)]
pub struct Leaf<'src>(
    /// The slice.
    pub &'src str,
);

/// What a value looks like, told by how it begins.
#[derive(Debug, Clone, Copy)]
pub enum Shape<'src> {
    /// `"text"`
    Text,
    /// `1`, `-0.5`
    Number,
    /// `Word` or `Word(…)`, split after the word.
    Word(&'src str, Option<Leaf<'src>>),
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
    /// What it is called in messages.
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

impl<'src> Leaf<'src> {
    /// What it looks like.
    #[must_use]
    pub fn shape(self) -> Shape<'src> {
        let text = self.0;
        match text.bytes().next() {
            Some(b'"') => Shape::Text,
            Some(b'r') if text[1..].trim_start_matches('#').starts_with('"') => Shape::Text,
            Some(b'b') if text[1..].starts_with(['"', '\'', 'r']) => Shape::Other,
            Some(b'0'..=b'9' | b'+' | b'-' | b'.') => Shape::Number,
            Some(b'(') => Shape::Parentheses,
            Some(b'[') => Shape::List,
            Some(b'{') => Shape::Map,
            _ => {
                let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
                let (word, rest) = text.split_at(end);
                let rest = rest.trim_start();
                match word {
                    "" => Shape::Other,
                    _ => Shape::Word(word, (!rest.is_empty()).then_some(Leaf(rest))),
                }
            }
        }
    }
}

impl<'de: 'src, 'src> Deserialize<'de> for Leaf<'src> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        <&RawValue>::deserialize(deserializer).map(|raw| Leaf(raw.trim().get_ron()))
    }
}

/// The entries of a map in file order, doubles included: a map type would merge them silently.
pub(super) struct Entries<'src>(pub(super) Vec<(Leaf<'src>, Leaf<'src>)>);

impl<'de: 'src, 'src> Deserialize<'de> for Entries<'src> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Pairs;
        impl<'de> Visitor<'de> for Pairs {
            type Value = Entries<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries<'de>, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(Pairs)
    }
}

/// A text without escapes borrows from the file; one with escapes can't.
pub(super) enum Text<'src> {
    /// As it stands in the file.
    Plain(&'src str),
    /// With its escapes undone.
    Escaped(String),
}

impl<'de: 'src, 'src> Deserialize<'de> for Text<'src> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AnyText;
        impl<'de> Visitor<'de> for AnyText {
            type Value = Text<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a text in quotes")
            }

            fn visit_borrowed_str<E: de::Error>(self, text: &'de str) -> Result<Text<'de>, E> {
                Ok(Text::Plain(text))
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Text<'de>, E> {
                Ok(Text::Escaped(text.to_owned()))
            }
        }
        deserializer.deserialize_str(AnyText)
    }
}
