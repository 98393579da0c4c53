//! Strangers, slow ones and huge ones, and programs that don't play along (LV-1).

use super::{Drawn, Page, extent, status, while_drawing};
use crate::testing::browser::Browser;
use framewright_tests::render;
use framewright_viewer::Viewer;
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;

#[test]
fn lv_1_strangers_get_nothing_of_a_program_and_change_nothing() {
    let Some(device) = render::device() else { return };
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let page = Page::of(&viewer);
    let mut drawn = Drawn::of(device, "forward", [64, 48]);
    while_drawing(|| drawn.show(&mut viewer), || page.state(|state| state["page"].is_object()));
    let before = drawn.msaa();
    let (host, json) = (&page.host, "Content-Type: application/json\r\n");
    let other = if before == "4" { "2" } else { "4" };
    let choice = format!("{{\"set\": {{\"msaa\": \"{other}\"}}}}");
    for what in ["", "state/0", "frame.html", "about", "choose", "look", "picture/1/0.png"] {
        let method = if ["choose", "look"].contains(&what) { "POST" } else { "GET" };
        let body = match what {
            "choose" => &*choice,
            "look" => "{\"hold\": true}",
            _ => "",
        };
        for headers in [
            // A name that leads here.
            format!("Host: evil.example:80\r\n{json}"),
            format!("Host: 127.0.0.1.evil.example\r\n{json}"),
            // Another page.
            format!("Host: {host}\r\nOrigin: http://evil.example\r\n{json}"),
            format!("Host: {host}\r\nOrigin: null\r\n{json}"),
            format!("Host: {host}\r\nOrigin: https://{host}\r\n{json}"),
            // No host, and one that is no text.
            json.to_owned(),
            format!("Host: \u{e4}\r\n{json}"),
        ] {
            let (head, body) = page.ask_with(method, what, &headers, body);
            assert!([400, 403].contains(&status(&head)), "{method} {what} {headers}: {head}");
            assert!(body.len() < 100, "{what}");
        }
        // No secret, another one, and a part of it.
        for path in ["/", "/0123456789abcdef0123456789abcdef/", &page.path[..10], "//", "/../"] {
            let stranger = Page { host: host.clone(), path: path.to_owned() };
            let (head, _) = stranger.ask_with(method, what, &page.own(), body);
            assert!([400, 404].contains(&status(&head)), "{method} {path}{what}: {head}");
        }
    }
    // A form of another page can be sent without asking, but not as JSON.
    let (head, _) = page.ask_with("POST", "look", &format!("Host: {host}\r\nContent-Type: text/plain\r\n"), "\"step\"");
    assert_eq!(status(&head), 403);
    for (what, body) in [
        ("look", "{\"renderer\": -1}"),
        ("look", "{\"hold\": 1}"),
        ("look", "\"jump\""),
        ("look", "{\"hold\": true, \"renderer\": 1}"),
        ("choose", "{}"),
        ("look", ""),
    ] {
        assert_eq!(page.post(what, body), 400, "{what} {body}");
    }
    let state = while_drawing(|| drawn.show(&mut viewer), || page.state(|_| true));
    assert_eq!((drawn.msaa(), &state["live"]["program"]["held"]), (before, &false.into()));
}

#[test]
fn lv_1_slow_and_huge_requests_keep_nobody_from_the_page() {
    let viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let page = Page::of(&viewer);
    // As many connections as there may be, which begin a request and don't go on.
    let slow: Vec<TcpStream> = (0..80)
        .map(|_| {
            let mut stream = TcpStream::connect(&page.host).expect("it listens");
            stream.write_all(format!("GET {} HTTP/1.1\r\nHost: ", page.path).as_bytes()).expect("sent");
            stream
        })
        .collect();
    assert_eq!(page.get("about").0, 200);
    // They were given up.
    for mut stream in slow {
        let ended = stream.read(&mut [0; 1 << 10]);
        assert!(ended.as_ref().is_ok() || ended.is_err_and(|error| error.kind() == ErrorKind::ConnectionReset));
    }
    // A body that doesn't come.
    let mut waits = TcpStream::connect(&page.host).expect("it listens");
    let head = format!("POST {}look HTTP/1.1\r\n{}Content-Length: 6\r\n\r\n\"", page.path, page.own());
    waits.write_all(head.as_bytes()).expect("sent");
    let mut answer = [0; 64];
    let read = waits.read(&mut answer).expect("answered");
    assert_eq!(status(&String::from_utf8_lossy(&answer[..read])), 408);
    // More than anybody has to say.
    for what in ["choose", "look"] {
        assert_eq!(page.post(what, &format!("\"{}\"", "x".repeat(100_000))), 413, "{what}");
    }
    let long = "x".repeat(1 << 20);
    let (head, _) = page.ask_with("GET", "about", &format!("{}X: {long}\r\n", page.own()), "");
    assert!([0, 431].contains(&status(&head)), "{head}");
    let (head, _) = page.ask_with("GET", &long, &page.own(), "");
    assert!([0, 404, 414, 431].contains(&status(&head)), "{head}");
    assert_eq!(page.get("about").0, 200);
}

#[test]
fn lv_1_a_program_that_ends_no_frame_is_told_and_takes_no_more_choices_than_it_can_keep() {
    let viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let page = Page::of(&viewer);
    let sent: Vec<u16> = (0..300).map(|_| page.post("choose", "{\"set\": {\"msaa\": \"1\"}}")).collect();
    assert!(sent.starts_with(&[204; 256]) && sent[256..].iter().all(|status| *status == 503), "{sent:?}");
    assert_eq!(page.get("frame.html").0, 404);
    let Some(mut browser) = Browser::start() else { return };
    browser.open(&viewer.url());
    browser.until("document.querySelector('#live-status').textContent === 'The program has ended no frame yet.'");
}

#[test]
fn lv_1_a_plan_that_is_another_one_in_every_frame_is_shown_now_and_then() {
    let Some(device) = render::device() else { return };
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let page = Page::of(&viewer);
    let mut drawn = Drawn::of(device, "forward", [64, 48]);
    let (mut frames, mut turned) = (0_u64, 0_u32);
    let mut frame = || {
        turned += 1;
        drawn.renderer.set_extent([64 + turned % 8, 48]).expect("a size");
        drawn.size = [64 + turned % 8, 48];
        drawn.show(&mut viewer);
        frames += 1;
    };
    let states = while_drawing(&mut frame, || {
        let mut last = 0;
        let mut next = || {
            let state = page.state(|state| state["live"]["version"].as_u64() > Some(last));
            last = state["live"]["version"].as_u64().expect("a number");
            (last, extent(&state))
        };
        [next(), next(), next()]
    });
    assert!(states.iter().all(|(_, extent)| (64..72).contains(&extent[0]) && extent[1] == 48), "{states:?}");
    assert!(frames >= states[2].0, "{frames} frames and {states:?}");
}

#[test]
fn lv_1_a_page_of_another_version_says_so() {
    let (Some(mut browser), Some(device)) = (Browser::start(), render::device()) else { return };
    let mut viewer = Viewer::serve("127.0.0.1:0").expect("a port");
    let mut drawn = Drawn::of(device, "forward", [64, 48]);
    let url = viewer.url();
    while_drawing(
        || drawn.show(&mut viewer),
        || {
            browser.open(&url);
            browser.until("models.length === 1");
            // As a page that stayed open while its program was built anew.
            browser.ask("live.format = 99");
            browser.until("document.querySelector('#load-again') !== null");
            browser.click("#load-again");
            browser.until("document.querySelector('#load-again') === null && live.format === 1 && models.length === 1");
        },
    );
    browser.has_no_errors();
}
