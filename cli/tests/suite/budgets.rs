//! Budgets, and what a check found in the forms of CI systems (IN-10, IN-12).

use crate::testing::{FORWARD, Place};
use serde_json::Value;

const BUDGET: &str = "Budget(version: 1, limits: [\n    (resolves: 0, memory_mib: 40),\n    (settings: {\"msaa\": 1}, barriers: 3),\n    \
    (device: \"mali-g78\", stored_mib: 1.5),\n])\n";

/// A place with the first pipeline and a budget.
fn place(budget: &str) -> Place {
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    place.file("budget.ron", budget);
    place
}

const CHECK: [&str; 4] = ["check", "first.ron", "--budget", "budget.ron"];

#[test]
fn a_breach_names_the_bound_the_step_that_breaks_it_and_the_limit() {
    let place = place(BUDGET);
    let err = place.run(&CHECK).exits(1).err;
    assert!(
        err.contains("the budget is exceeded: resolves 1, and at most 0 are allowed [E1503]\n  --> first.ron:27:32"),
        "{err}"
    );
    assert!(err.contains("in step 0, `resolve color`: `tone_map` samples `color` and it has 4 samples"), "{err}");
    assert!(
        err.contains("transient memory 49.22 MiB, and at most 40.00 MiB are allowed [E1503]\n  --> first.ron:19:16"),
        "{err}"
    );
    assert!(err.contains("::: budget.ron:2:5"), "{err}");
    assert_eq!(err.matches("the budget is exceeded").count(), 2, "the other limits are not for this Plan: {err}");
    // Exactly what there is, is within the bound; anything less is not.
    let limit = |bound: &str| format!("Budget(version: 1, limits: [({bound})])");
    let bounds = [("passes", 3.0), ("scopes", 2.0), ("resolves", 1.0), ("barriers", 5.0), ("barrier_calls", 2.0)];
    let bytes =
        [("stored_mib", 3.515_625), ("resolved_mib", 7.031_25), ("moved_mib", 10.546_875), ("memory_mib", 49.218_75)];
    for (bound, amount) in bounds.into_iter().chain(bytes) {
        place.file("budget.ron", limit(&format!("{bound}: {amount}")));
        place.run(&CHECK).exits(0);
        let less = if bound.ends_with("mib") { amount - 0.001 } else { amount - 1.0 };
        place.file("budget.ron", limit(&format!("{bound}: {less}")));
        place.run(&CHECK).exits(1).mentions("the budget is exceeded");
    }
}

#[test]
fn limits_are_for_the_variants_and_devices_that_they_name() {
    let place = place("Budget(version: 1, limits: [(device: \"mali-g78\", stored_mib: 1.5)])");
    let on = |device: &str| place.run(&[&CHECK[..], &["--device", device, "--set", "msaa=2"]].concat());
    on("lavapipe").exits(0);
    on("mali-g78").exits(1).mentions("stored 10.55 MiB, and at most 1.50 MiB are allowed");
    let all =
        place.run(&[&CHECK[..], &["--device", "all", "--set", "msaa=2", "--format", "json"]].concat()).exits(1).out;
    let all: Value = serde_json::from_str(&all).expect("JSON");
    let fine = all["devices"].as_array().expect("devices").iter().map(|device| (&device["profile"], &device["fine"]));
    let refused: Vec<&Value> = fine.filter(|(_, fine)| **fine == false).map(|(profile, _)| profile).collect();
    assert_eq!(refused, ["mali-g78"]);
    // Verdicts that variants share otherwise are told apart by the settings that a limit names.
    let pipeline =
        FORWARD.replace("settings: [", "settings: [(name: \"unread\", value: OneOf(default: 1, of: [1, 2])),");
    place.file("forward.ron", &pipeline);
    place.file("budget.ron", "Budget(version: 1, limits: [(settings: {\"unread\": 2}, passes: 0)])");
    let report = place
        .run(&["check", "forward.ron", "--budget", "budget.ron", "--all-variants", "--format", "json"])
        .exits(1)
        .out;
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let [failing, checked] = ["failing", "checked"].map(|name| report[name].as_u64().expect("a number"));
    assert_eq!(failing * 2, checked, "each variant with the value 2, and no other");
}

#[test]
fn lv_4_hints_are_bounded_together_and_by_code() {
    let place = Place::new();
    let check = |hints: &str, code: i32| {
        place.file("budget.ron", format!("Budget(version: 1, limits: [(hints: {hints})])"));
        place.run(&["check", "deferred", "--budget", "budget.ron"]).exits(code).err
    };
    check("5", 0);
    let all = check("4", 1);
    assert!(all.contains("the budget is exceeded: hints 5, and at most 4 are allowed [E1503]"), "{all}");
    assert!(all.contains("deferred.ron:37:16") && all.contains("`shadow` is 64.0 MiB of 105.6 MiB"), "{all}");
    check("{\"H01\": 1, \"H02\": 2, \"H04\": 2, \"H05\": 0}", 0);
    let loaded = check("{\"H02\": 2, \"H04\": 1}", 1);
    assert!(loaded.contains("the budget is exceeded: hints H04 2, and at most 1 are allowed [E1503]"), "{loaded}");
    assert!(
        loaded.contains("`color` is stored by the scope of `lighting`") && !loaded.contains("hints H02"),
        "{loaded}"
    );
}

#[test]
fn a_wrong_budget_is_told_with_its_place() {
    let place = place("");
    for (budget, expected) in [
        ("", "budget.ron:1:1"),
        ("Budget(version: 2, limits: [])", "this is version 2 of budgets"),
        ("Budget(version: 1, limits: [(resolve: 1)])", "budget.ron:1:30"),
        ("Budget(version: 1, limits: [(memory_mib: NaN)])", "a bound on transient memory can't be NaN"),
        ("Budget(version: 1, limits: [(memory_mib: -1)])", "a bound on transient memory can't be -1"),
        ("Budget(version: 1, limits: [(resolves: -1)])", "budget.ron:1:"),
        ("Budget(version: 1, limits: [(settings: {\"msa\": 1}, resolves: 1)])", "did you mean `msaa`?"),
        (
            "Budget(version: 1, limits: [(settings: {\"msaa\": [1]}, resolves: 1)])",
            "is a number, a text, true or false",
        ),
        ("Budget(version: 1, limits: [(device: \"x\")])", "the limit bounds nothing"),
        ("Budget(version: 1, limits: [(hints: {})])", "the limit bounds nothing"),
        ("Budget(version: 1, limits: [(hints: {\"H99\": 1})])", "there are no hints `H99`"),
        ("Budget(version: 1, limits: [(hints: -1)])", "budget.ron:1:"),
        ("Budget(version: 1, limits: [\n\n(resolves: 1),\n(öl: 1)])", "budget.ron:4:2"),
    ] {
        place.file("budget.ron", budget);
        place.run(&CHECK).exits(1).mentions(expected);
    }
    place.run(&["check", "first.ron", "--budget", "gone.ron"]).exits(1).mentions("the budget `gone.ron` can't be read");
}

#[test]
fn ci_systems_are_told_each_finding_with_its_place() {
    let place = place(BUDGET);
    let check = |format: &str, code: i32| place.run(&[&CHECK[..], &["--format", format]].concat()).exits(code).out;
    let sarif: Value = serde_json::from_str(&check("sarif", 1)).expect("JSON");
    let results = sarif["runs"][0]["results"].as_array().expect("results");
    assert_eq!(results.len(), 2);
    let region = &results[0]["locations"][0]["physicalLocation"];
    assert_eq!((&region["artifactLocation"]["uri"], &region["region"]["startLine"]), (&"first.ron".into(), &27.into()));
    assert_eq!(results[0]["ruleId"], "E1503");
    assert_eq!(results[0]["relatedLocations"][0]["physicalLocation"]["artifactLocation"]["uri"], "budget.ron");
    let xml = check("junit", 1);
    assert!(xml.contains("<testsuites tests=\"1\" failures=\"1\" errors=\"0\">"), "{xml}");
    assert!(xml.contains("type=\"E1503\">first.ron:27:32: the budget is exceeded: resolves 1"), "{xml}");
    let github = check("github", 1);
    let first = github.lines().next().expect("a line");
    assert!(
        first.starts_with("::error title=framewright%2C ")
            && first.contains(",file=first.ron,line=27,endLine=27,col=32,endColumn=41::"),
        "{first}"
    );
    assert!(first.ends_with("%0Abudget.ron:2:5: the limit"), "{first}");
    // Without a finding each form says so.
    place.file("budget.ron", "Budget(version: 1, limits: [(resolves: 9)])");
    assert_eq!(check("github", 0), "::notice title=framewright::first.ron is fine: 1 case\n");
    assert!(check("junit", 0).contains("failures=\"0\""));
    let sarif: Value = serde_json::from_str(&check("sarif", 0)).expect("JSON");
    assert_eq!(sarif["runs"][0]["results"], Value::Array(Vec::new()));
    // All variants, and all devices.
    for more in [&["--all-variants"][..], &["--device", "all"]] {
        for format in ["sarif", "junit", "github"] {
            place.file("budget.ron", BUDGET);
            let out = place.run(&[&CHECK[..], more, &["--format", format]].concat()).exits(1).out;
            assert!(out.contains("the budget is exceeded: resolves 1"), "{more:?} {out}");
        }
    }
}

#[test]
fn names_of_files_can_not_act_in_any_form() {
    let place = place(BUDGET);
    let evil = "a,b::error title=x%0A&<b>\"\u{202e}.ron";
    std::fs::rename(place.path("first.ron"), place.path(evil)).expect("moved");
    let check = |format: &str| place.run(&["check", evil, "--budget", "budget.ron", "--format", format]).exits(1).out;
    let github = check("github");
    assert!(github.lines().all(|line| line.contains(",file=a%2Cb%3A%3Aerror title=x%250A&<b>")), "{github}");
    assert_eq!(github.lines().count(), 2, "{github}");
    let xml = check("junit");
    assert!(!xml.contains("<b>") && !xml.contains('\u{202e}') && xml.contains("&amp;&lt;b&gt;&quot;"), "{xml}");
    let sarif: Value = serde_json::from_str(&check("sarif")).expect("JSON");
    let uri = &sarif["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"];
    assert_eq!(uri, "a%2Cb%3A%3Aerror%20title%3Dx%250A%26%3Cb%3E%22%E2%80%AE.ron");
}
