//! The text of a file: UTF-8, behind a byte order mark or without one.

/// The byte order mark, which some programs write before UTF-8.
const MARK: char = '\u{feff}';

/// Why the bytes of a file are no text: the end of a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoText {
    /// They are text of another encoding.
    #[error("it is {0}: save it as UTF-8")]
    Encoding(&'static str),
    /// A byte is no part of UTF-8.
    #[error("byte {at} is 0x{byte:02X}, which is not UTF-8")]
    Byte {
        /// Its place, from 0.
        at: usize,
        /// The byte.
        byte: u8,
    },
}

impl NoText {
    /// The same without the value of the byte.
    #[must_use]
    pub fn brief(&self) -> String {
        match self {
            NoText::Encoding(_) => self.to_string(),
            NoText::Byte { at, .. } => format!("byte {at} is not UTF-8"),
        }
    }
}

/// The text of a file, without its byte order mark.
///
/// # Errors
/// [`NoText`] names the encoding that it has instead, or the first byte that isn't UTF-8.
pub fn text_of(bytes: &[u8]) -> Result<&str, NoText> {
    if let Some(encoding) = other_encoding(bytes) {
        return Err(NoText::Encoding(encoding));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        NoText::Byte { at, byte: bytes.get(at).copied().unwrap_or_default() }
    })?;
    Ok(without_mark(text))
}

/// A text without its byte order mark.
#[must_use]
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix(MARK).unwrap_or(text)
}

/// The name of an encoding whose units have more than a byte, if the file begins like one: with its byte order mark, or with two letters
/// of ASCII.
#[must_use]
pub fn other_encoding(bytes: &[u8]) -> Option<&'static str> {
    let in_units = |unit: usize| bytes.len().is_multiple_of(unit);
    match bytes {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] if in_units(4) => Some("UTF-32"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] if in_units(2) => Some("UTF-16"),
        [1..0x80, 0, 1..0x80, 0, ..] | [0, 1..0x80, 0, 1..0x80, ..] if in_units(2) => Some("UTF-16"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_order_mark_is_no_part_of_the_text() {
        assert_eq!(text_of(b"\xef\xbb\xbfa\xc3\xa9"), Ok("aé"));
        assert_eq!(text_of(b"a\xef\xbb\xbf"), Ok("a\u{feff}"), "only at the beginning");
        assert_eq!(text_of(b""), Ok(""));
    }

    #[test]
    fn other_encodings_are_told_by_their_names() {
        let encoded = |unit: fn(u16) -> [u8; 2], text: &str| text.encode_utf16().flat_map(unit).collect::<Vec<u8>>();
        for text in ["\u{feff}Pipeline(", "Pipeline("] {
            for unit in [u16::to_le_bytes, u16::to_be_bytes] {
                assert_eq!(text_of(&encoded(unit, text)), Err(NoText::Encoding("UTF-16")), "{text}");
            }
        }
        for unit in [u32::to_le_bytes, u32::to_be_bytes] {
            let bytes: Vec<u8> = "\u{feff}Pipeline(".chars().flat_map(|letter| unit(letter.into())).collect();
            assert_eq!(text_of(&bytes), Err(NoText::Encoding("UTF-32")));
        }
        assert_eq!(text_of(b"caf\xe9"), Err(NoText::Byte { at: 3, byte: 0xe9 }));
        // What is no text at all is not taken for one.
        assert_eq!(other_encoding(b"\x7fELF\x02\x01\0\0"), None);
        assert_eq!((other_encoding(b"a\0"), other_encoding(b"\xff\xfe\0")), (None, None));
    }
}
