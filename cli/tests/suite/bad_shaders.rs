//! Shaders that are missing, don't compile, or don't fit their pass: said once, with the place in the pipeline.

use crate::testing::{self, FORWARD, Place, check, forward_with};

#[test]
fn a_shader_that_is_missing_is_reported_once_however_many_passes_use_it() {
    let place = Place::new();
    place.file("p.ron", FORWARD.replace("shader: \"lit\"", "shader: \"litt\""));
    let outcome = place.run(&["check", "p.ron"]).exits(1).mentions("did you mean `lit`?");
    assert_eq!(outcome.err.matches("error: ").count(), 1, "{}", outcome.err);
}

#[test]
fn a_missing_shader_is_said_with_those_that_there_are() {
    check(forward_with("shader: \"lit\"", "shader: \"lid\""))
        .exits(1)
        .mentions("error: there is no shader named `lid`\n  --> p.ron:33:57\n")
        .mentions("did you mean `lit`?")
        .mentions("looked for in ., the shipped shaders");
}

#[test]
fn a_shader_that_does_not_compile_is_said_with_its_own_line() {
    let place = Place::new();
    place.file("p.ron", forward_with("shader: \"lit\"", "shader: \"mine\""));
    place.file("mine.frag", "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = radiance; }\n");
    place
        .run(&["check", "p.ron"])
        .exits(1)
        .mentions("error: shader `mine` doesn't compile\n  --> p.ron:33:57\n")
        .mentions("  ::: ./mine.frag:3:23\n")
        .mentions(" 3 | void main() { color = radiance; }\n")
        .mentions("   |                       ^^^^^^^^ 'radiance' : undeclared identifier\n");
}

#[test]
fn a_mistake_in_a_file_that_a_shader_includes_is_shown_in_that_file_s_line() {
    let place = Place::new();
    place.file("p.ron", forward_with("shader: \"lit\"", "shader: \"mine\""));
    place.file("mine.frag", "#version 450\n#include \"light.glsl\"\nlayout(location = 0) out vec4 color;\nvoid main() { color = light(); }\n");
    place.file("light.glsl", "vec4 light() {\n    return vec4(\u{1b}radiance);\n}\n");
    let outcome = place.run(&["check", "p.ron"]).exits(1).mentions("  ::: ./light.glsl:2:");
    assert!(!outcome.err.contains('\u{1b}'), "{}", outcome.err);
    let json = place.run(&["check", "p.ron", "--format", "json"]).exits(1).out;
    let answer: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let label = &answer["diagnostics"][0]["labels"][1];
    assert_eq!((&label["file"], &label["line"]), (&"./light.glsl".into(), &2.into()), "{answer:#}");
}

#[test]
fn a_shader_that_does_not_match_its_pass_is_said_at_the_pass() {
    check(forward_with("sample: {\"source\"", "sample: {\"sauce\""))
        .exits(1)
        .mentions("error: ")
        .mentions("`sauce`")
        .mentions("--> p.ron:55:");
}

/// A full-screen pass that reads its own pixel of what another one drew.
const OWN_PIXEL: &str = "Pipeline(version: 1, images: [\n\
    (name: \"sky\", format: Color(hdr: false), size: Output, samples: 1),\n\
    (name: \"screen\", format: Output, size: Output)], passes: [\n\
    (name: \"sky\", draw: Sky, color: [(image: \"sky\", clear: (0.0, 0.0, 0.0, 1.0))]),\n\
    (name: \"show\", draw: FullScreen(\"show\"), sample: {\"source\": (image: \"sky\", own_pixel: true)}, \
    color: [\"screen\"])], outputs: [\"screen\"])";

const PLAIN: &str = "layout(set = 0, binding = 0) uniform sampler2D source;\n\
    #define HERE texelFetch(source, ivec2(gl_FragCoord.xy), 0)\n";

const LOCAL: &str = "layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput source;\n\
    #define HERE subpassLoad(source)\n";

fn check_own_pixel(declarations: &str) -> testing::Outcome {
    let place = Place::new();
    place.file("p.ron", OWN_PIXEL);
    let main = "layout(location = 0) out vec4 color;\nvoid main() { color = HERE; }\n";
    place.file("show.frag", format!("#version 460\n{declarations}{main}"));
    place.run(&["check", "p.ron"])
}

#[test]
fn a_shader_that_cannot_read_its_own_pixel_from_its_scope_is_said_with_its_place() {
    check_own_pixel(PLAIN)
        .exits(1)
        .mentions("error: `source` is read at the fragment's own position, but shader `show` can't read it as an input")
        .mentions(" --> p.ron:5:")
        .mentions("help: declare it `subpassInput` where `LOCAL_READ_source` is defined");
    check_own_pixel(&format!("#ifdef LOCAL_READ_source\n{LOCAL}#else\n{PLAIN}#endif\n")).exits(0);
    check_own_pixel(&format!("#ifdef LOCAL_READ_source\nnonsense\n#else\n{PLAIN}#endif\n"))
        .exits(1)
        .mentions("error: shader `show` doesn't compile")
        .mentions(" --> p.ron:5:");
}
