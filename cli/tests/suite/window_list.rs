//! EM-4: the list of settings and times that `framewright window` lays over its picture.
#![cfg(unix)]

use crate::testing::{FORWARD, Place, Vulkan, forward_with};
use crate::window::{DOWN, ESCAPE, LETTER_L, RIGHT, SCENE, Window, run, server};
use framewright_tests::sweep;
use image::RgbImage;

/// A window that all of the list fits into, but for the times of some passes.
const SIZE: [u16; 2] = [600, 400];
/// Width and height of a character, and the space around the text.
const CELL: [u32; 2] = [9, 15];
const MARGIN: u32 = 4;
/// The row of the first setting of a pipeline without presets: below the title and the speed.
const FIRST: u32 = 2;

/// The pixels of a row of the list, in these columns.
fn row(picture: &RgbImage, row: u32, columns: std::ops::Range<u32>) -> Vec<[u8; 3]> {
    let (top, [width, height]) = (MARGIN + row * CELL[1], CELL);
    let places = (top..top + height).flat_map(|y| columns.clone().map(move |column| (column, y)));
    let pixels = places.flat_map(|(column, y)| (0..width).map(move |x| (MARGIN + column * width + x, y)));
    pixels.map(|(x, y)| picture.get_pixel(x, y).0).collect()
}

/// Whether a cell has a mark in the colour of the chosen setting.
fn is_marked(picture: &RgbImage, of: u32) -> bool {
    row(picture, of, 0..1).iter().any(|[red, green, blue]| *red > 200 && *green > 150 && *blue < 150)
}

/// How many of the pixels in these places are others than in the other picture.
fn differs(one: &RgbImage, other: &RgbImage, places: impl Fn(u32, u32) -> bool) -> usize {
    let pixels = one.enumerate_pixels().zip(other.pixels());
    pixels.filter(|((x, y, texel), other)| places(*x, *y) && texel != other).count()
}

/// The words that show a pipeline in a window of [`SIZE`].
fn words<'w>(pipeline: &'w str, more: &[&'w str]) -> Vec<&'w str> {
    [&[pipeline, "--set", "msaa=1", "--size", "600x400", "--validate"][..], &SCENE, more].concat()
}

/// The headless picture of a pipeline.
fn drawn(place: &Place, more: &[&str]) -> RgbImage {
    let words = [&["run", "forward", "--set", "msaa=1", "-o", "drawn.png"][..], &SCENE, more].concat();
    place.run_with(&Vulkan::LAVAPIPE.variables().expect("it was there"), &words).exits(0);
    image::open(place.path("drawn.png")).expect("a picture").to_rgb8()
}

#[test]
fn em_4_the_list_is_on_the_screen_follows_keys_and_goes_with_its_key() {
    let Some(server) = server(true) else { return };
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::LAVAPIPE_OLD] {
        let place = Place::new();
        let Some(window) = Window::open(&place, &server, vulkan, &words("forward", &[])) else { continue };
        let frame = drawn(&place, &["--size", "600x400"]);
        let bare = window.shows(SIZE, "the picture alone", |shown| differs(shown, &frame, |_, _| true) == 0);
        window.press(LETTER_L);
        let listed = window.shows(SIZE, "a mark at the first setting", |shown| is_marked(shown, FIRST));
        assert!(differs(&listed, &bare, |x, y| x < 300 && y < 100) > 10_000, "the ground of the list is dark");
        assert_eq!(differs(&listed, &bare, |x, _| x >= MARGIN * 2 + 60 * CELL[0]), 0, "beside the list");
        // The next setting is chosen, and its value turned: `msaa`, then `hdr`.
        window.press(DOWN);
        let next = window.shows(SIZE, "a mark at the second setting", |shown| is_marked(shown, FIRST + 1));
        assert!(!is_marked(&next, FIRST));
        let value = |shown: &RgbImage| row(shown, FIRST + 1, 2..20);
        let before = value(&next);
        window.press(RIGHT);
        window.waits_for("hdr = false");
        window.shows(SIZE, "another value", |shown| is_marked(shown, FIRST + 1) && value(shown) != before);
        window.press(RIGHT);
        window.waits_for("hdr = true");
        window.shows(SIZE, "the value before", |shown| value(shown) == before);
        window.press(LETTER_L);
        window.shows(SIZE, "the picture alone again", |shown| differs(shown, &frame, |_, _| true) == 0);
        window.press(ESCAPE);
        let (code, said) = window.ends();
        assert_eq!(code, Some(0), "{said}");
        assert!(said.contains("validation: 0 findings"), "{said}");
    }
}

/// The pipeline that draws the list.
const LIST: &str = include_str!("../../src/window/list/list.ron");

#[test]
fn em_4_the_list_can_be_drawn_on_every_device_and_over_turned_pictures() {
    let place = Place::new();
    place.file("list.ron", LIST);
    for rotation in ["0", "90", "180", "270"] {
        let check = ["check", "list.ron", "--device", "all", "--set", "list_width=300", "--rotate", rotation];
        let checked = place.run(&check).exits(0);
        assert!(!checked.err.contains("warning"), "{}", checked.err);
    }
    let plan = place.run(&["inspect", "list.ron", "--rotate", "90", "--size", "64x32"]).exits(0).out;
    assert!(plan.contains("`screen` R8G8B8A8_SRGB 32×64, 1 sample, rotated by 90°"), "{plan}");
}

#[test]
fn em_4_a_list_whose_shaders_cannot_be_compiled_leaves_the_picture() {
    let Some(server) = server(false) else { return };
    let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    let place = Place::new();
    let words =
        ["window", "forward", "--size", "192x108", "--set", "msaa=1", "--frames", "3", "--precompiled", "spirv"];
    let words = [&words[..], &SCENE].concat();
    run(&place, &server, &variables, &words).exits(0);
    // A helper that can't start.
    let variables = [&variables[..], &[("FRAMEWRIGHT_HELPER", "1")]].concat();
    let listed = [&words[..], &["--no-cache", "--list", "-o", "shown.png"]].concat();
    run(&place, &server, &variables, &listed).exits(0).mentions("note: the list can't be shown");
    let shown = image::open(place.path("shown.png")).expect("a picture").to_rgb8();
    assert!(shown == drawn(&place, &["--size", "192x108"]));
}

#[test]
fn em_4_pictures_do_not_hold_the_list() {
    let Some(server) = server(false) else { return };
    for vulkan in [Vulkan::LAVAPIPE_CURRENT, Vulkan::LAVAPIPE_OLD] {
        let Some(variables) = vulkan.variables() else { continue };
        for (pipeline, choices, size) in [
            ("forward", &[][..], "192x108"),
            ("forward", &["--rotate", "90"], "108x192"),
            ("image_quality", &["--stereo", "double-wide"], "96x108"),
        ] {
            let place = Place::new();
            let both = |command, file| [&[command, pipeline, "-o", file][..], &SCENE, choices].concat();
            let more = ["--size", "192x108", "--frames", "3", "--list", "--validate"];
            let shown = [both("window", "shown.png"), more.into()].concat();
            run(&place, &server, &variables, &shown).exits(0).mentions("validation: 0 findings");
            let drawn = [both("run", "drawn.png"), vec!["--size", size, "--frames", "3"]].concat();
            place.run_with(&variables, &drawn).exits(0);
            let [shown, drawn] =
                ["shown.png", "drawn.png"].map(|file| image::open(place.path(file)).expect("a picture").to_rgb8());
            assert!(shown == drawn, "{pipeline} {choices:?}");
        }
    }
}

#[test]
fn em_4_the_list_is_upright_and_whole_over_turned_pictures_and_both_eyes() {
    let Some(server) = server(true) else { return };
    let mut settings = Vec::new();
    for (pipeline, choices) in
        [("forward", &[][..]), ("forward", &["--rotate", "90"]), ("forward", &["--stereo", "double-wide"])]
    {
        let place = Place::new();
        let more = [&["--list"][..], choices].concat();
        let words = words(pipeline, &more);
        let Some(window) = Window::open(&place, &server, Vulkan::LAVAPIPE_CURRENT, &words) else { return };
        let shown = window.shows(SIZE, "a mark at the first setting", |shown| is_marked(shown, FIRST));
        // The letters of the first settings, which are white or yellow on a dark ground whatever lies below.
        let letters = (FIRST..FIRST + 3).flat_map(|of| row(&shown, of, 0..40));
        settings.push(letters.map(|texel| texel.iter().max() > Some(&225)).collect::<Vec<_>>());
        window.press(ESCAPE);
        let (code, said) = window.ends();
        assert_eq!(code, Some(0), "{said}");
        assert!(said.contains("validation: 0 findings"), "{said}");
    }
    assert!(settings[0].iter().filter(|letter| **letter).count() > 200);
    assert!(settings[0] == settings[1], "turned");
    assert!(settings[0] == settings[2], "both eyes");
}

#[test]
fn em_4_a_mistake_is_in_the_list_while_the_last_good_frame_is_shown() {
    let Some(server) = server(true) else { return };
    let place = Place::new();
    place.file("mine.ron", FORWARD);
    let words = [&["mine.ron", "--size", "600x400", "--list"][..], &SCENE].concat();
    let Some(window) = Window::open(&place, &server, Vulkan::LAVAPIPE, &words) else { return };
    let red = |shown: &RgbImage| {
        let texels = row(shown, FIRST, 0..10);
        texels.iter().filter(|[red, green, blue]| *red > 230 && (110..150).contains(green) && *blue < 140).count() > 20
    };
    window.shows(SIZE, "a mark at the first setting", |shown| is_marked(shown, FIRST) && !red(shown));
    place.file("mine.ron", forward_with("draw: Sky", "draw: Skye"));
    window.shows(SIZE, "the mistake", |shown| red(shown) && is_marked(shown, FIRST + 2));
    place.file("mine.ron", FORWARD);
    window.shows(SIZE, "no mistake", |shown| is_marked(shown, FIRST) && !red(shown));
    window.press(ESCAPE);
    assert_eq!(window.ends().0, Some(0));
}

#[test]
fn em_4_the_preset_in_force_is_in_the_list_and_what_files_say_is_escaped() {
    let Some(server) = server(true) else { return };
    let place = Place::new();
    place.file("a\u{1b}[2J.ron", forward_with("presets: [", "presets: [(name: \"low\", set: {\"msaa\": 1}),"));
    // The characters of a row that aren't spaces.
    let written = |shown: &RgbImage, of: u32| {
        let bright = |column: &u32| row(shown, of, *column..*column + 1).iter().any(|texel| texel[0] > 225);
        (0..40).filter(bright).collect::<Vec<_>>()
    };
    for (more, lines) in [(&[][..], FIRST), (&["--preset", "low"], FIRST + 1)] {
        let words = [&["a\u{1b}[2J.ron", "--size", "600x400", "--list"][..], &SCENE, more].concat();
        let Some(window) = Window::open(&place, &server, Vulkan::LAVAPIPE, &words) else { return };
        let shown = window.shows(SIZE, "a mark at the first setting", |shown| is_marked(shown, lines));
        // `a\u{1b}[2J · 600×400`
        assert_eq!(written(&shown, 0), [0..10, 11..12, 13..20].into_iter().flatten().collect::<Vec<_>>());
        if !more.is_empty() {
            // `preset low`
            assert_eq!(written(&shown, 1), [0..6, 7..10].into_iter().flatten().collect::<Vec<_>>());
        }
    }
}

#[test]
fn em_4_the_list_survives_two_hundred_resizes_without_a_finding() {
    let Some(server) = server(true) else { return };
    let place = Place::new();
    let words = words("forward", &["--list", "-o", "last.png"]);
    let Some(window) = Window::open(&place, &server, Vulkan::LAVAPIPE_CURRENT, &words) else { return };
    let times = if sweep::is_long() { 1000 } else { 200 };
    for time in 0..times {
        window.resize([20 + time * 7 % 290, 10 + time * 11 % 170]);
        std::thread::sleep(std::time::Duration::from_millis(10));
        if time % 50 == 25 {
            window.press(DOWN);
        }
    }
    window.resize([211, 97]);
    window.waits_for_title("211×97");
    window.shows([211, 97], "a mark at a setting", |shown| (FIRST..6).any(|row| is_marked(shown, row)));
    window.press(ESCAPE);
    let (code, said) = window.ends();
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("validation: 0 findings"), "{said}");
    let last = image::open(place.path("last.png")).expect("a picture").to_rgb8();
    assert!(last == drawn(&place, &["--size", "211x97"]));
}
