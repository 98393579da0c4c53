//! Frames that are held, stepped and saved (LV-1).

use super::{Drawn, Page, while_drawing};
use crate::testing::Place;
use crate::testing::browser::Browser;
use framewright_tests::render;
use framewright_viewer::{SaveError, Viewer};
use std::time::Duration;

/// The texels of a picture that the page shows.
const TEXELS: &str = "(async () => { const image = document.querySelector('.outputs img'); await image.decode(); \
    const canvas = new OffscreenCanvas(64, 48); const context = canvas.getContext('2d'); context.drawImage(image, 0, 0); \
    return [...context.getImageData(0, 0, 64, 48).data].join(); })()";

#[test]
fn lv_1_a_frame_is_held_stepped_and_saved_in_the_page() {
    let (Some(mut browser), Some(device)) = (Browser::start(), render::device()) else { return };
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let page = Page::of(&viewer);
    let mut drawn = Drawn::of(device, "forward", [64, 48]);
    let url = viewer.url();
    let frame = "live.state.program.frame";
    while_drawing(
        || drawn.show(&mut viewer),
        || {
            browser.open(&url);
            browser.until("models.length === 1 && live.state.program.frame > 0");
            assert_eq!(browser.count("document.querySelectorAll('#renderer').length"), 0, "there is one");
            browser.click("#hold");
            browser.until("live.state.program.held");
        },
    );
    // The program goes on, and the page keeps its frame: a setting that is turned is taken.
    let held = browser.count(frame);
    let msaa = while_drawing(
        || drawn.show(&mut viewer),
        || {
            browser.until("document.querySelector('#live-status').textContent.startsWith('Frame ')");
            let value =
                browser.text("live.state.settings.find((one) => one.name === 'msaa').value === '4' ? '2' : '4'");
            browser.ask(&format!("choose({{ set: {{ msaa: '{value}' }} }})"));
            browser.until(&format!("live.state.chosen.msaa === '{value}'"));
            value
        },
    );
    (0..3).for_each(|_| drawn.show(&mut viewer));
    assert_eq!(drawn.msaa(), msaa);
    assert_eq!(browser.count(frame), held);
    // One further frame, which stays.
    while_drawing(
        || drawn.show(&mut viewer),
        || {
            browser.click("#step");
            browser.until(&format!("live.state.program.frame > {held}"));
        },
    );
    let stepped = browser.count(frame);
    (0..3).for_each(|_| drawn.show(&mut viewer));
    assert_eq!((browser.count(frame), browser.ask("live.state.program.held")), (stepped, true.into()));
    browser.click("#tab-live");
    let texels = browser.text(TEXELS);
    let shown = "models[0].plan.settings.find((one) => one.name === 'msaa').value";
    browser.until(&format!("{shown} === '{msaa}'"));
    browser.screenshot("held");
    browser.has_no_errors();

    // What the link saves opens from disk with the same frame, and needs no server.
    let link =
        browser.text("[...document.querySelectorAll('#live-tools a')].map((one) => one.getAttribute('href')).join()");
    assert_eq!(link, "frame.html,frame.html?sources=no");
    let place = Place::new();
    let saved = [("frame.html", true), ("frame.html?sources=no", false)].map(|(address, has_sources)| {
        let (status, bytes) = page.get(address);
        assert_eq!(status, 200);
        (place.file(format!("{has_sources}.html"), bytes), has_sources)
    });
    while_drawing(
        || drawn.show(&mut viewer),
        || {
            browser.click("#hold");
            browser.until(&format!("!live.state.program.held && live.state.program.frame > {stepped}"));
        },
    );
    drop(viewer);
    for (file, has_sources) in saved {
        browser.open_file(&file, "");
        assert_eq!(browser.text("state.view"), "saved");
        let said = browser.text("document.querySelector('#saved-frame').textContent");
        let summary = device.summary();
        for part in [&*format!("Frame {stepped} of forward on "), &summary.name, &summary.driver, " ms of the device"] {
            assert!(said.contains(part), "{said}");
        }
        assert!(browser.text(TEXELS) == texels, "another picture");
        assert_eq!(browser.text(shown), msaa);
        assert!(browser.count("models[0].times.frames") >= 1);
        browser.screenshot(&format!("saved-{has_sources}"));
        browser.click("#tab-overview");
        assert_eq!(browser.count("document.querySelector('.picture img').naturalWidth"), 64);
        browser.click("#tab-source");
        assert_eq!(browser.count("document.querySelectorAll('ol.source').length") > 0, has_sources);
        browser.has_no_errors();
        let text = std::fs::read_to_string(&file).expect("it is there");
        assert_eq!(text.contains("passes: ["), has_sources, "a text of the pipeline");
    }
}

#[test]
fn lv_1_a_program_saves_its_frames_and_the_last_one_of_a_device_that_is_lost() {
    let Some(device) = render::own_device() else { return };
    let place = Place::new();
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let mut drawn = Drawn::of(&device, "forward", [64, 48]);
    let never = viewer.save(&mut drawn.renderer, place.path("never.html"));
    assert!(matches!(never, Err(SaveError::NoFrame)), "{never:?}");
    drawn.draw().expect("drawn");
    viewer.leave_out_sources();
    viewer.save(&mut drawn.renderer, place.path("frame.html")).expect("saved");
    let text = std::fs::read_to_string(place.path("frame.html")).expect("it is there");
    assert!(text.contains("data:image/png;base64,") && !text.contains("passes: ["));
    let nowhere = viewer.save(&mut drawn.renderer, place.path("no such folder/frame.html"));
    assert!(matches!(nowhere, Err(SaveError::Write { .. })), "{nowhere:?}");

    let lost = place.path("lost");
    viewer.save_when_lost(&lost);
    drawn.show(&mut viewer);
    assert!(!lost.exists(), "nothing is lost yet");
    // An error of the user's loses no device.
    let setting = drawn.renderer.set("msaa", 3).expect_err("no value");
    assert_eq!(viewer.failed(&setting).expect("nothing is written"), None);

    // A frame of another renderer doesn't end in time: the device is given up.
    let mut slow = Drawn::of(&device, "forward", [1280, 720]);
    let mut options = framewright::RendererOptions::default();
    options.executor.timeout = Duration::from_nanos(1);
    slow.renderer = framewright::Renderer::open(&device, "forward", options).expect("a pipeline");
    slow.renderer.set_scene(&slow.scene);
    let error = (0..1000).find_map(|_| slow.draw().err()).expect("no device is as fast as that");
    let late = drawn.draw().expect_err("the device is lost");
    let written = viewer.failed(&late).expect("written").expect("a page");
    assert_eq!(viewer.failed(&error).expect("it is there").as_ref(), Some(&written), "one page");
    let names: Vec<_> = lost.read_dir().expect("a folder").map(|file| file.expect("a file").file_name()).collect();
    assert!(names.len() == 1 && names[0].to_string_lossy().starts_with("framewright-lost-"), "{names:?}");
    let Some(mut browser) = Browser::start() else { return };
    browser.open_file(&written, "");
    let said = browser.text("document.querySelector('#live-wrong').textContent");
    assert!(said.contains("The last frame that was shown: ") && said.contains(&late.to_string()), "{said}");
    assert_eq!(browser.count("document.querySelector('.outputs img').naturalWidth"), 64);
    browser.has_no_errors();
    drop((slow, drawn, device));
}

#[test]
fn lv_1_a_page_of_the_command_leaves_out_the_texts_of_files() {
    let place = Place::new();
    place.run(&["inspect", "forward", "--format", "html", "-o", "with.html"]).exits(0);
    place.run(&["inspect", "forward", "--format", "html", "--no-sources", "-o", "without.html"]).exits(0);
    place.run(&["inspect", "forward", "--no-sources"]).exits(2).mentions("`--no-sources` is about a page");
    let has_text = |name: &str| std::fs::read_to_string(place.path(name)).expect("written").contains("passes: [");
    assert_eq!((has_text("with.html"), has_text("without.html")), (true, false));
}
