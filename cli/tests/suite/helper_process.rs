//! Shaders are compiled and drivers tested in a helper process: what ends or fills that is an error of the file, or of the driver.

use crate::testing::{Place, Vulkan};
use framewright_graph::frame::{Draw, DrawList};
use framewright_graph::shader::Variant;
use framewright_passes::draw::interfaces;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::helper::Limits;
use framewright_vulkan::{Device, DeviceOptions, Helper, ShaderLibrary};
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A fragment shader with some text before its `main`, and what that writes.
fn fragment(before: &str, color: &str) -> String {
    format!(
        "#version 460\nlayout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 color;\n{before}\n\
         void main() {{ color = vec4({color}); }}\n"
    )
}

/// Macros of which each stands for the one before it twice, with `between` in between.
fn doubling(levels: u32, first: &str, between: &str) -> String {
    let twice = |level: u32| format!("#define A{level} A{0}{between}A{0}\n", level - 1);
    format!("#define A0 {first}\n") + &(1..=levels).map(twice).collect::<String>()
}

/// A pipeline whose only pass draws the screen with the shader `bad`.
fn pipeline() -> String {
    "Pipeline(version: 1, settings: [(name: \"n\", value: OneOf(default: 1, of: [1, 2]))],\n\
     images: [(name: \"screen\", format: Output, size: Output)],\n\
     passes: [(name: \"a\", when: \"n > 0\", draw: FullScreen(\"bad\"), color: [\"screen\"])], outputs: [\"screen\"])\n"
        .to_owned()
}

/// A folder with that pipeline and this shader.
fn place(bad: &str) -> Place {
    let place = Place::new();
    place.file("p.ron", pipeline());
    place.file("bad.frag", bad);
    place
}

/// Takes more stack than there is usually.
fn deep() -> String {
    fragment(&doubling(14, "uv.x", "+"), "A14")
}

/// Takes no end of time, and little else.
fn endless() -> String {
    fragment(&doubling(30, "", " "), "1.0 A30")
}

#[test]
fn a_shader_that_takes_too_much_is_an_error_of_the_file() {
    let nested = format!("{}1.0{}", "F(".repeat(10_000), ")".repeat(10_000));
    let not = "!".repeat(50_000);
    let dimensions = format!("float a{};", "[1]".repeat(50_000));
    let cases = [
        (deep(), &["a stack of more than 8 MiB"][..]),
        (fragment(&format!("#if {not}1\n#endif"), "1.0"), &["a stack of more than 8 MiB"]),
        (fragment(&doubling(24, "uv.x", "+"), "A24"), &["longer than 2 s", "more memory than 512 MiB"]),
        (endless(), &["longer than 2 s"]),
        (fragment("#define F(x) x", &nested), &["longer than 2 s", "more memory than 512 MiB"]),
        (fragment(&dimensions, "1.0"), &["longer than 2 s"]),
    ];
    for (bad, limits) in cases {
        let begin = Instant::now();
        let arguments = ["check", "p.ron", "--shader-seconds", "2", "--shader-memory", "512"];
        let outcome =
            place(&bad).run(&arguments).exits(1).mentions("error: shader `bad` doesn't compile\n --> p.ron:3:");
        let words = |limit: &&str| {
            let verb = if limit.starts_with("longer") { "took" } else { "needed" };
            outcome.err.contains(&format!(
                "^ the GLSL compiler {verb} {limit}, which is its limit; on which line isn't known\n"
            ))
        };
        assert!(limits.iter().any(words), "{limits:?}: {}", outcome.err);
        assert!(outcome.err.contains("\n ::: ./bad.frag:1:1\n"), "{}", outcome.err);
        assert!(begin.elapsed() < Duration::from_secs(30), "{:?}: {limits:?}", begin.elapsed());
    }
}

#[test]
fn a_shader_that_includes_itself_thousands_of_times_is_an_error_of_the_file() {
    let bad = fragment(&"#include \"bad.frag\"\n".repeat(50_000), "1.0");
    place(&bad)
        .run(&["check", "p.ron", "--shader-seconds", "2"])
        .exits(1)
        .mentions("error: shader `bad` doesn't compile\n --> p.ron:3:");
}

#[test]
fn every_command_that_compiles_shaders_survives_one_that_overflows_the_stack() {
    let place = place(&deep());
    let commands: [&[&str]; 5] = [
        &["check", "p.ron"],
        &["check", "p.ron", "--all-variants"],
        &["check", "p.ron", "--device", "all"],
        &["inspect", "p.ron"],
        &["check", "p.ron", "--format", "json"],
    ];
    for command in commands {
        let outcome = place.run(command).exits(1);
        let all = outcome.out + &outcome.err;
        assert!(all.contains("the GLSL compiler needed a stack of more than 8 MiB"), "{command:?}: {all}");
    }
    if let Some(variables) = Vulkan::LAVAPIPE.variables() {
        let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "-o", "x.png"];
        place.run_with(&variables, &run).exits(1).mentions("needed a stack of more than 8 MiB");
    }
}

#[test]
fn the_limits_of_shaders_are_raised_on_the_command_line() {
    let place = place(&deep());
    place.run(&["check", "p.ron", "--shader-stack", "256"]).exits(0);
    place.run(&["check", "p.ron"]).exits(1).mentions("help: `--shader-stack` raises it\n");
    place.run(&["check", "p.ron", "--shader-stack", "0"]).exits(2);
    place.run(&["check", "p.ron", "--shader-stack", "1024"]).exits(2).mentions("is a part of `--shader-memory`");
}

#[cfg(target_os = "linux")]
#[test]
fn more_memory_and_more_time_for_shaders_are_allowed_on_the_command_line() {
    // Some hundred thousand words of SPIR-V, and the tree that they are made of.
    let many = fragment(&doubling(16, "color += uv.xyxy;", " "), "0.0); A16 (color");
    let place = place(&many);
    let check = |memory: &str| place.run(&["check", "p.ron", "--shader-memory", memory, "--shader-seconds", "3600"]);
    check("192").exits(1).mentions("needed more memory than 192 MiB").mentions("help: `--shader-memory` raises it\n");
    check("4096").exits(0);
    // That is the shader's doing.
    place.file("bad.frag", fragment("", "1.0"));
    check("192").exits(0);
    // Whatever time it is given.
    place.file("bad.frag", endless());
    for seconds in ["1", "3"] {
        let check = place.run(&["check", "p.ron", "--shader-seconds", seconds]).exits(1);
        let said = format!("took longer than {seconds} s, which is its limit");
        check.mentions(&said).mentions("help: `--shader-seconds` raises it\n");
    }
}

#[test]
fn the_file_of_a_shader_that_takes_too_much_is_a_place_for_programs_too() {
    let json = place(&deep()).run(&["check", "p.ron", "--format", "json"]).exits(1).out;
    let answer: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let mistake = &answer["diagnostics"][0];
    assert_eq!((&mistake["file"], &mistake["line"]), (&"p.ron".into(), &3.into()), "{answer:#}");
    let label = &mistake["labels"][1];
    assert_eq!((&label["file"], &label["line"]), (&"./bad.frag".into(), &1.into()), "{answer:#}");
    assert_eq!(mistake["help"], "`--shader-stack` raises it", "{answer:#}");
}

#[test]
fn the_shader_after_one_that_ended_its_process_is_compiled_by_a_new_one() {
    let place = Place::new();
    let second = "(name: \"b\", draw: FullScreen(\"worse\"), color: [(image: \"screen\", blend: Alpha)])";
    place.file("p.ron", pipeline().replace("], outputs", &format!(", {second}], outputs")));
    place.file("bad.frag", deep());
    place.file("worse.frag", fragment("", "nothing"));
    place
        .run(&["check", "p.ron"])
        .exits(1)
        .mentions("\n ::: ./bad.frag:1:1\n")
        .mentions("the GLSL compiler needed a stack")
        .mentions("'nothing' : undeclared identifier");
}

/// A command that ends with the test, even if that fails.
struct Started(Child);

impl Drop for Started {
    fn drop(&mut self) {
        // It may have ended before.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The processes that a process started.
fn children(of: &Child) -> Vec<String> {
    let path = format!("/proc/{0}/task/{0}/children", of.id());
    let text = std::fs::read_to_string(path).unwrap_or_default();
    text.split_whitespace().map(str::to_owned).collect()
}

/// Whether a process runs. One that ended, and that no parent waited for, doesn't.
fn runs(id: &str) -> bool {
    let state = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
    state.rsplit_once(')').is_some_and(|(_, rest)| !rest.trim_start().starts_with(['Z', 'X']))
}

fn within(seconds: u64, mut test: impl FnMut() -> bool) -> bool {
    let begin = Instant::now();
    while begin.elapsed() < Duration::from_secs(seconds) {
        if test() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    false
}

#[cfg(target_os = "linux")]
#[test]
fn a_helper_ends_with_the_command_that_started_it_however_that_ends() {
    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;
    // SIGINT, which ends `check` like SIGTERM, is ignored where a shell has started the tests in the background.
    for signal in [Signal::SIGTERM, Signal::SIGKILL] {
        let place = place(&endless());
        let mut command = place.command(&["check", "p.ron", "--shader-seconds", "600"]);
        let mut command = Started(command.stderr(Stdio::null()).stdout(Stdio::null()).spawn().expect("it starts"));
        let mut helper = Vec::new();
        assert!(within(20, || {
            helper = children(&command.0);
            !helper.is_empty()
        }));
        // It is busy by now, or will be soon: both have to end.
        std::thread::sleep(Duration::from_millis(300));
        assert!(runs(&helper[0]));
        let id = i32::try_from(command.0.id()).expect("a process id");
        kill(Pid::from_raw(id), signal).expect("it can be ended");
        command.0.wait().expect("it ended");
        assert!(within(10, || !runs(&helper[0])), "{signal}: the helper outlives its command");
    }
}

/// The command as a helper that keeps nothing.
fn helper() -> Helper {
    Helper::program(Path::new(env!("CARGO_BIN_EXE_framewright")), Limits::default()).with_cache(None)
}

#[test]
fn a_helper_process_compiles_shaders_to_the_same_words() {
    let library = || ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
    let (mut here, mut helped) = (library(), library().with_helper(&helper()));
    let names = SHADERS.iter().filter_map(|(file, _)| file.strip_suffix(".frag"));
    let mut compared = 0;
    for name in names {
        for draw in [Draw::FullScreen, Draw::Objects(DrawList::Opaque)] {
            let variant = Variant::default();
            let [a, b] = [&mut here, &mut helped].map(|library| library.compiled(name, draw, &variant));
            match (a, b) {
                (Ok(a), Ok(b)) => {
                    assert!(a.vertex == b.vertex && a.fragment == b.fragment, "{name}");
                    assert_eq!(a.interface, b.interface, "{name}");
                    compared += 1;
                }
                (a, b) => assert_eq!(a.err(), b.err(), "{name}"),
            }
        }
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn a_helper_process_finds_of_a_device_what_this_process_finds() {
    let open = |helper| Device::open(&DeviceOptions { helper, ..DeviceOptions::default() });
    let (Ok(here), Ok(helped)) = (open(None), open(Some(helper()))) else {
        assert!(std::env::var_os("CI").is_none(), "CI must have a device");
        return;
    };
    assert_eq!(helped.profile(), here.profile());
    assert_eq!(helped.used_without(), here.used_without());
}

/// The only file in the folder of kept findings.
fn kept(cache: &Path) -> std::path::PathBuf {
    let folder = cache.join("framewright/self-tests");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").map(|file| file.expect("a file").path()).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    files.remove(0)
}

#[test]
fn what_self_tests_find_is_kept_and_a_damaged_or_unwritable_cache_is_ignored() {
    let Some(mut variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let cache = place.path("cache");
    let cache_text = cache.display().to_string();
    variables.push(("XDG_CACHE_HOME", &cache_text));
    let devices = || place.run_with(&variables, &["devices"]).exits(0).out;
    let fresh = devices();
    let file = kept(&cache);
    let text = std::fs::read_to_string(&file).expect("a text");
    assert_eq!(std::fs::read_dir(file.parent().expect("a folder")).expect("listed").count(), 1, "nothing unfinished");

    // Found in another way it would say this.
    let key_end = text.find("\"found\"").expect("what was found");
    let (key, found) = text.split_at(key_end);
    let lie = found.replace("\"draws_views_unknown\": null", "\"draws_views_unknown\": \"as was kept\"");
    std::fs::write(&file, format!("{key}{}", lie.replace("\"draws_views\": true", "\"draws_views\": false")))
        .expect("written");
    assert!(devices().contains("device 0 is used without multiview: as was kept"), "it is read");

    for damaged in ["", "nonsense", &text.replace("\"key\": \"", "\"key\": \"another "), "{\"key\": 3}"] {
        std::fs::write(&file, damaged).expect("written");
        assert_eq!(devices(), fresh, "{damaged}");
        assert_eq!(std::fs::read_to_string(&file).expect("a text"), text, "it is found and kept anew");
    }
    let no_folder = place.file("file", "").display().to_string();
    variables.pop();
    variables.push(("XDG_CACHE_HOME", &no_folder));
    assert_eq!(place.run_with(&variables, &["devices"]).exits(0).out, fresh);
}

#[test]
fn a_profile_and_a_refusal_say_of_a_self_test_that_could_not_be_done_that_it_was_not() {
    let Some(mut variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let cache = place.path("cache").display().to_string();
    // As if this were a helper itself, which starts no others.
    variables.extend([("XDG_CACHE_HOME", &*cache), ("FRAMEWRIGHT_HELPER", "1")]);
    place
        .run_with(&variables, &["devices", "--save", "saved.ron"])
        .exits(0)
        .mentions("note: not all of the device could be tested, and the profile is without what wasn't");
    let saved = std::fs::read_to_string(place.path("saved.ron")).expect("saved");
    assert!(saved.contains("untested_multiview: true") && saved.contains("untested_depth_resolve"), "{saved}");
    assert!(!saved.contains("refuted_"), "{saved}");
    let multiview = ["inspect", "forward", "--device", "saved.ron", "--stereo", "multiview"];
    let outcome = place.run(&multiview).exits(3).mentions("several views at once, and that couldn't be tested");
    assert!(!outcome.err.contains("a test showed"), "{}", outcome.err);
}

/// Starts `devices` with nothing kept, and holds its first helper up as a driver that hangs would. `None`: that came too late.
#[cfg(target_os = "linux")]
fn held_up(variables: &[(&str, &str)]) -> Option<(Place, Started, nix::unistd::Pid)> {
    use nix::sys::signal::{Signal, kill};
    use nix::unistd::Pid;
    let place = Place::new();
    let mut command = place.command(&["devices"]);
    command.envs(variables.iter().copied()).env("XDG_CACHE_HOME", place.path("cache"));
    let mut command = Started(command.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().expect("it starts"));
    // Before it is a helper it is a copy of the command, which waits for it.
    let is_helper = |id: &&String| {
        let arguments = std::fs::read_to_string(format!("/proc/{id}/cmdline")).unwrap_or_default();
        arguments.contains("--framewright-helper")
    };
    let mut helper = None;
    within(60, || {
        let found = children(&command.0).iter().find(is_helper).and_then(|id| id.parse().ok()).map(Pid::from_raw);
        helper = found.filter(|helper| kill(*helper, Signal::SIGSTOP).is_ok());
        helper.is_some() || command.0.try_wait().expect("it can be asked").is_some()
    });
    helper.map(|helper| (place, command, helper))
}

#[cfg(target_os = "linux")]
#[test]
fn a_command_that_waits_for_a_self_test_says_so() {
    use std::io::{BufRead, BufReader};
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let told = (0..10).find_map(|_| {
        let (place, mut command, helper) = held_up(&variables)?;
        let mut said = BufReader::new(command.0.stderr.take().expect("piped")).lines();
        Some((said.next()?.expect("a text"), said, command, helper, place))
    });
    let (first, said, mut command, helper, _place) = told.expect("a helper that was held up in time");
    let (start, end) = ("note: testing what `llvmpipe", "each of two tests is given up after 60 s");
    assert!(first.starts_with(start) && first.ends_with(end), "{first}");
    nix::sys::signal::kill(helper, nix::sys::signal::Signal::SIGKILL).expect("it can be ended");
    assert_eq!(said.count(), 0, "it is said once");
    assert_eq!(command.0.wait().expect("it ended").code(), Some(0));
}
