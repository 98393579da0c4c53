//! Values that a place takes, in a few words with links.

use crate::reference::catalogue::called;
use framewright_graph::ron::{Form, PlainForm, Words};
use std::collections::BTreeMap;

/// Choices of more words than this have a list of their own.
pub(crate) const MOST_INLINE: usize = 10;

/// Where on the page tables, words and choices are told.
pub(crate) type Places = BTreeMap<String, String>;

/// The values that a form takes.
pub(crate) fn takes(form: &Form, places: &Places) -> String {
    match form {
        Form::Anything => "anything".to_owned(),
        Form::Plain(PlainForm::Truth) | Form::Truth => "`true` or `false`".to_owned(),
        Form::Plain(PlainForm::Whole) => "a whole number".to_owned(),
        Form::Plain(PlainForm::Number) | Form::Number => "a number".to_owned(),
        Form::Plain(PlainForm::Text) => "a text".to_owned(),
        Form::Plain(PlainForm::Name | PlainForm::Outside) => "a name".to_owned(),
        Form::Plain(PlainForm::Shader) => "the name of [a shader](#shaders)".to_owned(),
        Form::Whole(least, most) => format!("a whole number, {} to {}", digits(*least), digits(*most)),
        Form::Listed(numbers) => any_of(numbers.iter().map(ToString::to_string).collect()),
        Form::Expression("a condition") => "a [condition](#expressions)".to_owned(),
        Form::Expression(what) => format!("{what} by an [expression](#expressions)"),
        Form::Reference(what) | Form::Open(what) => (*what).to_owned(),
        Form::Fields(table) => linked(&table().noun(), called(&table()), places),
        Form::Words(words) => linked(words.what, words.name, places),
        Form::Choice(what, words) => match words() {
            words if words.len() > MOST_INLINE => linked(what, what, places),
            words => any_of(words.iter().map(|word| format!("`{word}`")).collect()),
        },
        Form::Tuple(values) => {
            let values: Vec<String> = values.iter().map(|value| takes(value, places)).collect();
            format!("({})", values.join(", "))
        }
        Form::Several(of, least, most) => format!("({least} to {most} values, each {})", takes(of, places)),
        Form::List(of) => format!("a list, each {}", takes(of, places)),
        Form::Map(of, form) => format!("a map from each {of} to {}", takes(form, places)),
        Form::Either(forms) => any_of(forms.iter().map(|form| takes(form, places)).collect()),
    }
}

/// How a word is written, and what it takes besides words.
pub(crate) fn besides(words: &Words, places: &Places) -> Vec<String> {
    words.or.iter().map(|or| takes(or, places)).collect()
}

/// "a, b or c", each once.
fn any_of(mut all: Vec<String>) -> String {
    let mut seen = std::collections::BTreeSet::new();
    all.retain(|one| seen.insert(one.clone()));
    let last = all.pop().unwrap_or_default();
    if all.is_empty() { last } else { format!("{} or {last}", all.join(", ")) }
}

/// "a [size](#sizes)"
fn linked(noun: &str, name: &str, places: &Places) -> String {
    let place = places.get(name).unwrap_or_else(|| panic!("the page doesn't tell of {name}"));
    match noun.split_once(' ') {
        Some((article @ ("a" | "an"), noun)) => format!("{article} [{noun}](#{place})"),
        _ => format!("[{noun}](#{place})"),
    }
}

/// A number with commas between its thousands.
fn digits(number: i64) -> String {
    let text = number.to_string();
    let mut shown = String::new();
    for (at, digit) in text.chars().enumerate() {
        if at > 0 && (text.len() - at).is_multiple_of(3) && text.len() > 4 {
            shown.push(',');
        }
        shown.push(digit);
    }
    shown
}
