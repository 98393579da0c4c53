//! `check` and `inspect`: Plans without a GPU, the same bytes every time.

use crate::testing::{FORWARD, Place, outcome, repository, shipped_pipelines};
use framewright_tests::sweep;

/// Each reachable combination of the settings of `forward.ron` that take part in its structure.
fn settings() -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for msaa in ["1", "2", "4", "8"] {
        for hdr in ["true", "false"] {
            for tone_mapping in ["true", "false"] {
                let set = [format!("msaa={msaa}"), format!("hdr={hdr}"), format!("tone_mapping={tone_mapping}")];
                all.push(set.into_iter().flat_map(|one| ["--set".to_owned(), one]).collect());
            }
        }
    }
    all
}

fn plan(set: &[&str]) -> serde_json::Value {
    let mut arguments = vec!["inspect", "forward", "--format", "json"];
    arguments.extend(set.iter().flat_map(|one| ["--set", one]));
    let outcome = Place::new().run(&arguments).exits(0);
    serde_json::from_str(&outcome.out).expect("JSON")
}

#[test]
fn every_shipped_pipeline_is_fine_as_it_comes() {
    for pipeline in shipped_pipelines() {
        let outcome = Place::new().run(&["check", &pipeline]).exits(0);
        assert!(outcome.out.starts_with(&format!("{pipeline}: fine on lavapipe: ")), "{}", outcome.out);
    }
}

#[test]
fn forward_is_fine_in_every_combination_of_settings() {
    for set in sweep::of("settings of forward", settings(), 6) {
        let mut arguments = vec!["check".to_owned(), "forward".to_owned()];
        arguments.extend(set);
        let outcome = Place::new().run(&arguments).exits(0);
        assert!(outcome.out.starts_with("forward: fine on lavapipe: "), "{}", outcome.out);
    }
}

#[test]
fn check_as_json_says_that_all_is_fine() {
    let outcome = Place::new().run(&["check", "forward", "--format", "json"]).exits(0);
    let answer: serde_json::Value = serde_json::from_str(&outcome.out).expect("JSON");
    assert_eq!(answer["fine"], true);
    assert_eq!(answer["device"], "lavapipe");
    assert_eq!(answer["diagnostics"].as_array().map(Vec::len), Some(0));
    assert_eq!(answer["violations"].as_array().map(Vec::len), Some(0));
}

/// What a device is to be made with for the pipeline (DO-11), each with the first that uses it.
#[test]
fn do_11_check_as_json_lists_the_features_that_the_plan_uses() {
    let features = |set: &str| -> Vec<(String, String)> {
        let outcome = Place::new().run(&["check", "forward", "--set", set, "--format", "json"]).exits(0);
        let answer: serde_json::Value = serde_json::from_str(&outcome.out).expect("JSON");
        let features = answer["features"].as_array().expect("a list").iter();
        let text = |value: &serde_json::Value| value.as_str().expect("a text").to_owned();
        features.map(|feature| (text(&feature["name"]), text(&feature["by"]))).collect()
    };
    let plain = features("msaa=1");
    assert!(plain.is_sorted(), "{plain:?}");
    assert!(plain.contains(&("synchronization2".to_owned(), "every Plan".to_owned())), "{plain:?}");
    assert!(
        plain.iter().any(|(name, by)| name == "dynamicRendering" && by.starts_with("the rendering scope of step "))
    );
    let has_samples = |list: &[(String, String)]| list.iter().any(|(name, _)| name == "sampleRateShading");
    assert!(!has_samples(&plain), "{plain:?}");
    let place = Place::new();
    place.file("p.ron", "Pipeline(version: 1, nothing: 2)");
    let wrong = place.run(&["check", "p.ron", "--format", "json"]).exits(1);
    let answer: serde_json::Value = serde_json::from_str(&wrong.out).expect("JSON");
    assert!(answer["features"].is_null(), "{}", wrong.out);
}

#[test]
fn the_shipped_copy_and_the_file_give_the_same_plan_and_the_copy_is_said_to_be_one() {
    let place = Place::new();
    let copy = place
        .run(&["inspect", "forward", "--format", "json"])
        .exits(0)
        .says("note: there is no file `forward` here; this is the shipped pipeline of that name");
    place.file("forward.ron", FORWARD);
    let file = place.run(&["inspect", "forward.ron", "--format", "json"]).exits(0).says("");
    assert_eq!(copy.out, file.out);
}

#[test]
fn a_users_file_goes_before_a_shipped_one() {
    let place = Place::new();
    place.file("forward", FORWARD.replace("default: 4", "default: 1"));
    let plan = place.run(&["inspect", "forward", "--format", "json"]).exits(0).says("");
    assert!(plan.out.contains("\"value\": \"1\""), "{}", plan.out);
}

/// In separate processes, working directories, with other thread counts, terminals and locales.
#[test]
fn the_same_command_gives_the_same_bytes_wherever_it_runs() {
    let place = Place::new();
    let pipeline = repository("examples/pipelines/forward.ron").canonicalize().expect("there");
    let folder = pipeline.parent().expect("a folder").to_owned();
    let arguments = |file: &str| ["inspect", file, "--set", "msaa=4", "--format", "json"].map(str::to_owned);
    let absolute = arguments(pipeline.to_str().expect("a plain path"));
    let first = place.run(&absolute).exits(0).out;
    assert!(first.len() > 1000);
    for threads in ["1", "2", "64"] {
        let variables =
            [("RAYON_NUM_THREADS", threads), ("LC_ALL", "tr_TR.UTF-8"), ("TERM", "dumb"), ("COLUMNS", "20")];
        assert_eq!(place.run_with(&variables, &absolute).exits(0).out, first);
    }
    for (directory, file) in
        [("/", pipeline.to_str().expect("plain")), (folder.to_str().expect("plain"), "forward.ron")]
    {
        let outcome = outcome(place.command(&arguments(file)).current_dir(directory)).exits(0);
        assert_eq!(outcome.out, first, "in {directory}");
    }
    place.run(&[&absolute[..], &["-o".to_owned(), "plan.json".to_owned()]].concat()).exits(0);
    assert_eq!(std::fs::read_to_string(place.path("plan.json")).expect("written"), first);
}

#[test]
fn a_plan_comes_back_from_its_json_form() {
    let place = Place::new();
    let json = place.run(&["inspect", "forward", "--format", "json"]).exits(0).out;
    let plan = framewright_graph::plan::Plan::from_json(&json).expect("a Plan");
    assert_eq!(plan.to_json().expect("JSON"), json);
    assert_eq!(framewright_graph::verify::verify(&plan), []);
}

#[test]
fn at_four_samples_there_is_exactly_one_resolve_and_it_is_folded() {
    let totals = &plan(&["msaa=4"])["totals"];
    assert_eq!((&totals["resolves"], &totals["folded_resolves"], &totals["copies"]), (&1.into(), &1.into(), &0.into()));
}

#[test]
fn at_one_sample_there_is_no_resolve_and_no_multisampled_image() {
    let plan = plan(&["msaa=1"]);
    assert_eq!(plan["totals"]["resolves"], 0);
    for image in plan["images"].as_array().expect("a list") {
        assert_eq!(image["samples"], 1, "{}", image["name"]);
    }
}

#[test]
fn without_hdr_and_tone_mapping_at_one_sample_the_scene_goes_straight_into_the_output() {
    let plan = plan(&["msaa=1", "hdr=false", "tone_mapping=false"]);
    let names: Vec<&str> =
        plan["images"].as_array().expect("a list").iter().filter_map(|it| it["name"].as_str()).collect();
    assert_eq!(names.len(), 2, "the output and its depth: {names:?}");
    assert_eq!(plan["totals"]["scopes"], 1);
    assert_eq!(plan["totals"]["copies"], 0);
}

/// IQ-5: lavapipe has 1 and 4 samples.
#[test]
fn a_sample_count_that_the_device_lacks_is_lowered_and_said() {
    for (wanted, used, words) in [(8, 4, "4 samples"), (2, 1, "1 sample")] {
        let plan = plan(&[&format!("msaa={wanted}")]);
        let most =
            plan["images"].as_array().expect("a list").iter().filter_map(|image| image["samples"].as_u64()).max();
        assert_eq!(most, Some(used));
        let said =
            format!("{words} instead of {wanted}: `lavapipe` offers 1 and 4 for R16G16B16A16_SFLOAT with D32_SFLOAT");
        let note = plan["notes"].as_array().expect("a list").iter().any(|note| note["text"] == said);
        assert!(note, "{:#}", plan["notes"]);
    }
}

#[test]
fn a_profile_of_ones_own_decides_what_is_there() {
    let place = Place::new();
    let shipped = framewright_graph::device::SHIPPED_PROFILES[0].1;
    place.file("one.ron", shipped.replace("samples: [1, 4]", "samples: [1]").replace("\"lavapipe\"", "\"mine\""));
    let outcome = place.run(&["inspect", "forward", "--device", "one.ron", "--format", "json"]).exits(0);
    let plan: serde_json::Value = serde_json::from_str(&outcome.out).expect("JSON");
    assert_eq!(plan["device"]["name"], "mine");
    assert_eq!(plan["totals"]["resolves"], 0);
}

#[test]
fn a_scene_decides_which_passes_there_are() {
    let place = Place::new();
    // The facts that are named have the values of the scene.
    let with = |arguments: &[&str]| {
        let json = place.run(&[&["inspect", "forward", "--format", "json"], arguments].concat()).exits(0).out;
        let mut plan: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        plan["decided"] = serde_json::Value::Null;
        plan
    };
    assert_eq!(with(&[]), with(&["--scene", "spheres_and_cubes"]), "the shipped scene holds everything");
}
