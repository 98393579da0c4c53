//! What hot reload says in a program (LV-1): mistakes at their lines, until they are mended.

use super::{Drawn, Page, while_drawing};
use crate::testing::Place;
use crate::testing::browser::Browser;
use framewright_tests::render;
use framewright_viewer::Viewer;

#[test]
fn lv_1_mistakes_of_a_reload_stand_at_their_lines_in_the_page() {
    let (Some(mut browser), Some(device)) = (Browser::start(), render::device()) else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let file = place.path("first.ron");
    let text = std::fs::read_to_string(&file).expect("it is there");
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let page = Page::of(&viewer);
    let mut drawn = Drawn::of(device, &file, [64, 48]);
    let wrong = text.replace("samples: \"msaa\"", "samples: \"msa\"");
    assert_ne!(wrong, text);
    while_drawing(|| drawn.show(&mut viewer), || page.state(|state| state["page"].is_object()));

    std::fs::write(&file, wrong).expect("written");
    drawn.renderer.reload().expect_err("a mistake");
    let url = viewer.url();
    while_drawing(
        || drawn.show(&mut viewer),
        || {
            browser.open(&url);
            browser.until("document.querySelector('#live-wrong button.place') !== null");
            browser.click("#live-wrong button.place");
            let line =
                browser.text("document.querySelector('.view-panel:not([hidden]) li:has(> .mistake)').textContent");
            assert!(line.contains("samples: \"msa\"") && line.contains("did you mean `msaa`"), "{line}");
        },
    );
    // The last good frame is drawn, and an error that has no place is told too.
    std::fs::remove_file(&file).expect("it is there");
    drawn.renderer.reload().expect_err("no file");
    let state = while_drawing(
        || drawn.show(&mut viewer),
        || {
            page.state(|state| {
                state["live"]["message"].as_str().is_some_and(|text| {
                    text.contains("first.ron` can't be read") || text.contains("there is no pipeline")
                })
            })
        },
    );
    assert_eq!(state["live"]["mistakes"].as_array().map(Vec::len), Some(1));

    std::fs::write(&file, &text).expect("written");
    drawn.renderer.reload().expect("mended");
    while_drawing(
        || drawn.show(&mut viewer),
        || {
            browser
                .until("live.state.mistakes.length === 0 && document.querySelector('#live-wrong').textContent === ''");
        },
    );
    browser.has_no_errors();
}
