//! Values of fields: known when the file is read, or found at each lowering from settings, parameters, images and
//! surroundings.

use super::evaluator::{Evaluator, within_view};
use crate::base::Diagnostic;
use crate::language::model::Decided;
use crate::ron::{Leaf, Name, Reader, Spanned};
use std::sync::Arc;

/// The bounds of all values of fields: they are kept in a document, and copied into pipelines.
pub(crate) trait Kept: Clone + Send + Sync + 'static {}

impl<T: Clone + Send + Sync + 'static> Kept for T {}

/// A closure that finds a value.
type Ask<T> = dyn Fn(&mut Evaluator<'_, '_>) -> Option<T> + Send + Sync;

/// A value of a field: a constant, or a closure that is evaluated at each lowering.
#[derive(Clone)]
pub(crate) enum Given<T> {
    /// The file says it.
    Known(T),
    /// It is found at each lowering; `None` if there is none, which is reported then.
    Asked(Arc<Ask<T>>),
}

impl<T: Kept> Given<T> {
    pub(crate) fn asked(ask: impl Fn(&mut Evaluator<'_, '_>) -> Option<T> + Send + Sync + 'static) -> Given<T> {
        Given::Asked(Arc::new(ask))
    }

    /// A value that is computed from this one, if there is one.
    pub(crate) fn then<U: Kept>(self, make: impl Fn(T) -> Option<U> + Send + Sync + 'static) -> Option<Given<U>> {
        match self {
            Given::Known(value) => make(value).map(Given::Known),
            Given::Asked(ask) => Some(Given::asked(move |evaluator| ask(evaluator).and_then(&make))),
        }
    }

    /// A value that is computed from this one.
    pub(crate) fn map<U: Kept>(self, make: impl Fn(T) -> U + Send + Sync + 'static) -> Given<U> {
        given(self, make)
    }

    /// A value that is computed from this one, or a mistake. The mistake is reported to `reader` if the value is known; else
    /// it is a fault at each lowering, see [`Evaluator::fault`]. The second argument is the view of the entry, unless it is
    /// the main one.
    pub(crate) fn checked<U: Kept>(
        self,
        reader: &mut Reader,
        check: impl Fn(T, Option<&Name>) -> Result<U, Diagnostic> + Send + Sync + 'static,
    ) -> Option<Given<U>> {
        self.checked_as(reader, false, check)
    }

    /// As [`checked`](Given::checked). If the file says the wrong part of the value itself (`said`), the mistake is always
    /// reported, never a fault.
    pub(crate) fn checked_as<U: Kept>(
        self,
        reader: &mut Reader,
        said: bool,
        check: impl Fn(T, Option<&Name>) -> Result<U, Diagnostic> + Send + Sync + 'static,
    ) -> Option<Given<U>> {
        match self {
            Given::Known(value) => check(value, None).map_err(|wrong| reader.report(wrong)).ok().map(Given::Known),
            Given::Asked(ask) => Some(Given::asked(move |evaluator| {
                let value = ask(evaluator)?;
                let checked = check(value, evaluator.scope.view);
                let tell = |wrong| if said { evaluator.reader.report(wrong) } else { evaluator.fault(wrong) };
                checked.map_err(tell).ok()
            })),
        }
    }

    /// Whether the file says the value.
    pub(crate) const fn is_known(&self) -> bool {
        matches!(self, Given::Known(_))
    }
}

impl<T: Kept> Given<Decided<T>> {
    /// The same value. Its cause names the view unless that is the main one, as messages outside of the entry need it.
    pub(crate) fn within_view(self) -> Self {
        let Given::Asked(ask) = self else { return self };
        Given::asked(move |evaluator| {
            let decided = ask(evaluator)?;
            let because = decided.because.map(|because| within_view(evaluator.scope.view, &because).into());
            Some(Decided { because, ..decided })
        })
    }

    /// A value that `leaf` says itself.
    pub(crate) fn said(leaf: Leaf<'_>, value: T) -> Self {
        Given::Known(Decided::said(leaf.span(), value))
    }

    /// The same value, at the place of `leaf`.
    pub(crate) fn at(self, leaf: Leaf<'_>) -> Self {
        let span = leaf.span();
        self.map(move |decided| Decided { span, ..decided })
    }

    /// A value that is computed from this one, with the same cause.
    pub(crate) fn of<U: Kept>(self, make: impl Fn(T) -> U + Send + Sync + 'static) -> Given<Decided<U>> {
        self.map(move |decided| decided.map(&make))
    }

    /// The value and its place alone.
    pub(crate) fn spanned(self) -> Given<Spanned<T>> {
        self.map(Decided::spanned)
    }

    /// The value alone.
    pub(crate) fn alone(self) -> Given<T> {
        self.map(|decided| decided.value)
    }
}

/// Values of an entry that belong together: one, a tuple or a list of them, or none.
pub(crate) trait GivenTuple: Send + Sync + 'static {
    /// The values.
    type Values: Kept;

    /// All values; without an evaluator only if all are known. Each is evaluated, so that all mistakes are told.
    fn find(&self, evaluator: Option<&mut Evaluator<'_, '_>>) -> Option<Self::Values>;

    /// All values.
    fn evaluate(&self, evaluator: &mut Evaluator<'_, '_>) -> Option<Self::Values> {
        self.find(Some(evaluator))
    }
}

/// A value that is computed from several values.
pub(crate) fn given<P: GivenTuple, T: Kept>(
    parts: P,
    make: impl Fn(P::Values) -> T + Send + Sync + 'static,
) -> Given<T> {
    match parts.find(None) {
        Some(values) => Given::Known(make(values)),
        None => Given::asked(move |evaluator| parts.evaluate(evaluator).map(&make)),
    }
}

impl<T: Kept> GivenTuple for Given<T> {
    type Values = T;

    fn find(&self, evaluator: Option<&mut Evaluator<'_, '_>>) -> Option<T> {
        match self {
            Given::Known(value) => Some(value.clone()),
            Given::Asked(ask) => ask(evaluator?),
        }
    }
}

impl<P: GivenTuple> GivenTuple for Option<P> {
    type Values = Option<P::Values>;

    fn find(&self, evaluator: Option<&mut Evaluator<'_, '_>>) -> Option<Self::Values> {
        self.as_ref().map_or(Some(None), |part| part.find(evaluator).map(Some))
    }
}

impl<P: GivenTuple> GivenTuple for Vec<P> {
    type Values = Vec<P::Values>;

    fn find(&self, mut evaluator: Option<&mut Evaluator<'_, '_>>) -> Option<Self::Values> {
        let mut values = Vec::with_capacity(self.len());
        for part in self {
            values.extend(part.find(evaluator.as_deref_mut()));
        }
        (values.len() == self.len()).then_some(values)
    }
}

impl<P: GivenTuple, const N: usize> GivenTuple for [P; N] {
    type Values = [P::Values; N];

    fn find(&self, mut evaluator: Option<&mut Evaluator<'_, '_>>) -> Option<Self::Values> {
        all(self.each_ref().map(|part| part.find(evaluator.as_deref_mut())))
    }
}

/// All of several values; `None` if one is missing.
pub(crate) fn all<T, const N: usize>(values: [Option<T>; N]) -> Option<[T; N]> {
    let values: Option<Vec<T>> = values.into_iter().collect();
    values?.try_into().ok()
}

macro_rules! tuples {
    ($($part:ident)*) => {
        impl<$($part: GivenTuple),*> GivenTuple for ($($part,)*) {
            type Values = ($($part::Values,)*);

            #[allow(non_snake_case, reason = "parts have the names of their types")]
            fn find(&self, mut evaluator: Option<&mut Evaluator<'_, '_>>) -> Option<Self::Values> {
                let ($($part,)*) = self;
                let ($($part,)*) = ($($part.find(evaluator.as_deref_mut()),)*);
                Some(($($part?,)*))
            }
        }
    };
}

tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
tuples!(A B C D E);
