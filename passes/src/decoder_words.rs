//! What decoders of pictures say, for people.

use std::fmt::Display;

/// The words of a decoder's error, with the name of a PNG chunk in place of its value in Rust's own form.
#[must_use]
pub fn decoder_words(error: impl Display) -> String {
    let words = error.to_string();
    let Some((before, behind)) = words.split_once("ChunkType { type: ") else { return words.trim_end().to_owned() };
    let name = behind.split([',', ' ', '}']).next().unwrap_or_default();
    let rest = behind.split_once('}').map_or("", |(_, rest)| rest);
    format!("{before}{name}{rest}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_value_is_shown_in_rusts_own_form() {
        let crc = "CRC error: expected 0x9d have 0x25 while decoding ChunkType { type: IDAT, critical: true } chunk.";
        assert_eq!(decoder_words(crc), "CRC error: expected 0x9d have 0x25 while decoding IDAT chunk.");
        assert_eq!(decoder_words("Unknown chunk: ChunkType { type: ABCD }"), "Unknown chunk: ABCD");
        assert_eq!(decoder_words("expected 16 but found 1\n"), "expected 16 but found 1");
        assert_eq!(decoder_words("no { here"), "no { here");
    }
}
