//! Values that several fields take: numbers, truths, words, and fills of images and buffers. Each stands by itself or as
//! an expression in quotes.

use crate::base::{Code, Diagnostic};
use crate::expression::{Value, WantedTypes};
use crate::frame::{FrameValue, PARAM_COMPONENTS, ParamValue};
use crate::language::model::{Decided, Decisions, Fill, SettingKind};
use crate::language::scope::{Context, FieldContents, FieldValue, Quoted, all, combined, decided, within_view};
use crate::ron::{Form, Leaf, Number, Reader, Shape, Spanned, Words};
use crate::vulkan::Format;
use std::ops::RangeInclusive;
use std::sync::Arc;

impl Context<'_> {
    /// A whole number within `range`; all values of a plain setting must lie there. `what` names it: "number of mip levels".
    pub(crate) fn whole<T: TryFrom<i64> + FieldContents>(
        &mut self,
        leaf: Leaf<'_>,
        what: &'static str,
        range: RangeInclusive<i64>,
    ) -> Option<FieldValue<T>> {
        self.whole_because(leaf, what, range).map(FieldValue::alone)
    }

    /// A whole number as [`Context::whole`] reads it, with its place.
    pub(crate) fn whole_at<T: TryFrom<i64> + FieldContents>(
        &mut self,
        leaf: Leaf<'_>,
        what: &'static str,
        range: RangeInclusive<i64>,
    ) -> Option<FieldValue<Spanned<T>>> {
        self.whole_because(leaf, what, range).map(FieldValue::spanned)
    }

    /// A whole number as [`Context::whole`] reads it, with its place and cause.
    pub(crate) fn whole_because<T: TryFrom<i64> + FieldContents>(
        &mut self,
        leaf: Leaf<'_>,
        what: &'static str,
        range: RangeInclusive<i64>,
    ) -> Option<FieldValue<Decided<T>>> {
        let Shape::Text = leaf.shape() else {
            if !matches!(leaf.shape(), Shape::Number) {
                self.reader.expected(leaf, "a whole number, or an expression in quotes");
                return None;
            }
            return constant(self.reader, leaf, what, range).map(|number| FieldValue::said(leaf, number));
        };
        let words = ("a whole number", Some("a whole number"));
        let (number, setting) = self.value(leaf, SettingKind::is_whole, WantedTypes::INTEGER, words)?;
        if let Some(odd) = setting.and_then(|setting| setting.whole_beyond(&range)) {
            let message = format!("this setting allows {odd}, which is no {what}");
            self.reader.wrong(
                Code::SETTING_TOO_WIDE,
                leaf,
                message,
                &format!("{} to {} are allowed", range.start(), range.end()),
            );
            return None;
        }
        typed(number, whole_number)?.checked(self.reader, move |number, _| {
            match T::try_from(number.value).ok().filter(|_| range.contains(&number.value)) {
                Some(value) => Ok(number.map(|_| value)),
                None => {
                    let wrong = Diagnostic::new(Code::NUMBER_OUTSIDE, number.span, outside(number.value, what, &range));
                    Err(wrong.remark(number.remark()))
                }
            }
        })
    }

    /// A number to fill with.
    fn fill_number(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<f64>> {
        self.number_because(leaf, "a value to fill with").map(FieldValue::alone)
    }

    /// A number, and its cause. `what` names it: "a scale".
    pub(crate) fn number_because(&mut self, leaf: Leaf<'_>, what: &str) -> Option<FieldValue<Decided<f64>>> {
        let Shape::Text = leaf.shape() else {
            return self.reader.number_as(leaf, Some(what)).map(|number| FieldValue::said(leaf, number));
        };
        let words = ("a number", Some("a number"));
        let (number, _) = self.value(leaf, SettingKind::is_number, WantedTypes::NUMBER, words)?;
        typed(number, |value| match value {
            Value::Number(number) => Some(number),
            #[allow(clippy::cast_precision_loss, reason = "the nearest number is meant")]
            Value::Integer(number) => Some(number as f64),
            _ => None,
        })
    }

    /// `true` or `false`.
    pub(crate) fn truth(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<bool>>> {
        let Shape::Text = leaf.shape() else {
            return self.reader.truth(leaf).map(|value| FieldValue::said(leaf, value));
        };
        let fits = |kind: &SettingKind| matches!(kind, SettingKind::Bool { .. });
        let (value, _) = self.value(leaf, fits, WantedTypes::BOOL, ("`true` or `false`", None))?;
        typed(value, |value| if let Value::Bool(value) = value { Some(value) } else { None })
    }

    /// A format that an expression says.
    pub(crate) fn format(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<Format>>> {
        let format = decided(self.expression(leaf, WantedTypes::FORMAT)?, leaf.span());
        typed(format, |value| if let Value::Format(format) = value { Some(format) } else { None })
    }

    /// A value for a shader's parameter, and the words for it in the file.
    pub(crate) fn param(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<ParamValue>>> {
        let elements = if matches!(leaf.shape(), Shape::List) { leaf.values() } else { None };
        let Some(elements) = elements else { return self.param_within(leaf, PARAM_DEPTH) };
        let elements: Vec<_> = elements.map(|element| self.param_within(element, PARAM_DEPTH)).collect();
        if elements.is_empty() {
            self.reader.wrong(Code::WRONG_SHAPE, leaf, "an array has at least one value".to_owned(), "");
            return None;
        }
        listed(leaf, elements)
    }

    /// As [`Context::param`], a list of at most so many dimensions.
    fn param_within(&mut self, leaf: Leaf<'_>, dimensions: u32) -> Option<FieldValue<Decided<ParamValue>>> {
        if dimensions == 0 || !matches!(leaf.shape(), Shape::Parentheses) {
            return self.param_alone(leaf, dimensions == PARAM_DEPTH);
        }
        // Named fields are no components.
        let Some(leaves) = leaf.values() else { return self.param_alone(leaf, dimensions == PARAM_DEPTH) };
        let leaves: Vec<Leaf<'_>> = leaves.collect();
        if !PARAM_COMPONENTS.contains(&leaves.len()) {
            let (least, most) = (PARAM_COMPONENTS.start(), PARAM_COMPONENTS.end());
            let what = if dimensions == PARAM_DEPTH { "a vector or matrix" } else { "a column of a matrix" };
            let message = format!("{what} has {least} to {most} values in `(…, …)`; here are {}", leaves.len());
            let help = if dimensions == PARAM_DEPTH { "an array stands in `[…, …]`" } else { "" };
            self.reader.wrong(Code::WRONG_SHAPE, leaf, message, help);
            return None;
        }
        // All of them are read, so that all mistakes are told.
        listed(leaf, leaves.into_iter().map(|leaf| self.param_within(leaf, dimensions - 1)).collect())
    }

    /// A single value for a shader's parameter. `lists`: a list could stand there too.
    fn param_alone(&mut self, leaf: Leaf<'_>, lists: bool) -> Option<FieldValue<Decided<ParamValue>>> {
        match leaf.shape() {
            Shape::Text => {}
            Shape::Word("true" | "false", None) => {
                return self.reader.truth(leaf).map(|value| FieldValue::said(leaf, ParamValue::Bool(value)));
            }
            Shape::Number | Shape::Word("NaN" | "inf", None) => {
                let value = match leaf.number() {
                    Some(Number::Whole(number)) => ParamValue::Integer(number),
                    _ => ParamValue::Number(self.reader.number_as(leaf, Some("a parameter"))?),
                };
                return Some(FieldValue::said(leaf, value));
            }
            _ => {
                let more = if lists { "several of them in `(…, …)`, an array in `[…, …]`, " } else { "" };
                self.reader.expected(leaf, &format!("a number, `true`, `false`, {more}or an expression in quotes"));
                return None;
            }
        }
        if let Some(value) = leaf.plain().filter(|text| self.scope.names_nothing(text)).and_then(FrameValue::named) {
            return Some(FieldValue::said(leaf, ParamValue::OfFrame(value)));
        }
        let fits = |kind: &SettingKind| !matches!(kind, SettingKind::Choice { .. });
        let words = (WantedTypes::PARAMETER.words, Some(WantedTypes::PARAMETER.words));
        let value = match self.quoted(leaf, fits, WantedTypes::PARAMETER, words)? {
            Quoted::Parameter(parameter, at) => {
                let written: Arc<str> =
                    format!("{} `{}`", self.scope.symbols.parameter_word(), parameter.name.text).into();
                let span = leaf.span();
                let value = FieldValue::computed(move |evaluator| evaluator.parameter(at, span));
                value.map(move |decided| Decided { because: Some(written.clone()), ..decided })
            }
            Quoted::Expression(expression) => {
                let written: Arc<str> = leaf.text().into();
                decided(expression, leaf.span()).map(move |decided| {
                    let because = decided.because.or_else(|| Some(written.clone()));
                    Decided { because, ..decided }
                })
            }
        };
        typed(value, |value| match value {
            Value::Bool(value) => Some(ParamValue::Bool(value)),
            Value::Integer(value) => Some(ParamValue::Integer(value)),
            Value::Number(value) => Some(ParamValue::Number(value)),
            _ => None,
        })
    }

    /// One of a few words, by itself or as the text that an expression says.
    pub(crate) fn word<T: Copy + FieldContents>(
        &mut self,
        leaf: Leaf<'_>,
        what: &'static str,
        choices: &'static [(&'static str, T)],
    ) -> Option<FieldValue<Decided<T>>> {
        let quoted = leaf.plain().filter(|text| !self.scope.names_nothing(text));
        if quoted.is_none() {
            return self.reader.choice(leaf, what, choices).map(|word| FieldValue::said(leaf, word));
        }
        let said = decided(self.expression(leaf, WantedTypes::TEXT)?, leaf.span());
        typed(said, text)?.checked(self.reader, move |said, view| {
            if let Some((_, value)) = choices.iter().find(|(word, _)| *word == &*said.value) {
                return Ok(said.map(|_| *value));
            }
            let wrong = Diagnostic::new(Code::UNKNOWN_WORD, said.span, format!("`{}` is not {what}", said.value));
            let known: Vec<String> = choices.iter().map(|(word, _)| format!("`'{word}'`")).collect();
            let wrong = wrong.remark(within_view(view, said.remark()));
            Err(wrong.help(format!("it is one of {}", known.join(", "))))
        })
    }

    /// The value of a fill, and its place.
    pub(crate) fn fill(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Spanned<Fill>>> {
        let fill = if !matches!(leaf.shape(), Shape::Parentheses) {
            self.fill_number(leaf)?.map(Fill::Number)
        } else if let Some([depth, stencil]) = leaf.tuple() {
            let (depth, stencil) = (self.fill_number(depth), self.fill_number(stencil));
            combined((depth?, stencil?), |(depth, stencil)| Fill::DepthStencil(depth, stencil))
        } else if let Some(parts) = leaf.tuple::<4>() {
            combined(all(parts.map(|part| self.fill_number(part)))?, Fill::Color)
        } else {
            self.reader.wrong(Code::FILL_UNFIT, leaf, "this is no value for all texels", FILLS);
            return None;
        };
        Some(at(leaf, fill))
    }

    /// One of several words that take nothing, or a setting or expression that says one.
    pub(crate) fn bare_word(
        &mut self,
        leaf: Leaf<'_>,
        words: &'static Words,
    ) -> Option<FieldValue<Decided<&'static str>>> {
        let Shape::Text = leaf.shape() else {
            let (word, rest) = self.reader.one_of(leaf, words)?;
            return self.reader.bare(word, rest).map(|()| FieldValue::said(leaf, word));
        };
        let fits = |kind: &SettingKind| matches!(kind, SettingKind::Choice { .. });
        let (said, setting) = self.value(leaf, fits, WantedTypes::TEXT, ("a text", None))?;
        if let Some(setting) = setting
            && let Some(odd) = setting.texts().iter().find(|text| words.find(text).is_none())
        {
            let message = format!("this setting allows `{}`, which is not {}", odd, words.what);
            let known: Vec<String> = words.all.iter().map(|word| format!("`{}`", word.word)).collect();
            let help = format!("write one of {} in place of `{odd}`", known.join(", "));
            let wrong =
                Diagnostic::new(Code::SETTING_TOO_WIDE, leaf.span(), message).label(setting.name.span, "declared here");
            self.reader.report(wrong.help(help));
            return None;
        }
        typed(said, text)?.checked(self.reader, move |said, _| match words.find(&said.value) {
            Some(known) => Ok(said.map(|_| known.word)),
            None => {
                let wrong =
                    Diagnostic::new(Code::UNKNOWN_WORD, said.span, format!("`{}` is not {}", said.value, words.what));
                Err(wrong.remark(said.remark()).help(words.forms()))
            }
        })
    }
}

/// A list of values, with the words for them; `None` if one of them is wrong.
fn listed(
    leaf: Leaf<'_>,
    values: Vec<Option<FieldValue<Decided<ParamValue>>>>,
) -> Option<FieldValue<Decided<ParamValue>>> {
    let (values, span) = (values.into_iter().collect::<Option<Vec<_>>>()?, leaf.span());
    Some(combined(values, move |values: Vec<Decided<ParamValue>>| {
        let mut words: Vec<Arc<str>> = Vec::new();
        for because in values.iter().filter_map(|value| value.because.as_ref()) {
            if !words.contains(because) {
                words.push(because.clone());
            }
        }
        let because = (!words.is_empty()).then(|| words.join(", ").into());
        let value = ParamValue::list(values.into_iter().map(|value| value.value));
        Decided { value, span, because, by: Decisions::default() }
    }))
}

/// A value of another type.
pub(crate) fn typed<T: FieldContents>(
    value: FieldValue<Decided<Value>>,
    make: impl Fn(Value) -> Option<T> + Send + Sync + 'static,
) -> Option<FieldValue<Decided<T>>> {
    value.then(move |Decided { value, span, because, by }| Some(Decided { value: make(value)?, span, because, by }))
}

/// The value as a whole number, if it is one.
pub(crate) fn whole_number(value: Value) -> Option<i64> {
    if let Value::Integer(number) = value { Some(number) } else { None }
}

fn text(value: Value) -> Option<Arc<str>> {
    if let Value::Text(text) = value { Some(text) } else { None }
}

/// A value with the place of `leaf`.
pub(crate) fn at<T: FieldContents>(leaf: Leaf<'_>, value: FieldValue<T>) -> FieldValue<Spanned<T>> {
    let span = leaf.span();
    value.map(move |value| Spanned { value, span })
}

/// A whole number within `range` that stands by itself.
fn constant<'src, T: TryFrom<i64>>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    what: &str,
    range: RangeInclusive<i64>,
) -> Option<T> {
    let number = reader.integer(leaf)?;
    let fitting = T::try_from(number).ok().filter(|_| range.contains(&number));
    if fitting.is_none() {
        reader.wrong(Code::NUMBER_OUTSIDE, leaf, outside(number, what, &range), "");
    }
    fitting
}

fn outside(number: i64, what: &str, range: &RangeInclusive<i64>) -> String {
    format!("{number} is no {what}: {} to {} are allowed", range.start(), range.end())
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
    optional(leaf, |leaf| reader.choice(leaf, what, choices).map(|value| leaf.spanned(value)))
}

/// The form of a fill: a value for every component or word, depth and stencil, or a colour.
pub(crate) const FILL: Form = Form::Either(&[Form::Number, Form::Tuple(&[Form::Number, Form::Number]), COLOR]);

/// Red, green, blue and alpha.
pub(crate) const COLOR: Form = Form::Tuple(&[Form::Number, Form::Number, Form::Number, Form::Number]);

/// Dimensions of a matrix.
const PARAM_DEPTH: u32 = 2;

/// A vector, or a matrix as a list of its columns.
const PARAM_LIST: Form =
    Form::Several(&Form::Either(&[Form::Number, Form::Truth, Form::Several(&Form::Number, 2, 4)]), 2, 4);

/// A value for a shader's parameter: a scalar, a vector, a matrix, or an array of such.
pub(crate) const PARAM: Form = Form::Either(&[
    Form::Number,
    Form::Truth,
    PARAM_LIST,
    Form::List(&Form::Either(&[Form::Number, Form::Truth, PARAM_LIST])),
]);

const FILLS: &str = "a value is a number, `(depth, stencil)` or `(red, green, blue, alpha)`";

/// A field with its word, and the cause of the word.
pub(crate) fn said(field: &str, word: &str, because: Option<Arc<str>>) -> Arc<str> {
    let because = because.map(|because| format!(" ({because})")).unwrap_or_default();
    format!("`{field}: {word}`{because}").into()
}

/// Counts of vertices, instances and invocations.
pub(crate) const MANY: Form = Form::Whole(1, u32::MAX as i64);
