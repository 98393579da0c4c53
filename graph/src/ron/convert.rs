//! A file as JSON, in the way that [`schema`](crate::language::schema()) describes.

use super::{Leaf, Number, Shape};
use crate::base::{Code, Diagnostic};
use serde_json::{Map, Number as JsonNumber, Value, json};

/// A value of a file as JSON.
///
/// `(name: value)` becomes `{"name": value}`; `(a, b)` and `[a, b]` become `[a, b]`; `Word(…)` becomes `{"Word": …}` with the
/// contents of the parentheses, and `Word` alone `{"Word": []}`; `{"key": value}`, texts, numbers, `true` and `false` stay.
/// `Some(value)` is the value, and a field that is `None` is left out. A number that JSON doesn't have is a word.
///
/// # Errors
/// Values without such a form: fields and keys that stand twice, keys that are no texts, bytes and characters.
pub fn convert(leaf: Leaf<'_>) -> Result<Value, Vec<Diagnostic>> {
    let mut errors = Vec::new();
    let value = value(leaf, &mut errors);
    if errors.is_empty() { Ok(value) } else { Err(errors) }
}

fn value(leaf: Leaf<'_>, errors: &mut Vec<Diagnostic>) -> Value {
    match leaf.shape() {
        Shape::Text => json!(leaf.words().unwrap_or_default()),
        Shape::Number => number(leaf),
        Shape::Word("true", None) => json!(true),
        Shape::Word("false", None) => json!(false),
        Shape::Word("Some", Some(inside)) => match inside.tuple() {
            Some([inner]) => value(inner, errors),
            None => json!({ "Some": value(inside, errors) }),
        },
        Shape::Word(word, None) => json!({ word: [] }),
        Shape::Word(word, Some(inside)) => json!({ word: value(inside, errors) }),
        Shape::List => list(leaf, errors),
        Shape::Parentheses => match leaf.values() {
            Some(_) => list(leaf, errors),
            None => {
                let fields = leaf.fields().into_iter().flatten();
                let there = fields.filter(|(_, value)| !matches!(value.shape(), Shape::Word("None", None)));
                object(there.map(|(name, value)| (name, name.text().to_owned(), value)).collect(), errors)
            }
        },
        Shape::Map => {
            let mut entries = Vec::new();
            for (key, value) in leaf.entries().into_iter().flatten() {
                match key.words() {
                    Some(name) => entries.push((key, name.into_owned(), value)),
                    None => errors.push(Diagnostic::new(Code::NO_JSON_FORM, key.span(), "keys in JSON are texts")),
                }
            }
            object(entries, errors)
        }
        Shape::Other => {
            if !leaf.is_broken() {
                errors.push(Diagnostic::new(Code::NO_JSON_FORM, leaf.span(), "this has no form in JSON"));
            }
            Value::Null
        }
    }
}

fn list(leaf: Leaf<'_>, errors: &mut Vec<Diagnostic>) -> Value {
    leaf.values().into_iter().flatten().map(|one| value(one, errors)).collect()
}

fn object(entries: Vec<(Leaf<'_>, String, Leaf<'_>)>, errors: &mut Vec<Diagnostic>) -> Value {
    let mut object = Map::new();
    for (at, name, leaf) in entries {
        if object.contains_key(&name) {
            errors.push(Diagnostic::new(Code::NO_JSON_FORM, at.span(), format!("`{name}` stands here twice")));
        }
        let value = value(leaf, errors);
        object.insert(name, value);
    }
    Value::Object(object)
}

fn number(leaf: Leaf<'_>) -> Value {
    let number = match leaf.number() {
        Some(Number::Whole(number)) => Some(number.into()),
        Some(Number::Huge(number) | Number::Real(number)) => JsonNumber::from_f64(number),
        Some(Number::NotFinite) | None => None,
    };
    number.map_or_else(|| json!({ leaf.text(): [] }), Value::Number)
}
