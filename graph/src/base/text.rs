//! Numbers and line endings in texts.

use std::borrow::Cow;

/// A number, as it is shown: whole ones without a fraction, very large and small ones with an exponent.
pub(crate) fn shown_number(number: f64) -> String {
    let text = format!("{number:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// The text with `\n` for each `\r\n`: what digests count, so that they are the same in a checkout that has other line endings.
#[must_use]
pub fn unix_lines(text: &str) -> Cow<'_, str> {
    if text.contains('\r') { Cow::Owned(text.replace("\r\n", "\n")) } else { Cow::Borrowed(text) }
}
