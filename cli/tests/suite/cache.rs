//! The cache: compiled shaders are taken from it where nothing that they were made from has changed, and only there.

use crate::testing::{FORWARD, Outcome, Place, Vulkan};
use serde_json::Value;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

const PIPELINE: &str = "Pipeline(version: 1, images: [(name: \"screen\", format: Output, size: Output)],
    passes: [(name: \"fill\", draw: FullScreen(\"fill\"), color: [\"screen\"])], outputs: [\"screen\"])";

const SHADER: &str =
    "#version 460\n#include \"shade.glsl\"\nlayout(location = 0) out vec4 color;\nvoid main() { color = SHADE; }\n";

/// A folder with a pipeline whose shader includes a file, and with a cache of its own.
fn place() -> Place {
    let place = Place::new();
    place.file("p.ron", PIPELINE);
    place.file("fill.frag", SHADER);
    place.file("shade.glsl", "#define SHADE vec4(1.0)\n");
    place
}

/// Runs a command of that folder.
fn run<A: AsRef<OsStr>>(place: &Place, arguments: &[A]) -> Outcome {
    let cache = place.path("cache").to_string_lossy().into_owned();
    place.run_with(&[("XDG_CACHE_HOME", &cache)], arguments)
}

/// Runs it where it can't start a process that compiles.
fn run_without_compiler<A: AsRef<OsStr>>(place: &Place, arguments: &[A]) -> Outcome {
    let cache = place.path("cache").to_string_lossy().into_owned();
    place.run_with(&[("XDG_CACHE_HOME", &cache), ("FRAMEWRIGHT_HELPER", "1")], arguments)
}

/// The files with compiled stages.
fn kept(place: &Place) -> Vec<PathBuf> {
    let entries = fs::read_dir(place.path("cache/framewright/spirv")).into_iter().flatten();
    entries.map(|entry| entry.expect("listed").path()).collect()
}

const CHECK: [&str; 2] = ["check", "p.ron"];

#[test]
fn what_was_compiled_is_not_compiled_again() {
    let place = place();
    run_without_compiler(&place, &CHECK).exits(3).mentions("the helper process that compiles shaders");
    let first = run(&place, &CHECK).exits(0);
    assert_eq!(kept(&place).len(), 2, "a fragment stage and a vertex stage");
    assert_eq!(run_without_compiler(&place, &CHECK).exits(0).out, first.out);
    run_without_compiler(&place, &["check", "p.ron", "--no-cache"]).exits(3);
}

#[test]
fn a_file_that_changed_is_compiled_whichever_it_is() {
    let place = place();
    run(&place, &CHECK).exits(0);
    place.file("shade.glsl", "#define SHADE vec4(nothing)\n");
    run(&place, &CHECK).exits(1).mentions("'nothing' : undeclared identifier");
    place.file("shade.glsl", "#define SHADE vec4(0.5)\n");
    run_without_compiler(&place, &CHECK).exits(3);
    run(&place, &CHECK).exits(0);
    run_without_compiler(&place, &CHECK).exits(0);
    place.file("fill.frag", SHADER.replace("SHADE;", "SHADE * wrong;"));
    run(&place, &CHECK).exits(1).mentions("'wrong' : undeclared identifier");
    fs::remove_file(place.path("shade.glsl")).expect("removed");
    place.file("fill.frag", SHADER);
    run(&place, &CHECK).exits(1).mentions("shade.glsl");
}

#[test]
fn a_file_that_is_found_in_another_place_now_is_compiled() {
    let place = Place::new();
    place.file("p.ron", PIPELINE);
    let name = "include/film_grain.glsl";
    place.file("fill.frag", SHADER.replace("shade.glsl", name).replace("SHADE", "vec4(1.0)"));
    run(&place, &CHECK).exits(0);
    // One beside the shader is nearer than the shipped one.
    fs::create_dir(place.path("include")).expect("made");
    place.file(name, "nonsense");
    run(&place, &CHECK).exits(1).mentions("./include/film_grain.glsl:1:1");
    fs::remove_file(place.path(name)).expect("removed");
    run_without_compiler(&place, &CHECK).exits(0);
}

#[test]
fn a_stage_is_the_same_from_wherever_its_file_is_named() {
    let place = place();
    run(&place, &CHECK).exits(0);
    let absolute = place.path("p.ron").to_string_lossy().into_owned();
    run_without_compiler(&place, &["check", &absolute]).exits(0);
    place.file("shade.glsl", "#define SHADE vec4(nothing)\n");
    run_without_compiler(&place, &["check", &absolute]).exits(3);
}

#[test]
fn other_limits_compile_anew() {
    let place = place();
    run(&place, &CHECK).exits(0);
    run_without_compiler(&place, &["check", "p.ron", "--shader-stack", "9"]).exits(3);
    run_without_compiler(&place, &["check", "p.ron", "--shader-memory", "1025"]).exits(3);
    run_without_compiler(&place, &["check", "p.ron", "--shader-seconds", "11"]).exits(3);
}

#[test]
fn a_damaged_file_counts_as_none_and_is_replaced() {
    let place = place();
    run(&place, &CHECK).exits(0);
    for file in kept(&place) {
        let whole = fs::read(&file).expect("read");
        let middle = whole.len() / 2;
        let mut damaged: Vec<Vec<u8>> = [0, 1, middle, whole.len() - 1].map(|length| whole[..length].to_vec()).into();
        for at in [0, 3, 4, 40, middle, whole.len() - 1] {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x10;
            damaged.push(bytes);
        }
        damaged.push([&*whole, b"more"].concat());
        for bytes in damaged {
            fs::write(&file, &bytes).expect("written");
            run_without_compiler(&place, &CHECK).exits(3);
            run(&place, &CHECK).exits(0);
            assert!(fs::read(&file).expect("read") == whole, "it is written again as it was");
        }
    }
    run_without_compiler(&place, &CHECK).exits(0);
}

#[test]
fn commands_at_once_share_a_cache() {
    let place = place();
    place.file("forward.ron", FORWARD);
    let cache = place.path("cache");
    let start = || {
        let mut command = place.command(&["check", "forward.ron", "--all-variants", "--threads", "2"]);
        command.env("XDG_CACHE_HOME", &cache).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts")
    };
    let commands: Vec<_> = (0..4).map(|_| start()).collect();
    let out = |command: std::process::Child| {
        let output = command.wait_with_output().expect("it ends");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    };
    let outs: Vec<String> = commands.into_iter().map(out).collect();
    let again = run_without_compiler(&place, &["check", "forward.ron", "--all-variants", "--threads", "2"]).exits(0);
    assert!(outs.iter().all(|out| *out == again.out), "{outs:#?}");
    assert!(
        kept(&place).iter().all(|file| file.extension().is_none()),
        "nothing unfinished is left: {:?}",
        kept(&place)
    );
}

#[test]
fn the_cache_is_listed_and_cleared_and_what_others_keep_beside_it_stays() {
    let place = place();
    let files = |arguments: &[&str]| -> Vec<u64> {
        let answer: Value = serde_json::from_str(&run(&place, arguments).exits(0).out).expect("JSON");
        assert_eq!(Path::new(answer["folder"].as_str().expect("a path")), place.path("cache/framewright"));
        let kinds = answer["kinds"].as_array().expect("a list");
        kinds.iter().map(|kind| kind["files"].as_u64().expect("a number")).collect()
    };
    let list = ["cache", "--format", "json"];
    assert_eq!(files(&list), [0; 3]);
    run(&place, &CHECK).exits(0);
    assert_eq!(files(&list), [2, 0, 0]);
    let said = run(&place, &["cache"]).exits(0).out;
    assert!(said.starts_with("kept in ") && said.contains("\n  spirv: 2 files, "), "{said}");
    place.file("cache/framewright/other", "stays");
    assert_eq!(files(&["cache", "--clear", "--format", "json"]), [2, 0, 0]);
    assert_eq!(files(&list), [0; 3]);
    assert!(place.path("cache/framewright/other").exists());
    run(&place, &["check", "p.ron", "--no-cache"]).exits(0);
    assert_eq!(files(&list), [0; 3]);
}

/// EM-9: what a driver keeps of pipelines stays for the next command; damage to it, or another driver's, does no harm.
#[test]
fn pipelines_are_kept_as_the_driver_gives_them_and_damage_does_no_harm() {
    let place = place();
    let Some(driver) = Vulkan::LAVAPIPE.variables() else { return };
    let cache = place.path("cache").to_string_lossy().into_owned();
    let variables = [&driver[..], &[("XDG_CACHE_HOME", &*cache)]].concat();
    let picture = || {
        place
            .run_with(&variables, &["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "4x4", "-o", "p.png"])
            .exits(0);
        fs::read(place.path("p.png")).expect("it is written")
    };
    let files = || -> Vec<PathBuf> {
        let entries = fs::read_dir(place.path("cache/framewright/pipelines")).expect("a folder");
        entries.map(|entry| entry.expect("listed").path()).collect()
    };
    let first = picture();
    let [file] = &files()[..] else { panic!("one file for the device: {:?}", files()) };
    let whole = fs::read(file).expect("read");
    for bytes in [&whole[..0], &whole[..whole.len() - 1], &[7; 1000], &[&*whole, b"more"].concat()] {
        fs::write(file, bytes).expect("written");
        assert!(picture() == first);
        assert!(fs::read(file).expect("read") == whole, "it is written again as it was");
    }
    fs::write(file, "damaged").expect("written");
    let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "4x4", "-o", "p.png", "--no-cache"];
    place.run_with(&variables, &run).exits(0);
    assert_eq!(fs::read(file).expect("read"), b"damaged", "the cache isn't written");
    fs::remove_dir_all(place.path("cache/framewright/pipelines")).expect("removed");
    place.file("cache/framewright/pipelines", "no folder");
    assert!(picture() == first);
}

#[test]
fn a_cache_that_can_not_be_written_costs_time_and_nothing_else() {
    let place = place();
    place.file("cache", "no folder");
    run(&place, &CHECK).exits(0);
    run(&place, &["cache"]).exits(3).mentions("can't be read: Not a directory");
    let nowhere = [("XDG_CACHE_HOME", ""), ("HOME", "")];
    place.run_with(&nowhere, &CHECK).exits(0);
    let said = place.run_with(&nowhere, &["cache"]).exits(0).out;
    assert_eq!(said, "nothing is kept: neither `XDG_CACHE_HOME` nor `HOME` is an absolute path\n");
}
