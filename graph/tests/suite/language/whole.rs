//! Files that are wrong as a whole, and such as are made to hurt: each is answered, shortly and soon.

use framewright_graph::base::{self, Sources};
use framewright_graph::language::{self, LARGEST_FILE};
use std::time::{Duration, Instant};

/// The answer about bad bytes. It is short and comes soon, for all bytes.
fn answer(bytes: impl Into<Vec<u8>>) -> String {
    let mut sources = Sources::default();
    let begin = Instant::now();
    let errors = language::read_bytes(&mut sources, "test.ron", "test.ron", bytes.into()).expect_err("a bad file");
    let shown = base::render(&sources, &errors);
    assert!(begin.elapsed() < Duration::from_secs(20), "the answer took {:?}", begin.elapsed());
    assert!(shown.len() < 200_000, "the answer has {} bytes", shown.len());
    assert!(shown.chars().all(|c| c == '\n' || !c.is_control()), "control characters are shown");
    shown
}

/// Holds an answer against the one under `whole/`.
fn pinned(name: &str, shown: &str) {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/language/whole");
    insta::with_settings!({
        snapshot_path => folder, prepend_module_to_snapshot => false, omit_expression => true,
    }, { insta::assert_snapshot!(name, shown) });
}

/// A pipeline with some images between two that are right.
fn with_images(images: &str) -> String {
    format!(
        "Pipeline(version: 1, images: [(name: \"screen\", format: Output, size: Output), {images}], passes: [], outputs: [\"screen\"])"
    )
}

#[test]
fn other_programs_read_mistakes_as_json() {
    let mut sources = Sources::default();
    let text = "Pipeline(version: 1, images: [\n  (name: \"a\", format: Dept, size: Output),\n                  (name: \"a\", format: Depth, size: Output),\n], passes: [], outputs: [\"a\"])";
    let errors = language::read(&mut sources, "some/test.ron", "test.ron", text.to_owned()).expect_err("a bad file");
    let json = serde_json::to_string_pretty(&base::to_json(&sources, &errors)).expect("JSON");
    pinned("json", &json);
}

#[test]
fn a_byte_order_mark_is_taken() {
    pinned("byte_order_mark", &answer("\u{feff}Pipeline(version: 1)"));
}

#[test]
fn a_picture_is_no_text() {
    pinned("picture", &answer(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".as_slice()));
}

#[test]
fn bytes_that_break_off_are_placed() {
    pinned("broken_off", &answer(b"Pipeline(\n    version: 1, // \xff\n)".as_slice()));
}

#[test]
fn zeros_are_no_pipeline() {
    pinned("zeros", &answer(vec![0; 1000]));
}

#[test]
fn a_hundred_thousand_brackets_are_too_deep() {
    pinned("brackets", &answer("[".repeat(100_000)));
    pinned("brackets_in_a_list", &answer(with_images(&"(".repeat(100_000))));
    pinned("brackets_on_lines", &answer(with_images(&"[\n".repeat(100_000))));
    pinned("options", &answer(with_images(&"Some(".repeat(100_000))));
}

#[test]
fn a_hundred_thousand_nested_comments_are_answered() {
    pinned("nested_comments", &answer("/*".repeat(100_000)));
}

#[test]
fn a_file_beyond_the_limit_is_not_read() {
    pinned("beyond_the_limit", &answer(" ".repeat(LARGEST_FILE + 1)));
}

#[test]
fn a_long_line_is_cut_or_left_out() {
    let blanks = " ".repeat(3000);
    pinned("long_line", &answer(with_images(&format!("{blanks}(name: \"a\", format: Dept, size: Output)"))));
    let blanks = " ".repeat(100_000);
    pinned("longest_line", &answer(with_images(&format!("{blanks}(name: \"a\", format: Dept, size: Output)"))));
}

#[test]
fn many_mistakes_are_counted() {
    let image = "(name: \"a\", format: Dept, size: Like(\"b\")),\n";
    let shown = answer(with_images(&image.repeat(20_000)));
    let last = shown.lines().last().unwrap_or_default();
    pinned("many_mistakes", last);
}

#[test]
fn a_long_chain_of_images_ends_in_one_answer() {
    let chain: String = (0..50_000)
        .map(|at| format!("(name: \"i{at}\", format: Depth, size: Like(\"i{}\")),\n", (at + 1) % 50_000))
        .collect();
    let shown = answer(with_images(&chain));
    assert_eq!(shown.matches("error: sizes follow each other in a circle").count(), 1);
}
