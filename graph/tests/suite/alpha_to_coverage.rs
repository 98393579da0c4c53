//! Alpha that says how many samples are covered: where there are several, and nowhere else.

use crate::testing::pipelines::{INPUTS, right, set};
use crate::testing::plans::{on, scopes, shipped};
use framewright_graph::device::Profile;
use framewright_graph::expand::Inputs;
use framewright_graph::plan::{Pass, Plan, Work};
use framewright_graph::verify::verify;

/// Opaque and perforated objects with `msaa` samples, whose depth a pass samples, and a pass that shows the picture.
const PIPELINE: &str = r#"Pipeline(
    version: 1,
    settings: [
        (name: "msaa", value: OneOf(default: 4, of: [1, 4, 8])),
        (name: "covers", value: Bool(default: true)),
    ],
    images: [
        (name: "color", format: Color, size: Output, samples: "msaa"),
        (name: "depth", format: Depth, size: Like("color"), samples: Like("color")),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "opaque", draw: Objects(Opaque), shader: "lit",
            color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
        (name: "masked", draw: Objects(Masked), shader: "lit_masked", alpha_to_coverage: "covers",
            color: ["color"], depth: "depth"),
        (name: "stripes", draw: FullScreen("depth_stripes"), sample: {"depth": (image: DepthOnly("depth"), filter: Nearest)},
            params: {"period": 1.0}, color: [(image: "color", blend: Premultiplied)]),
        (name: "show", draw: FullScreen("blur_tent"), sample: {"source": "color"}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;

fn plan_on(chosen: &[(&str, &str)], device: &Profile) -> Plan {
    let set = set(chosen);
    let frame = right(PIPELINE, &Inputs { set: &set, ..INPUTS });
    on(&frame, device).expect("it compiles")
}

fn plan(chosen: &[(&str, &str)]) -> Plan {
    plan_on(chosen, &shipped("lavapipe"))
}

fn passes(plan: &Plan) -> Vec<&Pass> {
    scopes(plan).into_iter().flat_map(|scope| &scope.passes).collect()
}

/// Names of the passes that cover samples by alpha.
fn covering(plan: &Plan) -> Vec<&str> {
    passes(plan).into_iter().filter(|pass| pass.alpha_to_coverage).map(|pass| &*pass.name).collect()
}

const OFF: &str = "alpha_to_coverage is off: its targets have 1 sample";

fn said(plan: &Plan) -> bool {
    plan.notes.iter().any(|note| &*note.subject == "masked" && note.text == OFF)
}

#[test]
fn a_pass_that_asks_for_it_covers_samples_and_what_draws_its_depth_again_does_not() {
    let plan = plan(&[]);
    assert_eq!(covering(&plan), ["masked"]);
    let again = passes(&plan).into_iter().find(|pass| &*pass.name == "masked (depth only)").expect("it is drawn again");
    assert!(again.redraws.is_some() && !again.alpha_to_coverage);
    assert!(plan.tree().contains("`masked` draws masked objects with shader `lit_masked`, alpha to coverage"));
    assert!(plan.to_json().expect("it is written").contains("\"alpha_to_coverage\": true"));
    assert!(!said(&plan));
}

#[test]
fn without_being_asked_nothing_is_covered_by_alpha() {
    let plan = plan(&[("covers", "false")]);
    assert!(covering(&plan).is_empty() && !said(&plan));
}

#[test]
fn with_one_sample_it_is_off_and_the_plan_says_why() {
    let asked = plan(&[("msaa", "1")]);
    assert!(covering(&asked).is_empty() && said(&asked), "{}", asked.tree());
    let mut single = shipped("lavapipe");
    single.formats.iter_mut().for_each(|support| support.samples.retain(|count| *count == 1));
    let lowered = plan_on(&[], &single);
    assert!(covering(&lowered).is_empty() && said(&lowered), "{}", lowered.tree());
    assert_eq!(covering(&plan(&[("msaa", "8")])), ["masked"], "lowered to 4");
}

#[test]
fn the_checker_finds_alpha_that_can_not_cover() {
    let wrong = |change: fn(&mut Plan)| {
        let mut plan = plan(&[]);
        change(&mut plan);
        verify(&plan).iter().any(|violation| violation.to_string().contains("covers samples by alpha and can't"))
    };
    fn each(plan: &mut Plan, change: fn(&mut Pass)) {
        for step in &mut plan.steps {
            if let Work::Render(scope) = &mut step.work {
                scope.passes.iter_mut().for_each(change);
            }
        }
    }
    assert!(!wrong(|_| {}));
    assert!(wrong(|plan| each(plan, |pass| pass.alpha_to_coverage |= &*pass.name == "show")), "one sample");
    assert!(wrong(|plan| each(plan, |pass| pass.alpha_to_coverage |= pass.redraws.is_some())), "no colour");
    assert!(wrong(|plan| each(plan, |pass| pass.discards = false)), "fragments are lost");
}
