//! Pictures that are drawn when somebody looks at them (LV-5): in the page of a running program, and in that of `serve`.

use crate::testing::browser::Browser;
use crate::testing::server::Server;
use crate::testing::{Place, Vulkan};
use framewright::{Device, Renderer, RendererOptions, SceneDrawSource, load_scene};
use framewright_tests::render;
use framewright_viewer::Viewer;
use serde_json::{Value, json};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

/// How a program is told to end, and what it tells of itself.
#[derive(Default)]
struct Told {
    end: AtomicBool,
    /// Frames that were captured.
    captured: AtomicUsize,
    /// Plans that it made.
    plans: AtomicUsize,
}

/// Draws frame after frame with a viewer until it is told to end. Returns the texels of the last picture.
fn program(device: &Device, url: &mpsc::Sender<String>, told: &Told) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let scene = load_scene("spheres_and_cubes")?;
    let mut renderer = Renderer::open(device, "forward", RendererOptions::default())?;
    renderer.set_scene(&scene);
    renderer.set_extent([64, 48])?;
    let mut viewer = Viewer::serve("127.0.0.1:0")?;
    url.send(viewer.url())?;
    while !told.end.load(Ordering::Relaxed) {
        let plan = renderer.prepare()?.plan;
        let mut objects = SceneDrawSource::for_plan(device, &scene, [64, 48], plan)?;
        renderer.frame(&mut objects)?;
        told.captured.fetch_add(usize::from(renderer.is_capturing()), Ordering::Relaxed);
        told.plans.store(usize::try_from(renderer.plans())?, Ordering::Relaxed);
        viewer.frame(&mut renderer)?;
    }
    if renderer.is_capturing() {
        renderer.captured()?;
    }
    let plan = renderer.prepare()?.plan;
    let mut objects = SceneDrawSource::for_plan(device, &scene, [64, 48], plan)?;
    renderer.frame(&mut objects)?;
    Ok(renderer.read("screen")?.bytes)
}

/// Ends the program, also where the test fails.
struct Ends<'a>(&'a Told);

impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.0.end.store(true, Ordering::Relaxed);
    }
}

/// Asks the server of the page for pictures, and returns status and text of the answer.
fn asked(browser: &mut Browser, body: &str) -> (u64, String) {
    let script = format!(
        "(async () => {{ const answer = await fetch('pictures', {{ method: 'POST', headers: {{ 'content-type': 'application/json' }}, \
         body: {} }}); return [answer.status, await answer.text()]; }})()",
        json!(body)
    );
    let told = browser.ask(&script);
    (told[0].as_u64().expect("a number"), told[1].as_str().expect("text").to_owned())
}

/// The problem that the only picture of an answer has.
fn problem((status, text): (u64, String)) -> String {
    assert_eq!(status, 200, "{text}");
    let answer: Value = serde_json::from_str(&text).expect("JSON");
    answer["pictures"][0]["problem"].as_str().unwrap_or_else(|| panic!("{text}")).to_owned()
}

const VIEW: &str = "document.querySelector('dialog.large').view";

/// Opens the picture of `screen` in its full size, and holds it against the texels that it is of.
fn look_closely(browser: &mut Browser) -> String {
    browser.ask("openLarge(DATA.captures.findLast((one) => one.image === 'screen'))");
    browser.until(&format!("{VIEW}.picture?.small.join() === '64,48'"));
    // The value under the pointer is the texel's.
    browser.click("dialog.large canvas.stage");
    browser.until(&format!("{VIEW}.at !== null && {VIEW}.at !== undefined"));
    let said = browser.text(&format!("{VIEW}.value.textContent"));
    let wanted = browser.text(&format!(
        "(() => {{ const [x, y] = {VIEW}.at; const raw = Array.from({VIEW}.picture.raw.slice((y * 64 + x) * 4, (y * 64 + x) * 4 + 4)); \
         return x + ', ' + y + ': ' + raw.map((byte) => '= ' + byte + '/255').join(); }})()"
    ));
    let (place, shares) = wanted.split_once(": ").expect("two parts");
    assert!(said.starts_with(place) && shares.split(',').all(|share| said.contains(share)), "{said}, {wanted}");
    // A press lists what the texel held after each pass that wrote the image.
    browser.until("document.querySelectorAll('.texels li').length > 0 && ![...document.querySelectorAll('.texels li')].some((one) => one.textContent.endsWith('…'))");
    let listed = browser.text("[...document.querySelectorAll('.texels li')].map((one) => one.textContent).join('|')");
    let last = listed.split('|').next_back().expect("a pass");
    assert!(shares.split(',').all(|share| last.contains(share)), "{last}, {wanted}");
    // Each texel is counted once in each channel.
    let sums = browser.text(&format!(
        "histogramOf({VIEW}.picture).channels.map(({{ bins, others }}) => bins.reduce((a, b) => a + b) + others).join()"
    ));
    assert_eq!(sums, ["3072"; 4].join(","));
    // A range is drawn from its darkest to its brightest number.
    let pixels = format!(
        "(() => {{ const [{{ canvas }}] = {VIEW}.layers; return [...canvas.getContext('2d').getImageData(0, 0, 64, 48).data].reduce((a, b) => a + b); }})()"
    );
    let before = browser.count(&pixels);
    browser.ask("(() => { const handle = document.querySelectorAll('.ranged input')[1]; handle.value = 200; handle.dispatchEvent(new Event('input')); })()");
    assert!(browser.count(&pixels) > before, "less is brightest, so more is bright");
    browser.ask("(() => { const handle = document.querySelectorAll('.ranged input')[1]; handle.value = 1000; handle.dispatchEvent(new Event('input')); })()");
    assert_eq!(browser.count(&pixels), before);
    browser.text(&format!("Array.from({VIEW}.picture.raw).join()"))
}

#[test]
fn lv_5_a_running_program_draws_pictures_when_they_are_looked_at() {
    let (Some(mut browser), Some(device)) = (Browser::start(), render::device()) else { return };
    let told = Told::default();
    let (send, url) = mpsc::channel();
    let (shown, last) = std::thread::scope(|threads| {
        let ends = Ends(&told);
        let running = threads.spawn(|| program(device, &send, &told).map_err(|error| error.to_string()));
        let url = url.recv().expect("the program is there");
        browser.open(&url);
        browser.until("models.length === 1 && DATA.captures.length > 3");
        assert_eq!(told.captured.load(Ordering::Relaxed), 0, "nobody looks");
        let frame = browser.count("live.frame");
        let plans = told.plans.load(Ordering::Relaxed);
        let shown = look_closely(&mut browser);
        assert!(told.captured.load(Ordering::Relaxed) > 0);
        // The page shows the program's own Plan all along.
        assert_eq!((browser.count("live.frame"), told.plans.load(Ordering::Relaxed)), (frame, plans));
        // Blinking shows the kept picture and the other one in turn.
        let exposure = "const slider = document.querySelector('dialog.large input[type=range]'); slider.value";
        browser.ask(&format!("(() => {{ {exposure} = 0; }})()"));
        browser.ask(
            "[...document.querySelectorAll('dialog.large button')].find((one) => one.textContent === 'Keep').click()",
        );
        browser.ask("showLarge(document.querySelector('dialog.large').view, DATA.captures.find((one) => one.image === 'depth') ?? DATA.captures[0])");
        browser.until(&format!("{VIEW}.picture?.image !== 'screen'"));
        browser.ask("(() => { const choice = document.querySelector('.compare select'); choice.value = [...choice.options].find((one) => one.textContent.startsWith('kept')).value; choice.dispatchEvent(new Event('change')); })()");
        browser.until(&format!("{VIEW}.other !== null && {VIEW}.second === true"));
        assert_eq!(browser.text(&format!("pictureShown({VIEW}).image")), "screen");
        browser.until(&format!("{VIEW}.second === false"));
        browser.screenshot("large-live");
        browser.press("Escape");
        browser.until("document.querySelector('dialog') === null");
        // The panel of a pass shows its images, which are drawn when they are in sight.
        browser.ask("select('pass:' + DATA.captures.at(-1).pass)");
        browser.until("(() => { const all = [...document.querySelectorAll('#details figure')]; return all.length > 1 && all.every((one) => one.picture); })()");
        // Rows of the grid have pictures where they are switched on.
        browser.click("#tab-grid");
        assert_eq!(browser.count("document.querySelectorAll('canvas.tiny').length"), 0);
        browser.click("#view-grid input.switch");
        browser.until("document.querySelectorAll('#view-grid canvas.tiny').length > 1");
        browser.screenshot("grid-pictures");
        // What is wrong with a question is said.
        let frame = browser.count("live.frame");
        let ask = |of: Value, size: Value, frame: usize| {
            json!({ "frame": frame, "pictures": [{ "of": of, "size": size }] }).to_string()
        };
        let screen = json!({ "pass": "nobody", "image": "screen" });
        let small = json!({ "most": 8 });
        let why = problem(asked(&mut browser, &ask(screen.clone(), small.clone(), frame)));
        assert_eq!(why, "no pass `nobody` writes `screen`");
        let why = problem(asked(&mut browser, &ask(screen, small.clone(), frame + 1)));
        assert_eq!(why, "the frame that the page shows is another one by now");
        let own = browser.ask("nameOfCapture(DATA.captures.findLast((one) => one.image === 'screen'))");
        let beside = json!({ "most": 8, "region": [64, 0, 1, 1] });
        let why = problem(asked(&mut browser, &ask(own.clone(), beside, frame)));
        assert_eq!(why, "a part that begins at 64, 0 has no texel of a picture of 64×48");
        let (status, text) = asked(&mut browser, &ask(own.clone(), json!({ "most": u32::MAX }), frame));
        assert!(status == 200 && text.contains("\"small\":[64,48]"), "{text}");
        let many = json!({ "frame": frame, "pictures": vec![json!({ "of": own, "size": small }); 65] }).to_string();
        for body in ["", "[]", "{\"frame\":-1,\"pictures\":[]}", &many] {
            assert_eq!(asked(&mut browser, body).0, 400, "{body}");
        }
        assert_eq!(asked(&mut browser, &"x".repeat(100_000)).0, 413);
        drop(ends);
        let last = running.join().expect("no panic").expect("no error");
        (shown, last)
    });
    let texels: Vec<String> = last.iter().map(u8::to_string).collect();
    assert!(shown == texels.join(","), "the page's texels are those of a readback");
    render::silent(device).expect("silent");
}

#[test]
fn lv_5_serve_draws_pictures_when_they_are_looked_at() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let small = ["--scene", "spheres_and_cubes", "--size", "64x48"];
    place.run_with(&variables, &[&["run", "first.ron"][..], &small, &["-o", "screen.png"]].concat()).exits(0);
    let server = Server::start(&place, &variables, &[&["first.ron"][..], &small].concat());
    browser.open(&server.address());
    browser.until("live.state?.busy === false && DATA.captures.length === 4");
    let shown = look_closely(&mut browser);
    browser.has_no_errors();
    let png = image::open(place.path("screen.png")).expect("a picture").into_rgba8();
    let texels: Vec<String> = png.as_raw().iter().map(u8::to_string).collect();
    assert!(shown == texels.join(","), "the page's texels are those of the picture");
    // While a file is wrong, the last good frame stays without new pictures.
    let text = std::fs::read_to_string(place.path("first.ron")).expect("it is there");
    place.file("first.ron", text.replace("Pipeline(", "Pipelin("));
    browser.until("live.state.mistakes.length === 1");
    let body =
        "JSON.stringify({ frame: live.frame, pictures: [{ of: nameOfCapture(DATA.captures[0]), size: { most: 8 } }] })";
    let body = browser.text(body);
    assert_eq!(problem(asked(&mut browser, &body)), "a file has mistakes: pictures are drawn when they are mended");
    place.file("first.ron", text);
    browser.until("live.state.mistakes.length === 0 && live.state.busy === false");
    // A page that shows an earlier frame is told.
    assert_eq!(problem(asked(&mut browser, &body)), "the frame that the page shows is another one by now");
    // Other sites get none.
    let headers = format!("Host: {}\r\nOrigin: http://evil.example\r\nContent-Type: application/json\r\n", server.host);
    let (head, _) = server.ask("POST /pictures", &headers, &body);
    assert!(head.starts_with("HTTP/1.1 403"), "{head}");
}
