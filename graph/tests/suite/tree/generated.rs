//! Texts that are made at random, or changed so.

use crate::tree::judge::judge;
use crate::tree::{ours, shipped};
use proptest::prelude::*;

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
