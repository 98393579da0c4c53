//! `docs/language.md` is made of the readers' own tables, and of the text around them in `language.md` beside this file.

pub(crate) mod catalogue;
mod examples;
mod page;
mod schema;
mod takes;

use std::path::{Path, PathBuf};

/// Writes the page instead of comparing it.
const UPDATE: &str = "FRAMEWRIGHT_UPDATE";

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/language.md")
}

#[test]
fn the_reference_tells_what_is_read() {
    let made = page::make(include_str!("language.md"));
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(page(), made).expect("written");
        return;
    }
    let there = std::fs::read_to_string(page()).unwrap_or_default();
    let differs = there.lines().zip(made.lines()).find(|(there, made)| there != made);
    assert!(
        there == made,
        "docs/language.md is not what the tables say, first {differs:#?}\n\
         see:    {UPDATE}=1 cargo test -p framewright-graph --test suite reference; git diff docs/language.md\n\
         accept: git add docs/language.md"
    );
}

#[test]
fn every_field_says_what_it_means_and_what_it_takes() {
    for table in catalogue::all().tables.values() {
        assert!(!table.noun().is_empty(), "{} doesn't say what it is", table.name);
        for row in table.rows {
            let said = row.about.iter().any(|line| line.trim().ends_with('.') || line.trim().ends_with('`'));
            assert!(said, "`{}` of {} has no documentation", row.name, table.name);
            let taken = !matches!(row.form, framewright_graph::ron::Form::Anything);
            assert!(taken, "`{}` of {} doesn't say what it takes: `=> Form::…`", row.name, table.name);
        }
    }
}
