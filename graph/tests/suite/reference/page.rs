//! The page: a text with places that tables fill.

use crate::reference::catalogue::{self, Catalogue, called};
use crate::reference::takes::{MOST_INLINE, Places, besides, takes};
use framewright_graph::expression::functions;
use framewright_graph::language::{goes_with, names_of};
use framewright_graph::ron::{Row, Table, WordContents, Words};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Fills the places of a text: `{{fields Image}}`, `{{words Size}}`, `{{choice a blend}}`, `{{names view}}`, `{{functions}}` and
/// `{{contents}}`. Everything that the catalogue holds has its place, and just one.
pub(crate) fn make(text: &str) -> String {
    let all = catalogue::all();
    let places = places(text);
    let mut page = String::new();
    let mut filled = BTreeSet::new();
    for line in text.lines() {
        match placeholder(line) {
            Some(what) => {
                assert!(filled.insert(what.to_owned()), "{line} stands there twice");
                page += &fill(what, text, &all, &places);
            }
            None => page += line,
        }
        page.push('\n');
    }
    let expected = expected(&all);
    let missing: Vec<&String> = expected.difference(&filled).collect();
    assert!(missing.is_empty(), "tests/suite/reference/language.md has no places for what is read: {missing:?}");
    page
}

fn placeholder(line: &str) -> Option<&str> {
    line.strip_prefix("{{")?.strip_suffix("}}")
}

/// Everything that must have a place on the page.
fn expected(all: &Catalogue) -> BTreeSet<String> {
    let tables = all.tables.keys().filter(|name| !all.inner.contains(name)).map(|name| format!("fields {name}"));
    let words = all.words.keys().map(|name| format!("words {name}"));
    let large = all.choices.iter().filter(|(_, words)| words.len() > MOST_INLINE);
    tables.chain(words).chain(large.map(|(what, _)| format!("choice {what}"))).collect()
}

/// The heading above each place.
fn places(text: &str) -> Places {
    let mut heading = String::new();
    let mut places = Places::new();
    for (_, title, line) in headed(text) {
        heading = title.map_or(heading, anchor);
        if let Some((_, name)) = placeholder(line).and_then(|what| what.split_once(' ')) {
            places.insert(name.to_owned(), heading.clone());
        }
    }
    places
}

/// Each line, and of headings their depth and text.
fn headed(text: &str) -> impl Iterator<Item = (usize, Option<&str>, &str)> {
    let mut code = false;
    text.lines().map(move |line| {
        code ^= line.starts_with("```");
        let depth = line.bytes().take_while(|byte| *byte == b'#').count();
        let title = line[depth..].strip_prefix(' ').filter(|_| depth > 0 && !code);
        (depth, title, line)
    })
}

/// The anchor that GitHub makes of a heading.
fn anchor(title: &str) -> String {
    let letters = title.to_lowercase();
    letters.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-')).collect::<String>().replace(' ', "-")
}

fn fill(what: &str, text: &str, all: &Catalogue, places: &Places) -> String {
    let (kind, name) = what.split_once(' ').unwrap_or((what, ""));
    match kind {
        "contents" => contents(text),
        "functions" => rows(["function", "its value"], functions().map(|(form, about)| [code(form), about.to_owned()])),
        "names" => {
            let names = names_of(name).map(|(name, ty, about)| [code(name), ty.words().to_owned(), about.to_owned()]);
            rows(["name", "", "its value"], names)
        }
        "choice" => {
            let words = all.choices.get(name).unwrap_or_else(|| panic!("there is no choice {name}"));
            let words: Vec<String> = words.iter().map(|word| code(word)).collect();
            format!("{name} is one of {}.", words.join(", ")).replacen('a', "A", 1)
        }
        "words" => words(all.words.get(name).unwrap_or_else(|| panic!("there are no words {name}")), places),
        "fields" => fields(all.tables.get(name).unwrap_or_else(|| panic!("there is no table {name}")), places),
        _ => panic!("what is {what}?"),
    }
}

fn contents(text: &str) -> String {
    let titles = headed(text).filter_map(|(depth, title, _)| title.filter(|_| depth == 2));
    let titles: Vec<String> = titles.map(|title| format!("[{title}](#{})", anchor(title))).collect();
    titles.join(" · ")
}

fn fields(table: &Table, places: &Places) -> String {
    let (about, example) = documentation(table.about);
    let begin = about.split_once(':').map_or("", |(_, rest)| rest.trim());
    let mut text = String::new();
    if !begin.is_empty() {
        text += &format!("{}: {begin}\n\n", capital(&table.noun()));
    }
    let example = example.unwrap_or_else(|| panic!("{} has no example", called(table)));
    text += &format!("```ron\n{example}\n```\n\n");
    let row = |row: &Row| {
        let name = if row.needed { format!("**{}**", code(row.name)) } else { code(row.name) };
        [name, takes(&row.form, places), meaning(table, row)]
    };
    text + &rows(["field", "takes", "meaning"], table.rows.iter().map(row))
}

fn meaning(table: &Table, row: &Row) -> String {
    let (about, _) = documentation(row.about);
    match goes_with(row.name).filter(|_| called(table) == "Pass") {
        Some(words) => {
            let words: Vec<String> = words.iter().map(|word| code(word)).collect();
            format!("{about} Goes with {}.", words.join(", "))
        }
        None => about,
    }
}

fn words(words: &Words, places: &Places) -> String {
    let besides = besides(words, places).into_iter().map(|or| [or, String::new()]);
    let each = words.all.iter().map(|word| {
        let written: Vec<String> = word.written().map(code).collect();
        let inner = word
            .takes
            .iter()
            .filter_map(|takes| if let WordContents::Fields(table) = takes { Some(table()) } else { None });
        let inner = inner.filter(|table| !places.contains_key(called(table)));
        let mut about = word.about.to_owned();
        for row in inner.flat_map(|table| table.rows) {
            let name = if row.needed { format!("**{}**", code(row.name)) } else { code(row.name) };
            // Writing to a text can't fail.
            let _ = write!(about, "<br>{name}, {}: {}", takes(&row.form, places), documentation(row.about).0);
        }
        [written.join("<br>"), about]
    });
    rows([words.what, "meaning"], each.chain(besides))
}

/// A table of Markdown.
fn rows<const N: usize>(titles: [&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let mut text = format!("| {} |\n|{}", titles.join(" | "), "---|".repeat(N));
    for row in rows {
        let _ = write!(text, "\n| {} |", row.join(" | "));
    }
    text
}

/// The sentences of a documentation comment, and its example.
fn documentation(lines: &[&str]) -> (String, Option<String>) {
    let lines: Vec<&str> = lines.iter().map(|line| line.strip_prefix(' ').unwrap_or(line)).collect();
    let fence = lines.iter().position(|line| line.starts_with("```")).unwrap_or(lines.len());
    let about = lines[..fence].join(" ").trim().to_owned();
    let example = lines.get(fence + 1..lines.len().saturating_sub(1)).filter(|_| fence < lines.len());
    (about, example.map(|lines| lines.join("\n")))
}

fn code(text: &str) -> String {
    format!("`{}`", text.replace('|', "\\|"))
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
