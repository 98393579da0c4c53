//! Files of any bytes: reading one ends in a pipeline or in mistakes that can be shown.

use crate::testing::pipelines::{INPUTS, shipped};
use crate::testing::table::Table;
use framewright_graph::base::{self, Sources};
use framewright_graph::expand::expand;
use framewright_graph::language;
use proptest::prelude::*;
use std::sync::Arc;

/// Reads bytes, expands what they say, shows what is wrong; panics if any of these does, or if nothing is shown.
fn goes_through(bytes: Vec<u8>) {
    let mut sources = Sources::default();
    let pipeline = language::read_bytes(&mut sources, "random.ron", "random.ron", bytes);
    let sources = Arc::new(sources);
    if let Err(errors) = pipeline.and_then(|pipeline| expand(&pipeline, sources.clone(), &INPUTS, &mut Table)) {
        let shown = base::render(&sources, &errors);
        assert!(shown.starts_with("error: "));
        assert!(shown.chars().all(|c| c == '\n' || !c.is_control()), "{shown:?}");
        assert_eq!(base::to_json(&sources, &errors).as_array().map(Vec::len), Some(errors.len()));
    }
}

/// Pieces that the language is made of, and some that it isn't.
const PIECES: &[&str] = &[
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "\"",
    ",",
    ":",
    "name: ",
    "\"color\"",
    "\"screen\"",
    "Like(\"color\")",
    "Output",
    "Depth",
    "Color(hdr: \"hdr\")",
    "Scaled(0.5)",
    "1e999",
    "NaN",
    "-1",
    "0",
    "99999999999999999999",
    "/*",
    "*/",
    "//",
    "\n",
    "\u{feff}",
    "\u{9b}",
    "é",
    "r#\"",
    "\\",
    "Some(",
    "None",
    "()",
    "#![enable(unwrap_newtypes)]",
    "'",
    "b\"x\"",
    "samples: \"msaa\"",
    "when: \"!hdr || hdr\"",
    "otherwise: Forward(from: \"color\", to: \"screen\")",
    "0x10",
    "1_0",
];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn any_bytes_are_answered(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        goes_through(bytes);
    }

    #[test]
    fn any_text_is_answered(text in "\\PC*") {
        goes_through(text.into_bytes());
    }

    #[test]
    fn a_shipped_pipeline_with_changes_is_answered(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), 0..40_usize, any::<prop::sample::Index>()), 1..6),
    ) {
        let mut text = shipped("forward.ron");
        for (at, removed, piece) in changes {
            let start = text.floor_char_boundary(at.index(text.len() + 1));
            let end = text.ceil_char_boundary((start + removed).min(text.len()));
            text.replace_range(start..end, PIECES[piece.index(PIECES.len())]);
        }
        goes_through(text.into_bytes());
    }

    #[test]
    fn a_shipped_pipeline_with_a_byte_changed_is_answered(at in any::<prop::sample::Index>(), byte in any::<u8>()) {
        let mut bytes = shipped("soft_focus.ron").into_bytes();
        let at = at.index(bytes.len());
        bytes[at] = byte;
        goes_through(bytes);
    }
}
