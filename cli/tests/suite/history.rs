//! The last states of the live page: listed, compared, and taken again (LV-9).

use crate::testing::browser::Browser;
use crate::testing::server::Server;
use crate::testing::{Place, Vulkan, repository};
use serde_json::Value;

const SMALL: [&str; 5] = ["first.ron", "--scene", "scene.ron", "--size", "64x36"];

/// A place with a pipeline and a scene of its own.
fn begun() -> Place {
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let scene = std::fs::read_to_string(repository("examples/scenes/spheres_and_cubes.ron")).expect("a scene");
    place.file("scene.ron", scene);
    place
}

/// Replaces a piece of text in a file, in one step.
fn edit(place: &Place, file: &str, old: &str, new: &str) {
    let text = std::fs::read_to_string(place.path(file)).expect("it is there");
    assert!(text.contains(old), "{file} has no `{old}`");
    let beside = place.file("beside.txt", text.replacen(old, new, 1));
    std::fs::rename(beside, place.path(file)).expect("moved");
}

fn version(state: &Value) -> u64 {
    state["live"]["version"].as_u64().expect("a number")
}

/// The next state, which has another frame.
fn after(server: &Server, state: &Value, change: impl FnOnce()) -> Value {
    change();
    let mut later = server.state_after(version(state));
    while later["live"]["frame"] == state["live"]["frame"] {
        later = server.state_after(version(&later));
    }
    later
}

#[test]
fn lv_9_states_tell_what_changed_and_any_two_are_compared() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    let first = server.state_after(0);
    let choose = |body: &str| {
        let (head, _) = server.ask("POST /choose", &server.own(), body);
        assert!(head.starts_with("HTTP/1.1 204"), "{head}");
    };
    let edited = after(&server, &first, || edit(&place, "first.ron", "\"sky\", draw: Sky", "\"horizon\", draw: Sky"));
    let turned = after(&server, &edited, || choose("{\"set\": {\"msaa\": \"1\"}}"));
    // A frame that is wrong is no state, and what was edited meanwhile counts for the next.
    edit(&place, "scene.ron", "Scene(", "Scenery(");
    let wrong = server.state_after(version(&turned));
    assert_eq!(wrong["history"], turned["history"], "{}", wrong["live"]["message"]);
    let mended = after(&server, &wrong, || edit(&place, "scene.ron", "Scenery(", "Scene("));
    let history = mended["history"].as_array().expect("a list");
    let changed: Vec<&Value> = history.iter().map(|state| &state["changed"]).collect();
    let told = |words: &[&str]| serde_json::json!(words);
    assert_eq!(
        changed,
        [&told(&["the first frame"]), &told(&["first.ron"]), &told(&["msaa: 4 → 1"]), &told(&["scene.ron"])]
    );
    assert!(history.iter().all(|state| state["milliseconds"].as_f64() > Some(0.0)), "{history:?}");

    // Earlier pictures stay.
    let number = |at: usize| history[at]["version"].as_u64().expect("a number");
    for state in history {
        let address = state["pictures"][0].as_str().expect("a picture");
        let (head, png) = server.ask(&format!("GET /{address}"), &server.own(), "");
        assert!(head.starts_with("HTTP/1.1 200") && png.starts_with(b"\x89PNG"), "{address}: {head}");
    }
    let (head, body) = server.ask(&format!("GET /compare/{}/{}", number(0), number(2)), &server.own(), "");
    assert!(head.starts_with("HTTP/1.1 200"), "{head}");
    let compared: Value = serde_json::from_slice(&body).expect("JSON");
    let names = |plan: usize| {
        let nodes = compared["plans"][plan]["whole"]["nodes"].as_array().expect("nodes");
        nodes.iter().map(|node| node["name"].as_str().expect("a name")).collect::<Vec<_>>().join(",")
    };
    assert_eq!((&*names(0), &*names(1)), ("opaque,sky,resolve color,tone_map", "opaque,horizon,tone_map"));
    assert_eq!(compared["sides"][1]["chosen"]["msaa"], "1");
    for (address, status) in [("compare/1/99999", "404"), ("compare/a/1", "400"), ("compare/1", "404")] {
        let (head, _) = server.ask(&format!("GET /{address}"), &server.own(), "");
        assert!(head.starts_with(&format!("HTTP/1.1 {status}")), "{address}: {head}");
    }
    let foreign = "Host: example.com\r\n";
    let (head, _) = server.ask(&format!("GET /compare/{}/{}", number(0), number(2)), foreign, "");
    assert!(head.starts_with("HTTP/1.1 403"), "{head}");

    // The settings of a state are taken again, and nothing else that was chosen since.
    choose("{\"exactly\": {\"preset\": null, \"set\": {}}}");
    let undone = after(&server, &mended, || ());
    assert_eq!(undone["live"]["chosen"], serde_json::json!({}));
    assert_eq!(undone["history"][4]["changed"], told(&["msaa: 1 → 4"]));
    let (head, _) = server.ask("POST /choose", &server.own(), "{\"exactly\": {\"other\": 1}}");
    assert!(head.starts_with("HTTP/1.1 400"), "{head}");
}

#[test]
fn lv_9_the_page_lists_states_compares_two_side_by_side_and_undoes_settings() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let Some(mut browser) = Browser::start() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    browser.open(&server.address());
    browser.until("live.state?.busy === false && past.states.length === 1");
    browser.click("#tab-history");
    assert_eq!(browser.ask("document.querySelector('#compare').disabled"), true);
    browser.ask("choose({ set: { msaa: '1' } })");
    browser.until("past.states.length === 2 && live.state.busy === false");
    let row = "document.querySelector('#view-history tbody tr').textContent";
    let shown = browser.text(row);
    assert!(shown.contains("msaa: 4 → 1") && shown.contains(" ms") && shown.contains("msaa=1"), "{shown}");
    assert_eq!(browser.count("document.querySelectorAll('#view-history tbody img').length"), 2);
    browser.until("[...document.querySelectorAll('#view-history tbody img')].every((one) => one.naturalWidth === 64)");
    browser.screenshot("history");

    browser.click("#compare");
    browser.until("models.length === 2 && state.view === 'differences'");
    let sides = browser.text("document.querySelector('#view-differences').textContent");
    assert!(sides.contains("msaa=1") && sides.contains(" of the device"), "{sides}");
    assert_eq!(browser.count("document.querySelectorAll('#view-differences .sides img').length"), 2);
    browser.until("[...document.querySelectorAll('.sides img')].every((one) => one.naturalWidth === 64)");
    browser.click("#tab-graph");
    assert_eq!(browser.count("document.querySelectorAll('#view-graph section').length"), 2);
    browser.screenshot("history-compared");

    // A newer frame doesn't take the comparison away.
    edit(&place, "first.ron", "\"sky\", draw: Sky", "\"horizon\", draw: Sky");
    browser.until("past.states.length === 3 && live.state.busy === false");
    assert_eq!(browser.count("models.length"), 2);
    browser.click("#newest");
    assert_eq!(browser.count("models.length"), 1);
    assert_eq!(browser.text("models[0].nodes.map((node) => node.name).join()"), "opaque,horizon,tone_map");
    assert_eq!(browser.text("state.view"), "history");
    browser.click("#undo");
    browser.until("past.states.length === 4 && live.state.busy === false");
    assert_eq!(
        browser.text("models[0].nodes.map((node) => node.name).join()"),
        "opaque,horizon,resolve color,tone_map"
    );
    assert_eq!(browser.count("Object.keys(live.state.chosen).length"), 0);
    browser.has_no_errors();
}
