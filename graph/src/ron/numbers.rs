//! Numbers as RON writes them: `1`, `-0.5`, `1_000`, `1e-3`, `.5`, `0xff`, `0b1010`, `0o17`.

/// A number, by how it is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Number {
    /// Written without point and exponent.
    Whole(i64),
    /// Written without point and exponent, but beyond 64 bits; the nearest floating-point number.
    Huge(f64),
    /// Written with point or exponent; finite unless it is too large.
    Real(f64),
    /// `-inf` and the like.
    NotFinite,
}

/// The number that a text means, if it means one. Types behind the digits (`1u8`) are no part of numbers.
pub(crate) fn parse(text: &str) -> Option<Number> {
    let (negative, digits) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    // Eighteen digits stay below 2⁶³.
    if digits.len() <= 18 && digits.bytes().all(|byte| byte.is_ascii_digit()) && !digits.is_empty() {
        let number = digits.bytes().fold(0, |number, digit| 10 * number + i64::from(digit - b'0'));
        return Some(Number::Whole(if negative { -number } else { number }));
    }
    if matches!(digits, "inf" | "NaN") {
        return Some(Number::NotFinite);
    }
    for (prefix, base) in [("0x", 16), ("0b", 2), ("0o", 8)] {
        if let Some(digits) = digits.strip_prefix(prefix) {
            return based(negative, digits, base);
        }
    }
    let whole = digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'_');
    let mut plain = String::with_capacity(text.len());
    let mut previous = None;
    for c in text.chars() {
        match c {
            '_' if matches!(previous, Some('0'..='9' | 'e' | 'E')) => continue,
            '0'..='9' | '.' | '+' | '-' | 'e' | 'E' => plain.push(c),
            _ => return None,
        }
        previous = Some(c);
    }
    let real = plain.parse().ok()?;
    Some(match plain.parse() {
        Ok(number) if whole => Number::Whole(number),
        _ if whole => Number::Huge(real),
        _ => Number::Real(real),
    })
}

fn based(negative: bool, digits: &str, base: u32) -> Option<Number> {
    if digits.starts_with('_') {
        return None;
    }
    let digits: String = digits.chars().filter(|c| *c != '_').collect();
    // A sign here would be a second one.
    if digits.is_empty() || !digits.chars().all(|c| c.is_digit(base)) {
        return None;
    }
    let signed = if negative { format!("-{digits}") } else { digits };
    match i64::from_str_radix(&signed, base) {
        Ok(number) => Some(Number::Whole(number)),
        Err(_) => Some(Number::Huge(if negative { f64::NEG_INFINITY } else { f64::INFINITY })),
    }
}
