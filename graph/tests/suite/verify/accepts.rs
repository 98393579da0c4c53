//! The checker accepts correct Plans, and shares nothing with the compiler.

use crate::testing::hand_written_plans;
use framewright_graph::plan::{ImageBarrier, MemoryBarrier, Plan};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Accesses, Layout, Stages};
use std::path::Path;

pub(crate) fn accept(name: &str, plan: &Plan) {
    let violations: Vec<String> = verify(plan).iter().map(ToString::to_string).collect();
    assert!(violations.is_empty(), "{name}:\n{}", violations.join("\n"));
}

/// The first Plan, with two barriers that wait for what was waited for before.
fn with_redundant_barriers() -> Plan {
    let [(_, mut plan), ..] = hand_written_plans::all();
    let step = &mut plan.steps[1];
    step.memory_barriers.push(MemoryBarrier {
        src_stages: Stages::ALL_COMMANDS,
        src_accesses: Accesses::MEMORY_WRITE,
        dst_stages: Stages::ALL_COMMANDS,
        dst_accesses: Accesses::MEMORY_READ | Accesses::MEMORY_WRITE,
        hand_overs: Vec::new(),
        buffers: Vec::new(),
    });
    let again = ImageBarrier { old_layout: Layout::TransferSrcOptimal, ..plan.steps[2].image_barriers[0].clone() };
    let mut step = plan.steps[2].clone();
    step.image_barriers = vec![again];
    plan.steps.push(step);
    hand_written_plans::recount(&mut plan);
    plan
}

#[test]
fn plans_written_by_hand_are_accepted() {
    for (name, plan) in hand_written_plans::all() {
        accept(name, &plan);
    }
}

#[test]
fn redundant_barriers_are_accepted() {
    accept("redundant", &with_redundant_barriers());
}

#[test]
fn a_plan_survives_its_json_form() {
    for (name, plan) in hand_written_plans::all() {
        let text = plan.to_json().unwrap();
        let again = Plan::from_json(&text).unwrap();
        assert_eq!(again, plan, "{name}");
        assert_eq!(again.to_json().unwrap(), text, "{name}");
    }
}

/// Nothing but the words that a Plan is written in, and every file is part of it.
#[test]
fn the_checker_shares_nothing_with_the_compiler() {
    const WORDS: [&str; 4] = ["frame", "plan", "shader", "vulkan"];
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/verify");
    let modules = std::fs::read_to_string(folder.join("mod.rs")).unwrap();
    let mut files = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains("compile"), "{} mentions the compiler", path.display());
        for used in text.split("crate::").skip(1) {
            let module = used.split(|letter: char| !letter.is_alphanumeric() && letter != '_').next().unwrap();
            assert!(WORDS.contains(&module), "{} uses crate::{module}", path.display());
        }
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert!(name == "mod" || modules.contains(&format!("mod {name};")), "{} is not compiled", path.display());
        files += 1;
    }
    assert!(files > 5, "{files} files in {}", folder.display());
}

#[test]
fn the_documented_example_is_a_right_plan_in_the_form_that_is_written() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/plan-example.json");
    let text = std::fs::read_to_string(path).unwrap();
    let plan = Plan::from_json(&text).unwrap();
    accept("the example", &plan);
    assert_eq!(plan.to_json().unwrap(), text);
}
