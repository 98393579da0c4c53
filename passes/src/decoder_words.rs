//! What decoders of pictures say, for people.

use std::fmt::Display;

/// The words of a decoder's error, without values in Rust's own form: `CRC error while decoding ChunkType { type: IDAT, … } chunk` loses
/// all behind `while decoding`.
#[must_use]
pub fn decoder_words(error: impl Display) -> String {
    let words = error.to_string();
    let behind = |word: &str| words.find(word).map(|at| words[..at].trim_end());
    let told = behind(" while decoding ChunkType").or_else(|| behind(" {")).unwrap_or(&words);
    told.trim_end().trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_value_is_shown_in_rusts_own_form() {
        let crc = "CRC error: expected 0x9d have 0x25 while decoding ChunkType { type: IDAT, critical: true } chunk.";
        assert_eq!(decoder_words(crc), "CRC error: expected 0x9d have 0x25");
        assert_eq!(
            decoder_words("Unrecognized critical chunk: ChunkType { type: ABCD }"),
            "Unrecognized critical chunk: ChunkType"
        );
        assert_eq!(decoder_words("expected 16 but found 1\n"), "expected 16 but found 1");
        assert_eq!(decoder_words("it is empty"), "it is empty");
    }
}
