//! `framewright serve` in a test: started, asked, and ended.

use super::Place;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// How long a state may take.
const PATIENCE: Duration = Duration::from_secs(120);

/// A server. It ends when this is dropped.
pub(crate) struct Server {
    pub(crate) process: Child,
    /// Such as `127.0.0.1:7117`.
    pub(crate) host: String,
    said: Receiver<String>,
}

impl Drop for Server {
    fn drop(&mut self) {
        drop(self.process.kill());
        drop(self.process.wait());
    }
}

impl Server {
    /// Starts one at a free port.
    pub(crate) fn start(place: &Place, variables: &[(&str, &str)], arguments: &[&str]) -> Server {
        let mut command = place.command(&[&["serve"], arguments, &["--port", "0"]].concat());
        command.envs(variables.iter().copied()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut process = command.spawn().expect("it starts");
        let mut first = String::new();
        BufReader::new(process.stdout.take().expect("piped")).read_line(&mut first).expect("a line");
        let host = first.split('/').nth(2).unwrap_or_else(|| panic!("`{first}` names no address")).to_owned();
        let errors = BufReader::new(process.stderr.take().expect("piped"));
        let (send, said) = channel();
        std::thread::spawn(move || errors.lines().map_while(Result::ok).for_each(|line| drop(send.send(line))));
        Server { process, host, said }
    }

    pub(crate) fn address(&self) -> String {
        format!("http://{}/", self.host)
    }

    /// The head and the body of the answer to a request; `headers` each end with a line break.
    pub(crate) fn ask(&self, request: &str, headers: &str, body: &str) -> (String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.host).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        let length = body.len();
        write!(stream, "{request} HTTP/1.1\r\n{headers}Connection: close\r\nContent-Length: {length}\r\n\r\n{body}")
            .expect("sent");
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("answered");
        let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").expect("a head");
        (String::from_utf8_lossy(&answer[..end]).into_owned(), answer[end + 4..].to_vec())
    }

    /// The headers of the server's own page.
    pub(crate) fn own(&self) -> String {
        format!("Host: {}\r\nOrigin: http://{}\r\nContent-Type: application/json\r\n", self.host, self.host)
    }

    /// The first state after `version` that isn't in the middle of drawing.
    pub(crate) fn state_after(&self, mut version: u64) -> Value {
        let begun = Instant::now();
        loop {
            let (head, body) = self.ask(&format!("GET /state/{version}"), &self.own(), "");
            assert!(begun.elapsed() < PATIENCE, "no state after {version}: {head}");
            if head.starts_with("HTTP/1.1 204") {
                continue;
            }
            let state: Value = serde_json::from_slice(&body).unwrap_or_else(|_| panic!("no state: {head}"));
            version = state["live"]["version"].as_u64().expect("a number");
            if state["live"]["busy"] == false {
                return state;
            }
        }
    }

    /// Lines with `text` that it has said on standard error, of those that weren't asked for before. Waits for `count` of them: what it
    /// says goes another way than its states, and may come later.
    pub(crate) fn said(&self, count: usize, text: &str) -> Vec<String> {
        let mut found = Vec::new();
        while found.len() < count {
            let line = self.said.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("only {found:?} with `{text}`"));
            found.extend(line.contains(text).then_some(line));
        }
        found.extend(self.said.try_iter().filter(|line| line.contains(text)));
        found
    }
}
