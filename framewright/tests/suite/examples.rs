//! The examples draw what they say (EM-1, EM-12).

use crate::testing::difference;
use framewright::{Device, DeviceOptions};
use framewright_tests::render::{self, Setup, in_repository};
use framewright_tests::wayland_server::{Shell, WaylandServer};
use framewright_tests::x_server::XServer;
use image::RgbaImage;
use std::path::Path;
use std::process::Command;

/// Runs an example in a folder of its own, and returns what it printed. Nothing where the machine has no driver.
fn run(example: &str, arguments: &[&str], look: impl FnOnce(&str, &Path)) {
    run_with(&[], example, arguments, look);
}

/// The same with some variables set; those that are empty aren't.
fn run_with(variables: &[(&str, &str)], example: &str, arguments: &[&str], look: impl FnOnce(&str, &Path)) {
    if render::device().is_none() {
        return;
    }
    let tests = std::env::current_exe().expect("a path");
    let built = tests.parent().and_then(Path::parent).expect("a folder").join("examples").join(example);
    assert!(built.exists(), "{} isn't built: cargo build --examples -p framewright", built.display());
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new(built);
    for (name, value) in variables {
        match value.is_empty() {
            true => command.env_remove(name),
            false => command.env(name, value),
        };
    }
    let out = command.args(arguments).current_dir(folder.path()).output().expect("it runs");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    look(&String::from_utf8_lossy(&out.stdout), folder.path());
}

fn picture(path: &Path) -> RgbaImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).into_rgba8()
}

/// A picture of a shipped pipeline by the layers one by one, on the device that examples draw on.
fn expected(set: &[(&str, &str)], extent: [u32; 2]) -> Vec<u8> {
    let device = Device::open(&DeviceOptions::default()).expect("a device");
    let scene = crate::testing::scene();
    let setup = Setup { pipeline: "examples/pipelines/forward.ron", set, scene: &scene, extent };
    render::render(&device, &setup).expect("drawn")[0].bytes.clone()
}

#[test]
fn the_ten_lines_draw_the_scene() {
    run("embed_minimal", &[], |_, folder| {
        assert_eq!(*picture(&folder.join("out/embedded.png")).as_raw(), expected(&[("msaa", "4")], [640, 360]));
    });
    let text = std::fs::read_to_string(in_repository("examples/embed_minimal.rs")).expect("a text");
    let (_, main) = text.split_once("dyn std::error::Error>> {\n").expect("a main");
    let (lines, _) = main.split_once("\n\n").expect("what comes after is about files");
    assert_eq!(lines.lines().count(), 10, "{lines}");
}

#[test]
fn a_batch_takes_no_more_memory_the_longer_it_is() {
    run("headless_batch", &["100"], |said, folder| {
        let most: Vec<u64> = said.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let [100, first_rounds, all] = most[..] else { panic!("{said}") };
        // Between buffers the allocator leaves gaps of a few bytes.
        assert!(first_rounds > 0 && all - first_rounds < 1024, "{said}");
        assert_eq!(std::fs::read_dir(folder.join("out/batch")).expect("a folder").count(), 100);
        // The second picture of a size, long after the first one of it.
        for (number, white_point, extent) in [(1, "4", [96, 54]), (49, "4", [96, 54]), (59, "16", [128, 72])] {
            let drawn = picture(&folder.join(format!("out/batch/{number:04}.png")));
            assert_eq!(*drawn.as_raw(), expected(&[("white_point", white_point)], extent), "{number}");
        }
    });
}

#[test]
fn an_engine_of_the_programs_own_draws_and_records() {
    run("custom_pass", &[], |_, folder| {
        let drawn = picture(&folder.join("out/engine.png"));
        assert_eq!(drawn.dimensions(), (160, 80));
        // The tint times the material, half of which is 0; grass stands in the upper left corner.
        assert_eq!(drawn.get_pixel(0, 0).0, [0, 255, 0, 255]);
        assert_eq!(drawn.get_pixel(159, 79).0, [255, 0, 0, 255]);
    });
}

#[test]
fn a_file_that_changes_is_drawn_on_with_its_history() {
    run("embed_changing", &[], |said, folder| {
        assert!(said.contains("out/changing.ron:7:36"), "{said}");
        assert!(said.contains("carried over: steady"), "{said}");
        let [plain, still_plain, overlay] =
            ["plain", "still_plain", "overlay"].map(|name| picture(&folder.join(format!("out/{name}.png"))));
        assert!(difference(plain.as_raw(), still_plain.as_raw()) < 1.0, "a mistake changes nothing");
        // The overlay covers a corner; elsewhere the picture stays.
        let changed = |picture: &RgbaImage, x, y| {
            plain.get_pixel(x, y).0.iter().zip(picture.get_pixel(x, y).0).any(|(one, other)| one.abs_diff(other) > 40)
        };
        let count = |from: [u32; 2], to: [u32; 2]| {
            (from[0]..to[0])
                .flat_map(|x| (from[1]..to[1]).map(move |y| (x, y)))
                .filter(|(x, y)| changed(&overlay, *x, *y))
                .count()
        };
        assert!(count([0, 0], [60, 30]) > 900, "{}", count([0, 0], [60, 30]));
        assert!(count([160, 90], [320, 180]) < 100, "{}", count([160, 90], [320, 180]));
    });
}

#[test]
fn a_window_of_the_programs_own_shows_frames_and_ends() {
    let server = match XServer::start() {
        Ok(server) => server,
        Err(missing) => {
            assert!(std::env::var_os("CI").is_none(), "in CI this is a failure: {missing}");
            return eprintln!("SKIPPED: {missing}");
        }
    };
    let variables = [("DISPLAY", server.display()), ("WAYLAND_DISPLAY", ""), ("WAYLAND_SOCKET", "")];
    run_with(&variables, "own_window", &["40"], |said, _| assert_eq!(said, "40 frames were shown\n"));
}

/// EM-4.
#[test]
fn a_window_of_the_programs_own_is_shown_on_wayland_too() {
    let server = match WaylandServer::start(Shell::Desktop) {
        Ok(server) => server,
        Err(missing) => {
            assert!(std::env::var_os("CI").is_none(), "in CI this is a failure: {missing}");
            return eprintln!("SKIPPED: {missing}");
        }
    };
    let own = server.variables();
    let variables = [[("DISPLAY", ""), ("WAYLAND_SOCKET", "")], own.each_ref().map(|(name, value)| (*name, &**value))];
    run_with(&variables.concat(), "own_window", &["40"], |said, _| assert_eq!(said, "40 frames were shown\n"));
}
