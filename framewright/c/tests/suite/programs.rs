//! Programs in C draw what programs in Rust draw, and survive wrong calls (EM-12).

use crate::testing::{Program, has, has_headers, text};
use framewright_tests::render::{self, Setup, in_repository};
use std::path::{Path, PathBuf};
use std::process::Output;

const EXTENT: [u32; 2] = [320, 180];

/// A program of the repository, built; `None` where the machine can't build or draw.
pub(crate) fn program(path: &str) -> Option<Program> {
    (has_headers() && has("cc") && render::device().is_some()).then(|| Program::of(&text(path)))
}

/// The red, green and blue of a picture that a program wrote.
fn picture(path: &Path) -> Vec<u8> {
    let bytes = std::fs::read(path).expect("a picture");
    let head = format!("P6\n{} {}\n255\n", EXTENT[0], EXTENT[1]);
    bytes.strip_prefix(head.as_bytes()).expect("a PPM of that size").to_vec()
}

/// The same by the layers of the library one by one.
pub(crate) fn expected() -> Vec<u8> {
    let device = render::device().expect("it was asked for");
    let scene = framewright::load_scene("spheres_and_cubes").expect("it is shipped");
    let setup =
        Setup { pipeline: "examples/pipelines/forward.ron", set: &[("msaa", "4")], scene: &scene, extent: EXTENT };
    let texels = render::render(device, &setup).expect("drawn")[0].bytes.clone();
    texels.chunks(4).flat_map(|texel| texel[..3].to_vec()).collect()
}

fn succeeded(out: &Output) -> String {
    let (said, complained) = (String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
    assert!(out.status.success(), "{:?}: {said}{complained}", out.status);
    said.into_owned()
}

#[test]
fn a_program_in_c_draws_what_rust_draws() {
    let Some(program) = program("examples/embed_minimal.c") else { return };
    let said = succeeded(&program.run(&["picture.ppm", "validate"], &[]));
    assert!(said.starts_with("drawn by "), "{said}");
    assert!(picture(&program.path("picture.ppm")) == expected(), "another picture");
}

/// What turns the layer on for a program that doesn't, and has it look closely.
const VALIDATION: [(&str, &str); 5] = [
    ("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation"),
    ("VK_LAYER_VALIDATE_SYNC", "1"),
    ("VK_LAYER_SYNCVAL_SHADER_ACCESSES_HEURISTIC", "1"),
    ("VK_LAYER_SYNCVAL_LOAD_OP_AFTER_STORE_OP_VALIDATION", "1"),
    ("VK_LAYER_ENABLE_MESSAGE_LIMIT", "0"),
];

#[test]
fn a_program_in_c_records_into_its_own_commands_on_its_own_device() {
    let Some(program) = program("examples/embed_own_device.c") else { return };
    let said = succeeded(&program.run(&["picture.ppm"], &VALIDATION));
    // The layer would print what it finds: nothing stands beside the program's own line. 2 is COLOR_ATTACHMENT_OPTIMAL.
    assert!(said.starts_with("drawn by ") && said.ends_with(", and left in the layout 2\n"), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(picture(&program.path("picture.ppm")) == expected(), "another picture");

    // A frame is taken back, which planning would wait for.
    let text = text("examples/embed_own_device.c");
    let recording = "    check(framewright_renderer_record_into(renderer, commands, &done, NULL, 0, &frame));\n";
    let taken_back = [
        recording,
        "    check(framewright_renderer_set(renderer, \"msaa\", \"1\"));\n",
        "    check(framewright_renderer_discard(renderer, frame));\n",
        "    check(framewright_renderer_set(renderer, \"msaa\", NULL));\n",
        "    vk(vkResetCommandPool(raw, pool, 0));\n    vk(vkBeginCommandBuffer(commands, &begin));\n",
        recording,
    ];
    let discarding = text.replace(recording, &taken_back.concat());
    assert_ne!(discarding, text);
    let discarding = Program::of(&discarding);
    let said = succeeded(&discarding.run(&["picture.ppm"], &VALIDATION));
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(picture(&discarding.path("picture.ppm")) == expected(), "another picture");

    // The layer is awake: it tells that an image isn't destroyed.
    let leaky = text.replace("    vkDestroyImage(raw, image, NULL);\n", "");
    assert_ne!(leaky, text);
    let out = Program::of(&leaky).run(&["picture.ppm"], &VALIDATION);
    assert!(String::from_utf8_lossy(&out.stdout).contains("VUID-vkDestroyDevice-device"), "{out:?}");
}

/// What the sanitizer says of a program: memory that was used wrongly, and what was never freed.
fn sanitized(text: &str) -> String {
    let program = Program::with(text, &["-g", "-fsanitize=address"]);
    let out = program.run(&["picture.ppm"], &[("ASAN_OPTIONS", "detect_leaks=1")]);
    String::from_utf8_lossy(&out.stderr).into_owned()
}

/// Bytes that the driver and its libraries may leak: 112 on Debian 12, and 240 since its Mesa 22.3.6-1+deb12u2. They are unloaded by the time that the sanitizer tells, which
/// then may take what leaks for another library's.
const OF_DRIVERS: u64 = 400;

/// The bytes that a program never freed, as the sanitizer counts them.
fn leaked(said: &str) -> u64 {
    let summary = said.lines().find_map(|line| line.strip_prefix("SUMMARY: AddressSanitizer: "));
    let bytes = summary.and_then(|summary| summary.split_once(" byte(s) leaked")).map(|(bytes, _)| bytes);
    bytes.map_or(0, |bytes| bytes.parse().expect("a number"))
}

#[test]
fn programs_in_c_free_all_that_they_are_given() {
    let Some(_) = program("examples/embed_minimal.c") else { return };
    for path in ["examples/embed_minimal.c", "framewright/c/tests/programs/bad_calls.c"] {
        let said = sanitized(&text(path));
        // Where the sanitizer finds a function of Rust among the callers, it is this library that leaks.
        let is_ours = said.contains("/rustc/") || said.contains("heap-use-after-free");
        assert!(leaked(&said) <= OF_DRIVERS && !is_ours, "{path}: {said}");
    }
    for free in ["scene", "renderer", "device"] {
        let text = text("examples/embed_minimal.c");
        let leaky = text.replace(&format!("    framewright_{free}_free({free});\n"), "");
        assert_ne!(leaky, text);
        assert!(leaked(&sanitized(&leaky)) > OF_DRIVERS, "the sanitizer sees no {free} that isn't freed");
    }
}

#[test]
fn do_11_pf_8_a_program_in_c_makes_a_device_with_exactly_what_a_frame_uses() {
    let Some(program) = program("framewright/c/tests/programs/exact_device.c") else { return };
    let said = succeeded(&program.run(&[], &VALIDATION));
    // The layer would print what it finds.
    assert!(said.contains("dynamicRendering is missed\n"), "{said}");
    assert!(said.lines().all(|line| line.ends_with(" is missed")), "{said}");
}

#[test]
fn wrong_calls_have_their_status_and_their_words() {
    let Some(program) = program("framewright/c/tests/programs/bad_calls.c") else { return };
    succeeded(&program.run(&[], &[]));
}

/// Somebody else has an image between frames, in this Plan and the next (DO-11).
#[test]
fn do_11_a_program_in_c_says_who_has_an_image_between_frames() {
    let Some(program) = program("framewright/c/tests/programs/owners.c") else { return };
    let said = succeeded(&program.run(&[], &VALIDATION));
    // The layer would print what it finds.
    assert_eq!(said, "");
}

/// Passes run when the program says so, and in the frames of its numbers (DO-9).
#[test]
fn do_9_a_program_in_c_says_what_is_dirty_and_numbers_frames() {
    let Some(program) = program("framewright/c/tests/programs/frame_runs.c") else { return };
    let pipeline = in_repository("tests/pipelines/frame_runs.ron");
    succeeded(&program.run(&[pipeline.to_str().expect("a path in UTF-8")], &VALIDATION));
}

/// The command, which serves as a helper, where it was built.
fn helper() -> Option<PathBuf> {
    let command = std::env::current_exe().expect("a path").parent()?.parent()?.join("framewright");
    if !command.exists() {
        eprintln!("SKIPPED: cargo build -p framewright-cli");
    }
    command.exists().then_some(command)
}

#[cfg(unix)]
#[test]
fn a_helper_that_dies_ends_no_program_and_spoils_no_shader() {
    let Some(program) = program("framewright/c/tests/programs/dead_helper.c") else { return };
    let cache = tempfile::tempdir().expect("a folder");
    let variables = [("XDG_CACHE_HOME", cache.path().to_str().expect("a text"))];
    for useless in ["/bin/false", "/bin/true", "/nowhere"] {
        let said = succeeded(&program.run(&[useless, "useless"], &variables));
        assert!(said.contains("the helper process that compiles shaders"), "{said}");
    }
    let Some(helper) = helper() else { return };
    let said = succeeded(&program.run(&[helper.to_str().expect("a text"), "useful"], &variables));
    assert_eq!(said, "191\n");
}

#[test]
fn a_program_in_c_records_custom_passes() {
    let Some(program) = program("framewright/c/tests/programs/custom_passes.c") else { return };
    succeeded(&program.run(&[], &[]));
    let drawn = picture(&program.path("picture.ppm"));
    for (number, texel) in drawn.chunks(3).enumerate() {
        let [x, y] = [number % EXTENT[0] as usize, number / EXTENT[0] as usize];
        assert_eq!(texel, if x < 160 && y < 90 { [255, 255, 255] } else { [0, 0, 255] }, "{x}, {y}");
    }
}

/// In each way that the device knows, with draws of objects of the program's own (DO-12).
#[test]
fn do_12_a_program_in_c_records_for_both_eyes_at_once() {
    let Some(program) = program("framewright/c/tests/programs/both_eyes.c") else { return };
    let said = succeeded(&program.run(&[], &[]));
    println!("{said}");
}

/// The layer is on: it would print what it finds (DO-8).
#[test]
fn do_8_threads_of_a_program_in_c_draw_within_a_scope() {
    let Some(program) = program("framewright/c/tests/programs/threads.c") else { return };
    assert_eq!(succeeded(&program.run(&[], &VALIDATION)), "");
    let drawn = picture(&program.path("picture.ppm"));
    for (number, texel) in drawn.chunks(3).enumerate() {
        let x = number % EXTENT[0] as usize;
        // Four threads have forty columns each; the pass before them has the rest.
        let shade = [[255, 0, 0], [0, 255, 0], [255, 255, 0], [255, 255, 255]].get(x / 40);
        assert_eq!(texel, shade.unwrap_or(&[0, 0, 255]), "{x}");
    }
}

/// A lie is told with the place of the pass; what it spoilt is mended (DO-8).
#[test]
fn do_8_lies_of_a_program_in_c_are_told() {
    let Some(program) = program("framewright/c/tests/programs/lies.c") else { return };
    succeeded(&program.run(&[], &[]));
}

/// The layer is on: it would print what it finds (DO-5).
#[test]
fn a_program_in_c_binds_a_set_of_its_own() {
    let Some(program) = program("framewright/c/tests/programs/sets.c") else { return };
    assert_eq!(succeeded(&program.run(&[], &VALIDATION)), "");
}

/// Vertex buffers, indices, bind groups and push constants, in each kind of draws (DO-5). The layer is on.
#[test]
fn do_5_a_program_in_c_draws_objects_of_its_own() {
    let Some(program) = program("framewright/c/tests/programs/objects.c") else { return };
    assert_eq!(succeeded(&program.run(&[], &VALIDATION)), "");
}

#[test]
fn wrong_draws_have_their_status_and_their_words() {
    let Some(program) = program("framewright/c/tests/programs/bad_draws.c") else { return };
    assert_eq!(succeeded(&program.run(&[], &VALIDATION)), "");
}

#[test]
fn a_program_in_c_brings_shaders_along_compiled() {
    let Some(program) = program("framewright/c/tests/programs/modules.c") else { return };
    succeeded(&program.run(&[], &[]));
}

#[test]
fn changes_reach_the_scene_and_are_told_to_the_program() {
    let Some(program) = program("framewright/c/tests/programs/changes.c") else { return };
    succeeded(&program.run(&[], &[]));
}

#[test]
fn programs_are_short() {
    for example in ["embed_minimal.c", "embed_own_device.c"] {
        let text = std::fs::read_to_string(in_repository("examples").join(example)).expect("a text");
        assert!(text.lines().count() < 150, "{example} is long");
    }
}
