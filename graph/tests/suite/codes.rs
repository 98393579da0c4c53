//! `docs/codes.md` is made of the table of codes.

use framewright_graph::base::Room;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Writes the page instead of comparing it.
const UPDATE: &str = "FRAMEWRIGHT_UPDATE";

const HEAD: &str = "\
# Codes of mistakes

Every error ends its first line with a code. A code stands for one rule, and never changes its meaning. `framewright explain --code E0207` prints what stands here.
";

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/codes.md")
}

fn made() -> String {
    let mut made = HEAD.to_owned();
    for room in Room::all() {
        // Writing to a text can't fail.
        let _ = write!(made, "\n## {}\n", room.title);
        for code in room.codes() {
            let _ = write!(made, "\n### {code}: {}\n\n", code.title());
            // Examples stand in lines of their own.
            let explanation = code.explanation().replace("\nWrong:", "\n\nWrong:").replace("\nMended:", "\\\nMended:");
            let _ = writeln!(made, "{explanation}");
        }
    }
    made
}

#[test]
fn the_page_of_codes_tells_what_the_table_says() {
    let made = made();
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(page(), made).expect("written");
        return;
    }
    let there = std::fs::read_to_string(page()).unwrap_or_default();
    let differs = there.lines().zip(made.lines()).find(|(there, made)| there != made);
    assert!(
        there == made,
        "docs/codes.md is not what the table says, first {differs:#?}\n\
         see:    {UPDATE}=1 cargo test -p framewright-graph --test suite codes; git diff docs/codes.md\n\
         accept: git add docs/codes.md"
    );
}
