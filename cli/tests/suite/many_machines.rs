//! The scripts that measure a sweep on many machines: each is run part by part as its scheduler does, and the joined results hold the
//! choices of the whole sweep (NU-1).
#![cfg(unix)]

use crate::testing::shell::{documents, shell, step, text};
use crate::testing::{Place, Vulkan, repository};
use serde_json::Value;
use std::path::PathBuf;

/// The sweep of the scripts, so small that a test can measure it.
const SMALL: [&str; 2] = ["--size 640x360", "--size 16x9 --frames 1 --reference none"];
const SWEEP: &str = "image_quality --scene spheres_and_cubes --size 640x360 --sweep msaa=1,4 --sweep blur=0,1,2";

/// A file of the scripts.
fn script(name: &str) -> PathBuf {
    repository("examples/sweeps").join(name)
}

/// Choices and surroundings of all rows, sorted.
fn choices(place: &Place, folder: &str) -> Vec<String> {
    let file = std::fs::read_to_string(place.path(folder).join("results.json")).expect("results");
    let results: Value = serde_json::from_str(&file).expect("JSON");
    let rows = results["rows"].as_array().expect("rows").iter();
    let what = |row: &Value| {
        assert!(row["outcome"]["measured"].is_object(), "{row}");
        let of = ["choice", "settings", "scene", "scene_digest", "size", "stereo"].map(|it| row[it].to_string());
        of.join(" ")
    };
    let mut all: Vec<String> = rows.map(what).collect();
    all.sort_unstable();
    all
}

/// Holds joined results against those of the whole sweep on one machine.
fn are_those_of_one_machine(place: &Place) {
    let measure = format!("framewright measure {} -o whole", SWEEP.replace(SMALL[0], SMALL[1]));
    shell(place, "sh", &["-c", &measure], &[]).exits(0);
    let whole = choices(place, "whole");
    assert_eq!(whole.len(), 6);
    assert_eq!(choices(place, "results/all"), whole);
    assert!(place.path("results/all/index.html").is_file());
}

/// The sweep that a script names, made small.
fn small(measure: &str) -> String {
    assert_eq!(measure, SWEEP, "the scripts measure one sweep");
    measure.replace(SMALL[0], SMALL[1])
}

#[test]
fn the_tasks_of_a_slurm_array_together_measure_the_sweep() {
    if Vulkan::LAVAPIPE.variables().is_none() {
        return;
    }
    let place = Place::new();
    let [slurm, join] = ["slurm.sh", "join.sh"].map(|name| script(name).display().to_string());
    let sweep = small(SWEEP);
    let arguments: Vec<&str> = std::iter::once(&*slurm).chain(sweep.split(' ')).collect();
    // An array that doesn't begin at 1: its tasks are 3, 4, 5 and 6.
    for task in ["3", "4", "5", "6"] {
        let variables = [("SLURM_ARRAY_TASK_ID", task), ("SLURM_ARRAY_TASK_COUNT", "4"), ("SLURM_ARRAY_TASK_MIN", "3")];
        shell(&place, "bash", &arguments, &variables).exits(0);
    }
    // A part that is missing is an error, and no results are written.
    shell(&place, "bash", &[&join, "5"], &[]).exits(1).mentions("`results/part_5/results.json` can't be read");
    assert!(!place.path("results/all").exists());
    shell(&place, "bash", &[&join, "4"], &[]).exits(0);
    are_those_of_one_machine(&place);
    // Outside of an array it says what is missing.
    shell(&place, "bash", &arguments, &[]).exits(1).mentions("SLURM_ARRAY_TASK_ID");
}

#[test]
fn the_pods_of_an_indexed_job_together_measure_the_sweep() {
    if Vulkan::LAVAPIPE.variables().is_none() {
        return;
    }
    let place = Place::new();
    let jobs = documents(&script("kubernetes.yaml"));
    let [measure, join] = &jobs[..] else { panic!("{} documents", jobs.len()) };
    for job in [measure, join] {
        assert_eq!((text(&job["apiVersion"]), text(&job["kind"])), ("batch/v1", "Job"));
    }
    let container = |job: &'static str, at: usize| {
        let container = &jobs[at]["spec"]["template"]["spec"]["containers"][0];
        assert_eq!(text(&container["name"]), job);
        let command: Vec<&str> = container["command"].as_sequence().expect("a command").iter().map(text).collect();
        let env = container["env"].as_sequence().expect("variables").iter();
        let env: Vec<(&str, &str)> = env.map(|one| (text(&one["name"]), text(&one["value"]))).collect();
        (command, env)
    };
    let spec = &measure["spec"];
    assert_eq!(text(&spec["completionMode"]), "Indexed");
    let (command, variables) = container("measure", 0);
    let completions = spec["completions"].as_integer().expect("a number");
    let sweep = small(variables.iter().find(|(name, _)| *name == "MEASURE").expect("a sweep").1);
    for index in 0..completions {
        let index = index.to_string();
        let own = [("MEASURE", &*sweep), ("JOB_COMPLETION_INDEX", &*index)];
        shell(&place, command[0], &command[1..], &[&variables[..], &own].concat()).exits(0);
    }
    let (command, variables) = container("join", 1);
    shell(&place, command[0], &command[1..], &variables).exits(0);
    are_those_of_one_machine(&place);
}

#[test]
fn the_jobs_of_a_ci_matrix_together_measure_the_sweep() {
    if Vulkan::LAVAPIPE.variables().is_none() {
        return;
    }
    let place = Place::new();
    let workflow = documents(&script("github_actions.yml")).remove(0);
    let jobs = &workflow["jobs"];
    assert_eq!(text(&jobs["join"]["needs"]), "measure");
    let parts = jobs["measure"]["strategy"]["matrix"]["part"].as_sequence().expect("a list");
    let (measure, count) = (step(&workflow, "measure", "measure"), parts.len().to_string());
    let sweep = small(text(&workflow["env"]["MEASURE"]));
    for part in parts {
        let part = part.as_integer().expect("a number").to_string();
        // The runner puts values in for its expressions.
        let filled = |name: &str| {
            let value = text(&measure["env"][name]);
            let value = value.replace("${{ matrix.part }}", &part).replace("${{ strategy.job-total }}", &count);
            assert!(!value.contains("${{"), "{value}");
            value
        };
        let [own, all] = ["PART", "PARTS"].map(filled);
        let variables = [("MEASURE", &*sweep), ("PART", &own), ("PARTS", &all)];
        shell(&place, "bash", &["-e", "-c", text(&measure["run"])], &variables).exits(0);
    }
    shell(&place, "bash", &["-e", "-c", text(&step(&workflow, "join", "join")["run"])], &[]).exits(0);
    are_those_of_one_machine(&place);
}
