//! `framewright attach` (LV-1): the page of a program is found, and what else answers is told apart.

use super::{Drawn, while_drawing};
use crate::testing::Place;
use framewright_tests::render;
use framewright_viewer::Viewer;
use serde_json::Value;
use std::io::{Read, Write, copy};
use std::net::{TcpListener, TcpStream};
use std::thread;

/// A server that answers every request with these words. It ends with the tests.
fn answers(answer: String) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let host = listener.local_addr().expect("an address").to_string();
    thread::spawn(move || {
        for stream in listener.incoming().map_while(Result::ok) {
            let mut stream = stream;
            drop(stream.read(&mut [0; 4096]));
            drop(stream.write_all(answer.as_bytes()));
        }
    });
    host
}

/// A tunnel to a server, at another port. It ends with the tests.
fn tunnel(to: String) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("an address").port();
    thread::spawn(move || {
        for here in listener.incoming().map_while(Result::ok) {
            let there = TcpStream::connect(&to).expect("it listens");
            let ways = [(&here, &there), (&there, &here)].map(|(from, to)| (from.try_clone(), to.try_clone()));
            for (from, to) in ways {
                let (mut from, mut to) = (from.expect("a clone"), to.expect("a clone"));
                thread::spawn(move || {
                    drop(copy(&mut from, &mut to));
                    drop(to.shutdown(std::net::Shutdown::Write));
                });
            }
        }
    });
    format!("localhost:{port}")
}

#[test]
fn lv_1_attach_finds_a_program_through_a_tunnel_too_and_saves_its_frame() {
    let Some(device) = render::device() else { return };
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let mut drawn = Drawn::of(device, "forward", [64, 48]);
    let (url, place) = (viewer.url(), Place::new());
    let (host, token) = url.trim_start_matches("http://").trim_end_matches('/').split_once('/').expect("an address");
    // To find a viewer no frame is needed.
    let shown = place.run(&["attach", &url, "--no-open"]).exits(0);
    assert_eq!((shown.out, shown.err), (format!("{url} shows the program\n"), String::new()));
    let through = format!("http://{}/{token}/", tunnel(host.to_owned()));
    let told = place.run(&["attach", &through, "--no-open", "--json"]).exits(0).out;
    let told: Value = serde_json::from_str(&told).expect("JSON");
    assert_eq!((&told["url"], &told["opened"], &told["saved"]), (&through.into(), &false.into(), &Value::Null));
    assert_eq!(told["version"], env!("CARGO_PKG_VERSION"));

    let save = ["attach", host, "--token", token, "--save", "frame.html", "--no-sources"];
    while_drawing(|| drawn.show(&mut viewer), || place.run(&save)).exits(0);
    let text = std::fs::read_to_string(place.path("frame.html")).expect("it is there");
    assert!(text.contains("data:image/png;base64,") && !text.contains("passes: ["));
    // A file that can't be written is told before anything is asked.
    place.run(&["attach", &url, "--save", "no such folder/frame.html"]).exits(3).mentions("no such folder");
}

/// The browser is the system's: here a program that notes what it is given.
#[cfg(target_os = "linux")]
#[test]
fn lv_1_attach_opens_the_browser_of_the_system() {
    use std::os::unix::fs::PermissionsExt;
    let viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let (url, place) = (viewer.url(), Place::new());
    let script = place.file("xdg-open", "#!/bin/sh\nprintf '%s' \"$1\" > opened.part\nmv opened.part opened\n");
    std::fs::set_permissions(&script, std::fs::Permissions::from_mode(0o755)).expect("set");
    let folder = place.path("").to_string_lossy().into_owned();
    let path = format!("{folder}:/usr/bin:/bin");
    place.run_with(&[("PATH", path.as_str())], &["attach", &url]).exits(0);
    while !place.path("opened").exists() {
        thread::yield_now();
    }
    assert_eq!(std::fs::read_to_string(place.path("opened")).expect("it is there"), url);
    std::fs::remove_file(script).expect("it is there");
    let none =
        place.run_with(&[("PATH", folder.as_str())], &["attach", &url]).exits(0).mentions("no browser can be opened");
    assert!(none.out.contains(&url), "{}", none.out);
}

#[test]
fn lv_1_attach_tells_what_is_no_viewer_and_one_of_another_version() {
    let place = Place::new();
    let viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let host = viewer.url().trim_start_matches("http://").split('/').next().expect("a host").to_owned();
    for secret in ["", "0123456789abcdef0123456789abcdef"] {
        let said = place.run(&["attach", &format!("http://{host}/{secret}"), "--no-open"]).exits(3);
        said.mentions("doesn't know the secret part of the address").mentions("ssh -L");
    }
    drop(viewer);
    let free = TcpListener::bind("127.0.0.1:0").expect("a port").local_addr().expect("an address").to_string();
    place.run(&["attach", &free, "--token", "0af3", "--no-open"]).exits(3).mentions("no viewer answers at http://");
    let head = "HTTP/1.1 200 OK\r\nConnection: close\r\n";
    for body in ["hello", "{\"server\": \"another\", \"version\": \"1\", \"format_version\": 1}", "[]"] {
        let other = answers(format!("{head}Content-Length: {}\r\n\r\n{body}", body.len()));
        place.run(&["attach", &other, "--no-open"]).exits(3).mentions("another program answers there");
    }
    let moved = answers("HTTP/1.1 302 Found\r\nLocation: http://127.0.0.1:1/\r\nContent-Length: 0\r\n\r\n".to_owned());
    place.run(&["attach", &moved, "--no-open"]).exits(3).mentions("no viewer answers");
    place.run(&["attach", &answers(String::new()), "--no-open"]).exits(3).mentions("no viewer answers");
    let newer = "{\"server\": \"framewright-viewer\", \"version\": \"9.9\\u001b[31m\", \"format_version\": 2}";
    let newer = answers(format!("{head}Content-Length: {}\r\n\r\n{newer}", newer.len()));
    let said = place.run(&["attach", &newer, "--no-open"]).exits(0).mentions("note: the program has Framewright 9.9");
    assert!(!said.err.contains('\u{1b}'), "{}", said.err);
    for (address, why) in [
        ("https://127.0.0.1:7117/0af3/", "plain HTTP"),
        ("127.0.0.1:99999", "port"),
        ("http://127.0.0.1:7117/a-b/", "letters and digits"),
        ("a b", "names no machine"),
    ] {
        place.run(&["attach", address, "--no-open"]).exits(2).mentions(why);
    }
    place.run(&["attach", "127.0.0.1", "--no-sources"]).exits(2);
}
