//! What our reader makes of a text is what the `ron` crate makes of it.
//!
//! Known differences, all of them refused by one side and none read in two ways:
//! - we refuse ranges (`1..2`), raw identifiers (`r#a-b`), types behind numbers (`1u8`, `0.5f32`) and brackets nested
//!   deeper than 128; bytes in quotes take the escapes of texts;
//! - `ron` refuses `Some` without exactly one value in parentheses; to our reader it is a word like others. It refuses
//!   whole numbers beyond 64 bits that are written to another base than ten; ours knows them to be too large. It refuses
//!   bytes in quotes that are no ASCII.

use framewright_graph::describe::text::{Leaf, Number, Shape, Tree};
use framewright_graph::describe::{Diagnostic, render};
use framewright_graph::source::Sources;
use proptest::prelude::*;
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;
use std::path::Path;

fn options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

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

/// The parts of a value as `ron` cuts them.
#[derive(Debug)]
enum Parts<'t> {
    None,
    Values(Vec<&'t str>),
    Fields(Vec<(String, &'t str)>),
}

impl<'de> Deserialize<'de> for Parts<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Cut;
        impl<'de> Visitor<'de> for Cut {
            type Value = Parts<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("brackets")
            }

            fn visit_unit<E>(self) -> Result<Parts<'de>, E> {
                Ok(Parts::None)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Parts<'de>, A::Error> {
                let mut parts = Vec::new();
                while let Some(value) = values.next_element::<&RawValue>()? {
                    parts.push(value.trim().get_ron());
                }
                Ok(Parts::Values(parts))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<Parts<'de>, A::Error> {
                let mut parts = Vec::new();
                while let Some((name, value)) = fields.next_entry::<String, &RawValue>()? {
                    parts.push((name, value.trim().get_ron()));
                }
                Ok(Parts::Fields(parts))
            }
        }
        deserializer.deserialize_any(Cut)
    }
}

/// The entries of a map as `ron` cuts them.
struct Entries<'t>(Vec<(&'t str, &'t str)>);

impl<'de> Deserialize<'de> for Entries<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Cut;
        impl<'de> Visitor<'de> for Cut {
            type Value = Entries<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Entries<'de>, A::Error> {
                let mut entries = Vec::new();
                while let Some((key, value)) = map.next_entry::<&RawValue, &RawValue>()? {
                    entries.push((key.trim().get_ron(), value.trim().get_ron()));
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(Cut)
    }
}

fn theirs<'t, T: Deserialize<'t>>(text: &'t str) -> T {
    options().from_str(text).unwrap_or_else(|error| panic!("{error}: {text:?}"))
}

/// Every value under `leaf` is what `ron` reads in the same text, and stands where `ron` finds it.
fn agree(leaf: Leaf<'_>) {
    let text = leaf.text();
    match leaf.shape() {
        Shape::Text => assert_eq!(leaf.words().as_deref(), Some(&*theirs::<String>(text))),
        Shape::Number => match leaf.number() {
            Some(Number::Whole(number)) => assert_eq!(number, theirs::<i64>(text), "{text}"),
            Some(Number::Real(number)) => assert_eq!(number, theirs::<f64>(text), "{text}"),
            Some(Number::Huge(number)) if number.is_finite() => assert_eq!(number, theirs::<f64>(text), "{text}"),
            Some(Number::Huge(_)) => {}
            Some(Number::NotFinite) => assert!(!theirs::<f64>(text).is_finite(), "{text}"),
            None => panic!("`{text}` is a number without value"),
        },
        Shape::Word("Some", _) => leaf.values().into_iter().flatten().for_each(agree),
        Shape::Word(word, rest) => {
            assert!(text.starts_with(word));
            rest.into_iter().for_each(agree);
        }
        Shape::List => {
            let same: Vec<&str> = leaf.values().expect("a list").map(Leaf::text).collect();
            assert_eq!(same, theirs::<Vec<&RawValue>>(text).iter().map(|raw| raw.trim().get_ron()).collect::<Vec<_>>());
            leaf.values().expect("a list").for_each(agree);
        }
        Shape::Parentheses => match (theirs::<Parts<'_>>(text), leaf.values()) {
            (Parts::None, Some(mut values)) => assert!(values.next().is_none(), "{text:?}"),
            (Parts::Values(parts), Some(values)) => {
                let values: Vec<Leaf<'_>> = values.collect();
                assert_eq!(values.iter().map(|value| value.text()).collect::<Vec<_>>(), parts, "{text:?}");
                values.into_iter().for_each(agree);
            }
            (Parts::Fields(parts), None) => {
                let fields: Vec<_> = leaf.fields().expect("fields").collect();
                let same = fields.iter().map(|(name, value)| (name.text().to_owned(), value.text()));
                assert_eq!(same.collect::<Vec<_>>(), parts, "{text:?}");
                fields.into_iter().for_each(|(_, value)| agree(value));
            }
            (parts, _) => panic!("{text:?} is {parts:?}"),
        },
        Shape::Map => {
            let entries: Vec<_> = leaf.entries().expect("a map").collect();
            let same: Vec<_> = entries.iter().map(|(key, value)| (key.text(), value.text())).collect();
            assert_eq!(same, theirs::<Entries<'_>>(text).0, "{text:?}");
            entries.into_iter().flat_map(|(key, value)| [key, value]).for_each(agree);
        }
        Shape::Other => {
            options().from_str::<IgnoredAny>(text).unwrap_or_else(|error| panic!("{error}: {text:?}"));
        }
    }
}

/// Whether `ron` has a rule here that we don't, or the other way round.
fn differ(text: &str) -> bool {
    let typed = |at: usize| {
        let before = text[..at].chars().next_back().is_some_and(|c| c.is_ascii_hexdigit() || matches!(c, '.' | '_'));
        before && text[at..].starts_with(['i', 'u', 'f'])
    };
    let bytes = text.match_indices('b').any(|(at, _)| text[at + 1..].starts_with(['"', '\'', 'r']));
    text.contains("..")
        || text.match_indices("r#").any(|(at, _)| !text[at + 2..].starts_with(['"', '#']))
        || text.contains("Some")
        || text.contains("inff")
        || text.contains("NaNf")
        || bytes
        || (0..text.len()).filter(|at| text.is_char_boundary(*at)).any(typed)
}

/// Both read a text, and in the same way, or neither does.
fn judge(text: &str) -> bool {
    let read = ours(text);
    let accepted = options().from_str::<IgnoredAny>(text);
    match (&read, &accepted) {
        (Ok(tree), Ok(_)) => agree(tree.root()),
        (Ok(_), Err(error)) => assert!(differ(text), "only we read {text:?}: {error}"),
        (Err(errors), Ok(_)) => assert!(differ(text), "only ron reads {text:?}: {}", errors[0].message),
        (Err(_), Err(_)) => {}
    }
    read.is_ok() && accepted.is_ok()
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
    let read = files("tests/language/bad").iter().filter(|text| judge(text)).count();
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

/// RON of every kind, with blanks and comments.
fn value() -> impl Strategy<Value = String> {
    let blank =
        || prop_oneof![4 => Just(""), 2 => Just(" "), 1 => Just("\n"), 1 => Just("/* , */"), 1 => Just("// )\n")];
    let word = || "[a-zA-Z_][a-z0-9_]{0,4}";
    let leaf = prop_oneof![
        word(),
        "-?[0-9]{1,20}",
        "[+-]?[0-9]{0,3}\\.[0-9]{1,4}(e-?[0-9]{1,2})?",
        "0x[0-9a-f]{1,8}",
        "\"[a-z,()\\[\\]{}:ä/ ]{0,6}\"",
        Just(r#""\"\\""#.to_owned()),
        Just("r#\"\"\"#".to_owned()),
        Just("'\"'".to_owned()),
        Just("true".to_owned()),
    ];
    let pad = move |text: String| (blank(), blank()).prop_map(move |(before, after)| format!("{before}{text}{after}"));
    leaf.prop_flat_map(pad).prop_recursive(5, 60, 5, move |inner| {
        let values = || prop::collection::vec(inner.clone(), 0..5);
        let pairs = |key: BoxedStrategy<String>| {
            prop::collection::vec((key, inner.clone()).prop_map(|(key, value)| format!("{key}:{value}")), 1..5)
        };
        let end = |text: &str| if text.is_empty() { "" } else { "," };
        prop_oneof![
            values().prop_map(|values| format!("[{}]", values.join(","))),
            values().prop_map(move |values| format!("({}{})", values.join(","), end(&values.concat()))),
            (word(), values()).prop_map(|(word, values)| format!("{word}({})", values.join(","))),
            (word(), pairs(word().boxed())).prop_map(|(word, fields)| format!("{word} ({},)", fields.join(","))),
            pairs(word().boxed()).prop_map(|fields| format!("({})", fields.join(","))),
            pairs(inner.clone().boxed()).prop_map(|entries| format!("{{{}}}", entries.join(","))),
        ]
        .prop_flat_map(pad)
    })
}

/// A change at a place, which is a share of the text's length.
fn changes() -> impl Strategy<Value = Vec<(f64, usize, String)>> {
    let inserted = prop_oneof![
        2 => Just(String::new()),
        3 => "[()\\[\\]{},:\"'/*#!.+-]{1,2}",
        2 => "[a-z0-9_ ä\\\\\n]{1,3}",
    ];
    prop::collection::vec((0.0..1.0, 0_usize..3, inserted), 1..4)
}

fn changed(text: &str, changes: &[(f64, usize, String)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (share, removed, inserted)| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in a short text")]
        let at = text.floor_char_boundary((text.len() as f64 * share) as usize);
        let end = text.ceil_char_boundary((at + removed).min(text.len()));
        format!("{}{inserted}{}", &text[..at], &text[end..])
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn generated_ron_is_read_as_ron_reads_it(text in value()) {
        assert!(judge(&text), "{text:?}: {:?}", ours(&text).err());
    }

    #[test]
    fn changed_ron_is_read_or_refused_as_ron_does(text in value(), changes in changes()) {
        judge(&changed(&text, &changes));
    }

    #[test]
    fn tokens_in_any_order_are_read_or_refused_as_ron_does(
        text in "([()\\[\\]{},:]|[ab](: )?|\"a\"|[1.-]|//\n?|/\\*|\\*/| |r#?\"|#|!|'|\\\\|ä|=){0,24}"
    ) {
        judge(&text);
    }

    #[test]
    fn any_text_is_answered(text in any::<String>()) {
        judge(&text);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_files_are_read_or_refused_as_ron_does(file in any::<prop::sample::Index>(), changes in changes()) {
        let files = shipped();
        judge(&changed(file.get::<String>(&files), &changes));
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
