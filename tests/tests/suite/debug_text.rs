//! `Debug` text is Rust's, for those who write this code. What people are told is worded: no source formats by `{:?}` but where it is
//! said here why that is no message, or is Vulkan's word.

use proc_macro2::{Literal, TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::path::Path;

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

/// Files that format by `Debug`, how often, and why.
const ALLOWED: [(&str, usize, &str); 16] = [
    (
        "backend-vulkan/src/base/debug_words.rs",
        1,
        "the names of Vulkan and SPIR-V, which their crates have as Debug text",
    ),
    ("backend-vulkan/src/shaders/spirv_cache.rs", 2, "a part of a key"),
    ("framewright/lab/src/digest.rs", 1, "a part of a digest"),
    ("framewright/lab/src/bench/choice.rs", 1, "a part of a digest"),
    ("framewright/lab/src/sweep/values.rs", 2, "numbers that read as the very same"),
    ("cli/src/variants/facts.rs", 4, "numbers that read as the very same"),
    ("graph/src/base/text.rs", 1, "a number that reads as the very same"),
    ("backend-vulkan/src/shaders/corpus.rs", 3, "a test's own"),
    ("graph/src/shader/draw_kind.rs", 1, "a text of RON"),
    ("graph/src/shader/interface_file.rs", 3, "texts of RON"),
    ("graph/src/shader/interface_vertices.rs", 1, "a text of RON"),
    (
        "passes/src/texture_files/containers/dds.rs",
        1,
        "the names of DXGI's formats, which their crate has as Debug text",
    ),
    ("passes/src/facts/mod.rs", 1, "numbers in brackets, as files have them"),
    ("passes/src/scene/gltf/lights.rs", 1, "numbers in brackets, as glTF has them"),
    ("passes/src/scene/gltf/mod.rs", 2, "numbers in brackets, as glTF has them"),
    ("passes/src/scene/gltf/nodes.rs", 1, "numbers in brackets, as glTF has them"),
];

const ASSERTIONS: [&str; 8] =
    ["assert", "assert_eq", "assert_ne", "debug_assert", "debug_assert_eq", "debug_assert_ne", "panic", "unreachable"];

/// How often format strings of a file ask for `Debug` text, outside of tests and assertions.
fn debug_texts(text: &str) -> usize {
    let tokens: TokenStream = text.parse().expect("it is Rust");
    count(tokens)
}

fn count(tokens: TokenStream) -> usize {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut found = 0;
    let mut at = 0;
    while at < tokens.len() {
        let is_mark =
            |at: usize, mark: char| matches!(tokens.get(at), Some(TokenTree::Punct(it)) if it.as_char() == mark);
        let is_of_tests = || match tokens.get(at + 1) {
            Some(TokenTree::Group(group)) => group.to_string().replace([' ', '\n'], "") == "[cfg(test)]",
            _ => false,
        };
        if is_mark(at, '#') && is_of_tests() {
            // The item behind it ends with its braces, or a semicolon.
            let ends = |token: &TokenTree| match token {
                TokenTree::Group(group) => group.delimiter() == proc_macro2::Delimiter::Brace,
                TokenTree::Punct(mark) => mark.as_char() == ';',
                _ => false,
            };
            at += 2 + tokens[at + 2..].iter().position(ends).map_or(tokens.len(), |end| end + 1);
            continue;
        }
        // A broken promise of the program is no message for people.
        let is_assertion = || match &tokens[at] {
            TokenTree::Ident(word) => ASSERTIONS.iter().any(|name| word == name),
            _ => false,
        };
        if is_mark(at + 1, '!') && is_assertion() {
            at += 3;
            continue;
        }
        found += match &tokens[at] {
            TokenTree::Group(group) => count(group.stream()),
            TokenTree::Literal(literal) => in_literal(literal),
            TokenTree::Ident(_) | TokenTree::Punct(_) => 0,
        };
        at += 1;
    }
    found
}

fn in_literal(literal: &Literal) -> usize {
    let text = literal.to_string();
    // Comments of documentation are literals of attributes, and hold what they like.
    let places = text.split('{').skip(1).filter_map(|rest| rest.split_once('}'));
    places.filter(|(place, _)| place.ends_with(":?") || place.ends_with(":#?")).count()
}

fn of_folder(folder: &Path, name: &str, found: &mut BTreeMap<String, usize>) {
    let mut entries: Vec<_> =
        folder.read_dir().expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        let name = format!("{name}/{}", path.file_name().expect("a name").to_string_lossy());
        if path.is_dir() {
            of_folder(&path, &name, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).expect("readable");
            let text: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
            let count = debug_texts(&text.join("\n"));
            if count > 0 {
                found.insert(name, count);
            }
        }
    }
}

#[test]
fn no_debug_text_reaches_people() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the repository");
    let mut found = BTreeMap::new();
    for name in CRATES {
        of_folder(&root.join(name).join("src"), &format!("{name}/src"), &mut found);
    }
    let allowed: BTreeMap<String, usize> =
        ALLOWED.iter().map(|(file, count, _)| ((*file).to_owned(), *count)).collect();
    let new: Vec<_> = found.iter().filter(|(file, count)| allowed.get(*file) != Some(count)).collect();
    assert!(new.is_empty(), "`{{:?}}` in sources: word it, or say in this test why it is no message: {new:#?}");
    let gone: Vec<_> = allowed.keys().filter(|file| !found.contains_key(*file)).collect();
    assert!(gone.is_empty(), "allowed, and not there any more: {gone:?}");
}

#[test]
fn debug_text_is_found_wherever_it_is_formatted() {
    for (text, count) in [
        (r#"fn f() { format!("{:?}", 1); }"#, 1),
        (r#"fn f() { let t = format!("a {name:?} and {other:#?}"); }"#, 2),
        (r##"#[error("{doing} failed: {result:?}")] struct E;"##, 1),
        (r#"fn f() { write!(f, "{0:?}", x).map(|_| { vec![format!("{y:?}")] }); }"#, 2),
        (r#"fn f() { assert!(a, "{a:?}"); panic!("{b:?}"); assert_eq!(1, 2, "{c:?}"); }"#, 0),
        (r#"#[cfg(test)] mod tests { fn f() { format!("{:?}", 1); } } fn g() { format!("{}", 1); }"#, 0),
        (r#"fn f() { format!("{x}: ?"); }"#, 0),
    ] {
        assert_eq!(debug_texts(text), count, "{text}");
    }
}
