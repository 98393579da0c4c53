//! Mistakes have stable codes, which `explain --code` explains (IN-5).

use crate::testing::{FORWARD, Place, check};
use serde_json::Value;

#[test]
fn a_code_is_explained_without_a_pipeline() {
    let place = Place::new();
    for shown in ["E0207", "e0207"] {
        let told = place.run(&["explain", "--code", shown]).exits(0).out;
        assert!(told.starts_with("E0207: There is no image of that name.\n\n"), "{told}");
        assert!(told.contains("Mended: `color: [\"color\"]`"), "{told}");
    }
}

#[test]
fn a_code_is_explained_to_programs() {
    let told = Place::new().run(&["explain", "--code", "E0207", "--format", "json"]).exits(0).out;
    let told: Value = serde_json::from_str(&told).expect("JSON");
    assert_eq!((&told["code"], &told["title"]), (&"E0207".into(), &"There is no image of that name.".into()));
    assert!(told["explanation"].as_str().is_some_and(|it| it.starts_with("Passes use images that")), "{told}");
}

#[test]
fn an_unknown_code_is_refused_with_a_near_one() {
    Place::new()
        .run(&["explain", "--code", "E0027"])
        .exits(2)
        .mentions("error: there is no code `E0027` [E1609]\nhelp: did you mean `E0207`?");
}

#[test]
fn a_code_stands_alone() {
    let place = Place::new();
    for more in [&["forward"][..], &["forward", "color"], &["--size", "8x8"], &["--set", "msaa=1"]] {
        let refused = place.run(&[&["explain", "--code", "E0207"], more].concat()).exits(2).err;
        assert!(refused.contains("the argument '--code <E0123>' cannot be used with"), "{refused}");
    }
    place.run(&["explain"]).exits(2).mentions("<PIPELINE>");
}

#[test]
fn errors_end_their_first_line_with_the_code_and_programs_are_told_it() {
    let wrong = FORWARD.replace("color: [(image: \"color\"", "color: [(image: \"colour\"");
    assert_ne!(wrong, FORWARD);
    check(&wrong).exits(1).mentions("error: there is no image named `colour` [E0207]\n");
    let place = Place::new();
    place.file("p.ron", &wrong);
    let told: Value =
        serde_json::from_str(&place.run(&["check", "p.ron", "--format", "json"]).exits(1).out).expect("JSON");
    assert_eq!(told["diagnostics"][0]["code"], "E0207", "{told}");
    for (format, words) in [("sarif", "named `colour` [E0207]"), ("junit", "[E0207]"), ("github", "[E0207]")] {
        let told = place.run(&["check", "p.ron", "--format", format]).exits(1).out;
        assert!(told.contains(words), "{told}");
    }
    place.run(&["check", "nothing.ron"]).exits(1).mentions("[E1601]");
}
