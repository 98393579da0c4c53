//! Values of fields: constant, or found at each lowering from settings, parameters, images and
//! surroundings.

use super::evaluator::{Evaluator, within_view};
use crate::base::Diagnostic;
use crate::language::model::Decided;
use crate::ron::{Leaf, Name, Reader, Spanned};
use std::sync::Arc;

/// The bounds of all values of fields: they are kept in a document, and copied into pipelines.
pub(crate) trait FieldContents: Clone + Send + Sync + 'static {}

impl<T: Clone + Send + Sync + 'static> FieldContents for T {}

/// A closure that finds a value.
type Compute<T> = dyn Fn(&mut Evaluator<'_, '_>) -> Option<T> + Send + Sync;

/// A value of a field: a constant, or a closure that is evaluated at each lowering.
#[derive(Clone)]
pub(crate) enum FieldValue<T> {
    /// The file says it.
    Constant(T),
    /// It is found at each lowering; `None` if there is none, which is reported then.
    Computed(Arc<Compute<T>>),
}

impl<T: FieldContents> FieldValue<T> {
    pub(crate) fn computed(
        compute: impl Fn(&mut Evaluator<'_, '_>) -> Option<T> + Send + Sync + 'static,
    ) -> FieldValue<T> {
        FieldValue::Computed(Arc::new(compute))
    }

    /// A value that is computed from this one, if there is one.
    pub(crate) fn then<U: FieldContents>(
        self,
        make: impl Fn(T) -> Option<U> + Send + Sync + 'static,
    ) -> Option<FieldValue<U>> {
        match self {
            FieldValue::Constant(value) => make(value).map(FieldValue::Constant),
            FieldValue::Computed(compute) => {
                Some(FieldValue::computed(move |evaluator| compute(evaluator).and_then(&make)))
            }
        }
    }

    /// A value that is computed from this one.
    pub(crate) fn map<U: FieldContents>(self, make: impl Fn(T) -> U + Send + Sync + 'static) -> FieldValue<U> {
        combined(self, make)
    }

    /// A value that is computed from this one, or a mistake. The mistake is reported to `reader` if the value is constant; else
    /// it is a fault at each lowering, see [`Evaluator::fault`]. The second argument is the view of the entry, unless it is
    /// the main one.
    pub(crate) fn checked<U: FieldContents>(
        self,
        reader: &mut Reader,
        check: impl Fn(T, Option<&Name>) -> Result<U, Diagnostic> + Send + Sync + 'static,
    ) -> Option<FieldValue<U>> {
        self.checked_as(reader, false, check)
    }

    /// As [`checked`](FieldValue::checked). If the file says the wrong part of the value itself (`said`), the mistake is always
    /// reported, never a fault.
    pub(crate) fn checked_as<U: FieldContents>(
        self,
        reader: &mut Reader,
        said: bool,
        check: impl Fn(T, Option<&Name>) -> Result<U, Diagnostic> + Send + Sync + 'static,
    ) -> Option<FieldValue<U>> {
        match self {
            FieldValue::Constant(value) => {
                check(value, None).map_err(|wrong| reader.report(wrong)).ok().map(FieldValue::Constant)
            }
            FieldValue::Computed(compute) => Some(FieldValue::computed(move |evaluator| {
                let value = compute(evaluator)?;
                let checked = check(value, evaluator.scope.view);
                let tell = |wrong| if said { evaluator.reader.report(wrong) } else { evaluator.fault(wrong) };
                checked.map_err(tell).ok()
            })),
        }
    }
}

impl<T: FieldContents> FieldValue<Decided<T>> {
    /// The same value. Its cause names the view unless that is the main one, as messages outside of the entry need it.
    pub(crate) fn within_view(self) -> Self {
        let FieldValue::Computed(compute) = self else { return self };
        FieldValue::computed(move |evaluator| {
            let decided = compute(evaluator)?;
            let because = decided.because.map(|because| within_view(evaluator.scope.view, &because).into());
            Some(Decided { because, ..decided })
        })
    }

    /// A value that `leaf` says itself.
    pub(crate) fn said(leaf: Leaf<'_>, value: T) -> Self {
        FieldValue::Constant(Decided::said(leaf.span(), value))
    }

    /// The same value, at the place of `leaf`.
    pub(crate) fn at(self, leaf: Leaf<'_>) -> Self {
        let span = leaf.span();
        self.map(move |decided| Decided { span, ..decided })
    }

    /// A value that is computed from this one, with the same cause.
    pub(crate) fn of<U: FieldContents>(self, make: impl Fn(T) -> U + Send + Sync + 'static) -> FieldValue<Decided<U>> {
        self.map(move |decided| decided.map(&make))
    }

    /// The value and its place alone.
    pub(crate) fn spanned(self) -> FieldValue<Spanned<T>> {
        self.map(Decided::spanned)
    }

    /// The value alone.
    pub(crate) fn alone(self) -> FieldValue<T> {
        self.map(|decided| decided.value)
    }
}

/// Values of an entry that belong together: one, a tuple or a list of them, or none.
pub(crate) trait FieldValueTuple: Send + Sync + 'static {
    /// The values.
    type Values: FieldContents;

    /// Whether the file says all values.
    fn is_constant(&self) -> bool;

    /// All values, if the file says them.
    fn into_constants(self) -> Option<Self::Values>;

    /// All values. Each is evaluated, so that all mistakes are told.
    fn evaluate(&self, evaluator: &mut Evaluator<'_, '_>) -> Option<Self::Values>;
}

/// A value that may be missing because it couldn't be read: the others are evaluated all the same.
pub(crate) struct ReadableValue<P>(pub(crate) Option<P>);

/// A value that is computed from several values.
pub(crate) fn combined<P: FieldValueTuple, T: FieldContents>(
    parts: P,
    make: impl Fn(P::Values) -> T + Send + Sync + 'static,
) -> FieldValue<T> {
    if parts.is_constant() {
        let values = parts.into_constants().expect("the file says all values");
        return FieldValue::Constant(make(values));
    }
    FieldValue::computed(move |evaluator| parts.evaluate(evaluator).map(&make))
}

/// A value that is computed from several values, with mistakes that `make` reports: now if all are constant, else at each
/// lowering.
pub(crate) fn reported<P: FieldValueTuple, T: FieldContents>(
    reader: &mut Reader,
    parts: P,
    make: impl Fn(&mut Reader, P::Values) -> Option<T> + Send + Sync + 'static,
) -> Option<FieldValue<T>> {
    if parts.is_constant() {
        return make(reader, parts.into_constants()?).map(FieldValue::Constant);
    }
    Some(FieldValue::computed(move |evaluator| {
        let values = parts.evaluate(evaluator)?;
        make(evaluator.reader, values)
    }))
}

impl<T: FieldContents> FieldValueTuple for FieldValue<T> {
    type Values = T;

    fn is_constant(&self) -> bool {
        matches!(self, FieldValue::Constant(_))
    }

    fn into_constants(self) -> Option<T> {
        if let FieldValue::Constant(value) = self { Some(value) } else { None }
    }

    fn evaluate(&self, evaluator: &mut Evaluator<'_, '_>) -> Option<T> {
        match self {
            FieldValue::Constant(value) => Some(value.clone()),
            FieldValue::Computed(compute) => compute(evaluator),
        }
    }
}

impl<P: FieldValueTuple> FieldValueTuple for Option<P> {
    type Values = Option<P::Values>;

    fn is_constant(&self) -> bool {
        self.as_ref().is_none_or(P::is_constant)
    }

    fn into_constants(self) -> Option<Self::Values> {
        self.map_or(Some(None), |part| part.into_constants().map(Some))
    }

    fn evaluate(&self, evaluator: &mut Evaluator<'_, '_>) -> Option<Self::Values> {
        self.as_ref().map_or(Some(None), |part| part.evaluate(evaluator).map(Some))
    }
}

impl<P: FieldValueTuple> FieldValueTuple for ReadableValue<P> {
    type Values = Option<P::Values>;

    fn is_constant(&self) -> bool {
        self.0.as_ref().is_some_and(P::is_constant)
    }

    fn into_constants(self) -> Option<Self::Values> {
        self.0?.into_constants().map(Some)
    }

    fn evaluate(&self, evaluator: &mut Evaluator<'_, '_>) -> Option<Self::Values> {
        Some(self.0.as_ref().and_then(|part| part.evaluate(evaluator)))
    }
}

impl<P: FieldValueTuple> FieldValueTuple for Vec<P> {
    type Values = Vec<P::Values>;

    fn is_constant(&self) -> bool {
        self.iter().all(P::is_constant)
    }

    fn into_constants(self) -> Option<Self::Values> {
        self.into_iter().map(P::into_constants).collect()
    }

    fn evaluate(&self, evaluator: &mut Evaluator<'_, '_>) -> Option<Self::Values> {
        let mut values = Vec::with_capacity(self.len());
        for part in self {
            values.extend(part.evaluate(evaluator));
        }
        (values.len() == self.len()).then_some(values)
    }
}

impl<P: FieldValueTuple, const N: usize> FieldValueTuple for [P; N] {
    type Values = [P::Values; N];

    fn is_constant(&self) -> bool {
        self.iter().all(P::is_constant)
    }

    fn into_constants(self) -> Option<Self::Values> {
        all(self.map(P::into_constants))
    }

    fn evaluate(&self, evaluator: &mut Evaluator<'_, '_>) -> Option<Self::Values> {
        all(self.each_ref().map(|part| part.evaluate(evaluator)))
    }
}

/// All of several values; `None` if one is missing.
pub(crate) fn all<T, const N: usize>(values: [Option<T>; N]) -> Option<[T; N]> {
    let values: Option<Vec<T>> = values.into_iter().collect();
    values?.try_into().ok()
}

macro_rules! tuples {
    ($($part:ident)*) => {
        impl<$($part: FieldValueTuple),*> FieldValueTuple for ($($part,)*) {
            type Values = ($($part::Values,)*);

            #[allow(non_snake_case, reason = "parts have the names of their types")]
            fn is_constant(&self) -> bool {
                let ($($part,)*) = self;
                $($part.is_constant())&&*
            }

            #[allow(non_snake_case, reason = "parts have the names of their types")]
            fn into_constants(self) -> Option<Self::Values> {
                let ($($part,)*) = self;
                Some(($($part.into_constants()?,)*))
            }

            #[allow(non_snake_case, reason = "parts have the names of their types")]
            fn evaluate(&self, evaluator: &mut Evaluator<'_, '_>) -> Option<Self::Values> {
                let ($($part,)*) = self;
                let ($($part,)*) = ($($part.evaluate(evaluator),)*);
                Some(($($part?,)*))
            }
        }
    };
}

tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
tuples!(A B C D E);
tuples!(A B C D E F);
