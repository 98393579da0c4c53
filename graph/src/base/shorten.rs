//! How much messages repeat of files and lists: the one place where it is bounded.

use std::borrow::Cow;
use std::fmt::Display;

/// A text of at most this many bytes is never shortened.
const SHORT: usize = 1024;

/// A quote in backticks in a longer text has at most this many characters.
const LONGEST_QUOTE: usize = 160;

/// How many characters a shortened text keeps of its end.
const FROM_THE_END: usize = 40;

/// A text has at most this many characters.
const LONGEST: usize = 8192;

/// A list names at most this many of its entries.
pub(crate) const MOST_LISTED: usize = 12;

/// A message, remark or help of bounded length: its quotes in backticks are shortened first, in the middle.
pub(crate) fn bounded(text: &str) -> Cow<'_, str> {
    if text.len() <= SHORT {
        return Cow::Borrowed(text);
    }
    let mut shorter = String::with_capacity(SHORT);
    for (at, piece) in text.split('`').enumerate() {
        if at > 0 {
            shorter.push('`');
        }
        let quoted = at % 2 == 1;
        if quoted && piece.chars().nth(LONGEST_QUOTE).is_some() {
            shorter.extend(piece.chars().take(LONGEST_QUOTE - FROM_THE_END));
            shorter.push('…');
            let end = piece.char_indices().rev().nth(FROM_THE_END - 1).map_or(0, |(at, _)| at);
            shorter.push_str(&piece[end..]);
        } else {
            shorter.push_str(piece);
        }
        if shorter.len() > 4 * LONGEST {
            break;
        }
    }
    if let Some((end, _)) = shorter.char_indices().nth(LONGEST) {
        shorter.truncate(end);
        shorter.push('…');
    }
    Cow::Owned(shorter)
}

/// The entries of a list with commas between them, the first dozen if there are more, with how many follow.
pub(crate) fn enumerated<T: Display>(entries: impl ExactSizeIterator<Item = T>) -> String {
    let more = entries.len().saturating_sub(MOST_LISTED);
    let mut text = entries.take(MOST_LISTED).map(|entry| entry.to_string()).collect::<Vec<_>>().join(", ");
    if more > 0 {
        text.push_str(&format!(" and {more} more"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{LONGEST, bounded, enumerated};

    #[test]
    fn what_is_quoted_is_shortened_and_what_is_said_about_it_stays() {
        let long = "x".repeat(1 << 20);
        let shown = bounded(&format!("`{long}` is not a format of `image`, nor is `{long}end`")).into_owned();
        assert!(shown.len() < 400, "{shown}");
        assert!(
            shown.starts_with("`xxx") && shown.contains("x…x") && shown.contains("` is not a format of `image`, nor")
        );
        assert!(shown.ends_with("xend`"), "{shown}");
        assert_eq!(bounded("`short` is short"), "`short` is short");
    }

    #[test]
    fn no_text_is_longer_than_the_bound() {
        for text in ["ä".repeat(1 << 20), "`a` ".repeat(1 << 20), "`".repeat(1 << 20)] {
            assert!(bounded(&text).chars().count() <= LONGEST + 1);
        }
    }

    #[test]
    fn a_long_list_names_its_first_entries_and_counts_the_others() {
        assert_eq!(enumerated([1, 2, 4].iter()), "1, 2, 4");
        assert_eq!(enumerated((1..=12).collect::<Vec<_>>().iter()), "1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12");
        let million: Vec<u32> = (1..=1_000_000).collect();
        assert_eq!(enumerated(million.iter()), "1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 and 999988 more");
    }
}
