//! Numbers as people read them.

/// A number, as it is shown: whole ones without a fraction, very large and small ones with an exponent.
pub(crate) fn shown_number(number: f64) -> String {
    let text = format!("{number:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}
