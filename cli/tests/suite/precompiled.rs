//! Shaders that were compiled ahead: a command that can't compile takes them, where nothing that they were made from has changed.

use crate::testing::{Outcome, Place};
use std::fs;
use std::path::PathBuf;

const PIPELINE: &str = "Pipeline(version: 1, images: [(name: \"screen\", format: Output, size: Output)],
    passes: [(name: \"fill\", draw: FullScreen(\"fill\"), color: [\"screen\"])], outputs: [\"screen\"])";

const SHADER: &str =
    "#version 460\n#include \"shade.glsl\"\nlayout(location = 0) out vec4 color;\nvoid main() { color = SHADE; }\n";

const CHECK: [&str; 5] = ["check", "p.ron", "--no-cache", "--precompiled", "spirv"];

/// A folder with a pipeline whose shader includes a file, and with its compiled shaders.
fn place() -> Place {
    let place = Place::new();
    place.file("p.ron", PIPELINE);
    place.file("fill.frag", SHADER);
    place.file("shade.glsl", "#define SHADE vec4(1.0)\n");
    place.run(&CHECK).exits(0);
    place
}

/// Runs the same where it can't start a process that compiles.
fn check_without_compiler(place: &Place) -> Outcome {
    place.run_with(&[("FRAMEWRIGHT_HELPER", "1")], &CHECK)
}

/// The files of compiled shaders, sorted.
fn compiled(place: &Place) -> Vec<PathBuf> {
    let entries = fs::read_dir(place.path("spirv")).expect("a folder");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("listed").path()).collect();
    files.sort();
    files
}

#[test]
fn shaders_that_were_compiled_ahead_need_no_compiler() {
    let place = place();
    let names = compiled(&place).iter().map(|file| file.file_name().unwrap_or_default().to_owned()).collect::<Vec<_>>();
    let beginnings = ["fill.frag.", "full_screen.vert."];
    assert!(
        names.len() == 2
            && names.iter().zip(beginnings).all(|(name, begins)| name.to_string_lossy().starts_with(begins)),
        "{names:?}"
    );
    assert_eq!(check_without_compiler(&place).exits(0).out, place.run(&CHECK).exits(0).out);
    place.run_with(&[("FRAMEWRIGHT_HELPER", "1")], &CHECK[..3]).exits(1).mentions("the helper process that compiles");
}

#[test]
fn a_text_that_changed_since_is_not_compiled_ahead_whichever_it_is() {
    let place = place();
    for (file, before, after) in [
        ("shade.glsl", "#define SHADE vec4(1.0)\n", "#define SHADE vec4(0.5)\n"),
        ("fill.frag", SHADER, &SHADER.replace("SHADE;", "SHADE * 2.0;")),
    ] {
        place.file(file, after);
        check_without_compiler(&place).exits(1).mentions("the helper process that compiles");
        place.file(file, before);
        check_without_compiler(&place).exits(0);
    }
    // What is compiled is added, and what was there stays.
    place.file("shade.glsl", "#define SHADE vec4(0.5)\n");
    place.run(&CHECK).exits(0);
    assert_eq!(compiled(&place).len(), 3);
    check_without_compiler(&place).exits(0);
}

#[test]
fn a_file_that_is_no_spirv_and_a_folder_that_is_none_are_told() {
    let place = place();
    let files = compiled(&place);
    let spirv = fs::read(&files[0]).expect("SPIR-V");
    for damaged in [&b""[..], b"no SPIR-V", &spirv[..spirv.len() - 1]] {
        fs::write(&files[0], damaged).expect("written");
        check_without_compiler(&place).exits(1).mentions("shader `fill` can't be used").mentions(" is no SPIR-V");
    }
    fs::write(&files[0], &spirv[..24]).expect("written");
    check_without_compiler(&place).exits(1).mentions("shader `fill` can't be used");
    place.run(&["check", "p.ron", "--precompiled", "p.ron"]).exits(1).mentions("the precompiled shader p.ron/");
}

#[test]
fn a_shader_with_an_array_of_images_is_compiled_ahead_as_any_is() {
    let place = place();
    place.file(
        "p.ron",
        "Pipeline(version: 1, images: [(name: \"a\", format: R8_UNORM, size: Output), \
            (name: \"b\", format: R8_UNORM, size: Output), (name: \"screen\", format: Output, size: Output)],
         passes: [(name: \"begin\", fill: (to: \"a\", value: 0)), (name: \"also\", fill: (to: \"b\", value: 1)),
            (name: \"show\", draw: FullScreen(\"taps\"), sample: {\"taps\": [\"a\", \"b\"]}, color: [\"screen\"])],
         outputs: [\"screen\"])",
    );
    let text = "#version 460\n#ifdef HAS_taps\nlayout(set = 0, binding = 0) uniform sampler2D taps[2];\n#endif\n\
        layout(location = 0) out vec4 color;\nvoid main() { color = texture(taps[1], vec2(0.5)); }\n";
    place.file("taps.frag", text);
    place.run(&CHECK).exits(0);
    check_without_compiler(&place).exits(0);
    let inspected = place.run(&["inspect", "p.ron"]).exits(0).out;
    for line in ["taps[0] = `a`, sampled, LINEAR", "taps[1] = `b`, sampled, LINEAR"] {
        assert!(inspected.contains(line), "`{line}` is not in\n{inspected}");
    }
}
