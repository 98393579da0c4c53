//! Line endings of texts.

use std::borrow::Cow;

/// The text with `\n` for each `\r\n`: what digests count, so that they are the same in a checkout that has other line endings.
#[must_use]
pub fn unix_lines(text: &str) -> Cow<'_, str> {
    if text.contains('\r') { Cow::Owned(text.replace("\r\n", "\n")) } else { Cow::Borrowed(text) }
}
