//! Counts the files that name variants of an enumeration that grows: somebody looks at each of them for a new kind of work, draw or access.

use framewright_tests::sources::{self, FLAGS, KINDS, Source, flat};
use std::collections::BTreeSet;

/// Whether a file names a variant of `kind`, or imports one; under an alias too.
fn names(source: &Source, kind: &str) -> bool {
    let mut tokens = Vec::new();
    flat(&source.tokens, &mut tokens);
    let mut called = BTreeSet::from([kind]);
    called.extend(tokens.windows(3).filter(|it| it[0] == kind && it[1] == "as").map(|it| it[2].as_str()));
    let is_variant = |token: &str| token == "(" || token == "*" || token.starts_with(char::is_uppercase);
    tokens.windows(4).any(|it| called.contains(it[0].as_str()) && it[1] == ":" && it[2] == ":" && is_variant(&it[3]))
}

#[test]
fn as_many_files_name_kinds_as_did() {
    let sources = sources::all();
    let mut changed = Vec::new();
    for kind in KINDS.iter().chain(&FLAGS) {
        let (name, known) = (kind.name, kind.others);
        let others = sources.iter().filter(|source| kind.is_foreign_to(&source.path));
        let naming: Vec<&str> = others.filter(|source| names(source, name)).map(|source| &*source.path).collect();
        println!("{name}: {} files", naming.len());
        if naming.len() != known {
            changed.push(format!("{} files name variants of `{name}`, and {known} did: {naming:#?}", naming.len()));
        }
    }
    assert!(
        changed.is_empty(),
        "{}\nwhere there are more, ask a predicate beside the enumeration; where there are fewer, lower the number",
        changed.join("\n")
    );
}

#[test]
fn variants_are_found_by_any_name() {
    let source = |text: &str| {
        let tokens = text.parse::<proc_macro2::TokenStream>().expect("Rust").into_iter().collect();
        Source { path: String::new(), text: text.to_owned(), tokens }
    };
    for text in [
        "fn f(it: Work) -> bool { matches!(it, Work::Copy) }",
        "use crate::frame::Work as FrameWork; fn f() { let it = FrameWork::Copy; }",
        "use crate::frame::Work::{Copy, Fill};",
        "use crate::frame::Work::*;",
    ] {
        assert!(names(&source(text), "Work"), "{text}");
    }
    for text in ["use crate::frame::Work;", "fn f(it: &Work) { Work::name(it) }", "enum Works { Copy }"] {
        assert!(!names(&source(text), "Work"), "{text}");
    }
}
