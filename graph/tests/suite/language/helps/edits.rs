//! Changes of a file's text. Records, fields and elements are found by their brackets.

use std::ops::Range;

pub(super) fn replace(text: &str, old: &Range<usize>, new: &str) -> String {
    format!("{}{new}{}", &text[..old.start], &text[old.end..])
}

/// The bytes in which two texts differ, in each of them.
pub(super) fn difference(before: &str, after: &str) -> [Range<usize>; 2] {
    let least = before.len().min(after.len());
    let same = |pairs: &mut dyn Iterator<Item = (u8, u8)>| pairs.take_while(|(a, b)| a == b).count();
    let start = same(&mut before.bytes().zip(after.bytes()));
    let end = same(&mut before.bytes().rev().zip(after.bytes().rev())).min(least - start);
    [start..before.len() - end, start..after.len() - end]
}

/// The bytes that are neither in quotes nor in comments.
fn code(text: &str) -> impl Iterator<Item = (usize, u8)> {
    let bytes = text.as_bytes();
    let (mut quoted, mut comment) = (false, false);
    (0..bytes.len()).filter_map(move |at| {
        let byte = bytes[at];
        match (quoted, comment) {
            (true, _) => quoted = byte != b'"',
            (_, true) => comment = byte != b'\n',
            _ if byte == b'"' => quoted = true,
            _ if byte == b'/' && bytes.get(at + 1) == Some(&b'/') => comment = true,
            _ => return Some((at, byte)),
        }
        None
    })
}

/// The insides of pairs of brackets: those that hold a place, the innermost first, and those that the place ends in or is
/// followed by.
pub(super) fn brackets(text: &str, place: &Range<usize>, open: u8) -> Vec<Range<usize>> {
    let (mut stack, mut found) = (Vec::new(), Vec::new());
    for (at, byte) in code(text) {
        match byte {
            b'(' | b'[' | b'{' => stack.push((at, byte)),
            b')' | b']' | b'}' => {
                let Some((start, opened)) = stack.pop() else { continue };
                let holds = start <= place.start && place.end <= at + 1;
                let ends = place.start <= start && place.end == at + 1 || start == place.end;
                if opened == open && (holds || ends) {
                    found.push(start + 1..at);
                }
            }
            _ => {}
        }
    }
    found
}

/// The word and its parentheses that a place is in, or that it is the word of: `Eye(Left, "color")`.
pub(super) fn calls(text: &str, place: &Range<usize>) -> Vec<Range<usize>> {
    let with_word = |record: Range<usize>| {
        let before = &text[..record.start - 1];
        let word = before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len();
        (word < before.len()).then_some(word..record.end + 1)
    };
    brackets(text, place, b'(').into_iter().take(2).filter_map(with_word).collect()
}

/// The elements of a text, which commas separate.
pub(super) fn elements(text: &str) -> Vec<Range<usize>> {
    let (mut depth, mut start, mut all) = (0_u32, 0, Vec::new());
    for (at, byte) in code(text) {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            b',' if depth == 0 => {
                all.push(start..at);
                start = at + 1;
            }
            _ => {}
        }
    }
    all.push(start..text.len());
    let trimmed = |it: &Range<usize>| {
        let part = &text[it.clone()];
        let start = it.start + part.len() - part.trim_start().len();
        start..start.max(it.start + part.trim_end().len())
    };
    all.iter().map(trimmed).filter(|it| !it.is_empty()).collect()
}

/// A record's field, with its name.
fn field(record: &str, name: &str) -> Option<Range<usize>> {
    let value = |it: &Range<usize>| record[it.clone()].strip_prefix(name).map(str::trim_start);
    elements(record).into_iter().find(|it| value(it).is_some_and(|rest| rest.starts_with(':')))
}

/// A record with a field of this value. What is between brackets is added to what is there.
pub(super) fn with(record: &str, name: &str, value: &str) -> String {
    let old = field(record, name);
    let entries = |text: &str| Some(text.split_once('{')?.1.strip_suffix('}')?.trim_end_matches(',').to_owned());
    let fields = |text: &str| Some(text.trim().strip_prefix('(')?.strip_suffix(')')?.to_owned());
    let there = old.as_ref().and_then(|old| fields(record[old.clone()].split_once(':')?.1));
    // Other fields of the old value stay.
    let merged = there.zip(fields(value)).map(|(there, new)| {
        let new = elements(&new).into_iter().filter_map(|it| new[it].split_once(": "));
        format!("({})", new.fold(there, |there, (name, value)| with(&there, name, value)))
    });
    let value = merged.as_deref().unwrap_or(value);
    let value = match old.as_ref().and_then(|old| entries(&record[old.clone()])).zip(entries(value)) {
        Some((there, more)) if !there.is_empty() => format!("{{{there}, {more}}}"),
        _ => value.to_owned(),
    };
    match (old, elements(record).last()) {
        (Some(old), _) => replace(record, &old, &format!("{name}: {value}")),
        (None, Some(last)) => replace(record, &(last.end..last.end), &format!(", {name}: {value}")),
        (None, None) => format!("{name}: {value}"),
    }
}

/// A record without a field, if it has it.
pub(super) fn without_field(record: &str, name: &str) -> Option<String> {
    field(record, name).map(|it| without(record, &it))
}

/// The inside of brackets without one of its elements.
pub(super) fn without(all: &str, element: &Range<usize>) -> String {
    let comma = all[element.end..].trim_start().starts_with(',').then(|| all[element.end..].find(',').unwrap_or(0) + 1);
    replace(all, &(element.start..element.end + comma.unwrap_or(0)), "")
}

/// The records that declare what has this name.
pub(super) fn declared(text: &str, name: &str) -> Vec<Range<usize>> {
    let named = format!("name: \"{name}\"");
    let record = |at| brackets(text, &(at..at + 1), b'(').into_iter().next();
    text.match_indices(&named).filter_map(|(at, _)| record(at)).collect()
}

/// The names of what a section declares: `images`. Anchors stand between passes.
pub(super) fn names<'t>(text: &'t str, section: &str) -> Vec<&'t str> {
    let (section, field) = if section == "anchors" { ("passes", "(anchor: \"") } else { (section, "(name: \"") };
    let start = format!("{section}: [");
    let mut names = Vec::new();
    for (at, word) in text.match_indices(&start) {
        let inner = at + word.len();
        let Some(list) = brackets(text, &(at..inner - 1), b'[').into_iter().find(|it| it.start == inner) else {
            continue;
        };
        let entries = elements(&text[list.clone()]);
        let named = |it: Range<usize>| text[list.clone()][it].strip_prefix(field)?.split('"').next();
        names.extend(entries.into_iter().filter_map(named));
    }
    names
}

/// The text with a pass right before the element of its list that a place is in.
pub(super) fn moved(text: &str, place: &Range<usize>, pass: &str) -> Option<String> {
    let record = declared(text, pass).into_iter().rfind(|it| it.start > place.start)?;
    let whole = record.start - 1..record.end + 1;
    let list = brackets(text, &whole, b'[').into_iter().find(|it| it.start < whole.start)?;
    let elements = elements(&text[list.clone()]).into_iter().map(|it| it.start + list.start..it.end + list.start);
    let target = elements.into_iter().find(|it| it.contains(&place.start))?;
    let between = text[target.start..whole.start].trim_end().trim_end_matches(',');
    Some(replace(text, &(target.start..whole.end), &format!("{}, {between}", &text[whole.clone()])))
}
