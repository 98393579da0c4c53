//! A real browser without a window, told what to do through its own debugging protocol.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tungstenite::{Message, WebSocket};

/// How long a page may take for anything.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);

/// The address that a browser says it listens at, after `words`.
pub(super) fn listening(process: &mut Child, words: &str) -> String {
    let mut lines = BufReader::new(process.stderr.take().expect("piped")).lines();
    let address = lines.find_map(|line| Some(line.ok()?.strip_prefix(words)?.to_owned()));
    std::thread::spawn(move || lines.for_each(drop));
    address.expect("the browser says where it listens")
}

/// A connection to the address of a browser.
pub(super) fn connected(address: &str) -> WebSocket<TcpStream> {
    let host = address.trim_start_matches("ws://").split('/').next().expect("a host");
    let stream = TcpStream::connect(host).expect("it listens");
    stream.set_read_timeout(Some(PATIENCE)).expect("set");
    tungstenite::client(address, stream).expect("it answers").0
}

/// A browser with one page. It ends when this is dropped.
pub(crate) struct Browser {
    process: Child,
    socket: WebSocket<TcpStream>,
    session: Value,
    last: u64,
    /// Errors of scripts and of the page, of policies too.
    errors: Vec<String>,
    _profile: tempfile::TempDir,
}

impl Drop for Browser {
    fn drop(&mut self) {
        drop(self.process.kill());
        drop(self.process.wait());
    }
}

impl Browser {
    /// Starts one; `None` where none is installed, which CI doesn't allow.
    pub(crate) fn start() -> Option<Browser> {
        Browser::start_with(&[])
    }

    /// The same with further options.
    pub(crate) fn start_with(options: &[&str]) -> Option<Browser> {
        let profile = tempfile::tempdir().expect("a folder");
        let mut command = Command::new("chromium");
        command.args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-port=0"]);
        command.args(["--no-first-run", "--disable-dev-shm-usage", "--window-size=1400,900"]).args(options);
        command.arg(format!("--user-data-dir={}", profile.path().display())).arg("about:blank");
        let started = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let Ok(mut process) = started else {
            assert!(std::env::var_os("CI").is_none(), "no browser: install the package chromium");
            println!("skipped: no browser (package chromium)");
            return None;
        };
        let socket = connected(&listening(&mut process, "DevTools listening on "));
        let mut browser =
            Browser { process, socket, session: Value::Null, last: 0, errors: Vec::new(), _profile: profile };
        let target = browser.call("Target.createTarget", &json!({"url": "about:blank"}))["targetId"].clone();
        let attached = browser.call("Target.attachToTarget", &json!({"targetId": target, "flatten": true}));
        browser.session = attached["sessionId"].clone();
        for domain in ["Page", "Runtime", "Log"] {
            browser.call(&format!("{domain}.enable"), &json!({}));
        }
        Some(browser)
    }

    /// Opens an address, and waits until it is loaded.
    pub(crate) fn open(&mut self, address: &str) {
        // An address that differs in its fragment alone would not be loaded again.
        self.call("Page.navigate", &json!({"url": "about:blank"}));
        self.errors.clear();
        let answer = self.call("Page.navigate", &json!({"url": address}));
        assert!(answer.get("errorText").is_none(), "{address}: {answer}");
        self.until("document.readyState === 'complete' && location.href !== 'about:blank'");
        self.settle();
    }

    /// Opens a file from disk, with a fragment.
    pub(crate) fn open_file(&mut self, file: &Path, fragment: &str) {
        self.open(&format!("file://{}{fragment}", file.display()));
    }

    /// Waits until two frames were drawn.
    pub(crate) fn settle(&mut self) {
        self.ask("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))");
    }

    /// Waits until an expression holds.
    #[track_caller]
    pub(crate) fn until(&mut self, expression: &str) {
        let begin = Instant::now();
        while self.ask(expression) != Value::Bool(true) {
            assert!(begin.elapsed() < PATIENCE, "never: {expression}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The value of an expression.
    #[track_caller]
    pub(crate) fn ask(&mut self, expression: &str) -> Value {
        let question = json!({"expression": expression, "returnByValue": true, "awaitPromise": true});
        let answer = self.call("Runtime.evaluate", &question);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// The number that an expression has.
    #[track_caller]
    pub(crate) fn count(&mut self, expression: &str) -> usize {
        let value = self.ask(expression);
        value.as_u64().unwrap_or_else(|| panic!("{expression} is {value}")).try_into().expect("fits")
    }

    /// The text that an expression has.
    #[track_caller]
    pub(crate) fn text(&mut self, expression: &str) -> String {
        let value = self.ask(expression);
        value.as_str().unwrap_or_else(|| panic!("{expression} is {value}")).to_owned()
    }

    /// Texts in sight that have less contrast than WCAG 2.2 wants at level AA, in words.
    #[track_caller]
    pub(crate) fn faint_texts(&mut self) -> Vec<String> {
        let found = self.ask(include_str!("contrast.js"));
        found.as_array().expect("a list").iter().map(ToString::to_string).collect()
    }

    /// Presses the mouse in the middle of the first element that a selector finds.
    #[track_caller]
    pub(crate) fn click(&mut self, selector: &str) {
        let found = json!(selector);
        let place = self.ask(&format!(
            "(() => {{ const box = document.querySelector({found})?.getBoundingClientRect(); \
             return box ? [box.x + box.width / 2, box.y + box.height / 2] : null; }})()"
        ));
        assert!(place.is_array(), "nothing is {selector}");
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({"type": kind, "x": place[0], "y": place[1], "button": "left", "clickCount": 1});
            self.call("Input.dispatchMouseEvent", &event);
        }
        self.settle();
    }

    /// Presses a key: a letter, or a name such as `ArrowRight`.
    pub(crate) fn press(&mut self, key: &str) {
        let mut down = json!({"type": "keyDown", "key": key, "code": key});
        if key.chars().count() == 1 {
            down["text"] = key.into();
        }
        self.call("Input.dispatchKeyEvent", &down);
        self.call("Input.dispatchKeyEvent", &json!({"type": "keyUp", "key": key, "code": key}));
        self.settle();
    }

    /// Makes the screen another: width, height, and whether it is dark.
    pub(crate) fn screen(&mut self, width: u32, height: u32, dark: bool) {
        let size = json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        self.call("Emulation.setDeviceMetricsOverride", &size);
        let scheme = if dark { "dark" } else { "light" };
        let features = json!({"features": [{"name": "prefers-color-scheme", "value": scheme}]});
        self.call("Emulation.setEmulatedMedia", &features);
        self.settle();
    }

    /// The page on paper, as the bytes of a PDF.
    pub(crate) fn printed(&mut self) -> Vec<u8> {
        self.decoded("Page.printToPDF")
    }

    /// Writes a picture of the page to the folder that `FRAMEWRIGHT_SCREENSHOTS` names, for people to look at.
    pub(crate) fn screenshot(&mut self, name: &str) {
        let Some(folder) = std::env::var_os("FRAMEWRIGHT_SCREENSHOTS") else { return };
        let picture = self.decoded("Page.captureScreenshot");
        let path = Path::new(&folder).join(format!("{name}.png"));
        std::fs::File::create(path).and_then(|mut file| file.write_all(&picture)).expect("written");
    }

    fn decoded(&mut self, method: &str) -> Vec<u8> {
        let answer = self.call(method, &json!({}));
        BASE64_STANDARD.decode(answer["data"].as_str().expect("data")).expect("base64")
    }

    /// Asserts that no script failed, and that the page's own policy had nothing to block.
    #[track_caller]
    pub(crate) fn has_no_errors(&mut self) {
        self.settle();
        assert!(self.errors.is_empty(), "{:#?}", self.errors);
    }

    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.last += 1;
        let mut message = json!({"id": self.last, "method": method, "params": parameters});
        if !self.session.is_null() {
            message["sessionId"] = self.session.clone();
        }
        self.socket.send(Message::text(message.to_string())).expect("sent");
        loop {
            let Message::Text(text) = self.socket.read().expect("it answers") else { continue };
            let answer: Value = serde_json::from_str(&text).expect("JSON");
            match answer["method"].as_str() {
                Some("Runtime.exceptionThrown") => self.errors.push(answer["params"].to_string()),
                Some("Log.entryAdded") if answer["params"]["entry"]["level"] == "error" => {
                    self.errors.push(answer["params"]["entry"].to_string());
                }
                _ => {}
            }
            if answer["id"] == self.last {
                assert!(answer.get("error").is_none(), "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }
}
