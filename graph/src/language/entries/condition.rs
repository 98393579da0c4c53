//! `when`: a condition that switches an entry off.

use super::values::optional;
use crate::language::model::Off;
use crate::language::scope::Context;
use crate::ron::{Form, Leaf, Shape};

/// What `when` takes.
pub(crate) const CONDITION: Form = Form::Expression("a condition");

impl Context<'_, '_> {
    /// Why an entry with this condition is off, if it is, and in which view. `None` if the condition is wrong.
    pub(crate) fn off(&mut self, when: Option<Leaf<'_>>) -> Option<Option<Off>> {
        let off = optional(when, |leaf| self.when(leaf))?.flatten();
        Some(off.map(|Off { span, because }| Off { span, because: self.scope.within_view(&because) }))
    }

    /// Whether a pass runs: `Some(None)`, or why it doesn't.
    pub(crate) fn when(&mut self, leaf: Leaf<'_>) -> Option<Option<Off>> {
        let Shape::Text = leaf.shape() else {
            self.reader.expected(leaf, "a condition in quotes");
            return None;
        };
        let outcome = self.condition(leaf)?;
        Some(outcome.map(|because| Off { span: leaf.span(), because }))
    }
}
