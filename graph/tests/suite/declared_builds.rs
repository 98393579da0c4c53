//! Builds of acceleration structures that custom passes declare, and images of shading rates (DO-8).

use crate::testing::parts;
use crate::testing::pipelines::{INPUTS, right, wrong};
use crate::testing::plans::{compiled, on};
use framewright_graph::device::{Profile, SHIPPED_PROFILES};
use framewright_graph::plan::{MemoryBarrier, Plan, Step};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Accesses, BufferUsage, Stages};

/// A frame that fills corners, builds a structure of them, and traces it.
const BUILT: &str = r#"Pipeline(version: 1,
    images: [(name: "screen", format: R8G8B8A8_UNORM, size: Output)],
    buffers: [(name: "corners", bytes: 256), (name: "structure", bytes: 4096), (name: "scratch", bytes: 4096),
        (name: "hits", bytes: 256)],
    passes: [
        (name: "corners", fill: (to: "corners", value: 1)),
        (name: "build", custom: "build", reads: ["corners"], writes: ["structure", "scratch"], uses: [
            (buffer: "corners", stages: [ACCELERATION_STRUCTURE_BUILD_KHR], accesses: [SHADER_READ]),
            (buffer: "structure", stages: [ACCELERATION_STRUCTURE_BUILD_KHR], accesses: [ACCELERATION_STRUCTURE_WRITE_KHR]),
            (buffer: "scratch", stages: [ACCELERATION_STRUCTURE_BUILD_KHR], accesses: [ACCELERATION_STRUCTURE_WRITE_KHR]),
        ]),
        (name: "trace", custom: "trace", reads: ["structure"], writes: ["hits"], uses: [
            (buffer: "structure", stages: [COMPUTE_SHADER], accesses: [ACCELERATION_STRUCTURE_READ_KHR]),
            (buffer: "hits", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_WRITE]),
        ]),
        (name: "show", draw: FullScreen("plain"), color: ["screen"]),
    ],
    outputs: ["screen", "hits"])"#;

const BUILD: Stages = Stages::ACCELERATION_STRUCTURE_BUILD_KHR;

fn device(features: &[&str]) -> Profile {
    Profile { features: Some(features.iter().map(|it| (*it).to_owned()).collect()), ..parts::device() }
}

fn planned() -> Plan {
    let device = device(&["accelerationStructure", "bufferDeviceAddress"]);
    on(&right(BUILT, &INPUTS), &device).unwrap_or_else(|errors| panic!("{errors:?}"))
}

fn usage(plan: &Plan, name: &str) -> BufferUsage {
    plan.buffers.iter().find(|it| &*it.name == name).expect("it is used").usage
}

#[test]
fn do_8_builds_wait_for_what_they_read_and_are_waited_for() {
    let plan = planned();
    let barriers: Vec<&MemoryBarrier> = plan.steps.iter().flat_map(|step| &step.memory_barriers).collect();
    let has = |from: (Stages, Accesses), to: (Stages, Accesses)| {
        let is = |it: &&MemoryBarrier| {
            let begins = it.src_stages.contains(from.0) && it.src_accesses.contains(from.1);
            begins && it.dst_stages == to.0 && it.dst_accesses.contains(to.1)
        };
        assert!(barriers.iter().any(is), "{}", plan.tree());
    };
    has((Stages::CLEAR, Accesses::TRANSFER_WRITE), (BUILD, Accesses::SHADER_READ));
    let [read, written] = [Accesses::ACCELERATION_STRUCTURE_READ_KHR, Accesses::ACCELERATION_STRUCTURE_WRITE_KHR];
    has((BUILD, written), (Stages::COMPUTE_SHADER, read));
    // What is built, what it is built from and what the build works in have addresses.
    let addressed = BufferUsage::SHADER_DEVICE_ADDRESS;
    let input = BufferUsage::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR;
    assert_eq!(usage(&plan, "corners"), BufferUsage::TRANSFER_DST | input | addressed);
    let stored = BufferUsage::ACCELERATION_STRUCTURE_STORAGE_KHR | BufferUsage::STORAGE_BUFFER | addressed;
    assert_eq!([usage(&plan, "structure"), usage(&plan, "scratch")], [stored; 2]);
    assert!(!usage(&plan, "hits").contains(addressed));
    let names: Vec<_> = plan.own_features().iter().map(|it| it.name).collect();
    assert!(names.contains(&"accelerationStructure") && names.contains(&"bufferDeviceAddress"), "{names:?}");
}

#[test]
fn do_8_verify_holds_builds_to_barriers_and_usages() {
    let plan = planned();
    assert_eq!(verify(&plan), []);
    let caught = |change: &dyn Fn(&mut Plan)| {
        let mut plan = plan.clone();
        change(&mut plan);
        !verify(&plan).is_empty()
    };
    let barriers = |plan: &mut Plan, change: fn(&mut MemoryBarrier)| {
        plan.steps.iter_mut().flat_map(|step: &mut Step| &mut step.memory_barriers).for_each(change);
    };
    // What shaders read is not what a build reads, nor in another stage.
    assert!(caught(&|plan| barriers(plan, |it| {
        if it.dst_accesses.contains(Accesses::SHADER_READ) {
            it.dst_accesses = (it.dst_accesses - Accesses::SHADER_READ) | Accesses::SHADER_STORAGE_READ;
            it.dst_stages |= Stages::COMPUTE_SHADER;
        }
    })));
    assert!(caught(&|plan| barriers(plan, |it| it.dst_accesses -= Accesses::SHADER_READ)));
    assert!(caught(&|plan| barriers(plan, |it| it.src_accesses -= Accesses::ACCELERATION_STRUCTURE_WRITE_KHR)));
    for lost in [
        BufferUsage::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR,
        BufferUsage::SHADER_DEVICE_ADDRESS,
        BufferUsage::ACCELERATION_STRUCTURE_STORAGE_KHR,
    ] {
        assert!(caught(&|plan| plan.buffers.iter_mut().for_each(|it| it.usage -= lost)), "{lost:?}");
    }
}

#[test]
fn do_8_a_device_without_them_is_named_with_the_feature() {
    let refused = on(&right(BUILT, &INPUTS), &device(&[])).expect_err("it has no acceleration structures");
    let said: Vec<String> = refused.iter().map(|it| it.message.clone()).collect();
    assert!(said.iter().all(|it| it.contains("needs the feature accelerationStructure, which")), "{said:?}");
    assert!(!said.is_empty());
}

/// A custom pass that names `rates`, and what it declares of it.
fn rates(fields: &str) -> String {
    format!(
        r#"Pipeline(version: 1, images: [
            (name: "screen", format: R8G8B8A8_UNORM, size: Output),
            (name: "kept", format: R8G8B8A8_UNORM, size: Output, lifetime: Persistent),
            (name: "rates", format: R8_UINT, size: Scaled(0.0625), lifetime: Persistent)],
         buffers: [(name: "old", bytes: 256, lifetime: Persistent)],
         passes: [(name: "build", custom: "build", side_effect: true, {fields}),
            (name: "show", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#
    )
}

const RATES: &str = r#"uses: [(image: "rates", stages: [FRAGMENT_SHADING_RATE_ATTACHMENT_KHR],
    accesses: [FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR], layout: FRAGMENT_SHADING_RATE_ATTACHMENT_OPTIMAL_KHR)]"#;

#[test]
fn do_8_shading_rates_that_the_plans_scope_would_not_have_are_refused() {
    // A program that begins a scope of its own attaches them there.
    let own = right(&rates(&format!(r#"reads: ["rates", "kept"], {RATES}"#)), &INPUTS);
    compiled(&own);
    let drawn = rates(&format!(r#"color: ["kept"], sample: {{"rates": "rates"}}, {RATES}"#));
    let said = wrong(&drawn, &INPUTS);
    let what = "`rates` is declared as the shading rates of the pass's rendering scope, which has none";
    assert!(said.contains(what) && said.contains("test.ron:6:"), "{said}");
}

#[test]
fn do_8_every_device_with_shading_rates_has_them_in_the_format_that_vulkan_demands() {
    let frame = right(&rates(&format!(r#"reads: ["rates", "kept"], {RATES}"#)), &INPUTS);
    let mut have = 0;
    for (name, text) in SHIPPED_PROFILES {
        let profile = Profile::from_ron(text).expect("a profile");
        if profile.has_feature("attachmentFragmentShadingRate") {
            on(&frame, &profile).unwrap_or_else(|errors| panic!("{name}: {errors:?}"));
            have += 1;
        }
    }
    assert_eq!(have, 3);
    // A format that has no such use is named with what declares it.
    let other = rates(&format!(r#"reads: ["rates", "kept"], {RATES}"#)).replace("R8_UINT", "R16_SFLOAT");
    let profile =
        Profile::from_ron(SHIPPED_PROFILES.iter().find(|it| it.0 == "nvidia-rtx-2080").expect("it is there").1);
    let errors = on(&right(&other, &INPUTS), &profile.expect("a profile")).expect_err("no such use");
    let [wrong] = &errors[..] else { panic!("{errors:?}") };
    assert!(wrong.message.ends_with("no FRAGMENT_SHADING_RATE_ATTACHMENT_KHR"), "{wrong:?}");
    assert!(wrong.labels.iter().any(|it| it.text == "pass `build` declares this use"), "{wrong:?}");
}

#[test]
fn do_8_reads_of_builds_are_of_buffers_and_of_builds() {
    for (fields, words) in [
        (
            r#"reads: ["old"], uses: [(buffer: "old", stages: [COMPUTE_SHADER], accesses: [SHADER_READ])]"#,
            "SHADER_READ doesn't happen in COMPUTE_SHADER",
        ),
        (
            r#"reads: ["kept"], uses: [(image: "kept", stages: [ACCELERATION_STRUCTURE_BUILD_KHR], accesses: [SHADER_READ], layout: GENERAL)]"#,
            "`kept` is an image, which sees no SHADER_READ",
        ),
    ] {
        let said = wrong(&rates(fields), &INPUTS);
        assert!(said.contains(words), "{said}");
    }
}
