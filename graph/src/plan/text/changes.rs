//! Changes of a pipeline in words.

use crate::frame::change::{Action, InsertPlace};
use crate::plan::Change;
use crate::plan::names::ShownText;
use std::sync::Arc;

/// A change in words, with its place.
pub(super) fn words(change: &Change) -> String {
    let words = match &change.action {
        Action::Extends { file } => format!("extends `{}`", ShownText(file)),
        Action::Extension { file } => format!("applies `{}`", ShownText(file)),
        Action::Add { of, names } => {
            format!("adds {} {}", if names.len() == 1 { of.word() } else { of.plural() }, listed(names))
        }
        Action::Set { of, name, fields, without } => {
            let set = (!fields.is_empty()).then(|| format!("sets {}", listed(fields)));
            let taken = (!without.is_empty()).then(|| format!("takes away {}", listed(without)));
            let done: Vec<String> = set.into_iter().chain(taken).collect();
            format!("{} of {} `{}`", done.join(" and "), of.word(), ShownText(name))
        }
        Action::Remove { of, name } => format!("removes {} `{}`", of.word(), ShownText(name)),
        Action::Insert { place, names } => {
            let place = match place {
                InsertPlace::Start => "before all others".to_owned(),
                InsertPlace::Before(name) => format!("before `{}`", ShownText(name)),
                InsertPlace::After(name) => format!("after `{}`", ShownText(name)),
                InsertPlace::At(name) => format!("at the anchor `{}`", ShownText(name)),
                InsertPlace::End => "after all others".to_owned(),
            };
            format!("inserts {} {place}", listed(names))
        }
        Action::Outputs { names } => format!("gives {} out in place of all others", listed(names)),
    };
    match &change.at {
        Some(place) => format!("{words} ({}:{})", ShownText(&place.file), place.line),
        None => words,
    }
}

/// "`a`, `b` and `c`".
fn listed(names: &[Arc<str>]) -> String {
    let mut shown: Vec<String> = names.iter().map(|name| format!("`{}`", ShownText(name))).collect();
    match shown.pop() {
        None => "nothing".to_owned(),
        Some(only) if shown.is_empty() => only,
        Some(last) => format!("{} and {last}", shown.join(", ")),
    }
}
