//! Pipelines that are as large as anyone's.

use crate::testing::{self, Place};
use std::fmt::Write;

/// Passes of a pipeline that draws back and forth between two images.
pub(crate) fn back_and_forth(passes: usize) -> String {
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

/// Passes that nobody needs, behind one that draws the screen.
fn needless(passes: usize) -> String {
    let images: String = (0..passes).map(|at| format!("(name: \"i{at}\", format: Output, size: Output),\n")).collect();
    let draw = |image: String| format!("draw: Sky, color: [(image: \"{image}\", clear: (0.0, 0.0, 0.0, 1.0))]");
    let needless: String = (0..passes).map(|at| format!("(name: \"p{at}\", {}),\n", draw(format!("i{at}")))).collect();
    format!(
        "Pipeline(version: 1, images: [{images}(name: \"screen\", format: Output, size: Output)], passes: [\n{needless}\
        (name: \"show\", {})], outputs: [\"screen\"])",
        draw("screen".to_owned())
    )
}

#[test]
fn of_many_notes_of_one_kind_people_are_shown_a_few_and_programs_all() {
    let place = Place::new();
    place.file("p.ron", needless(1000));
    for device in ["lavapipe", "all"] {
        let out = place.run(&["check", "p.ron", "--device", device]).exits(0).out;
        let notes: Vec<&str> = out.lines().filter(|line| line.contains("note: ")).collect();
        assert_eq!(notes.len(), 4, "{out}");
        assert!(notes[2].contains("`p2`: does not run: no output needs what it writes"), "{out}");
        assert!(notes[3].contains("note: 997 more like `p3` (`--format json` has all)"), "{out}");
    }
    let json = place.run(&["check", "p.ron", "--format", "json"]).exits(0).out;
    assert_eq!(json.matches("no output needs what it writes").count(), 1000);
    // Twenty are no more than anyone reads.
    place.file("p.ron", needless(20));
    let out = place.run(&["check", "p.ron"]).exits(0).out;
    assert_eq!(out.matches("does not run").count(), 20, "{out}");
}

#[test]
fn a_long_check_shows_what_it_does_on_a_terminal_alone() {
    let place = Place::new();
    place.file("p.ron", back_and_forth(10_000));
    assert_eq!(place.run(&["check", "p.ron"]).exits(0).err, "");
    // `script` gives it a terminal.
    let line = format!("{} check p.ron > out.txt", env!("CARGO_BIN_EXE_framewright"));
    let mut script = std::process::Command::new("script");
    script.args(["-qec", &line, "/dev/null"]).env("TERM", "xterm").current_dir(place.path(""));
    match script.output() {
        Ok(shown) => {
            let shown = String::from_utf8_lossy(&shown.stdout);
            assert!(shown.contains("compiling 10000 passes for "), "{shown:?}");
        }
        Err(error) => eprintln!("SKIPPED: no `script` here: {error}"),
    }
}

#[test]
fn an_image_of_thirty_thousand_parts_takes_moderate_memory() {
    let place = Place::new();
    let part = |pass: usize| format!("(image: \"a\", mip: {}, layer: {pass})", pass % 15);
    let fills: String = (0..2048)
        .map(|pass| format!("(name: \"p{pass}\", fill: (to: {}, value: 0), side_effect: true),\n", part(pass)))
        .collect();
    let text = format!(
        "Pipeline(version: 1, images: [\n\
        (name: \"a\", format: R8_UNORM, size: Fixed(16384, 1), mips: 15, layers: 2048),\n\
        (name: \"screen\", format: Output, size: Output)], passes: [\n{fills}\
        (name: \"all\", fill: (to: \"a\", value: 0)),\n\
        (name: \"show\", draw: FullScreen(\"reinhard\"), sample: {{\"source\": (image: \"a\", layer: 0)}}, \
        color: [\"screen\"])], outputs: [\"screen\"])"
    );
    place.file("p.ron", text);
    for device in ["lavapipe", "amd-rx-7800-xt"] {
        // Pairs of parts would take a hundred times as much.
        let check = "ulimit -v 4000000; exec \"$0\" check p.ron --device \"$1\"";
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", check, env!("CARGO_BIN_EXE_framewright"), device]).current_dir(place.path(""));
        let outcome = testing::outcome(&mut shell).exits(0);
        assert!(outcome.out.contains(": 2050 passes in 1 rendering scope, "), "{}", outcome.out);
    }
}
