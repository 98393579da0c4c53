//! `framewright window`, on an X server that nobody sees.
#![cfg(unix)]

use crate::testing::{FORWARD, Outcome, Place, Vulkan, forward_with, outcome};
use framewright_tests::sweep;
use framewright_tests::x_server::XServer;
use image::RgbImage;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::io::{BufRead, BufReader};
use std::process::{Child, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    ClientMessageEvent, ConfigureWindowAux, ConnectionExt as _, EventMask, ImageFormat, InputFocus, KEY_PRESS_EVENT,
    KEY_RELEASE_EVENT, MapState,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

pub(crate) const SCENE: [&str; 2] = ["--scene", "spheres_and_cubes"];
pub(crate) const SIZE: [&str; 2] = ["--size", "192x108"];

/// A server, with or without a window manager; `None` where there is none, which fails in CI.
pub(crate) fn server(manager: bool) -> Option<XServer> {
    let started = if manager { XServer::with_manager() } else { XServer::start() };
    match started {
        Ok(server) => Some(server),
        Err(missing) => {
            assert!(std::env::var_os("CI").is_none(), "in CI this is a failure: {missing}");
            eprintln!("SKIPPED: {missing}");
            None
        }
    }
}

/// Runs a command that ends by itself.
pub(crate) fn run(place: &Place, server: &XServer, variables: &[(&str, &str)], words: &[&str]) -> Outcome {
    let mut command = place.command(words);
    command.env_remove("WAYLAND_DISPLAY").env("DISPLAY", server.display()).envs(variables.iter().copied());
    outcome(&mut command)
}

#[test]
fn the_picture_in_the_window_is_the_one_that_run_writes() {
    let Some(server) = server(false) else { return };
    if let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() {
        for (pipeline, choices) in [
            ("forward", &[][..]),
            ("forward", &["--set", "msaa=1", "--rotate", "90"]),
            ("deferred", &[]),
            ("image_quality", &["--stereo", "double-wide"]),
        ] {
            let place = Place::new();
            let both = |command, file| [&[command, pipeline, "-o", file][..], &SCENE, choices].concat();
            let shown = [both("window", "shown.png"), SIZE.into(), vec!["--frames", "3", "--validate"]].concat();
            run(&place, &server, &variables, &shown).exits(0).mentions("validation: 0 findings");
            // In a window both eyes share the width, and a turned picture has the window's height as its width.
            let size = match choices {
                [.., "double-wide"] => "96x108",
                [.., "90"] => "108x192",
                _ => "192x108",
            };
            let drawn = [both("run", "drawn.png"), vec!["--size", size, "--frames", "3"]].concat();
            place.run_with(&variables, &drawn).exits(0);
            let [shown, drawn] = ["shown.png", "drawn.png"].map(|file| {
                image::open(place.path(file)).unwrap_or_else(|error| panic!("{pipeline}: {error}")).to_rgb8()
            });
            assert_eq!(shown.dimensions(), drawn.dimensions(), "{pipeline} {choices:?}");
            assert!(shown == drawn, "{pipeline} {choices:?}");
        }
    }
}

/// An open window of the command's, and what the test does to it.
pub(crate) struct Window<'s> {
    child: Child,
    /// Its lines on standard error.
    said: Receiver<String>,
    x: RustConnection,
    root: u32,
    window: u32,
    _server: &'s XServer,
}

impl<'s> Window<'s> {
    pub(crate) fn open(place: &Place, server: &'s XServer, vulkan: Vulkan, words: &[&str]) -> Option<Window<'s>> {
        let mut command = place.command(&[&["window"][..], words].concat());
        command.env_remove("WAYLAND_DISPLAY").env("DISPLAY", server.display()).envs(vulkan.variables()?);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts");
        let lines = BufReader::new(child.stderr.take().expect("piped")).lines();
        let (send, said) = mpsc::channel();
        std::thread::spawn(move || lines.map_while(Result::ok).try_for_each(|line| send.send(line)));
        let (x, screen) = RustConnection::connect(Some(server.display())).expect("the server listens");
        let root = x.setup().roots[screen].root;
        let mut window = Window { child, said, x, root, window: 0, _server: server };
        window.waits_for("keys: ");
        window.window = window.find(root).expect("a window with a title");
        Some(window)
    }

    /// The window of the command's below another one.
    fn find(&self, below: u32) -> Option<u32> {
        let children = self.x.query_tree(below).expect("sent").reply().expect("its windows").children;
        children.into_iter().find_map(|window| {
            let (wm_class, string) =
                (x11rb::protocol::xproto::AtomEnum::WM_NAME, x11rb::protocol::xproto::AtomEnum::ANY);
            let name = self.x.get_property(false, window, wm_class, string, 0, 64).expect("sent").reply();
            let is_it = name.is_ok_and(|name| {
                let name = String::from_utf8_lossy(&name.value).into_owned();
                name.contains("framewright") || name.contains("frames/s")
            });
            if is_it { Some(window) } else { self.find(window) }
        })
    }

    /// Reads what the command says until it says `text`.
    #[track_caller]
    pub(crate) fn waits_for(&self, text: &str) {
        let mut all = String::new();
        while !all.contains(text) {
            match self.said.recv_timeout(Duration::from_secs(60)) {
                Ok(line) => all += &line,
                Err(_) => panic!("it doesn't say `{text}`:\n{all}"),
            }
        }
    }

    /// Waits until the title has these words.
    pub(crate) fn waits_for_title(&self, words: &str) {
        let begun = Instant::now();
        loop {
            let utf8 = self.x.intern_atom(false, b"_NET_WM_NAME").expect("sent").reply().expect("an atom").atom;
            let any = x11rb::protocol::xproto::AtomEnum::ANY;
            let title =
                self.x.get_property(false, self.window, utf8, any, 0, 256).expect("sent").reply().expect("a title");
            let title = String::from_utf8_lossy(&title.value).into_owned();
            if title.contains(words) {
                return;
            }
            assert!(begun.elapsed() < Duration::from_secs(30), "`{words}` is not in `{title}`");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    pub(crate) fn resize(&self, [width, height]: [u32; 2]) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.x.configure_window(self.window, &size).expect("sent").check().expect("it has the size");
    }

    /// What the window shows; `None` while it isn't on the screen in this size.
    fn picture(&self, [width, height]: [u16; 2]) -> Option<RgbImage> {
        let format = ImageFormat::Z_PIXMAP;
        let image = self.x.get_image(format, self.window, 0, 0, width, height, u32::MAX).expect("sent").reply().ok()?;
        let texels = image.data.chunks_exact(4).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect();
        RgbImage::from_raw(width.into(), height.into(), texels)
    }

    /// Waits until what the window shows is so, and returns it.
    #[track_caller]
    pub(crate) fn shows(&self, size: [u16; 2], what: &str, so: impl Fn(&RgbImage) -> bool) -> RgbImage {
        let begun = Instant::now();
        loop {
            if let Some(picture) = self.picture(size).filter(&so) {
                return picture;
            }
            assert!(begun.elapsed() < Duration::from_secs(60), "the window doesn't show {what}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Asks the window manager to minimise the window, or to show it again.
    fn minimise(&self, on: bool) {
        const ICONIC: u32 = 3;
        if on {
            let change = self.x.intern_atom(false, b"WM_CHANGE_STATE").expect("sent").reply().expect("an atom").atom;
            let event = ClientMessageEvent::new(32, self.window, change, [ICONIC, 0, 0, 0, 0]);
            let mask = EventMask::SUBSTRUCTURE_REDIRECT | EventMask::SUBSTRUCTURE_NOTIFY;
            self.x.send_event(false, self.root, mask, event).expect("sent").check().expect("it is asked");
        } else {
            self.x.map_window(self.window).expect("sent").check().expect("it is shown");
        }
        self.x.sync().expect("the server has done it");
    }

    /// Waits until the window is shown and has the focus.
    fn is_focused(&self) {
        let begun = Instant::now();
        loop {
            let shown = self.x.get_window_attributes(self.window).expect("sent").reply().expect("its attributes");
            if shown.map_state == MapState::VIEWABLE {
                let _ = self.x.set_input_focus(InputFocus::PARENT, self.window, 0_u32).expect("sent").check();
                if self.x.get_input_focus().expect("sent").reply().expect("the focus").focus == self.window {
                    return;
                }
            }
            assert!(begun.elapsed() < Duration::from_secs(30), "the window has no focus");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Presses and releases a key, by its code on a usual keyboard.
    pub(crate) fn press(&self, code: u8) {
        self.is_focused();
        for event in [KEY_PRESS_EVENT, KEY_RELEASE_EVENT] {
            self.x.xtest_fake_input(event, code, 0, self.root, 0, 0, 0).expect("sent").check().expect("a key");
        }
    }

    /// Waits until the command ends, and returns its exit code with what else it said.
    pub(crate) fn ends(mut self) -> (Option<i32>, String) {
        let begun = Instant::now();
        let code = loop {
            if let Some(status) = self.child.try_wait().expect("its status") {
                break status.code();
            }
            assert!(begun.elapsed() < Duration::from_secs(120), "it doesn't end");
            std::thread::sleep(Duration::from_millis(20));
        };
        (code, self.said.iter().collect::<Vec<_>>().join("\n"))
    }
}

impl Drop for Window<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub(crate) const ESCAPE: u8 = 9;
const LEFT: u8 = 113;
pub(crate) const RIGHT: u8 = 114;
pub(crate) const DOWN: u8 = 116;
const LETTER_E: u8 = 26;
pub(crate) const LETTER_L: u8 = 46;
const LETTER_P: u8 = 33;
const LETTER_T: u8 = 28;

#[test]
fn a_window_survives_resizes_and_being_minimised_without_a_finding() {
    let Some(server) = server(true) else { return };
    let place = Place::new();
    let words = [&["forward", "--set", "msaa=1", "--validate", "-o", "last.png"][..], &SCENE, &SIZE].concat();
    let Some(window) = Window::open(&place, &server, Vulkan::LAVAPIPE_CURRENT, &words) else { return };
    let times = if sweep::is_long() { 1000 } else { 60 };
    for time in 0..times {
        window.resize([150 + time * 7 % 90, 60 + time * 11 % 70]);
        std::thread::sleep(Duration::from_millis(10));
        if time % 20 == 10 {
            window.minimise(true);
            std::thread::sleep(Duration::from_millis(50));
            window.minimise(false);
        }
    }
    window.resize([211, 97]);
    std::thread::sleep(Duration::from_millis(500));
    window.press(ESCAPE);
    let (code, said) = window.ends();
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("validation: 0 findings"), "{said}");
    let last = image::open(place.path("last.png")).expect("a picture").to_rgb8();
    assert_eq!(last.dimensions(), (211, 97));
    let drawn = ["run", "forward", "--set", "msaa=1", "--size", "211x97", "-o", "drawn.png"];
    place.run_with(&Vulkan::LAVAPIPE.variables().expect("it was there"), &[&drawn[..], &SCENE].concat()).exits(0);
    assert!(last == image::open(place.path("drawn.png")).expect("a picture").to_rgb8());
}

#[test]
fn keys_turn_settings_eyes_and_the_screen_and_write_pictures() {
    let Some(server) = server(true) else { return };
    let place = Place::new();
    let words = [&["forward", "--validate"][..], &SCENE, &SIZE].concat();
    let Some(window) = Window::open(&place, &server, Vulkan::LAVAPIPE_CURRENT, &words) else { return };
    window.press(DOWN);
    window.waits_for("hdr = true");
    window.press(RIGHT);
    window.waits_for("hdr = false");
    window.press(LEFT);
    window.waits_for("hdr = true");
    window.press(LETTER_P);
    window.waits_for("wrote `forward-001.png`");
    window.press(LETTER_T);
    window.waits_for("rotated by 90°");
    window.press(LETTER_P);
    window.waits_for("wrote `forward-002.png`");
    for _ in 0..3 {
        window.press(LETTER_T);
    }
    window.waits_for("rotated by 0°");
    window.press(LETTER_E);
    window.waits_for("both eyes beside each other");
    window.press(LETTER_E);
    window.waits_for("one eye");
    window.press(ESCAPE);
    let (code, said) = window.ends();
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("validation: 0 findings"), "{said}");
    let size = |file: &str| image::open(place.path(file)).expect("a picture").to_rgb8().dimensions();
    assert_eq!([size("forward-001.png"), size("forward-002.png")], [(192, 108), (108, 192)]);
}

#[test]
fn a_mistake_in_a_file_leaves_the_last_good_frame_and_a_mended_file_is_drawn() {
    let Some(server) = server(false) else { return };
    let place = Place::new();
    place.file("mine.ron", FORWARD);
    let words = [&["mine.ron"][..], &SCENE, &SIZE].concat();
    let Some(window) = Window::open(&place, &server, Vulkan::LAVAPIPE, &words) else { return };
    place.file("mine.ron", forward_with("draw: Sky", "draw: Skye"));
    window.waits_for("Skye");
    window.waits_for_title("the last good frame is shown");
    place.file("mine.ron", FORWARD);
    window.waits_for("`mine.ron` is drawn as it is now");
    kill(Pid::from_raw(i32::try_from(window.child.id()).expect("a number")), Signal::SIGINT).expect("sent");
    let (code, said) = window.ends();
    assert_eq!(code, Some(0), "Ctrl-C closes it: {said}");
}

#[test]
fn a_pipeline_without_a_picture_for_each_eye_shows_one() {
    let Some(server) = server(true) else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let words = [&["first.ron", "--validate"][..], &SCENE, &SIZE].concat();
    let Some(window) = Window::open(&place, &server, Vulkan::LAVAPIPE_CURRENT, &words) else { return };
    window.press(LETTER_E);
    window.waits_for("the first output has no picture for each eye");
    window.press(LETTER_P);
    window.waits_for("wrote `first-001.png`");
    window.press(ESCAPE);
    let (code, said) = window.ends();
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("validation: 0 findings"), "{said}");
    assert_eq!(image::open(place.path("first-001.png")).expect("a picture").to_rgb8().dimensions(), (192, 108));
}

#[test]
fn what_keeps_a_window_from_opening_is_told_before_it_opens() {
    let place = Place::new();
    let variables = Vulkan::LAVAPIPE.variables();
    let mut nowhere = place.command(&[&["window", "forward"][..], &SCENE].concat());
    nowhere.env_remove("WAYLAND_DISPLAY").env_remove("DISPLAY").envs(variables.clone().unwrap_or_default());
    let said = outcome(&mut nowhere).exits(3).err;
    assert!(said.contains("no window can be opened: neither WAYLAND_DISPLAY"), "{said}");
    let (Some(server), Some(variables)) = (server(false), variables) else { return };
    for (words, code, said) in [
        (&["window", "forwards"][..], 1, "there is no pipeline `forwards`"),
        (&["window", "forward", "--set", "msaa=3"], 2, "msaa"),
        (&["window", "forward", "--preset", "none"], 2, "none"),
        (&["window", "forward", "-o", "a.exr"], 2, "a window's picture is a .png file"),
        (&["window", "forward", "--device", "nobody"], 3, "no device named nobody"),
        (&["window", "forward", "-o", "no/such/folder/a.png"], 3, "no/such/folder"),
    ] {
        run(&place, &server, &variables, &[words, &SCENE].concat()).exits(code).mentions(said);
    }
    // It has no surfaces of Xlib.
    if let Some(variables) = Vulkan::SWIFTSHADER.variables() {
        let said = run(&place, &server, &variables, &[&["window", "forward"][..], &SCENE].concat()).exits(3);
        said.mentions("the driver shows nothing on this display: it lacks VK_KHR_xlib_surface");
    }
    // What the first output is can't be shown, which no frame mends.
    place.file("light.ron", forward_with("outputs: [\"screen\"]", "outputs: [\"color\"]"));
    run(&place, &server, &variables, &[&["window", "light.ron"][..], &SCENE].concat())
        .exits(1)
        .mentions("can't be shown");
    place.file("wrong.ron", forward_with("draw: Sky", "draw: Skye"));
    run(&place, &server, &variables, &[&["window", "wrong.ron"][..], &SCENE].concat()).exits(1).mentions("Skye");
}

/// Asserts that a window says which packages it lacks, where none of these libraries can be opened: a folder that is looked in before
/// the system's holds empty files of their names.
pub(crate) fn lacks(server: &[(&str, String)], libraries: &[&str], said: &str) {
    let place = Place::new();
    std::fs::create_dir_all(place.path("missing")).expect("made");
    for library in libraries {
        place.file(format!("missing/{library}"), "");
    }
    let words = [&["window", "forward", "--frames", "1"][..], &SCENE, &SIZE].concat();
    let mut command = place.command(&words);
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env("LD_LIBRARY_PATH", place.path("missing"));
    let told = outcome(command.envs(server.iter().cloned())).exits(3);
    let expected = format!("error: no window can be opened: a library is missing, which Debian has in {said} [E1305]");
    assert_eq!(told.err.lines().next(), Some(&*expected), "{libraries:?}: {}", told.err);
    assert!(!told.err.contains("panicked"), "{libraries:?}: {}", told.err);
}

#[test]
fn a_library_that_a_window_needs_and_is_missing_is_named_with_its_package() {
    let Some(server) = server(false) else { return };
    let of_x = "libx11-6 or libx11-xcb1 or libxcursor1 or libxi6";
    for (libraries, said) in [
        (["libxkbcommon-x11.so.0", "libxkbcommon-x11.so"], "libxkbcommon-x11-0"),
        // The one before needs it.
        (["libxkbcommon.so.0", "libxkbcommon.so"], "libxkbcommon-x11-0"),
        (["libXcursor.so.1", "libXcursor.so"], of_x),
        (["libXi.so.6", "libXi.so"], of_x),
    ] {
        lacks(&[("DISPLAY", server.display().to_owned())], &libraries, said);
    }
}

/// What a window compiles is added to the folder, and taken from there by the next one.
#[test]
fn a_window_takes_shaders_that_were_compiled_ahead() {
    let (Some(server), Some(variables)) = (server(false), Vulkan::LAVAPIPE.variables()) else { return };
    let place = Place::new();
    let words = [&["window", "forward", "--no-cache", "--precompiled", "spirv", "--frames", "1"][..], &SCENE, &SIZE];
    run(&place, &server, &variables, &words.concat()).exits(0);
    let files = || std::fs::read_dir(place.path("spirv")).map_or(0, Iterator::count);
    let compiled = files();
    assert!(compiled > 3, "{compiled} shaders were added");
    for file in std::fs::read_dir(place.path("spirv")).expect("listed") {
        std::fs::write(file.expect("readable").path(), "no SPIR-V").expect("written");
    }
    run(&place, &server, &variables, &words.concat()).exits(1).mentions(" is no SPIR-V");
    assert_eq!(files(), compiled);
}
