//! The rooms of each crate: which folder may use which, as docs/architecture.md lists them.

mod arrows;
mod rules;

use std::path::Path;

/// The crates whose rooms have an order.
const CRATES: [&str; 9] = [
    "graph",
    "backend-vulkan",
    "passes",
    "framewright",
    "framewright/c",
    "framewright/lab",
    "framewright/viewer",
    "framewright/viewer/what-if",
    "cli",
];

/// The rooms of a crate from the bottom to the top: those that the tables of rooms in docs/architecture.md name, in their order.
fn order(page: &str, name: &str) -> Vec<String> {
    let src = format!("`{name}/src/");
    let mut rooms = Vec::new();
    let tables = page.split("\n\n").filter(|part| part.starts_with("| room |"));
    for cell in tables.flat_map(str::lines).filter_map(|line| line.strip_prefix("| ")?.split('|').next()) {
        for path in cell.split(&src).skip(1) {
            let room = path.split(['/', '`', '.']).next().unwrap_or_default().to_owned();
            if !rooms.contains(&room) {
                rooms.push(room);
            }
        }
    }
    rooms
}

#[test]
fn no_file_uses_one_above_it_and_no_circle_is_wide() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let page = std::fs::read_to_string(root.join("docs/architecture.md")).unwrap();
    let breaches: Vec<String> = CRATES
        .iter()
        .flat_map(|name| {
            let arrows = arrows::of_folder(&root.join(name).join("src"));
            assert!(
                arrows.values().map(|used| used.len()).sum::<usize>() > arrows.len(),
                "{name}: hardly any file uses another"
            );
            rules::breaches(&arrows, &order(&page, name)).into_iter().map(move |breach| format!("{name}/src: {breach}"))
        })
        .collect();
    assert!(breaches.is_empty(), "{}", breaches.join("\n"));
}

/// The breaches in a crate of these files.
fn found(sources: &[(&str, &str)], order: &[&str]) -> Vec<String> {
    let order: Vec<String> = order.iter().map(|room| (*room).to_owned()).collect();
    rules::breaches(&arrows::of_sources(sources.iter().copied()), &order)
}

#[test]
fn an_upward_arrow_is_found_whatever_way_it_is_written() {
    let face = ("lib.rs", "mod low; mod high;");
    let high = ("high/mod.rs", "mod deep; pub use deep::Thing;");
    let deep = ("high/deep.rs", "pub struct Thing;");
    for low in [
        "use crate::high::Thing;",
        "use crate::high::{self, Thing as Other};",
        "fn f() -> crate::high::Thing { todo() }",
        "use super::high; fn f() { high::Thing; }",
        "fn f() { vec![crate::high::Thing]; }",
        "impl Into<crate::high::deep::Thing> for u32 {}",
    ] {
        let breaches = found(&[face, high, deep, ("low.rs", low)], &["low", "high"]);
        assert!(
            breaches.contains(&"low.rs uses high/deep.rs, which stands above it".to_owned()),
            "{low}: {breaches:?}"
        );
    }
    let downward = [face, high, deep, ("low.rs", "pub fn f() {}"), ("high/other.rs", "use crate::low::f;")];
    assert_eq!(found(&downward, &["low", "high"]), Vec::<String>::new());
    let tests_alone = [face, high, deep, ("low.rs", "#[cfg(test)] mod tests { use crate::high::Thing; }")];
    assert_eq!(found(&tests_alone, &["low", "high"]), Vec::<String>::new());
}

#[test]
fn a_re_export_of_something_higher_is_found_and_one_of_an_own_file_is_not() {
    let high =
        [("lib.rs", ""), ("high/mod.rs", "mod deep; pub use deep::Thing;"), ("high/deep.rs", "pub struct Thing;")];
    for export in ["pub use crate::high::Thing;", "pub(crate) use crate::high::*;", "pub use super::high::deep;"] {
        let breaches = found(&[&high[..], &[("low/mod.rs", export)]].concat(), &["low", "high"]);
        assert!(
            matches!(&breaches[..], [breach] if breach.starts_with("low/mod.rs uses high/")),
            "{export}: {breaches:?}"
        );
    }
    assert_eq!(found(&high, &["high"]), Vec::<String>::new());
}

#[test]
fn an_upward_arrow_is_found_in_a_module_inside_a_file() {
    let high = [("lib.rs", ""), ("high.rs", "pub struct Thing;")];
    for low in [
        "mod inner { use super::super::high::Thing; }",
        "mod inner { mod more { fn f() -> super::super::super::high::Thing { todo() } } }",
        "mod inner { pub use crate::high::Thing; }",
        "mod inner { use crate::high; fn f() { high::Thing; } }",
    ] {
        let breaches = found(&[&high[..], &[("low.rs", low)]].concat(), &["low", "high"]);
        assert_eq!(breaches, ["low.rs uses high.rs, which stands above it"], "{low}");
    }
    // Names of a module inside a file are no names of the file.
    let apart = "mod inner { pub struct Thing; } use crate::high::Thing; fn f() { Thing; }";
    let above = [high[0], high[1], ("top.rs", apart)];
    assert_eq!(found(&above, &["high", "top"]), Vec::<String>::new());
}

#[test]
fn a_path_that_goes_on_after_an_import_is_followed_to_its_end() {
    for low in [
        "fn f() { crate::middle::high::deep::Thing; }",
        "use crate::middle; fn f() { middle::high::deep::Thing; }",
        "use crate::middle::high; fn f() { high::Thing; }",
        "use crate::high::Thing;",
    ] {
        let arrows = arrows::of_sources([
            ("low.rs", low),
            ("middle/mod.rs", "pub use crate::high;"),
            ("high/mod.rs", "pub mod deep; pub use deep::*;"),
            ("high/deep.rs", "pub struct Thing;"),
        ]);
        assert!(arrows["low.rs"].contains("high/deep.rs"), "{low}: {arrows:?}");
    }
}

#[test]
fn rooms_are_read_from_tables_of_rooms_alone() {
    let page = "\
text of `graph/src/text`

| stage | makes |
|---|---|
| `graph/src/top` | what it makes |

| room | contents |
|---|---|
| `graph/src/low` | not `graph/src/other` |
| `graph/src/top.rs` | more |
";
    assert_eq!(order(page, "graph"), ["low", "top"]);
}

#[test]
fn rooms_that_nobody_ordered_are_found_and_those_that_are_gone() {
    let breaches = found(&[("a.rs", ""), ("b/mod.rs", "")], &["a", "c"]);
    assert_eq!(
        breaches,
        ["b/mod.rs: the order of rooms doesn't name `b`", "the order of rooms names `c`, which isn't there"]
    );
}

#[test]
fn folders_that_use_each_other_are_found_at_any_depth() {
    let breaches = found(
        &[
            ("top/mod.rs", "mod a; mod b;"),
            ("top/a/mod.rs", "pub struct A;"),
            ("top/a/second.rs", "use crate::top::b::B;"),
            ("top/b/mod.rs", "pub struct B;"),
            ("top/b/second.rs", "use super::super::a::A;"),
        ],
        &["top"],
    );
    assert_eq!(
        breaches,
        ["folders use each other: top/a/second.rs uses top/b/mod.rs, top/b/second.rs uses top/a/mod.rs"]
    );
}

#[test]
fn a_circle_of_four_files_is_found_and_one_of_three_is_not() {
    let four = [
        ("x/a.rs", "use super::b::B; pub struct A;"),
        ("x/b.rs", "use super::c::C; pub struct B;"),
        ("x/c.rs", "use super::d::D; pub struct C;"),
        ("x/d.rs", "use super::a::A; pub struct D;"),
    ];
    assert_eq!(found(&four, &["x"]), ["4 files use each other in a circle: x/a.rs, x/b.rs, x/c.rs, x/d.rs"]);
    let three = [four[0], four[1], ("x/c.rs", "use super::a::A; pub struct C;")];
    assert_eq!(found(&three, &["x"]), Vec::<String>::new());
}
