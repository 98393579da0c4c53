//! Values that a file says, with their causes.

use crate::base::Span;
use crate::expression::Decision;
use crate::ron::Spanned;
use std::sync::Arc;

/// A value, its place, and its cause: the settings and facts that decided it.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
    /// The cause in words, if the value has one: "msaa = 4".
    pub because: Option<Arc<str>>,
    /// The settings and facts that decided the value.
    pub by: Decisions,
}

/// Settings, facts, and properties of the view and the device that decided something, each once. Most values have none, so
/// it is no larger than a pointer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Decisions(Option<Arc<Vec<Decision>>>);

impl Decisions {
    /// The decisions of an expression.
    pub(crate) fn new(decided: Vec<Decision>) -> Decisions {
        Decisions((!decided.is_empty()).then(|| Arc::new(decided)))
    }

    /// The decisions, in the order of reading.
    #[must_use]
    pub fn all(&self) -> &[Decision] {
        self.0.as_ref().map_or(&[], |all| all.as_slice())
    }

    /// Whether these are the very same decisions, not merely equal ones.
    pub(crate) fn are_same(&self, other: &Decisions) -> bool {
        match (&self.0, &other.0) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            (one, other) => one.is_none() && other.is_none(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.0.is_none()
    }

    /// These decisions, then those of `other` that are not among them.
    #[must_use]
    pub fn and(&self, other: &Decisions) -> Decisions {
        match (self.is_empty(), other.is_empty()) {
            (_, true) => self.clone(),
            (true, _) => other.clone(),
            _ => {
                let new = other.all().iter().filter(|decision| !self.all().contains(decision));
                Decisions::new(self.all().iter().chain(new).cloned().collect())
            }
        }
    }
}

impl<T> Decided<T> {
    /// A value that the file says itself.
    pub(crate) const fn said(span: Span, value: T) -> Decided<T> {
        Decided { value, span, because: None, by: Decisions(None) }
    }

    /// A value that is computed from this one, with the same cause.
    pub(crate) fn map<U>(self, make: impl FnOnce(T) -> U) -> Decided<U> {
        Decided { value: make(self.value), span: self.span, because: self.because, by: self.by }
    }

    /// A value that is computed from two. Its causes are those of both, and its place is that of the first.
    pub(crate) fn and<U, V>(self, other: Decided<U>, make: impl FnOnce(T, U) -> V) -> Decided<V> {
        let because = match (self.because, other.because) {
            (Some(one), Some(other)) => Some(format!("{one}, {other}").into()),
            (one, other) => one.or(other),
        };
        Decided { value: make(self.value, other.value), span: self.span, because, by: self.by.and(&other.by) }
    }

    /// The value and its place alone.
    pub(crate) fn spanned(self) -> Spanned<T> {
        Spanned { value: self.value, span: self.span }
    }

    /// The cause as a remark; empty if the value has none.
    pub(crate) fn remark(&self) -> &str {
        self.because.as_deref().unwrap_or_default()
    }
}
