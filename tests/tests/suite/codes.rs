//! Every code of a mistake is given by the program: a row that nobody gives would explain what never happens.

use framewright_graph::base::{Code, Room};
use framewright_tests::sources::{self, Source};
use proc_macro2::TokenTree;
use std::collections::BTreeSet;

/// The table of codes.
const TABLE: &str = "graph/src/base/code/";

/// The names after `Code::`, at any depth.
fn named(tokens: &[TokenTree], found: &mut BTreeSet<String>) {
    for (at, token) in tokens.iter().enumerate() {
        if let TokenTree::Group(group) = token {
            named(&group.stream().into_iter().collect::<Vec<_>>(), found);
        }
        let text = |at: usize| tokens.get(at).map(ToString::to_string).unwrap_or_default();
        if text(at) == "Code" && text(at + 1) == ":" && text(at + 2) == ":" {
            found.insert(text(at + 3));
        }
    }
}

/// The names of a source's rows: `NAME = 207,`.
fn rows(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let (name, number) = line.trim().strip_suffix(',')?.split_once(" = ")?;
        number.bytes().all(|digit| digit.is_ascii_digit()).then_some(name)
    })
}

#[test]
fn every_code_is_given_somewhere() {
    let (mut declared, mut given) = (Vec::new(), BTreeSet::new());
    for Source { path, text, tokens } in sources::all() {
        if path.starts_with(TABLE) {
            declared.extend(rows(&text).map(str::to_owned));
        } else {
            named(&tokens, &mut given);
        }
    }
    assert_eq!(declared.len(), Code::all().count(), "the rows of the table");
    let idle: Vec<&String> = declared.iter().filter(|name| !given.contains(*name)).collect();
    assert!(idle.is_empty(), "codes that nobody gives: {idle:#?}");
}

#[test]
fn every_room_has_codes() {
    assert!(Room::all().iter().all(|room| room.codes().count() > 2));
}
