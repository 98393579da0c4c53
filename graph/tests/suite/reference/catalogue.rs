//! Everything that the readers' tables name, found from the three kinds of files on.

use framewright_graph::language::FILES;
use framewright_graph::ron::{Form, Table, WordContents, Words};
use std::collections::BTreeMap;

/// Tables, words and choices by name.
#[derive(Default)]
pub(crate) struct Catalogue {
    /// Tables of fields, without `Fields` at the end of their names.
    pub(crate) tables: BTreeMap<&'static str, Table>,
    /// Those of them that stand behind words alone, and are told with them.
    pub(crate) inner: Vec<&'static str>,
    /// Tables of words.
    pub(crate) words: BTreeMap<&'static str, &'static Words>,
    /// Words that stand alone, by what they are together.
    pub(crate) choices: BTreeMap<&'static str, Vec<&'static str>>,
}

/// The name of a table without its end.
pub(crate) fn called(table: &Table) -> &'static str {
    table.name.trim_end_matches("Fields")
}

/// The example in a table's documentation.
pub(crate) fn example(table: &Table) -> String {
    let lines = table.about.iter().map(|line| line.strip_prefix(' ').unwrap_or(line));
    let inside = lines.skip_while(|line| *line != "```ron").skip(1).take_while(|line| *line != "```");
    let example = inside.collect::<Vec<_>>().join("\n");
    assert!(!example.is_empty(), "{} has no example", called(table));
    example
}

/// Everything.
pub(crate) fn all() -> Catalogue {
    let mut all = Catalogue::default();
    for file in FILES {
        all.table(file(), false);
    }
    all
}

impl Catalogue {
    fn table(&mut self, table: Table, inner: bool) {
        let name = called(&table);
        if !inner {
            self.inner.retain(|other| *other != name);
        }
        if let Some(known) = self.tables.insert(name, table) {
            assert_eq!(known.about, table.about, "two tables are called {name}");
            return;
        }
        if inner {
            self.inner.push(name);
        }
        for row in table.rows {
            self.form(&row.form);
        }
    }

    fn form(&mut self, form: &Form) {
        match form {
            Form::Fields(table) => self.table(table(), false),
            Form::Words(words) => {
                if self.words.insert(words.name, words).is_some() {
                    return;
                }
                words.or.iter().for_each(|or| self.form(or));
                for takes in words.all.iter().flat_map(|word| word.takes) {
                    match takes {
                        WordContents::Nothing => {}
                        WordContents::Values(values) => values.iter().for_each(|value| self.form(value)),
                        WordContents::Fields(table) => self.table(table(), true),
                    }
                }
            }
            Form::Choice(what, words) => {
                let known = self.choices.entry(what).or_insert_with(words);
                assert_eq!(*known, words(), "there are two choices called {what}");
            }
            Form::Tuple(forms) | Form::Either(forms) => forms.iter().for_each(|form| self.form(form)),
            Form::List(of) | Form::Several(of, ..) | Form::Map(_, of) => self.form(of),
            Form::Anything
            | Form::Open(_)
            | Form::Plain(_)
            | Form::Truth
            | Form::Whole(..)
            | Form::Listed(_)
            | Form::Number
            | Form::Expression(_)
            | Form::Reference(_) => {}
        }
    }
}
