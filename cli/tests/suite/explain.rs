//! `explain`: why something is in a Plan, or isn't, in words (IN-5, IN-6, IN-8).

use crate::testing::Place;
use serde_json::Value;

fn first() -> Place {
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    place
}

#[track_caller]
fn told(place: &Place, arguments: &[&str], expected: &[&str]) {
    let out = place.run(&[&["explain"], arguments].concat()).exits(0).out;
    for words in expected {
        assert!(out.contains(words), "`{words}` is not in\n{out}");
    }
}

#[test]
fn a_pass_an_image_a_resolve_a_barrier_an_allocation_and_a_queue_are_explained() {
    let place = first();
    told(
        &place,
        &["first.ron", "tone_map"],
        &["`tone_map` draws in step 1\n", "(first.ron:26)", "`resolve color` for `color (resolved)`"],
    );
    told(
        &place,
        &["first.ron", "tone_map"],
        &["opens a rendering scope of its own: it samples `color (resolved)`", "its step moves 3.5 MiB"],
    );
    told(
        &place,
        &["first.ron", "color"],
        &["28.1 MiB at 0 B in heap 0", "`sky` in step 0 reads and writes it", "it is a transient attachment"],
    );
    told(
        &place,
        &["first.ron", "color", "--device", "mali-g78"],
        &["it is never loaded nor stored: the device draws in tiles, and keeps its 28.1 MiB on the chip"],
    );
    told(
        &place,
        &["first.ron", "sky", "--device", "mali-g78"],
        &["its step keeps 42.2 MiB on the chip, neither loaded nor stored"],
    );
    told(
        &place,
        &["first.ron", "color", "--set", "msaa=1"],
        &["it is no transient attachment: `tone_map` needs it in memory"],
    );
    told(
        &place,
        &["first.ron", "resolve:color"],
        &["`tone_map` samples `color` and it has 4 samples (first.ron:27)", "samples: set by msaa = 4"],
    );
    told(
        &place,
        &["first.ron", "resolve:color", "--set", "msaa=1"],
        &["no resolve reads or writes `color`", "1 sample"],
    );
    let waits =
        "waits for COLOR_ATTACHMENT_WRITE in COLOR_ATTACHMENT_OUTPUT, before SHADER_SAMPLED_READ in FRAGMENT_SHADER";
    told(
        &place,
        &["first.ron", "barrier:color (resolved)"],
        &["`tone_map` reads what step 0 wrote", waits, "goes if the reader"],
    );
    told(&place, &["first.ron", "step:1"], &["step 1: rendering scope, 1280×720, 1 sample", "moves 3.5 MiB stored"]);
    told(&place, &["first.ron", "heap:0"], &["heap 0: 49.2 MiB", "`depth`: 14.1 MiB at 28.1 MiB, steps 0–0"]);
    told(&place, &["first.ron", "queue:graphics"], &["2 steps run on the graphics queue"]);
    told(&place, &["deferred", "show_open"], &["`show_open` is not in the Plan", "is off: overlay = false"]);
    told(&place, &["deferred", "shown"], &["its memory is shared with", "`shadow`, alive in steps 0–9"]);
}

#[test]
fn a_copy_and_a_fill_are_explained_by_their_own_lines() {
    let place = Place::new();
    let image = |name: &str| format!("(name: \"{name}\", format: R8G8B8A8_UNORM, size: Fixed(8, 8))");
    let passes = "(name: \"set\", fill: (to: \"a\", value: 0)), (name: \"move\", copy: (from: \"a\", to: \"b\"))";
    let (a, b) = (image("a"), image("b"));
    let outputs = "(image: \"b\", encoding: Unorm)";
    place.file(
        "moves.ron",
        format!("Pipeline(version: 1, images: [{a}, {b}], passes: [{passes}], outputs: [{outputs}])"),
    );
    told(&place, &["moves.ron", "set"], &["`set` fills in step 0", "step 0: `set` fills `a` 8×8 with "]);
    told(&place, &["moves.ron", "move"], &["`move` copies in step 1", "step 1: `move`: copy `a` 8×8 → `b` 8×8"]);
}

#[test]
fn programs_read_the_same_and_unknown_things_are_told_with_a_near_name() {
    let place = first();
    let json = place.run(&["explain", "first.ron", "sky", "--format", "json"]).exits(0).out;
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["explanations"][0]["text"], "`sky` draws in step 0");
    assert_eq!(json["explanations"][0]["parts"][0]["at"], "first.ron:22:16");
    assert_eq!(json["explanations"][0]["parts"][0]["kind"], "pass");
    place.run(&["explain", "first.ron", "tonemap"]).exits(1).mentions("help: did you mean `tone_map`?");
    place.run(&["explain", "first.ron", "step:9"]).exits(1).mentions("the steps are 0 to 1");
    place.run(&["explain", "first.ron", "step:x"]).exits(1).mentions("the steps are 0 to 1");
    place.run(&["explain", "first.ron", "heap:4294967296"]).exits(1).mentions("the heaps are 0 to 0");
    place.run(&["explain", "first.ron", "queue:video"]).exits(1).mentions("graphics, compute and transfer");
    place.run(&["explain", "first.ron", "\u{1b}[2J"]).exits(1).mentions("there is no `\\u{1b}[2J` in the Plan");
    place.run(&["explain", "first.ron"]).exits(2);
}
