//! The differences between two Plans (IN-4, IN-7) are held against their JSON forms.

use crate::testing::graphs;
use crate::testing::pipelines::{INPUTS, right, set, shipped};
use crate::testing::plans::{self, compiled, on};
use crate::testing::raster::{self, Raster};
use framewright_graph::device::SHIPPED_PROFILES;
use framewright_graph::difference::{Change, Differences, Entry, Kind};
use framewright_graph::expand::Inputs;
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::Format;
use serde_json::Value;
use std::collections::BTreeSet;

fn plan(pipeline: &str, chosen: &[(&str, &str)]) -> Plan {
    let chosen = set(chosen);
    compiled(&right(&shipped(pipeline), &Inputs { set: &chosen, ..INPUTS }))
}

/// Plans of several pipelines, settings and devices.
fn some_plans() -> Vec<Plan> {
    let frame = right(&shipped("forward.ron"), &INPUTS);
    let devices = SHIPPED_PROFILES.iter().filter_map(|(name, _)| on(&frame, &plans::shipped(name)).ok());
    let more = [plan("forward.ron", &[("msaa", "1")]), plan("forward.ron", &[("tone_mapping", "false")])];
    devices.chain(more).collect()
}

fn between(a: &Plan, b: &Plan) -> Differences {
    Differences::between(("a.ron", a), ("b.ron", b))
}

fn of_kind(found: &Differences, kind: Kind) -> Vec<&Entry> {
    found.entries.iter().filter(|entry| entry.kind == kind).collect()
}

fn json(plan: &Plan) -> Value {
    serde_json::from_str(&plan.to_json().expect("JSON")).expect("JSON")
}

#[test]
fn a_plan_has_no_difference_to_itself() {
    for plan in some_plans() {
        let found = between(&plan, &plan);
        assert!(found.is_empty(), "{}", found.text());
        assert!(found.text().ends_with("\nno difference\n") && found.markdown().ends_with("\nNo difference.\n"));
    }
}

#[test]
fn the_other_way_round_what_was_added_is_removed() {
    let plans = some_plans();
    for (a, b) in plans.iter().flat_map(|a| plans.iter().map(move |b| (a, b))) {
        let key = |entry: &Entry, swap: bool| {
            let (change, fields) = match &entry.change {
                Change::Added { fields } => (if swap { 2 } else { 1 }, fields),
                Change::Removed { fields } => (if swap { 1 } else { 2 }, fields),
                Change::Changed { fields } => (0, fields),
            };
            let fields = fields.iter().map(|field| {
                let (a, b) = if swap { (&field.b, &field.a) } else { (&field.a, &field.b) };
                (field.name, a.clone(), b.clone())
            });
            // The fields of B's entry come first.
            let mut fields: Vec<_> = fields.collect();
            fields.sort();
            (entry.kind, entry.name.clone(), change, fields)
        };
        let [forth, back] = [(between(a, b), false), (between(b, a), true)].map(|(found, swap)| {
            let mut all: Vec<_> = found.entries.iter().map(|entry| key(entry, swap)).collect();
            all.sort();
            all
        });
        assert_eq!(forth, back);
    }
}

/// Images and passes that only one Plan has are those that only its JSON form has; sums are those of the JSON forms.
#[test]
fn only_what_one_plan_alone_has_is_added_or_removed() {
    let graphs = [graphs::deferred(), graphs::chain(9), graphs::wide(5), graphs::local(7)];
    let all: Vec<Plan> =
        graphs.iter().map(compiled).chain([plan("forward.ron", &[]), plan("soft_focus.ron", &[])]).collect();
    let pairs = all.iter().flat_map(|a| all.iter().map(move |b| (a, b)));
    let mut passes = 0;
    for (a, b) in pairs {
        let found = between(a, b);
        let [in_a, in_b] = [a, b].map(json);
        let names = |plan: &Value| -> BTreeSet<String> {
            plan["images"]
                .as_array()
                .expect("images")
                .iter()
                .map(|it| format!("`{}`", it["name"].as_str().expect("a name")))
                .collect()
        };
        let only = |kind: Kind, added: bool| -> BTreeSet<String> {
            let is = |entry: &&&Entry| match entry.change {
                Change::Added { .. } => added,
                Change::Removed { .. } => !added,
                Change::Changed { .. } => false,
            };
            of_kind(&found, kind).iter().filter(is).map(|entry| entry.name.clone()).collect()
        };
        let [of_a, of_b] = [&in_a, &in_b].map(names);
        assert_eq!(only(Kind::Image, true), &of_b - &of_a);
        assert_eq!(only(Kind::Image, false), &of_a - &of_b);
        passes += only(Kind::Pass, true).len();
        let total =
            |name: &str| found.totals.iter().find(|figure| figure.name == name).map(|figure| [figure.a, figure.b]);
        for (name, key) in [
            ("passes", "passes"),
            ("resolves", "resolves"),
            ("placed memory", "placed_bytes"),
            ("barrier calls", "barrier_calls"),
        ] {
            let [a, b] = [&in_a, &in_b].map(|plan| plan["totals"][key].as_u64().expect("a number"));
            assert_eq!(total(name), Some([a, b]), "{name}");
        }
        for plan in [a, b] {
            let steps = plan.steps.iter().map(|step| plan.moved_by(step).sum()).sum::<u64>();
            assert_eq!(plan.moved().sum(), steps);
        }
    }
    assert!(passes > 20, "{passes}");
}

/// A pass that leaves a rendering scope takes nothing with it that the scope needs as before.
#[test]
fn what_a_scope_needs_stays_when_its_first_pass_leaves() {
    let graph = |passes: &str| {
        let text = format!(
            r#"Pipeline(
    version: 1,
    images: [(name: "color", format: Color(), size: Output), (name: "screen", format: Output, size: Output)],
    passes: [{passes}
        (name: "glass", draw: Objects(Transparent), shader: "lit", color: ["color"]),
        (name: "show", draw: FullScreen("reinhard"), sample: {{"source": "color"}}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#
        );
        compiled(&right(&text, &INPUTS))
    };
    const CLEARED: &str = r#"[(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]"#;
    let opaque = |color: &str| format!(r#"(name: "opaque", draw: Objects(Opaque), shader: "lit", color: {color}),"#);
    let sky = format!(r#"(name: "sky", draw: Sky, color: {CLEARED}),"#);
    let a = graph(&(sky + &opaque(r#"["color"]"#)));
    let b = graph(&opaque(CLEARED));
    assert_eq!(a.totals.scopes, b.totals.scopes);
    let found = between(&a, &b);
    // Passes tell whose scope they are in; attachments, barriers and resolves are the same.
    let told: Vec<(Kind, &str)> = found.entries.iter().map(|entry| (entry.kind, &*entry.name)).collect();
    assert_eq!(told, ["`opaque`", "`glass`", "`sky`"].map(|name| (Kind::Pass, name)), "{}", found.text());
}

/// With 4 samples `forward` draws into 4 samples a texel, keeps none of them and resolves once.
#[test]
fn samples_bring_a_resolve_and_its_cause() {
    let found = between(&plan("forward.ron", &[("msaa", "1")]), &plan("forward.ron", &[("msaa", "4")]));
    let [resolve] = of_kind(&found, Kind::Resolve)[..] else { panic!("{}", found.text()) };
    assert_eq!(resolve.name, "`color` → `color (resolved)`");
    assert_eq!(resolve.because.as_deref(), Some("`tone_map` samples `color` and it has 4 samples"));
    assert!(matches!(resolve.change, Change::Added { .. }), "{resolve:?}");
    let text = found.text();
    for said in [
        "\n  ~ `msaa`: value 4 (was 1)\n",
        "\n  ~ `tone_map`: binds source = `color (resolved)` (was source = `color`) (test.ron:54)\n",
        ", of the scope of `opaque`: store DONT_CARE (was STORE); ",
    ] {
        assert!(text.contains(said), "`{said}` is not in\n{text}");
    }
    // 640 × 360 texels of 8 bytes: stored with one sample, written by the resolve with four.
    let moved = |name: &str| found.totals.iter().find(|figure| figure.name == name).map(|figure| [figure.a, figure.b]);
    let (color, screen) = (640 * 360 * 8, 640 * 360 * 4);
    assert_eq!(moved("stored"), Some([color + screen, screen]));
    assert_eq!(moved("resolved"), Some([0, color]));
    assert_eq!(moved("loaded"), Some([0, 0]));
}

/// IN-12: nothing in a name acts in Markdown, HTML or on a terminal. Pipelines have no such names, and a Plan in a file may.
#[test]
fn names_do_not_act() {
    let plan = plan("forward.ron", &[]);
    let hostile = r#""<img onerror=x>|`[a](b)*_\u001b\u202e@all #1""#;
    let text = plan.to_json().expect("JSON").replace("\"tone_map\"", hostile);
    let found = between(&plan, &Plan::from_json(&text).expect("a Plan"));
    let markdown = found.markdown();
    assert!(markdown.contains("&lt;img onerror=x&gt;\\|\\`\\[a\\](b)\\*\\_"), "{markdown}");
    for letter in ['\u{1b}', '\u{202e}'] {
        assert!(!markdown.contains(letter) && !found.text().contains(letter), "{letter:?}");
    }
    assert!(!markdown.contains("<img") && !markdown.contains("@all") && !markdown.contains("#1"), "{markdown}");
}

/// The leaves of a JSON form: the way to each.
fn leaves(value: &Value, at: &str, found: &mut Vec<String>) {
    match value {
        Value::Array(list) => (0..).zip(list).for_each(|(index, one)| leaves(one, &format!("{at}/{index}"), found)),
        Value::Object(fields) => fields.iter().for_each(|(name, one)| leaves(one, &format!("{at}/{name}"), found)),
        _ => found.push(at.to_owned()),
    }
}

/// Another value of the same kind; of a word each of those that stand anywhere in the Plan under the same name.
fn others(value: &Value, words: &[Value]) -> Vec<Value> {
    match value {
        Value::Bool(truth) => vec![Value::Bool(!truth)],
        Value::Number(number) if number.is_f64() => vec![(number.as_f64().unwrap_or_default() + 0.25).into()],
        Value::Number(number) => vec![(2 * number.as_u64().unwrap_or_default() + 1).into()],
        Value::String(_) => words.iter().filter(|word| *word != value).take(2).cloned().collect(),
        _ => Vec::new(),
    }
}

/// Whatever is changed in a Plan, but for numbers of steps, offsets, memory types and reasons, the difference is told.
#[test]
fn every_change_of_a_plan_is_told() {
    let unsaid = [
        "/id",
        "/format_version",
        "/offset",
        "/alignment",
        "/type_bits",
        "/heap",
        "/lifetime/0",
        "/lifetime/1",
        "/after",
        "/needed_by",
        "/because",
        "/line",
        "/file",
        "/at",
        "/step",
        "/exact_memory",
        "/merged",
        "/written",
    ];
    let (mut missed, mut told) = (BTreeSet::new(), 0);
    for plan in [plan("forward.ron", &[]), plan("soft_focus.ron", &[]), compiled(&graphs::deferred())] {
        let whole = json(&plan);
        let mut all = Vec::new();
        leaves(&whole, "", &mut all);
        for path in all {
            if unsaid.iter().any(|end| path.ends_with(end))
                || path.starts_with("/heaps/")
                || path.starts_with("/totals/live_peak")
                || path.starts_with("/decided")
                || path.starts_with("/changes")
            {
                continue;
            }
            let name = path.rsplit('/').find(|part| part.parse::<u32>().is_err()).unwrap_or_default();
            let mut words = Vec::new();
            collect(&whole, name, &mut words);
            for other in others(&whole.pointer(&path).cloned().unwrap_or_default(), &words) {
                let mut changed = whole.clone();
                *changed.pointer_mut(&path).expect("it is there") = other;
                let Ok(changed) = Plan::from_json(&changed.to_string()) else { continue };
                if between(&plan, &changed).is_empty() {
                    let place: Vec<&str> =
                        path.split('/').map(|part| if part.parse::<u32>().is_ok() { "…" } else { part }).collect();
                    missed.insert(place.join("/"));
                } else {
                    told += 1;
                }
            }
        }
    }
    assert!(told > 1000, "{told}");
    assert_eq!(missed, BTreeSet::new(), "these can change, and nothing is told");
}

/// All texts that stand under a name.
fn collect(value: &Value, name: &str, found: &mut Vec<Value>) {
    let mut add = |one: &Value| {
        if one.is_string() && !found.contains(one) {
            found.push(one.clone());
        }
    };
    match value {
        Value::Array(list) => list.iter().for_each(|one| collect(one, name, found)),
        Value::Object(fields) => {
            if let Some(one) = fields.get(name) {
                add(one);
            }
            fields.values().for_each(|one| collect(one, name, found));
        }
        _ => {}
    }
}

#[test]
fn colours_that_change_their_locations_are_told() {
    let plan = |swapped: bool| {
        let mut raster = Raster::default();
        let [a, b] = ["a", "b"].map(|name| raster.image(name, Format::R8G8B8A8_UNORM, 1));
        let [first, then] = if swapped { [b, a] } else { [a, b] };
        raster.objects("draw").clear(first).clear(then);
        on(&raster.outputs(&[a, b]), &raster::device()).expect("it compiles")
    };
    let found = between(&plan(false), &plan(true));
    let told = of_kind(&found, Kind::Attachment).into_iter().map(|entry| match &entry.change {
        Change::Changed { fields } => fields.iter().map(|it| (it.name, it.a.as_deref(), it.b.as_deref())).collect(),
        Change::Added { .. } | Change::Removed { .. } => vec![],
    });
    let [one, other] = [Some("color 0"), Some("color 1")];
    let expected = [vec![("attached as", other, one)], vec![("attached as", one, other)]];
    assert_eq!(told.collect::<Vec<Vec<_>>>(), expected, "{}", found.text());
}

/// DO-9: in which frames a step runs is a difference, also of what is no pass.
#[test]
fn do_9_how_often_a_copy_and_a_fill_run_is_told() {
    let text = |run: &str| {
        format!(
            r#"Pipeline(version: 1, images: [], buffers: [(name: "a", bytes: 4), (name: "b", bytes: 4), (name: "c", bytes: 4)],
                passes: [(name: "fill", {run} fill: (to: "a", value: 7)), (name: "copy", {run} copy: (from: "a", to: "b")),
                         (name: "on", copy: (from: "b", to: "c"))],
                outputs: [(buffer: "c")])"#
        )
    };
    let [a, b] = ["", "run: Every(2),"].map(|run| compiled(&right(&text(run), &INPUTS)));
    let found = between(&a, &b);
    let of_transfers = of_kind(&found, Kind::Transfer);
    let runs = of_transfers.iter().filter(|entry| match &entry.change {
        Change::Changed { fields } => fields.iter().any(|field| field.name == "runs"),
        Change::Added { .. } | Change::Removed { .. } => false,
    });
    assert_eq!(runs.count(), 2, "{}", found.text());
}
