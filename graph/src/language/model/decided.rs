//! Values that a file says, with their causes.

use crate::base::Span;
use crate::ron::Spanned;
use std::sync::Arc;

/// A value, its place, and its cause: the settings and facts that decided it.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
    /// The cause, if the value has one: "msaa = 4".
    pub because: Option<Arc<str>>,
}

impl<T> Decided<T> {
    /// A value that the file says itself.
    pub(crate) const fn said(span: Span, value: T) -> Decided<T> {
        Decided { value, span, because: None }
    }

    /// A value that is computed from this one, with the same cause.
    pub(crate) fn map<U>(self, make: impl FnOnce(T) -> U) -> Decided<U> {
        Decided { value: make(self.value), span: self.span, because: self.because }
    }

    /// A value that is computed from two. Its causes are those of both, and its place is that of the first.
    pub(crate) fn and<U, V>(self, other: Decided<U>, make: impl FnOnce(T, U) -> V) -> Decided<V> {
        let because = match (self.because, other.because) {
            (Some(one), Some(other)) => Some(format!("{one}, {other}").into()),
            (one, other) => one.or(other),
        };
        Decided { value: make(self.value, other.value), span: self.span, because }
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
