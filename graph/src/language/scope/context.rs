//! The context in which the entries of a file are read. It offers a method for each kind of value.

use super::evaluator::joined;
use super::field_value::FieldValue;
use super::lookup::{Scope, is_expression};
use super::parameter::{Parameter, ParameterKind};
use crate::base::{Code, Diagnostic, Span};
use crate::expression::{Expression, Value, WantedTypes};
use crate::language::model::{Decided, Decisions, SettingKind};
use crate::ron::{Leaf, Reader, Shape};

/// The context of an entry: the reader that mistakes are reported to, and the scope that names are looked up in. The files
/// of `entries` add methods to it, one for each kind of value: `samples(leaf)`, `size(leaf)`, `lifetime(leaf)`.
pub(crate) struct Context<'c> {
    pub(crate) reader: &'c mut Reader,
    pub(crate) scope: Scope<'c>,
}

/// A text in quotes, where a value is wanted.
pub(crate) enum Quoted<'c> {
    /// The plain name of a setting or parameter, and its number.
    Parameter(&'c Parameter, usize),
    /// Any other text.
    Expression(Expression),
}

impl<'c> Context<'c> {
    /// The value of a text in quotes: of a setting or parameter whose kind `fits`, or of an expression. `words` are as in
    /// [`Context::quoted`]. Comes with the setting whose plain name the text is: all its allowed values have to make sense.
    pub(crate) fn value(
        &mut self,
        leaf: Leaf<'_>,
        fits: impl Fn(&SettingKind) -> bool + Copy,
        wanted: WantedTypes<'static>,
        words: (&str, Option<&str>),
    ) -> Option<(FieldValue<Decided<Value>>, Option<&'c Parameter>)> {
        let span = leaf.span();
        Some(match self.quoted(leaf, fits, wanted, words)? {
            Quoted::Parameter(parameter, at) => {
                let setting = Some(parameter).filter(|_| self.scope.symbols.settings);
                (FieldValue::computed(move |evaluator| evaluator.parameter(at, span)), setting)
            }
            Quoted::Expression(expression) => (decided(expression, span), None),
        })
    }

    /// The setting whose plain name stands in quotes, if it is one.
    pub(crate) fn setting(&self, leaf: Leaf<'_>) -> Option<&'c Parameter> {
        let symbols = self.scope.symbols;
        let plain = leaf.plain().filter(|plain| symbols.settings && !self.scope.is_index(plain))?;
        symbols.parameters.get(symbols.names.at(plain)?)?.as_ref()
    }

    /// The expression that stands at `leaf`, checked.
    pub(crate) fn expression(&mut self, leaf: Leaf<'_>, wanted: WantedTypes<'_>) -> Option<Expression> {
        match (leaf.shape(), leaf.plain()) {
            (Shape::Text, Some(text)) => match Expression::new(text, leaf.span_of(text), &self.scope, wanted) {
                Ok(expression) => Some(expression),
                Err(errors) => {
                    errors.into_iter().for_each(|error| self.reader.report(error));
                    None
                }
            },
            (Shape::Text, None) => {
                self.reader.wrong(
                    Code::EXPRESSION_SYNTAX,
                    leaf,
                    "expressions take no escapes",
                    "write the characters themselves",
                );
                None
            }
            _ => {
                self.reader.expected(leaf, &format!("{}, or an expression in quotes", wanted.words));
                None
            }
        }
    }

    /// A plain name or an expression in quotes. Reports a plain name that nothing has, and a setting whose kind doesn't fit.
    /// `words` name the values that would fit, and `literal` those that may stand there without quotes, if any may.
    pub(crate) fn quoted(
        &mut self,
        leaf: Leaf<'_>,
        fits: impl Fn(&SettingKind) -> bool + Copy,
        wanted: WantedTypes<'_>,
        (words, literal): (&str, Option<&str>),
    ) -> Option<Quoted<'c>> {
        let symbols = self.scope.symbols;
        let plain = leaf.plain().unwrap_or_default();
        let thing = symbols.images.at(plain).is_some() || symbols.buffers.at(plain).is_some();
        let other = thing && symbols.names.at(plain).is_none();
        let word = matches!(plain, "true" | "false") || crate::vulkan::Format::from_name(plain).is_some();
        if plain.is_empty() || is_expression(plain) || self.scope.is_index(plain) || other || word {
            return self.expression(leaf, wanted).map(Quoted::Expression);
        }
        let name = self.reader.reference(leaf, if symbols.settings { "a setting" } else { "a parameter" })?;
        let fitting = |at: usize| match symbols.parameters.get(at).and_then(Option::as_ref) {
            Some(Parameter { kind: ParameterKind::Value(kind), .. }) => fits(kind),
            _ => false,
        };
        let at = symbols.names.find_fitting(self.reader, &name, fitting, literal)?;
        let parameter = symbols.parameters.get(at)?.as_ref()?;
        let ParameterKind::Value(kind) = &parameter.kind else {
            return self.expression(leaf, wanted).map(Quoted::Expression);
        };
        if !fits(kind) {
            let (word, text) = (symbols.parameter_word(), &name.text);
            let message = format!("{word} `{text}` is {}; {words} is needed here", kind.words());
            self.reader.report(
                Diagnostic::new(Code::WRONG_KIND, name.span, message).label(parameter.name.span, "declared here"),
            );
            return None;
        }
        Some(Quoted::Parameter(parameter, at))
    }
}

/// The value of an expression that stands at `span`, and its cause.
pub(crate) fn decided(expression: Expression, span: Span) -> FieldValue<Decided<Value>> {
    FieldValue::computed(move |evaluator| {
        let outcome = evaluator.evaluate(&expression)?;
        let (because, by) = (joined(&outcome.decided), Decisions::new(outcome.decided));
        Some(Decided { value: outcome.value, span, because, by })
    })
}
