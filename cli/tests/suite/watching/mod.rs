//! A program in this process whose page is asked over plain HTTP: its frames are drawn while it is.

mod attaching;
mod attacks;
mod costs;
mod keeping;
mod reloading;
mod renderers;

use framewright::{Device, Renderer, RendererOptions, Scene, SceneDrawSource, load_scene};
use framewright_viewer::Viewer;
use serde_json::Value;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::thread;

/// A renderer with its scene.
struct Drawn {
    renderer: Renderer,
    scene: Scene,
    size: [u32; 2],
}

impl Drawn {
    fn of(device: &Device, pipeline: impl AsRef<Path>, size: [u32; 2]) -> Drawn {
        let scene = load_scene("spheres_and_cubes").expect("it is shipped");
        let mut options = RendererOptions::default();
        options.executor.timestamps = true;
        let mut renderer = Renderer::open(device, pipeline, options).expect("a pipeline");
        renderer.set_scene(&scene);
        renderer.set_extent(size).expect("a size");
        Drawn { renderer, scene, size }
    }

    /// Draws a frame.
    fn draw(&mut self) -> Result<u64, framewright::Error> {
        let device = self.renderer.device().clone();
        let plan = self.renderer.prepare()?.plan;
        let mut objects = SceneDrawSource::for_plan(&device, &self.scene, self.size, plan)?;
        self.renderer.frame(&mut objects)
    }

    /// Draws a frame, and shows it.
    fn show(&mut self, viewer: &mut Viewer) {
        self.draw().expect("drawn");
        viewer.frame(&mut self.renderer).expect("shown");
    }

    /// The value of `msaa` in its Plan.
    fn msaa(&self) -> String {
        let settings = self.renderer.plan().map(|plan| plan.settings.clone()).unwrap_or_default();
        let found = settings.iter().find(|setting| *setting.name == *"msaa").map(|setting| setting.value.to_string());
        found.expect("a setting")
    }
}

/// The answer to a question that another thread asks while `frame` is called again and again.
fn while_drawing<T: Send>(mut frame: impl FnMut(), question: impl FnOnce() -> T + Send) -> T {
    thread::scope(|threads| {
        let asked = threads.spawn(question);
        while !asked.is_finished() {
            frame();
        }
        asked.join().expect("no panic")
    })
}

/// The page of a viewer, asked over plain HTTP.
struct Page {
    /// Such as `127.0.0.1:7117`.
    host: String,
    /// The secret part, between slashes.
    path: String,
}

impl Page {
    fn of(viewer: &Viewer) -> Page {
        Page::at(&viewer.url())
    }

    fn at(url: &str) -> Page {
        let (host, path) = url.trim_start_matches("http://").split_once('/').expect("an address");
        Page { host: host.to_owned(), path: format!("/{path}") }
    }

    /// The head and the body of an answer; `headers` each end with a line break, and name the host.
    fn ask_with(&self, method: &str, what: &str, headers: &str, body: &str) -> (String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.host).expect("it listens");
        let (path, length) = (&self.path, body.len());
        let request = format!(
            "{method} {path}{what} HTTP/1.1\r\n{headers}Content-Length: {length}\r\nConnection: close\r\n\r\n{body}"
        );
        // What is refused may be answered before it is read.
        drop(stream.write_all(request.as_bytes()));
        let mut answer = Vec::new();
        drop(stream.read_to_end(&mut answer));
        let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").unwrap_or(answer.len());
        let head = String::from_utf8_lossy(&answer[..end]).into_owned();
        (head, answer.get(end + 4..).unwrap_or_default().to_vec())
    }

    fn get(&self, what: &str) -> (u16, Vec<u8>) {
        let (head, body) = self.ask_with("GET", what, &self.own(), "");
        (status(&head), body)
    }

    fn post(&self, what: &str, body: &str) -> u16 {
        status(&self.ask_with("POST", what, &self.own(), body).0)
    }

    /// The headers of its own page.
    fn own(&self) -> String {
        let host = &self.host;
        format!("Host: {host}\r\nOrigin: http://{host}\r\nContent-Type: application/json\r\n")
    }

    /// The first state that holds.
    fn state(&self, holds: impl Fn(&Value) -> bool) -> Value {
        let mut version = 0;
        for _ in 0..1000 {
            let (status, body) = self.get(&format!("state/{version}"));
            assert!(status == 200, "{status} after the state {version}");
            let state: Value = serde_json::from_slice(&body).expect("JSON");
            if holds(&state) {
                return state;
            }
            version = state["live"]["version"].as_u64().expect("a number");
        }
        panic!("there was no such state");
    }
}

/// The number of an answer's status; 0 where there is none.
fn status(head: &str) -> u16 {
    head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0)
}

/// Width and height of the Plan that a state shows.
fn extent(state: &Value) -> [u64; 2] {
    let extent = &state["page"]["plans"][0]["whole"]["plan"]["extent"];
    [0, 1].map(|at| extent[at].as_u64().unwrap_or_default())
}

/// The names of the renderers that a state tells of.
fn names(state: &Value) -> Vec<&str> {
    let renderers = state["live"]["program"]["renderers"].as_array().map(Vec::as_slice).unwrap_or_default();
    renderers.iter().filter_map(|one| one["name"].as_str()).collect()
}
