//! The live page: edits show, mistakes leave the last good frame, settings are turned in the page, and strangers are refused (IN-11).

use crate::testing::browser::Browser;
use crate::testing::server::Server;
use crate::testing::{Place, Vulkan, repository};
use serde_json::Value;
use std::path::Path;

const SMALL: [&str; 5] = ["first.ron", "--scene", "scene.ron", "--size", "64x36"];

/// A place with a pipeline and a scene of its own.
fn begun() -> Place {
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let scene = std::fs::read_to_string(repository("examples/scenes/spheres_and_cubes.ron")).expect("a scene");
    place.file("scene.ron", scene);
    place
}

/// Replaces a piece of text in a file.
fn edit(place: &Place, file: &str, old: &str, new: &str) {
    let text = std::fs::read_to_string(place.path(file)).expect("it is there");
    assert!(text.contains(old), "{file} has no `{old}`");
    place.file(file, text.replacen(old, new, 1));
}

fn version(state: &Value) -> u64 {
    state["live"]["version"].as_u64().expect("a number")
}

fn frame(state: &Value) -> u64 {
    state["live"]["frame"].as_u64().expect("a number")
}

/// The bytes of the picture of the first output.
fn picture(server: &Server, state: &Value) -> Vec<u8> {
    let address = state["live"]["outputs"][0]["picture"].as_str().expect("a picture");
    let (head, png) = server.ask(&format!("GET /{address}"), &server.own(), "");
    assert!(head.starts_with("HTTP/1.1 200"), "{head}");
    png
}

#[test]
fn the_page_follows_edits_shows_mistakes_at_their_lines_and_recovers() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let Some(mut browser) = Browser::start() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    browser.open(&server.address());
    let drawn = "live.state?.busy === false && document.querySelector('.outputs img')?.naturalWidth === 64";
    browser.until(drawn);
    assert_eq!(browser.text("location.protocol + state.view"), "http:live");
    let nodes = "models[0].nodes.map((node) => node.name).join()";
    assert_eq!(browser.text(nodes), "opaque,sky,resolve color,tone_map");
    browser.screenshot("live");

    // An edit: the graph changes where it is looked at, and the selection stays.
    browser.click("#tab-graph");
    browser.ask("select('pass:tone_map')");
    edit(&place, "first.ron", "\"sky\", draw: Sky", "\"horizon\", draw: Sky");
    browser.until("models[0].nodes.some((node) => node.name === 'horizon')");
    assert_eq!(browser.text("state.view + state.selected"), "graphpass:tone_map");
    assert_eq!(browser.count("document.querySelectorAll('#view-graph g[data-key]:not(.beside)').length"), 4);

    // A broken one: its message, its line, and the frame before.
    browser.until("live.state.busy === false");
    let before = browser.count("live.frame");
    edit(&place, "first.ron", "samples: \"msaa\"", "samples: \"msa\"");
    browser.until("document.querySelector('#live-wrong pre') !== null");
    assert_eq!(browser.count("live.frame"), before);
    assert!(browser.text("document.querySelector('#live-wrong pre').textContent").contains("first.ron:12:"));
    browser.click("#tab-live");
    assert_eq!(browser.ask("document.querySelector('.outputs img').naturalWidth"), 64);
    browser.screenshot("live-wrong");
    browser.click("#live-wrong button.place");
    assert_eq!(browser.text("state.view"), "source");
    let line = browser.text("document.querySelector('li:has(> .mistake)').textContent");
    assert!(line.contains("samples: \"msa\"") && line.contains("did you mean `msaa`"), "{line}");
    browser.screenshot("live-wrong-source");

    // A mended one.
    edit(&place, "first.ron", "samples: \"msa\"", "samples: \"msaa\"");
    browser.until("live.state.mistakes.length === 0 && live.state.busy === false");
    assert_eq!(browser.count("document.querySelectorAll('.mistake, #live-wrong pre').length"), 0);

    // A setting, turned in the page.
    browser.click("#tab-live");
    browser.ask("(() => { const choice = document.querySelector('[data-setting=msaa]'); choice.value = '1'; choice.dispatchEvent(new Event('change')); })()");
    browser.until("live.state.chosen.msaa === '1' && live.state.busy === false");
    assert_eq!(browser.text(nodes), "opaque,horizon,tone_map");
    assert_eq!(browser.text("document.querySelector('.chosen select').value"), "1");
    browser.click("#as-begun");
    browser.until("live.state.chosen.msaa === undefined && live.state.busy === false");
    assert_eq!(browser.text(nodes), "opaque,horizon,resolve color,tone_map");

    // A pipeline that is deleted, and comes back.
    let text = std::fs::read(place.path("first.ron")).expect("it is there");
    std::fs::remove_file(place.path("first.ron")).expect("removed");
    browser.until("document.querySelector('#live-wrong pre')?.textContent.includes('first')");
    place.file("first.ron", text);
    browser.until("live.state.mistakes.length === 0 && live.state.busy === false");
    browser.has_no_errors();
}

#[test]
fn scenes_shaders_and_files_that_were_missing_are_watched_too() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    let first = server.state_after(0);
    let drawn = picture(&server, &first);
    assert!(drawn.starts_with(b"\x89PNG"));

    let mut state = first.clone();
    let mut changes = |change: &dyn Fn(), what: &str| {
        let before = picture(&server, &state);
        change();
        let mut later = server.state_after(version(&state));
        // A change that is seen between two frames is a state of its own.
        while frame(&later) == frame(&state) {
            later = server.state_after(version(&later));
        }
        assert_eq!(later["live"]["mistakes"], serde_json::json!([]), "{what}");
        assert_ne!(picture(&server, &later), before, "{what}");
        state = later;
    };
    changes(&|| edit(&place, "scene.ron", "\"coral\", color: \"#dd5a3c\"", "\"coral\", color: \"#3cdd5a\""), "a scene");
    let inverted = "#version 450\nlayout(set = 0, binding = 0) uniform sampler2D source;\nlayout(location = 0) in vec2 uv;\n\
        layout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0) - texture(source, uv); }\n";
    changes(&|| drop(place.file("reinhard.frag", inverted)), "a shader that stands before the shipped one");
    changes(&|| drop(place.file("reinhard.frag", inverted.replace("1.0", "0.5"))), "an edited shader");
    changes(&|| std::fs::remove_file(place.path("reinhard.frag")).expect("removed"), "the shipped shader again");
    assert_eq!(server.said().iter().filter(|line| line.contains("drawn in")).count(), 5, "one frame for an edit");
}

#[test]
fn other_sites_other_hosts_and_other_machines_get_nothing() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    let own = format!("Host: {}\r\n", server.host);
    let json = "Content-Type: application/json\r\n";
    for (request, headers, body) in [
        ("GET /", "Host: example.com\r\n".to_owned(), ""),
        ("GET /state/0", "Host: example.com\r\n".to_owned(), ""),
        ("GET /state/0", format!("{own}Origin: http://example.com\r\n"), ""),
        ("POST /choose", format!("{own}{json}Origin: null\r\n"), "{\"set\":{}}"),
        ("POST /choose", format!("{own}Content-Type: text/plain\r\n"), "{\"set\":{}}"),
    ] {
        let (head, body) = server.ask(request, &headers, body);
        assert!(head.starts_with("HTTP/1.1 403"), "{request} {headers}: {head}");
        assert!(!String::from_utf8_lossy(&body).contains("live"), "{request} {headers}");
    }
    let (head, _) = server.ask("GET /", &own, "");
    for header in [
        "content-security-policy: frame-ancestors 'none'",
        "x-content-type-options: nosniff",
        "cache-control: no-store",
    ] {
        assert!(head.contains(header), "{head}");
    }
    for body in ["", "[]", "{\"set\": 1}", "{\"other\": {}}", &"x".repeat(100_000)] {
        let (head, _) = server.ask("POST /choose", &server.own(), body);
        assert!(head.starts_with("HTTP/1.1 4"), "{head}");
    }
    for path in ["/picture/../first.ron", "/picture/0/0.png", "/first.ron", "/state/x", "/state/-1"] {
        let (head, _) = server.ask(&format!("GET {path}"), &own, "");
        assert!(head.starts_with("HTTP/1.1 4"), "{path}: {head}");
    }
    // It listens on 127.0.0.1 alone.
    if let Ok(sockets) = std::fs::read_to_string("/proc/net/tcp") {
        let port: u16 = server.host.rsplit(':').next().and_then(|port| port.parse().ok()).expect("a port");
        let end = format!(":{port:04X}");
        let listening = sockets.lines().filter_map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            (words.get(3) == Some(&"0A")).then(|| words[1].to_owned())
        });
        let own: Vec<String> = listening.filter(|local| local.ends_with(&end)).collect();
        assert_eq!(own, [format!("0100007F{end}")]);
    }
}

#[test]
fn choices_that_are_wrong_or_no_longer_known_do_no_harm() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    let choose = |body: &str| {
        let before = server.state_after(0);
        let (head, _) = server.ask("POST /choose", &server.own(), body);
        assert!(head.starts_with("HTTP/1.1 204"), "{head}");
        server.state_after(version(&before))
    };
    let first = server.state_after(0);
    let wrong = choose("{\"set\": {\"msaa\": \"3\"}}");
    assert!(wrong["live"]["message"].as_str().expect("text").contains("msaa"), "{}", wrong["live"]);
    assert_eq!(frame(&wrong), frame(&first));
    let good = choose("{\"set\": {\"msaa\": \"1\"}}");
    assert_eq!(
        (good["live"]["message"].as_str(), good["live"]["settings"][0]["value"].as_str()),
        (Some(""), Some("1"))
    );
    // The file loses the setting: so does the choice.
    let text = std::fs::read_to_string(place.path("first.ron")).expect("it is there");
    let without =
        text.replace("(name: \"msaa\", value: OneOf(default: 4, of: [1, 2, 4])),", "").replace("\"msaa\"", "1");
    place.file("first.ron", without);
    let later = server.state_after(version(&good));
    assert_eq!(later["live"]["mistakes"], serde_json::json!([]), "{}", later["live"]["message"]);
    assert_eq!(later["live"]["chosen"], serde_json::json!({}));
}

#[test]
fn captures_are_drawn_and_served() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &[&SMALL[..], &["--capture"]].concat());
    let state = server.state_after(0);
    let captures = state["page"]["captures"].as_array().expect("a list");
    assert_eq!(captures.len(), 4, "{}", state["live"]);
    for capture in captures {
        let (head, png) =
            server.ask(&format!("GET /{}", capture["file"].as_str().expect("an address")), &server.own(), "");
        assert!(head.starts_with("HTTP/1.1 200") && png.starts_with(b"\x89PNG"), "{head}");
    }
}

#[test]
fn what_keeps_a_server_from_starting_is_said() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let taken = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = taken.local_addr().expect("an address").port().to_string();
    place
        .run_with(&variables, &[&["serve"], &SMALL[..], &["--port", &port]].concat())
        .exits(3)
        .mentions(&format!("the port {port} of 127.0.0.1 can't be used"))
        .mentions("--port");
    place.run(&["serve", "first.ron"]).exits(2).mentions("--scene");
    place.run_with(&variables, &[&["serve"], &SMALL[..], &["--port", "65536"]].concat()).exits(2);
    place.run_with(&variables, &[&["serve"], &SMALL[..], &["--device", "none"]].concat()).exits(3);
}

#[cfg(target_os = "linux")]
#[test]
fn a_hundred_edits_take_no_more_memory_than_ten() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let small = ["first.ron", "--scene", "scene.ron", "--size", "16x9"];
    let mut server = Server::start(&place, &variables, &small);
    let mut state = server.state_after(0);
    let text = std::fs::read_to_string(place.path("first.ron")).expect("it is there");
    let edits = std::env::var("FRAMEWRIGHT_LONG").map_or(100, |_| 1000);
    let mut held = 0;
    for edit in 0..edits {
        // Other values, another graph, and a mistake by turns.
        let changed = match edit % 3 {
            0 => text.replace("(0.0, 0.0, 0.0, 1.0)", &format!("(0.0, 0.0, {}.0, 1.0)", edit)),
            1 => text.replace("default: 4", "default: 1"),
            _ => text.replace("\"opaque\", draw", "\"opaque\", drew"),
        };
        place.file("first.ron", changed);
        state = server.state_after(version(&state));
        assert_eq!(state["live"]["mistakes"] == serde_json::json!([]), edit % 3 < 2, "{edit}: {}", state["live"]);
        if edit == 10 {
            held = resident(server.process.id());
        }
    }
    let grown = resident(server.process.id()).saturating_sub(held);
    println!("{edits} edits: {held} KiB held after ten, {grown} KiB more at the end");
    assert!(grown < 4096, "{grown} KiB more after {edits} edits");
    // Ctrl-C is how it ends.
    nix::sys::signal::kill(nix::unistd::Pid::from_raw(server.process.id() as i32), nix::sys::signal::Signal::SIGINT)
        .expect("sent");
    assert_eq!(server.process.wait().expect("ended").code(), Some(0));
}

/// KiB of memory that a process holds.
#[cfg(target_os = "linux")]
fn resident(process: u32) -> u64 {
    let status = std::fs::read_to_string(Path::new("/proc").join(process.to_string()).join("status")).expect("it runs");
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("a line");
    line.trim().trim_end_matches(" kB").parse().expect("a number")
}
