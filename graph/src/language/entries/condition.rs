//! `when`: a condition that switches an entry off.

use crate::expression::{Value, WantedTypes};
use crate::language::model::{Decided, Decisions, OffReason, SettingKind};
use crate::language::scope::{Context, FieldValue, FieldValueTuple, Quoted, within_view};
use crate::ron::{Form, Leaf, Shape};
use std::sync::Arc;

/// The form of `when`: a condition.
pub(crate) const CONDITION: Form = Form::Expression("a condition");

/// The outcome of a condition.
#[derive(Debug, Clone, Default)]
pub(crate) struct Condition {
    /// Why it doesn't hold; `None`: it holds.
    pub(crate) off: Option<OffReason>,
    /// The settings and facts that decided it.
    pub(crate) by: Decisions,
}

impl Context<'_> {
    /// Whether an entry with this condition is on, and why, in which view. `None` if the condition is wrong.
    pub(crate) fn condition(&mut self, when: Option<Leaf<'_>>) -> Option<FieldValue<Condition>> {
        let Some(when) = when else { return Some(FieldValue::Constant(Condition::default())) };
        let condition = self.when(when)?;
        Some(FieldValue::computed(move |evaluator| {
            let Condition { off, by } = condition.evaluate(evaluator)?;
            let view = evaluator.scope.view;
            let off = off.map(|OffReason { span, because }| OffReason { span, because: within_view(view, &because) });
            Some(Condition { off, by })
        }))
    }

    /// Whether a condition holds, and why.
    pub(crate) fn when(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Condition>> {
        let Shape::Text = leaf.shape() else {
            self.reader.expected(leaf, "a condition in quotes");
            return None;
        };
        let span = leaf.span();
        let fits = |kind: &SettingKind| matches!(kind, SettingKind::Bool { .. });
        Some(match self.quoted(leaf, fits, WantedTypes::BOOL, ("`true` or `false`", None))? {
            Quoted::Parameter(parameter, at) => {
                let unknown: Arc<str> = format!("`{}` is false", parameter.name.text).into();
                FieldValue::computed(move |evaluator| evaluator.parameter(at, span)).map(
                    move |Decided { value, because, by, .. }| {
                        let because = || because.as_ref().unwrap_or(&unknown).to_string();
                        let off = (value != Value::Bool(true)).then(|| OffReason { span, because: because() });
                        Condition { off, by }
                    },
                )
            }
            Quoted::Expression(condition) => FieldValue::computed(move |evaluator| {
                let outcome = evaluator.evaluate(&condition)?;
                let off = outcome.failed.as_ref().map(|failed| {
                    let because = outcome.because();
                    let unknown = || format!("`{}` does not hold", failed.text);
                    OffReason { span, because: if because.is_empty() { unknown() } else { because } }
                });
                Some(Condition { off, by: Decisions::new(outcome.decided) })
            }),
        })
    }
}
