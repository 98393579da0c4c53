//! Values that several fields take: numbers, truths, words, and what images and buffers are filled with. Each stands
//! there by itself or as an expression in quotes.

use crate::base::Diagnostic;
use crate::expression::{Outcome, Value, Wanted};
use crate::frame::ParamValue;
use crate::language::model::{Fill, SettingKind};
use crate::language::scope::{ParameterKind, Quoted, Scope, joined};
use crate::ron::{Form, Leaf, Number, Reader, Shape, Words};
use crate::vulkan::Format;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// A value and what decided it.
pub(crate) type Decided<T> = (T, Option<Arc<str>>);

/// A whole number of `range`. Of a plain setting all values must lie there. `what` names it: "number of mip levels".
pub(crate) fn whole<'src, T: TryFrom<i64>>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    what: &str,
    range: RangeInclusive<i64>,
) -> Option<T> {
    whole_because(reader, scope, leaf, what, range).map(|(value, _)| value)
}

/// The same with what decided it.
pub(crate) fn whole_because<'src, T: TryFrom<i64>>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    what: &str,
    range: RangeInclusive<i64>,
) -> Option<Decided<T>> {
    let Shape::Text = leaf.shape() else {
        if !matches!(leaf.shape(), Shape::Number) {
            reader.expected(leaf, "a whole number, or an expression in quotes");
            return None;
        }
        return constant(reader, leaf, what, range).map(|number| (number, None));
    };
    let (value, because) = match scope.quoted(reader, leaf, SettingKind::is_whole, "a whole number")? {
        Quoted::Given(parameter, given) => {
            if let ParameterKind::Value(kind) = &parameter.kind
                && let Some(odd) = kind.whole_beyond(&range)
                && scope.known.settings
            {
                let message = format!("this setting allows {odd}, which is no {what}");
                reader.wrong(leaf, message, &format!("{} to {} are allowed", range.start(), range.end()));
                return None;
            }
            (given.value.clone(), scope.because(parameter, given))
        }
        Quoted::Expression => {
            let Outcome { value, decided, .. } = scope.evaluate(reader, leaf, Wanted::INTEGER)?;
            (value, joined(&decided))
        }
    };
    let Value::Integer(number) = value else { return None };
    let fitting = T::try_from(number).ok().filter(|_| range.contains(&number));
    if fitting.is_none() {
        let (least, most) = (range.start(), range.end());
        let wrong = Diagnostic::new(leaf.span(), format!("{number} is no {what}: {least} to {most} are allowed"));
        scope.fault(reader, leaf, wrong.remark(because.as_deref().unwrap_or_default()));
    }
    fitting.map(|number| (number, because))
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

/// A number to fill with.
fn number<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<f64> {
    number_because(reader, scope, leaf, "a value to fill with").map(|(number, _)| number)
}

/// A number, and what decided it. `what` names it: "a scale".
pub(crate) fn number_because<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    what: &str,
) -> Option<Decided<f64>> {
    let Shape::Text = leaf.shape() else {
        return reader.number_as(leaf, Some(what)).map(|number| (number, None));
    };
    let (value, because) = match scope.quoted(reader, leaf, SettingKind::is_number, "a number")? {
        Quoted::Given(parameter, given) => (given.value.clone(), scope.because(parameter, given)),
        Quoted::Expression => {
            let Outcome { value, decided, .. } = scope.evaluate(reader, leaf, Wanted::NUMBER)?;
            (value, joined(&decided))
        }
    };
    match value {
        Value::Number(number) => Some((number, because)),
        #[allow(clippy::cast_precision_loss, reason = "the nearest number is meant")]
        Value::Integer(number) => Some((number as f64, because)),
        _ => None,
    }
}

/// `true` or `false`.
pub(crate) fn truth<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<bool> {
    let Shape::Text = leaf.shape() else { return reader.truth(leaf) };
    let fits = |kind: &SettingKind| matches!(kind, SettingKind::Bool { .. });
    let value = match scope.quoted_or(reader, leaf, fits, "`true` or `false`", None)? {
        Quoted::Given(_, given) => given.value.clone(),
        Quoted::Expression => scope.evaluate(reader, leaf, Wanted::BOOL)?.value,
    };
    if let Value::Bool(value) = value { Some(value) } else { None }
}

/// A format that an expression says.
pub(crate) fn format<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Format> {
    match scope.evaluate(reader, leaf, Wanted::FORMAT)?.value {
        Value::Format(format) => Some(format),
        _ => None,
    }
}

/// A value for a shader's parameter, and what stands for it in the file.
pub(crate) fn param<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Decided<ParamValue>> {
    let (value, written) = match leaf.shape() {
        Shape::Text => {
            let fits = |kind: &SettingKind| !matches!(kind, SettingKind::Choice { .. });
            match scope.quoted(reader, leaf, fits, Wanted::PARAMETER.words)? {
                Quoted::Given(parameter, given) => {
                    (given.value.clone(), format!("{} `{}`", scope.known.given_word(), parameter.name.text))
                }
                Quoted::Expression => {
                    let Outcome { value, decided, .. } = scope.evaluate(reader, leaf, Wanted::PARAMETER)?;
                    (value, joined(&decided).map_or_else(|| leaf.text().to_owned(), |because| because.to_string()))
                }
            }
        }
        Shape::Word("true" | "false", None) => return Some((ParamValue::Bool(reader.truth(leaf)?), None)),
        Shape::Number | Shape::Word("NaN" | "inf", None) => {
            return Some(match leaf.number() {
                Some(Number::Whole(number)) => (ParamValue::Integer(number), None),
                _ => (ParamValue::Number(reader.number_as(leaf, Some("a parameter"))?), None),
            });
        }
        _ => {
            reader.expected(leaf, "a number, `true`, `false`, or an expression in quotes");
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
pub(crate) fn word<'src, T: Copy>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    what: &str,
    choices: &[(&'static str, T)],
) -> Option<T> {
    let quoted = leaf.plain().filter(|text| !scope.names_nothing(text));
    if quoted.is_none() {
        return choice(reader, leaf, what, choices);
    }
    let Outcome { value: Value::Text(text), decided, .. } = scope.evaluate(reader, leaf, Wanted::TEXT)? else {
        return None;
    };
    let found = choices.iter().find(|(word, _)| **word == *text).map(|(_, value)| *value);
    if found.is_none() {
        let because = scope.within_view(joined(&decided).as_deref().unwrap_or_default());
        let wrong = Diagnostic::new(leaf.span(), format!("`{text}` is not {what}")).remark(because);
        let known: Vec<String> = choices.iter().map(|(word, _)| format!("`'{word}'`")).collect();
        scope.fault(reader, leaf, wrong.help(format!("it is one of {}", known.join(", "))));
    }
    found
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

/// What an image or buffer is filled with.
pub(crate) fn fill<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Fill> {
    if !matches!(leaf.shape(), Shape::Parentheses) {
        return number(reader, scope, leaf).map(Fill::Number);
    }
    if let Some([depth, stencil]) = leaf.tuple() {
        let (depth, stencil) = (number(reader, scope, depth), number(reader, scope, stencil));
        return Some(Fill::DepthStencil(depth?, stencil?));
    }
    let Some(parts) = leaf.tuple::<4>() else {
        reader.wrong(leaf, "this is no value for all texels", FILLS);
        return None;
    };
    let parts = parts.map(|part| number(reader, scope, part));
    Some(Fill::Color([parts[0]?, parts[1]?, parts[2]?, parts[3]?]))
}

/// One of several words that take nothing, or a setting or expression that says one.
pub(crate) fn bare_word<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    words: &'static Words,
) -> Option<Decided<&'static str>> {
    let Shape::Text = leaf.shape() else {
        let (word, rest) = reader.one_of(leaf, words)?;
        return reader.bare(word, rest).map(|()| (word, None));
    };
    let fits = |kind: &SettingKind| matches!(kind, SettingKind::Choice { .. });
    let (value, because) = match scope.quoted_or(reader, leaf, fits, "a text", None)? {
        Quoted::Given(parameter, given) => {
            if scope.known.settings
                && let Some(odd) = parameter.texts().iter().find(|text| words.find(text).is_none())
            {
                let message = format!("this setting allows `{}`, which is not {}", odd, words.what);
                let known: Vec<String> = words.all.iter().map(|word| format!("`{}`", word.word)).collect();
                let help = format!("write one of {} in place of `{odd}`", known.join(", "));
                let declared = &parameter.name;
                let wrong = Diagnostic::new(leaf.span(), message).label(declared.span, "declared here");
                reader.report(wrong.help(help));
                return None;
            }
            (given.value.clone(), scope.because(parameter, given))
        }
        Quoted::Expression => {
            let outcome = scope.evaluate(reader, leaf, Wanted::TEXT)?;
            let because = joined(&outcome.decided);
            (outcome.value, because)
        }
    };
    let Value::Text(text) = value else { return None };
    match words.find(&text) {
        Some(known) => Some((known.word, because)),
        None => {
            let wrong = Diagnostic::new(leaf.span(), format!("`{}` is not {}", text, words.what));
            let wrong = wrong.remark(because.as_deref().unwrap_or_default()).help(words.forms());
            scope.fault(reader, leaf, wrong);
            None
        }
    }
}

/// A field with its word, and what decided it.
pub(crate) fn said(field: &str, word: &str, because: Option<Arc<str>>) -> Arc<str> {
    let because = because.map(|because| format!(" ({because})")).unwrap_or_default();
    format!("`{field}: {word}`{because}").into()
}

/// Counts of vertices, instances and invocations.
pub(crate) const MANY: Form = Form::Whole(1, u32::MAX as i64);
