//! Mistakes are told in one clear message, with their place and the right exit code; nothing half-written stays behind.

use crate::testing::{FORWARD, Place, Vulkan, check, forward_with, outcome};
use std::process::Stdio;

const SCENE: &str = "spheres_and_cubes";

#[test]
fn a_missing_pipeline_is_said_with_the_names_of_shipped_ones() {
    Place::new().run(&["check", "nowhere.ron"]).exits(1).says(
        "error: there is no pipeline `nowhere.ron`, and none of that name is shipped (shipped: auto_exposure, deferred, \
         deferred_mobile, dynamic_resolution, forward, forward_overlay, image_quality, post, shadows, snow, soft_focus, \
         temporal)",
    );
    // A shipped name in a folder is a path, and nothing else.
    Place::new().run(&["check", "here/forward.ron"]).exits(1).mentions("there is no pipeline `here/forward.ron`");
}

#[test]
fn a_name_without_its_ending_finds_the_file_that_was_meant() {
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    place.run(&["check", "first"]).exits(1).mentions("help: did you mean `first.ron`?");
}

#[test]
fn a_folder_is_no_pipeline() {
    Place::new()
        .run(&["check", "."])
        .exits(1)
        .says("error: the pipeline `.` can't be read: Is a directory (os error 21)");
}

#[test]
fn an_empty_file_is_said_to_be_empty() {
    check("")
        .exits(1)
        .mentions("error: the file is empty\n --> p.ron:1:1\n")
        .mentions("a pipeline begins with `Pipeline(");
}

#[test]
fn a_binary_file_is_said_to_be_no_text() {
    check(b"Pipeline\x00\xff\xfe")
        .exits(1)
        .mentions("error: this is not a text file: byte 9 is 0xFF, which is not UTF-8\n --> p.ron:1:10\n");
}

#[test]
fn a_hundred_thousand_brackets_are_too_many() {
    let brackets = "[".repeat(100_000);
    check(format!("Pipeline(version: 1, images: {brackets}"))
        .exits(1)
        .mentions("error: brackets are nested too deeply\n--> p.ron:1:");
    check(&brackets).exits(1).mentions("error: brackets are nested too deeply\n--> p.ron:1:129\n");
}

#[test]
fn a_file_without_end_is_no_regular_file() {
    let said = "error: the pipeline `/dev/zero` can't be read: it is a pipe or a device, not a regular file";
    Place::new().run(&["check", "/dev/zero"]).exits(1).says(said);
}

#[test]
fn an_unknown_image_is_said_with_the_nearest_name() {
    check(forward_with("image: \"color\", clear", "image: \"colr\", clear"))
        .exits(1)
        .mentions("error: there is no image named `colr`\n  --> p.ron:34:29\n")
        .mentions("help: did you mean `color`?");
}

#[test]
fn an_unknown_setting_on_the_command_line_is_said_with_all_that_there_are() {
    Place::new()
        .run(&["check", "forward", "--set", "samples=4"])
        .exits(2)
        .mentions("error: there is no setting named `samples`")
        .mentions("there are `msaa`, `hdr`, `tone_mapping`, `white_point`");
}

#[test]
fn a_value_that_a_setting_does_not_allow_is_an_error() {
    Place::new()
        .run(&["check", "forward", "--set", "msaa=3"])
        .exits(2)
        .mentions("error: setting `msaa` doesn't allow `3`\n  --> forward.ron:13:16\n")
        .mentions("it is one of 1, 2, 4, 8");
}

#[test]
fn several_mistakes_are_reported_at_once_and_as_json_too() {
    let place = Place::new();
    place.file(
        "p.ron",
        forward_with("\"color\", clear", "\"colr\", clear").replace("size: Like(\"color\")", "size: Like(\"x\")"),
    );
    let people = place.run(&["check", "p.ron"]).exits(1);
    assert!(people.err.contains("`colr`") && people.err.contains("`x`"), "{}", people.err);

    let programs = place.run(&["check", "p.ron", "--format", "json"]).exits(1);
    let answer: serde_json::Value = serde_json::from_str(&programs.out).expect("JSON");
    assert_eq!(answer["fine"], false);
    let mistakes = answer["diagnostics"].as_array().expect("a list");
    assert_eq!(mistakes.len(), 2, "{mistakes:#?}");
    for mistake in mistakes {
        assert_eq!(mistake["file"], "p.ron");
        assert!(mistake["line"].as_u64() > Some(1) && mistake["column"].as_u64() > Some(1), "{mistake:#?}");
    }
}

#[test]
fn a_missing_scene_is_said() {
    Place::new().run(&["inspect", "forward", "--scene", "none.glb"]).exits(1).says(
        "note: there is no file `forward` here; this is the shipped pipeline of that name\n\
         error: there is no scene `none.glb`, and none of that name is shipped (shipped: courtyard, passing, spheres_and_cubes)",
    );
}

#[test]
fn a_truncated_glb_is_refused() {
    let place = Place::new();
    place.file("p.ron", FORWARD);
    place.file("cut.glb", b"glTF\x02\x00\x00\x00\xff\x00\x00\x00");
    place
        .run(&["inspect", "p.ron", "--scene", "cut.glb"])
        .exits(1)
        .says("error: cut.glb: the file is cut short: it has 12 bytes and says that it has 255");
}

#[test]
fn an_unknown_profile_is_a_wrong_command_line_and_a_broken_one_a_wrong_file() {
    let place = Place::new();
    place.file("p.ron", FORWARD);
    place.file("broken.ron", "Profile(name: 3)");
    place
        .run(&["check", "p.ron", "--device", "voodoo"])
        .exits(2)
        .says(
            "error: there is no device profile `voodoo`: give the file of one, or one that is shipped (lavapipe, swiftshader, \
             nvidia-rtx-2080, amd-rx-7800-xt, intel-arc-a770, mali-g78, meta-quest-3)",
        );
    place
        .run(&["check", "p.ron", "--device", "none.ron"])
        .exits(1)
        .says("error: the device profile `none.ron` can't be read: No such file or directory (os error 2)");
    place
        .run(&["check", "p.ron", "--device", "broken.ron"])
        .exits(1)
        .mentions("error: broken.ron:1:14: Expected string");
}

#[test]
fn sizes_of_nothing_and_sizes_beyond_all_devices_are_refused() {
    for (size, message) in [
        ("0x10", "the width must be 1 to 16384 pixels"),
        ("10x0", "the height must be 1 to 16384 pixels"),
        ("16385x10", "the width must be 1 to 16384 pixels"),
        ("10x4294967297", "the height must be 1 to 16384 pixels"),
        ("ten", "expected WIDTHxHEIGHT, such as 1280x720"),
    ] {
        let message = format!("error: invalid value '{size}' for '--size <WxH>': {message}");
        Place::new().run(&["inspect", "forward", "--size", size]).exits(2).mentions(&message);
    }
}

#[test]
fn a_picture_that_the_device_has_no_memory_for_is_refused_at_once() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    Place::new()
        .run_with(&variables, &["run", "forward", "--scene", SCENE, "--size", "16384x16384"])
        .exits(3)
        .mentions("error: no memory for the Plan, 15.0 GiB for `color` (8.0 GiB), ")
        .mentions(": the device has ")
        .mentions("GiB\nhelp: choose a smaller --size, fewer samples, or fewer or smaller images");
}

#[test]
fn a_wrong_command_line_exits_with_2() {
    for arguments in [&["draw"][..], &[], &["check"], &["run", "forward"], &["check", "forward", "--set", "msaa"]] {
        Place::new().run(arguments).exits(2);
    }
}

#[test]
fn help_and_version_are_answers() {
    let help = Place::new().run(&["--help"]).exits(0);
    assert!(help.out.contains("Exit codes:") && help.err.is_empty());
    assert!(Place::new().run(&["--version"]).exits(0).out.starts_with("framewright "));
}

#[test]
fn output_that_can_not_be_written_is_said_with_what_mends_it() {
    let place = Place::new();
    place.file("p.ron", FORWARD);
    place.file("file", "");
    for (target, link) in [("missing", "link"), ("no folder/plan.json", "file.json")] {
        std::os::unix::fs::symlink(target, place.path(link)).expect("a link");
    }
    for (target, message) in [
        (
            "none/plan.json",
            "`none/plan.json` can't be written: No such file or directory (os error 2)\nhelp: its folder must exist: mkdir -p none",
        ),
        (
            "file/plan.json",
            "`file/plan.json` can't be written: Not a directory (os error 20)\nhelp: choose a place in a folder",
        ),
        (
            "link/plan.json",
            "`link/plan.json` can't be written: No such file or directory (os error 2)\nhelp: its folder must exist: mkdir -p missing\n",
        ),
        ("link/in/plan.json", "help: its folder must exist: mkdir -p missing/in\n"),
        ("file.json", "help: its folder must exist: mkdir -p 'no folder'\n"),
        (".", "`.` can't be written: is a directory\nhelp: that is a folder"),
        ("/dev/full", "`/dev/full` can't be written: No space left on device (os error 28)\nhelp: make room"),
        ("/proc/plan.json", "`/proc/plan.json` can't be written: "),
    ] {
        place.run(&["inspect", "p.ron", "-o", target]).exits(3).mentions(message);
    }
    assert_eq!(place.names(), ["file", "file.json", "link", "p.ron"]);
}

#[test]
fn what_is_read_is_never_written_over_by_whatever_name() {
    let place = Place::new();
    place.file("p.ron", FORWARD);
    place.file("scene.ron", "");
    std::fs::create_dir(place.path("folder")).expect("made");
    for name in ["p.ron", "./p.ron", "folder/../p.ron"] {
        let message =
            format!("error: `{name}` is the pipeline itself, which would be lost: name another file to write");
        place.run(&["inspect", "p.ron", "-o", name]).exits(2).says(&message);
    }
    place.run(&["inspect", "p.ron", "--scene", "scene.ron", "-o", "scene.ron"]).exits(2).mentions("the scene itself");
    let report = ["run", "p.ron", "--scene", "scene.ron", "--report", "p.ron"];
    place.run(&report).exits(2).mentions("the pipeline itself");
    let twice = ["run", "p.ron", "--scene", "scene.ron", "-o", "a.png", "--dump", "color=folder/../a.png"];
    let message = "error: `folder/../a.png` would be written twice: another name leads to the same file";
    place.run(&twice).exits(2).says(message);
    assert_eq!(std::fs::read_to_string(place.path("p.ron")).expect("there"), FORWARD);
    assert_eq!(place.names(), ["folder", "p.ron", "scene.ron"]);
}

#[test]
fn a_pipe_is_opened_once_and_not_taken_for_a_missing_file() {
    let place = Place::new();
    place.file("p.ron", FORWARD);
    let answer = outcome(place.command(&["inspect", "p.ron", "-o", "/dev/stdout"]).stdout(Stdio::piped())).exits(0);
    assert!(answer.out.starts_with("Plan for lavapipe"), "{}", answer.out);
}

#[test]
fn without_a_folder_for_the_layers_manifest_the_answer_names_the_variable() {
    if !std::path::Path::new(framewright_tests::drivers::CURRENT_LAYER).exists() {
        eprintln!("skipped: chromium-common is not installed");
        return;
    }
    let place = Place::new();
    place.file("file", "");
    let file = place.path("file");
    let home = [("XDG_CACHE_HOME", file.to_str().expect("text"))];
    let run = ["run", "forward", "--scene", "spheres_and_cubes", "--validate"];
    place.run_with(&home, &run).exits(3).mentions("mend it with: XDG_CACHE_HOME naming a folder that is yours");
    assert_eq!(place.names(), ["file"]);
}

#[test]
fn a_full_disk_behind_standard_output_is_said_and_a_reader_that_went_away_is_not() {
    let place = Place::new();
    place.file("p.ron", FORWARD);
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("there");
    outcome(place.command(&["inspect", "p.ron"]).stdout(full)).exits(3).mentions("standard output can't be written");

    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    outcome(place.command(&["inspect", "p.ron", "--format", "json"]).stdout(writer)).exits(0).says("");
}

#[test]
fn control_characters_never_reach_the_terminal() {
    let place = Place::new();
    let hostile = "\u{1b}[2J\u{9b}\u{7f}\u{202e}\u{7}";
    place.file(format!("{hostile}.ron"), forward_with("\"opaque\"", &format!("\"op{hostile}\"")));
    place.file(format!("wrong{hostile}.ron"), forward_with("\"color\", clear", &format!("\"col{hostile}\", clear")));
    place.file(format!("scene{hostile}.glb"), "no scene");
    let own = format!("{hostile}.ron");
    let wrong = format!("wrong{hostile}.ron");
    let scene = format!("scene{hostile}.glb");
    for arguments in [
        &["check", &*own][..],
        &["check", &own, "--format", "json"],
        &["check", &wrong],
        &["check", &wrong, "--format", "json"],
        &["check", hostile],
        &["check", &own, "--set", hostile],
        &["check", &own, "--set", &format!("{hostile}={hostile}")],
        &["check", &own, "--device", hostile],
        &["inspect", &own],
        &["inspect", &own, "--format", "json"],
        &["inspect", "forward", "--scene", &scene],
        &["inspect", "forward", "-o", &format!("{hostile}/{hostile}")],
        &[
            "run",
            "forward",
            "--scene",
            SCENE,
            "--dump",
            &format!("{hostile}=x.png"),
            "--dump",
            &format!("{hostile}=y.png"),
        ],
        &[hostile],
    ] {
        let outcome = place.run(arguments);
        let said = format!("{}{}", outcome.out, outcome.err);
        let raw = said.chars().find(|c| (c.is_control() && *c != '\n') || *c == '\u{202e}');
        assert_eq!(raw, None, "{arguments:?} said {said:?}");
        assert!(!said.is_empty(), "{arguments:?}");
    }
}

#[test]
fn without_a_driver_the_answer_names_the_package() {
    let none = [("VK_DRIVER_FILES", "/nonexistent.json"), ("VK_ICD_FILENAMES", "/nonexistent.json")];
    let place = Place::new();
    for arguments in [&["devices"][..], &["run", "forward", "--scene", SCENE, "-o", "x.png"]] {
        place
            .run_with(&none, arguments)
            .exits(3)
            .mentions("error: no Vulkan driver with a device")
            .mentions("mesa-vulkan-drivers");
    }
    assert_eq!(place.names(), [""; 0]);
}

#[test]
fn without_the_layer_a_validated_run_ends_and_names_the_package() {
    let Some(mut variables) = Vulkan::LAVAPIPE.variables() else { return };
    variables.push(("VK_LAYER_PATH", "/nonexistent"));
    Place::new()
        .run_with(&variables, &["run", "forward", "--scene", SCENE, "--validate"])
        .exits(3)
        .mentions("error: no layer VK_LAYER_KHRONOS_validation")
        .mentions("vulkan-validationlayers");
}

#[test]
fn an_unknown_device_is_said_with_those_that_there_are_and_a_profile_can_not_draw() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let run = |device| place.run_with(&variables, &["run", "forward", "--scene", SCENE, "--device", device]);
    run("voodoo").exits(3).mentions("error: no device named voodoo").mentions("llvmpipe");
    run("7").exits(3).mentions("error: no device number 7");
    run("mine.ron").exits(2).mentions("`mine.ron` is a device profile, and a device is needed here");
}

#[test]
fn a_dump_of_an_image_that_is_not_there_is_an_error_and_nothing_is_written() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let arguments = ["run", "forward", "--scene", SCENE, "--size", "32x18", "-o", "a.png", "--dump", "dept=b.png"];
    place.run_with(&variables, &arguments).exits(2).mentions("`dept`").mentions("`depth`");
    assert_eq!(place.names(), [""; 0]);
}

/// Where the device filters depth it may be; a `D16_UNORM` that isn't filtered becomes no larger format that isn't either.
#[test]
fn depth_that_the_device_does_not_filter_is_refused_with_its_place() {
    let depth = |format: &str, sampled: &str| {
        format!(
            r#"Pipeline(
    version: 1,
    images: [(name: "depth", format: {format}, size: Output), (name: "screen", format: Output, size: Output)],
    passes: [
        (name: "opaque", draw: Objects(Opaque), shader: "lit",
            color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
        (name: "show", draw: FullScreen("downsample"),
            sample: {{"source": {sampled}}}, color: ["screen"]),
    ],
    outputs: ["screen"],
)
"#
        )
    };
    let place = Place::new();
    for format in ["Depth", "D16_UNORM"] {
        place.file("p.ron", depth(format, r#"(image: "depth", filter: Linear)"#));
        place
            .run(&["check", "p.ron"])
            .exits(1)
            .mentions("error: `show` can't filter `depth`: `lavapipe` can't do that with D")
            .mentions(" --> p.ron:8:40\n")
            .mentions("write `(image: \"depth\", filter: Nearest)`, or choose another format");
        place.run(&["check", "p.ron", "--device", "swiftshader"]).exits(0);
    }
    // Without a word it isn't filtered.
    place.file("p.ron", depth("Depth", r#""depth""#));
    place.run(&["check", "p.ron"]).exits(0);
}

#[cfg(unix)]
#[test]
fn a_pipe_in_place_of_a_file_is_refused_at_once_whatever_the_file_is() {
    let place = Place::new();
    for pipe in ["pipe.ron", "pipe.json", "pipe.gltf", "pipe.png", "pipe.frag", "swept/results.json"] {
        std::fs::create_dir_all(place.path("swept")).expect("a folder");
        let made = std::process::Command::new("mkfifo").arg(place.path(pipe)).status().expect("mkfifo");
        assert!(made.success());
    }
    place.file("plain.ron", FORWARD);
    let of = |rest: &str| format!("Pipeline(version: 1, {rest})");
    place.file("includes.ron", of("include: [\"pipe.ron\"], images: [], passes: [], outputs: []"));
    place.file("extends.ron", of("extends: \"pipe.ron\""));
    let drawn = "images: [(name: \"o\", format: R8G8B8A8_UNORM, size: Output)], outputs: [\"o\"]";
    let pass = |shader: &str| format!("passes: [(name: \"p\", draw: FullScreen(\"{shader}\"), color: [\"o\"])]");
    place.file("shader.ron", of(&format!("{drawn}, {}", pass("pipe"))));
    let textures = "textures: [(name: \"t\", file: \"pipe.png\")]";
    place.file("texture.ron", of(&format!("{drawn}, {textures}, {}", pass("plain"))));
    let commands: [&[&str]; 15] = [
        &["check", "pipe.ron"],
        &["check", "plain.ron", "--settings", "pipe.ron"],
        &["check", "plain.ron", "--extend", "pipe.ron"],
        &["check", "plain.ron", "--budget", "pipe.ron"],
        &["check", "plain.ron", "--device", "pipe.ron"],
        &["check", "plain.ron", "--interface", "pipe.ron"],
        &["check", "includes.ron"],
        &["check", "extends.ron"],
        &["check", "shader.ron"],
        &["check", "texture.ron"],
        &["inspect", "plain.ron", "--scene", "pipe.gltf"],
        &["facts", "pipe.ron"],
        &["diff", "plain.ron", "pipe.json"],
        &["choose", "swept", "--max-ms", "5"],
        &["schema", "pipe.ron"],
    ];
    for command in commands {
        place.run(command).exits(1).mentions("regular file");
    }
}

#[test]
fn a_byte_order_mark_is_taken_in_every_text_and_utf_16_is_told() {
    let place = Place::new();
    let marked = |name: &str, text: &str| place.file(name, format!("\u{feff}{text}"));
    marked("marked.ron", FORWARD);
    marked("settings.ron", "Settings(version: 1, set: {\"msaa\": 1})");
    marked("budget.ron", "Budget(version: 1, limits: [(resolves: 3)])");
    marked("extension.ron", "Extension(version: 1, about: \"nothing\", changes: [])");
    marked("scene.ron", include_str!("../../../examples/scenes/spheres_and_cubes.ron"));
    place.run(&["check", "marked.ron"]).exits(0);
    place.run(&["check", "marked.ron", "--settings", "settings.ron", "--extend", "extension.ron"]).exits(0);
    place.run(&["check", "marked.ron", "--budget", "budget.ron"]).exits(0);
    place.run(&["facts", "scene.ron"]).exits(0);
    let wide = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    for text in [FORWARD.to_owned(), format!("\u{feff}{FORWARD}")] {
        place.file("wide.ron", wide(&text));
        for command in [
            &["check", "wide.ron"][..],
            &["check", "forward", "--settings", "wide.ron"],
            &["check", "forward", "--budget", "wide.ron"],
            &["check", "forward", "--device", "wide.ron"],
            &["check", "forward", "--extend", "wide.ron"],
            &["facts", "wide.ron"],
        ] {
            place.run(command).exits(1).mentions("it is UTF-16: save it as UTF-8");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn too_many_open_files_are_no_mistake_of_a_file() {
    let place = Place::new();
    place.file("mine.frag", "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(0.5); }\n");
    place.file(
        "mine.ron",
        "Pipeline(version: 1, images: [(name: \"o\", format: R8G8B8A8_UNORM, size: Output)],\n\
            passes: [(name: \"p\", draw: FullScreen(\"mine\"), color: [\"o\"])], outputs: [\"o\"])",
    );
    let mut codes = Vec::new();
    for most in 4..12 {
        let line = format!("ulimit -n {most}; exec \"$0\" check mine.ron --no-cache");
        let mut shell = std::process::Command::new("sh");
        let outcome = outcome(shell.args(["-c", &line, env!("CARGO_BIN_EXE_framewright")]).current_dir(place.path("")));
        assert!(matches!(outcome.code, Some(0 | 3)), "{most}: {:?} {}", outcome.code, outcome.err);
        codes.push(outcome.code);
    }
    assert_eq!((codes.first(), codes.last()), (Some(&Some(3)), Some(&Some(0))), "{codes:?}");
}
