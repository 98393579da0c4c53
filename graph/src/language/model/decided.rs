//! Values that a file says, with what decided them.

use crate::base::Span;
use crate::ron::Spanned;
use std::sync::Arc;

/// A value, its place, and what decided it.
#[derive(Debug, Clone, PartialEq)]
pub struct Decided<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
    /// What decided it, if anything did: "msaa = 4".
    pub because: Option<Arc<str>>,
}

impl<T> Decided<T> {
    /// A value that the file says itself.
    pub(crate) const fn said(span: Span, value: T) -> Decided<T> {
        Decided { value, span, because: None }
    }

    /// What is made of the value; the same decided it.
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

    /// What decided it, as remarks have it.
    pub(crate) fn remark(&self) -> &str {
        self.because.as_deref().unwrap_or_default()
    }
}
