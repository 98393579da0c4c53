//! The page of a program in C (LV-1).

use crate::programs::{expected, program};
use crate::testing::Program;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};

/// Ends the program, also where the test fails.
struct Ends(Child);

impl Drop for Ends {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// The status and the body of an answer.
fn ask(url: &str, method: &str, what: &str, body: &str) -> (u16, Vec<u8>) {
    let (host, path) = url.trim_start_matches("http://").split_once('/').expect("an address");
    let mut stream = TcpStream::connect(host).expect("it listens");
    let length = body.len();
    write!(
        stream,
        "{method} /{path}{what} HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nContent-Length: {length}\r\n\
         Connection: close\r\n\r\n{body}"
    )
    .expect("sent");
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).expect("answered");
    let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").expect("a head");
    let head = String::from_utf8_lossy(&answer[..end]).into_owned();
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).expect("a status");
    (status, answer[end + 4..].to_vec())
}

/// The first state that holds.
fn state(url: &str, holds: impl Fn(&Value) -> bool) -> Value {
    let mut version = 0;
    for _ in 0..600 {
        let (status, body) = ask(url, "GET", &format!("state/{version}"), "");
        assert!(status == 200, "{status}: it ends frames");
        let state: Value = serde_json::from_slice(&body).expect("JSON");
        if holds(&state) {
            return state;
        }
        version = state["live"]["version"].as_u64().expect("a number");
    }
    panic!("no such state");
}

/// The value of `msaa` in the Plan that is shown.
fn msaa(state: &Value) -> Option<&str> {
    let settings = state["page"]["plans"][0]["whole"]["plan"]["settings"].as_array()?;
    settings.iter().find(|setting| setting["name"] == "msaa")?["value"].as_str()
}

/// A program that runs, and the address of its page.
fn started(program: &Program) -> (Ends, String) {
    let mut running = Ends(program.command(&[], &[]).stdout(Stdio::piped()).spawn().expect("it runs"));
    let mut url = String::new();
    BufReader::new(running.0.stdout.take().expect("piped")).read_line(&mut url).expect("a line");
    (running, url.trim().to_owned())
}

/// The step and pass are those that the program recorded, by the labels of the commands.
#[test]
fn lv_1_findings_of_validation_stand_in_the_page_at_their_step() {
    let Some(program) = program("framewright/c/tests/programs/findings.c") else { return };
    let (mut running, url) = started(&program);
    let found = |state: &Value| state["live"]["program"]["findings"].as_array().is_some_and(|found| !found.is_empty());
    let state = state(&url, found);
    let finding = &state["live"]["program"]["findings"][0];
    assert!(finding["rule"].as_str().is_some_and(|rule| rule.contains("vkCmdSetDepthBounds")), "{finding}");
    assert!(finding["at"].as_str().is_some_and(|at| at.starts_with("step 0: ") && at.contains("whole")), "{finding}");
    assert!(finding["text"].as_str().is_some_and(|text| !text.is_empty()) && finding["times"].as_u64() >= Some(1));
    std::fs::write(program.path("end"), "").expect("written");
    assert!(running.0.wait().expect("ended").success());
}

#[test]
fn lv_1_a_program_in_c_serves_its_page_and_takes_settings() {
    let Some(program) = program("framewright/c/tests/programs/watched.c") else { return };
    let (mut running, url) = started(&program);
    let url = &*url;

    let shown = state(url, |state| msaa(state).is_some());
    assert_eq!(shown["live"]["program"]["renderers"][0]["name"], "forward");
    assert_eq!(msaa(&shown), Some("4"));
    // The picture is the one that Rust draws. A later frame may have taken its place.
    let picture = (0..100).find_map(|_| {
        let shown = state(url, |_| true);
        let address = shown["live"]["outputs"][0]["picture"].as_str().expect("a picture").to_owned();
        let (status, png) = ask(url, "GET", &address, "");
        (status == 200).then_some(png)
    });
    let picture = image::load_from_memory(&picture.expect("a picture")).expect("a PNG file").to_rgb8();
    assert!(picture.into_raw() == expected(), "another picture");

    assert_eq!(ask(url, "POST", "choose", "{\"set\": {\"msaa\": \"1\"}}").0, 204);
    state(url, |state| msaa(state) == Some("1"));
    assert_eq!(ask(url, "POST", "choose", "{\"set\": {\"msaa\": \"3\"}}").0, 204);
    let refused = state(url, |state| state["live"]["mistakes"] != serde_json::json!([]));
    assert!(refused["live"]["message"].as_str().is_some_and(|text| text.contains("msaa")), "{}", refused["live"]);

    std::fs::write(program.path("end"), "").expect("written");
    assert!(running.0.wait().expect("ended").success());
    let host = url.trim_start_matches("http://").split('/').next().expect("a host");
    assert!(TcpStream::connect(host).is_err(), "its port is free");
}
