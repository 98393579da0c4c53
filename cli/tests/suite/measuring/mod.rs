//! `measure`: sweeps, their costs and errors beside a converged reference, and what is kept of them (NU-1).

mod references;

#[cfg(target_os = "linux")]
use crate::compare::grey;
#[cfg(target_os = "linux")]
use crate::testing::shell::shell;
use crate::testing::{Outcome, Place, Vulkan};
use serde_json::Value;

/// The part of the command line that all sweeps share, for the lavapipe of this machine.
fn measure(place: &Place, more: &[&str]) -> Option<Outcome> {
    let variables = Vulkan::LAVAPIPE.variables()?;
    let arguments = ["measure", "image_quality", "--scene", "spheres_and_cubes", "--size", "96x54", "--frames", "2"];
    Some(place.run_with(&variables, &[&arguments[..], more].concat()))
}

fn results(place: &Place, folder: &str) -> Value {
    let file = std::fs::read_to_string(place.path(folder).join("results.json")).expect("results");
    serde_json::from_str(&file).expect("JSON")
}

/// The figures of the row with these choices.
fn row<'r>(results: &'r Value, choice: &[(&str, &str)]) -> &'r Value {
    let rows = results["rows"].as_array().expect("rows");
    let found = rows.iter().find(|row| choice.iter().all(|(name, value)| row["choice"][name] == *value));
    &found.unwrap_or_else(|| panic!("no row {choice:?}"))["outcome"]["measured"]
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn more_samples_cost_memory_and_come_nearer_to_the_reference() {
    let place = Place::new();
    let sweeps = ["--sweep", "msaa=1,4", "--sweep", "render_scale=0.5..2:3", "-o", "swept"];
    let Some(out) = measure(&place, &sweeps) else { return };
    let table = out.exits(0).out;
    assert_eq!(table.lines().count(), 8, "{table}");
    let results = results(&place, "swept");
    assert_eq!(results["rows"].as_array().map(Vec::len), Some(6));
    let at = |msaa: &str, scale: &str| row(&results, &[("msaa", msaa), ("render_scale", scale)]);
    let flip = |row: &Value| number(&row["errors"]["flip"]["mean"]);
    for msaa in ["1", "4"] {
        let [small, whole, large] = ["0.5", "1.25", "2"].map(|scale| at(msaa, scale));
        assert!(flip(small) > flip(whole) && flip(whole) > flip(large), "{small} {whole} {large}");
        let bytes = |row: &Value| number(&row["cost"]["transient_bytes"]);
        assert!(bytes(small) < bytes(whole) && bytes(whole) < bytes(large));
        for row in [small, whole, large] {
            // The error of the reference itself is below all that it is to show, and it has one.
            let own = &row["reference_errors"];
            assert!(number(&own["flip"]["mean"]) < flip(row) && number(&own["rmse"]) > 0.0, "{row}");
            let cost = &row["cost"];
            assert!(number(&cost["gpu_milliseconds"]["median"]) > 0.0 && number(&cost["moved_bytes"]) > 0.0, "{row}");
            // Lavapipe counts them: each pixel is drawn at least once.
            assert!(number(&cost["fragment_invocations"]) >= 96.0 * 54.0, "{row}");
            let [low, median, high] = ["low", "median", "high"].map(|it| number(&cost["gpu_ratio"][it]));
            assert!(0.0 < low && low <= median && median <= high, "{row}");
            // A figure that spreads, and is that of this row: recording takes longer than nothing, and less than a second.
            let recording = number(&cost["recording_milliseconds"]["median"]);
            assert!(0.0 < recording && recording < 1000.0, "{row}");
            // Its passes take what the frame takes, or a little less: barriers are the frame's.
            let passes = row["passes"].as_array().expect("passes");
            let times = passes.iter().map(|pass| number(&pass["gpu_milliseconds"]["median"]));
            let part = times.sum::<f64>() / number(&cost["gpu_milliseconds"]["median"]);
            assert!(passes.len() >= 3 && (0.5..1.5).contains(&part), "{part} in passes: {row}");
            for file in ["picture", "reference", "heat_map"] {
                let name = row[file].as_str().expect("a file");
                assert!(place.path("swept").join(name).is_file(), "{name}");
            }
        }
    }
    assert!(flip(at("4", "1.25")) < flip(at("1", "1.25")));
}

#[test]
fn a_sweep_goes_on_where_it_stopped_and_mixes_no_two() {
    let place = Place::new();
    let first = ["--sweep", "msaa=1,4", "--reference", "none", "-o", "swept"];
    let Some(out) = measure(&place, &first) else { return };
    out.exits(0);
    let kept = results(&place, "swept");
    assert!(row(&kept, &[("msaa", "1")])["errors"].is_null());
    let again = measure(&place, &first).expect("lavapipe").exits(0);
    assert!(again.err.contains("note: 2 choices are measured already"), "{}", again.err);
    assert_eq!(results(&place, "swept"), kept);
    // Another version of the program, or of its shaders, is another sweep.
    for (field, value) in [("framewright", "0.0.1"), ("shipped_shaders", "0123456789abcdef")] {
        let mut older = kept.clone();
        older["subject"][field] = value.into();
        place.file("swept/results.json", older.to_string());
        let said = measure(&place, &first).expect("lavapipe").exits(2);
        said.mentions(&format!("`swept` holds results of another sweep: `{field}` is `{value}` there, and `"));
    }
    place.file("swept/results.json", serde_json::to_string_pretty(&kept).expect("JSON") + "\n");
    // More choices: those that are there stay.
    let more = ["--sweep", "msaa=1,2,4", "--reference", "none", "-o", "swept"];
    measure(&place, &more).expect("lavapipe").exits(0);
    let all = results(&place, "swept");
    assert_eq!(row(&all, &[("msaa", "4")]), row(&kept, &[("msaa", "4")]));
    assert_eq!(all["rows"].as_array().map(Vec::len), Some(3));
    let others = [
        &["--reference", "none", "--set", "blur=2"][..],
        &["--reference", "auto"],
        &["--reference", "none", "--stereo", "multi-pass"],
    ];
    for other in others {
        let other = [&["--sweep", "msaa=1,2,4", "-o", "swept"], other].concat();
        measure(&place, &other).expect("lavapipe").exits(2).mentions("holds results of another sweep: `");
    }
    assert_eq!(results(&place, "swept"), all);
}

/// Two that write one file would lose each other's rows.
#[test]
fn two_processes_do_not_measure_into_one_folder() {
    let place = Place::new();
    std::fs::create_dir(place.path("swept")).expect("a folder");
    let lock = std::fs::File::create(place.path("swept/results.lock")).expect("a file");
    lock.lock().expect("held");
    let sweep = ["--sweep", "msaa=1", "--reference", "none", "-o", "swept"];
    let Some(out) = measure(&place, &sweep) else { return };
    out.exits(2).mentions("another process measures into `swept`\nhelp: wait until it ends");
    assert!(!place.path("swept/results.json").exists());
    drop(lock);
    measure(&place, &sweep).expect("lavapipe").exits(0);
}

#[test]
fn shards_together_are_the_sweep() {
    let place = Place::new();
    let choices = |folder: &str| -> Vec<String> {
        let results = results(&place, folder);
        results["rows"].as_array().expect("rows").iter().map(|row| row["choice"].to_string()).collect()
    };
    let sweep = ["--sweep", "msaa=1,4", "--sweep", "blur=0,1,2", "--reference", "none", "-o"];
    let Some(out) = measure(&place, &[&sweep[..], &["all"]].concat()) else { return };
    out.exits(0);
    let mut parts = Vec::new();
    for (number, folder) in [("1/2", "one"), ("2/2", "two")] {
        measure(&place, &[&sweep[..], &[folder, "--shard", number]].concat()).expect("lavapipe").exits(0);
        parts.extend(choices(folder));
    }
    let mut all = choices("all");
    parts.sort_unstable();
    all.sort_unstable();
    assert_eq!(parts, all);
}

#[test]
fn what_is_measured_is_what_run_draws() {
    let place = Place::new();
    let measured = ["--sweep", "msaa=4", "--set", "blur=1", "--reference", "none", "-o", "swept"];
    let Some(out) = measure(&place, &measured) else { return };
    out.exits(0);
    let arguments = [
        "run",
        "image_quality",
        "--scene",
        "spheres_and_cubes",
        "--size",
        "96x54",
        "--set",
        "msaa=4",
        "--set",
        "blur=1",
        "-o",
        "run.png",
    ];
    place.run_with(&Vulkan::LAVAPIPE.variables().expect("lavapipe"), &arguments).exits(0);
    let results = results(&place, "swept");
    let picture = row(&results, &[("msaa", "4")])["picture"].as_str().expect("a picture");
    let [ours, theirs] =
        ["run.png", &format!("swept/{picture}")].map(|it| std::fs::read(place.path(it)).expect("read"));
    assert!(ours == theirs, "the pictures differ");
    // Beside itself it has no error, and its reference can be any file of its size.
    let own = ["--sweep", "msaa=4", "--set", "blur=1", "--reference", "run.png", "-o", "own"];
    measure(&place, &own).expect("lavapipe").exits(0);
    let own = self::results(&place, "own");
    assert_eq!(number(&row(&own, &[("msaa", "4")])["errors"]["rmse"]), 0.0);
    let other = ["--sweep", "@size=48x48", "--reference", "run.png", "-o", "other"];
    measure(&place, &other).expect("lavapipe").exits(1).mentions("only pictures of one size are compared");
    // It was found before anything was drawn.
    assert!(!place.path("other").exists());
    // A picture of light beyond what a display shows is compared in another way, which is said.
    let light = exr::prelude::SpecificChannels::rgb(|_| (0.5_f32, 0.5_f32, 0.5_f32));
    let light = exr::prelude::Image::from_channels((96, 54), light);
    exr::prelude::WritableImage::write(&light).to_file(place.path("light.exr")).expect("written");
    let beside = |picture: &str, folder: &str| {
        measure(&place, &["--sweep", "msaa=1", "--reference", picture, "-o", folder]).expect("lavapipe").exits(0).err
    };
    let said = beside("light.exr", "light");
    assert!(said.contains("note: FLIP is HDR-FLIP here: light.exr holds light without an upper end"), "{said}");
    // A reference without any finite pixel says nothing of a picture.
    let light = exr::prelude::SpecificChannels::rgb(|_| (f32::NAN, f32::INFINITY, f32::NAN));
    let light = exr::prelude::Image::from_channels((96, 54), light);
    exr::prelude::WritableImage::write(&light).to_file(place.path("nothing.exr")).expect("written");
    let beside_nothing = ["--sweep", "msaa=1", "--reference", "nothing.exr", "-o", "nothing"];
    let out = measure(&place, &beside_nothing).expect("lavapipe").exits(1).out;
    assert!(out.contains("failed: no pixel is finite in both"), "{out}");
    assert!(!beside("run.png", "shown").contains("HDR-FLIP"));
}

#[test]
fn a_row_that_failed_is_measured_again() {
    let place = Place::new();
    let sweep = ["--sweep", "msaa=1,4", "--reference", "none", "-o", "swept"];
    let Some(out) = measure(&place, &sweep) else { return };
    out.exits(0);
    let mut kept = results(&place, "swept");
    kept["rows"][0]["outcome"] = serde_json::json!({ "failed": "the machine was asleep" });
    place.file("swept/results.json", kept.to_string());
    let again = measure(&place, &sweep).expect("lavapipe").exits(0);
    assert!(again.err.contains("note: 1 choice is measured already"), "{}", again.err);
    let all = results(&place, "swept");
    assert_eq!(all["rows"].as_array().map(Vec::len), Some(2));
    assert!(number(&row(&all, &[("msaa", "1")])["cost"]["moved_bytes"]) > 0.0);
    assert_eq!(all["rows"][1], kept["rows"][1]);
}

#[test]
fn a_pipeline_is_another_if_its_own_shaders_or_pictures_are() {
    let place = Place::new();
    let pipeline = r#"Pipeline(
        version: 1,
        textures: [(name: "grain", file: "grain.png")],
        images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "all", draw: FullScreen("own"), color: ["screen"], sample: {"grain": "grain"})],
        outputs: ["screen"],
    )"#;
    place.file("p.ron", pipeline);
    let grain = |light: u8| {
        let path = place.path("grain.png");
        image::RgbImage::from_pixel(4, 4, image::Rgb([light; 3])).save(path).expect("written");
    };
    grain(7);
    let shader = "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"part.glsl\"\n\
        layout(set = 0, binding = 0) uniform sampler2D grain; layout(location = 0) in vec2 uv;\n\
        layout(location = 0) out vec4 color; void main() { color = texture(grain, uv) * part(); }";
    let part = "float part() {\n    return 1.0;\n}\n";
    let scene = "Scene(version: 1,\n    camera: (position: (0, 0, 10), target: (0, 0, 0), fov: 42),\n\
        materials: [(name: \"grey\", color: \"#404040\")],\n\
        objects: [Cube(name: \"cube\", material: \"grey\", position: (0, 0, 0), size: 2)])\n";
    place.file("own.frag", shader);
    place.file("part.glsl", part);
    place.file("s.ron", scene);
    place.file("other.frag", "nothing");
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let arguments = ["measure", "p.ron", "--scene", "s.ron", "--size", "8x8", "--frames", "1"];
    let measure = |folder: &str| {
        let sweep = ["--sweep", "@size=8x8", "--reference", "none", "-o", folder];
        place.run_with(&variables, &[&arguments[..], &sweep].concat())
    };
    measure("swept").exits(0);
    place.file("other.frag", "something that nothing names");
    measure("swept").exits(0);
    // PF-2: line endings of the pipeline, its shaders and the scene make no other one.
    for (name, text) in [("p.ron", pipeline), ("own.frag", shader), ("part.glsl", part), ("s.ron", scene)] {
        place.file(name, text.replace('\n', "\r\n"));
    }
    measure("swept").exits(0).mentions("note: 1 choice is measured already");
    place.file("part.glsl", "float part() { return 0.5; }");
    measure("swept").exits(2).mentions("holds results of another sweep: `pipeline_digest` is `");
    measure("again").exits(0);
    grain(9);
    measure("again").exits(2).mentions("holds results of another sweep: `pipeline_digest` is `");
}

/// Values have one form, however a row ended and however they were written.
#[test]
fn settings_that_failed_once_are_not_chosen() {
    let place = Place::new();
    let pipeline = r#"Pipeline(
        version: 1,
        settings: [(name: "scale", value: Number(default: 1.0, min: 1.0, max: 4.0))],
        presets: [(name: "reference", set: {"scale": 4.0})],
        images: [(name: "screen", format: Output, size: Output)],
        passes: [
            (name: "clear", draw: Sky, color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]),
            (name: "own", when: "scale > 1 && scene.has_transparent", custom: "mine", color: ["screen"]),
        ],
        outputs: ["screen"],
    )"#;
    place.file("p.ron", pipeline);
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let run = |sweep: &[&str]| {
        let arguments = ["measure", "p.ron", "--scene", "spheres_and_cubes", "--size", "16x8", "--frames", "1"];
        place.run_with(&variables, &[&arguments[..], sweep].concat())
    };
    let black = image::RgbImage::new(16, 8);
    black.save(place.path("black.png")).expect("written");
    // A name that would end a cell of the table.
    std::fs::copy(crate::testing::repository("examples/sweeps/one_unlit_cube.ron"), place.path("cu|be.ron"))
        .expect("copied");
    let scenes = "@scene=spheres_and_cubes,cu|be.ron";
    let sweep = ["--sweep", "scale=1.0,2.0", "--sweep", scenes, "--reference", "black.png", "-o", "swept"];
    let table = run(&sweep).exits(0).out;
    assert_eq!(table.matches("@scene=cu\\|be.ron").count(), 2, "{table}");
    let bars = |line: &str| line.replace("\\|", "").matches('|').count();
    let columns: Vec<_> = table.lines().filter(|line| line.starts_with('|')).map(bars).collect();
    assert!(columns.len() == 6 && columns.iter().all(|bars| *bars == columns[0]), "{table}");
    let all = results(&place, "swept");
    let outcomes = all["rows"].as_array().expect("rows").iter().map(|row| {
        assert_eq!(row["choice"]["scale"], row["settings"]["scale"]);
        (row["settings"]["scale"].as_str().expect("a text"), row["outcome"]["failed"].is_string())
    });
    assert_eq!(outcomes.collect::<Vec<_>>(), [("1", false), ("1", false), ("2", true), ("2", false)]);
    // The sky covers each of 16×8 pixels once. Lavapipe counts whole blocks, some of which are beside the picture.
    let fragments = number(&all["rows"][0]["outcome"]["measured"]["cost"]["fragment_invocations"]);
    assert!((128.0..=256.0).contains(&fragments), "{fragments}");
    let chosen = place.run(&["choose", "swept", "--max-ms", "10000"]).exits(0).out;
    assert!(chosen.starts_with("best: scale=1\n") && chosen.contains("left out: 1 that can't be drawn\n"), "{chosen}");
    // What is measured under another form of the same value stays.
    let again = ["--sweep", "scale=1,2", "--sweep", scenes, "--reference", "black.png", "-o", "swept"];
    let said = run(&again).exits(0).err;
    assert!(said.contains("note: 3 choices are measured already"), "{said}");
    run(&["--sweep", "scale=2,2.0", "--reference", "none", "-o", "other"])
        .exits(2)
        .mentions("`scale` is swept over `2` twice");
}

#[test]
fn bars_flicker_less_with_temporal_anti_aliasing() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let arguments = [
        "measure",
        "temporal",
        "--scene",
        "passing",
        "--size",
        "96x54",
        "--frames",
        "1",
        "--sweep",
        "taa=false,true",
        "--flicker",
        "12",
        "-o",
        "swept",
    ];
    place.run_with(&variables, &arguments).exits(0);
    let results = results(&place, "swept");
    assert_eq!(results["subject"]["flicker_frames"], 12);
    let flicker = |taa: &str, figure: &str| number(&row(&results, &[("taa", taa)])["flicker"][figure]);
    for figure in ["mean", "percentile_95"] {
        let [without, with] = ["false", "true"].map(|taa| flicker(taa, figure));
        assert!(0.0 < with && with < without, "{figure}: {with} with it, {without} without");
    }
    // Each frame has a reference of its own: what moves in it too is no flicker.
    let pictures = std::fs::read_dir(place.path("swept/pictures")).expect("a folder");
    let files = pictures.map(|file| file.expect("a file").file_name().to_string_lossy().into_owned());
    assert_eq!(files.filter(|name| name.starts_with("reference_") && name.ends_with(".exr")).count(), 12);
    assert!(flicker("false", "mean") < 0.03, "{}", flicker("false", "mean"));
    for taa in ["false", "true"] {
        let map = row(&results, &[("taa", taa)])["flicker_map"].as_str().expect("a path");
        let map = image::open(place.path("swept").join(map)).expect("a picture");
        assert_eq!((map.width(), map.height()), (96, 54));
    }
    let table = std::fs::read_to_string(place.path("swept/results.csv")).expect("a table");
    assert!(table.lines().next().expect("a head").contains(",flicker,flicker_95,flicker_worst,"), "{table}");
    let wrong = [&arguments[..arguments.len() - 1], &["other", "--reference", "none"]].concat();
    place.run_with(&variables, &wrong).exits(2).mentions("flicker is measured against references of each frame");
}

#[cfg(target_os = "linux")]
#[test]
fn a_reference_of_another_size_is_refused_before_it_is_decoded() {
    let place = Place::new();
    grey(&place, "large.png", 16384);
    // Decoded it takes more than this.
    let line = |size: &str| {
        format!(
            "ulimit -v 400000; exec \"$0\" measure image_quality --scene spheres_and_cubes --size {size} --reference large.png -o swept"
        )
    };
    let said = |size: &str| shell(&place, "sh", &["-c", &line(size), env!("CARGO_BIN_EXE_framewright")], &[]).exits(1);
    said("16x16").mentions("`large.png` is 16384×16384, and `screen` is 16×16: only pictures of one size are compared");
    said("16384x16384").mentions("it has 16384 × 16384 pixels, and at most 67108864 are compared");
    assert!(!place.path("swept").exists());
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_in_place_of_a_reference_or_of_results_are_refused_at_once() {
    let place = Place::new();
    std::fs::create_dir(place.path("swept")).expect("a folder");
    for pipe in ["pipe.png", "swept/results.json"] {
        let made = std::process::Command::new("mkfifo").arg(place.path(pipe)).status().expect("mkfifo");
        assert!(made.success());
    }
    let no_file = "can't be read: it is a pipe or a device, not a regular file";
    for file in ["/dev/zero", "pipe.png"] {
        let Some(outcome) = measure(&place, &["--reference", file, "-o", "other"]) else { return };
        outcome.exits(1).mentions(&format!("the picture `{file}` {no_file}"));
        assert!(!place.path("other").exists());
    }
    let into = measure(&place, &["--sweep", "msaa=1", "--reference", "none", "-o", "swept"]).expect("lavapipe");
    into.exits(1).mentions(&format!("the file of results `swept/results.json` {no_file}"));
}

/// A device that lacks what was chosen draws something else, which is no figure of the choice.
#[test]
fn samples_that_the_device_lacks_are_not_measured() {
    let place = Place::new();
    let Some(out) = measure(&place, &["--sweep", "msaa=2,4,8", "--reference", "none", "-o", "swept"]) else { return };
    out.exits(0);
    let results = results(&place, "swept");
    assert!(number(&row(&results, &[("msaa", "4")])["cost"]["moved_bytes"]) > 0.0);
    for (at, expected) in [(0, "`color`: 1 sample instead of 2"), (2, "`color`: 4 samples instead of 8")] {
        let why = results["rows"][at]["outcome"]["failed"].as_str().expect("an error");
        assert!(why.starts_with(expected), "{why}");
    }
    // Nothing that was asked for could be measured.
    let none = ["--sweep", "msaa=8", "--reference", "none", "-o", "none"];
    measure(&place, &none).expect("lavapipe").exits(1);
}

#[test]
fn a_choice_that_can_not_be_drawn_is_a_row() {
    let place = Place::new();
    let pipeline = r#"Pipeline(
        version: 1,
        settings: [(name: "own", value: Bool(default: false))],
        images: [(name: "screen", format: Output, size: Output)],
        passes: [
            (name: "clear", draw: Sky, color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]),
            (name: "own", when: "own", custom: "mine", color: ["screen"]),
        ],
        outputs: ["screen"],
    )"#;
    place.file("p.ron", pipeline);
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let arguments = ["measure", "p.ron", "--scene", "spheres_and_cubes", "--size", "8x8", "--frames", "1"];
    let sweep = ["--sweep", "own=false,true", "--reference", "none", "-o", "swept"];
    let out = place.run_with(&variables, &[&arguments[..], &sweep].concat()).exits(0).out;
    assert!(out.contains("failed: "), "{out}");
    let results = results(&place, "swept");
    // 8×8 texels of 4 bytes are stored, and nothing is loaded.
    assert_eq!(row(&results, &[("own", "false")])["cost"]["moved_bytes"], 256);
    assert!(results["rows"][1]["outcome"]["failed"].is_string(), "{results}");
}

#[test]
fn sweeps_that_say_nothing_are_refused_before_anything_is_drawn() {
    let place = Place::new();
    let wrong = |more: &[&str]| {
        let arguments = ["measure", "image_quality", "--scene", "spheres_and_cubes", "-o", "swept"];
        place.run(&[&arguments[..], more].concat()).exits(2)
    };
    wrong(&["--sweep", "sharpness=1,2"]).mentions("the pipeline has no setting `sharpness`; there are render_scale");
    wrong(&["--sweep", "msaa=1,2", "--sweep", "msaa=4"]).mentions("`msaa` is swept twice");
    wrong(&["--sweep", "msaa="]).mentions("expected NAME=A,B,C or NAME=LO..HI:STEPS");
    wrong(&["--sweep", "render_scale=2..1:3"]).mentions("the range goes backwards: 2 is not below 1");
    wrong(&["--sweep", "@size=0x9"]).mentions("@size: the width must be 1 to 16384 pixels");
    wrong(&["--sweep", "@stereo=three"]).mentions("@stereo: expected auto");
    wrong(&["--sweep", "@size=64x"]).mentions("@size: expected WIDTHxHEIGHT");
    let several = wrong(&["--sweep", "msaa=1,3", "--sweep", "render_scale=1,99"]);
    several.mentions("setting `msaa` doesn't allow `3`").mentions("setting `render_scale` doesn't allow `99`");
    wrong(&["--set", "msaa=3"]).mentions("setting `msaa` doesn't allow `3`");
    let arguments =
        ["measure", "image_quality", "--scene", "spheres_and_cubes", "--sweep", "@scene=none.ron", "-o", "swept"];
    place.run(&arguments).exits(1).mentions("there is no scene `none.ron`");
    place.file("file", "no folder");
    let arguments = ["measure", "image_quality", "--scene", "spheres_and_cubes", "--sweep", "msaa=1", "-o", "file"];
    place.run(&arguments).exits(3).mentions("`file` can't be written: it is a file, and a folder is wanted");
    place
        .run(&["measure", "image_quality", "--scene", "spheres_and_cubes", "--reference", "none.png", "-o", "swept"])
        .exits(1)
        .mentions("the picture `none.png` can't be read");
    wrong(&["--shard", "3/2"]).mentions("expected K/N");
    let many = ["render_scale=0.5..4:1000", "white_point=1..100:1000", "blur=0,1,2,3,4,5"];
    let many: Vec<&str> = many.iter().flat_map(|sweep| ["--sweep", sweep]).collect();
    let said = wrong(&many).err;
    assert!(
        said.contains("has 6000000 choices, and at most 10000 are measured: sweep fewer values [E1614]\n"),
        "{said}"
    );
    // Where pairs are few enough they are named.
    let many = ["render_scale=0.5..4:50", "white_point=1..100:50", "blur=0,1,2,3,4,5"];
    let many: Vec<&str> = many.iter().flat_map(|sweep| ["--sweep", sweep]).collect();
    wrong(&many)
        .mentions("has 15000 choices, and at most 10000 are measured: sweep fewer values, or combine them pairwise");
    let arguments = ["measure", "auto_exposure", "--scene", "spheres_and_cubes", "-o", "swept"];
    place.run(&arguments).exits(2).mentions("the pipeline has no preset `reference`");
    assert!(!place.path("swept").exists());
}
