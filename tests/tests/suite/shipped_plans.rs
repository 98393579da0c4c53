//! Plans of the shipped pipelines, in the combinations of their discrete settings, without any device.

use crate::hand_written_plans::names_all;
use framewright_graph::base;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile, SHIPPED_PROFILES};
use framewright_graph::plan::Plan;
use framewright_graph::verify::verify;
use framewright_tests::shipped::{self, ShippedFrame};

/// A Plan and how it came about.
struct Shipped {
    how: String,
    plan: Plan,
}

/// The Plans of these frames for a shipped device.
fn shipped_for(name: &str, text: &str, frames: Vec<&ShippedFrame>) -> Vec<Shipped> {
    let profile = Profile::from_ron(text).expect("shipped profiles are read");
    let plan = |shipped: &ShippedFrame| {
        let plan = compile(&shipped.frame, &profile, &mut MemoryEstimate(&profile), &Options::default())
            .unwrap_or_else(|wrong| panic!("{}", base::render(&shipped.frame.sources, &wrong)));
        Shipped { how: format!("{} on {name}", shipped.how), plan }
    };
    frames.into_iter().map(plan).collect()
}

fn frames() -> Vec<&'static ShippedFrame> {
    shipped::frames([333, 187]).iter().collect()
}

#[test]
fn every_shipped_pipeline_compiles_to_a_plan_without_violations_on_every_shipped_device() {
    for (name, text) in SHIPPED_PROFILES {
        assert!(frames().len() > 40, "{} frames", frames().len());
        let plans = shipped_for(name, text, frames());
        for Shipped { how, plan } in plans {
            assert_eq!(verify(&plan), [], "{how}\n{}", plan.tree());
        }
    }
}

#[test]
fn no_barrier_of_a_shipped_pipeline_can_be_left_out_unseen() {
    let mut removed = 0;
    let (name, text) = SHIPPED_PROFILES[0];
    for Shipped { how, plan } in shipped_for(name, text, frames()) {
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
                    kept_bytes: plan.totals.kept_bytes,
                    ..framewright_graph::plan::Totals::count(&without.steps)
                };
                let violations = verify(&without);
                let caught = violations.iter().any(names_all);
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
    let (name, text) = SHIPPED_PROFILES[0];
    let soft_focus = frames().into_iter().filter(|one| one.how.starts_with("soft_focus.ron"));
    let plans = shipped_for(name, text, soft_focus.collect());
    assert!(!plans.is_empty());
    for Shipped { how, plan } in plans {
        let totals = plan.totals;
        assert!(totals.placed_bytes as f64 <= 1.02 * totals.live_peak_bytes as f64, "{how}: {totals:?}");
        assert!(totals.placed_bytes < totals.transient_bytes, "{how}: {totals:?}");
    }
}
