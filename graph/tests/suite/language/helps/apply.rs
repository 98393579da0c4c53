//! A file's text with what a help says.

use super::edits::{
    brackets, calls, declared, difference, elements, moved, names, replace, with, without, without_field,
};
use super::offers::Offer;
use crate::language::bad::folder;
use std::collections::BTreeSet;
use std::ops::Range;

/// Names in the forms that helps show, and the sections that declare what they stand for.
const NAMED: [(&str, &[&str]); 11] = [
    ("image", &["images"]),
    ("an_image", &["images"]),
    ("buffer", &["buffers"]),
    ("a_buffer", &["buffers"]),
    ("pass", &["passes"]),
    ("anchor", &["anchors"]),
    ("second", &["passes"]),
    ("setting", &["settings"]),
    ("shader", &[]),
    ("name", &["images", "buffers", "passes"]),
    ("…", &["images", "buffers", "passes", "settings", "parameters"]),
];

/// Marks and words in forms that stand for values, and such values.
const VALUES: [(&str, &str); 10] = [
    ("(…)", "(side_effect: true)"),
    ("passes: […]", "passes: []"),
    ("min: …, max: …", "min: 0, max: 9"),
    ("before: …, after: …", "before: Undefined, after: Sampled"),
    ("stages: […], accesses: […]", "stages: [COPY], accesses: [TRANSFER_READ]"),
    ("layout: …", "layout: TRANSFER_SRC_OPTIMAL"),
    ("(red, green, blue, alpha)", "(0.0, 0.0, 0.0, 0.0)"),
    ("(depth, stencil)", "(0.0, 0)"),
    ("(width, height)", "(64, 64)"),
    ("\"shader\"", "\"plain\""),
];

/// Values that `…` may stand for.
const ANY: [&str; 6] = ["0", "true", "\"2 > 1\"", "Undefined", "SHADER_READ_ONLY_OPTIMAL", "R8G8B8A8_UNORM"];

/// A file's text and that of the file that it extends, whose names it may use.
fn with_base(text: &str) -> String {
    let base = text.split_once("extends: \"").and_then(|(_, rest)| rest.split('"').next());
    let base = base.and_then(|path| std::fs::read_to_string(folder().join(path)).ok());
    format!("{text}\n{}", base.unwrap_or_default())
}

/// The texts of a snippet with names of the file in place of its own, and with values in place of `…`.
fn filled(text: &str, snippet: &str) -> Vec<String> {
    let text = &with_base(text);
    let mut all = vec![VALUES.iter().fold(snippet.to_owned(), |it, (form, value)| it.replace(form, value))];
    for (name, sections) in NAMED {
        let stands = format!("\"{name}\"");
        let known: BTreeSet<&str> = sections.iter().flat_map(|section| names(text, section)).collect();
        for _ in 0..snippet.matches(&stands).count().min(2) {
            let each = |it: &String| {
                let it = it.clone();
                let stands = stands.clone();
                known.clone().into_iter().map(move |known| it.replacen(&stands, &format!("\"{known}\""), 1))
            };
            all = if known.is_empty() { all } else { all.iter().flat_map(each).collect() };
        }
    }
    let values = |it: String| match it.contains('…') {
        true => ANY.iter().map(|value| it.replace('…', value)).collect(),
        false => vec![it],
    };
    all.into_iter().flat_map(values).collect()
}

/// The file's text with what a help offers of a mistake at these places. Several, where the help leaves open of what it
/// speaks. `all` that it offers: where the same could be said by several fields, it is said by one.
pub(super) fn applied(text: &str, places: &[Range<usize>], offer: &Offer, all: &[Offer]) -> Vec<String> {
    let Some(place) = places.first() else { return Vec::new() };
    let records = || places.iter().flat_map(|place| brackets(text, place, b'('));
    match offer {
        Offer::Write { new, old: None } => filled(text, new).iter().flat_map(|new| written(text, place, new)).collect(),
        Offer::Write { new, old: Some(old) } => {
            let call = old.strip_suffix("(…)");
            let named = |it: &Range<usize>| call.is_some_and(|word| text[it.clone()].starts_with(&format!("{word}(")));
            let calls = calls(text, place).into_iter().filter(named);
            let found = text.match_indices(old.as_str()).map(|(at, old)| at..at + old.len());
            calls.chain(found).map(|at| replace(text, &at, new)).collect()
        }
        Offer::Known(new) => written(text, place, new),
        Offer::Say { field, value, of } => {
            if let [one, others @ ..] = &of[..]
                && !others.is_empty()
            {
                let of = |of: &[String]| {
                    Box::new(Offer::Say { field: field.clone(), value: value.clone(), of: of.to_vec() })
                };
                return applied(text, places, &Offer::Both(of(std::slice::from_ref(one)), of(others)), &[]);
            }
            let records: Vec<Range<usize>> = of.first().map_or_else(|| records().collect(), |of| declared(text, of));
            let said = |record: &Range<usize>, value: &str| {
                let new = with(&text[record.clone()], field, value);
                let others =
                    all.iter().filter_map(|it| if let Offer::Say { field, .. } = it { Some(field) } else { None });
                let others = others.filter(|other| *other != field && of.is_empty());
                let alone = others.fold(new, |new, other| without_field(&new, other).unwrap_or(new));
                replace(text, record, &alone)
            };
            let values = filled(text, value);
            records.iter().flat_map(|record| values.iter().map(move |value| said(record, value))).collect()
        }
        Offer::Leave(Some(field)) => {
            let left = |it: Range<usize>| Some(replace(text, &it, &without_field(&text[it.clone()], field)?));
            records().filter_map(left).collect()
        }
        Offer::Leave(None) => {
            let lists = [b'(', b'[', b'{'].into_iter().flat_map(|open| brackets(text, place, open));
            let left = |list: Range<usize>| {
                let all = &text[list.clone()];
                let holds =
                    |it: &Range<usize>| list.start + it.start <= place.start && place.end <= list.start + it.end;
                Some(replace(text, &list, &without(all, &elements(all).into_iter().find(holds)?)))
            };
            lists.filter_map(left).collect()
        }
        Offer::Unquote => {
            let bare = text[place.clone()].trim_matches(['"', '\'']);
            [bare, "1", "true"].map(|new| replace(text, place, new)).to_vec()
        }
        // A repeated pass is declared once.
        Offer::Move(pass) => moved(text, place, pass.split('[').next().unwrap_or(pass)).into_iter().collect(),
        Offer::Both(first, second) => {
            let then = |text: String, before: &str| {
                let [old, new] = difference(before, &text);
                let moved = |at: usize| if at >= old.end { at + new.len() - old.len() } else { at };
                let place = moved(place.start)..moved(place.end);
                applied(&text, std::slice::from_ref(&place), second, &[])
            };
            applied(text, places, first, &[]).into_iter().flat_map(|it| then(it, text)).collect()
        }
    }
}

/// The text with something in place of what is underlined, or of the record or the word with parentheses around it.
fn written(text: &str, place: &Range<usize>, new: &str) -> Vec<String> {
    let old = &text[place.clone()];
    let mut all = vec![replace(text, place, new)];
    if !new.starts_with(['(', '"']) {
        all.push(replace(text, place, &format!("\"{new}\"")));
    }
    let calls = calls(text, place).into_iter().filter(|it| it.start == place.start || new.ends_with(')'));
    all.extend(calls.map(|call| replace(text, &call, new)));
    if let Some(new) = new.strip_prefix('(').and_then(|new| new.strip_suffix(')'))
        && let Some(record) = brackets(text, place, b'(').first()
        && !old.starts_with('(')
    {
        all.push(replace(text, record, new));
        // Or with what else the record says.
        let fields = elements(new).into_iter().filter_map(|it| new[it].split_once(": "));
        let merged = fields.fold(text[record.clone()].to_owned(), |record, (name, value)| with(&record, name, value));
        all.push(replace(text, record, &merged));
    }
    all
}
