//! `when`: a condition that switches an entry off.

use crate::expression::{Value, Wanted};
use crate::language::model::{Decided, Off, SettingKind};
use crate::language::scope::{Context, FieldValue, FieldValueTuple, Quoted, within_view};
use crate::ron::{Form, Leaf, Shape};
use std::sync::Arc;

/// The form of `when`: a condition.
pub(crate) const CONDITION: Form = Form::Expression("a condition");

impl Context<'_> {
    /// Why an entry with this condition is off, if it is, and in which view. `None` if the condition is wrong.
    pub(crate) fn off(&mut self, when: Option<Leaf<'_>>) -> Option<FieldValue<Option<Off>>> {
        let Some(when) = when else { return Some(FieldValue::Constant(None)) };
        let off = self.when(when)?;
        Some(FieldValue::computed(move |evaluator| {
            let off = off.evaluate(evaluator)?;
            let view = evaluator.scope.view;
            Some(off.map(|Off { span, because }| Off { span, because: within_view(view, &because) }))
        }))
    }

    /// Whether a pass runs: `None`, or why it doesn't.
    pub(crate) fn when(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Option<Off>>> {
        let Shape::Text = leaf.shape() else {
            self.reader.expected(leaf, "a condition in quotes");
            return None;
        };
        let span = leaf.span();
        let fits = |kind: &SettingKind| matches!(kind, SettingKind::Bool { .. });
        Some(match self.quoted(leaf, fits, Wanted::BOOL, ("`true` or `false`", None))? {
            Quoted::Parameter(parameter, at) => {
                let unknown: Arc<str> = format!("`{}` is false", parameter.name.text).into();
                FieldValue::computed(move |evaluator| evaluator.parameter(at, span)).map(
                    move |Decided { value, because, .. }| {
                        let because = || because.as_ref().unwrap_or(&unknown).to_string();
                        (value != Value::Bool(true)).then(|| Off { span, because: because() })
                    },
                )
            }
            Quoted::Expression(condition) => FieldValue::computed(move |evaluator| {
                let outcome = evaluator.evaluate(&condition)?;
                let Some(failed) = &outcome.failed else { return Some(None) };
                let because = outcome.because();
                let because = if because.is_empty() { format!("`{}` does not hold", failed.text) } else { because };
                Some(Some(Off { span, because }))
            }),
        })
    }
}
