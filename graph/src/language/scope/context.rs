//! The context in which the values of an entry are read and evaluated. It offers a method for each kind of value.

use super::level::DecidedValue;
use super::lookup::{Scope, is_expression, joined};
use super::parameter::{Parameter, ParameterKind};
use crate::base::{Diagnostic, Label};
use crate::expression::{Expression, Outcome, Value, Wanted};
use crate::language::model::SettingKind;
use crate::ron::{Leaf, Reader, Shape};
use std::rc::Rc;
use std::sync::Arc;

/// The context of an entry: the reader that mistakes are reported to, and the scope that names are looked up in. The files
/// of `entries` add methods to it, one for each kind of value: `samples(leaf)`, `size(leaf)`, `lifetime(leaf)`.
pub(crate) struct Context<'c, 'a> {
    pub(crate) reader: &'c mut Reader,
    pub(crate) scope: Scope<'a>,
    /// Whether an expression had no value, and that was no mistake.
    pub(crate) forgave: bool,
}

/// What a text in quotes is, where a value is wanted.
pub(crate) enum Quoted<'a> {
    /// The plain name of a setting or parameter, and its value.
    Parameter(&'a Parameter, &'a DecidedValue),
    /// Anything else.
    Expression,
}

/// The value of a text in quotes.
pub(crate) struct Evaluated<'a> {
    pub(crate) value: Value,
    /// What decided it: "msaa = 4".
    pub(crate) because: Option<Arc<str>>,
    /// The setting whose plain name the text is: all that it allows has to make sense.
    pub(crate) setting: Option<&'a Parameter>,
}

impl<'c, 'a> Context<'c, 'a> {
    pub(crate) const fn new(reader: &'c mut Reader, scope: Scope<'a>) -> Context<'c, 'a> {
        Context { reader, scope, forgave: false }
    }

    /// Evaluates something that may be `off`: then an expression without a value is no mistake.
    pub(crate) fn leniently<T>(&mut self, off: bool, evaluate: impl FnOnce(&mut Self) -> T) -> T {
        let lenient = self.scope.lenient;
        self.scope.lenient |= off;
        let value = evaluate(self);
        self.scope.lenient = lenient;
        value
    }

    /// The value of an expression, and what decided it.
    pub(crate) fn evaluate(&mut self, leaf: Leaf<'_>, wanted: Wanted<'_>) -> Option<Outcome> {
        let expression = self.check(leaf, wanted)?;
        match expression.evaluate(&self.scope) {
            Ok(outcome) => Some(outcome),
            Err(errors) => {
                for mut error in errors {
                    if let Some(Label { text, .. }) = error.labels.first_mut() {
                        *text = self.scope.within_view(text);
                    }
                    self.fault(leaf, error);
                }
                self.forgave = true;
                None
            }
        }
    }

    /// The value of a text in quotes: of a setting or parameter whose kind `fits`, or of an expression. `literal` is what may
    /// stand there without quotes, if anything may.
    pub(crate) fn value(
        &mut self,
        leaf: Leaf<'_>,
        fits: impl Fn(&SettingKind) -> bool + Copy,
        wanted: Wanted<'_>,
        (words, literal): (&str, Option<&str>),
    ) -> Option<Evaluated<'a>> {
        match self.quoted(leaf, fits, words, literal)? {
            Quoted::Parameter(parameter, value) => {
                let setting = Some(parameter).filter(|_| self.scope.symbols.settings);
                let because = self.scope.because(parameter, value);
                Some(Evaluated { value: value.value.clone(), because, setting })
            }
            Quoted::Expression => {
                let Outcome { value, decided, .. } = self.evaluate(leaf, wanted)?;
                Some(Evaluated { value, because: joined(&decided), setting: None })
            }
        }
    }

    /// A condition: `Some(None)` if it holds, else what made it fail.
    pub(crate) fn condition(&mut self, leaf: Leaf<'_>) -> Option<Option<String>> {
        let fits = |kind: &SettingKind| matches!(kind, SettingKind::Bool { .. });
        if let Quoted::Parameter(parameter, value) = self.quoted(leaf, fits, "`true` or `false`", None)? {
            let failed = || self.scope.because(parameter, value).map(|because| because.to_string());
            let holds = value.value == Value::Bool(true);
            return Some((!holds).then(|| failed().unwrap_or_else(|| format!("`{}` is false", parameter.name.text))));
        }
        let outcome = self.evaluate(leaf, Wanted::BOOL)?;
        let Some(failed) = &outcome.failed else { return Some(None) };
        let because = outcome.because();
        Some(Some(if because.is_empty() { format!("`{}` does not hold", failed.text) } else { because }))
    }

    /// The expression that stands at `leaf`, checked once.
    fn check(&mut self, leaf: Leaf<'_>, wanted: Wanted<'_>) -> Option<Rc<Expression>> {
        if let Some(known) = self.scope.checked.borrow().get(&leaf.span()) {
            return known.clone();
        }
        let expression = match (leaf.shape(), leaf.plain()) {
            (Shape::Text, Some(text)) => match Expression::new(text, leaf.span_of(text), &self.scope, wanted) {
                Ok(expression) => Some(Rc::new(expression)),
                Err(errors) => {
                    errors.into_iter().for_each(|error| self.reader.report(error));
                    None
                }
            },
            (Shape::Text, None) => {
                self.reader.wrong(leaf, "expressions take no escapes", "write the characters themselves");
                None
            }
            _ => {
                self.reader.expected(leaf, &format!("{}, or an expression in quotes", wanted.words));
                None
            }
        };
        self.scope.checked.borrow_mut().insert(leaf.span(), expression.clone());
        expression
    }

    /// Reports a mistake in a value, unless the value is an expression of something that is off.
    pub(crate) fn fault(&mut self, leaf: Leaf<'_>, diagnostic: Diagnostic) {
        if self.scope.lenient && matches!(leaf.shape(), Shape::Text) {
            self.forgave = true;
        } else {
            self.reader.report(diagnostic);
        }
    }

    /// What a text in quotes is. Reports a plain name that nothing has, and a setting whose kind doesn't fit; `wanted`
    /// says what would, and `literal` what may stand there without quotes, if anything may.
    pub(crate) fn quoted(
        &mut self,
        leaf: Leaf<'_>,
        fits: impl Fn(&SettingKind) -> bool + Copy,
        wanted: &str,
        literal: Option<&str>,
    ) -> Option<Quoted<'a>> {
        let plain = leaf.plain().unwrap_or_default();
        let index = self.scope.index.is_some_and(|(index, _)| *index.text == *plain);
        let thing = self.scope.symbols.images.at(plain).is_some() || self.scope.symbols.buffers.at(plain).is_some();
        let other = thing && self.scope.symbols.names.at(plain).is_none();
        if plain.is_empty() || is_expression(plain) || index || other {
            return Some(Quoted::Expression);
        }
        if matches!(plain, "true" | "false") || crate::vulkan::Format::from_name(plain).is_some() {
            return Some(Quoted::Expression);
        }
        let name =
            self.reader.reference(leaf, if self.scope.symbols.settings { "a setting" } else { "a parameter" })?;
        let fitting = |at: usize| match self.scope.symbols.parameters.get(at).and_then(Option::as_ref) {
            Some(Parameter { kind: ParameterKind::Value(kind), .. }) => fits(kind),
            _ => false,
        };
        let at = self.scope.symbols.names.find_fitting(self.reader, &name, fitting, literal)?;
        let parameter = self.scope.symbols.parameters.get(at)?.as_ref()?;
        let ParameterKind::Value(kind) = &parameter.kind else { return Some(Quoted::Expression) };
        if !fits(kind) {
            let (word, text) = (self.scope.symbols.parameter_word(), &name.text);
            let message = format!("{word} `{text}` is {}; {wanted} is needed here", kind.words());
            self.reader.report(Diagnostic::new(name.span, message).label(parameter.name.span, "declared here"));
            return None;
        }
        self.scope.values.get(at)?.as_ref().map(|value| Quoted::Parameter(parameter, value))
    }
}
