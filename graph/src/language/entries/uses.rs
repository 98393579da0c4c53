//! `use`: a fragment is put in under a name of its own, with arguments for its parameters.

use super::body::Tables;
use super::condition::{CONDITION, Condition};
use super::fragments::Fragments;
use super::repeat::REPEAT;
use super::stand_ins::{OTHERWISE, StandInList};
use super::values::optional;
use super::{cadence, parameters, views};
use crate::base::{Code, Diagnostic, Span, enumerated};
use crate::expression::{Expression, Outcome, Type, Value, WantedTypes};
use crate::fields;
use crate::frame::Cadence;
use crate::language::model::SettingKind;
use crate::language::scope::{Context, DecidedValue, FieldValue, Parameter, ParameterKind, Symbols, joined};
use crate::ron::{Form, Leaf, Name, PlainForm, Reader, Shape};
use std::collections::{HashMap, HashSet};

fields! {
    /// A use: it puts a fragment in.
    /// ```ron
    /// (use: "halve", name: "half", with: {"source": "image", "target": "target"}, when: "bloom")
    /// ```
    pub(crate) struct UseFields<'src> as "Use" {
        /// The fragment's name.
        pub(crate) r#use: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// Its own name: all that it puts in is named `NAME.…`, in Plans too.
        pub(crate) name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// The view that all it puts in is for; the first if left out.
        pub(crate) view: Option<Leaf<'src>> => views::NAME,
        /// In [which frames](#passes-that-dont-run-in-every-frame) its passes run that don't say it themselves; always if left out.
        pub(crate) run: Option<Leaf<'src>> => cadence::RUN,
        /// The name of an index, and how often the entry is repeated.
        pub(crate) repeat: Option<Leaf<'src>> => REPEAT,
        /// Values for the fragment's parameters, by their names.
        pub(crate) with: Option<Leaf<'src>> => Form::Map("parameter", &ARGUMENT),
        /// A condition: if it is false, nothing is put in.
        pub(crate) when: Option<Leaf<'src>> => CONDITION,
        /// Stand-ins: contents of the images that it would write, if nothing is put in.
        pub(crate) otherwise: Option<Leaf<'src>> => OTHERWISE,
    }
}

/// A value for a parameter.
const ARGUMENT: Form = Form::Either(&[
    Form::Plain(PlainForm::Truth),
    Form::Plain(PlainForm::Number),
    parameters::FORMAT,
    Form::Expression("an image, a buffer, or an expression"),
]);

/// A use that a file says.
pub(crate) struct UseEntry {
    pub(crate) name: Name,
    /// The fragment, by number.
    pub(crate) fragment: usize,
    pub(crate) condition: FieldValue<Condition>,
    /// In which frames its passes run that don't say it themselves.
    pub(crate) run: Option<FieldValue<Cadence>>,
    /// The stand-ins for when it is off.
    pub(crate) otherwise: Option<StandInList>,
    /// Values for the fragment's parameters, in their order.
    pub(crate) arguments: Vec<Option<Argument>>,
}

/// A value for a parameter, and where it stands, unless it is the parameter's default.
#[derive(Clone)]
pub(crate) struct Argument {
    pub(crate) value: FieldValue<DecidedValue>,
    pub(crate) span: Option<Span>,
}

impl Context<'_> {
    /// A use of one of the fragments.
    pub(crate) fn use_entry(&mut self, fields: &UseFields<'_>, fragments: &Fragments<Tables<'_>>) -> Option<UseEntry> {
        let name = self.reader.name(fields.name, "a use");
        let fragment = self.reader.reference(fields.r#use, "a fragment");
        let fragment = fragment.and_then(|name| fragments.names.find(self.reader, &name));
        let condition = self.condition(fields.when);
        let run = optional(fields.run, |leaf| self.cadence(leaf));
        let otherwise = self.otherwise(fields.otherwise, fields.when);
        let found = fragment.and_then(|at| Some((fragments.called(at), &*fragments.get(at)?.symbols)));
        let arguments = found.map(|found| self.arguments(fields, found));
        let (fragment, arguments) = (fragment?, arguments?);
        Some(UseEntry { name: name?, fragment, condition: condition?, run: run?, otherwise: otherwise?, arguments })
    }

    /// Values for the parameters of the fragment `called` so, in their order; `None` where there is none, which was reported.
    fn arguments(&mut self, fields: &UseFields<'_>, (called, symbols): (&str, &Symbols)) -> Vec<Option<Argument>> {
        let mut leaves: HashMap<usize, Leaf<'_>> = HashMap::new();
        let entries: Vec<(Leaf<'_>, Leaf<'_>)> =
            fields.with.and_then(|with| self.reader.map(with, "`with`")).into_iter().flatten().collect();
        let given: HashSet<&str> = entries.iter().filter_map(|(key, _)| key.plain()).collect();
        for (key, value) in entries {
            let Some(name) = self.reader.reference(key, "a parameter") else { continue };
            let Some(at) = symbols.names.at(&name.text) else {
                if symbols.names.complete() {
                    let unknown = format!("fragment `{called}` has no parameter named `{}`", name.text);
                    let open = symbols.names.in_order().filter(|name| !given.contains(name));
                    let other = if symbols.names.in_order().next().is_some() { "other " } else { "" };
                    let none = format!("fragment `{called}` has no {other}parameters");
                    let help = self.reader.known(&name.text, open).or(Some(none));
                    self.reader
                        .report(Diagnostic { help, ..Diagnostic::new(Code::UNKNOWN_PARAMETER, name.span, unknown) });
                }
                continue;
            };
            if leaves.insert(at, value).is_some() {
                self.reader.report(Diagnostic::new(
                    Code::LISTED_TWICE,
                    name.span,
                    format!("`with` names `{}` twice", name.text),
                ));
            }
        }
        let mut missing = Vec::new();
        let mut values = Vec::with_capacity(symbols.parameters.len());
        for (at, parameter) in symbols.parameters.iter().enumerate() {
            let Some(parameter) = parameter else {
                values.push(None);
                continue;
            };
            values.push(match leaves.get(&at) {
                Some(leaf) => self.argument(*leaf, parameter).map(|value| Argument { value, span: Some(leaf.span()) }),
                None => {
                    let default = parameter.default();
                    if default.is_none() {
                        missing.push(parameter);
                    }
                    default.map(|value| Argument { value: FieldValue::Constant(value.into()), span: None })
                }
            });
        }
        if let Some(first) = missing.first() {
            let example = |parameter: &&&Parameter| {
                let value = match parameter.kind.ty() {
                    Type::Image => "\"an_image\"",
                    Type::Buffer => "\"a_buffer\"",
                    _ => "…",
                };
                format!("\"{}\": {value}", parameter.name.text)
            };
            let examples: Vec<String> = missing.iter().map(|it| example(&it)).collect();
            let names = enumerated(missing.iter().map(|parameter| format!("`{}`", parameter.name.text)));
            let what = if missing.len() == 1 { "parameter" } else { "parameters" };
            let message = format!("fragment `{called}` needs the {what} {names}");
            let wrong = Diagnostic::new(Code::PARAMETER_MISSING, fields.r#use.span(), message)
                .label(first.name.span, "declared here, without default");
            self.reader.report(wrong.help(format!("add `with: {{{}}}`", examples.join(", "))));
        }
        values
    }

    fn argument(&mut self, leaf: Leaf<'_>, parameter: &Parameter) -> Option<FieldValue<DecidedValue>> {
        match &parameter.kind {
            ParameterKind::Image => Some(self.image(leaf)?.map(|image| Value::Image(image.index).into())),
            ParameterKind::Buffer => Some(self.buffer(leaf)?.map(|buffer| Value::Buffer(buffer.index).into())),
            ParameterKind::Format { .. } => match leaf.shape() {
                Shape::Text => self.expression(leaf, WantedTypes::FORMAT).map(evaluated),
                _ => {
                    let format = parameters::format(self.reader, leaf)?;
                    Some(FieldValue::Constant(Value::Format(format).into()))
                }
            },
            ParameterKind::Value(kind) => {
                let given = match leaf.shape() {
                    Shape::Text => {
                        self.unquoted(leaf, kind)?;
                        evaluated(self.expression(leaf, wanted(kind))?)
                    }
                    _ => FieldValue::Constant(plain(self.reader, leaf, parameter, kind)?.into()),
                };
                self.allowed(leaf, &parameter.name, kind.clone(), given)
            }
        }
    }

    /// Reports a word that stands where an expression is wanted, and is meant for a text: nothing is called so.
    fn unquoted(&mut self, leaf: Leaf<'_>, kind: &SettingKind) -> Option<()> {
        let SettingKind::Choice { of, .. } = kind else { return Some(()) };
        let Some(word) = leaf.plain().filter(|word| self.scope.names_nothing(word)) else { return Some(()) };
        let known = of.iter().any(|text| **text == *word);
        let meant: Vec<_> = of.iter().filter(|text| !known || ***text == *word).collect();
        let all = enumerated(meant.iter().map(|text| format!("`\"'{text}'\"`")));
        let message = format!("texts in expressions stand in single quotes, found `{word}`");
        let unquoted = Diagnostic::new(Code::TEXT_WITHOUT_QUOTES, leaf.span(), message);
        let unquoted = unquoted.help(format!("write it in single quotes inside the quotes: {all}"));
        self.reader.report(unquoted);
        None
    }

    fn allowed(
        &mut self,
        leaf: Leaf<'_>,
        Name { text, span }: &Name,
        kind: SettingKind,
        given: FieldValue<DecidedValue>,
    ) -> Option<FieldValue<DecidedValue>> {
        let (at, text, span) = (leaf.span(), text.clone(), *span);
        given.checked(self.reader, move |given, _| {
            if kind.allows(&given.value) {
                return Ok(given);
            }
            let because = joined(&given.decided);
            let message = format!("parameter `{text}` doesn't allow `{}`", given.value);
            let wrong =
                Diagnostic::new(Code::VALUE_NOT_ALLOWED, at, message).remark(because.as_deref().unwrap_or_default());
            Err(wrong.label(span, "declared here").help(format!("it is {}", kind.allowed())))
        })
    }
}

/// The value of an expression, and all decisions behind it.
fn evaluated(expression: Expression) -> FieldValue<DecidedValue> {
    FieldValue::computed(move |evaluator| {
        let Outcome { value, decided, .. } = evaluator.evaluate(&expression)?;
        Some(DecidedValue { value, decided })
    })
}

const fn wanted(kind: &SettingKind) -> WantedTypes<'static> {
    match kind {
        SettingKind::Bool { .. } => WantedTypes::BOOL,
        SettingKind::OneOf { .. } | SettingKind::Integer { .. } => WantedTypes::INTEGER,
        SettingKind::Number { .. } => WantedTypes::NUMBER,
        SettingKind::Choice { .. } => WantedTypes::TEXT,
    }
}

/// A value that stands by itself, without quotes.
fn plain(reader: &mut Reader, leaf: Leaf<'_>, parameter: &Parameter, kind: &SettingKind) -> Option<Value> {
    match kind {
        SettingKind::Bool { .. } => reader.truth(leaf).map(Value::Bool),
        SettingKind::OneOf { .. } | SettingKind::Integer { .. } => reader.integer(leaf).map(Value::Integer),
        SettingKind::Number { .. } => {
            let what = format!("parameter `{}`", parameter.name.text);
            reader.number_as(leaf, Some(&what)).map(Value::Number)
        }
        SettingKind::Choice { .. } => {
            reader.expected(leaf, "a text in single quotes within quotes");
            None
        }
    }
}
