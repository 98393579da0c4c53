//! Shaders that were compiled ahead: a command that can't compile takes them, where nothing that they were made from has changed.

use crate::testing::{Outcome, Place, Vulkan};
use framewright_tests::sweep;
use std::collections::BTreeSet;
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
    place.run_with(&[("FRAMEWRIGHT_HELPER", "1")], &CHECK[..3]).exits(3).mentions("the helper process that compiles");
}

#[test]
fn a_text_that_changed_since_is_not_compiled_ahead_whichever_it_is() {
    let place = place();
    for (file, before, after) in [
        ("shade.glsl", "#define SHADE vec4(1.0)\n", "#define SHADE vec4(0.5)\n"),
        ("fill.frag", SHADER, &SHADER.replace("SHADE;", "SHADE * 2.0;")),
    ] {
        place.file(file, after);
        check_without_compiler(&place).exits(3).mentions("the helper process that compiles");
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

/// A pipeline that resolves, reads locally, samples in part, and draws depth again.
const WAYS: &str = "Pipeline(version: 1,
    settings: [(name: \"scale\", value: Number(default: 0.5, min: 0.1, max: 1.0))],
    images: [
        (name: \"color\", format: R16G16B16A16_SFLOAT, size: Dynamic(by: \"scale\", up_to: 1.0), samples: 4, per_eye: true),
        (name: \"depth\", format: Depth, size: Like(\"color\"), samples: 4),
        (name: \"seen\", format: Like(\"color\"), size: Like(\"color\")),
        (name: \"screen\", format: Output, size: Output, per_eye: true),
    ],
    passes: [
        (name: \"objects\", draw: Objects(Opaque), shader: \"object\",
            color: [(image: \"color\", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: \"depth\", clear: 0.0)),
        (name: \"see\", draw: FullScreen(\"see\"), sample: {\"depth\": \"depth\"}, color: [\"seen\"]),
        (name: \"mix\", draw: FullScreen(\"mix\"), sample: {\"one\": \"color\", \"other\": \"seen\"}, color: [\"screen\"]),
    ],
    outputs: [\"screen\"])";

/// Its shaders.
const OF_WAYS: [(&str, &str); 3] = [
    (
        "object.frag",
        "layout(location = 0) out vec4 color;\nvoid main() { if (gl_FrontFacing) { discard; } color = vec4(1.0); }\n",
    ),
    (
        "see.frag",
        "#include \"include/texture.glsl\"\nlayout(set = 0, binding = 0) uniform sampler2D depth;\n\
         layout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 color;\n\
         void main() { color = vec4(found_in(depth, depth_st, uv).r); }\n",
    ),
    (
        "mix.frag",
        "#include \"include/texture.glsl\"\nlayout(set = 0, binding = 0) uniform sampler2D one;\n\
         layout(set = 0, binding = 1) uniform sampler2D other;\nlayout(location = 0) in vec2 uv;\n\
         layout(location = 0) out vec4 color;\n\
         void main() { color = found_in(one, one_st, uv) + found_in(other, other_st, uv); }\n",
    ),
];

/// That pipeline, one of whose shaders doesn't compile where `broken` is defined.
fn ways(file: &str, broken: &str) -> Place {
    let place = Place::new();
    place.file("p.ron", WAYS);
    for (name, text) in OF_WAYS {
        let mistake = format!("#ifdef {broken}\n#error broken so\n#endif\n");
        let mistake = if name == file { &*mistake } else { "" };
        place.file(name, format!("#version 460\n#extension GL_GOOGLE_include_directive : require\n{mistake}{text}"));
    }
    place
}

#[test]
fn a_shader_that_does_not_compile_as_its_pass_is_drawn_is_found_by_check() {
    for (file, broken, device, stereo) in [
        ("object.frag", "FRAMEWRIGHT_BOTH_EYES", "lavapipe", "instanced"),
        ("object.frag", "FRAMEWRIGHT_BOTH_EYES", "lavapipe", "double-wide"),
        ("object.frag", "FRAMEWRIGHT_BOTH_EYES", "nvidia-rtx-2080", "multiview"),
        ("mix.frag", "FRAMEWRIGHT_HALVES", "swiftshader", "instanced"),
        ("mix.frag", "FRAMEWRIGHT_HALVES", "lavapipe", "double-wide"),
        ("object.frag", "DEPTH_ONLY", "lavapipe", "off"),
        ("mix.frag", "FRAMEWRIGHT_PARTS", "lavapipe", "off"),
    ] {
        let place = ways(file, broken);
        let check = |more: &[&str]| {
            place.run(&[&["check", "p.ron", "--no-cache", "--stereo", stereo, "--device", device][..], more].concat())
        };
        let name = file.trim_end_matches(".frag");
        for more in [&[][..], &["--all-variants"]] {
            let found = check(more).exits(1);
            let said = format!("{}{}", found.out, found.err);
            assert!(
                said.contains(&format!("`{name}`")) && said.contains("doesn't compile"),
                "{broken}, {stereo}: {said}"
            );
            assert!(said.contains("p.ron:") && said.contains("broken so"), "{broken}, {stereo}: {said}");
        }
        // Drawn otherwise it is fine, but for what is drawn so in every mode.
        if stereo != "off" {
            place.run(&["check", "p.ron", "--no-cache", "--stereo", "multi-pass", "--device", device]).exits(0);
        }
    }
    ways("", "").run(&["check", "p.ron", "--stereo", "instanced", "--all-variants"]).exits(0);
}

#[test]
fn a_shader_that_reads_more_than_its_pass_gives_as_it_is_drawn_is_found_by_check() {
    let place = ways("", "");
    let more = "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"include/texture.glsl\"\n\
        layout(set = 0, binding = 0) uniform sampler2D depth;\nlayout(location = 0) in vec2 uv;\n\
        layout(location = 0) out vec4 color;\n#ifdef FRAMEWRIGHT_BOTH_EYES\n\
        layout(set = 0, binding = 1) uniform sampler2D more;\n#endif\nvoid main() {\n\
        color = vec4(found_in(depth, depth_st, uv).r);\n#ifdef FRAMEWRIGHT_BOTH_EYES\n\
        color += texture(more, uv);\n#endif\n}\n";
    place.file("see.frag", more);
    let check = |stereo| place.run(&["check", "p.ron", "--no-cache", "--stereo", stereo]);
    check("off").exits(0);
    let said = check("instanced").exits(1).err;
    assert!(said.contains("shader `see` can't be used: it declares `more`, which pass `see` doesn't give"), "{said}");
    assert!(said.contains("p.ron:12") && said.contains("for both eyes at once (`instanced`)"), "{said}");
}

/// In each way to draw for two eyes that this driver has; the profile is that of the device that is drawn on.
#[test]
fn what_drawing_compiles_is_compiled_ahead_by_check() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let pipelines: [(&str, &[&str]); 6] = [
        ("forward", &[]),
        (
            "image_quality",
            &["--set", "depth_stripes=blended", "--set", "depth_resolve=Min", "--set", "alpha_to_coverage=true"],
        ),
        ("dynamic_resolution", &[]),
        ("deferred", &["--set", "overlay=true"]),
        ("snow", &[]),
        ("p.ron", &[]),
    ];
    let modes = ["off", "multi-pass", "double-wide", "instanced"];
    let cases = pipelines.into_iter().flat_map(|pipeline| modes.map(|stereo| (pipeline, stereo)));
    for ((pipeline, more), stereo) in sweep::of("ways to draw", cases.collect(), 6) {
        let place = ways("", "");
        let of = [&[pipeline, "--stereo", stereo, "--size", "64x36", "--precompiled", "spirv"][..], more].concat();
        place.run_with(&variables, &["devices", "--save", "live.ron", "--device", "lavapipe"]).exits(0);
        place.run(&[&["check", "--device", "live.ron"][..], &of].concat()).exits(0);
        let ahead: BTreeSet<PathBuf> = compiled(&place).into_iter().collect();
        let drawn = [&["run", "--scene", "spheres_and_cubes", "-o", "x.png"][..], &of].concat();
        place.run_with(&variables, &drawn).exits(0);
        let more: Vec<_> = compiled(&place).into_iter().filter(|file| !ahead.contains(file)).collect();
        assert!(more.is_empty(), "{pipeline}, {stereo}: {more:?} were compiled beside {} ahead", ahead.len());
    }
}

/// PF-2: the same names for the same texts, whatever ends their lines; what is included counts as well.
#[test]
fn line_endings_change_no_compiled_shaders() {
    let place = place();
    let before = compiled(&place);
    for (file, text) in [("p.ron", PIPELINE), ("fill.frag", SHADER), ("shade.glsl", "#define SHADE vec4(1.0)\n")] {
        place.file(file, text.replace('\n', "\r\n"));
    }
    check_without_compiler(&place).exits(0);
    place.run(&CHECK).exits(0);
    assert_eq!(compiled(&place), before);
}

/// A file may hold another stage than its name says.
#[test]
fn a_module_of_another_stage_is_refused_by_check() {
    let place = place();
    let files = compiled(&place);
    let [fragment, vertex] = &files[..] else { panic!("{files:?}") };
    let [of_fragment, of_vertex] = [fragment, vertex].map(|file| fs::read(file).expect("SPIR-V"));
    for (file, module, right, stage) in
        [(vertex, &of_fragment, &of_vertex, "vertex"), (fragment, &of_vertex, &of_fragment, "fragment")]
    {
        fs::write(file, module).expect("written");
        place.run(&CHECK).exits(1).mentions(&format!("has no entry point `main` of a {stage} stage"));
        fs::write(file, right).expect("written");
    }
    place.run(&CHECK).exits(0);
}
