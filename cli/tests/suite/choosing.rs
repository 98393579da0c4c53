//! `choose`: the best settings under a budget, of those that were measured (NU-3).

use crate::testing::results::{Numbers, Row, results, write};
use crate::testing::{Outcome, Place, repository};
use serde_json::{Value, json};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// A limit of the command line.
#[derive(Debug, Clone, Copy)]
struct Limit {
    option: &'static str,
    value: f64,
}

/// Settings, and their worst figures by the option that limits them.
#[derive(Debug, Clone)]
struct Candidate {
    settings: Value,
    figures: BTreeMap<&'static str, f64>,
    /// Quartiles of the ratio.
    quartiles: [f64; 2],
    /// The number of settings that are faster, and not just by chance.
    speed: usize,
    /// The FLIP of the reference itself.
    doubt: f64,
    /// The number of settings of less error, beyond that of their references.
    error: usize,
}

const COSTS: [&str; 4] = ["--max-ms", "--max-ratio", "--max-mib", "--max-moved-mib"];
/// The last one is of results with flicker alone.
const OPTIONS: [&str; 11] = [
    COSTS[0],
    COSTS[1],
    COSTS[2],
    COSTS[3],
    "--max-flip",
    "--max-rmse",
    "--max-error",
    "--max-relative-mse",
    "--min-psnr",
    "--min-ssim",
    "--max-flicker",
];

/// The figure of a row that an option limits.
fn figure(row: &Value, option: &str) -> f64 {
    let measured = &row["outcome"]["measured"];
    let errors = &measured["errors"];
    let number = match option {
        "--max-ms" => measured["cost"]["gpu_milliseconds"]["median"].as_f64(),
        "--max-ratio" => measured["cost"]["gpu_ratio"]["median"].as_f64(),
        "--max-mib" => measured["cost"]["transient_bytes"].as_f64().map(|bytes| bytes / 1048576.0),
        "--max-moved-mib" => measured["cost"]["moved_bytes"].as_f64().map(|bytes| bytes / 1048576.0),
        "--max-flip" => errors["flip"]["mean"].as_f64(),
        "--max-rmse" => errors["rmse"].as_f64(),
        "--max-error" => errors["max_error"].as_f64(),
        "--max-relative-mse" => errors["relative_mse"].as_f64(),
        // Without a difference it is infinite.
        "--min-psnr" => errors["psnr"].as_f64().or(Some(f64::INFINITY)),
        "--min-ssim" => errors["ssim"].as_f64(),
        // Of results without flicker nothing is asked.
        _ => Some(measured["flicker"]["mean"].as_f64().unwrap_or(0.0)),
    };
    number.expect("a number")
}

/// A row's surroundings.
fn group(row: &Value) -> String {
    format!("{} {} {}", row["scene"], row["size"], row["stereo"])
}

fn is_good(row: &Value) -> bool {
    let errors = &row["outcome"]["measured"]["errors"];
    let flicker = &row["outcome"]["measured"]["flicker"]["non_finite"];
    errors.is_object() && errors["non_finite"] == json!([0, 0]) && (flicker.is_null() || flicker == 0)
}

/// The groups that count.
fn groups(results: &Value) -> BTreeSet<String> {
    results["rows"].as_array().expect("rows").iter().filter(|row| is_good(row)).map(group).collect()
}

/// The ratio of the baseline's settings in each group; 1 where the baseline itself was drawn.
fn baselines(results: &Value) -> BTreeMap<String, f64> {
    let baseline = results["subject"]["baseline"].as_object().expect("settings");
    let mut settings = baseline.clone();
    settings.retain(|name, _| !name.starts_with('@'));
    let mut found = BTreeMap::new();
    for row in results["rows"].as_array().expect("rows") {
        let size = format!("{}x{}", row["size"][0], row["size"][1]);
        let own = baseline.get("@scene") == Some(&row["scene_digest"])
            && baseline.get("@size") == Some(&json!(size))
            && baseline.get("@stereo") == Some(&row["stereo"]);
        if own {
            found.insert(group(row), 1.0);
        } else if row["settings"] == Value::Object(settings.clone()) && row["outcome"]["measured"].is_object() {
            found.insert(group(row), figure(row, "--max-ratio"));
        }
    }
    found
}

/// Numbers in the order of a figure: how many candidates come before those that can't be told apart.
fn ranks(all: &[Candidate], option: &str, alike: impl Fn(&Candidate, &Candidate) -> bool) -> Vec<usize> {
    let mut left: Vec<usize> = (0..all.len()).collect();
    left.sort_by(|a, b| all[*a].figures[option].total_cmp(&all[*b].figures[option]));
    let mut ranks = vec![0; all.len()];
    // From the least on, as long as they are like the very least.
    while let Some(least) = left.first().copied() {
        let count = left.iter().take_while(|at| alike(&all[least], &all[**at])).count();
        let before = all.len() - left.len();
        left.drain(..count).for_each(|at| ranks[at] = before);
    }
    ranks
}

/// All settings that can be chosen, from the file itself: those with good rows wherever there is one.
fn candidates(results: &Value) -> Vec<Candidate> {
    let rows = results["rows"].as_array().expect("rows");
    let (groups, baselines) = (groups(results), baselines(results));
    let factor = |row: &Value| baselines.get(&group(row)).copied().unwrap_or(1.0);
    let mut all: Vec<Value> = rows.iter().map(|row| row["settings"].clone()).collect();
    all.sort_by_key(Value::to_string);
    all.dedup();
    let of = |settings: Value| {
        let own: Vec<&Value> =
            rows.iter().filter(|row| row["settings"] == settings && groups.contains(&group(row))).collect();
        let covered: BTreeSet<String> = own.iter().map(|row| group(row)).collect();
        if covered != groups || own.is_empty() || !own.iter().all(|row| is_good(row)) {
            return None;
        }
        let worst = |option: &'static str| {
            let by = |row: &Value| if option == "--max-ratio" { factor(row) } else { 1.0 };
            let figures = own.iter().map(|row| figure(row, option) / by(row));
            let worst = if option.starts_with("--min") { f64::min } else { f64::max };
            (option, figures.reduce(worst).expect("a row"))
        };
        let most = |by: &dyn Fn(&Value) -> f64| *own.iter().max_by(|a, b| by(a).total_cmp(&by(b))).expect("a row");
        let slowest = most(&|row| figure(row, "--max-ratio") / factor(row));
        let ratio = &slowest["outcome"]["measured"]["cost"]["gpu_ratio"];
        let quartiles = ["low", "high"].map(|it| ratio[it].as_f64().expect("a number") / factor(slowest));
        let reference = &most(&|row| figure(row, "--max-flip"))["outcome"]["measured"]["reference_errors"];
        let doubt = reference["flip"]["mean"].as_f64().unwrap_or(0.0);
        let figures = OPTIONS.map(worst).into();
        Some(Candidate { settings: settings.clone(), figures, quartiles, speed: 0, doubt, error: 0 })
    };
    let mut all: Vec<Candidate> = all.into_iter().filter_map(of).collect();
    let ratio = |one: &Candidate| one.figures["--max-ratio"];
    let within = |figure: f64, [low, high]: [f64; 2]| low <= figure && figure <= high;
    // Each one's median lies within the other's quartiles.
    let fast = ranks(&all, "--max-ratio", |fastest, one| {
        within(ratio(one), fastest.quartiles) && within(ratio(fastest), one.quartiles)
    });
    let flip = |one: &Candidate| one.figures["--max-flip"];
    let right = ranks(&all, "--max-flip", |best, one| flip(one) - flip(best) <= best.doubt.max(one.doubt));
    for (one, (speed, error)) in all.iter_mut().zip(fast.into_iter().zip(right)) {
        (one.speed, one.error) = (speed, error);
    }
    all
}

fn overshoot(candidate: &Candidate, limit: &Limit) -> f64 {
    let beyond = candidate.figures[limit.option] - limit.value;
    let beyond = if limit.option.starts_with("--min") { -beyond } else { beyond };
    beyond / limit.value.abs()
}

/// Whether `a` is preferred to `b`, by the rule of the documents.
fn prefer(a: &Candidate, b: &Candidate, limits: &[Limit]) -> Ordering {
    let has_cost = limits.iter().any(|limit| COSTS.contains(&limit.option));
    let by = |option: &str| a.figures[option].total_cmp(&b.figures[option]);
    let (speed, error) = (a.speed.cmp(&b.speed), a.error.cmp(&b.error));
    let first = if has_cost { error.then(speed) } else { speed.then(error) };
    first.then(by("--max-mib")).then(by("--max-ratio")).then(by("--max-flip"))
}

/// All that hold some limits and that no other one which holds them is preferred to.
fn best<'a>(all: &'a [Candidate], limits: &[Limit], among: &[Limit]) -> Vec<&'a Candidate> {
    let fits = |candidate: &&Candidate| among.iter().all(|limit| overshoot(candidate, limit) <= 0.0);
    let fitting: Vec<&Candidate> = all.iter().filter(fits).collect();
    let unbeaten = |one: &&&Candidate| !fitting.iter().any(|other| prefer(other, one, limits).is_lt());
    fitting.iter().filter(unbeaten).copied().collect()
}

/// Those whose largest overshoot is least.
fn nearest<'a>(all: &[&'a Candidate], limits: &[Limit]) -> Vec<&'a Candidate> {
    let largest =
        |candidate: &Candidate| limits.iter().map(|limit| overshoot(candidate, limit)).fold(f64::MIN, f64::max);
    let least = all.iter().map(|one| largest(one)).fold(f64::MAX, f64::min);
    all.iter().filter(|one| largest(one) <= least).copied().collect()
}

/// Whether an entry of the answer is one of those that an exhaustive search allows, or both have none.
#[track_caller]
fn agrees(entry: &Value, allowed: &[&Candidate], what: &str, context: &dyn std::fmt::Debug) {
    match entry {
        Value::Null => assert!(allowed.is_empty(), "no {what}, and there is {allowed:?}: {context:?}"),
        entry => {
            let found = allowed.iter().find(|one| one.settings == entry["settings"]);
            let Some(found) = found else { panic!("{what} is {entry}, not of {allowed:?}: {context:?}") };
            assert_eq!(entry["gpu_milliseconds"].as_f64(), Some(found.figures["--max-ms"]), "{what}");
            assert_eq!(entry["gpu_ratio"]["median"].as_f64(), Some(found.figures["--max-ratio"]), "{what}");
            assert_eq!(entry["errors"]["flip"].as_f64(), Some(found.figures["--max-flip"]), "{what}");
        }
    }
}

fn choose(place: &Place, limits: &[Limit], others: &[&str]) -> Outcome {
    let mut arguments: Vec<String> = vec!["choose".to_owned(), ".".to_owned()];
    arguments.extend(limits.iter().flat_map(|limit| [limit.option.to_owned(), limit.value.to_string()]));
    arguments.extend(others.iter().map(|it| (*it).to_owned()));
    place.run(&arguments)
}

/// The options that limit something which results have.
fn options(results: &Value) -> &'static [&'static str] {
    if results["subject"]["flicker_frames"].is_null() { &OPTIONS[..10] } else { &OPTIONS }
}

/// Random results: few values, so that many figures are equal; several scenes; rows that fail, lack a reference or have
/// pixels that aren't finite.
fn random(numbers: &mut Numbers) -> Value {
    let [values, scenes, few] = [1 + numbers.below(5), 1 + numbers.below(3), 2 + numbers.below(12)];
    let flickers = numbers.below(2) == 0;
    let mut rows = Vec::new();
    // One group may fail as a whole.
    let lost = numbers.below(8);
    for (msaa, scale) in (0..values).flat_map(|msaa| (0..values).map(move |scale| (msaa, scale))) {
        for scene in 0..scenes {
            let mut step = || 1.0 + numbers.below(few) as f64;
            let mut row = Row::new(&[("msaa", &(1 << msaa).to_string()), ("scale", &format!("{}.5", scale))])
                .scene(&format!("scene{scene}.ron"))
                .costs(step() / 4.0, (step() as u64 * 3) << 18)
                .moved((step() as u64) << 20)
                .ratio(step() / 8.0, step() / 16.0)
                .errors(step() / 64.0, step() / 32.0, 1.0 - step() / 128.0)
                .reference_error((step() - 1.0) / 256.0)
                .further_errors(step(), step() / 4.0, 20.0 + step());
            if flickers {
                row = row.flicker(step() / 16.0, u32::from(numbers.below(16) == 0));
            }
            row = match numbers.below(48) {
                _ if scene == lost => row.failed("it has no such eyes"),
                0 => row.failed("no device has that"),
                1 => row.not_finite(3),
                2 => row.without_reference(),
                3 => continue,
                _ => row,
            };
            rows.push(row.value());
        }
    }
    let mut results = results(rows);
    results["subject"]["baseline"] =
        json!({ "msaa": "1", "scale": "0.5", "@scene": "scene0.ron: a digest", "@size": "64x64", "@stereo": "off" });
    if flickers {
        results["subject"]["flicker_frames"] = json!(16);
    }
    results
}

/// How often something was chosen, ratios had no baseline, nothing held the limits, and a limit bound, alone or with others.
#[derive(Debug, Default)]
struct Found {
    chosen: usize,
    refused: usize,
    missed: usize,
    bound: usize,
    bound_together: usize,
}

impl Found {
    /// Holds the answer for the results in a place's folder against an exhaustive search.
    fn search(&mut self, place: &Place, results: &Value, limits: &[Limit]) {
        let all = &*candidates(results);
        let outcome = choose(place, limits, &["--format", "json"]);
        let known: BTreeSet<String> = baselines(results).into_keys().collect();
        if limits.iter().any(|limit| limit.option == "--max-ratio") && !groups(results).is_subset(&known) {
            self.refused += 1;
            outcome.exits(1).mentions("error: `--max-ratio` holds times against those of the settings of the baseline");
            return;
        }
        let answer: Value = serde_json::from_str(&outcome.out).unwrap_or_else(|_| panic!("{}", outcome.err));
        let best_of_all = best(all, limits, limits);
        agrees(&answer["chosen"], &best_of_all, "the choice", &limits);
        assert_eq!(outcome.code, Some(i32::from(best_of_all.is_empty())));
        let Some(winner) = best_of_all.first() else {
            self.missed += 1;
            agrees(&answer["nearest_miss"], &nearest(&all.iter().collect::<Vec<_>>(), limits), "the miss", &limits);
            return;
        };
        self.chosen += 1;
        let better: Vec<&Candidate> = all.iter().filter(|one| prefer(one, winner, limits).is_lt()).collect();
        agrees(&answer["next_better"], &nearest(&better, limits), "the next better", &limits);
        // Sets of limits by size: those without which others would be chosen, while no part of them is such a set.
        let mut sets: Vec<usize> = (1..1 << limits.len()).collect();
        sets.sort_by_key(|set| set.count_ones());
        let mut binding: Vec<(usize, Vec<&Candidate>)> = Vec::new();
        for set in sets {
            let others: Vec<Limit> = (0..limits.len()).filter(|at| set >> at & 1 == 0).map(|at| limits[at]).collect();
            let mut without = best(all, limits, &others);
            without.retain(|one| prefer(one, winner, limits).is_lt());
            if !without.is_empty() && !binding.iter().any(|(smaller, _)| smaller & set == *smaller) {
                binding.push((set, without));
            }
        }
        assert_eq!(better.is_empty(), binding.is_empty(), "something better is excluded by limits");
        let options = |set: usize| -> Vec<&str> {
            (0..limits.len()).filter(|at| set >> at & 1 == 1).map(|at| limits[at].option).collect()
        };
        let together = |entry: &Value| -> BTreeSet<String> {
            entry["options"].as_array().expect("it").iter().map(|it| it.as_str().expect("it").to_owned()).collect()
        };
        let said: Vec<(BTreeSet<String>, &Value)> = answer["limits"]
            .as_array()
            .expect("limits")
            .iter()
            .map(|entry| (BTreeSet::from([entry["option"].as_str().expect("it").to_owned()]), &entry["without"]))
            .filter(|(_, without)| !without.is_null())
            .chain(answer["binding_together"].as_array().expect("it").iter().map(|it| (together(it), &it["without"])))
            .collect();
        assert_eq!(said.len(), binding.len(), "{answer} {binding:?}");
        for (set, without) in &binding {
            let options: BTreeSet<String> = options(*set).into_iter().map(str::to_owned).collect();
            let entry = said.iter().find(|(of, _)| *of == options).unwrap_or_else(|| panic!("{options:?} in {answer}"));
            agrees(entry.1, without, "the choice without limits", &options);
            *(if options.len() == 1 { &mut self.bound } else { &mut self.bound_together }) += 1;
        }
    }
}

/// Some limits by chance, at least one.
fn some_limits(
    numbers: &mut Numbers,
    options: &[&'static str],
    mut value: impl FnMut(&mut Numbers, &str) -> f64,
) -> Vec<Limit> {
    let mut limits = Vec::new();
    while limits.is_empty() {
        for option in options {
            if numbers.below(4) == 0 {
                limits.push(Limit { option, value: value(numbers, option) });
            }
        }
    }
    limits
}

#[test]
fn the_choice_is_what_an_exhaustive_search_finds() {
    let mut numbers = Numbers(7);
    let mut found = Found::default();
    for _ in 0..500 {
        let place = Place::new();
        let results = random(&mut numbers);
        write(&place, ".", &results);
        let limits = some_limits(&mut numbers, options(&results), |numbers, option| {
            let part = (1 + numbers.below(9)) as f64;
            match option {
                "--max-ms" => part / 4.0,
                "--max-ratio" => part / 4.0,
                "--max-mib" => part * 0.75,
                "--max-moved-mib" => part,
                "--max-flip" => part / 64.0,
                "--max-rmse" => part / 32.0,
                "--max-error" => part,
                "--max-relative-mse" => part / 4.0,
                "--min-psnr" => 20.0 + part,
                "--max-flicker" => part / 16.0,
                _ => 1.0 - part / 128.0,
            }
        });
        found.search(&place, &results, &limits);
    }
    assert!(
        found.chosen > 60 && found.missed > 60 && found.bound > 20 && found.bound_together > 5 && found.refused > 2,
        "{found:?}"
    );
}

/// NU-3: the same over the figures of the study. Each limit is the figure of some settings.
#[test]
fn the_choice_from_the_study_is_what_an_exhaustive_search_finds() {
    let mut numbers = Numbers(18);
    let mut found = Found::default();
    for sweep in std::fs::read_dir(repository("docs/trade-offs")).expect("the study") {
        let file = std::fs::read_to_string(sweep.expect("a sweep").path().join("results.json")).expect("results");
        let results: Value = serde_json::from_str(&file).expect("JSON");
        let all = candidates(&results);
        if all.is_empty() {
            continue;
        }
        let place = Place::new();
        write(&place, ".", &results);
        for _ in 0..8 {
            let limits = some_limits(&mut numbers, options(&results), |numbers, option| {
                all[numbers.below(all.len() as u64) as usize].figures[option]
            });
            found.search(&place, &results, &limits);
        }
    }
    assert!(found.chosen > 20 && found.missed > 5 && found.bound > 5, "{found:?}");
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
    let by_ratio = || [row("1", 9.0, 1.0, 0.5, 4), row("2", 1.0, 1.3, 0.1, 4), row("4", 2.0, 1.7, 0.1, 4)];
    assert_eq!(best(by_ratio(), any_flip), "1");
    // 5 % more time, within the spread: the least error is best, and of equal errors the least memory.
    assert_eq!(
        best([row("1", 1.0, 1.0, 0.5, 4), row("2", 9.0, 1.05, 0.1, 4), row("4", 2.0, 1.7, 0.1, 4)], any_flip),
        "2"
    );
    assert_eq!(
        best([row("1", 1.0, 1.0, 0.1, 8), row("2", 9.0, 1.05, 0.1, 4), row("4", 2.0, 1.7, 0.1, 1)], any_flip),
        "2"
    );
    // Beside a limit of cost errors come first, then times as far as they can be told apart.
    assert_eq!(
        best([row("1", 1.0, 1.0, 0.1, 8), row("2", 9.0, 1.05, 0.1, 4), row("4", 2.0, 1.7, 0.1, 1)], any_time),
        "2"
    );
    assert_eq!(
        best([row("1", 1.0, 1.0, 0.1, 8), row("2", 9.0, 1.3, 0.1, 4), row("4", 2.0, 1.7, 0.1, 1)], any_time),
        "1"
    );
    // All equal: the faster one.
    assert_eq!(
        best([row("1", 1.0, 1.05, 0.1, 4), row("2", 9.0, 1.0, 0.1, 4), row("4", 2.0, 1.7, 0.1, 4)], any_flip),
        "2"
    );
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
    assert!(out.contains("misses --max-ms 5 by inf % (not measured)"), "{out}");
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
    assert!(err.contains("have no flicker, which `--max-flicker` limits\nhelp: measure it: "), "{err}");
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
