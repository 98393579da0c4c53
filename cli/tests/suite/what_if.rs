//! Pages that compile their pipeline anew, by WebAssembly (LV-8).

use crate::testing::browser::Browser;
use crate::testing::{Place, repository, shipped_pipelines};
use framewright_graph::device::SHIPPED_PROFILES;
use framewright_tests::sweep;
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// A page may have this many bytes more for it.
const MOST_MORE: u64 = 3 << 20;

/// Whether there is a compiler for pages, which CI demands.
fn is_built() -> bool {
    let there = repository("target/what-if.wasm").exists();
    assert!(there || std::env::var_os("CI").is_none(), "no compiler for pages: .ci/what-if.sh");
    if !there {
        println!("skipped: no compiler for pages (.ci/what-if.sh)");
    }
    there
}

/// The page of a pipeline.
fn page(place: &Place, name: &str, more: &[&str]) -> PathBuf {
    let arguments = ["inspect", name, "--format", "html", "--what-if", "-o", "page.html"];
    place.run(&[&arguments, more].concat()).exits(0);
    place.path("page.html")
}

/// A browser that shows the view of a page.
fn shown(page: &std::path::Path) -> Option<Browser> {
    let mut browser = Browser::start()?;
    browser.open_file(page, "#view=what-if");
    browser.until("document.getElementById('what-if-status').textContent === 'This is the Plan of the page.'");
    Some(browser)
}

/// Has the page compile with a change of its choices, such as `it.extent = [1, 1]`, and waits for the answer.
fn change(browser: &mut Browser, change: &str) -> String {
    browser.ask(&format!(
        "(async () => {{ clearTimeout(whatIf.timer); const it = whatIf.choices; {change}; showChoices(); await compileAnew(); }})()"
    ));
    browser.text("document.getElementById('what-if-status').textContent")
}

#[test]
fn lv_8_the_plan_of_webassembly_is_the_commands_byte_for_byte() {
    if !is_built() {
        return;
    }
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    let devices: Vec<&str> = SHIPPED_PROFILES.iter().map(|(name, _)| *name).collect();
    let mut compared = 0;
    for name in sweep::of("pipelines by WebAssembly", shipped_pipelines(), 5) {
        browser.open_file(&page(&place, &name, &[]), "#view=what-if");
        let plans = browser.ask(&format!(
            "(async () => {{ await unpackWhatIf(); const plans = []; for (const device of {}) {{ \
             const answer = await askCompiler({{ ...whatIf.subject.own, device }}, 'plan'); \
             plans.push(answer.plan ?? answer.wrong.message); }} return plans; }})()",
            json!(devices)
        ));
        let plans = plans.as_array().expect("a list");
        assert_eq!(plans.len(), devices.len());
        let every = devices.iter().zip(plans).collect();
        for (device, plan) in sweep::of(&format!("Plans of {name} by WebAssembly"), every, 3) {
            let said = place.run(&["inspect", &name, "--device", device, "--format", "json"]);
            let expected = if said.code == Some(0) { said.out } else { said.err };
            let plan = plan.as_str().expect("a text");
            assert!(plan == expected, "{name} on {device}: {} and {} bytes", plan.len(), expected.len());
            compared += 1;
        }
        browser.has_no_errors();
    }
    assert!(compared >= 15, "{compared}");
}

#[test]
fn lv_8_choices_and_lines_that_change_give_another_plan_in_every_view() {
    if !is_built() {
        return;
    }
    let place = Place::new();
    let scene = ["--scene", "courtyard", "--device", "mali-g78"];
    place.run(&[&["inspect", "forward", "--format", "html", "-o", "plain.html"][..], &scene].concat()).exits(0);
    let page = page(&place, "forward", &scene);
    let bytes = |name: &str| fs::metadata(place.path(name)).expect("written").len();
    assert!(bytes("page.html") - bytes("plain.html") < MOST_MORE, "{}", bytes("page.html"));
    let Some(mut browser) = shown(&page) else { return };
    browser.screenshot("what-if-own");

    // Another size: what the command says of it.
    let said = change(&mut browser, "it.extent = [640, 360]");
    assert!(said.contains("differences from the Plan of the page; compiled in"), "{said}");
    let smaller = ["inspect", "forward", "--size", "640x360", "--format", "json"];
    let smaller = place.run(&[&smaller[..], &scene].concat()).exits(0).out;
    assert!(browser.text("askCompiler(whatIf.choices, 'plan').then((answer) => answer.plan)") == smaller);
    let is_shown = format!("models.length === 2 && JSON.stringify(models[1].plan) === JSON.stringify({smaller})");
    assert_eq!(browser.ask(&is_shown), Value::Bool(true));
    assert!(browser.count("document.querySelectorAll('#what-if-result .sums tbody tr').length") > 0);
    browser.ask("showView('memory')");
    assert_eq!(browser.count("document.querySelectorAll('#view-memory section').length"), 2, "both stand side by side");
    browser.ask("showView('what-if')");

    // A pass that is left out, a setting, another device.
    let said = change(&mut browser, "it.extent = whatIf.subject.own.extent; it.left_out = ['transparent']");
    assert!(said.contains("difference"), "{said}");
    assert_eq!(browser.ask("models[1].byKey.has('pass:transparent')"), Value::Bool(false));
    browser.screenshot("what-if-left-out");
    let said = change(&mut browser, "it.left_out = []; it.set = [['msaa', '1']]");
    assert!(said.contains("difference"), "{said}");
    let said = change(&mut browser, "it.set = []; it.device = 'nvidia-rtx-2080'");
    assert!(said.contains("difference"), "{said}");
    assert_eq!(browser.text("models[1].plan.device.name"), "NVIDIA GeForce RTX 2080");

    // Back where it began.
    browser.click("#what-if-begun");
    browser.until("models.length === 1 && document.getElementById('what-if-status').textContent.startsWith('This is the Plan of the page')");
    browser.has_no_errors();
}

#[test]
fn lv_8_mistakes_are_those_of_check_at_their_lines() {
    if !is_built() {
        return;
    }
    let place = Place::new();
    let forward = fs::read_to_string(repository("examples/pipelines/forward.ron")).expect("a text");
    place.file("forward.ron", &forward);
    let page = page(&place, "forward.ron", &[]);
    let Some(mut browser) = shown(&page) else { return };
    let wrong = forward.replacen("format: ", "fromat: ", 1);
    let line = 1 + forward[..forward.find("format: ").expect("a format")].matches('\n').count();
    browser.ask(&format!(
        "(() => {{ const text = document.getElementById('what-if-text'); text.focus(); text.value = {}; text.dispatchEvent(new Event('input')); }})()",
        json!(wrong)
    ));
    browser.until("document.querySelector('#what-if-result .wrong') !== null");
    place.file("forward.ron", &wrong);
    let said = place.run(&["check", "forward.ron"]).exits(1).err;
    let shown = browser.text("document.querySelector('#what-if-result .wrong').textContent");
    assert!(said.starts_with(shown.trim_end()), "{shown}\n{said}");
    assert_eq!(browser.text("document.querySelector('.lines .bad').textContent"), line.to_string());
    assert_eq!(browser.text("document.activeElement.id"), "what-if-text", "the text keeps the cursor");
    browser.screenshot("what-if-wrong");
    browser.click("#what-if-result .place");
    assert_eq!(
        browser.ask("whatIf.area.value.slice(0, whatIf.area.selectionStart).split('\\n').length"),
        Value::from(line)
    );
    // Digits and slashes are letters of the text, and choose no view.
    browser.press("1");
    assert_eq!(browser.text("state.view"), "what-if");

    for (change_of_it, expected) in [
        ("it.texts = {}; it.extent = [0, 99999]", "the frame can't be 0×99999: 1 to 16384 texels are allowed"),
        ("it.extent = [64, 64]; it.device = 'toaster'", "there is no device profile `toaster`"),
        ("it.device = 'lavapipe'; it.set = [['nothing', '1']]", "`nothing`"),
        ("it.set = []; it.left_out = ['<img src=x onerror=alert(1)>\\u202e\")']", "<img src=x"),
        ("it.left_out = []; it.texts = { 'forward.ron': '' }", "the file is empty"),
        ("it.texts = { 'forward.ron': '('.repeat(200000) }", "nested too deeply"),
        (
            "it.texts = { 'forward.ron': whatIf.subject.files[0].text.replace('version: 1,', 'version: 1, include: [\"nothing.ron\"],') }",
            "`nothing.ron` isn't among the files that this page carries",
        ),
    ] {
        change(&mut browser, change_of_it);
        let shown = browser.text("document.querySelector('#what-if-result .wrong').textContent");
        assert!(shown.contains(expected), "{change_of_it}: {shown}");
    }
    assert_eq!(browser.count("document.querySelectorAll('#what-if-result img').length"), 0);
    let said = change(&mut browser, "it.texts = { 'forward.ron': 'x'.repeat(1000001) }");
    assert!(said.contains("too long"), "{said}");

    // After all of that the page compiles as before.
    let said = change(&mut browser, "Object.assign(it, structuredClone(whatIf.subject.own))");
    assert!(said.starts_with("This is the Plan of the page"), "{said}");
    browser.has_no_errors();
}

#[test]
fn lv_8_a_shader_that_the_page_lacks_is_told() {
    if !is_built() {
        return;
    }
    let place = Place::new();
    let forward = fs::read_to_string(repository("examples/pipelines/forward.ron")).expect("a text");
    place.file("forward.ron", &forward);
    let Some(mut browser) = shown(&page(&place, "forward.ron", &[])) else { return };
    change(
        &mut browser,
        "it.texts = { 'forward.ron': it.texts['forward.ron'] ?? whatIf.subject.files[0].text.replace('\"sky\"', '\"another_sky\"').replace('shader: \"lit\"', 'shader: \"other\"') }",
    );
    let shown = browser.text("document.querySelector('#what-if-result')?.textContent ?? ''");
    assert!(shown.contains("this page doesn't carry it"), "{shown}");
}

#[test]
fn lv_8_a_page_of_another_build_and_an_old_browser_say_so() {
    if !is_built() {
        return;
    }
    let place = Place::new();
    let page = page(&place, "post", &[]);
    let text = fs::read_to_string(&page).expect("a page");
    let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    assert_eq!(text.matches(&version).count(), 1);
    let other = place.file("other.html", text.replace(&version, "\"version\":\"0.0.9\""));
    let Some(mut browser) = Browser::start() else { return };
    let status = "document.getElementById('what-if-status').textContent";
    browser.open_file(&other, "#view=what-if");
    browser.until(&format!("{status}.includes('is another one than that of the command')"));
    drop(browser);
    // It has no WebAssembly then.
    let Some(mut old) = Browser::start_with(&["--js-flags=--jitless"]) else { return };
    old.open_file(&page, "#view=what-if");
    old.until(&format!("{status}.startsWith('Nothing is compiled here')"));
    old.ask("showView('graph')");
    assert!(old.count("document.querySelectorAll('#view-graph g[data-key]').length") > 0, "all else works");
}

#[test]
fn lv_8_without_the_compiler_the_command_says_how_it_is_made() {
    let place = Place::new();
    fs::create_dir(place.path("alone")).expect("made");
    let alone = place.path("alone/framewright");
    fs::copy(env!("CARGO_BIN_EXE_framewright"), &alone).expect("copied");
    let run = |more: &[&str]| {
        let mut command = Command::new(&alone);
        command.args(["inspect", "post", "--what-if", "-o", "page.html"]).args(more).current_dir(place.path(""));
        crate::testing::outcome(&mut command)
    };
    run(&["--format", "html"]).exits(3).mentions("[E1311]").mentions(".ci/what-if.sh makes it");
    fs::write(place.path("what-if.wasm"), "no module").expect("written");
    run(&["--format", "html"]).exits(3).mentions("[E1311]").mentions("no compiler for pages");
    run(&["--format", "tree"]).exits(2).mentions("add `--format html`");
    assert!(!place.path("page.html").exists());
}
