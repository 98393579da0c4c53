//! Plans from strangers. Every place in the JSON form of Plans is changed, alone and together with all that are equal to it. What
//! is read and verified all the same is prepared and drawn under the validation layer: it either is an error, or the layer is
//! silent.

mod mutants;

use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Groups, Stereo};
use framewright_graph::plan::{ImageBarrier, Plan, Role, Step, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Rotation, Subresources};
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::scene::{Scene, Sun};
use framewright_tests::render::{Setup, Ways, device, library, plan_for};
use framewright_tests::shapes::{material, scene, square};
use framewright_tests::sweep;
use framewright_vulkan::{Device, Executor, ExecutorOptions, Message, ShaderLibrary};
use glam::Mat4;
use mutants::{Mutant, Vocabulary};
use serde_json::Value;
use std::collections::BTreeMap;

/// Pipelines that together have every kind of work and resource, and how they are drawn.
const PIPELINES: [(&str, Stereo, Rotation); 11] = [
    ("copies", Stereo::Off, Rotation::Identity),
    ("exposure", Stereo::Off, Rotation::Identity),
    ("accumulate", Stereo::Off, Rotation::Identity),
    ("depth_resolves", Stereo::Off, Rotation::Identity),
    ("resolves", Stereo::Off, Rotation::Identity),
    ("scale", Stereo::Off, Rotation::Identity),
    ("shadows", Stereo::Off, Rotation::Identity),
    ("lit", Stereo::Off, Rotation::Identity),
    ("forward", Stereo::Off, Rotation::Rotate90),
    ("eyes_clamped", Stereo::DoubleWide, Rotation::Identity),
    ("eyes_fetched", Stereo::Instanced, Rotation::Identity),
];

/// What is larger takes a software driver long, or all of the machine's memory.
const MOST_BYTES: u64 = 1 << 28;
const MOST_INVOCATIONS: u64 = 1 << 16;

/// A square that casts the sun's shadow.
fn lit_square() -> Scene {
    let sun = Sun { direction: [0.0, -1.0, -1.0], color: [1.0; 3], shadows: true };
    Scene { sun, ..scene(vec![square()], vec![material([1.0; 4])], vec![(0, 0, Mat4::IDENTITY)]) }
}

fn plans(device: &Device, scene: &Scene, shaders: &mut ShaderLibrary) -> Vec<(&'static str, Plan)> {
    let plan = |(name, stereo, rotation): (&'static str, Stereo, Rotation)| {
        let folder = if name == "forward" { "examples" } else { "tests" };
        let pipeline = format!("{folder}/pipelines/{name}.ron");
        let setup = Setup { pipeline: &pipeline, set: &[], scene, extent: [8, 8] };
        let plan = plan_for(device, &setup, Ways { stereo, rotation }, shaders, &Options::default());
        (name, plan.unwrap_or_else(|error| panic!("{name}: {error}")))
    };
    PIPELINES.map(plan).into()
}

/// Whether drawing it takes little time and memory.
fn is_small(plan: &Plan) -> bool {
    let of_image = |image: &framewright_graph::plan::Image| match image.role {
        Role::Transient(_) => 0,
        _ => image
            .made()
            .into_iter()
            .chain([image.made_layers(), image.samples])
            .map(u64::from)
            .fold(16, u64::saturating_mul),
    };
    let buffers = plan.buffers.iter().map(|buffer| buffer.bytes);
    let bytes = plan.images.iter().map(of_image).chain(buffers).chain(plan.heaps.iter().map(|heap| heap.bytes));
    let invocations = plan.steps.iter().flat_map(|step| match &step.work {
        Work::Render(scope) => scope
            .passes
            .iter()
            .map(|pass| match pass.draw {
                Some(Draw::Vertices { count, instances }) => u64::from(count) * u64::from(instances),
                _ => 1,
            })
            .collect(),
        Work::Dispatch(pass) => vec![match pass.groups {
            Some(Groups::Count(count) | Groups::Invocations(count)) => {
                count.map(u64::from).into_iter().fold(1, u64::saturating_mul)
            }
            _ => 1,
        }],
        _ => Vec::new(),
    });
    bytes.fold(0, u64::saturating_add) < MOST_BYTES && invocations.fold(0, u64::saturating_add) < MOST_INVOCATIONS
}

/// Draws two frames, and reads all outputs.
fn draw(
    device: &Device,
    plan: &Plan,
    scene: &Scene,
    shaders: &mut ShaderLibrary,
) -> Result<(), framewright_vulkan::Error> {
    let mut source = SceneDrawSource::for_plan(device, scene, plan.extent, plan)?;
    let mut executor = Executor::new(device, plan, shaders, &ExecutorOptions::default())?;
    for _ in 0..2 {
        executor.frame(&mut source)?;
    }
    for output in 0..plan.outputs.len() {
        // Buffers and images of several samples can't be read so.
        drop(executor.read(output));
    }
    Ok(())
}

#[test]
fn a_changed_plan_is_refused_or_drawn_in_silence() {
    let Some(device) = device() else { return };
    let (scene, mut shaders) = (lit_square(), library());
    let plans: Vec<(&str, Value)> = plans(device, &scene, &mut shaders)
        .into_iter()
        .map(|(name, plan)| (name, serde_json::to_value(&plan).expect("JSON")))
        .collect();
    let mut vocabulary = Vocabulary::default();
    plans.iter().for_each(|(_, plan)| vocabulary.add(plan));
    let (mut outcomes, mut found) = (BTreeMap::<&str, usize>::new(), Vec::new());
    for (name, plan) in &plans {
        for change in sweep::of(name, vocabulary.mutants(name, plan), 600) {
            let Mutant { how, text } = mutants::changed(plan, change);
            let Ok(plan) = Plan::from_json(&text) else {
                *outcomes.entry("not read").or_default() += 1;
                continue;
            };
            if !verify(&plan).is_empty() {
                *outcomes.entry("not right").or_default() += 1;
                continue;
            }
            if !is_small(&plan) {
                *outcomes.entry("too large").or_default() += 1;
                continue;
            }
            if std::env::var_os("FRAMEWRIGHT_TELL").is_some() {
                eprintln!("{how}");
            }
            let before = device.messages().list().len();
            let drawn = draw(device, &plan, &scene, &mut shaders);
            let said: Vec<Message> = device.messages().list().split_off(before);
            let said: Vec<String> =
                said.iter().filter(|it| it.is_finding()).map(|it| format!("{}: {}", it.id, it.text)).collect();
            *outcomes.entry(if drawn.is_ok() { "drawn" } else { "refused by the device" }).or_default() += 1;
            if let Some(first) = said.first() {
                eprintln!("FOUND {how}\n      {first}\n      {drawn:?}");
                found.push(how);
            }
        }
    }
    println!("{outcomes:?}");
    assert_eq!(found, [""; 0]);
    // Something of each was tried.
    for (outcome, least) in [("drawn", 100), ("not right", 100), ("not read", 100), ("refused by the device", 10)] {
        assert!(outcomes.get(outcome) >= Some(&least), "{outcome}: {outcomes:?}");
    }
}

/// The error that `change` to the Plan of a pipeline leads to; it breaks no rule.
fn refusal(pipeline: &str, change: impl FnOnce(Plan) -> Plan) -> Option<String> {
    let device = device()?;
    let (scene, mut shaders) = (lit_square(), library());
    let plans = plans(device, &scene, &mut shaders);
    let (_, plan) = plans.into_iter().find(|(name, _)| *name == pipeline).expect("it is one of them");
    let plan = change(plan);
    assert_eq!(verify(&plan), []);
    let refused = draw(device, &plan, &scene, &mut shaders);
    Some(refused.expect_err("it is refused").to_string())
}

#[test]
fn heaps_that_are_more_together_than_the_device_has_are_refused() {
    let more = |mut plan: Plan| {
        plan.heaps[0].bytes = 1 << 30;
        plan.heaps = vec![plan.heaps[0].clone(); 1 << 10];
        plan.totals.placed_bytes = 1 << 40;
        plan
    };
    let Some(said) = refusal("resolves", more) else { return };
    assert!(said.starts_with("no memory for the Plan, 1.0 TiB"), "{said}");
}

#[test]
fn a_shader_stage_that_the_plan_leaves_out_is_refused() {
    let change = |plan: Plan| {
        let text = plan.to_json().expect("JSON").replace("FRAGMENT_SHADER", "VERTEX_SHADER");
        Plan::from_json(&text).expect("a Plan")
    };
    let Some(said) = refusal("copies", change) else { return };
    assert!(said.contains("FRAGMENT_SHADER") && said.contains("the Plan has it used in"), "{said}");
}

/// A checker that looks at all pairs of attachments or barriers takes hours.
#[test]
fn very_long_lists_are_looked_at_in_little_time() {
    const MANY: u32 = 100_000;
    let Some(device) = device() else { return };
    let (scene, mut shaders) = (lit_square(), library());
    let plans = plans(device, &scene, &mut shaders);
    let (_, plan) = plans.into_iter().find(|(name, _)| *name == "lit").expect("it is one of them");
    let mut attached = plan.clone();
    for step in &mut attached.steps {
        if let Work::Render(scope) = &mut step.work {
            scope.attachments = vec![scope.attachments[0].clone(); MANY as usize];
        }
    }
    assert!(!verify(&attached).is_empty());
    let mut layered = plan.clone();
    let barrier = layered.steps[0].image_barriers[0].clone();
    layered.images[barrier.image.0 as usize].layers = MANY;
    let layer = |layer| ImageBarrier {
        range: Subresources { base_layer: layer, layers: 1, ..barrier.range },
        ..barrier.clone()
    };
    layered.steps[0].image_barriers = (0..MANY).map(layer).collect();
    assert!(!verify(&layered).is_empty());
    let mut long = plan;
    let nothing =
        Step { memory_barriers: Vec::new(), image_barriers: Vec::new(), work: Work::Export, ..long.steps[0].clone() };
    long.steps.extend(vec![nothing; MANY as usize]);
    assert_eq!(verify(&long), []);
    draw(device, &long, &scene, &mut shaders).expect("it is drawn");
}
