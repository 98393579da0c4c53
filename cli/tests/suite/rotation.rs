//! `--rotate`: frames drawn turned, and pictures that are upright all the same.

use crate::testing::{Outcome, Place, Vulkan};

/// A depth that leaves the frame, and nothing for a screen.
const UNSHOWN: &str = r#"Pipeline(
    version: 1,
    images: [(name: "light", format: Color(hdr: true), size: Output)],
    passes: [(name: "sky", draw: Sky, color: [(image: "light", clear: (0.0, 0.0, 0.0, 1.0))])],
    outputs: ["light"],
)"#;

fn run(place: &Place, vulkan: Vulkan, more: &[&str]) -> Option<Outcome> {
    let arguments = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "96x54", "--validate"];
    Some(place.run_with(&vulkan.variables()?, &[&arguments[..], more].concat()))
}

/// PR-5: `-o` writes the upright picture, whatever the rotation.
#[test]
fn pictures_are_upright_whatever_the_rotation() {
    let place = Place::new();
    for degrees in ["0", "90", "180", "270"] {
        let file = format!("{degrees}.png");
        let Some(outcome) = run(&place, Vulkan::LAVAPIPE_CURRENT, &["--rotate", degrees, "-o", &file]) else { return };
        let outcome = outcome.exits(0);
        assert!(outcome.out.contains("validation: silent; "), "{}", outcome.out);
    }
    let [upright, others @ ..] = ["0", "90", "180", "270"]
        .map(|name| image::open(place.path(format!("{name}.png"))).expect("a picture").to_rgb8());
    assert_eq!(upright.dimensions(), (96, 54));
    for other in others {
        let off = |(one, other): (&u8, &u8)| one.abs_diff(*other) > 1;
        assert_eq!(other.dimensions(), (96, 54));
        assert_eq!(upright.as_raw().iter().zip(other.as_raw()).filter(|pair| off(*pair)).count(), 0);
    }
}

/// PR-1, PR-2: the Plan says what is rotated, and by how much.
#[test]
fn the_plan_says_what_is_rotated() {
    let place = Place::new();
    let inspect =
        |more: &[&str]| place.run(&[&["inspect", "forward", "--size", "96x54"][..], more].concat()).exits(0).out;
    let tree = inspect(&["--rotate", "270"]);
    assert!(tree.contains("`screen` R8G8B8A8_SRGB 54×96, 1 sample, rotated by 270°"), "{tree}");
    assert_eq!(tree.matches("rotated").count(), 1, "{tree}");
    let direct = ["--rotate", "90", "--set", "hdr=false", "--set", "tone_mapping=false"];
    assert_eq!(inspect(&direct).matches("rotated by 90°").count(), 3);
    assert_eq!(inspect(&["--rotate", "0"]), inspect(&[]));
    let json = inspect(&["--rotate", "180", "--format", "json"]);
    assert_eq!(json.matches("\"rotation\": \"ROTATE_180\"").count(), 1);
    let check = place.run(&["check", "image_quality", "--rotate", "90", "--device", "all"]).exits(0);
    assert!(check.out.contains("image_quality"), "{}", check.out);
}

#[test]
fn other_angles_and_pipelines_without_a_screen_are_refused() {
    let place = Place::new();
    for wrong in ["45", "-90", "360", "", "quarter"] {
        let said = place.run(&["check", "forward", &format!("--rotate={wrong}")]).exits(2);
        said.mentions("expected 0, 90, 180 or 270");
    }
    place.file("p.ron", UNSHOWN);
    place.run(&["check", "p.ron"]).exits(0);
    let said = place.run(&["check", "p.ron", "--rotate", "90"]).exits(1);
    let said = said.mentions("nothing can be rotated by 90°: no output is made to be shown on a screen");
    said.mentions("p.ron:5:15").mentions("say `format: Output` of `light`");
}
