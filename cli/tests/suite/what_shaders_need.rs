//! A need of a shader that a pass or a device can't meet is told at the shader's line, with what to write instead.

use crate::testing::{Outcome, Place};
use framewright_graph::device::SHIPPED_PROFILES;

/// The answer of `check` for a pipeline with one pass that runs a shader of this text before `screen` is drawn.
fn check(place: &Place, (file, text): (&str, &str), pass: &str, arguments: &[&str]) -> Outcome {
    place.file(file, text);
    place.file(
        "p.ron",
        format!(
            r#"Pipeline(version: 1,
    images: [(name: "kept", format: R8_UNORM, size: Output), (name: "screen", format: Output, size: Output)],
    passes: [
        (name: "begin", fill: (to: "kept", value: 0)),
        {pass}
        (name: "show", draw: FullScreen("copy"), sample: {{"source": "kept"}}, color: ["screen"]),
    ],
    outputs: ["screen"])"#
        ),
    );
    place.run(&[&["check", "p.ron"], arguments].concat())
}

#[test]
fn arrays_that_no_pass_can_give_are_not_supported_and_the_shaders_line_is_named() {
    let pass = r#"(name: "look", draw: FullScreen("looks"), sample: {"map": "kept"}, color: ["screen"]),"#;
    for (declared, what, instead) in [
        ("sampler2D map[2][3]", "an array of arrays", "declare one array"),
        ("Blocks { vec4 value; } map[2]", "an array of blocks", "declare one storage block that holds an array"),
    ] {
        let text = format!(
            "#version 460\nlayout(set = 0, binding = 0) uniform {declared};\n\
             layout(location = 0) out vec4 color;\nvoid main() {{ color = vec4(1.0); }}\n"
        );
        let outcome = check(&Place::new(), ("looks.frag", &text), pass, &[]).exits(1);
        assert!(outcome.err.contains(&format!("shader `looks` declares `map` as {what} (")), "{}", outcome.err);
        assert!(outcome.err.contains("looks.frag:2), which isn't supported"), "{}", outcome.err);
        assert!(outcome.err.contains(instead), "{}", outcome.err);
        assert_eq!(outcome.err.matches("error: ").count(), 1, "{}", outcome.err);
    }
}

const STORES: &str = "#version 460\nlayout(local_size_x = 8) in;\n\
    layout(set = 0, binding = 0, r8) uniform writeonly image2D target;\n\
    void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(1.0)); }\n";

const STORE: &str = r#"(name: "store", dispatch: "stores", groups: Texels("kept"), storage: {"target": "kept"}),"#;

#[test]
fn a_device_that_lists_a_format_for_storage_takes_it_and_another_is_told_which_it_has() {
    let place = Place::new();
    check(&place, ("stores.comp", STORES), STORE, &["--device", "all"]).exits(0);
    let shipped = SHIPPED_PROFILES[0].1;
    let line = shipped.lines().find(|line| line.contains("(format: R8_UNORM, usage")).expect("its line");
    let without = line.replacen("SAMPLED | STORAGE", "SAMPLED", 1);
    place.file("one.ron", shipped.replacen(line, &without, 1).replace("\"lavapipe\"", "\"mine\""));
    check(&place, ("stores.comp", STORES), STORE, &["--device", "one.ron"])
        .exits(1)
        .mentions("error: `kept` can't be R8_UNORM on `mine`: no STORAGE")
        .mentions("a shader stores it here")
        .mentions("write another `format` of `kept`: `R8_SNORM`, `R8G8_UNORM`, ");
}

#[test]
fn a_compute_shader_without_a_workgroup_size_is_refused_at_its_line() {
    let text = STORES.replacen("layout(local_size_x = 8) in;", "", 1);
    check(&Place::new(), ("stores.comp", &text), STORE, &[])
        .exits(1)
        .mentions("stores.comp:4: it doesn't say how large its workgroups are");
}
