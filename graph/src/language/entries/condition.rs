//! `when`: a condition that switches an entry off.

use crate::language::model::Off;
use crate::language::scope::Scope;
use crate::ron::{Form, Leaf, Reader, Shape};

/// What `when` takes.
pub(crate) const CONDITION: Form = Form::Expression("a condition");

/// Whether a pass runs: `Some(None)`, or why it doesn't.
pub(crate) fn when<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Option<Off>> {
    let Shape::Text = leaf.shape() else {
        reader.expected(leaf, "a condition in quotes");
        return None;
    };
    let outcome = scope.condition(reader, leaf)?;
    Some(outcome.map(|because| Off { span: leaf.span(), because }))
}

/// A field that may be absent: `None` if it is there and wrong.
pub(crate) fn optional<'src, T>(
    leaf: Option<Leaf<'src>>,
    lower: impl FnOnce(Leaf<'src>) -> Option<T>,
) -> Option<Option<T>> {
    match leaf {
        Some(leaf) => lower(leaf).map(Some),
        None => Some(None),
    }
}
