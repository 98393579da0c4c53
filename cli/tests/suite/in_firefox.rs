//! The pages in another browser than the one that they are built with: Debian's Firefox.

use crate::testing::firefox::Firefox;
use crate::testing::server::Server;
use crate::testing::{Place, Vulkan, repository};
use serde_json::json;

const CONTRAST: &str = include_str!("testing/contrast.js");

#[test]
fn lv_10_every_view_works_in_firefox() {
    let place = Place::new();
    place.run(&["inspect", "deferred", "--format", "html", "-o", "page.html"]).exits(0);
    let Some(mut firefox) = Firefox::start(true) else { return };
    firefox.open_file(&place.path("page.html"), "#view=graph&pass=lighting");
    assert_eq!(firefox.ask("getComputedStyle(document.body).backgroundColor"), "rgb(22, 24, 27)", "dark");
    assert_eq!(firefox.ask("state.selected"), "pass:lighting");
    for width in [400, 1280, 2560] {
        firefox.screen(width, 720);
        for view in firefox.ask("VIEWS.map((view) => view.name)").as_array().expect("views").clone() {
            let view = view.as_str().expect("a name");
            firefox.ask(&format!("document.getElementById('tab-{view}').click()"));
            assert_eq!(firefox.ask("document.querySelector('.view-panel:not([hidden])').id"), format!("view-{view}"));
            let over = firefox.ask("document.documentElement.scrollWidth - innerWidth").as_i64();
            assert!(over.is_some_and(|over| over <= 0), "{view}: {over:?} of {width} pixels too wide");
            if width == 1280 {
                assert_eq!(firefox.ask(CONTRAST.trim()), json!([]), "{view}");
            }
        }
    }
    // The keys of the page, and the browser's Back.
    firefox.ask("document.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }))");
    assert_ne!(firefox.ask("state.selected"), "pass:lighting");
    firefox.ask("history.back()");
    firefox.until("state.selected === 'pass:lighting'");
    firefox.has_no_errors();
}

#[test]
fn lv_10_the_live_page_works_in_firefox() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let Some(mut firefox) = Firefox::start(false) else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let scene = std::fs::read_to_string(repository("examples/scenes/spheres_and_cubes.ron")).expect("a scene");
    place.file("scene.ron", scene);
    let server = Server::start(&place, &variables, &["first.ron", "--scene", "scene.ron", "--size", "64x36"]);
    firefox.open(&server.address());
    firefox.until("live.state?.busy === false && document.querySelector('.outputs img')?.naturalWidth === 64");
    assert_eq!(firefox.ask("models[0].times !== null"), true);
    firefox.ask("choose({ set: { msaa: '1' } })");
    firefox.until("models[0].plan.settings.find((one) => one.name === 'msaa').value === '1'");
    assert_eq!(firefox.ask(CONTRAST.trim()), json!([]));
    firefox.has_no_errors();
}
