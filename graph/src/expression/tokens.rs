//! Words and signs of an expression's text.

use super::program::shown;
use crate::base::Code;
use std::ops::Range;

/// A mistake in a text, and its bytes.
#[derive(Debug)]
pub(super) struct Mistake {
    pub(super) code: Code,
    pub(super) range: Range<usize>,
    pub(super) message: String,
    pub(super) help: Option<String>,
}

impl Mistake {
    /// Text that can't be understood, unless another code is given.
    pub(super) fn new(range: Range<usize>, message: impl Into<String>) -> Mistake {
        Mistake { code: Code::EXPRESSION_SYNTAX, range, message: message.into(), help: None }
    }

    pub(super) fn code(self, code: Code) -> Mistake {
        Mistake { code, ..self }
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Mistake {
        self.help = Some(help.into());
        self
    }
}

/// A word or sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Token<'a> {
    /// Digits alone.
    Integer(&'a str),
    /// With a point or an exponent.
    Number(&'a str),
    /// The text between single quotes.
    Text(&'a str),
    /// `levels`, `scene.has_opaque`.
    Name(&'a str),
    /// One of [`SIGNS`].
    Sign(&'static str),
    End,
}

/// Signs that begin like shorter signs come first.
const SIGNS: [&str; 19] =
    ["||", "&&", "==", "!=", "<=", ">=", "<", ">", "+", "-", "*", "/", "%", "!", "(", ")", "[", "]", ","];

/// A token and its bytes.
#[derive(Debug, Clone)]
pub(super) struct PlacedToken<'a> {
    pub(super) token: Token<'a>,
    pub(super) range: Range<usize>,
}

/// The token at or after byte `at`, blanks left out.
pub(super) fn next(text: &str, at: usize) -> Result<PlacedToken<'_>, Mistake> {
    let rest = &text[at..];
    let start = at + (rest.len() - rest.trim_start().len());
    let rest = &text[start..];
    let placed = |token, length| Ok(PlacedToken { token, range: start..start + length });
    let Some(first) = rest.chars().next() else { return placed(Token::End, 0) };
    if first.is_ascii_digit() {
        let (length, whole) = number(rest);
        let after = rest[length..].find(|c: char| !(word(c) || c == '.')).unwrap_or(rest.len() - length);
        if after > 0 {
            let odd = &rest[..length + after];
            let help = "numbers are written `12`, `0.5` or `1e-3`";
            return Err(Mistake::new(start..start + odd.len(), format!("{} is no number", shown(odd))).help(help));
        }
        let digits = &rest[..length];
        return placed(if whole { Token::Integer(digits) } else { Token::Number(digits) }, length);
    }
    if first.is_alphabetic() || first == '_' {
        return name(rest, start).and_then(|length| placed(Token::Name(&rest[..length]), length));
    }
    if first == '\'' {
        return match rest[1..].find('\'') {
            Some(length) => placed(Token::Text(&rest[1..=length]), length + 2),
            None => Err(Mistake::new(start..text.len(), "this text has no end").help("texts end with `'`")),
        };
    }
    match SIGNS.into_iter().find(|sign| rest.starts_with(sign)) {
        Some(sign) => placed(Token::Sign(sign), sign.len()),
        None => Err(unexpected(first, start)),
    }
}

fn word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn digits(text: &str) -> usize {
    text.bytes().take_while(u8::is_ascii_digit).count()
}

/// How many bytes of `text` are a number, and whether it is digits alone.
fn number(text: &str) -> (usize, bool) {
    let whole = digits(text);
    let mut length = whole;
    if let Some(fraction) = text[length..].strip_prefix('.').map(digits).filter(|digits| *digits > 0) {
        length += 1 + fraction;
    }
    if let Some(after) = text[length..].strip_prefix(['e', 'E']) {
        let sign = usize::from(after.starts_with(['+', '-']));
        let exponent = digits(&after[sign..]);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    (length, length == whole)
}

/// How many bytes of `text`, which begins at `start`, are a name and the names after points.
fn name(text: &str, start: usize) -> Result<usize, Mistake> {
    let mut length = 0;
    loop {
        length += text[length..].find(|c| !word(c)).unwrap_or(text.len() - length);
        if !text[length..].starts_with('.') {
            return Ok(length);
        }
        length += 1;
        if !text[length..].starts_with(|c: char| c.is_alphabetic() || c == '_') {
            let message = format!("a name is missing after {}", shown(&text[..length]));
            return Err(Mistake::new(start..start + length, message));
        }
    }
}

/// A character that begins nothing.
fn unexpected(found: char, start: usize) -> Mistake {
    let mistake = Mistake::new(start..start + found.len_utf8(), format!("unexpected `{found}` in an expression"));
    match found {
        '=' => mistake.help("write `==`"),
        '&' => mistake.help("write `&&`"),
        '|' => mistake.help("write `||`"),
        '"' | '“' | '”' | '‘' | '’' | '`' => mistake.help("texts stand in single quotes: `'high'`"),
        '^' => mistake.help("powers are written `pow(a, b)`"),
        '?' | ':' => mistake.help("a choice is written `if(condition, a, b)`"),
        '.' => mistake.help("numbers begin with a digit: `0.5`"),
        '≤' => mistake.help("write `<=`"),
        '≥' => mistake.help("write `>=`"),
        '≠' => mistake.help("write `!=`"),
        '×' | '·' => mistake.help("write `*`"),
        _ => mistake,
    }
}
