//! Ctrl-C ends a command soon, whatever it waits for, with 130, and leaves nothing half-written.
#![cfg(unix)]

use crate::testing::{Outcome, Place, Vulkan};
use nix::sys::signal::{Signal, kill};
use nix::unistd::{Pid, mkfifo};
use std::io::{BufRead, BufReader};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// It keeps a device at work: SwiftShader for ever, lavapipe for 65,535 rounds of each pixel.
const BUSY: &str = "#version 460
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    float a = uv.x;
    while (a < 2.0) a = fract(sin(a * 1.37 + 0.1));
    color = vec4(a);
}";

const PIPELINE: &str = r#"Pipeline(
    version: 1,
    images: [(name: "screen", format: Output, size: Output)],
    passes: [(name: "all", draw: FullScreen("busy"), color: ["screen"])],
    outputs: ["screen"],
)"#;

/// How long a command may take to end.
const SOON: Duration = Duration::from_secs(5);
/// After this time, whatever else the machine does, what is waited for will never come.
const STUCK: Duration = Duration::from_secs(300);

fn start(place: &Place, variables: &[(&str, &str)], words: &[&str]) -> Child {
    let mut command = place.command(words);
    command.envs(variables.iter().copied()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the command starts")
}

/// Waits until a command watches for Ctrl-C.
fn watches(child: &Child) {
    let status = format!("/proc/{}/status", child.id());
    let caught = || {
        let status = std::fs::read_to_string(&status).expect("it runs");
        let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).expect("a mask");
        u64::from_str_radix(mask.trim(), 16).expect("a number") & (1 << (Signal::SIGINT as u64 - 1)) != 0
    };
    until(caught, "it watches for Ctrl-C");
}

/// Waits until a command says `text`.
fn says(child: &mut Child, text: &str) {
    let err = child.stderr.take().expect("piped");
    let mut lines = BufReader::new(err);
    let mut line = String::new();
    while !line.contains(text) {
        line.clear();
        assert!(lines.read_line(&mut line).expect("read") > 0, "it ended without `{text}`");
    }
    child.stderr = Some(lines.into_inner());
}

fn until(mut holds: impl FnMut() -> bool, what: &str) {
    let begun = Instant::now();
    while !holds() {
        assert!(begun.elapsed() < STUCK, "after {STUCK:?} it does not hold that {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Presses Ctrl-C once, and waits for the command's end.
#[track_caller]
fn interrupted(child: Child) -> Outcome {
    ended_by(Signal::SIGINT, child)
}

/// Sends a signal, and waits for the command's end.
#[track_caller]
fn ended_by(signal: Signal, mut child: Child) -> Outcome {
    let begun = Instant::now();
    kill(Pid::from_raw(child.id().try_into().expect("an id")), signal).expect("it runs");
    while child.try_wait().expect("waited for").is_none() {
        if begun.elapsed() > SOON {
            child.kill().expect("it runs");
            panic!("after {SOON:?} it had not ended");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let output = child.wait_with_output().expect("it ended");
    Outcome {
        code: output.status.code(),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

#[test]
fn ctrl_c_ends_the_wait_for_a_device_that_is_at_work() {
    for driver in [Vulkan::LAVAPIPE, Vulkan::SWIFTSHADER] {
        let Some(variables) = driver.variables() else { continue };
        let place = Place::new();
        place.file("p.ron", PIPELINE);
        place.file("busy.frag", BUSY);
        let words =
            ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "1024x1024", "-o", "a.png", "--report", "a"];
        let child = start(&place, &variables, &words);
        watches(&child);
        // Time to compile and to begin the frame.
        std::thread::sleep(Duration::from_secs(3));
        interrupted(child).exits(130).mentions("error: interrupted after 0 of 1 frames: nothing was written");
        assert_eq!(place.names(), ["busy.frag", "p.ron"]);
    }
}

#[test]
fn ctrl_c_ends_the_compilation_of_an_endless_shader() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    place.file("p.ron", PIPELINE);
    // Macros of which each stands for the one before it twice.
    let macros: String = (1..=30).map(|level| format!("#define A{level} A{0} A{0}\n", level - 1)).collect();
    let shader = BUSY.replace("void main() {", &format!("#define A0\n{macros}void main() {{ A30"));
    place.file("busy.frag", shader);
    let limits = ["--shader-seconds", "600", "--shader-memory", "4096"];
    let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "-o", "a.png"];
    let child = start(&place, &variables, &[&run[..], &limits].concat());
    watches(&child);
    // Time to test the device and to begin the shader.
    std::thread::sleep(Duration::from_secs(4));
    interrupted(child).exits(130).mentions("error: interrupted after 0 of 1 frames: nothing was written");
    assert_eq!(place.names(), ["busy.frag", "p.ron"]);

    let child = start(&place, &variables, &[&["check", "p.ron", "--all-variants"][..], &limits].concat());
    watches(&child);
    std::thread::sleep(Duration::from_secs(1));
    let outcome = interrupted(child).exits(130);
    assert!(!(outcome.out.clone() + &outcome.err).contains("cancelled"), "{} {}", outcome.out, outcome.err);
}

#[test]
fn ctrl_c_ends_the_wait_for_the_reader_of_a_pipe() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let pipe = place.path("pipe.exr");
    mkfifo(&pipe, nix::sys::stat::Mode::S_IRWXU).expect("a pipe");
    let words = ["run", "forward", "--scene", "spheres_and_cubes", "--size", "200x200", "--dump", "color=pipe.exr"];
    // Nothing reads.
    let mut child = start(&place, &variables, &words);
    says(&mut child, "note: waiting until something reads the pipe `pipe.exr`");
    interrupted(child).exits(130).mentions("error: interrupted before all of `pipe.exr` was written");
    // The reader of the pipe reads only a part.
    let mut child = start(&place, &variables, &words);
    says(&mut child, "note: waiting");
    let reader = std::fs::File::open(&pipe).expect("opened");
    std::thread::sleep(Duration::from_millis(500));
    interrupted(child).exits(130).mentions("interrupted before all of `pipe.exr` was written");
    drop(reader);
    // All of it arrives where it is read.
    let child = start(&place, &variables, &words);
    let read = std::fs::read(&pipe).expect("read");
    assert_eq!(child.wait_with_output().expect("it ends").status.code(), Some(0));
    place.run_with(&variables, &[&words[..6], &["--dump", "color=file.exr"]].concat()).exits(0);
    assert!(read.len() > 1 << 16 && read == std::fs::read(place.path("file.exr")).expect("read"));
    // A command that watches for no signal is ended by the system. (By SIGTERM here: a shell that has started the tests in the
    // background has them ignore SIGINT.)
    let mut child = start(&place, &variables, &["inspect", "forward", "-o", "pipe.exr"]);
    says(&mut child, "note: waiting");
    assert_eq!(ended_by(Signal::SIGTERM, child).code, None);
}

#[test]
fn ctrl_c_ends_a_sweep_and_keeps_what_is_measured() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let words = ["measure", "image_quality", "--scene", "spheres_and_cubes", "--size", "96x54"];
    let rows = |folder: &str| {
        let text = std::fs::read_to_string(place.path(folder).join("results.json")).expect("read");
        let results: serde_json::Value = serde_json::from_str(&text).expect("whole");
        results["rows"].as_array().map_or(0, Vec::len)
    };
    let sweep = ["--sweep", "white_point=1..100:24", "--frames", "12", "--reference", "none", "-o", "swept"];
    let child = start(&place, &variables, &[&words[..], &sweep].concat());
    until(|| place.path("swept/results.json").exists(), "some are measured");
    interrupted(child).exits(130).mentions("those are kept, and the same command goes on with the others");
    assert!((8..24).contains(&rows("swept")), "{} rows", rows("swept"));
    // Within the first batch, whose choices were all drawn: those that were held against their references already are kept.
    let sweep = ["--sweep", "white_point=1..100:8", "--frames", "1", "--flicker", "30", "-o", "held"];
    let child = start(&place, &variables, &[&words[..], &sweep].concat());
    let maps = || std::fs::read_dir(place.path("held/heat_maps")).is_ok_and(|files| files.count() > 2);
    // Those of the first, and one of the second, whose flicker takes long.
    until(maps, "the second is held against its reference");
    let said = interrupted(child).exits(130).err;
    let kept = rows("held");
    assert!((1..8).contains(&kept) && said.contains(&format!("interrupted after {kept} of 8 choices")), "{said}");
}

#[test]
fn ctrl_c_ends_the_drawing_of_references_and_keeps_those_that_are_drawn() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let words = ["measure", "image_quality", "--scene", "spheres_and_cubes", "--size", "96x54", "--frames", "1"];
    let sweep = ["--sweep", "white_point=1..100:24", "-o", "swept"];
    let drawn = || -> Vec<std::path::PathBuf> {
        let files = std::fs::read_dir(place.path("swept/pictures")).into_iter().flatten();
        let paths = files.map(|file| file.expect("a file").path());
        paths.filter(|path| path.extension().is_some_and(|ending| ending == "json")).collect()
    };
    let child = start(&place, &variables, &[&words[..], &sweep].concat());
    until(|| drawn().len() > 1, "two references are drawn");
    interrupted(child).exits(130).mentions("interrupted after 0 of 24 choices");
    let kept = drawn();
    assert!(kept.len() < 24);
    let made = |path: &std::path::PathBuf| std::fs::metadata(path).and_then(|data| data.modified()).expect("a time");
    let before: Vec<_> = kept.iter().map(made).collect();
    let child = start(&place, &variables, &[&words[..], &sweep].concat());
    until(|| drawn().len() > kept.len(), "the same command goes on");
    interrupted(child).exits(130);
    assert_eq!(kept.iter().map(made).collect::<Vec<_>>(), before, "they were drawn again");
}
