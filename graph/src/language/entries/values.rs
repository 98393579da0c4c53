//! Values that several fields take: numbers, truths, words, and what images and buffers are filled with. Each stands
//! there by itself or as an expression in quotes.

use crate::base::Diagnostic;
use crate::expression::{Outcome, Value, Wanted};
use crate::frame::ParamValue;
use crate::language::model::{Fill, SettingKind};
use crate::language::scope::{Context, Evaluated, Quoted, joined};
use crate::ron::{Form, Leaf, Number, Reader, Shape, Spanned, Words};
use crate::vulkan::Format;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// A value and what decided it.
pub(crate) type Decided<T> = (T, Option<Arc<str>>);

impl Context<'_, '_> {
    /// A whole number of `range`. Of a plain setting all values must lie there. `what` names it: "number of mip levels".
    pub(crate) fn whole<T: TryFrom<i64>>(
        &mut self,
        leaf: Leaf<'_>,
        what: &str,
        range: RangeInclusive<i64>,
    ) -> Option<T> {
        self.whole_because(leaf, what, range).map(|(value, _)| value)
    }

    /// The same with what decided it.
    pub(crate) fn whole_because<T: TryFrom<i64>>(
        &mut self,
        leaf: Leaf<'_>,
        what: &str,
        range: RangeInclusive<i64>,
    ) -> Option<Decided<T>> {
        let Shape::Text = leaf.shape() else {
            if !matches!(leaf.shape(), Shape::Number) {
                self.reader.expected(leaf, "a whole number, or an expression in quotes");
                return None;
            }
            return constant(self.reader, leaf, what, range).map(|number| (number, None));
        };
        let words = ("a whole number", Some("a whole number"));
        let Evaluated { value, because, setting } = self.value(leaf, SettingKind::is_whole, Wanted::INTEGER, words)?;
        if let Some(odd) = setting.and_then(|setting| setting.whole_beyond(&range)) {
            let message = format!("this setting allows {odd}, which is no {what}");
            self.reader.wrong(leaf, message, &format!("{} to {} are allowed", range.start(), range.end()));
            return None;
        }
        let Value::Integer(number) = value else { return None };
        let fitting = T::try_from(number).ok().filter(|_| range.contains(&number));
        if fitting.is_none() {
            let (least, most) = (range.start(), range.end());
            let wrong = Diagnostic::new(leaf.span(), format!("{number} is no {what}: {least} to {most} are allowed"));
            self.fault(leaf, wrong.remark(because.as_deref().unwrap_or_default()));
        }
        fitting.map(|number| (number, because))
    }

    /// A number to fill with.
    fn fill_number(&mut self, leaf: Leaf<'_>) -> Option<f64> {
        self.number_because(leaf, "a value to fill with").map(|(number, _)| number)
    }

    /// A number, and what decided it. `what` names it: "a scale".
    pub(crate) fn number_because(&mut self, leaf: Leaf<'_>, what: &str) -> Option<Decided<f64>> {
        let Shape::Text = leaf.shape() else {
            return self.reader.number_as(leaf, Some(what)).map(|number| (number, None));
        };
        let words = ("a number", Some("a number"));
        let Evaluated { value, because, .. } = self.value(leaf, SettingKind::is_number, Wanted::NUMBER, words)?;
        match value {
            Value::Number(number) => Some((number, because)),
            #[allow(clippy::cast_precision_loss, reason = "the nearest number is meant")]
            Value::Integer(number) => Some((number as f64, because)),
            _ => None,
        }
    }

    /// `true` or `false`.
    pub(crate) fn truth(&mut self, leaf: Leaf<'_>) -> Option<bool> {
        let Shape::Text = leaf.shape() else { return self.reader.truth(leaf) };
        let fits = |kind: &SettingKind| matches!(kind, SettingKind::Bool { .. });
        let value = self.value(leaf, fits, Wanted::BOOL, ("`true` or `false`", None))?.value;
        if let Value::Bool(value) = value { Some(value) } else { None }
    }

    /// A format that an expression says.
    pub(crate) fn format(&mut self, leaf: Leaf<'_>) -> Option<Format> {
        match self.evaluate(leaf, Wanted::FORMAT)?.value {
            Value::Format(format) => Some(format),
            _ => None,
        }
    }

    /// A value for a shader's parameter, and what stands for it in the file.
    pub(crate) fn param(&mut self, leaf: Leaf<'_>) -> Option<Decided<ParamValue>> {
        let (value, written) = match leaf.shape() {
            Shape::Text => {
                let fits = |kind: &SettingKind| !matches!(kind, SettingKind::Choice { .. });
                match self.quoted(leaf, fits, Wanted::PARAMETER.words, Some(Wanted::PARAMETER.words))? {
                    Quoted::Parameter(parameter, value) => (
                        value.value.clone(),
                        format!("{} `{}`", self.scope.symbols.parameter_word(), parameter.name.text),
                    ),
                    Quoted::Expression => {
                        let Outcome { value, decided, .. } = self.evaluate(leaf, Wanted::PARAMETER)?;
                        (value, joined(&decided).map_or_else(|| leaf.text().to_owned(), |because| because.to_string()))
                    }
                }
            }
            Shape::Word("true" | "false", None) => return Some((ParamValue::Bool(self.reader.truth(leaf)?), None)),
            Shape::Number | Shape::Word("NaN" | "inf", None) => {
                return Some(match leaf.number() {
                    Some(Number::Whole(number)) => (ParamValue::Integer(number), None),
                    _ => (ParamValue::Number(self.reader.number_as(leaf, Some("a parameter"))?), None),
                });
            }
            _ => {
                self.reader.expected(leaf, "a number, `true`, `false`, or an expression in quotes");
                return None;
            }
        };
        let value = match value {
            Value::Bool(value) => ParamValue::Bool(value),
            Value::Integer(value) => ParamValue::Integer(value),
            Value::Number(value) => ParamValue::Number(value),
            _ => return None,
        };
        Some((value, Some(written.into())))
    }

    /// One of a few words, by itself or as the text that an expression says.
    pub(crate) fn word<T: Copy>(&mut self, leaf: Leaf<'_>, what: &str, choices: &[(&'static str, T)]) -> Option<T> {
        let quoted = leaf.plain().filter(|text| !self.scope.names_nothing(text));
        if quoted.is_none() {
            return choice(self.reader, leaf, what, choices);
        }
        let Outcome { value: Value::Text(text), decided, .. } = self.evaluate(leaf, Wanted::TEXT)? else {
            return None;
        };
        let found = choices.iter().find(|(word, _)| **word == *text).map(|(_, value)| *value);
        if found.is_none() {
            let because = self.scope.within_view(joined(&decided).as_deref().unwrap_or_default());
            let wrong = Diagnostic::new(leaf.span(), format!("`{text}` is not {what}")).remark(because);
            let known: Vec<String> = choices.iter().map(|(word, _)| format!("`'{word}'`")).collect();
            self.fault(leaf, wrong.help(format!("it is one of {}", known.join(", "))));
        }
        found
    }

    /// What an image or buffer is filled with.
    pub(crate) fn fill(&mut self, leaf: Leaf<'_>) -> Option<Fill> {
        if !matches!(leaf.shape(), Shape::Parentheses) {
            return self.fill_number(leaf).map(Fill::Number);
        }
        if let Some([depth, stencil]) = leaf.tuple() {
            let (depth, stencil) = (self.fill_number(depth), self.fill_number(stencil));
            return Some(Fill::DepthStencil(depth?, stencil?));
        }
        let Some(parts) = leaf.tuple::<4>() else {
            self.reader.wrong(leaf, "this is no value for all texels", FILLS);
            return None;
        };
        let parts = parts.map(|part| self.fill_number(part));
        Some(Fill::Color([parts[0]?, parts[1]?, parts[2]?, parts[3]?]))
    }

    /// One of several words that take nothing, or a setting or expression that says one.
    pub(crate) fn bare_word(&mut self, leaf: Leaf<'_>, words: &'static Words) -> Option<Decided<&'static str>> {
        let Shape::Text = leaf.shape() else {
            let (word, rest) = self.reader.one_of(leaf, words)?;
            return self.reader.bare(word, rest).map(|()| (word, None));
        };
        let fits = |kind: &SettingKind| matches!(kind, SettingKind::Choice { .. });
        let Evaluated { value, because, setting } = self.value(leaf, fits, Wanted::TEXT, ("a text", None))?;
        if let Some(setting) = setting
            && let Some(odd) = setting.texts().iter().find(|text| words.find(text).is_none())
        {
            let message = format!("this setting allows `{}`, which is not {}", odd, words.what);
            let known: Vec<String> = words.all.iter().map(|word| format!("`{}`", word.word)).collect();
            let help = format!("write one of {} in place of `{odd}`", known.join(", "));
            let wrong = Diagnostic::new(leaf.span(), message).label(setting.name.span, "declared here");
            self.reader.report(wrong.help(help));
            return None;
        }
        let Value::Text(text) = value else { return None };
        match words.find(&text) {
            Some(known) => Some((known.word, because)),
            None => {
                let wrong = Diagnostic::new(leaf.span(), format!("`{}` is not {}", text, words.what));
                let wrong = wrong.remark(because.as_deref().unwrap_or_default()).help(words.forms());
                self.fault(leaf, wrong);
                None
            }
        }
    }
}

/// A whole number of `range` that stands there by itself.
fn constant<'src, T: TryFrom<i64>>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    what: &str,
    range: RangeInclusive<i64>,
) -> Option<T> {
    let number = reader.integer(leaf)?;
    let fitting = T::try_from(number).ok().filter(|_| range.contains(&number));
    if fitting.is_none() {
        let (least, most) = (range.start(), range.end());
        reader.wrong(leaf, format!("{number} is no {what}: {least} to {most} are allowed"), "");
    }
    fitting
}

/// A field that may be absent: `None` if it is there and wrong.
pub(crate) fn optional<'src, T>(
    leaf: Option<Leaf<'src>>,
    read: impl FnOnce(Leaf<'src>) -> Option<T>,
) -> Option<Option<T>> {
    match leaf {
        Some(leaf) => read(leaf).map(Some),
        None => Some(None),
    }
}

/// One of a few words in a field that may be absent: `None` if it is there and wrong.
pub(crate) fn optional_choice<T: Copy>(
    reader: &mut Reader,
    leaf: Option<Leaf<'_>>,
    what: &str,
    choices: &[(&'static str, T)],
) -> Option<Option<Spanned<T>>> {
    optional(leaf, |leaf| choice(reader, leaf, what, choices).map(|value| leaf.spanned(value)))
}

/// One of a few words.
pub(crate) fn choice<'src, T: Copy>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    what: &str,
    choices: &[(&'static str, T)],
) -> Option<T> {
    let words: Vec<&'static str> = choices.iter().map(|(word, _)| *word).collect();
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    let forms = match &quoted[..] {
        [one, other] => format!("write {one} or {other}"),
        several => format!("write one of {}", several.join(", ")),
    };
    let (word, rest) = reader.word(leaf, what, &words, &forms)?;
    reader.bare(word, rest)?;
    choices.iter().find(|(choice, _)| *choice == word).map(|(_, value)| *value)
}

/// What an image or buffer is filled with: every component or word, depth and stencil, or a colour.
pub(crate) const FILL: Form = Form::Either(&[Form::Number, Form::Tuple(&[Form::Number, Form::Number]), COLOR]);

/// Red, green, blue and alpha.
pub(crate) const COLOR: Form = Form::Tuple(&[Form::Number, Form::Number, Form::Number, Form::Number]);

const FILLS: &str = "a value is a number, `(depth, stencil)` or `(red, green, blue, alpha)`";

/// A field with its word, and what decided it.
pub(crate) fn said(field: &str, word: &str, because: Option<Arc<str>>) -> Arc<str> {
    let because = because.map(|because| format!(" ({because})")).unwrap_or_default();
    format!("`{field}: {word}`{because}").into()
}

/// Counts of vertices, instances and invocations.
pub(crate) const MANY: Form = Form::Whole(1, u32::MAX as i64);
