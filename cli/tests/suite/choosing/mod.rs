//! `choose`: the best settings under a budget, of those that were measured (NU-3).

mod search;

use crate::testing::results::{Row, results, write};
use crate::testing::{Outcome, Place};
use serde_json::{Value, json};

/// A limit of the command line.
#[derive(Debug, Clone, Copy)]
struct Limit {
    option: &'static str,
    value: f64,
}

fn choose(place: &Place, limits: &[Limit], others: &[&str]) -> Outcome {
    let mut arguments: Vec<String> = vec!["choose".to_owned(), ".".to_owned()];
    arguments.extend(limits.iter().flat_map(|limit| [limit.option.to_owned(), limit.value.to_string()]));
    arguments.extend(others.iter().map(|it| (*it).to_owned()));
    place.run(&arguments)
}

/// Three settings of one scene, and what each costs and buys.
fn three() -> Value {
    let row = |msaa: &str, ms: f64, flip: f64| Row::new(&[("msaa", msaa)]).costs(ms, 4 << 20).errors(flip, flip, 0.9);
    results([row("1", 1.0, 0.08), row("4", 2.0, 0.03), row("8", 3.0, 0.02)].map(Row::value).into())
}

#[test]
fn the_answer_says_which_limit_binds_and_what_the_next_better_settings_cost() {
    let place = Place::new();
    write(&place, ".", &three());
    let limits = [Limit { option: "--max-ms", value: 2.5 }, Limit { option: "--max-mib", value: 64.0 }];
    let out = choose(&place, &limits, &[]).exits(0).out;
    for said in [
        "best: msaa=4\n  1.000 (0.750–1.250) × the baseline's time, 2.000 ms, 4.0 MiB transient, 5.0 MiB moved\n",
        "measured with scene.ron at 64x64\n",
        "--max-ms 2.5: 2.000 ms; binds: without it msaa=8: 1.500 (1.125–1.875) × the baseline's time, 3.000 ms, 4.0 MiB \
         transient, flip 0.02000\n",
        "--max-mib 64: 4.0 MiB; doesn't bind\n",
        "next better: msaa=8: 1.500 (1.125–1.875) × the baseline's time, 3.000 ms, 4.0 MiB transient, flip 0.02000; misses \
         --max-ms 2.5 by 20.0 % (3.000 ms)\n",
    ] {
        assert!(out.contains(said), "`{said}` is not in\n{out}");
    }
    let out = choose(&place, &[Limit { option: "--max-flip", value: 0.05 }], &[]).exits(0).out;
    assert!(out.starts_with("best: msaa=4\n") && out.contains("binds: without it msaa=1"), "{out}");
    let limits = [Limit { option: "--max-ms", value: 2.5 }, Limit { option: "--max-flip", value: 0.021 }];
    let out = choose(&place, &limits, &["-o", "settings.ron"]).exits(1).out;
    assert!(out.contains("nothing that was measured holds all limits\nnearest miss: msaa=8\n"), "{out}");
    assert!(out.contains("misses --max-ms 2.5 by 20.0 % (3.000 ms)"), "{out}");
    assert!(!place.path("settings.ron").exists());
    let out = choose(&place, &[Limit { option: "--max-ms", value: 9.0 }], &[]).exits(0).out;
    assert!(out.starts_with("best: msaa=8\n") && out.contains("nothing better was measured"), "{out}");
    // Better settings miss two limits at once: neither binds alone.
    let limits = [Limit { option: "--max-ms", value: 2.5 }, Limit { option: "--max-ratio", value: 1.2 }];
    let out = choose(&place, &limits, &[]).exits(0).out;
    for said in [
        "--max-ms 2.5: 2.000 ms; binds together with others\n--max-ratio 1.2: 1.000 × the baseline's time; binds together",
        "--max-ms and --max-ratio bind together: without them msaa=8: 1.500 (1.125–1.875) × the baseline's time",
    ] {
        assert!(out.contains(said), "`{said}` is not in\n{out}");
    }
}

#[test]
fn settings_must_hold_with_every_scene_and_be_measured_with_each() {
    let place = Place::new();
    let row = |msaa: &str, scene: &str, ms: f64| {
        Row::new(&[("msaa", msaa), ("@scene", scene)]).scene(scene).costs(ms, 4 << 20).errors(0.1 / ms, 0.1, 0.9)
    };
    let rows =
        [row("1", "easy.ron", 1.0), row("1", "hard.ron", 2.0), row("4", "easy.ron", 2.5), row("4", "hard.ron", 5.0)];
    write(&place, ".", &results(rows.map(Row::value).into()));
    let out = choose(&place, &[Limit { option: "--max-ms", value: 3.0 }], &[]).exits(0).out;
    assert!(out.starts_with("best: msaa=1\n  1.000 (0.750–1.250) × the baseline's time, 2.000 ms"), "{out}");
    assert!(out.contains("the worst figures of easy.ron at 64x64; hard.ron at 64x64"), "{out}");
    // Settings that were measured with the easy scene alone don't win.
    let some = [row("1", "easy.ron", 1.0), row("1", "hard.ron", 2.0), row("4", "easy.ron", 2.5)];
    // Nor do those that failed with the hard one.
    let failed = [some.to_vec(), vec![row("4", "hard.ron", 5.0).failed("no")]].concat();
    for (rows, why) in [
        (some.to_vec(), "left out: 1 that weren't measured with every scene, size and way of stereo\n"),
        (failed, "left out: 1 that can't be drawn\n"),
    ] {
        write(&place, ".", &results(rows.into_iter().map(Row::value).collect()));
        let out = choose(&place, &[Limit { option: "--max-ms", value: 3.0 }], &[]).exits(0).out;
        assert!(out.starts_with("best: msaa=1\n") && out.contains(why), "{out}");
    }
    // A scene with which nothing can be drawn empties nothing.
    let lost = [row("1", "easy.ron", 1.0), row("4", "easy.ron", 2.5), row("1", "hard.ron", 2.0).failed("no")];
    write(&place, ".", &results(lost.map(Row::value).into()));
    let out = choose(&place, &[Limit { option: "--max-ms", value: 3.0 }], &[]).exits(0).out;
    assert!(out.starts_with("best: msaa=4\n") && out.contains("measured with easy.ron at 64x64\n"), "{out}");
    assert!(out.contains("left out: hard.ron at 64x64, where nothing that was measured can be chosen\n"), "{out}");
}

#[test]
fn times_that_can_not_be_told_apart_are_equal_and_error_and_memory_decide() {
    let place = Place::new();
    // Milliseconds drift from batch to batch: by them alone the order would be another.
    let row = |msaa: &str, ms: f64, ratio: f64, flip: f64, mib: u64| {
        Row::new(&[("msaa", msaa)]).costs(ms, mib << 20).ratio(ratio, 0.1).errors(flip, 0.1, 0.9)
    };
    let best = |rows: [Row; 3], limit: Limit| {
        write(&place, ".", &results(rows.map(Row::value).into()));
        choose(&place, &[limit], &["--format", "json"]).exits(0).out.parse::<Value>().expect("JSON")["chosen"]
            ["settings"]["msaa"]
            .clone()
    };
    let (any_flip, any_time) = (Limit { option: "--max-flip", value: 1.0 }, Limit { option: "--max-ms", value: 100.0 });
    for (rows, limit, settings, why) in [
        (
            [row("1", 9.0, 1.0, 0.5, 4), row("2", 1.0, 1.3, 0.1, 4), row("4", 2.0, 1.7, 0.1, 4)],
            any_flip,
            "1",
            "the ratio",
        ),
        // 5 % more time is within the spread.
        (
            [row("1", 1.0, 1.0, 0.5, 4), row("2", 9.0, 1.05, 0.1, 4), row("4", 2.0, 1.7, 0.1, 4)],
            any_flip,
            "2",
            "the error",
        ),
        (
            [row("1", 1.0, 1.0, 0.1, 8), row("2", 9.0, 1.05, 0.1, 4), row("4", 2.0, 1.7, 0.1, 1)],
            any_flip,
            "2",
            "memory",
        ),
        // Beside a limit of cost errors come first, then times as far as they can be told apart.
        (
            [row("1", 1.0, 1.0, 0.1, 8), row("2", 9.0, 1.05, 0.1, 4), row("4", 2.0, 1.7, 0.1, 1)],
            any_time,
            "2",
            "memory",
        ),
        (
            [row("1", 1.0, 1.0, 0.1, 8), row("2", 9.0, 1.3, 0.1, 4), row("4", 2.0, 1.7, 0.1, 1)],
            any_time,
            "1",
            "the ratio",
        ),
        (
            [row("1", 1.0, 1.05, 0.1, 4), row("2", 9.0, 1.0, 0.1, 4), row("4", 2.0, 1.7, 0.1, 4)],
            any_flip,
            "2",
            "the median",
        ),
    ] {
        assert_eq!(best(rows, limit), settings, "{why} decides");
    }
}

#[test]
fn differences_below_the_error_of_the_reference_decide_nothing() {
    let place = Place::new();
    let best = |own: f64| {
        let row = |msaa: &str, ratio: f64, flip: f64| {
            let row = Row::new(&[("msaa", msaa)]).costs(1.0, 4 << 20).ratio(ratio, 0.01).errors(flip, 0.1, 0.9);
            row.reference_error(own).value()
        };
        write(&place, ".", &results(vec![row("1", 1.0, 0.016), row("4", 2.0, 0.015), row("8", 1.5, 0.02)]));
        choose(&place, &[Limit { option: "--max-ms", value: 9.0 }], &[]).exits(0).out
    };
    // 0.016 is as near as 0.015 if the reference itself may be 0.002 beside the truth: the faster one is better.
    for (own, settings) in [(0.0, "msaa=4"), (0.0005, "msaa=4"), (0.002, "msaa=1"), (0.1, "msaa=1")] {
        let said = best(own);
        assert!(said.starts_with(&format!("best: {settings}\n")), "{own}: {said}");
    }
}

#[test]
fn ratios_are_to_the_time_of_the_baseline_in_the_same_scene() {
    let place = Place::new();
    // All that is drawn with the easy scene takes a fifth of the time.
    let row = |msaa: &str, scene: &str, ratio: f64| {
        Row::new(&[("msaa", msaa), ("scale", "1"), ("@scene", scene)])
            .scene(scene)
            .costs(1.0, 4 << 20)
            .ratio(ratio, 0.01)
            .errors(0.1 / ratio, 0.1, 0.9)
    };
    let all = [row("4", "scene.ron", 1.0), row("8", "scene.ron", 1.5), row("4", "easy.ron", 0.2)];
    let heavier = row("8", "easy.ron", 0.5);
    write(&place, ".", &results(all.iter().cloned().chain([heavier.clone()]).map(Row::value).collect()));
    let limit = [Limit { option: "--max-ratio", value: 2.0 }];
    let out = choose(&place, &limit, &[]).exits(0).out;
    assert!(out.starts_with("best: msaa=4 scale=1\n  1.000 (0.990–1.010) × the baseline's time"), "{out}");
    assert!(out.contains("misses --max-ratio 2 by 25.0 % (2.500 × the baseline's time)"), "{out}");
    // Without the baseline's settings there is nothing that they are relative to.
    let without = [all[0].clone(), all[1].clone(), heavier];
    write(&place, ".", &results(without.map(Row::value).into()));
    let said = choose(&place, &limit, &[]).exits(1);
    said.mentions(
        "the settings of the baseline (msaa=4 scale=1), which were not measured with easy.ron at 64x64\nhelp: ",
    );
    choose(&place, &[Limit { option: "--max-ms", value: 2.0 }], &[]).exits(0);
}

#[test]
fn folders_without_their_pictures_can_be_chosen_from() {
    let place = Place::new();
    for (folder, msaa, flip) in [("a", "1", 0.2), ("b", "4", 0.1)] {
        let row = Row::new(&[("msaa", msaa)]).costs(1.0, 4 << 20).errors(flip, 0.1, 0.9);
        write(&place, folder, &results(vec![row.pictures("pictures/1.png", "pictures/2.png").value()]));
    }
    let out = place.run(&["choose", "a", "b", "--max-ms", "2"]).exits(0).out;
    assert!(out.starts_with("best: msaa=4\n"), "{out}");
}

#[test]
fn results_without_times_are_chosen_from_by_memory_and_error() {
    let place = Place::new();
    let row = |msaa: &str, mib: u64, flip: f64| {
        Row::new(&[("msaa", msaa)]).costs(1.0, mib << 20).errors(flip, 0.1, 0.9).without_times()
    };
    write(&place, ".", &results([row("1", 1, 0.2), row("4", 4, 0.1), row("8", 8, 0.05)].map(Row::value).into()));
    let out = choose(&place, &[Limit { option: "--max-mib", value: 5.0 }], &[]).exits(0).out;
    assert!(out.starts_with("best: msaa=4\n  no times, 4.0 MiB transient"), "{out}");
    let out = choose(&place, &[Limit { option: "--max-ms", value: 5.0 }], &[]).exits(1).out;
    assert!(out.contains("misses --max-ms 5 (not measured)"), "{out}");
}

#[test]
fn rows_that_failed_or_are_not_finite_never_win() {
    let place = Place::new();
    let row = |msaa: &str| Row::new(&[("msaa", msaa)]).costs(1.0, 4 << 20).errors(0.0, 0.0, 1.0);
    let good = Row::new(&[("msaa", "8")]).costs(3.0, 4 << 20).errors(0.1, 0.1, 0.9);
    let bad = [row("1").failed("no"), row("2").not_finite(1), row("4").without_reference()];
    write(&place, ".", &results(bad.clone().into_iter().chain([good]).map(Row::value).collect()));
    let limit = [Limit { option: "--max-ms", value: 9.0 }];
    let out = choose(&place, &limit, &[]).exits(0).out;
    assert!(out.starts_with("best: msaa=8\n"), "{out}");
    assert!(out.contains("left out: 1 that can't be drawn\nleft out: 1 with pixels that aren't finite\n"), "{out}");
    write(&place, ".", &results(bad.map(Row::value).into()));
    let out = choose(&place, &limit, &[]).exits(1).out;
    assert!(
        out.starts_with("nothing that was measured can be chosen\n") && out.contains("without a reference"),
        "{out}"
    );
}

#[test]
fn flicker_is_limited_where_it_was_measured() {
    let place = Place::new();
    let row = |msaa: &str, ms: f64| Row::new(&[("msaa", msaa)]).costs(ms, 4 << 20).errors(0.1, 0.1, 0.9);
    let limit = [Limit { option: "--max-flicker", value: 0.02 }];
    write(&place, ".", &results(vec![row("1", 1.0).value()]));
    let err = choose(&place, &limit, &[]).exits(1).err;
    assert!(err.contains("have no flicker, which `--max-flicker` limits [E1611]\nhelp: measure it: "), "{err}");
    let rows = [row("1", 1.0).flicker(0.05, 0), row("2", 2.0).flicker(0.01, 3), row("4", 3.0).flicker(0.015, 0)];
    let mut measured = results(rows.map(Row::value).into());
    measured["subject"]["flicker_frames"] = json!(16);
    write(&place, ".", &measured);
    let out = choose(&place, &limit, &[]).exits(0).out;
    assert!(out.starts_with("best: msaa=4\n") && out.contains("ssim 0.90000, flicker 0.01500\n"), "{out}");
    assert!(out.contains("--max-flicker 0.02: 0.01500; binds: without it msaa=1"), "{out}");
    assert!(out.contains("left out: 1 with pixels that aren't finite\n"), "{out}");
}

#[test]
fn the_settings_file_is_one_that_run_takes() {
    let place = Place::new();
    place.file(
        "p.ron",
        "Pipeline(version: 1, settings: [(name: \"msaa\", value: OneOf(default: 1, of: [1, 4])), \
         (name: \"look\", value: OneOf(default: \"1\", of: [\"1\", \"old film\"])), \
         (name: \"on\", value: Bool(default: false)), (name: \"scale\", value: Number(default: 1.0, min: 0.5, max: 2.0))], \
         images: [(name: \"screen\", format: Output, size: Output)], \
         passes: [(name: \"all\", draw: FullScreen(\"vignette\"), when: \"on\", color: [\"screen\"])], outputs: [\"screen\"])",
    );
    for look in ["1", "old film"] {
        let all = [("msaa", "4"), ("look", look), ("on", "true"), ("scale", "1.5")];
        let mut value = results(vec![Row::new(&all).costs(1.0, 1 << 20).errors(0.1, 0.1, 0.9).value()]);
        value["subject"]["pipeline"] = json!("p.ron");
        write(&place, ".", &value);
        let limit = [Limit { option: "--max-ms", value: 2.0 }];
        let outcome = choose(&place, &limit, &["-o", "settings.ron"]).exits(0);
        assert!(outcome.out.ends_with("written to settings.ron\n") && outcome.err.is_empty(), "{outcome:?}");
        let text = std::fs::read_to_string(place.path("settings.ron")).expect("written");
        for set in ["\"msaa\": 4,", "\"on\": true,", "\"scale\": 1.5,"] {
            assert!(text.contains(set), "{text}");
        }
        // A setting that the file gives no allowed value would be named.
        let outcome = place.run(&["check", "p.ron", "--settings", "settings.ron"]);
        assert!(!outcome.err.contains("settings.ron"), "{}", outcome.err);
    }
    // What would act on a terminal, or hide what follows, is written as escapes.
    let hidden = "a\u{1b}[2J\u{202e}\"\\\n\tz";
    let mut value = results(vec![Row::new(&[("look", hidden)]).costs(1.0, 1 << 20).errors(0.1, 0.1, 0.9).value()]);
    value["subject"]["device"] = json!(hidden);
    write(&place, ".", &value);
    choose(&place, &[Limit { option: "--max-ms", value: 2.0 }], &["-o", "settings.ron"]).exits(0);
    let text = std::fs::read_to_string(place.path("settings.ron")).expect("written");
    assert!(text.contains(r#""look": "a\u{1b}[2J\u{202e}\"\\\n\tz","#), "{text}");
    assert!(text.chars().all(|it| it == '\n' || (!it.is_control() && it != '\u{202e}')), "{text:?}");
    // What the pipeline refuses is told.
    let mut value = results(vec![Row::new(&[("msaa", "16")]).costs(1.0, 1 << 20).errors(0.1, 0.1, 0.9).value()]);
    value["subject"]["pipeline"] = json!("p.ron");
    write(&place, ".", &value);
    let limit = [Limit { option: "--max-ms", value: 2.0 }];
    choose(&place, &limit, &["-o", "settings.ron"]).exits(0).mentions("`p.ron` as it is here refuses these settings");
    place.file("p.ron", "no pipeline");
    choose(&place, &limit, &["-o", "settings.ron"])
        .exits(0)
        .mentions("the settings were not checked with the pipeline");
}

#[test]
fn a_budget_is_stated_and_no_results_are_lost() {
    let place = Place::new();
    let file = write(&place, ".", &three());
    choose(&place, &[], &[]).exits(2);
    for wrong in [["--max-ms", "0"], ["--max-ms", "-1"], ["--max-mib", "NaN"], ["--max-flip", "x"]] {
        choose(&place, &[], &wrong).exits(2);
    }
    let before = std::fs::read(&file).expect("read");
    let said = choose(&place, &[], &["--max-ms", "9", "-o", "results.json"]).exits(2);
    said.mentions("`results.json` is a file of results that is read, which would be lost");
    assert_eq!(std::fs::read(&file).expect("read"), before);
    choose(&place, &[], &["--max-ms", "9", "-o", "missing/settings.ron"]).exits(3);
}
