//! The page of a Plan, in a real browser: what each view shows is what the Plan's JSON says (IN-1, IN-3, IN-12).

use crate::large::back_and_forth;
use crate::testing::browser::Browser;
use crate::testing::{Place, shipped_pipelines};
use framewright_tests::sweep;
use serde_json::Value;
use std::path::PathBuf;

/// The Plan of a pipeline as JSON, and its page.
fn plan_and_page(place: &Place, arguments: &[&str]) -> (Value, PathBuf) {
    let json = place.run(&[&["inspect"], arguments, &["--format", "json"]].concat()).exits(0).out;
    place.run(&[&["inspect"], arguments, &["--format", "html", "-o", "page.html"]].concat()).exits(0);
    (serde_json::from_str(&json).expect("JSON"), place.path("page.html"))
}

fn list<'v>(value: &'v Value, name: &str) -> &'v Vec<Value> {
    value[name].as_array().unwrap_or_else(|| panic!("no list {name}"))
}

/// Work in a Plan: passes, resolves that scopes carry, and transfers.
pub(crate) fn nodes(plan: &Value) -> usize {
    let of = |step: &Value| match &step["work"] {
        Value::String(_) => 0,
        work if work.get("render").is_some() => {
            let scope = &work["render"];
            list(scope, "passes").len()
                + list(scope, "attachments").iter().filter(|it| it["resolve"].is_object()).count()
        }
        _ => 1,
    };
    list(plan, "steps").iter().map(of).sum()
}

fn is_transient(resource: &&Value) -> bool {
    resource["role"].get("transient").is_some()
}

#[test]
fn every_view_of_every_shipped_pipeline_shows_what_its_plan_says() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    let ways = [&[][..], &["--stereo", "multi-pass", "--device", "nvidia-rtx-2080"]];
    let cases = shipped_pipelines().into_iter().flat_map(|name| ways.map(|options| (name.clone(), options)));
    for (name, options) in sweep::of("pages of shipped pipelines", cases.collect(), 8) {
        let arguments = [&[&*name][..], options].concat();
        let (plan, page) = plan_and_page(&place, &arguments);
        let resources = || list(&plan, "images").iter().chain(list(&plan, "buffers"));
        browser.open_file(&page, "#view=graph");
        browser.ask("printing = true, VIEWS.forEach((view) => { makeView(view); view.parts.forEach((part) => part.redraw?.()); })");
        let mut shown = |selector: &str| browser.count(&format!("document.querySelectorAll('{selector}').length"));
        let about = format!("{arguments:?}");
        assert_eq!(shown("#view-graph g[data-key]:not(.beside)"), nodes(&plan), "{about}: graph");
        let culled = list(&plan, "notes").iter().filter(|note| note["kind"] == "unneeded").count();
        assert_eq!(
            shown(
                "#view-grid g:is(.draw,.dispatch,.custom,.folded_resolve,.resolve,.copy,.blit,.fill,.culled)[data-key]"
            ),
            nodes(&plan) + culled,
            "{about}: grid"
        );
        assert_eq!(shown("#view-memory rect.block"), resources().filter(is_transient).count(), "{about}: memory");
        assert_eq!(shown("#view-steps details"), list(&plan, "steps").len(), "{about}: steps");
        assert_eq!(shown("#view-cost tbody tr"), list(&plan, "steps").len(), "{about}: cost");
        assert_eq!(shown("#view-timeline g[data-key]"), list(&plan, "steps").len(), "{about}: timeline");
        let waits = list(&plan, "steps").iter().flat_map(|step| list(step, "waits"));
        assert_eq!(
            shown("#view-timeline path.wait"),
            waits.filter(|wait| wait["frames_ago"] == 0).count(),
            "{about}: waits"
        );
        assert_eq!(shown("#view-images tbody tr"), resources().count(), "{about}: images");
        assert_eq!(shown("#view-notes li[data-key]"), list(&plan, "notes").len(), "{about}: notes");
        assert_eq!(shown("#view-devices details") + 1, 7, "{about}: other devices");
        // Every step that is opened says each of its barriers, with stages and accesses.
        browser.ask("document.querySelectorAll('#view-steps details').forEach((step) => { step.open = true; })");
        browser.settle();
        let barriers = |step: &Value| {
            ["memory_barriers", "image_barriers", "releases"].map(|kind| list(step, kind).len()).iter().sum::<usize>()
        };
        let expected: usize = list(&plan, "steps").iter().map(barriers).sum();
        let lines = "[...document.querySelectorAll('#view-steps li')].filter((line) => line.textContent.startsWith('barrier: ') && / before /.test(line.textContent)).length";
        assert_eq!(browser.count(lines), expected, "{about}: barriers");
        browser.has_no_errors();
    }
}

#[test]
fn the_cost_view_says_what_stays_on_the_chip_of_a_device_that_draws_in_tiles() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    for (device, stays) in [("mali-g78", true), ("amd-rx-7800-xt", false)] {
        let (_, page) = plan_and_page(&place, &["first.ron", "--device", device]);
        browser.open_file(&page, "#view=cost");
        let shown = browser.text("document.querySelector('#view-cost').innerText");
        // 1280 × 720 texels of 4 samples: 8 bytes of colour, 4 of depth.
        assert_eq!(shown.contains("keeps 42.2 MiB on the chip: color, depth are neither"), stays, "{device}: {shown}");
        let cells = "[...document.querySelectorAll('#view-cost tbody tr')].map((row) => row.cells.length > 8 ? row.cells[8].innerText : '').join()";
        assert_eq!(browser.text(cells), if stays { "42.2 MiB,0 B" } else { "," }, "{device}");
        browser.has_no_errors();
    }
}

#[test]
fn what_is_selected_is_marked_in_every_view_and_stands_in_the_address() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let (_, page) = plan_and_page(&place, &["first.ron"]);
    browser.open_file(&page, "#view=grid&pass=tone_map");
    assert_eq!(browser.text("document.querySelector('#details h2').textContent"), "tone_map", "a deep link");
    for (asked, missing) in [("#view=grid&pass=toon_map", "pass toon_map"), ("#view=grit", "view grit")] {
        browser.open_file(&page, asked);
        assert_eq!(browser.text("document.querySelector('#details [role=status] code').textContent"), missing);
    }
    browser.open_file(&page, "#view=grid");
    browser.click("#view-grid g.folded_resolve");
    assert_eq!(browser.count("document.querySelectorAll('#details [role=status]').length"), 0);
    let details = "document.querySelector('#details').innerText";
    let about = browser.text(details);
    assert!(about.contains("tone_map samples color and it has 4 samples"), "{about}");
    assert!(about.contains("color (resolved) goes too: 7.0 MiB."), "{about}");
    assert!(browser.text("location.hash").ends_with("pass=resolve%20color"));
    for view in ["overview", "graph", "timeline", "grid", "memory", "steps", "cost", "images", "notes", "source"] {
        browser.click(&format!("#tab-{view}"));
        assert_eq!(browser.text("state.view"), view);
        let panel = format!("document.querySelector('#view-{view}')");
        assert!(!browser.ask(&format!("{panel}.hidden")).as_bool().expect("a fact"), "{view}");
        if !matches!(view, "notes" | "source") {
            let marked = format!("{panel}.querySelectorAll('.selected, .related').length");
            assert!(browser.count(&marked) > 0, "nothing is marked in {view}");
        }
        browser.screenshot(&format!("first-{view}"));
    }
    // A link in the panel leads on, and a place to its line.
    browser.click("#details button.place");
    assert_eq!(
        browser.text("document.querySelector('li.here').textContent").trim(),
        "sample: {\"source\": \"color\"},"
    );
    browser.has_no_errors();
}

#[test]
fn lv_4_the_overview_has_figures_what_is_dearest_and_what_stands_out() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    let (plan, page) = plan_and_page(&place, &["deferred"]);
    browser.open_file(&page, "");
    assert_eq!(browser.text("state.view"), "overview");
    let figures =
        browser.text("[...document.querySelectorAll('#view-overview .large')].map((one) => one.textContent).join()");
    let totals = &plan["totals"];
    assert!(figures.starts_with(&format!("{},", totals["passes"])), "{figures}");
    assert!(figures.ends_with(&format!(",{},{}", totals["barrier_calls"], totals["resolves"])), "{figures}");
    let hints = browser.text("document.querySelector('#view-overview .hints').innerText");
    assert!(hints.contains("H01 shadow is 64.0 MiB of 105.6 MiB of transient memory"), "{hints}");
    // A name leads to its panel, and Back to where it was.
    browser.click("#view-overview .hints button.link");
    assert_eq!(browser.text("state.selected"), "image:shadow");
    browser.ask("history.back()");
    browser.until("state.selected === null");
    browser.has_no_errors();
}

#[test]
fn lv_6_fragments_fold_into_boxes_and_unfold() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    let (plan, page) = plan_and_page(&place, &["deferred"]);
    browser.open_file(&page, "#view=graph");
    let shown = "document.querySelectorAll('#view-graph g[data-key]:not(.beside)').length";
    browser.ask("printing = true, VIEWS.forEach((view) => view.parts?.forEach((part) => part.redraw?.()))");
    assert_eq!(browser.count(shown), nodes(&plan));
    browser.ask("[...document.querySelectorAll('#view-graph .tools button')].at(-1).click()");
    browser.settle();
    let boxes = browser.count("document.querySelectorAll('#view-graph .fragment').length");
    assert!(boxes > 2 && browser.count(shown) < nodes(&plan) / 2, "{boxes}");
    // Enter unfolds the one that has the focus.
    browser.ask("document.querySelector('#view-graph .fragment [role=button]').focus()");
    browser.press("Enter");
    browser.settle();
    assert_eq!(browser.count("document.querySelectorAll('#view-graph .fragment').length"), boxes - 1);
    browser.has_no_errors();
}

#[test]
fn keys_and_the_search_reach_everything() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let (_, page) = plan_and_page(&place, &["first.ron"]);
    browser.open_file(&page, "");
    browser.press("ArrowRight");
    assert_eq!(browser.text("state.selected"), "pass:opaque");
    browser.press("ArrowRight");
    assert_eq!(browser.text("state.selected"), "pass:sky");
    browser.press("5");
    assert_eq!(browser.text("state.view"), "memory");
    browser.press("/");
    for letter in "(resolved)".chars() {
        browser.press(&letter.to_string());
    }
    assert_eq!(browser.count("document.querySelectorAll('#found button').length"), 2, "the image, and a note about it");
    browser.press("Enter");
    assert_eq!(browser.text("state.selected"), "image:color (resolved)");
    browser.press("Escape");
    assert_eq!(browser.ask("state.selected"), Value::Null);
    // Every control has a name that a screen reader says, and every view its role.
    let nameless = "[...document.querySelectorAll('button, input')].filter((one) => !(one.textContent.trim() || one.labels?.length || one.title)).length";
    assert_eq!(browser.count(nameless), 0);
    assert_eq!(browser.count("document.querySelectorAll('[role=tabpanel]').length"), browser.count("VIEWS.length"));
    browser.has_no_errors();
}

#[test]
fn dark_narrow_and_printed_pages_work() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    let (_, page) = plan_and_page(&place, &["deferred"]);
    browser.screen(400, 800, true);
    browser.open_file(&page, "#view=memory&pass=lighting");
    let ground = browser.text("getComputedStyle(document.body).backgroundColor");
    assert_eq!(ground, "rgb(22, 24, 27)", "dark");
    for view in ["overview", "graph", "timeline", "grid", "memory", "steps", "cost", "images", "notes", "devices"] {
        browser.click(&format!("#tab-{view}"));
        let over = browser.ask("document.documentElement.scrollWidth - innerWidth");
        assert!(over.as_i64().expect("a number") <= 0, "{view} is {over} pixels too wide");
        browser.screenshot(&format!("narrow-{view}"));
    }
    browser.screen(1400, 900, false);
    let paper = browser.printed();
    assert!(paper.starts_with(b"%PDF") && paper.len() > 20_000, "{} bytes", paper.len());
    browser.has_no_errors();
}

#[test]
fn lv_10_every_view_has_contrast_in_both_themes_and_fits_from_400_to_2560_pixels() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    plan_and_page(&place, &["deferred"]);
    let difference = ["diff", "deferred", "deferred", "--b", "shadows=false", "--format", "html", "-o", "diff.html"];
    place.run(&difference).exits(0);
    let mut faults = Vec::new();
    for (file, fragment) in [("page.html", "#view=graph&pass=lighting"), ("diff.html", "#view=differences&pass=sky")] {
        for dark in [false, true] {
            browser.screen(1280, 720, dark);
            browser.open_file(&place.path(file), fragment);
            for view in browser.ask("VIEWS.map((view) => view.name)").as_array().expect("views").clone() {
                let view = view.as_str().expect("a name");
                browser.click(&format!("#tab-{view}"));
                let faint = browser.faint_texts();
                faults.extend(faint.iter().map(|text| format!("{file}, {view}, dark {dark}: {text}")));
                browser.screenshot(&format!("{file}-{view}-{dark}"));
                for width in [400, 2560] {
                    browser.screen(width, 720, dark);
                    let over = browser.ask("document.documentElement.scrollWidth - innerWidth").as_i64();
                    assert!(over.is_some_and(|over| over <= 0), "{file}, {view}: {over:?} of {width} pixels too wide");
                }
                browser.screen(1280, 720, dark);
            }
            let nested = "document.querySelectorAll(':is(summary, button, a) :is(button, a, input)').length";
            assert_eq!(browser.count(nested), 0, "what is pressed lies in something that is pressed");
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
    browser.has_no_errors();
}

#[test]
fn hostile_names_and_texts_do_nothing() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let evil = "</script><img src=x onerror=hacked=1>\u{202e}";
    let file = "<img src=x onerror=hacked=1>.ron";
    let text = std::fs::read_to_string(place.path("first.ron")).expect("written");
    place.file(file, format!("// {evil} <!-- <script>hacked=1</script>\n{text}"));
    // A pipeline's names can't hold such characters; those of a stranger's Plan can.
    let plan = place.run(&["inspect", file, "--format", "json"]).exits(0).out;
    place.file(
        "plan.json",
        plan.replace("\"opaque\"", &format!("\"{evil}\"")).replace("`opaque`", &format!("`{evil}`")),
    );
    place.run(&["diff", file, "plan.json", "--format", "html", "-o", "page.html"]).exits(0);
    browser.open_file(&place.path("page.html"), "");
    browser.ask("printing = true, VIEWS.forEach((view) => { showView(view.name); })");
    browser.ask("document.querySelectorAll('#view-steps details').forEach((step) => { step.open = true; })");
    browser.ask("select(models[1].nodes[0].key)");
    assert!(browser.text("document.querySelector('#details h2').textContent").starts_with("</script><img"));
    assert_eq!(browser.ask("typeof hacked"), "undefined");
    assert_eq!(browser.count("document.querySelectorAll('img').length"), 0);
    assert!(!browser.text("document.body.innerText").contains('\u{202e}'), "direction marks are written out");
    browser.has_no_errors();
    // The policy blocks what a mistake of ours would let in.
    browser.ask("document.body.insertAdjacentHTML('beforeend', '<img src=x onerror=\"hacked=1\">')");
    browser.settle();
    assert_eq!(browser.ask("typeof hacked"), "undefined");
}

#[test]
fn two_plans_stand_side_by_side_with_their_differences() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let choices = ["diff", "first.ron", "--b", "msaa=1", "--b", "@device=amd-rx-7800-xt"];
    let json = place.run(&[&choices[..], &["--format", "json"]].concat()).exits(0).out;
    place.run(&[&choices[..], &["--format", "html", "-o", "page.html"]].concat()).exits(0);
    let differences: Value = serde_json::from_str(&json).expect("JSON");
    browser.open_file(&place.path("page.html"), "");
    assert_eq!(browser.text("state.view"), "differences");
    let rows = |selector: &str| format!("document.querySelectorAll('#view-differences {selector}').length");
    assert_eq!(browser.count(&rows(".entries > li")), list(&differences, "entries").len());
    let differ = list(&differences, "totals").iter().filter(|figure| figure["a"] != figure["b"]).count();
    assert_eq!(browser.count(&rows(".sums tbody tr")), differ);
    browser.screenshot("diff");
    browser.click("#tab-graph");
    assert_eq!(browser.count("document.querySelectorAll('#view-graph section').length"), 2);
    browser.ask("select('pass:tone_map')");
    assert_eq!(browser.count("document.querySelectorAll('#view-graph g.selected').length"), 2, "in both");
    browser.screenshot("diff-graph");
    browser.has_no_errors();
}

#[test]
fn a_thousand_passes_are_drawn_as_far_as_they_are_in_sight() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    place.file("p.ron", back_and_forth(1000));
    let (plan, page) = plan_and_page(&place, &["p.ron"]);
    let size = page.metadata().expect("written").len();
    assert!(size <= 5 << 20, "{size} bytes");
    browser.open_file(&page, "#view=graph");
    assert_eq!(browser.count("models[0].nodes.length"), nodes(&plan));
    for (view, scroll, most) in [
        ("graph", "box.show(0, 9000, 10, 10)", 600),
        ("timeline", "box.scrollTop = 9000; box.scrollLeft = 9000", 900),
        ("grid", "box.scrollTop = 9000; box.scrollLeft = 9000", 900),
    ] {
        browser.click(&format!("#tab-{view}"));
        let begin = browser.text("String(performance.now())");
        let made = format!(
            "(() => {{ const before = elementsMade; const box = document.querySelector('.view-panel:not([hidden]) :is(.scroller, .canvas)'); {scroll}; \
             return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(elementsMade - before)))); }})()"
        );
        let made = browser.count(&made);
        assert!(made > 20 && made < most, "{made} elements for a step of scrolling in {view}");
        println!("{view}: {made} elements, at {begin} ms");
    }
    browser.ask("select('pass:p900')");
    browser.settle();
    assert_eq!(
        browser.count("document.querySelectorAll('#view-grid g.selected').length > 0 ? 1 : 0"),
        1,
        "it is brought in sight"
    );
    browser.has_no_errors();
}

#[test]
fn of_a_plan_that_is_too_large_the_page_is_a_summary_and_says_so() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    let passes = if sweep::is_long() { 100_000 } else { 20_000 };
    place.file("p.ron", back_and_forth(passes));
    place.run(&["inspect", "p.ron", "--format", "html", "-o", "page.html"]).exits(0);
    let page = place.path("page.html");
    assert!(page.metadata().expect("written").len() < 2 << 20, "{:?}", page.metadata());
    browser.open_file(&page, "#view=steps");
    assert_eq!(browser.count("document.querySelectorAll('#view-steps details').length"), 200);
    browser.click("#tab-graph");
    let shown = browser.text("document.querySelector('#view-graph').innerText");
    assert!(shown.contains(&format!("This Plan has {passes} steps.")));
    browser.click("#tab-overview");
    let shown = browser.text("document.querySelector('#view-overview').innerText");
    assert!(shown.contains("barriers") && !shown.contains('`'), "{shown}");
    browser.has_no_errors();
    let said = place.run(&["inspect", "p.ron", "--format", "svg"]).exits(1);
    said.mentions(&format!("a picture of {passes} passes can't be read"));
}
