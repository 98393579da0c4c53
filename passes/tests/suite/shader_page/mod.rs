//! `docs/shaders.md` is made of the shipped shaders: of what they declare, and of the comments beside it.

mod comments;
mod page;

use std::path::{Path, PathBuf};

/// Writes the page instead of comparing it.
const UPDATE: &str = "FRAMEWRIGHT_UPDATE";

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/shaders.md")
}

#[test]
fn the_page_of_shipped_shaders_tells_what_they_declare() {
    let made = page::make(include_str!("shaders.md"));
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(page(), made).expect("written");
        return;
    }
    let there = std::fs::read_to_string(page()).unwrap_or_default();
    let differs = there.lines().zip(made.lines()).find(|(there, made)| there != made);
    assert!(
        there == made,
        "docs/shaders.md is not what the shaders say, first {differs:#?}\n\
         see:    {UPDATE}=1 cargo test -p framewright-passes --test suite shader_page; git diff docs/shaders.md\n\
         accept: git add docs/shaders.md"
    );
}
