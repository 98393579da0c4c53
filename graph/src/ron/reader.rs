//! Reads single values, and reports mistakes with their places.

use super::{FromLeaf, Leaf, Name, Number, Shape, Words};
use crate::base::{Code, Diagnostic, keep, nearest, suggestion};
use crate::vulkan::vulkans_name;
use std::fmt::Display;

/// A name has at most this many bytes.
const LONGEST_NAME: usize = 64;

/// After this many mistakes near names are no longer looked for: that would take long in a large file.
pub(crate) const MANY_MISTAKES: usize = 100;

/// Reads values and keeps the mistakes in them.
#[derive(Debug, Default)]
pub struct Reader {
    /// The mistakes, in the order of reading.
    pub errors: Vec<Diagnostic>,
}

impl Reader {
    /// Keeps a mistake, unless there are very many.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        keep(&mut self.errors, diagnostic);
    }

    /// Reports `message` at `leaf`, unless `leaf` couldn't be read anyway.
    pub fn wrong(&mut self, code: Code, leaf: Leaf<'_>, message: impl Into<String>, help: &str) {
        self.wrong_part(code, leaf, leaf.text(), message, help);
    }

    /// Reports `message` at a part of the text of `leaf`.
    pub(crate) fn wrong_part(
        &mut self,
        code: Code,
        leaf: Leaf<'_>,
        part: &str,
        message: impl Into<String>,
        help: &str,
    ) {
        if leaf.is_broken() {
            return;
        }
        let diagnostic = Diagnostic::new(code, leaf.span_of(part), message);
        self.report(if help.is_empty() { diagnostic } else { diagnostic.help(help) });
    }

    /// Reports that `leaf` has the wrong shape.
    pub fn expected(&mut self, leaf: Leaf<'_>, expected: &str) {
        let found = leaf.shape().words();
        self.wrong(Code::WRONG_SHAPE, leaf, format!("expected {expected}, found {found}"), "");
    }

    /// Tells the parts of a value apart, or reports why that can't be. `what` names it in messages: "pass `sky`".
    pub fn read<'t, T: FromLeaf<'t>>(&mut self, leaf: Leaf<'t>, what: impl Display) -> Option<T> {
        T::from_leaf(leaf, &what, &mut self.errors)
    }

    /// A text in quotes, with or without escapes.
    pub fn words(&mut self, leaf: Leaf<'_>, what: &str) -> Option<String> {
        let words = leaf.words();
        if words.is_none() {
            self.expected(leaf, &format!("{what} in quotes"));
        }
        words.map(|words| words.into_owned())
    }

    /// A name that refers to something: quoted, not empty, without escapes and control characters.
    pub fn reference(&mut self, leaf: Leaf<'_>, what: &str) -> Option<Name> {
        let Shape::Text = leaf.shape() else {
            self.expected(leaf, &format!("the name of {what} in quotes"));
            return None;
        };
        let Some(text) = leaf.plain() else {
            self.wrong(Code::NAME_FORM, leaf, "names take no escapes", "write the characters themselves");
            return None;
        };
        if text.is_empty() {
            self.wrong(Code::NAME_FORM, leaf, format!("the name of {what} is empty"), "");
            return None;
        }
        if text.len() > LONGEST_NAME {
            let message = format!("the name of {what} has {} bytes; {LONGEST_NAME} are allowed", text.len());
            self.wrong(Code::NAME_FORM, leaf, message, "");
            return None;
        }
        if let Some((at, control)) = text.char_indices().find(|(_, c)| c.is_control()) {
            let part = &text[at..at + control.len_utf8()];
            let message = format!("the name of {what} holds the control character {}", control.escape_unicode());
            self.wrong_part(Code::NAME_FORM, leaf, part, message, "");
            return None;
        }
        Some(Name { text: text.into(), span: leaf.span() })
    }

    /// A name that the file gives to something: letters, digits and `_`, beginning with a letter or `_`. Without `-`,
    /// which expressions need.
    pub(crate) fn name(&mut self, leaf: Leaf<'_>, what: &str) -> Option<Name> {
        self.made_of(leaf, what, |c| c == '_', "names are letters, digits and `_`, and begin with a letter or `_`")
    }

    /// The name of a shader, or of a callback of the program: a `-` is allowed too.
    pub(crate) fn outside_name(&mut self, leaf: Leaf<'_>, what: &str) -> Option<Name> {
        let form = "these names are letters, digits, `_` and `-`, and begin with a letter or `_`";
        self.made_of(leaf, what, |c| matches!(c, '_' | '-'), form)
    }

    fn made_of(&mut self, leaf: Leaf<'_>, what: &str, also: impl Fn(char) -> bool, form: &str) -> Option<Name> {
        let name = self.reference(leaf, what)?;
        let mut characters = name.text.chars();
        let first = characters.next().is_some_and(|c| c.is_alphabetic() || c == '_');
        if !first || characters.any(|c| !(c.is_alphanumeric() || also(c))) {
            self.wrong(Code::NAME_FORM, leaf, format!("`{}` can't be the name of {what}", name.text), form);
            return None;
        }
        if matches!(&*name.text, "scene" | "view" | "device" | "true" | "false") {
            let message = format!("`{}` is reserved and can't be the name of {what}", name.text);
            self.wrong(Code::NAME_FORM, leaf, message, "");
            return None;
        }
        Some(name)
    }

    /// `Word` or `Word(…)`, one of `known`; `forms` shows them all.
    pub fn word<'t>(
        &mut self,
        leaf: Leaf<'t>,
        what: &str,
        known: &[&'static str],
        forms: &str,
    ) -> Option<(&'static str, Option<Leaf<'t>>)> {
        let Shape::Word(word, rest) = leaf.shape() else {
            let found = leaf.shape().words();
            self.wrong(Code::WRONG_SHAPE, leaf, format!("expected {what}, found {found}"), forms);
            return None;
        };
        if let Some(known) = known.iter().find(|known| **known == word) {
            return Some((known, rest));
        }
        let elsewhere = vulkans_name(word).filter(|format| known.contains(format));
        let near = elsewhere.or_else(|| nearest(word, known.iter().copied()));
        let help = near.map_or_else(|| forms.to_owned(), |near| format!("did you mean `{near}`?"));
        self.wrong_part(Code::UNKNOWN_WORD, leaf, word, format!("`{word}` is not {what}"), &help);
        None
    }

    /// One of a few words that stand alone, as the value that it means.
    pub(crate) fn choice<T: Copy>(&mut self, leaf: Leaf<'_>, what: &str, choices: &[(&'static str, T)]) -> Option<T> {
        if let Shape::Word(word, rest) = leaf.shape()
            && let Some((known, value)) = choices.iter().find(|(choice, _)| *choice == word)
        {
            return self.bare(known, rest).map(|()| *value);
        }
        let words: Vec<&'static str> = choices.iter().map(|(word, _)| *word).collect();
        let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
        let forms = match &quoted[..] {
            [one, other] => format!("write {one} or {other}"),
            several => format!("write one of {}", several.join(", ")),
        };
        self.word(leaf, what, &words, &forms);
        None
    }

    /// One of the words of a table, and its parentheses.
    pub(crate) fn one_of<'t>(
        &mut self,
        leaf: Leaf<'t>,
        words: &'static Words,
    ) -> Option<(&'static str, Option<Leaf<'t>>)> {
        if let Shape::Word(word, rest) = leaf.shape()
            && let Some(known) = words.find(word)
        {
            return Some((known.word, rest));
        }
        self.word(leaf, words.what, &words.known(), &words.forms())
    }

    /// A word that stands alone; `Word()` is accepted too.
    pub fn bare(&mut self, word: &str, rest: Option<Leaf<'_>>) -> Option<()> {
        let Some(rest) = rest.filter(|rest| rest.tuple::<0>().is_none()) else { return Some(()) };
        self.wrong(Code::PARENTHESES, rest, format!("`{word}` takes nothing in parentheses"), "");
        None
    }

    /// The contents of the parentheses after a word.
    pub fn inside<'t, T: FromLeaf<'t>>(&mut self, leaf: Leaf<'t>, rest: Option<Leaf<'t>>, form: &str) -> Option<T> {
        let Some(rest) = rest else {
            let message = format!("`{}` needs something in parentheses", leaf.text());
            self.wrong(Code::PARENTHESES, leaf, message, &format!("write `{form}`"));
            return None;
        };
        let before = self.errors.len();
        let value = self.read(rest, format_args!("`{form}`"));
        for error in self.errors.iter_mut().skip(before) {
            error.help.get_or_insert_with(|| format!("write `{form}`"));
        }
        value
    }

    /// The name that may have been meant, or the few names that there are.
    pub fn known<'k>(&self, name: &str, known: impl IntoIterator<Item = &'k str> + Clone) -> Option<String> {
        if self.has_many() { None } else { suggestion(name, known) }
    }

    /// Whether more mistakes were reported than people read the help of.
    pub(crate) fn has_many(&self) -> bool {
        self.errors.len() > MANY_MISTAKES
    }

    /// The values of a list.
    pub fn list<'t>(&mut self, leaf: Leaf<'t>, what: &str) -> Option<Vec<Leaf<'t>>> {
        let values = leaf.values().filter(|_| matches!(leaf.shape(), Shape::List));
        if values.is_none() {
            self.expected(leaf, &format!("{what}: a list `[…, …]`"));
        }
        values.map(Iterator::collect)
    }

    /// The entries of a map.
    pub(crate) fn map<'t>(
        &mut self,
        leaf: Leaf<'t>,
        what: &str,
    ) -> Option<impl Iterator<Item = (Leaf<'t>, Leaf<'t>)> + use<'t>> {
        let entries = leaf.entries();
        if entries.is_none() {
            self.expected(leaf, &format!("{what}: a map `{{\"name\": …, …}}`"));
        }
        entries
    }

    /// `true` or `false`.
    pub fn truth(&mut self, leaf: Leaf<'_>) -> Option<bool> {
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
    pub fn number(&mut self, leaf: Leaf<'_>) -> Option<f64> {
        self.number_as(leaf, None)
    }

    /// A finite number; `what` names it in messages: "a scale".
    pub(crate) fn number_as(&mut self, leaf: Leaf<'_>, what: Option<&str>) -> Option<f64> {
        #[allow(clippy::cast_precision_loss, reason = "the nearest number is meant")]
        let number = match (leaf.number(), leaf.shape()) {
            (Some(Number::Whole(number)), _) => number as f64,
            (Some(Number::Real(number) | Number::Huge(number)), _) => number,
            (Some(Number::NotFinite), _) | (None, Shape::Word("NaN" | "inf", None)) => {
                let expected = what.map_or_else(|| "expected".to_owned(), |what| format!("{what} is"));
                self.wrong(Code::WRONG_SHAPE, leaf, format!("{expected} a finite number, found `{}`", leaf.text()), "");
                return None;
            }
            (None, _) => {
                self.expected(leaf, "a number");
                return None;
            }
        };
        if !number.is_finite() {
            self.wrong(
                Code::NUMBER_TOO_LARGE,
                leaf,
                "this number is too large",
                "64-bit floating point reaches about 1.79e308",
            );
            return None;
        }
        Some(number)
    }

    /// A whole number.
    pub fn integer(&mut self, leaf: Leaf<'_>) -> Option<i64> {
        match leaf.number() {
            Some(Number::Whole(number)) => return Some(number),
            Some(Number::Huge(_)) => self.wrong(Code::NUMBER_TOO_LARGE, leaf, "this whole number is too large", ""),
            Some(Number::Real(_) | Number::NotFinite) => {
                self.wrong(Code::WRONG_SHAPE, leaf, format!("expected a whole number, found `{}`", leaf.text()), "");
            }
            None => self.expected(leaf, "a whole number"),
        }
        None
    }
}
