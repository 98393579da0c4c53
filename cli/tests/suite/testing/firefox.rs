//! Firefox without a window, told what to do through WebDriver BiDi.

use super::browser::{PATIENCE, connected, listening};
use serde_json::{Value, json};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use tungstenite::{Message, WebSocket};

/// A Firefox with one page. It ends when this is dropped.
pub(crate) struct Firefox {
    process: Child,
    socket: WebSocket<TcpStream>,
    context: Value,
    last: u64,
    /// What scripts and the page reported as errors.
    errors: Vec<String>,
    _profile: tempfile::TempDir,
}

impl Drop for Firefox {
    fn drop(&mut self) {
        drop(self.process.kill());
        drop(self.process.wait());
    }
}

impl Firefox {
    /// Starts one that likes dark pages, or light ones; `None` where none is installed, which CI doesn't allow.
    pub(crate) fn start(dark: bool) -> Option<Firefox> {
        let profile = tempfile::tempdir().expect("a folder");
        let scheme = if dark { 0 } else { 1 };
        let preferences = format!("user_pref(\"layout.css.prefers-color-scheme.content-override\", {scheme});\n");
        std::fs::write(profile.path().join("user.js"), preferences).expect("written");
        let mut command = Command::new("firefox-esr");
        command.args(["--headless", "--remote-debugging-port=0", "--no-remote", "--profile"]).arg(profile.path());
        let started = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let Ok(mut process) = started else {
            assert!(std::env::var_os("CI").is_none(), "no Firefox: install the package firefox-esr");
            println!("skipped: no Firefox (package firefox-esr)");
            return None;
        };
        let address = listening(&mut process, "WebDriver BiDi listening on ");
        let socket = connected(&format!("{address}/session"));
        let mut firefox =
            Firefox { process, socket, context: Value::Null, last: 0, errors: Vec::new(), _profile: profile };
        firefox.call("session.new", &json!({"capabilities": {}}));
        firefox.call("session.subscribe", &json!({"events": ["log.entryAdded"]}));
        firefox.context = firefox.call("browsingContext.getTree", &json!({}))["contexts"][0]["context"].clone();
        Some(firefox)
    }

    /// Opens an address, and waits until it is loaded.
    pub(crate) fn open(&mut self, address: &str) {
        let context = self.context.clone();
        self.call("browsingContext.navigate", &json!({"context": context, "url": address, "wait": "complete"}));
    }

    /// Opens a file from disk, with a fragment.
    pub(crate) fn open_file(&mut self, file: &Path, fragment: &str) {
        self.open(&format!("file://{}{fragment}", file.display()));
    }

    /// Makes the page another size.
    pub(crate) fn screen(&mut self, width: u32, height: u32) {
        let context = self.context.clone();
        let size = json!({"width": width, "height": height});
        self.call("browsingContext.setViewport", &json!({"context": context, "viewport": size}));
    }

    /// The value of an expression.
    #[track_caller]
    pub(crate) fn ask(&mut self, expression: &str) -> Value {
        let expression = format!("(async () => JSON.stringify(await ({expression}) ?? null))()");
        let target = json!({"context": self.context});
        let question = json!({"expression": expression, "target": target, "awaitPromise": true});
        let answer = self.call("script.evaluate", &question);
        assert_eq!(answer["type"], "success", "{expression}: {answer}");
        serde_json::from_str(answer["result"]["value"].as_str().expect("a text")).expect("JSON")
    }

    /// Waits until an expression holds.
    #[track_caller]
    pub(crate) fn until(&mut self, expression: &str) {
        let begin = std::time::Instant::now();
        while self.ask(expression) != Value::Bool(true) {
            assert!(begin.elapsed() < PATIENCE, "never: {expression}");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
    }

    /// Asserts that no script failed, and that the page's own policy had nothing to block.
    #[track_caller]
    pub(crate) fn has_no_errors(&mut self) {
        self.ask("1");
        assert!(self.errors.is_empty(), "{:#?}", self.errors);
    }

    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.last += 1;
        let message = json!({"id": self.last, "method": method, "params": parameters});
        self.socket.send(Message::text(message.to_string())).expect("sent");
        loop {
            let Message::Text(text) = self.socket.read().expect("it answers") else { continue };
            let answer: Value = serde_json::from_str(&text).expect("JSON");
            if answer["method"] == "log.entryAdded" && answer["params"]["level"] == "error" {
                self.errors.push(answer["params"].to_string());
            }
            if answer["id"] == self.last {
                assert_eq!(answer["type"], "success", "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }
}
