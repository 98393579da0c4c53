//! Pipelines that are as large as anyone's.

mod support;

use std::fmt::Write;
use support::Place;

/// Passes of a pipeline that draws back and forth between two images.
fn back_and_forth(passes: usize) -> String {
    let mut text = "Pipeline(version: 1, images: [\n\
        (name: \"a\", format: Color(hdr: true), size: Output), (name: \"b\", format: Like(\"a\"), size: Output),\n\
        (name: \"screen\", format: Output, size: Output)], passes: [\n\
        (name: \"first\", draw: Sky, color: [(image: \"a\", clear: (0.0, 0.0, 0.0, 1.0))]),\n"
        .to_owned();
    for pass in 0..passes - 2 {
        let [from, to] = if pass % 2 == 0 { ["a", "b"] } else { ["b", "a"] };
        let draw = format!("draw: FullScreen(\"downsample\"), sample: {{\"source\": \"{from}\"}}, color: [\"{to}\"]");
        writeln!(text, "(name: \"p{pass}\", {draw}),").expect("memory");
    }
    let last = if passes.is_multiple_of(2) { "a" } else { "b" };
    let draw = format!("draw: FullScreen(\"reinhard\"), sample: {{\"source\": \"{last}\"}}, color: [\"screen\"]");
    text + &format!("(name: \"last\", {draw})], outputs: [\"screen\"])")
}

#[test]
fn a_hundred_thousand_passes_are_checked_and_their_mistakes_are_shown_in_moderation() {
    let place = Place::new();
    let text = back_and_forth(100_000);
    place.file("p.ron", &text);
    let out = place.run(&["check", "p.ron"]).exits(0).out;
    assert!(out.starts_with("p.ron: fine on lavapipe: 100000 passes in 100000 rendering scopes, "), "{out}");

    place.file("p.ron", text.replace("\"downsample\"", "\"downsamples\""));
    let err = place.run(&["check", "p.ron"]).exits(1).mentions("downsamples").err;
    assert!(err.lines().count() < 1000, "{} lines are more than anyone reads", err.lines().count());
}
