//! Spans of the crate `tracing`, for profilers.

/// Begins a span that ends with the block: `span!("record", frame = number)`. Without the feature `tracing` it is nothing, and its fields
/// aren't evaluated.
macro_rules! span {
    ($name:literal $(, $field:ident = $value:expr)*) => {
        #[cfg(feature = "tracing")]
        let _span = tracing::info_span!($name $(, $field = $value)*).entered();
    };
}

pub(crate) use span;
