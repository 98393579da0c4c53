//! Our reader and the `ron` crate make the same tree of a text.
//!
//! Known differences, all of them refused by one side and none read in two ways:
//! - we refuse ranges (`1..2`), raw identifiers (`r#a-b`), types behind numbers (`1u8`, `0.5f32`) and brackets nested
//!   deeper than 128; bytes in quotes take the escapes of texts;
//! - `ron` refuses `Some` without exactly one value in parentheses; to our reader it is a word like others. It refuses
//!   whole numbers beyond 64 bits that are written to another base than ten; ours knows them to be too large. It refuses
//!   bytes in quotes that are no ASCII.

mod generated;
mod judge;

use framewright_graph::base::{Diagnostic, Sources, render};
use framewright_graph::ron::Tree;
use judge::judge;
use std::path::Path;

/// The tree that our reader makes of a text.
fn ours(text: &str) -> Result<Tree, Vec<Diagnostic>> {
    let mut sources = Sources::default();
    let file = sources.add("test.ron", "test.ron", text);
    let mut errors = Vec::new();
    let tree = Tree::read(file, text.into(), &mut errors);
    let shown = render(&sources, &errors);
    assert!(shown.chars().all(|c| c == '\n' || !c.is_control()), "{shown:?}");
    for label in errors.iter().flat_map(|error| &error.labels) {
        let (start, end) = (label.span.start as usize, label.span.end as usize);
        assert!(text.get(start..end).is_some(), "{start} to {end} is no part of {text:?}");
    }
    match tree {
        Some(tree) if errors.is_empty() => Ok(tree),
        _ => {
            assert!(!errors.is_empty(), "no tree and no word about it: {text:?}");
            Err(errors)
        }
    }
}

fn files(folder: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<_> = folder.read_dir().expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "ron"));
    paths.sort();
    assert!(!paths.is_empty(), "{} has no files", folder.display());
    paths.iter().map(|path| std::fs::read_to_string(path).expect("a text")).collect()
}

fn shipped() -> Vec<String> {
    ["../examples/pipelines", "../examples/scenes", "src/device/profiles"].into_iter().flat_map(files).collect()
}

#[test]
fn every_shipped_file_is_read_as_ron_reads_it() {
    for text in shipped() {
        assert!(judge(&text), "{text}");
    }
}

#[test]
fn every_bad_file_of_the_language_is_read_or_refused_as_ron_does() {
    let read = files("tests/suite/language/bad").iter().filter(|text| judge(text)).count();
    assert!(read > 20, "{read}");
}

#[test]
fn texts_that_are_ron() {
    for text in [
        "()",
        "( )",
        "(1,)",
        "[]",
        "{}",
        "{1: 2, 1: 3,}",
        "A",
        "A()",
        "A ( b : 1 , )",
        "A(B(C(1)))",
        "ä",
        "_",
        "a1",
        "1",
        "-1",
        "+1",
        "1_000",
        "1_",
        "0xff",
        "0xFF_ff",
        "-0x10",
        "0b1010",
        "0o17",
        "1.",
        ".5",
        "-.5",
        "1e5",
        "1E-5",
        "1.5e+3",
        "1_0.5",
        "99999999999999999999",
        "-9223372036854775808",
        "9223372036854775808",
        "1e999",
        "inf",
        "-inf",
        "+NaN",
        "true",
        "[true, false]",
        "None",
        r#""""#,
        r#""a\n\t\r\0\\\"\'b""#,
        r#""\x41\u{1F600}\u{e4}""#,
        r#""\xC3\xA4""#,
        "\"a\\\n   b\"",
        "\"a\\\r\n b\"",
        "r\"a\\b\"",
        "r#\"a\"b\"#",
        "r##\"\"#\"##",
        "'a'",
        r"'\n'",
        r"'\''",
        "'ä'",
        "// a\n1 // b",
        "/* /* a */ b */ 1 /**/",
        "#![enable(implicit_some)]\n1",
        "#![enable(implicit_some, unwrap_newtypes,)] 1",
        "# ! [ schema = \"a\" ] #![type = \"b\"] (a: 1)",
        "\u{2028}1\u{85}",
        "(a: 1, a: 2)",
        "{\"a\": 1, (b: 2): [3]}",
        "(true, a)",
        "A(b, c)",
        "[A(1), B, C(d: 2)]",
    ] {
        assert!(judge(text), "{text:?} is read by both");
    }
}

#[test]
fn texts_that_are_not_ron() {
    for text in [
        "",
        " ",
        "// a",
        "/* a",
        "/",
        "(",
        ")",
        "[1",
        "[1 2]",
        "[,]",
        "[1,,]",
        "(a: 1 b: 2)",
        "(a 1)",
        "(a: )",
        "(1, a: 2)",
        "(a: 1, 2)",
        "{1}",
        "{1: }",
        "{: 1}",
        "{1 2}",
        "1 2",
        "\"a",
        "\"\\q\"",
        "\"\\u{110000}\"",
        "\"\\u{}\"",
        "\"\\xff\"",
        "\"\\x4\"",
        "''",
        "'ab'",
        "'a",
        "r#\"a\"",
        "_1 2",
        "0x",
        "0x_1",
        "0xg",
        "0b2",
        "0o8",
        "1.5.5",
        "1e",
        "-",
        "+",
        ".",
        "1__a",
        "1._5",
        "--1",
        "0x-1",
        "0x+1",
        "a.b",
        "a-b",
        "#![enable(x)] 1",
        "#![enable()] 1",
        "#!1",
        "#![schema = 1] 1",
        "true(1)",
        "None(1)",
        "[1}",
        "(1]",
        "{1: 2)",
        "\u{feff}1",
        "@",
        "(a = 1)",
        "a b",
        "a: 1",
        "\"a\"\"b\"",
    ] {
        assert!(!judge(text), "{text:?} is read by both");
        assert!(ours(text).is_err(), "{text:?} is read");
    }
}

#[test]
fn each_mistake_is_said_once_and_hides_no_other() {
    let said = |text: &str| -> Vec<String> {
        let errors = ours(text).err().unwrap_or_default();
        errors.iter().map(|error| format!("{} {}", error.labels[0].span.start, error.message)).collect()
    };
    assert_eq!(said("[1 2, 3 @, 4]"), ["3 expected a comma", "8 expected a comma"]);
    assert_eq!(said("(a: 1, b 2, c: , d: 4)"), ["9 expected a colon", "15 expected a value, found `,`"]);
    assert_eq!(
        said("(a: [0x, 1], b: {1 [(2)] , 3: \"\\q\"})"),
        ["5 `0x` is no number", "19 expected a colon", "31 `\\q` stands for no character",]
    );
    assert_eq!(said("(a = (1, [2]), b: @)"), ["3 expected a colon", "18 expected a value, found `@`"]);
    assert_eq!(said("[(1, 2], 3)"), ["6 expected `)`"]);
    assert_eq!(
        said("[(a: \"open, b: 1),\n(a: \"closed\", b: 2)]"),
        ["5 this text runs over several lines, and makes no sense there"]
    );
}

#[test]
fn brackets_beyond_the_limit_are_refused_and_no_stack_is_too_small() {
    let nested = |depth: usize| format!("{}{}", "[".repeat(depth), "]".repeat(depth));
    assert!(ours(&nested(128)).is_ok());
    for depth in [129, 1_000_000] {
        let errors = ours(&nested(depth)).expect_err("too deep");
        assert_eq!((errors.len(), &*errors[0].message), (1, "brackets are nested too deeply"));
    }
}
