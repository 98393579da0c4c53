//! The page of a running program (LV-1, LV-2): it shows the program's own Plan, times and pictures, and its settings are the program's.

use crate::testing::browser::Browser;
use framewright::{Device, Renderer, RendererOptions, SceneDrawSource, load_scene};
use framewright_tests::render;
use framewright_viewer::Viewer;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::Duration;

/// What a program tells of itself when it ends.
struct Ended {
    /// The texels of its last picture.
    texels: Vec<u8>,
    /// The value of `msaa` in its last Plan.
    msaa: String,
}

/// A program that draws frame after frame until `end` is set, with a viewer. It tells the address of its page.
fn program(device: &Device, url: &mpsc::Sender<String>, end: &AtomicBool) -> Result<Ended, Box<dyn std::error::Error>> {
    let scene = load_scene("spheres_and_cubes")?;
    let mut options = RendererOptions::default();
    options.executor.timestamps = true;
    let mut renderer = Renderer::open(device, "forward", options)?;
    renderer.set_scene(&scene);
    renderer.set_extent([64, 48])?;
    let mut viewer = Viewer::serve("127.0.0.1:0")?;
    url.send(viewer.url())?;
    while !end.load(Ordering::Relaxed) {
        let plan = renderer.prepare()?.plan;
        let mut objects = SceneDrawSource::for_plan(device, &scene, [64, 48], plan)?;
        renderer.frame(&mut objects)?;
        viewer.frame(&mut renderer)?;
    }
    let settings = renderer.plan().map(|plan| plan.settings.clone()).unwrap_or_default();
    let msaa = settings.iter().find(|setting| *setting.name == *"msaa").map(|setting| setting.value.clone());
    Ok(Ended { texels: renderer.read("screen")?.bytes, msaa: msaa.unwrap_or_default() })
}

/// Ends the program, also where the test fails.
struct Ends<'e>(&'e AtomicBool);

impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// The first line of the answer to a request.
fn answered(url: &str, request: &str) -> String {
    let host = url.trim_start_matches("http://").split('/').next().expect("a host");
    let mut stream = TcpStream::connect(host).expect("it listens");
    stream.write_all(request.as_bytes()).expect("sent");
    let mut answer = String::new();
    drop(stream.read_to_string(&mut answer));
    answer.lines().next().unwrap_or_default().to_owned()
}

#[test]
fn lv_1_a_running_program_shows_its_plan_times_and_pictures_and_takes_settings() {
    let (Some(mut browser), Some(device)) = (Browser::start(), render::device()) else { return };
    let end = AtomicBool::new(false);
    let (send, url) = mpsc::channel();
    let (ended, shown, host) = std::thread::scope(|threads| {
        let ends = Ends(&end);
        let running = threads.spawn(|| program(device, &send, &end).map_err(|error| error.to_string()));
        let url = url.recv().expect("the program is there");
        browser.open(&url);
        browser.until("models.length === 1 && models[0].times !== null");
        assert_eq!(browser.text("models[0].name"), "forward");
        assert!(browser.count("models[0].times.frames") >= 1);
        browser.click("#tab-overview");
        let unit = "[...document.querySelectorAll('#view-overview .unit')].at(-1).textContent";
        assert_eq!(browser.text(unit), "of the device");
        // A setting that is turned in the page is the program's from its next frame on.
        let before = browser.text("models[0].plan.settings.find((one) => one.name === 'msaa').value");
        let value = if before == "4" { "2" } else { "4" };
        browser.ask(&format!("choose({{ set: {{ msaa: '{value}' }} }})"));
        browser.until(&format!("models[0].plan.settings.find((one) => one.name === 'msaa').value === '{value}'"));
        // One that the pipeline refuses changes nothing, and is told.
        browser.ask("choose({ set: { msaa: '3' } })");
        browser.until("live.state.mistakes.length === 1");
        // The picture holds the texels of the program's output.
        let pixel = "(async () => { const image = new Image(); image.src = live.state.outputs[0].picture; await image.decode(); \
            const canvas = new OffscreenCanvas(64, 48); const context = canvas.getContext('2d'); context.drawImage(image, 0, 0); \
            return [...context.getImageData(0, 0, 64, 48).data].join(); })()";
        let shown = browser.text(pixel);
        browser.has_no_errors();
        let host = url.trim_start_matches("http://").split('/').next().expect("a host");
        let path = url.trim_start_matches("http://").trim_start_matches(host);
        let ask = |path: &str, host: &str, more: &str| {
            answered(&url, &format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n{more}\r\n"))
        };
        assert_eq!(ask(path, host, ""), "HTTP/1.1 200 OK");
        assert_eq!(ask("/", host, ""), "HTTP/1.1 404 Not Found", "without the secret part");
        assert_eq!(ask("/state/0", host, ""), "HTTP/1.1 404 Not Found");
        assert_eq!(ask(path, "evil.example:80", ""), "HTTP/1.1 403 Forbidden", "a name that leads here");
        assert_eq!(ask(path, host, "Origin: http://evil.example\r\n"), "HTTP/1.1 403 Forbidden");
        assert_eq!(ask(path, "localhost:9000", ""), "HTTP/1.1 200 OK", "the end of a tunnel");
        drop(ends);
        let ended = running.join().expect("no panic").expect("no error");
        assert_eq!(ended.msaa, value);
        (ended, shown, host.to_owned())
    });
    let texels: Vec<String> = ended.texels.iter().map(u8::to_string).collect();
    assert!(shown == texels.join(","), "the picture is another one");
    render::silent(device).expect("silent");
    // The program has let go of its viewer, and the server ends with it: its port is free again.
    let free = (0..600).any(|_| {
        std::thread::sleep(Duration::from_millis(100));
        TcpStream::connect(&host).is_err()
    });
    assert!(free, "{host} is still served");
    // The page says so, and goes on showing what it has.
    browser.until("live.bar.status.textContent.startsWith('The server doesn')");
    assert_eq!(browser.count("models.length"), 1);
}
