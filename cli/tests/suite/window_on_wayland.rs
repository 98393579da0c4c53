//! `framewright window`, on a Wayland compositor that nobody sees (EM-4).
#![cfg(unix)]

use crate::testing::{Place, Vulkan, outcome};
use crate::window::{SCENE, SIZE, lacks};
use framewright_tests::wayland_server::{Shell, WaylandServer};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// A server; `None` where there is none, which fails in CI.
fn server(shell: Shell) -> Option<WaylandServer> {
    match WaylandServer::start(shell) {
        Ok(server) => Some(server),
        Err(missing) => {
            assert!(std::env::var_os("CI").is_none(), "in CI this is a failure: {missing}");
            eprintln!("SKIPPED: {missing}");
            None
        }
    }
}

/// The command on this server.
fn on(server: &WaylandServer, place: &Place, words: &[&str]) -> Option<Command> {
    let mut command = place.command(words);
    command.env_remove("DISPLAY").env_remove("WAYLAND_SOCKET").envs(server.variables());
    command.envs(Vulkan::LAVAPIPE_CURRENT.variables()?);
    Some(command)
}

#[test]
fn the_picture_in_the_window_is_the_one_that_run_writes() {
    let Some(server) = server(Shell::Desktop) else { return };
    for pipeline in ["forward", "deferred"] {
        let place = Place::new();
        let both = |command, file| [&[command, pipeline, "-o", file, "--frames", "3"][..], &SCENE, &SIZE].concat();
        let Some(mut shown) = on(&server, &place, &[&both("window", "shown.png")[..], &["--validate"]].concat()) else {
            return;
        };
        outcome(&mut shown).exits(0).mentions("validation: 0 findings");
        let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
        place.run_with(&variables, &both("run", "drawn.png")).exits(0);
        let [shown, drawn] = ["shown.png", "drawn.png"]
            .map(|file| image::open(place.path(file)).unwrap_or_else(|error| panic!("{pipeline}: {error}")).to_rgb8());
        assert!(shown == drawn, "{pipeline}");
    }
}

#[test]
fn a_library_that_a_window_needs_and_is_missing_is_named_with_its_package() {
    let Some(server) = server(Shell::Desktop) else { return };
    let libraries = ["libwayland-client.so.0", "libwayland-client.so"];
    lacks(&server.variables(), &libraries, "libwayland-client0");
}

/// A process that ends with the test.
struct Ends(Child);

impl Drop for Ends {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Drivers wait without end where a second frame is shown in a window that nobody sees.
#[test]
fn a_window_that_nobody_sees_ends_when_it_is_told_to() {
    let Some(server) = server(Shell::Kiosk) else { return };
    let place = Place::new();
    let Some(mut command) = on(&server, &place, &[&["window", "forward"][..], &SCENE].concat()) else { return };
    // What is said to the server tells when a frame is shown.
    command.env("WAYLAND_DEBUG", "1").stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = Ends(command.spawn().expect("the command starts"));
    let lines = BufReader::new(child.0.stderr.take().expect("piped")).lines();
    let (send, said) = mpsc::channel();
    std::thread::spawn(move || lines.map_while(Result::ok).for_each(|line| drop(send.send(line))));
    loop {
        let line = said.recv_timeout(Duration::from_secs(60)).expect("it shows a frame");
        if line.contains(".attach(wl_buffer@") {
            break;
        }
    }
    // Time for a second frame, for a command that draws one.
    std::thread::sleep(Duration::from_secs(1));
    let process = Pid::from_raw(i32::try_from(child.0.id()).expect("a process number"));
    kill(process, Signal::SIGINT).expect("sent");
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.0.try_wait().expect("its status") {
            break status;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "it doesn't end");
        std::thread::sleep(Duration::from_millis(20));
    };
    assert!(status.success());
}
