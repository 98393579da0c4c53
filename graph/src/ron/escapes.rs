//! Escapes in texts: `\n`, `\"`, `\x41`, `\u{1F600}`, and a line break that is left out.

use std::ops::Range;

/// The text that is meant, or the bytes of the first escape that means nothing.
pub(crate) fn undo(text: &str) -> Result<String, Range<usize>> {
    let mut plain = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(found) = text[at..].find('\\') {
        plain.push_str(&text[at..at + found]);
        let start = at + found;
        let rest = &text[start + 1..];
        let length = one(rest, &mut plain).ok_or_else(|| {
            let wrong = rest.chars().next().map_or(0, char::len_utf8);
            start..start + 1 + wrong
        })?;
        at = start + 1 + length;
    }
    plain.push_str(&text[at..]);
    Ok(plain)
}

/// Undoes the escape that `rest` goes on with after its `\`, and returns how many bytes it takes.
fn one(rest: &str, plain: &mut String) -> Option<usize> {
    let simple = match rest.chars().next()? {
        '\'' => '\'',
        '"' => '"',
        '\\' => '\\',
        'n' => '\n',
        'r' => '\r',
        't' => '\t',
        '0' => '\0',
        'x' => return bytes(rest, plain),
        'u' => {
            let digits = rest.strip_prefix("u{")?.split_once('}')?.0;
            let fits = (1..=6).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
            plain.push(char::from_u32(fits.then(|| u32::from_str_radix(digits, 16).ok())??)?);
            return Some(digits.len() + 3);
        }
        '\n' | '\r' => {
            let line = rest.strip_prefix('\r').unwrap_or(rest).strip_prefix('\n')?;
            let next = line.trim_start_matches([' ', '\t', '\n', '\r']);
            return Some(rest.len() - next.len());
        }
        _ => return None,
    };
    plain.push(simple);
    Some(1)
}

/// A character as one to four bytes in UTF-8: `x41` or `xC3\xA4`.
fn bytes(rest: &str, plain: &mut String) -> Option<usize> {
    let mut bytes = Vec::with_capacity(4);
    let mut left = rest.strip_prefix('x')?;
    while bytes.len() < 4 {
        let digits = left.get(..2).filter(|two| two.bytes().all(|byte| byte.is_ascii_hexdigit()))?;
        bytes.push(u8::from_str_radix(digits, 16).ok()?);
        left = &left[2..];
        if let Ok(character) = std::str::from_utf8(&bytes) {
            plain.push_str(character);
            return Some(rest.len() - left.len());
        }
        left = left.strip_prefix("\\x")?;
    }
    None
}
