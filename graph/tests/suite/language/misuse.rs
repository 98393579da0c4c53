//! Every field and every word that the readers' tables name is misused in some file under `bad/` or `bad_settings/`.

use crate::language::{bad, choices};
use crate::reference::catalogue::{self, called};
use framewright_graph::base::{Diagnostic, Sources, Span};
use framewright_graph::language::FILES;
use framewright_graph::ron::{Form, Leaf, Shape, Table, Tree, WordContents};
use std::collections::BTreeSet;

/// Fields and words of files, with where they stand.
#[derive(Default)]
struct Seen(Vec<(String, Span)>);

impl Seen {
    fn table(&mut self, leaf: Leaf<'_>, table: &Table) {
        for (name, value) in leaf.fields().into_iter().flatten() {
            let Some(row) = table.rows.iter().find(|row| row.name == name.text()) else { continue };
            let (from, to) = (name.span(), value.span());
            let span =
                from.file().map_or(from, |file| Span::new(file.try_into().expect("few files"), from.start, to.end));
            self.0.push((key(table, row.name), span));
            self.form(value, &row.form);
        }
    }

    fn form(&mut self, leaf: Leaf<'_>, form: &Form) {
        match form {
            Form::Fields(table) => self.table(leaf, &table()),
            Form::Words(words) => match leaf.shape() {
                Shape::Word(word, rest) if words.find(word).is_some() => {
                    self.0.push((format!("{} {word}", words.name), leaf.span()));
                    for takes in words.find(word).into_iter().flat_map(|word| word.takes) {
                        match (takes, rest) {
                            (WordContents::Values(forms), Some(rest)) => self.each(rest, forms),
                            (WordContents::Fields(table), Some(rest)) => self.table(rest, &table()),
                            _ => {}
                        }
                    }
                }
                _ => words.or.iter().for_each(|or| self.form(leaf, or)),
            },
            Form::Tuple(forms) => self.each(leaf, forms),
            Form::List(of) | Form::Several(of, ..) => {
                leaf.values().into_iter().flatten().for_each(|value| self.form(value, of))
            }
            Form::Map(_, of) => leaf.entries().into_iter().flatten().for_each(|(_, value)| self.form(value, of)),
            Form::Either(forms) => match forms.iter().max_by_key(|form| known(leaf, form)) {
                Some(form) if known(leaf, form) > 0 => self.form(leaf, form),
                _ => {
                    forms.iter().filter(|form| !matches!(form, Form::Fields(_))).for_each(|form| self.form(leaf, form))
                }
            },
            _ => {}
        }
    }

    fn each(&mut self, leaf: Leaf<'_>, forms: &[Form]) {
        leaf.values().into_iter().flatten().zip(forms).for_each(|(value, form)| self.form(value, form));
    }
}

/// The name of a field here. Fields that all files have in common with pipelines are read by the same readers.
fn key(table: &Table, row: &str) -> String {
    let pipeline = FILES[0]();
    let shared =
        matches!(called(table), "Extending" | "Extension") && pipeline.rows.iter().any(|other| other.name == row);
    format!("{}.{row}", called(if shared { &pipeline } else { table }))
}

/// How many of a value's fields a form knows.
fn known(leaf: Leaf<'_>, form: &Form) -> usize {
    let Form::Fields(table) = form else { return 0 };
    let rows = table().rows;
    leaf.fields().into_iter().flatten().filter(|(name, _)| rows.iter().any(|row| row.name == name.text())).count()
}

/// Adds to `all` the fields and words of the files in which a mistake's place lies.
fn misused(sources: &Sources, mistakes: &[Diagnostic], all: &mut BTreeSet<String>) {
    for (number, file) in (0..).map_while(|at: usize| Some((at, sources.file(at)?))) {
        let Some(tree) = Tree::read(u32::try_from(number).expect("few files"), file.text.clone(), &mut Vec::new())
        else {
            continue;
        };
        let root = tree.root();
        let word = if let Shape::Word(word, _) = root.shape() { Some(word) } else { None };
        let own = FILES.iter().filter(|table| table().word == word);
        let table = own.max_by_key(|table| known(root, &Form::Fields(**table))).map(|table| table());
        let mut seen = Seen::default();
        seen.table(root, &table.unwrap_or_else(FILES[0]));
        for (what, span) in seen.0 {
            let within = |at: Span| at.file() == span.file() && span.start <= at.start && at.end <= span.end;
            if mistakes.iter().any(|mistake| mistake.labels.first().is_some_and(|label| within(label.span))) {
                all.insert(what);
            }
        }
    }
}

#[test]
fn every_field_and_every_word_is_misused_somewhere() {
    let mut all = BTreeSet::new();
    for path in bad::files("ron") {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let (sources, mistakes) = bad::mistakes(&name, std::fs::read_to_string(&path).expect("a text"));
        misused(&sources, &mistakes, &mut all);
    }
    for (_, sources, mistakes) in choices::bad_files() {
        misused(&sources, &mistakes, &mut all);
    }
    let catalogue = catalogue::all();
    let fields = catalogue.tables.values().flat_map(|table| table.rows.iter().map(move |row| key(table, row.name)));
    let words =
        catalogue.words.values().flat_map(|words| words.all.iter().map(|word| format!("{} {}", words.name, word.word)));
    let lacking: Vec<String> = fields.chain(words).filter(|what| !all.contains(what)).collect();
    assert!(lacking.is_empty(), "misuse these in files under tests/language/bad: {lacking:#?}");
}
