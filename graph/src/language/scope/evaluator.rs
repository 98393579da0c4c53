//! Where the values of entries are found at a lowering.

use super::asked::{Answers, Asked};
use super::field_value::FieldValueTuple;
use super::level::{DecidedValue, Elements, LevelValues, Properties};
use super::lookup::DeclaredResource;
use super::symbols::Symbols;
use crate::base::{Diagnostic, Label, Span};
use crate::expression::{Decision, Expression, Origin, Outcome, Value};
use crate::frame::{BufferIndex, ImageIndex, Resource};
use crate::language::inputs::{Read, Surroundings};
use crate::language::model::{Decided, Decisions, Image};
use crate::ron::{Name, Reader};
use std::sync::Arc;

/// The values of everything that a name in quotes may refer to. A handle, copied freely.
#[derive(Clone, Copy)]
pub(crate) struct ScopeValues<'a> {
    pub(crate) symbols: &'a Symbols,
    pub(crate) level: &'a LevelValues,
    /// Settings as the view at hand has them, or parameters; `None` where one has no value, which was reported.
    pub(crate) values: &'a [Option<DecidedValue>],
    pub(crate) surroundings: &'a Surroundings<'a>,
    /// Properties of the images that were evaluated so far, each `None` where a mistake was reported; `None`: they are put off.
    pub(crate) properties: Option<&'a [Option<Properties>]>,
    /// The images that were evaluated so far.
    pub(crate) images: &'a [Option<Arc<Image>>],
    /// The number of the repetition at hand.
    pub(crate) index: Option<u32>,
    /// The view that the entry is for, unless it is the main one.
    pub(crate) view: Option<&'a Name>,
    /// Where what is asked for is noted, if anywhere.
    pub(crate) answers: Option<&'a Answers>,
}

impl<'a> ScopeValues<'a> {
    /// The value of the setting or parameter with this number.
    pub(super) fn parameter(&self, at: usize) -> Option<&'a DecidedValue> {
        if self.symbols.settings {
            self.surroundings.note(Read::Setting(at));
        }
        let value = self.values.get(at).and_then(Option::as_ref);
        self.note(|| Asked::Parameter(at, value.cloned()));
        value
    }

    /// The images of a declaration of this level.
    pub(super) fn images_of(&self, at: usize) -> Option<Elements> {
        let elements = self.level.images.get(at).copied();
        self.note(|| Asked::Images(at, elements));
        elements
    }

    /// The buffers of a declaration of this level.
    pub(super) fn buffers_of(&self, at: usize) -> Option<Elements> {
        let elements = self.level.buffers.get(at).copied();
        self.note(|| Asked::Buffers(at, elements));
        elements
    }

    /// Notes a question and its answer.
    pub(super) fn note(&self, asked: impl FnOnce() -> Asked) {
        if let Some(answers) = self.answers {
            answers.borrow_mut().push(asked());
        }
    }
}

/// The evaluator of an entry: the scope in which its values are found, and the reader that mistakes are reported to.
pub(crate) struct Evaluator<'e, 'a> {
    pub(crate) reader: &'e mut Reader,
    pub(crate) scope: ScopeValues<'a>,
    /// Whether an expression without a value is no mistake, because it belongs to something that is off.
    pub(crate) lenient: bool,
    /// Whether an expression had no value, and that was no mistake.
    pub(crate) forgave: bool,
    /// The decisions behind the images and buffers that the entry uses.
    pub(crate) chosen: Decisions,
}

impl<'e, 'a> Evaluator<'e, 'a> {
    pub(crate) fn new(reader: &'e mut Reader, scope: ScopeValues<'a>, lenient: bool) -> Evaluator<'e, 'a> {
        Evaluator { reader, scope, lenient, forgave: false, chosen: Decisions::default() }
    }

    /// Evaluates something that may be `off`: then an expression without a value is no mistake.
    pub(crate) fn leniently<T>(&mut self, off: bool, evaluate: impl FnOnce(&mut Self) -> T) -> T {
        let lenient = self.lenient;
        self.lenient |= off;
        let value = evaluate(self);
        self.lenient = lenient;
        value
    }

    /// Puts in the values of a field; `None` if it couldn't be read, or has no value.
    pub(crate) fn put_in<P: FieldValueTuple>(&mut self, field: &Option<P>) -> Option<P::Values> {
        field.as_ref()?.evaluate(self)
    }

    /// The value of an expression, and the decisions behind it.
    pub(crate) fn evaluate(&mut self, expression: &Expression) -> Option<Outcome> {
        match expression.evaluate(&self.scope) {
            Ok(outcome) => Some(outcome),
            Err(errors) => {
                for mut error in errors {
                    if let Some(Label { text, .. }) = error.labels.first_mut() {
                        *text = within_view(self.scope.view, text);
                    }
                    self.fault(error);
                }
                self.forgave = true;
                None
            }
        }
    }

    /// Reports a mistake in the value of an expression, unless it belongs to something that is off.
    pub(crate) fn fault(&mut self, diagnostic: Diagnostic) {
        if self.lenient {
            self.forgave = true;
        } else {
            self.reader.report(diagnostic);
        }
    }

    /// The value of a setting or parameter that is named at `span`.
    pub(crate) fn parameter(&self, at: usize, span: Span) -> Option<Decided<Value>> {
        let DecidedValue { value, decided } = self.scope.parameter(at)?;
        let decided = if self.scope.symbols.settings {
            let name = self.scope.symbols.parameters.get(at)?.as_ref()?.name.text.clone();
            vec![Decision { name, origin: Origin::Setting, value: value.clone() }]
        } else {
            decided.clone()
        };
        Some(Decided { value: value.clone(), span, because: joined(&decided), by: Decisions::new(decided) })
    }

    /// The image or buffer that a declaration of this level stands for.
    pub(super) fn declared(&self, declared: DeclaredResource) -> Option<Resource> {
        let one = |elements: Option<Elements>| match elements {
            Some(Elements::At { first, .. }) => Some(first),
            _ => None,
        };
        match declared {
            DeclaredResource::Image(at) => one(self.scope.images_of(at)).map(|at| Resource::Image(ImageIndex(at))),
            DeclaredResource::Buffer(at) => one(self.scope.buffers_of(at)).map(|at| Resource::Buffer(BufferIndex(at))),
        }
    }

    /// The image or buffer that an expression means.
    pub(super) fn resource(&mut self, expression: &Expression) -> Option<Resource> {
        let Outcome { value, decided, .. } = self.evaluate(expression)?;
        if !decided.is_empty() {
            self.chosen = self.chosen.and(&Decisions::new(decided));
        }
        match value {
            Value::Image(index) => Some(Resource::Image(index)),
            Value::Buffer(index) => Some(Resource::Buffer(index)),
            _ => None,
        }
    }
}

/// The cause of a value, with the name of its view unless that is the main one.
pub(crate) fn within_view(view: Option<&Name>, because: &str) -> String {
    match view {
        Some(name) if !because.is_empty() => format!("{because} in view `{}`", name.text),
        _ => because.to_owned(),
    }
}

/// The decisions behind a value, for people: "msaa = 4, hdr = true".
pub(crate) fn joined(decided: &[Decision]) -> Option<Arc<str>> {
    let (first, others) = decided.split_first()?;
    let mut words = first.to_string();
    for other in others {
        words += &format!(", {other}");
    }
    Some(words.into())
}
