//! Every help that names what to write instead is tried: the mistake is gone then, and no other is made at its place.
//!
//! Helps that name nothing are listed under `helps/`, each without what it quotes, with those that name what the file has
//! none of. `INSTA_UPDATE=always cargo test -p framewright-graph --test suite language` accepts new ones.

mod apply;
mod edits;
mod offers;

use crate::language::{bad, choices};
use apply::applied;
use edits::difference;
use framewright_graph::base::Diagnostic;
use offers::{Offer, offers};
use std::collections::BTreeSet;
use std::ops::Range;

/// A file, and how it is found out what is wrong with it.
struct File {
    name: String,
    text: String,
    /// Its number among the files that are read.
    number: usize,
    mistakes: fn(&str, String) -> Vec<Diagnostic>,
}

impl File {
    fn pipeline(name: &str) -> File {
        let text = std::fs::read_to_string(bad::folder().join(name)).expect("a text");
        let mistakes = |name: &str, text| bad::mistakes_if_any(name, text).1;
        File { name: name.to_owned(), text, number: 0, mistakes }
    }

    fn settings((name, text): (String, String)) -> File {
        File { name, text, number: 1, mistakes: |name, text| choices::mistakes(name, text).1 }
    }

    /// The mistakes of the file, if this is its text.
    fn wrong(&self, text: &str) -> Vec<Diagnostic> {
        (self.mistakes)(&self.name, text.to_owned())
    }

    /// Where a mistake stands in the file itself, not in one that it includes. Choices of the command stand in the first lines.
    fn places(&self, text: &str, mistake: &Diagnostic) -> Vec<Range<usize>> {
        let own = mistake.labels.iter().map(|label| label.span);
        let own = own.take_while(|span| span.file() == Some(self.number));
        let own = own.map(|span| span.start as usize..span.end as usize);
        let asked = text.lines().take_while(|line| line.starts_with("//! ")).map(|line| line.len() + 1).sum();
        let quoted = mistake.message.split('`').skip(1).step_by(2).last().unwrap_or_default();
        let asked = text[..asked].match_indices(quoted).map(|(at, word)| at..at + word.len());
        let alone =
            |at: &Range<usize>| text[..at.start].ends_with([' ', '=']) && text[at.end..].starts_with(['\n', '=']);
        asked.filter(alone).chain(own).collect()
    }

    /// A new mistake at the old one's place, or where something was written. In a file that is compiled for a device: any
    /// mistake.
    fn made(&self, mistake: &Diagnostic, before: &[Diagnostic], new: &str, offer: &Offer) -> Option<String> {
        let after = self.wrong(new);
        if bad::device(&self.text).is_some() {
            return after.first().map(|it| it.message.clone());
        }
        let [old, changed] = difference(&self.text, new);
        let moved = |at: usize| if at >= old.end { at + changed.len() - old.len() } else { at };
        let place = self.places(&self.text, mistake).into_iter().next().unwrap_or_default();
        let near = |range: Range<usize>, at: usize| (range.start..=range.end).contains(&at);
        let here = |at: usize| near(moved(place.start)..moved(place.end), at) || near(changed.clone(), at);
        let known = |it: &Diagnostic| before.iter().any(|old| old.message == it.message);
        // A name that is found now may lead to mistakes further on.
        let further = |it: &Diagnostic| match offer {
            Offer::Known(_) => !it.message.starts_with("there is no"),
            Offer::Write { new, .. } => {
                let named = |of: &&str| it.message.starts_with(&format!("{of} `{}` ", new.trim_matches('"')));
                ["shader", "fragment"].iter().any(named)
            }
            _ => false,
        };
        let wrong = |it: &&Diagnostic| {
            let here = self.places(new, it).first().is_none_or(|at| here(at.start));
            here && (it.message == mistake.message || !known(it) && !further(it))
        };
        after.iter().find(wrong).map(|wrong| wrong.message.clone())
    }
}

/// The outcome of trying helps.
#[derive(Default)]
struct Outcome {
    /// How many offers of helps mend their mistakes.
    tried: usize,
    /// Offers that mend nothing, with the mistakes that are left then.
    failed: Vec<String>,
    /// The forms of helps that aren't tried.
    untried: BTreeSet<String>,
}

impl Outcome {
    /// Tries every help that is given for a file.
    fn of(&mut self, file: &File) {
        let before = file.wrong(&file.text);
        assert!(!before.is_empty(), "{}", file.name);
        for mistake in &before {
            let Some(help) = mistake.help.as_deref() else { continue };
            let (places, offers) = (file.places(&file.text, mistake), offers(help));
            if offers.is_empty() {
                self.untried.insert(form(help));
            } else if places.is_empty() {
                self.untried.insert(format!("of another file: {}", form(help)));
                continue;
            }
            for offer in &offers {
                let mut wrong = BTreeSet::new();
                let mends = |new: &String| match file.made(mistake, &before, new, offer) {
                    Some(made) => {
                        wrong.insert(made);
                        false
                    }
                    None => true,
                };
                if applied(&file.text, &places, offer, &offers).iter().any(mends) {
                    self.tried += 1;
                } else if has_none(&wrong) {
                    self.untried.insert(format!("nothing to name: {}", form(help)));
                } else {
                    let then: Vec<String> = wrong.into_iter().take(6).collect();
                    let (name, message, then) = (&file.name, &mistake.message, then.join("\n        "));
                    self.failed.push(format!("{name}: {message}\n  help: {help}\n  {offer:?}\n  then: {then}"));
                }
            }
        }
    }

    fn failed(&self) -> String {
        format!("{} beside {}:\n{}", self.failed.len(), self.tried, self.failed.join("\n"))
    }
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
        let begins = ["expected `Pipeline(", "expected `Settings("].iter().any(|lead| it.starts_with(lead));
        it.contains(" has no field ") || it == "expected a comma" || begins
    };
    wrong.iter().any(lacks) && wrong.iter().all(|it| lacks(it) || elsewhere(it))
}

#[test]
fn every_help_that_says_what_to_write_mends_its_mistake() {
    let mut outcome = Outcome::default();
    for path in bad::files("ron") {
        outcome.of(&File::pipeline(&path.file_name().expect("a name").to_string_lossy()));
    }
    choices::bad_texts().into_iter().for_each(|file| outcome.of(&File::settings(file)));
    assert!(outcome.failed.is_empty(), "{}", outcome.failed());
    assert!(outcome.tried > 950, "only {} were tried", outcome.tried);
    let untried: Vec<String> = outcome.untried.into_iter().collect();
    insta::with_settings!({
        snapshot_path => "helps", prepend_module_to_snapshot => false, omit_expression => true,
    }, { insta::assert_snapshot!("untried", untried.join("\n")) });
}

/// Samples of a layer can't become one by any way to resolve, so none is offered.
#[test]
fn what_is_said_of_a_layer_of_multisampled_depth_makes_the_file_compile() {
    let names =
        ["cannot_be_resolved", "are_to_be_resolved"].map(|it| format!("compiled_layers_of_depth_that_{it}.ron"));
    for name in names {
        let file = File::pipeline(&name);
        let wrong = file.wrong(&file.text);
        let [Diagnostic { help: Some(help), .. }] = &wrong[..] else { panic!("{name}: {wrong:?}") };
        let samples = Offer::Say {
            field: "samples".to_owned(),
            value: "1".to_owned(),
            of: vec!["many".to_owned(), "layered".to_owned()],
        };
        assert_eq!(offers(help), std::slice::from_ref(&samples), "{name}");
        let places = file.places(&file.text, &wrong[0]);
        let all = applied(&file.text, &places, &samples, &[]);
        assert!(!all.is_empty(), "{name}");
        for mended in all {
            assert_eq!(file.wrong(&mended), [], "{mended}");
        }
    }
}
