//! Plans of the shipped pipelines, in every combination of their discrete settings, without any device.

use framewright_graph::compile::{Options, compile};
use framewright_graph::describe::{self, Pipeline, SettingKind};
use framewright_graph::device::{Estimated, Profile, SHIPPED_PROFILES};
use framewright_graph::expand::{Facts, Inputs, expand};
use framewright_graph::plan::Plan;
use framewright_graph::source::Sources;
use framewright_graph::verify::{Violation, verify};
use framewright_passes::draw::interface;
use framewright_passes::shipped::SHADERS;
use framewright_tests::render::in_repository;
use framewright_vulkan::ShaderLibrary;
use std::sync::Arc;

/// A Plan and how it came about.
struct Shipped {
    how: String,
    plan: Plan,
}

/// Every value that a setting of few values may have; the ends of one of many.
fn values(kind: &SettingKind) -> Vec<String> {
    match kind {
        SettingKind::Bool { .. } => vec!["false".to_owned(), "true".to_owned()],
        SettingKind::OneOf { of, .. } => of.iter().map(ToString::to_string).collect(),
        SettingKind::Number { min, max, .. } => vec![min.to_string(), max.to_string()],
        SettingKind::Integer { min, max, .. } => vec![min.to_string(), max.to_string()],
    }
}

fn combinations(pipeline: &Pipeline) -> Vec<Vec<(String, String)>> {
    pipeline.settings.iter().fold(vec![Vec::new()], |combinations, setting| {
        let with = |chosen: &Vec<(String, String)>, value: String| {
            [&chosen[..], &[(setting.name.text.to_string(), value)]].concat()
        };
        let all = combinations.iter();
        all.flat_map(|chosen| values(&setting.kind).into_iter().map(move |value| with(chosen, value))).collect()
    })
}

/// All Plans of all shipped pipelines, with everything in the scene and with nothing but opaque objects.
fn shipped() -> Vec<Shipped> {
    let profile = Profile::from_ron(SHIPPED_PROFILES[0].1).expect("shipped profiles are read");
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interface);
    let mut plans = Vec::new();
    let folder = std::fs::read_dir(in_repository("examples/pipelines")).expect("pipelines are shipped");
    for file in folder.map(|file| file.expect("the folder can be listed").path()) {
        let name = file.file_name().expect("a file has a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&file).expect("a shipped pipeline is text");
        let mut sources = Sources::default();
        let pipeline = describe::read(&mut sources, &name, &name, text).expect("a shipped pipeline is right");
        let sources = Arc::new(sources);
        let opaque = Facts { has_alpha_clip: false, has_transparent: false, ..Facts::UNKNOWN };
        for (set, facts) in combinations(&pipeline).iter().flat_map(|set| [(set, Facts::UNKNOWN), (set, opaque)]) {
            let inputs = Inputs { set, facts, facts_known: true, output_extent: [333, 187], dump: &[] };
            let frame = expand(&pipeline, sources.clone(), &inputs, &mut shaders)
                .unwrap_or_else(|wrong| panic!("{}", describe::render(&sources, &wrong)));
            let plan = compile(&frame, &profile, &mut Estimated(&profile.memory), &Options::default())
                .unwrap_or_else(|wrong| panic!("{}", describe::render(&sources, &wrong)));
            plans.push(Shipped { how: format!("{name} {set:?} {facts:?}"), plan });
        }
    }
    plans
}

fn names_both_steps_and_the_subresource(violation: &Violation) -> bool {
    let Violation { step: Some(step), other: Some(other), image: Some(image), range: Some(range), .. } = violation
    else {
        return false;
    };
    let sentence = violation.to_string();
    let parts = [step.to_string(), other.to_string(), format!("`{image}`"), range.to_string()];
    parts.iter().all(|part| sentence.contains(part))
}

#[test]
fn every_shipped_pipeline_compiles_to_a_plan_without_violations() {
    let plans = shipped();
    assert!(plans.len() > 40, "{} Plans", plans.len());
    for Shipped { how, plan } in plans {
        assert_eq!(verify(&plan), [], "{how}\n{}", plan.tree());
    }
}

#[test]
fn no_barrier_of_a_shipped_pipeline_can_be_left_out_unseen() {
    let mut removed = 0;
    for Shipped { how, plan } in shipped() {
        for step in 0..plan.steps.len() {
            let (images, memory) = (plan.steps[step].image_barriers.len(), plan.steps[step].memory_barriers.len());
            for barrier in 0..images + memory {
                let mut without = plan.clone();
                if barrier < images {
                    without.steps[step].image_barriers.remove(barrier);
                } else {
                    without.steps[step].memory_barriers.remove(barrier - images);
                }
                without.totals = framewright_graph::plan::Totals {
                    transient_bytes: plan.totals.transient_bytes,
                    placed_bytes: plan.totals.placed_bytes,
                    live_peak_bytes: plan.totals.live_peak_bytes,
                    output_bytes: plan.totals.output_bytes,
                    ..framewright_graph::plan::Totals::count(&without.steps)
                };
                let violations = verify(&without);
                let caught = violations.iter().any(names_both_steps_and_the_subresource);
                assert!(caught, "{how}: barrier {barrier} of step {step}: {violations:?}\n{}", plan.tree());
                removed += 1;
            }
        }
    }
    println!("{removed} barriers removed, each one missed");
    assert!(removed > 300, "{removed}");
}

/// Images whose lifetimes are disjoint share memory.
#[test]
fn soft_focus_is_placed_at_most_two_hundredths_above_its_live_peak() {
    let plans: Vec<Shipped> = shipped().into_iter().filter(|one| one.how.starts_with("soft_focus.ron")).collect();
    assert!(!plans.is_empty());
    for Shipped { how, plan } in plans {
        let totals = plan.totals;
        assert!(totals.placed_bytes as f64 <= 1.02 * totals.live_peak_bytes as f64, "{how}: {totals:?}");
        assert!(totals.placed_bytes < totals.transient_bytes, "{how}: {totals:?}");
    }
}
