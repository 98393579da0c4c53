//! Every help that names what to write instead is tried: the mistake is gone then, and no other is made at its place.

use crate::bad::{files, mistakes, mistakes_if_any};
use framewright_graph::describe::Diagnostic;
use std::ops::Range;

/// What a help says to write in place of what is underlined, if it says that.
fn replacement(help: &str) -> Option<&str> {
    let first = help.lines().next()?;
    let near = first.strip_prefix("did you mean `").and_then(|rest| rest.strip_suffix("`?"));
    let clear = || first.strip_prefix("clear it: `").and_then(|rest| rest.strip_suffix('`'));
    // A form such as `clamp(x, low, high)` shows what is meant, and isn't to be written so.
    let form = |text: &str| text.contains('(') && !text.starts_with('(');
    near.or_else(clear).filter(|text| !form(text) && !text.contains('…'))
}

/// Where the mistake stands in the file itself, not in one that it includes.
fn place(mistake: &Diagnostic) -> Option<Range<usize>> {
    let span = mistake.labels.first()?.span;
    (span.file() == Some(0)).then_some(span.start as usize..span.end as usize)
}

/// The text with what a help says at its place.
fn helped(text: &str, place: &Range<usize>, new: &str) -> Option<String> {
    let (before, old, after) = (&text[..place.start], &text[place.clone()], &text[place.end..]);
    // Where a field is named already, the help shows the whole of what stands around it.
    if new.starts_with('(') && before.trim_end().ends_with(':') && !before.trim_end().ends_with("depth:") {
        return None;
    }
    let quoted = old.starts_with('"') && !new.starts_with(['(', '"']);
    Some(if quoted { format!("{before}\"{new}\"{after}") } else { format!("{before}{new}{after}") })
}

#[test]
fn every_near_name_and_every_clear_that_a_help_offers_mends_its_mistake() {
    let (mut tried, mut failed) = (0, Vec::new());
    for path in files("ron") {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("a text");
        let (_, before) = mistakes(&name, text.clone());
        for mistake in &before {
            let Some(new) = mistake.help.as_deref().and_then(replacement) else { continue };
            let Some(place) = place(mistake) else { continue };
            let Some(mended) = helped(&text, &place, new) else { continue };
            tried += 1;
            let (_, after) = mistakes_if_any(&name, mended);
            let within = place.start..place.start + new.len() + 2;
            let here = |mistake: &&Diagnostic| self::place(mistake).is_some_and(|place| within.contains(&place.start));
            let old: Vec<&Diagnostic> = before.iter().filter(here).collect();
            // What is found is looked at further.
            let found = [format!("shader `{new}` "), format!("fragment `{new}` ")];
            let further = |it: &Diagnostic| found.iter().any(|found| it.message.starts_with(found));
            let is_old = |it: &Diagnostic| old.iter().any(|old| old.message == it.message);
            let made = |it: &&&Diagnostic| it.message == mistake.message || !is_old(it) && !further(it);
            if let Some(wrong) = after.iter().filter(here).collect::<Vec<_>>().iter().find(made) {
                failed.push(format!("{name}: {}\n  help: {new}\n  then: {}", mistake.message, wrong.message));
            }
        }
    }
    assert!(failed.is_empty(), "{} of {tried}:\n{}", failed.len(), failed.join("\n"));
    assert!(tried > 60, "only {tried} helps were tried");
}
