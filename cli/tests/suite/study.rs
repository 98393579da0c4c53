//! The study `docs/trade-offs.md`: its tables are those of the results beside it, and `choose` answers as it says (NU-1, NU-3, NU-6).

use crate::testing::{Place, repository};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Writes tables and answers into the page instead of comparing them.
const UPDATE: &str = "FRAMEWRIGHT_UPDATE";
const BEGIN: &str = "<!-- measured: ";
const PLANNED: &str = "<!-- planned: ";
const SHOWN: &str = "<!-- shown: ";
const END: &str = "<!-- end of what was measured -->\n";
const ASKED: &str = "```text\n$ framewright choose ";

fn rows(sweep: &str) -> Vec<Value> {
    let path = repository("docs/trade-offs").join(sweep).join("results.json");
    let file = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let results: Value = serde_json::from_str(&file).expect("JSON");
    results["rows"].as_array().expect("rows").clone()
}

/// A scene's name, as the page calls it.
fn scene_of(row: &Value) -> &str {
    row["scene"].as_str().expect("a scene").rsplit('/').next().expect("a name").trim_end_matches(".ron")
}

/// What the sweep chose, but for the scene.
fn choice_of(row: &Value) -> String {
    let chosen = row["choice"].as_object().expect("a choice").iter().filter(|(name, _)| *name != "@scene");
    let chosen: Vec<String> =
        chosen.map(|(name, value)| format!("`{name}={}`", value.as_str().expect("a text"))).collect();
    chosen.join(" ")
}

fn digits(number: &Value, digits: usize) -> String {
    number.as_f64().map_or("-".to_owned(), |number| format!("{number:.digits$}"))
}

/// The median of a time or ratio, and the quarters around it.
fn spread(of: &Value) -> String {
    let [median, low, high] = ["median", "low", "high"].map(|name| digits(&of[name], 2));
    format!("{median} ({low}–{high})")
}

/// A line for each choice: its cost on the first scene, and RMSE and FLIP on each. The last line has the references' own errors.
fn table(sweep: &str) -> String {
    let rows = rows(sweep);
    let mut scenes: Vec<&str> = Vec::new();
    let mut by_choice: Vec<(String, BTreeMap<&str, &Value>)> = Vec::new();
    for row in &rows {
        let (scene, choice) = (scene_of(row), choice_of(row));
        if !scenes.contains(&scene) {
            scenes.push(scene);
        }
        let at = by_choice.iter().position(|(other, _)| *other == choice).unwrap_or_else(|| {
            by_choice.push((choice, BTreeMap::new()));
            by_choice.len() - 1
        });
        by_choice[at].1.insert(scene, row);
    }
    let flickers = rows.iter().any(|row| row["outcome"]["measured"]["flicker"].is_object());
    let mut text = "| choice | of the baseline | MiB | moved MiB |".to_owned();
    scenes.iter().for_each(|scene| write!(text, " {scene}: RMSE | FLIP |").expect("a string takes everything"));
    text += if flickers { " flicker | 95 of 100 |" } else { "" };
    let columns = 4 + 2 * scenes.len() + 2 * usize::from(flickers);
    writeln!(text, "\n|{}", "---|".repeat(columns)).expect("a string takes everything");
    for (choice, by_scene) in by_choice {
        let first = &by_scene[scenes[0]]["outcome"];
        write!(text, "| {choice} |").expect("a string takes everything");
        if let Some(error) = first["failed"].as_str() {
            let empty = " - |".repeat(columns - 2);
            writeln!(text, " not measured: {} |{empty}", error.replace(['|', '\n'], " "))
                .expect("a string takes everything");
            continue;
        }
        let cost = &first["measured"]["cost"];
        let mebibytes = |of: &Value| of.as_f64().map_or("-".to_owned(), |bytes| format!("{:.1}", bytes / 1048576.0));
        let cells = [spread(&cost["gpu_ratio"]), mebibytes(&cost["transient_bytes"])];
        write!(text, " {} | {} |", cells.join(" | "), mebibytes(&cost["moved_bytes"]))
            .expect("a string takes everything");
        for scene in &scenes {
            let errors = &by_scene[scene]["outcome"]["measured"]["errors"];
            write!(text, " {} | {} |", digits(&errors["rmse"], 4), digits(&errors["flip"]["mean"], 4))
                .expect("a string takes everything");
        }
        if flickers {
            let flicker = &first["measured"]["flicker"];
            write!(text, " {} | {} |", digits(&flicker["mean"], 4), digits(&flicker["percentile_95"], 4))
                .expect("a string takes everything");
        }
        text.push('\n');
    }
    text += "| *the reference itself* | | | |";
    for scene in &scenes {
        // References of one scene may differ from choice to choice: the worst counts.
        let of_scene = rows.iter().filter(|row| scene_of(row) == *scene);
        let errors: Vec<&Value> = of_scene.map(|row| &row["outcome"]["measured"]["reference_errors"]).collect();
        let worst = |of: &dyn Fn(&Value) -> Option<f64>| {
            let worst = errors.iter().filter_map(|errors| of(errors)).fold(0.0, f64::max);
            format!("{worst:.4}")
        };
        let [rmse, flip] = [worst(&|it| it["rmse"].as_f64()), worst(&|it| it["flip"]["mean"].as_f64())];
        write!(text, " {rmse} | {flip} |").expect("a string takes everything");
    }
    text += if flickers { " | |\n" } else { "\n" };
    text
}

/// What Plans of some pipelines need for scenes of more and less, and for a scene that holds everything (NU-6).
fn planned(pipelines: &str) -> String {
    let place = Place::new();
    let mut text = "| pipeline | scene | passes | image barriers | MiB |\n|---|---|---|---|---|\n".to_owned();
    for pipeline in pipelines.split(' ') {
        for scene in ["one_unlit_cube", "opaque_only", "everything"] {
            let mut arguments = vec!["inspect", pipeline, "--size", "320x180", "--format", "json"];
            let file = repository("examples/sweeps").join(scene).with_extension("ron");
            if scene != "everything" {
                arguments.extend(["--scene", file.to_str().expect("a path")]);
            }
            let plan: Value = serde_json::from_str(&place.run(&arguments).exits(0).out).expect("JSON");
            let totals = &plan["totals"];
            let mebibytes = totals["placed_bytes"].as_f64().expect("bytes") / 1048576.0;
            let [passes, barriers] = [&totals["passes"], &totals["image_barriers"]];
            writeln!(text, "| `{pipeline}` | {scene} | {passes} | {barriers} | {mebibytes:.1} |")
                .expect("a string takes everything");
        }
    }
    text
}

/// Pictures and heat maps of some choices of a sweep, side by side: `SWEEP | A=1 B=2 | A=2 B=2`.
fn shown(wanted: &str) -> String {
    let (sweep, choices) = wanted.split_once(" | ").expect("a sweep and choices");
    let rows = rows(sweep);
    let [mut names, mut pictures, mut maps] = ["|", "|", "|"].map(str::to_owned);
    for choice in choices.split(" | ") {
        let holds = |row: &&Value| {
            choice.split(' ').all(|one| {
                let (name, value) = one.split_once('=').expect("NAME=VALUE");
                row["choice"][name] == value || (name == "@scene" && scene_of(row) == value)
            })
        };
        let found: Vec<&Value> = rows.iter().filter(holds).collect();
        let [row] = found[..] else { panic!("{} rows of {sweep} have {choice}", found.len()) };
        let measured = &row["outcome"]["measured"];
        let picture = |of: &str| {
            format!(" ![{of} of {choice}](trade-offs/{sweep}/{}) |", measured[of].as_str().expect("a picture"))
        };
        names += &format!(" `{}` |", choice.replace(' ', "` `"));
        pictures += &picture("picture");
        maps += &picture("heat_map");
    }
    let columns = "---|".repeat(choices.split(" | ").count());
    format!("{names}\n|{columns}\n{pictures}\n{maps}\n")
}

/// The page with what stands between two marks made anew.
fn made_anew(page: &str, begin: &str, end: &str, make: impl Fn(&str) -> String) -> String {
    let mut pieces = page.split(begin);
    let mut text = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (first, rest) = piece.split_once('\n').expect("a line");
        let (_, after) = rest.split_once(end).expect("an end");
        text += &format!("{begin}{first}\n{}{end}{after}", make(first));
    }
    text
}

/// The page's tables are what was measured, and each `choose` in it answers what stands below.
#[test]
fn the_study_shows_what_was_measured_and_what_choose_recommends() {
    let path = repository("docs/trade-offs.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let tables = made_anew(&page, BEGIN, END, |name| table(name.trim_end_matches(" -->")));
    let tables = made_anew(&tables, PLANNED, END, |pipelines| planned(pipelines.trim_end_matches(" -->")));
    let tables = made_anew(&tables, SHOWN, END, |wanted| shown(wanted.trim_end_matches(" -->")));
    let made = made_anew(&tables, ASKED, "```\n", |arguments| {
        let place = Place::new();
        let (folder, limits) = arguments.split_once(' ').expect("limits");
        let folder = repository("docs").join(folder);
        let folder = folder.to_str().expect("a path");
        let all: Vec<&str> = ["choose", folder].into_iter().chain(limits.split(' ')).collect();
        place.run(&all).out
    });
    assert!(made.matches(BEGIN).count() > 5 && made.matches(ASKED).count() > 3, "tables and answers are there");
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(path, made).expect("written");
        return;
    }
    let differs = page.lines().zip(made.lines()).find(|(there, made)| there != made);
    assert!(
        page == made,
        "docs/trade-offs.md differs, first {differs:#?}; accept: {UPDATE}=1 cargo test -p framewright-cli study"
    );
}

/// Presets that the page calls `choose`'s answer (`None`: the defaults): pipeline, preset, sweep, and the limits.
const RECOMMENDED: [(&str, Option<&str>, &str, &str); 9] = [
    ("image_quality", None, "edges", "--max-moved-mib 2.5"),
    ("image_quality", Some("low"), "edges", "--max-mib 1"),
    ("image_quality", Some("high"), "edges", "--max-mib 3"),
    ("image_quality", Some("ultra"), "edges", "--max-mib 12"),
    ("temporal", None, "motion", "--max-mib 1 --max-flicker 0.014"),
    ("shadows", Some("low"), "shadows", "--max-mib 8"),
    ("shadows", Some("medium"), "shadows", "--max-mib 12"),
    ("shadows", Some("high"), "shadows", "--max-mib 50"),
    ("shadows", None, "shadows", "--max-mib 50"),
];

/// All settings of a pipeline's preset that its sweep chose are those that `choose` writes.
#[test]
fn presets_are_what_choose_recommends() {
    let page = std::fs::read_to_string(repository("docs/trade-offs.md")).expect("the page");
    for (pipeline, preset, sweep, limits) in RECOMMENDED {
        let place = Place::new();
        let folder = repository("docs/trade-offs").join(sweep);
        let arguments = ["choose", folder.to_str().expect("a path"), "-o", "chosen.ron"];
        place.run(&arguments.into_iter().chain(limits.split(' ')).collect::<Vec<_>>()).exits(0);
        let settings = |more: &[&str]| {
            let arguments = ["inspect", pipeline, "--format", "json"];
            let plan = place.run(&[&arguments, more].concat()).exits(0).out;
            let plan: Value = serde_json::from_str(&plan).expect("JSON");
            plan["settings"].clone()
        };
        let of_preset = preset.map_or_else(|| settings(&[]), |name| settings(&["--preset", name]));
        let chosen = settings(&["--settings", "chosen.ron"]);
        let preset = preset.unwrap_or("the defaults");
        assert_eq!(chosen, of_preset, "{pipeline}, {preset}: {limits}");
        assert!(chosen.as_array().is_some_and(|all| !all.is_empty()));
        assert!(page.contains(&format!("choose trade-offs/{sweep} {limits}\n")), "{pipeline}, {preset}: {limits}");
    }
}
