//! The names that a pipeline's files mention, so that settings and facts that no file uses don't vary.
//!
//! Every reference to a setting or a fact stands in quotes. So a name that no string contains is certainly unused. A name
//! that only a description contains counts as used: then more variants are checked than necessary, never fewer.

use framewright_graph::base::Sources;
use std::collections::{BTreeSet, HashMap};

/// Pieces of names in the strings of all files, with how often they occur.
#[derive(Debug, Default)]
pub struct Mentions<'a> {
    pieces: HashMap<&'a str, usize>,
    /// Strings with numbers in them.
    numbers: Vec<&'a str>,
    /// The strings themselves.
    strings: BTreeSet<&'a str>,
    /// Whether a string has escapes, which aren't read: it may hold any name.
    hidden: bool,
}

impl<'a> Mentions<'a> {
    /// Everything that the files mention.
    #[must_use]
    pub fn of(sources: &'a Sources) -> Mentions<'a> {
        let mut mentions = Mentions::default();
        for file in (0..).map_while(|file| sources.file(file)) {
            mentions.text(&file.text);
        }
        mentions
    }

    /// Everything that one file mentions.
    #[must_use]
    pub fn of_text(text: &'a str) -> Mentions<'a> {
        let mut mentions = Mentions::default();
        mentions.text(text);
        mentions
    }

    /// Whether `name` may occur in at least `times` places. A `-` within it may be a minus: every piece must occur.
    #[must_use]
    pub fn may_hold(&self, name: &str, times: usize) -> bool {
        self.hidden || name.split('-').all(|piece| self.pieces.get(piece).is_some_and(|found| *found >= times))
    }

    /// All strings, each once.
    pub fn strings(&self) -> impl Iterator<Item = &'a str> {
        self.strings.iter().copied()
    }

    /// The numbers that stand in strings with `name`.
    pub fn numbers_beside(&self, name: &str) -> impl Iterator<Item = f64> {
        let with_it = self.numbers.iter().filter(move |text| words(text).any(|word| word == name));
        with_it.flat_map(|text| numbers(text))
    }

    /// The numbers that stand in strings with the whole name of a fact and a comparison.
    pub fn numbers_compared_with(&self, name: &str) -> impl Iterator<Item = f64> {
        let compared = self.numbers.iter().filter(|text| text.contains(['<', '>', '=']));
        compared.filter(move |text| text.contains(name)).flat_map(|text| numbers(text))
    }

    fn text(&mut self, text: &'a str) {
        let mut rest = text;
        while let Some(at) = rest.find(['"', '/', '\'']) {
            let before = &rest[..at];
            let from = &rest[at..];
            rest = if from.starts_with("//") {
                from.find('\n').map_or("", |end| &from[end..])
            } else if from.starts_with("/*") {
                after_comment(from)
            } else if from.starts_with('\'') {
                after_character(from)
            } else if let Some(inside) = from.strip_prefix('"') {
                let raw = before.trim_end_matches('#').ends_with('r');
                let fence = before.len() - before.trim_end_matches('#').len();
                if raw { self.raw_string(inside, fence) } else { self.string(inside) }
            } else {
                &from[1..]
            };
        }
    }

    fn raw_string(&mut self, from: &'a str, fence: usize) -> &'a str {
        let end = format!("\"{}", "#".repeat(fence));
        let length = from.find(&end).unwrap_or(from.len());
        self.words(&from[..length]);
        from.get(length + end.len()..).unwrap_or("")
    }

    fn string(&mut self, from: &'a str) -> &'a str {
        let mut at = 0;
        while let Some(next) = from[at..].find(['"', '\\']) {
            at += next;
            if from[at..].starts_with('"') {
                self.words(&from[..at]);
                return &from[at + 1..];
            }
            self.hidden = true;
            // The character after a backslash ends nothing.
            at += 1 + from[at + 1..].chars().next().map_or(0, char::len_utf8);
        }
        self.words(from);
        ""
    }

    fn words(&mut self, text: &'a str) {
        self.strings.insert(text);
        words(text).for_each(|piece| *self.pieces.entry(piece).or_default() += 1);
        if text.contains(|c: char| c.is_ascii_digit()) {
            self.numbers.push(text);
        }
    }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|piece| !piece.is_empty())
}

/// Numbers of an expression: `12`, `0.5`, `1e-3`. Digits within names are none.
fn numbers(text: &str) -> impl Iterator<Item = f64> {
    let mut rest = text;
    std::iter::from_fn(move || {
        loop {
            let at = rest.find(|c: char| c.is_alphanumeric() || c == '_')?;
            rest = &rest[at..];
            let mut exponent = false;
            let end = rest.find(|c: char| {
                let sign = matches!(c, '+' | '-') && exponent;
                exponent = matches!(c, 'e' | 'E') && rest.starts_with(|c: char| c.is_ascii_digit());
                !(c.is_alphanumeric() || matches!(c, '_' | '.') || sign)
            });
            let (word, after) = rest.split_at(end.unwrap_or(rest.len()));
            rest = after;
            if let Ok(number) = word.parse::<f64>()
                && word.starts_with(|c: char| c.is_ascii_digit())
            {
                return Some(number);
            }
        }
    })
}

/// The text after a comment, which may hold others.
fn after_comment(from: &str) -> &str {
    let mut depth = 0;
    let mut rest = from;
    loop {
        let Some(at) = rest.find("/*").into_iter().chain(rest.find("*/")).min() else { return "" };
        depth = if rest[at..].starts_with("/*") { depth + 1 } else { depth - 1 };
        rest = &rest[at + 2..];
        if depth == 0 {
            return rest;
        }
    }
}

/// The text after a character such as `'"'` or `'\''`; or a lone quote.
fn after_character(from: &str) -> &str {
    let mut characters = from.char_indices().skip(1);
    let escaped = characters.next().is_some_and(|(_, character)| character == '\\');
    if escaped {
        characters.next();
    }
    match characters.next() {
        Some((at, '\'')) => &from[at + 1..],
        _ => &from[1..],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str, name: &str, times: usize) -> bool {
        let mut sources = Sources::default();
        sources.add("a.ron", "a.ron", text.to_owned());
        Mentions::of(&sources).may_hold(name, times)
    }

    #[test]
    fn names_are_found_in_strings_and_nowhere_else() {
        let text = "// \"one\"\n(name: \"two\", three: r#\"a \"four\" b\"#, /* \"five\" /* */ \"six\" */ 'x', '\"', \"seven\")";
        for (name, there) in [
            ("one", false),
            ("two", true),
            ("three", false),
            ("four", true),
            ("five", false),
            ("six", false),
            ("seven", true),
            ("sev", false),
        ] {
            assert_eq!(found(text, name, 1), there, "{name}");
        }
    }

    #[test]
    fn a_name_is_found_within_an_expression_and_counted() {
        let text = "\"a-b\" \"!a && scene.has_sky\" \"min(a, 2)\"";
        assert!(found(text, "a", 3) && !found(text, "a", 4));
        assert!(found(text, "a-b", 1) && !found(text, "a-b", 2) && found(text, "has_sky", 1));
        assert!(!found(text, "a-c", 1));
    }

    #[test]
    fn numbers_of_expressions_are_found_and_those_in_names_are_not() {
        let all: Vec<f64> = numbers("a2 > 12 && b_3(0.5, -1e-3) + scene.x4 - 7e2 % 5").collect();
        assert_eq!(all, [12.0, 0.5, 0.001, 700.0, 5.0]);
        let mut sources = Sources::default();
        sources.add("a.ron", "a.ron", "\"x > 1\" 2 \"y > 3\" \"4 < x\"".to_owned());
        assert_eq!(Mentions::of(&sources).numbers_beside("x").collect::<Vec<_>>(), [1.0, 4.0]);
    }

    #[test]
    fn an_escaped_character_may_hide_any_name() {
        assert!(found(r#""\u{61}" "b""#, "anything", 9));
        assert!(!found(r#"r"\u{61}" "b""#, "anything", 1));
    }

    #[test]
    fn text_that_ends_within_something_ends_the_search() {
        for text in ["\"abc", "r#\"abc", "/* \"abc\"", "// \"abc\"", "'", "'\\", "\"a\\", "/", "r##\"a\"#"] {
            found(text, "abc", 1);
        }
    }
}
