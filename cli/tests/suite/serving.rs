//! The live page: edits show, mistakes leave the last good frame, settings are turned in the page, and strangers are refused (IN-11).

use crate::captures::{FACE, LOOK, odd_pipelines};
use crate::testing::browser::Browser;
use crate::testing::server::Server;
use crate::testing::{Place, Vulkan, repository};
use framewright_tests::sweep;
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
    put(place, file, text.replacen(old, new, 1));
}

/// Puts a file in place of another at once, as careful editors do: a busy machine may see one that is half written.
fn put(place: &Place, file: &str, text: impl AsRef<[u8]>) {
    let beside = place.file("beside.txt", text);
    std::fs::rename(beside, place.path(file)).expect("moved");
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

    // A mistake of the scene stands in the scene, and the pipeline's text stays beside it.
    edit(&place, "scene.ron", "Scene(", "Scenery(");
    browser.until("document.querySelector('#live-wrong pre')?.textContent.includes('scene.ron:3')");
    browser.click("#live-wrong button.place");
    let files = "[...document.querySelectorAll('#view-source [data-file]')].map((one) => one.dataset.file).join()";
    assert_eq!(browser.text(files), "scene.ron,first.ron");
    let line = browser.text("document.querySelector('li:has(> .mistake)').textContent");
    assert!(line.starts_with("Scenery("), "{line}");
    edit(&place, "scene.ron", "Scenery(", "Scene(");
    browser.until("live.state.mistakes.length === 0 && live.state.busy === false");
    assert_eq!(browser.text(files), "first.ron");

    // A pipeline that is deleted, and comes back.
    let text = std::fs::read(place.path("first.ron")).expect("it is there");
    std::fs::remove_file(place.path("first.ron")).expect("removed");
    browser.until("document.querySelector('#live-wrong pre')?.textContent.includes('first')");
    put(&place, "first.ron", text);
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
    changes(&|| put(&place, "reinhard.frag", inverted), "a shader that stands before the shipped one");
    changes(&|| put(&place, "reinhard.frag", inverted.replace("1.0", "0.5")), "an edited shader");
    changes(&|| std::fs::remove_file(place.path("reinhard.frag")).expect("removed"), "the shipped shader again");
    assert_eq!(server.said(5, "drawn in").len(), 5, "one frame for an edit");

    // A scene that is gone for a while, as while an editor writes it.
    let gone = std::fs::read(place.path("scene.ron")).expect("it is there");
    std::fs::remove_file(place.path("scene.ron")).expect("removed");
    let missing = server.state_after(version(&state));
    assert!(missing["live"]["message"].as_str().expect("text").contains("there is no scene"), "{}", missing["live"]);
    put(&place, "scene.ron", gone);
    let back = server.state_after(version(&missing));
    assert_eq!(back["live"]["mistakes"], serde_json::json!([]), "{}", back["live"]["message"]);
}

#[cfg(unix)]
#[test]
fn a_folder_a_pipe_and_a_device_in_place_of_a_file_are_told_and_what_takes_their_place_is_read() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    let mut state = server.state_after(0);
    let make_pipe = |path: &std::path::Path| {
        assert!(std::process::Command::new("mkfifo").arg(path).status().expect("mkfifo").success());
    };
    type Make<'m> = &'m dyn Fn(&std::path::Path);
    let odd: [(&str, Make<'_>); 3] = [
        ("Is a directory", &|path| std::fs::create_dir(path).expect("made")),
        ("it is a pipe or a device", &make_pipe),
        ("it is a pipe or a device", &|path| std::os::unix::fs::symlink("/dev/zero", path).expect("linked")),
    ];
    for file in ["scene.ron", "first.ron"] {
        for (said, make) in &odd {
            let path = place.path(file);
            let contents = std::fs::read(&path).expect("it is there");
            std::fs::remove_file(&path).expect("removed");
            make(&path);
            let message = |state: &Value| state["live"]["message"].as_str().expect("text").to_owned();
            let mut wrong = server.state_after(version(&state));
            // It may have been seen while it was gone.
            while !message(&wrong).contains(said) {
                wrong = server.state_after(version(&wrong));
            }
            match std::fs::symlink_metadata(&path).expect("there").is_dir() {
                true => std::fs::remove_dir(&path).expect("removed"),
                false => std::fs::remove_file(&path).expect("removed"),
            }
            put(&place, file, contents);
            state = server.state_after(version(&wrong));
            while !message(&state).is_empty() {
                state = server.state_after(version(&state));
            }
        }
    }
}

#[test]
fn states_are_counted_and_numbers_of_another_server_are_answered_at_once() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    let state = server.state_after(0);
    let number = version(&state);
    assert!((1..10).contains(&number), "{number}");
    let named = state["live"]["server"].as_str().expect("a text");
    let asked = |address: &str| {
        let (head, body) = server.ask(&format!("GET /state/{address}"), &server.own(), "");
        assert!(head.starts_with("HTTP/1.1 200"), "{head}");
        version(&serde_json::from_slice(&body).expect("JSON"))
    };
    // What a browser knows that outlived a server at this address: lower numbers, higher ones, and the same.
    for known in [0, number - 1, number, number + 1, 1_796_000_000_000] {
        assert_eq!(asked(&format!("0123456789abcdef/{known}")), number);
    }
    assert_eq!(asked(&format!("{}", number + 5)), number);
    // Of its own it tells another state.
    edit(&place, "scene.ron", "Scene(", "Scenery(");
    assert!(asked(&format!("{named}/{number}")) > number);
}

#[test]
fn while_a_scene_is_wrong_each_edit_of_the_pipeline_is_looked_at_once() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let server = Server::start(&place, &variables, &SMALL);
    let first = server.state_after(0);
    edit(&place, "scene.ron", "Scene(", "Scenery(");
    let wrong = server.state_after(version(&first));
    let mistake = &wrong["live"]["mistakes"][0];
    assert_eq!((&mistake["file"], &mistake["line"]), (&"scene.ron".into(), &3.into()), "{}", wrong["live"]);
    assert_eq!(wrong["live"]["sources"][0]["name"], "scene.ron");
    edit(&place, "first.ron", "\"sky\", draw: Sky", "\"horizon\", draw: Sky");
    let still = server.state_after(version(&wrong));
    // Whatever is wrong here would be looked at again ten times a second.
    std::thread::sleep(std::time::Duration::from_secs(1));
    let later = server.state_after(0);
    assert!(version(&later) <= version(&still) + 2, "{} after {}", version(&later), version(&still));
    edit(&place, "scene.ron", "Scenery(", "Scene(");
    let good = server.state_after(version(&later));
    assert_eq!(good["live"]["mistakes"], serde_json::json!([]), "{}", good["live"]["message"]);
    assert!(good["page"].to_string().contains("horizon"));
}

#[test]
fn a_preset_of_the_page_goes_before_the_command_line_and_goes_with_its_file() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let low = "version: 1,\n    presets: [(name: \"low\", set: {\"msaa\": 1})],";
    edit(&place, "first.ron", "version: 1,", low);
    // What was wrong at the start is mended, and the preset of the command line is gone: no edit ends the command.
    edit(&place, "first.ron", "samples: \"msaa\"", "samples: \"msa\"");
    let server = Server::start(&place, &variables, &[&SMALL[..], &["--preset", "low", "--set", "msaa=4"]].concat());
    let wrong = server.state_after(0);
    let mended = std::fs::read_to_string(place.path("first.ron")).expect("it is there");
    let mended = mended.replace("\"msa\"", "\"msaa\"");
    put(&place, "first.ron", mended.replace("\"low\"", "\"least\""));
    let unknown = server.state_after(version(&wrong));
    assert!(
        unknown["live"]["message"].as_str().expect("text").contains("no preset named `low`"),
        "{}",
        unknown["live"]
    );
    put(&place, "first.ron", &mended);
    let good = server.state_after(version(&unknown));
    let msaa = |state: &Value| state["live"]["settings"][0]["value"].as_str().map(str::to_owned);
    assert_eq!(msaa(&good).as_deref(), Some("4"), "{}", good["live"]);
    server.ask("POST /choose", &server.own(), "{\"preset\": \"low\"}");
    let chosen = server.state_after(version(&good));
    assert_eq!((msaa(&chosen).as_deref(), &chosen["live"]["preset"]), (Some("1"), &"low".into()));
    server.ask("POST /choose", &server.own(), "{\"preset\": null}");
    let begun = server.state_after(version(&chosen));
    assert_eq!((msaa(&begun).as_deref(), &begun["live"]["preset"]), (Some("4"), &Value::Null));
}

#[test]
fn a_preset_that_the_file_loses_is_not_chosen_any_more() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    edit(&place, "first.ron", "version: 1,", "version: 1,\n    presets: [(name: \"low\", set: {\"msaa\": 1})],");
    let server = Server::start(&place, &variables, &SMALL);
    let first = server.state_after(0);
    server.ask("POST /choose", &server.own(), "{\"preset\": \"low\"}");
    let chosen = server.state_after(version(&first));
    assert_eq!(chosen["live"]["preset"], "low");
    edit(&place, "first.ron", "\"low\"", "\"least\"");
    let later = server.state_after(version(&chosen));
    assert_eq!((&later["live"]["preset"], &later["live"]["message"]), (&Value::Null, &"".into()));
}

#[test]
fn what_is_wrong_from_the_start_is_shown_at_its_place() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let Some(mut browser) = Browser::start() else { return };
    let place = begun();
    edit(&place, "first.ron", "samples: \"msaa\"", "samples: \"msa\"");
    let server = Server::start(&place, &variables, &SMALL);
    browser.open(&server.address());
    browser.until("document.querySelector('#live-wrong button.place') !== null");
    browser.click("#live-wrong button.place");
    let line = browser.text("document.querySelector('.view-panel:not([hidden]) li:has(> .mistake)').textContent");
    assert!(line.contains("samples: \"msa\"") && line.contains("did you mean `msaa`"), "{line}");
    // A setting may be called as a member that every object has.
    let text = std::fs::read_to_string(place.path("first.ron")).expect("it is there");
    put(&place, "first.ron", text.replace("\"msa\"", "\"constructor\"").replace("\"msaa\"", "\"constructor\""));
    browser.until("live.state.mistakes.length === 0 && live.state.busy === false");
    browser.click("#tab-live");
    assert_eq!(browser.text("document.querySelector('[data-setting=constructor]').value"), "4");
    assert_eq!(browser.count("document.querySelectorAll('.chosen, #as-begun').length"), 0);
    // A server that is gone is told, also to who chooses something.
    drop(server);
    browser.ask("choose({ set: { constructor: '1' } })");
    browser.until("document.querySelector('#live-status').textContent.includes(\"doesn't answer\")");
}

#[test]
fn a_pipeline_or_scene_that_is_not_there_ends_it_at_once() {
    let place = begun();
    for (arguments, what) in [
        (["serve", "frist.ron", "--scene", "scene.ron", "--port", "0"], "there is no pipeline `frist.ron`"),
        (["serve", "first.ron", "--scene", "secne.ron", "--port", "0"], "there is no scene `secne.ron`"),
    ] {
        let said = place.run(&arguments).exits(1).err;
        assert!(said.contains(what), "{said}");
    }
    // A wrong command line ends it too: no edit mends that.
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let port = ["--port", "0", "--set", "nope=1"];
    place.run_with(&variables, &[&["serve"], &SMALL[..], &port].concat()).exits(2).mentions("nope");
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
    // One that the pipeline never had is forgotten.
    let unknown = choose("{\"set\": {\"bogus\": \"1\"}}");
    assert_eq!(unknown["live"]["chosen"], serde_json::json!({"msaa": "1"}));
    // The file loses the setting: so does the choice.
    let text = std::fs::read_to_string(place.path("first.ron")).expect("it is there");
    let without =
        text.replace("(name: \"msaa\", value: OneOf(default: 4, of: [1, 2, 4])),", "").replace("\"msaa\"", "1");
    put(&place, "first.ron", without);
    let later = server.state_after(version(&unknown));
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

/// Faces of a cube one by one, depth whose stencil nobody touched, stencil, several samples with stencil.
#[test]
fn whatever_is_drawn_is_captured_and_served_and_what_is_left_out_is_said() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    for (name, text, captured, left_out) in odd_pipelines() {
        let place = Place::new();
        place.file("p.ron", text);
        place.file("face.frag", FACE);
        place.file("look.frag", LOOK);
        let shown = ["p.ron", "--scene", "spheres_and_cubes", "--size", "64x36", "--capture"];
        let server = Server::start(&place, &variables, &shown);
        let state = server.state_after(0);
        assert_eq!(
            (&state["live"]["mistakes"], &state["live"]["message"]),
            (&serde_json::json!([]), &"".into()),
            "{name}"
        );
        let captures = state["page"]["captures"].as_array().expect("a list");
        assert_eq!(captures.len(), captured.len(), "{name}: {captures:?}");
        for capture in captures {
            let address = format!("GET /{}", capture["file"].as_str().expect("an address"));
            let (head, png) = server.ask(&address, &server.own(), "");
            assert!(head.starts_with("HTTP/1.1 200") && png.starts_with(b"\x89PNG"), "{name}: {head}");
        }
        let said = server.said(usize::from(left_out.is_some()), "not captured");
        assert_eq!(said.len(), usize::from(left_out.is_some()), "{name}: {said:?}");
        assert!(left_out.is_none_or(|why| said[0].ends_with(why)), "{name}: {said:?}");
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
fn a_hundred_edits_take_no_more_memory_than_forty() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = begun();
    let small = ["first.ron", "--scene", "scene.ron", "--size", "16x9"];
    let mut server = Server::start(&place, &variables, &small);
    let mut state = server.state_after(0);
    let text = std::fs::read_to_string(place.path("first.ron")).expect("it is there");
    // Long, so that what is kept of it shows.
    let shader = |edit: u64| {
        let lines = (0..100).map(|line| format!("color += 0.01 * sin(color.yzxw * {line}.0 + {edit}.0);\n"));
        format!(
            "#version 450\nlayout(set = 0, binding = 0) uniform sampler2D source;\nlayout(location = 0) in vec2 uv;\n\
             layout(location = 0) out vec4 color;\nvoid main() {{\ncolor = texture(source, uv);\n{}}}\n",
            lines.collect::<String>()
        )
    };
    let edits = if sweep::is_long() { 1000 } else { 100 };
    let mut held = 0;
    for edit in 0..edits {
        // Other values, another graph, another shader, and a mistake by turns.
        match edit % 4 {
            0 => put(&place, "first.ron", text.replace("(0.0, 0.0, 0.0, 1.0)", &format!("(0.0, 0.0, {edit}.0, 1.0)"))),
            1 => put(&place, "first.ron", text.replace("default: 4", "default: 1")),
            2 => put(&place, "reinhard.frag", shader(edit)),
            _ => put(&place, "first.ron", text.replace("\"opaque\", draw", "\"opaque\", drew")),
        };
        state = server.state_after(version(&state));
        assert_eq!(state["live"]["mistakes"] == serde_json::json!([]), edit % 4 < 3, "{edit}: {}", state["live"]);
        if edit % 100 == 99 {
            println!("{} edits: {} KiB", edit + 1, resident(server.process.id()));
        }
        // By now there are as many pipelines as are kept.
        if edit == 40 {
            held = resident(server.process.id());
        }
    }
    let grown = resident(server.process.id()).saturating_sub(held);
    println!("{edits} edits: {held} KiB held after forty, {grown} KiB more at the end");
    // Of what is a moment old some stays: pages of the allocator, half used.
    assert!(grown < 20_000 + 10 * edits, "{grown} KiB more after {edits} edits");
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
