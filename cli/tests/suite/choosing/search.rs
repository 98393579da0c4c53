//! `choose` beside an exhaustive search that is written from the documents (NU-3).

use super::{Limit, choose};
use crate::testing::results::{Numbers, Row, results, write};
use crate::testing::{Place, repository};
use serde_json::{Value, json};
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

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
