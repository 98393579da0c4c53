//! Reads single values, and turns what goes wrong into mistakes with their place.

use super::leaf::{Entries, Leaf, Shape, Text};
use super::pipeline::{Name, Spanned};
use super::{Diagnostic, reword, suggest};
use crate::source::Span;
use serde::Deserialize;

/// A name has at most this many bytes.
const LONGEST_NAME: usize = 64;

/// After this many mistakes near names are no longer looked for: that would take long in a large file.
const MANY_MISTAKES: usize = 100;

/// Reads the values of one text and keeps what is wrong with them.
pub struct Reader<'src> {
    file: u32,
    text: &'src str,
    options: ron::Options,
    /// What was reported, in the order of reading.
    pub errors: Vec<Diagnostic>,
}

impl<'src> Reader<'src> {
    /// A reader of `text`, which is the file numbered `file`.
    #[must_use]
    pub fn new(file: u32, text: &'src str) -> Reader<'src> {
        let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        Reader { file, text, options, errors: Vec::new() }
    }

    /// Where a slice of the file's text stands. Only addresses are compared.
    pub fn span(&self, part: &str) -> Span {
        let start = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize).min(self.text.len());
        let end = (start + part.len()).min(self.text.len());
        let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Span::new(self.file, offset(start), offset(end))
    }

    /// Keeps a mistake.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.errors.push(diagnostic);
    }

    /// Reports `message` at `leaf`.
    pub fn wrong(&mut self, leaf: Leaf<'src>, message: impl Into<String>, help: &str) {
        let diagnostic = Diagnostic::new(self.span(leaf.0), message);
        self.report(if help.is_empty() { diagnostic } else { diagnostic.help(help) });
    }

    /// Reports that `leaf` has the wrong shape.
    pub fn expected(&mut self, leaf: Leaf<'src>, expected: &str) {
        let found = leaf.shape().words();
        self.wrong(leaf, format!("expected {expected}, found {found}"), "");
    }

    /// Reads a value as a whole, or reports why it can't be. `what` names it in messages: "pass `sky`".
    pub fn read<T: Deserialize<'src>>(&mut self, leaf: Leaf<'src>, what: &str) -> Option<T> {
        match self.options.from_str(leaf.0) {
            Ok(value) => Some(value),
            Err(error) => {
                let diagnostic = reword::reword(&error, leaf.0, what, |part| self.span(part));
                self.report(diagnostic);
                None
            }
        }
    }

    /// Reads a value without reporting anything.
    pub fn probe<T: Deserialize<'src>>(&self, leaf: Leaf<'src>) -> Option<T> {
        self.options.from_str(leaf.0).ok()
    }

    /// A name as it stands, without reporting anything.
    pub fn probe_name(&self, leaf: Leaf<'src>) -> Option<Name> {
        match (leaf.shape(), self.probe(leaf)?) {
            (Shape::Text, Text::Plain(text)) => Some(Name { text: text.into(), span: self.span(leaf.0) }),
            _ => None,
        }
    }

    /// A text in quotes, with or without escapes.
    pub fn words(&mut self, leaf: Leaf<'src>, what: &str) -> Option<String> {
        let Shape::Text = leaf.shape() else {
            self.expected(leaf, &format!("{what} in quotes"));
            return None;
        };
        match self.read(leaf, what)? {
            Text::Plain(text) => Some(text.to_owned()),
            Text::Escaped(text) => Some(text),
        }
    }

    /// A name that refers to something: quoted, not empty, without escapes and control characters.
    pub fn reference(&mut self, leaf: Leaf<'src>, what: &str) -> Option<Name> {
        let Shape::Text = leaf.shape() else {
            self.expected(leaf, &format!("the name of {what} in quotes"));
            return None;
        };
        let Text::Plain(text) = self.read(leaf, what)? else {
            self.wrong(leaf, "names take no escapes", "write the characters themselves");
            return None;
        };
        if text.is_empty() {
            self.wrong(leaf, format!("the name of {what} is empty"), "");
            return None;
        }
        if text.len() > LONGEST_NAME {
            let message = format!("the name of {what} has {} bytes; {LONGEST_NAME} are allowed", text.len());
            self.wrong(leaf, message, "");
            return None;
        }
        if let Some((at, control)) = text.char_indices().find(|(_, c)| c.is_control()) {
            let part = Leaf(&text[at..at + control.len_utf8()]);
            let message = format!("the name of {what} holds the control character {}", control.escape_unicode());
            self.wrong(part, message, "");
            return None;
        }
        Some(Name { text: text.into(), span: self.span(leaf.0) })
    }

    /// A name that is given to something: letters, digits, `_` and `-`, beginning with a letter or `_`.
    pub(super) fn name(&mut self, leaf: Leaf<'src>, what: &str) -> Option<Name> {
        let name = self.reference(leaf, what)?;
        let mut characters = name.text.chars();
        let first = characters.next().is_some_and(|c| c.is_alphabetic() || c == '_');
        if !first || characters.any(|c| !(c.is_alphanumeric() || c == '_' || c == '-')) {
            let message = format!("`{}` can't be the name of {what}", name.text);
            self.wrong(leaf, message, "names are letters, digits, `_` and `-`, and begin with a letter or `_`");
            return None;
        }
        if matches!(&*name.text, "scene" | "view" | "device" | "true" | "false") {
            let message = format!("`{}` is reserved and can't be the name of {what}", name.text);
            self.wrong(leaf, message, "");
            return None;
        }
        Some(name)
    }

    /// `Word` or `Word(…)`, one of `known`; `forms` shows them all.
    pub fn word(
        &mut self,
        leaf: Leaf<'src>,
        what: &str,
        known: &[&'static str],
        forms: &str,
    ) -> Option<(&'static str, Option<Leaf<'src>>)> {
        let Shape::Word(word, rest) = leaf.shape() else {
            let found = leaf.shape().words();
            self.wrong(leaf, format!("expected {what}, found {found}"), forms);
            return None;
        };
        if let Some(known) = known.iter().find(|known| **known == word) {
            return Some((known, rest));
        }
        let near = suggest::nearest(word, known.iter().copied());
        let help = near.map_or_else(|| forms.to_owned(), |near| format!("did you mean `{near}`?"));
        self.wrong(Leaf(&leaf.0[..word.len()]), format!("`{word}` is not {what}"), &help);
        None
    }

    /// A word that stands alone; `Word()` is accepted too.
    pub fn bare(&mut self, word: &str, rest: Option<Leaf<'src>>) -> Option<()> {
        let Some(rest) = rest else { return Some(()) };
        let inside = rest.0.trim_start_matches('(').trim_end_matches(')').trim();
        if inside.is_empty() {
            return Some(());
        }
        self.wrong(rest, format!("`{word}` takes nothing in parentheses"), "");
        None
    }

    /// What stands in the parentheses after a word.
    pub fn inside<T: Deserialize<'src>>(
        &mut self,
        leaf: Leaf<'src>,
        rest: Option<Leaf<'src>>,
        form: &str,
    ) -> Option<T> {
        let Some(rest) = rest else {
            let message = format!("`{}` needs something in parentheses", leaf.0);
            self.wrong(leaf, message, &format!("write `{form}`"));
            return None;
        };
        match self.options.from_str(rest.0) {
            Ok(value) => Some(value),
            Err(error) => {
                let diagnostic = reword::reword(&error, rest.0, &format!("`{form}`"), |part| self.span(part));
                let help = diagnostic.help.clone().unwrap_or_else(|| format!("write `{form}`"));
                self.report(diagnostic.help(help));
                None
            }
        }
    }

    /// Which name may have been meant, or the few that there are.
    pub fn known<'k>(&self, name: &str, known: impl IntoIterator<Item = &'k str> + Clone) -> Option<String> {
        if self.errors.len() > MANY_MISTAKES { None } else { suggest::help(name, known) }
    }

    /// The values of a list.
    pub fn list(&mut self, leaf: Leaf<'src>, what: &str) -> Option<Vec<Leaf<'src>>> {
        let Shape::List = leaf.shape() else {
            self.expected(leaf, &format!("{what}: a list `[…, …]`"));
            return None;
        };
        self.read(leaf, what)
    }

    /// The entries of a map.
    pub(super) fn map(&mut self, leaf: Leaf<'src>, what: &str) -> Option<Entries<'src>> {
        let Shape::Map = leaf.shape() else {
            self.expected(leaf, &format!("{what}: a map `{{\"name\": …, …}}`"));
            return None;
        };
        self.read(leaf, what)
    }

    /// `true` or `false`.
    pub fn truth(&mut self, leaf: Leaf<'src>) -> Option<bool> {
        match leaf.shape() {
            Shape::Word("true", None) => Some(true),
            Shape::Word("false", None) => Some(false),
            _ => {
                self.expected(leaf, "`true` or `false`");
                None
            }
        }
    }

    /// A finite number.
    pub fn number(&mut self, leaf: Leaf<'src>) -> Option<f64> {
        match leaf.shape() {
            Shape::Number => {}
            Shape::Word("NaN" | "inf", None) => {
                self.wrong(leaf, format!("expected a finite number, found `{}`", leaf.0), "");
                return None;
            }
            _ => {
                self.expected(leaf, "a number");
                return None;
            }
        }
        if matches!(leaf.0, "-inf" | "+inf" | "-NaN" | "+NaN") {
            self.wrong(leaf, format!("expected a finite number, found `{}`", leaf.0), "");
            return None;
        }
        let number: f64 = self.read(leaf, "number")?;
        if !number.is_finite() {
            self.wrong(leaf, "this number is too large", "64-bit floating point reaches about 1.8e308");
            return None;
        }
        Some(number)
    }

    /// A whole number.
    pub fn integer(&mut self, leaf: Leaf<'src>) -> Option<i64> {
        let Shape::Number = leaf.shape() else {
            self.expected(leaf, "a whole number");
            return None;
        };
        if leaf.0.contains(['.', 'e', 'E', 'i', 'N']) && !leaf.0.contains("0x") {
            self.wrong(leaf, format!("expected a whole number, found `{}`", leaf.0), "");
            return None;
        }
        self.read(leaf, "whole number")
    }

    /// A value with its place.
    pub(super) fn spanned<T>(&self, leaf: Leaf<'src>, value: T) -> Spanned<T> {
        Spanned { value, span: self.span(leaf.0) }
    }
}
