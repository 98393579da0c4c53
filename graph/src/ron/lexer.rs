//! Blanks, comments, words, texts and numbers: the parts of a file without brackets.

use super::node::Kind;
use super::{escapes, numbers};
use crate::base::{Code, Diagnostic, Span};
use std::ops::Range;

/// Walks over a text. Mistakes are returned, not kept.
pub(crate) struct Lexer<'t> {
    pub(crate) file: u32,
    pub(crate) text: &'t str,
    /// Everything before this byte was read.
    pub(crate) at: usize,
    /// The last text in quotes that runs over several lines, if any: its closing quote may be missing.
    pub(crate) long: Option<Range<usize>>,
}

/// Why a value could not be read.
pub(crate) enum Stop {
    /// The value is wrong, but where the next one begins is clear.
    Value(Diagnostic),
    /// The value is wrong, and an item stands in brackets where it can't: the brackets may not be closed.
    Misplaced(Diagnostic),
    /// The rest of the file can't be read.
    File(Diagnostic),
}

/// Whether a character separates, and means nothing else.
fn is_blank(c: char) -> bool {
    matches!(
        c,
        ' ' | '\t' | '\n' | '\r' | '\x0B' | '\x0C' | '\u{85}' | '\u{200E}' | '\u{200F}' | '\u{2028}' | '\u{2029}'
    )
}

impl<'t> Lexer<'t> {
    pub(crate) fn byte(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    pub(crate) fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }

    pub(crate) fn span(&self, range: Range<usize>) -> Span {
        let offset = |at| u32::try_from(at).unwrap_or(u32::MAX);
        Span::new(self.file, offset(range.start), offset(range.end))
    }

    pub(crate) fn diagnostic(&self, code: Code, range: Range<usize>, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, self.span(range), message)
    }

    /// The character at `at`, as a range; empty at the end of the text.
    pub(crate) fn character(&self, at: usize) -> Range<usize> {
        at..at + self.text[at..].chars().next().map_or(0, char::len_utf8)
    }

    /// The text ends where more was expected; `open` is the bracket that is not closed.
    pub(crate) fn ends(&self, open: Option<usize>) -> Stop {
        let end = self.text.trim_end_matches(is_blank).len();
        let ends = self.diagnostic(Code::NOT_CLOSED, self.character(end), "the file ends in the middle of a value");
        let ends = match open {
            Some(open) => ends.label(self.span(open..open + 1), "opened here"),
            None => ends,
        };
        Stop::File(ends.help("is a bracket or a quote left open?"))
    }

    fn open_quote(&self, quote: usize) -> Stop {
        Stop::File(
            self.diagnostic(Code::NOT_CLOSED, quote..quote + 1, "this text has no end").help("close it with a quote"),
        )
    }

    /// Passes over blanks and comments, of which there are none before most brackets and commas.
    #[inline]
    pub(crate) fn blanks(&mut self) -> Result<(), Stop> {
        match self.byte() {
            None | Some(b'!'..=b'.' | b'0'..=b'~') => Ok(()),
            Some(_) => self.some_blanks(),
        }
    }

    fn some_blanks(&mut self) -> Result<(), Stop> {
        let bytes = self.text.as_bytes();
        loop {
            let mut at = self.at;
            while let Some(b' ' | b'\n' | b'\r' | b'\t') = bytes.get(at) {
                at += 1;
            }
            self.at = at;
            match bytes.get(at) {
                Some(b'/') => self.comment()?,
                Some(0x0B | 0x0C | 0x80..) => match self.rest().chars().next().filter(|c| is_blank(*c)) {
                    Some(blank) => self.at += blank.len_utf8(),
                    None => return Ok(()),
                },
                _ => return Ok(()),
            }
        }
    }

    fn comment(&mut self) -> Result<(), Stop> {
        let start = self.at;
        let bytes = self.text.as_bytes();
        match bytes.get(start + 1) {
            Some(b'/') => self.at = self.rest().find('\n').map_or(self.text.len(), |line| start + line),
            Some(b'*') => {
                self.at += 2;
                let mut level = 1_usize;
                while level > 0 {
                    match bytes.get(self.at..).unwrap_or_default() {
                        [b'*', b'/', ..] => (level, self.at) = (level - 1, self.at + 2),
                        [b'/', b'*', ..] => (level, self.at) = (level + 1, self.at + 2),
                        [_, ..] => self.at += 1,
                        [] => {
                            let open = self.diagnostic(Code::NOT_CLOSED, start..start + 2, "this comment has no end");
                            return Err(Stop::File(open.help("close it with `*/`, once for each `/*` within")));
                        }
                    }
                }
            }
            _ => {
                self.at += 1;
                let alone = self.diagnostic(Code::RON_SYNTAX, start..self.at, "unexpected character `/`");
                return Err(Stop::Value(alone.help("a comment begins with `//` or `/*`")));
            }
        }
        Ok(())
    }

    /// How many bytes the word takes that stands here; 0 if none does.
    pub(crate) fn word(&self) -> usize {
        let bytes = &self.text.as_bytes()[self.at..];
        let ascii = bytes.iter().take_while(|byte| byte.is_ascii_alphanumeric() || **byte == b'_').count();
        match bytes {
            [b'0'..=b'9', ..] => 0,
            // A raw text, bytes or a byte.
            [b'r', b'"', ..]
            | [b'r', b'#', b'"' | b'#', ..]
            | [b'b', b'"' | b'\'', ..]
            | [b'b', b'r', b'"' | b'#', ..] => 0,
            _ if bytes.get(ascii).is_none_or(u8::is_ascii) => ascii,
            _ => {
                let mut characters = self.rest().chars();
                match characters.next() {
                    Some(first) if first == '_' || unicode_ident::is_xid_start(first) => {
                        let more: usize =
                            characters.take_while(|c| unicode_ident::is_xid_continue(*c)).map(char::len_utf8).sum();
                        first.len_utf8() + more
                    }
                    _ => 0,
                }
            }
        }
    }

    /// A text, a number, bytes or a character; `None` if none of them begins here.
    pub(crate) fn scalar(&mut self) -> Option<Result<Kind, Stop>> {
        let start = self.at;
        match (self.byte()?, self.text.as_bytes().get(start + 1)) {
            (b'"', _) => Some(self.quoted()),
            (b'0'..=b'9' | b'+' | b'-' | b'.', _) => Some(self.number()),
            (b'r', Some(b'"' | b'#')) => self.raw(start + 1, Kind::Raw),
            (b'\'', _) => Some(self.one_character(start)),
            (b'b', Some(b'\'')) => Some(self.one_character(start + 1)),
            (b'b', Some(b'"')) => {
                self.at += 1;
                Some(self.quoted().map(|_| Kind::Other))
            }
            (b'b', Some(b'r')) => self.raw(start + 2, Kind::Other),
            _ => None,
        }
    }

    /// The byte behind the quote that closes the text which begins behind `open`.
    fn closing(&self, open: usize) -> Option<(usize, bool)> {
        let bytes = self.text.as_bytes();
        let (mut at, mut escaped) = (open, false);
        loop {
            match bytes.get(at)? {
                b'"' => return Some((at + 1, escaped)),
                b'\\' => (at, escaped) = (at + 2, true),
                _ => at += 1,
            }
        }
    }

    fn quoted(&mut self) -> Result<Kind, Stop> {
        let start = self.at;
        let Some((end, escaped)) = self.closing(start + 1) else { return Err(self.open_quote(start)) };
        self.at = end;
        let inner = &self.text[start + 1..end - 1];
        if inner.contains('\n') {
            self.long = Some(start..end);
        }
        if !escaped {
            return Ok(Kind::Text);
        }
        match escapes::undo(inner) {
            Ok(_) => Ok(Kind::Escaped),
            Err(wrong) => {
                let range = start + 1 + wrong.start..start + 1 + wrong.end;
                let shown = self.text[range.clone()].escape_debug().to_string();
                let wrong = self.diagnostic(
                    Code::RON_SYNTAX,
                    range,
                    format!("`{}` stands for no character", shown.replace("\\\\", "\\")),
                );
                let help =
                    "a `\\` begins an escape such as `\\n`, `\\\"` or `\\u{e4}`; write `\\\\` for the character itself";
                Err(Stop::Value(wrong.help(help)))
            }
        }
    }

    /// `"text"` or `#"text"#` from byte `from`.
    fn raw(&mut self, from: usize, kind: Kind) -> Option<Result<Kind, Stop>> {
        let rest = &self.text[from..];
        let hashes = rest.bytes().take_while(|byte| *byte == b'#').count();
        let inner = rest[hashes..].strip_prefix('"')?;
        let closing = format!("\"{}", &rest[..hashes]);
        let Some(end) = inner.find(&closing) else { return Some(Err(self.open_quote(self.at))) };
        self.at = from + hashes + 1 + end + closing.len();
        Some(Ok(kind))
    }

    /// `'c'` from byte `from`.
    fn one_character(&mut self, from: usize) -> Result<Kind, Stop> {
        let start = self.at;
        let inner = &self.text[from + 1..];
        let length = match inner.as_bytes() {
            [b'\\', _, more @ ..] => 2 + more.iter().take(16).take_while(|byte| **byte != b'\'').count(),
            _ => inner.chars().next().map_or(0, char::len_utf8),
        };
        let one = inner.get(..length).filter(|_| inner[length..].starts_with('\''));
        let meant = one.and_then(|one| if one.starts_with('\\') { escapes::undo(one).ok() } else { Some(one.into()) });
        self.at = from + 1;
        if meant.is_none_or(|meant| meant.chars().count() != 1) {
            let wrong = self.diagnostic(Code::RON_SYNTAX, start..from + 1, "this quote begins no single character");
            return Err(Stop::Value(wrong.help("texts stand in `\"`")));
        }
        self.at += length + 1;
        Ok(Kind::Other)
    }

    fn number(&mut self) -> Result<Kind, Stop> {
        let start = self.at;
        let bytes = &self.text.as_bytes()[start..];
        let length = bytes
            .iter()
            .take_while(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'+' | b'-'))
            .count();
        self.at += length;
        let text = &self.text[start..self.at];
        let plain = text.bytes().all(|byte| byte.is_ascii_digit());
        if plain || numbers::parse(text).is_some() {
            return Ok(Kind::Number);
        }
        Err(Stop::Value(self.diagnostic(Code::RON_SYNTAX, start..self.at, format!("`{text}` is no number"))))
    }
}
