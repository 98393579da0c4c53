//! JSON as glTF uses it. A whole number may be written with a point (RFC 8259, section 6, knows one kind of number), and a
//! mistake names its field.

use serde::Deserialize;
use serde_json::value::RawValue;
use serde_json::{Deserializer, Value};

/// Whole numbers below this are exact in 64-bit floats.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// Reads a whole text.
///
/// # Errors
/// The mistake with its field and place, escaped.
pub(super) fn text<'j, T: Deserialize<'j>>(json: &'j str) -> Result<T, String> {
    let mut reader = Deserializer::from_str(json);
    let read = serde_path_to_error::deserialize(&mut reader).map_err(|error| words(&error, true))?;
    reader.end().map_err(|error| escaped(&error.to_string()))?;
    Ok(read)
}

/// Part of a text that was read before, with whole numbers as such.
///
/// # Errors
/// In words, escaped: if it is nested too deep.
pub(super) fn value(raw: &RawValue) -> Result<Value, String> {
    let mut value = serde_json::from_str(raw.get()).map_err(|error| escaped(without_place(&error.to_string())))?;
    whole_numbers(&mut value);
    Ok(value)
}

/// Reads a value.
///
/// # Errors
/// The mistake with its field, escaped.
pub(super) fn read<T: for<'a> Deserialize<'a>>(value: Value) -> Result<T, String> {
    serde_path_to_error::deserialize(value).map_err(|error| words(&error, false))
}

fn whole_numbers(value: &mut Value) {
    match value {
        Value::Number(number) => {
            let whole = number.as_f64().filter(|it| number.is_f64() && it.fract() == 0.0 && it.abs() < EXACT);
            if let Some(whole) = whole {
                *value = Value::from(whole as i64);
            }
        }
        Value::Array(values) => values.iter_mut().for_each(whole_numbers),
        Value::Object(members) => members.values_mut().for_each(whole_numbers),
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}

/// The field and the parser's words; without its place where that counts from the start of an element.
fn words(error: &serde_path_to_error::Error<serde_json::Error>, place: bool) -> String {
    let (field, words) = (error.path().to_string(), error.inner().to_string());
    let (said, place) = match words.rfind(" at line ") {
        Some(end) if place => words.split_at(end),
        Some(end) => (&words[..end], ""),
        None => (&words[..], ""),
    };
    let said = match EXPECTED.iter().find_map(|(rusts, ours)| Some((said.strip_suffix(rusts)?, ours))) {
        Some((beginning, ours)) => format!("{beginning}{ours}"),
        None => {
            said.split_once(", expected struct ").map_or(said.to_owned(), |(is, _)| format!("{is}, expected an object"))
        }
    };
    // So it is called where there is none.
    let field = if matches!(&*field, "." | "?") { String::new() } else { format!("{field}: ") };
    escaped(&format!("{field}{said}{place}"))
}

/// The parser's names of types, and JSON's.
const EXPECTED: [(&str, &str); 5] = [
    ("expected u64", "expected a whole number, 0 or more"),
    ("expected u32", "expected a whole number, 0 or more"),
    ("expected f64", "expected a number"),
    ("expected a sequence", "expected a list"),
    ("expected a map", "expected an object"),
];

fn without_place(words: &str) -> &str {
    words.rfind(" at line ").map_or(words, |end| &words[..end])
}

fn escaped(words: &str) -> String {
    words.escape_debug().to_string().replace("\\'", "'").replace("\\\"", "\"")
}
