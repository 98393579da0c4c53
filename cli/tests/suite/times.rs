//! Times of frames: on the page of a report and of captures (LV-2), over the steps (LV-3), and as a trace for Perfetto (LV-10).

use crate::testing::browser::Browser;
use crate::testing::{Place, Vulkan};
use serde_json::Value;
use std::collections::BTreeMap;

const SMALL: [&str; 4] = ["--scene", "spheres_and_cubes", "--size", "96x54"];

fn read(place: &Place, file: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(place.path(file)).expect("written")).expect("JSON")
}

/// A place with the Plan and the report of a run of five frames, and its variables.
fn measured() -> Option<(Place, Vec<(&'static str, &'static str)>)> {
    let variables = Vulkan::LAVAPIPE.variables()?;
    let place = Place::new();
    let kept = ["--frames", "5", "--save-plan", "plan.json", "--report", "report.json", "--trace", "trace.json"];
    place.run_with(&variables, &[&["run", "forward"][..], &SMALL, &kept].concat()).exits(0);
    Some((place, variables))
}

#[test]
fn lv_2_a_reports_times_are_on_the_page_in_every_view_with_what_they_mean() {
    let Some((place, _)) = measured() else { return };
    place.run(&["inspect", "plan.json", "--report", "report.json", "--format", "html", "-o", "page.html"]).exits(0);
    let (report, plan) = (read(&place, "report.json"), read(&place, "plan.json"));
    assert_eq!(report["times"]["frames"], 5);
    let steps = plan["steps"].as_array().expect("a list").len();
    assert_eq!(report["times"]["steps"].as_array().map(Vec::len), Some(steps));
    let Some(mut browser) = Browser::start() else { return };
    browser.open_file(&place.path("page.html"), "#view=overview");
    let text = |view: &str| format!("document.querySelector('#view-{view}').textContent");
    let overview = browser.text(&text("overview"));
    for words in [
        "of the device",
        "the middle one of 5 frames on llvmpipe",
        "the host records a frame in",
        "The device is the processor",
    ] {
        assert!(overview.contains(words), "{words}: {overview}");
    }
    let median = browser.text("milliseconds(models[0].msOfStep(0))");
    let expected = report["times"]["steps"][0]["median"].as_f64().expect("a time");
    assert_eq!(browser.ask("models[0].msOfStep(0)").as_f64(), Some(expected));
    for view in ["graph", "steps", "cost"] {
        browser.click(&format!("#tab-{view}"));
        browser.settle();
        let shown = browser.text(&text(view));
        assert!(shown.contains(&median), "{view} lacks {median}: {shown}");
    }
    browser.click("#tab-grid");
    browser.settle();
    let short = browser.text("shortTime(models[0].msOfStep(0))");
    let heads =
        browser.text("[...document.querySelectorAll('#view-grid text.ms')].map((one) => one.textContent).join()");
    assert!(heads.split(',').any(|head| head == short), "{short} in {heads}");
    browser.ask("select('pass:sky')");
    let panel = browser.text("document.querySelector('#details').textContent");
    assert!(panel.contains("in 5 frames") && panel.contains("by a software driver"), "{panel}");
    browser.has_no_errors();
}

#[test]
fn lv_2_a_report_of_another_plan_or_none_is_refused_in_plain_words() {
    let Some((place, _)) = measured() else { return };
    let page = ["--format", "html", "-o", "page.html"];
    let refused = |subject: &str, report: &str, more: &[&str], words: &str| {
        let said = place.run(&[&["inspect", subject, "--report", report][..], &page, more].concat()).exits(1).err;
        assert!(said.contains(words), "{words}: {said}");
        assert!(!place.path("page.html").exists());
    };
    refused("post", "report.json", &["--size", "96x54"], "it is a report of another Plan: it was drawn with ");
    let other = "it was drawn with 96×54 pixels, and the Plan is for 1280×720";
    refused("forward", "report.json", &[], other);
    refused("plan.json", "plan.json", &[], "it is no report that `framewright run --report` wrote");
    refused("plan.json", "nothing.json", &[], "nothing.json");
    let with = |name: &str, change: &dyn Fn(&mut Value)| {
        let mut report = read(&place, "report.json");
        change(&mut report);
        place.file(name, report.to_string());
    };
    with("renamed.json", &|report| report["passes"][0]["name"] = "\u{1b}[31m".into());
    refused("plan.json", "renamed.json", &[], "it has `\\u{1b}[31m` in step 0 where the Plan has `opaque` in step 0");
    with("short.json", &|report| drop(report["passes"].as_array_mut().expect("a list").pop()));
    refused("plan.json", "short.json", &[], "it has nothing more where the Plan has");
    with("untimed.json", &|report| report["times"] = Value::Null);
    refused("plan.json", "untimed.json", &[], "it has no times: the device measured none");
    with("later.json", &|report| report["format_version"] = 3.into());
    refused("plan.json", "later.json", &[], "it is a report of version 3");
    with("torn.json", &|report| drop(report["times"]["steps"].as_array_mut().expect("a list").pop()));
    refused("plan.json", "torn.json", &[], "its times are of other steps than its passes");
    place.run(&["inspect", "plan.json", "--report", "report.json"]).exits(2).mentions("add `--format html`");
    let twice = [&["inspect", "forward", "--report", "report.json", "--capture"][..], &SMALL, &page].concat();
    place.run(&twice).exits(2);
}

#[test]
fn lv_2_a_page_with_captures_has_times_of_the_plan_itself() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    let page = ["--format", "html", "--capture", "-o", "page.html"];
    place.run_with(&variables, &[&["inspect", "forward"][..], &SMALL, &page].concat()).exits(0);
    browser.open_file(&place.path("page.html"), "#view=timeline");
    assert_eq!(browser.ask("models[0].times.steps.length === models[0].plan.steps.length"), true);
    assert!(browser.count("models[0].times.frames") >= 1);
    assert_eq!(browser.text("models[0].times.device.is_processor ? 'software' : 'GPU'"), "software");
    browser.has_no_errors();
}

#[test]
fn lv_3_the_timeline_has_lanes_for_host_and_queues_arrows_of_barriers_and_three_widths() {
    let Some((place, _)) = measured() else { return };
    let Some(mut browser) = Browser::start() else { return };
    place.run(&["inspect", "plan.json", "--report", "report.json", "--format", "html", "-o", "page.html"]).exits(0);
    browser.open_file(&place.path("page.html"), "#view=timeline");
    browser.settle();
    let view = "document.querySelector('#view-timeline')";
    let names = format!("[...{view}.querySelectorAll('text')].map((one) => one.textContent).join('|')");
    let shown = browser.text(&names);
    for name in ["recording", "graphics queue", "memory alive"] {
        assert!(shown.contains(name), "{name}: {shown}");
    }
    // Barriers whose images an earlier step used.
    let plan = read(&place, "plan.json");
    let mut arrows = std::collections::BTreeSet::new();
    let steps = browser.ask("models[0].rows().map((row) => [row.key, [...row.steps.keys()]])");
    let uses: BTreeMap<String, Vec<u64>> = serde_json::from_value(Value::Object(
        steps
            .as_array()
            .expect("rows")
            .iter()
            .map(|row| (row[0].as_str().expect("a key").to_owned(), row[1].clone()))
            .collect(),
    ))
    .expect("steps");
    for (to, step) in (0_u64..).zip(plan["steps"].as_array().expect("steps")) {
        for barrier in step["image_barriers"].as_array().expect("barriers") {
            let image = usize::try_from(barrier["image"].as_u64().expect("a number")).expect("fits");
            let name = plan["images"][image]["name"].as_str().expect("a name");
            let from = uses.get(&format!("image:{name}")).and_then(|steps| steps.iter().filter(|at| **at < to).max());
            arrows.extend(from.map(|from| (*from, to)));
        }
    }
    assert!(!arrows.is_empty());
    assert_eq!(browser.count(&format!("{view}.querySelectorAll('path.hazard').length")), arrows.len());
    // In a frame of many steps each leads from the last one that used the image.
    place.run(&["inspect", "deferred", "--format", "html", "-o", "deferred.html"]).exits(0);
    browser.open_file(&place.path("deferred.html"), "#view=timeline");
    browser.ask("printing = true, VIEWS.forEach((view) => view.parts?.forEach((part) => part.redraw?.()))");
    let told = browser.text(&format!(
        "[...new Set([...{view}.querySelectorAll('path.hazard title')].map((one) => one.textContent.split(':')[0]))].sort().join()"
    ));
    let expected = browser.text(
        "[...new Set(models[0].plan.steps.flatMap((step, to) => step.image_barriers.map(({ image }) => { \
         const uses = models[0].nodes.filter((node) => node.step < to && node.uses.some((use) => use.resource.image === image)); \
         return uses.length === 0 ? null : `a barrier before step ${to} waits for step ${Math.max(...uses.map((node) => node.step))}`; \
         })).filter(Boolean))].sort().join()",
    );
    assert!(told == expected && told.contains("before step 9 "), "{told}\n{expected}");
    browser.open_file(&place.path("page.html"), "#view=timeline");
    browser.settle();
    // Each width has all steps on one axis, and the recording beside them.
    let ends = format!("[...{view}.querySelectorAll('.lane')].map((one) => Number(one.getAttribute('width'))).join()");
    let mut widths = std::collections::BTreeSet::new();
    for kind in ["equal", "bytes", "ms"] {
        browser.ask(&format!(
            "(() => {{ const choice = document.querySelector('#view-timeline select'); choice.value = '{kind}'; choice.dispatchEvent(new Event('change')); }})()"
        ));
        browser.settle();
        assert_eq!(browser.count(&format!("{view}.querySelectorAll('.recording rect').length")), 1, "{kind}");
        widths.insert(browser.text(&format!(
            "[...{view}.querySelectorAll('g[data-key] > rect')].map((one) => one.getAttribute('width')).join()"
        )));
        assert!(!browser.text(&ends).is_empty());
    }
    assert_eq!(widths.len(), 3, "{widths:?}");
    // The line under the pointer goes through everything, and says what is there.
    browser.ask(
        "(() => { const box = document.querySelector('#view-timeline .scroller'); const place = box.getBoundingClientRect(); \
         box.dispatchEvent(new PointerEvent('pointermove', { clientX: place.left + 230, clientY: place.top + 40 })); })()",
    );
    browser.settle();
    assert_eq!(browser.count(&format!("{view}.querySelectorAll('path.cross').length")), 1);
    let said = browser.text(&format!("{view}.querySelector('[role=status]').textContent"));
    assert!(said.starts_with("step 0: ") && said.contains(" ms, ") && said.contains(" alive"), "{said}");
    browser.screenshot("timeline-of-a-report");
    browser.has_no_errors();
}

/// A span of a trace in nanoseconds: begin, end, name.
type Span = (u64, u64, String);

/// The spans of a trace by process and track, held against the Trace Event Format.
fn tracks(trace: &Value) -> BTreeMap<(u64, u64), Vec<Span>> {
    assert_eq!(trace["displayTimeUnit"], "ms");
    let mut tracks: BTreeMap<_, Vec<Span>> = BTreeMap::new();
    for event in trace["traceEvents"].as_array().expect("a list") {
        let number = |name: &str| event[name].as_u64().unwrap_or_else(|| panic!("{event} has no {name}"));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let time = |name: &str| {
            let microseconds = event[name].as_f64().unwrap_or_else(|| panic!("{event} has no {name}"));
            assert!((0.0..1e12).contains(&microseconds), "{event}");
            (microseconds * 1e3).round() as u64
        };
        let name = event["name"].as_str().expect("a name").to_owned();
        let track = (number("pid"), number("tid"));
        match event["ph"].as_str().expect("a phase") {
            "X" => tracks.entry(track).or_default().push((time("ts"), time("ts") + time("dur"), name)),
            "C" => assert!(event["args"]["bytes"].is_u64() && time("ts") < u64::MAX, "{event}"),
            "M" => assert!(event["args"]["name"].is_string(), "{event}"),
            other => panic!("{other} is no phase that is written: {event}"),
        }
    }
    tracks
}

#[test]
fn lv_10_a_trace_follows_the_format_and_has_each_frames_steps_passes_and_recording() {
    let Some((place, _)) = measured() else { return };
    let (trace, plan) = (read(&place, "trace.json"), read(&place, "plan.json"));
    let tracks = tracks(&trace);
    assert_eq!(tracks.keys().collect::<Vec<_>>(), [&(1, 1), &(2, 1)], "the host, and one queue");
    for (track, spans) in &tracks {
        let mut around: Vec<&Span> = Vec::new();
        for span in spans {
            assert!(span.0 <= span.1, "{span:?}");
            while around.last().is_some_and(|outer| outer.1 <= span.0) {
                around.pop();
            }
            assert!(around.last().is_none_or(|outer| span.1 <= outer.1), "{track:?}: {span:?} in {:?}", around.last());
            around.push(span);
        }
    }
    let steps = plan["steps"].as_array().expect("steps").len();
    let count = |track, wanted: &dyn Fn(&str) -> bool| tracks[&track].iter().filter(|span| wanted(&span.2)).count();
    assert_eq!(count((1, 1), &|name| name == "record"), 5);
    assert_eq!(count((1, 1), &|name| name == "frame 4"), 1);
    assert_eq!(count((2, 1), &|name| name.starts_with("step ")), 5 * steps);
    assert_eq!(count((2, 1), &|name| name == "tone_map"), 5);
    // The steps' times are those of the report.
    let report = read(&place, "report.json");
    let mut first: Vec<f64> = Vec::new();
    for (from, to, _) in tracks[&(2, 1)].iter().filter(|span| span.2.starts_with("step 0:")) {
        #[allow(clippy::cast_precision_loss, reason = "a few seconds")]
        first.push((to - from) as f64 / 1e6);
    }
    first.sort_by(f64::total_cmp);
    let median = report["times"]["steps"][0]["median"].as_f64().expect("a time");
    assert!((first[2] - median).abs() < 1e-5, "{first:?} {median}");
    let named: Vec<&str> = trace["traceEvents"]
        .as_array()
        .expect("a list")
        .iter()
        .filter(|event| event["ph"] == "M")
        .filter_map(|event| event["args"]["name"].as_str())
        .collect();
    assert!(named.contains(&"host") && named.contains(&"graphics queue"), "{named:?}");
    assert!(named.iter().any(|name| name.starts_with("device: llvmpipe")), "{named:?}");
}

#[test]
fn lv_10_a_trace_is_written_whole_and_over_nothing_that_was_read() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let run = |more: &[&str]| place.run_with(&variables, &[&["run", "forward"][..], &SMALL, more].concat());
    run(&["--trace", "none/trace.json"]).exits(3);
    run(&["--trace", "t.json", "--report", "t.json"]).exits(2).mentions("would be written twice");
    run(&["--trace", "t.json", "--bisect", "poison"]).exits(2);
    assert!(place.names().iter().all(|name| !name.contains("t.json")), "{:?}", place.names());
}
