//! Custom passes and imported images, which an embedding program would supply: `check` and `inspect` plan them, `run` says
//! that they are missing.

use crate::testing::{Place, Vulkan};

const TITLE: &str = "images: [(name: \"screen\", format: Output, size: Output)";

fn pipeline(place: &Place, more_images: &str, buffers: &str, passes: &str) {
    let text = format!(
        "Pipeline(version: 1, {TITLE}{more_images}], buffers: [{buffers}], passes: [{passes}], outputs: [\"screen\"])"
    );
    place.file("p.ron", text);
    place.run(&["check", "p.ron", "--device", "all"]).exits(0);
}

#[test]
fn a_custom_pass_is_planned_and_not_run() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "16x16", "-o", "a.png"];
    for (passes, said) in [
        (
            "(name: \"mine\", custom: \"panel\", color: [(image: \"screen\", clear: (0.0, 0.0, 0.0, 1.0))])",
            "error: nobody records `panel`, which the custom pass `mine` asks for",
        ),
        (
            "(name: \"mine\", custom: \"panel\", writes: [\"screen\"])",
            "error: nobody records `panel`, which the custom pass `mine` asks for",
        ),
    ] {
        pipeline(&place, "", "", passes);
        let tree = place.run(&["inspect", "p.ron"]).exits(0).out;
        assert!(tree.contains("panel"), "{tree}");
        place.run_with(&variables, &run).exits(1).mentions(said);
        assert_eq!(place.names(), ["p.ron"]);
    }
}

#[test]
fn what_nobody_hands_in_is_zero_and_said() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    pipeline(
        &place,
        ", (name: \"logo\", format: R8G8B8A8_UNORM, size: Fixed(4, 4), lifetime: Imported(before: Sampled)), \
         (name: \"window\", format: Output, size: Output, lifetime: Imported(before: Undefined, after: Present))",
        "",
        "(name: \"show\", draw: FullScreen(\"copy\"), sample: {\"source\": \"logo\"}, color: [\"screen\"]), \
         (name: \"present\", draw: FullScreen(\"copy\"), sample: {\"source\": \"logo\"}, color: [\"window\"])",
    );
    let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "16x16", "-o", "a.png", "--frames", "2"];
    let err =
        place.run_with(&variables, &run).exits(0).mentions("note: nobody hands in `logo` here: all of it is 0").err;
    assert!(!err.contains("`window`"), "it is handed in without contents: {err}");
    let picture = image::open(place.path("a.png")).expect("a picture").into_rgb8();
    assert!(picture.pixels().all(|pixel| pixel.0 == [0; 3]));
}

/// DO-8: what a custom pass declares is checked at its place, for every device.
#[test]
fn declared_uses_are_checked_where_they_stand() {
    let place = Place::new();
    let declared = |uses: &str| {
        format!(
            "Pipeline(version: 1, {TITLE},\n    (name: \"mask\", format: R16G16B16A16_SFLOAT, size: Output)],\n    passes: [\n        \
             (name: \"mine\", custom: \"mask\", writes: [\"mask\"], queue: Any, uses: [\n            {uses}]),\n        \
             (name: \"show\", draw: FullScreen(\"copy\"), sample: {{\"source\": \"mask\"}}, color: [\"screen\"])],\n    \
             outputs: [\"screen\"])"
        )
    };
    let right = "(image: \"mask\", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE], layout: GENERAL)";
    place.file("p.ron", declared(right));
    place.run(&["check", "p.ron", "--device", "all"]).exits(0);
    let tree = place.run(&["inspect", "p.ron", "--verbose"]).exits(0).out;
    assert!(tree.contains("before SHADER_STORAGE_WRITE in COMPUTE_SHADER"), "{tree}");
    for (wrong, said) in [
        (right.replace("COMPUTE_SHADER", "COPY"), "SHADER_STORAGE_WRITE doesn't happen in COPY [E0721]"),
        (right.replace("GENERAL", "TRANSFER_DST_OPTIMAL"), "doesn't happen in the layout TRANSFER_DST_OPTIMAL [E0721]"),
        (right.replace("mask", "screen"), "the pass names no such part of `screen` [E0721]"),
    ] {
        place.file("p.ron", declared(&wrong));
        let err = place.run(&["check", "p.ron"]).exits(1).err;
        assert!(err.contains(said) && err.contains("p.ron:5:13"), "{err}");
    }
    place.file("p.ron", declared(&right.replace("COMPUTE_SHADER", "COMPUTE")));
    place.run(&["check", "p.ron"]).exits(1).mentions("p.ron:5:38").mentions("COMPUTE_SHADER");
}
