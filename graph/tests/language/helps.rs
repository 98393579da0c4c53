//! Every help that names what to write instead is tried: the mistake is gone then, and no other is made at its place.
//!
//! Helps that name nothing are listed under `helps/`, each without what it quotes, with those that name what the file has
//! none of. `INSTA_UPDATE=always cargo test -p framewright-graph --test language` accepts new ones.

mod apply;
mod edits;
mod offers;

use crate::bad::{device, files, mistakes, mistakes_if_any};
use apply::applied;
use edits::difference;
use framewright_graph::describe::Diagnostic;
use offers::{Offer, offers};
use std::collections::BTreeSet;
use std::ops::Range;

/// Where a mistake stands in the file itself, not in one that it includes. What is asked for by the command stands in the
/// first lines.
fn places(text: &str, mistake: &Diagnostic) -> Vec<Range<usize>> {
    let own = mistake.labels.iter().map(|label| label.span).take_while(|span| span.file() == Some(0));
    let own = own.map(|span| span.start as usize..span.end as usize);
    let asked = text.lines().take_while(|line| line.starts_with("//! ")).map(|line| line.len() + 1).sum();
    let quoted = mistake.message.split('`').skip(1).step_by(2).last().unwrap_or_default();
    let asked = text[..asked].match_indices(quoted).map(|(at, word)| at..at + word.len());
    let asked = asked.filter(|at| text[..at.start].ends_with([' ', '=']) && text[at.end..].starts_with(['\n', '=']));
    asked.chain(own).collect()
}

/// What is wrong at a mistake's place, or where something was written, that wasn't before.
fn made(
    name: &str,
    text: &str,
    mistake: &Diagnostic,
    before: &[Diagnostic],
    new: &str,
    offer: &Offer,
) -> Option<String> {
    let (_, after) = mistakes_if_any(name, new.to_owned());
    // What the compiler says is wrong is all that is wrong.
    if device(text).is_some() {
        return after.first().map(|it| it.message.clone());
    }
    let [old, changed] = difference(text, new);
    let moved = |at: usize| if at >= old.end { at + changed.len() - old.len() } else { at };
    let place = places(text, mistake).into_iter().next().unwrap_or_default();
    let here = |at: usize| {
        (moved(place.start)..=moved(place.end)).contains(&at) || (changed.start..=changed.end).contains(&at)
    };
    let known = |it: &Diagnostic| before.iter().any(|old| old.message == it.message);
    // What is found is looked at further.
    let further = |it: &Diagnostic| match offer {
        Offer::Known(_) => !it.message.starts_with("there is no"),
        Offer::Write { new, .. } => ["shader", "fragment"]
            .iter()
            .any(|of| it.message.starts_with(&format!("{of} `{}` ", new.trim_matches('"')))),
        _ => false,
    };
    let wrong = |it: &&Diagnostic| {
        let here = places(new, it).first().is_none_or(|at| here(at.start));
        here && (it.message == mistake.message || !known(it) && !further(it))
    };
    after.iter().find(wrong).map(|wrong| wrong.message.clone())
}

/// A help without what it quotes.
fn form(help: &str) -> String {
    let prose: Vec<&str> = help.lines().next().unwrap_or_default().split('`').step_by(2).collect();
    prose.join("`…`").chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).collect()
}

/// Whether nothing of a file fits, of all that was tried: it declares nothing of the kind that was meant.
fn has_none(wrong: &BTreeSet<String>) -> bool {
    let lacks = |it: &String| it.starts_with("there is no ") || it.ends_with(" is needed here");
    // Not where it was meant to be said.
    let elsewhere = |it: &String| {
        it.contains(" has no field ") || it == "expected a comma" || it.starts_with("expected `Pipeline(")
    };
    wrong.iter().any(lacks) && wrong.iter().all(|it| lacks(it) || elsewhere(it))
}

#[test]
fn every_help_that_says_what_to_write_mends_its_mistake() {
    let (mut tried, mut failed, mut untried) = (0, Vec::new(), BTreeSet::new());
    for path in files("ron") {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("a text");
        let (_, before) = mistakes(&name, text.clone());
        for mistake in &before {
            let Some(help) = mistake.help.as_deref() else { continue };
            let (places, offers) = (places(&text, mistake), offers(help));
            if offers.is_empty() {
                untried.insert(form(help));
            } else if places.is_empty() {
                untried.insert(format!("of another file: {}", form(help)));
                continue;
            }
            for offer in &offers {
                let mut wrong = BTreeSet::new();
                let all = applied(&text, &places, offer, &offers);
                let mends = |new: &String| {
                    made(&name, &text, mistake, &before, new, offer).map(|it| wrong.insert(it)).is_none()
                };
                if all.iter().any(mends) {
                    tried += 1;
                } else if has_none(&wrong) {
                    untried.insert(format!("nothing to name: {}", form(help)));
                } else {
                    let wrong: Vec<String> = wrong.into_iter().take(6).collect();
                    let then = wrong.join("\n        ");
                    failed.push(format!("{name}: {}\n  help: {help}\n  {offer:?}\n  then: {then}", mistake.message));
                }
            }
        }
    }
    assert!(failed.is_empty(), "{} beside {tried}:\n{}", failed.len(), failed.join("\n"));
    assert!(tried > 780, "only {tried} were tried");
    let untried: Vec<String> = untried.into_iter().collect();
    insta::with_settings!({
        snapshot_path => "helps", prepend_module_to_snapshot => false, omit_expression => true,
    }, { insta::assert_snapshot!("untried", untried.join("\n")) });
}
