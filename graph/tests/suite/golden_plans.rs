//! The Plans of every shipped pipeline as text, on the shipped lavapipe profile: with its default settings, with each
//! alternative of each setting, over a scene of opaque objects alone, and over one without anything brighter than white. The
//! texts under `golden_plans/` are there to be reviewed: a change of the compiler shows as a change of theirs.

use crate::testing::pipelines::{INPUTS, shipped};
use crate::testing::plans::shipped as shipped_device;
use crate::testing::table::Table;
use framewright_graph::base::{self, Root, Sources};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile, Queues};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::Frame;
use framewright_graph::language::{self, Document, Facts, PipelineFiles, SettingKind};
use framewright_graph::plan::{Image, Pass, Plan, Resource, Role, StepId, Totals, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Sharing;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How a changed Plan is accepted.
const ACCEPT: &str = "INSTA_UPDATE=always cargo test -p framewright-graph --test suite golden_plans";

/// A way to make a Plan of a pipeline: its name, and what is set.
type Variant = (String, Vec<(String, String)>, Facts);

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden_plans")
}

fn pipelines() -> BTreeSet<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pipelines");
    let files = std::fs::read_dir(folder).expect("pipelines are shipped");
    let names = files.map(|file| file.expect("the folder can be listed").file_name().to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".ron")).collect()
}

/// Every value but the default of a setting of few values; the ends of one of many.
fn alternatives(kind: &SettingKind) -> Vec<String> {
    let (default, values) = match kind {
        SettingKind::Bool { default } => (default.to_string(), vec!["false".to_owned(), "true".to_owned()]),
        SettingKind::OneOf { default, of, .. } => (default.to_string(), of.iter().map(ToString::to_string).collect()),
        SettingKind::Choice { default, of } => (default.to_string(), of.iter().map(ToString::to_string).collect()),
        SettingKind::Number { default, min, max, .. } => (default.to_string(), vec![min.to_string(), max.to_string()]),
        SettingKind::Integer { default, min, max, .. } => (default.to_string(), vec![min.to_string(), max.to_string()]),
    };
    values.into_iter().filter(|value| *value != default).collect()
}

fn variants(file: &str, pipeline: &Document) -> Vec<Variant> {
    let name = file.trim_end_matches(".ron");
    let opaque = Facts { has_alpha_clip: false, has_cross_fade: false, has_transparent: false, ..Facts::UNKNOWN };
    let dim = Facts { peak_radiance: 0.75, ..Facts::UNKNOWN };
    let mut variants = vec![
        (name.to_owned(), Vec::new(), Facts::UNKNOWN),
        (format!("{name}@opaque_scene"), Vec::new(), opaque),
        (format!("{name}@dim_scene"), Vec::new(), dim),
    ];
    for setting in &pipeline.settings {
        variants.extend(alternatives(&setting.kind).into_iter().map(|value| {
            let set = vec![(setting.name.text.to_string(), value.clone())];
            (format!("{name}@{}={value}", setting.name.text), set, Facts::UNKNOWN)
        }));
    }
    variants
}

/// A shipped pipeline with the files that it names.
fn document(file: &str) -> (Document, Sources) {
    let root = Root::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pipelines"));
    let mut sources = Sources::default();
    let mut files = PipelineFiles::beside(root, file, &[]);
    let pipeline = language::read_with(&mut sources, &mut files, file, file, shipped(file));
    (pipeline.expect("a shipped pipeline is right"), sources)
}

pub(crate) fn expanded(file: &str, inputs: &Inputs<'_>) -> Frame {
    let (pipeline, sources) = document(file);
    let sources = Arc::new(sources);
    expand(&pipeline, sources.clone(), inputs, &mut Table)
        .unwrap_or_else(|errors| panic!("{}", base::render(&sources, &errors)))
}

fn all() -> Vec<(String, Variant)> {
    let each = |file: String| {
        let (pipeline, _) = document(&file);
        variants(&file, &pipeline).into_iter().map(move |variant| (file.clone(), variant))
    };
    pipelines().into_iter().flat_map(each).collect()
}

#[test]
fn every_shipped_pipeline_makes_the_plans_that_were_reviewed() {
    let profile = shipped_device("lavapipe");
    for (file, (name, set, facts)) in all() {
        let inputs = Inputs { set: &set, facts, facts_known: true, ..INPUTS };
        let frame = expanded(&file, &inputs);
        let plan = compile(&frame, &profile, &mut MemoryEstimate(&profile), &Options::default())
            .unwrap_or_else(|wrong| panic!("{name}: {wrong:?}"));
        assert_eq!(verify(&plan), [], "{name}");
        insta::with_settings!({
            snapshot_path => folder(), prepend_module_to_snapshot => false, omit_expression => true,
            description => format!("accept with {ACCEPT}"),
        }, { insta::assert_snapshot!(name, plan.tree()) });
    }
}

/// Barriers of a Plan that `verify` doesn't miss.
fn needless(name: &str, plan: &Plan) -> Vec<String> {
    let mut needless = Vec::new();
    for (step, described) in plan.steps.iter().enumerate() {
        let (images, memory) = (described.image_barriers.len(), described.memory_barriers.len());
        for barrier in 0..images + memory {
            let mut without = plan.clone();
            let what = match barrier.checked_sub(images) {
                None => {
                    let barrier = without.steps[step].image_barriers.remove(barrier);
                    format!("`{}`, {:?}", plan.image(barrier.image).name, barrier.hazard)
                }
                Some(at) => format!("{:?}", without.steps[step].memory_barriers.remove(at)),
            };
            let Totals { transient_bytes, placed_bytes, live_peak_bytes, kept_bytes, .. } = plan.totals;
            without.totals =
                Totals { transient_bytes, placed_bytes, live_peak_bytes, kept_bytes, ..Totals::count(&without.steps) };
            if verify(&without).is_empty() {
                needless.push(format!("{name}: step {step}: {what}"));
            }
        }
    }
    needless
}

#[test]
fn no_barrier_of_a_reviewed_plan_can_be_left_out() {
    let one_queue = shipped_device("lavapipe");
    let queues = Queues { compute: true, transfer: true, sharing: Sharing::Exclusive, wait_bytes: 0 };
    let devices = [Profile { queues, local_read: true, ..one_queue.clone() }, one_queue];
    let mut found = Vec::new();
    for (file, (name, set, facts)) in all() {
        let inputs = Inputs { set: &set, facts, facts_known: true, ..INPUTS };
        let frame = expanded(&file, &inputs);
        for device in &devices {
            let plan = compile(&frame, device, &mut MemoryEstimate(device), &Options::default());
            found.extend(needless(&name, &plan.unwrap_or_else(|wrong| panic!("{name}: {wrong:?}"))));
        }
    }
    assert!(found.is_empty(), "{} barriers that nobody misses:\n{}", found.len(), found.join("\n"));
}

/// Whether the work of a step touches an image or a buffer.
fn touches(work: &Work, resource: Resource) -> bool {
    let by_passes = |passes: &[Pass]| {
        passes.iter().any(|pass| {
            let images = pass.accesses.iter().map(|access| Resource::Image(access.image));
            images.chain(pass.buffers.iter().map(|access| Resource::Buffer(access.buffer))).any(|it| it == resource)
        })
    };
    match work {
        Work::Render(scope) => {
            let mut attached = scope.attachments.iter().flat_map(|attachment| {
                [Some(attachment.image), attachment.resolve.as_ref().map(|resolve| resolve.image)]
            });
            attached.any(|image| image.map(Resource::Image) == Some(resource)) || by_passes(&scope.passes)
        }
        Work::Dispatch(pass) | Work::Custom(pass) => by_passes(std::slice::from_ref(pass)),
        Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
            [&transfer.source, &transfer.target].iter().any(|side| side.resource() == resource)
        }
        Work::Fill(fill) => fill.target.resource() == resource,
        Work::Export => true,
    }
}

/// Every Plan that is held here, for lavapipe, with its name.
fn on_lavapipe() -> Vec<(String, Plan)> {
    let device = shipped_device("lavapipe");
    let compiled = all().into_iter().map(|(file, (name, set, facts))| {
        let inputs = Inputs { set: &set, facts, facts_known: true, ..INPUTS };
        let plan = compile(&expanded(&file, &inputs), &device, &mut MemoryEstimate(&device), &Options::default());
        let plan = plan.unwrap_or_else(|wrong| panic!("{name}: {wrong:?}"));
        (name, plan)
    });
    compiled.collect()
}

#[test]
fn every_barrier_names_the_first_step_that_needs_it_and_not_the_step_where_it_stands() {
    let mut earlier = 0;
    for (name, plan) in on_lavapipe() {
        for (number, step) in plan.steps.iter().enumerate() {
            let images = step.image_barriers.iter().map(|it| (Resource::Image(it.image), it.needed_by));
            let buffers = step.memory_barriers.iter().flat_map(|it| &it.buffers);
            for (resource, needed_by) in images.chain(buffers.map(|it| (Resource::Buffer(it.buffer), it.needed_by))) {
                // A need after the frame names no step.
                let Some(StepId(needed_by)) = needed_by else { continue };
                let what = format!("{name}: a barrier of {resource:?} before step {number}, needed by {needed_by}");
                assert!(needed_by as usize >= number, "{what}");
                assert!(touches(&plan.steps[needed_by as usize].work, resource), "{what}\n{}", plan.tree());
                // Others of its parts may be touched in between.
                let cut = matches!(resource, Resource::Image(id) if plan.image(id).layers * plan.image(id).mips > 1);
                let between = &plan.steps[number..if cut { number } else { needed_by as usize }];
                assert!(!between.iter().any(|step| touches(&step.work, resource)), "{what}\n{}", plan.tree());
                earlier += usize::from(needed_by as usize > number);
            }
        }
    }
    assert!(earlier > 50, "{earlier} barriers stand before an earlier step than the one that needs them");
}

/// The first barrier of what takes memory over may stand before its lifetime, and not within the lifetime of another
/// that lies on the same bytes.
#[test]
fn memory_is_free_where_the_first_barrier_of_what_takes_it_stands() {
    let mut earlier = 0;
    for (name, plan) in on_lavapipe() {
        let placed = |image: &Image| match &image.role {
            Role::Transient(placement) => Some(placement.clone()),
            _ => None,
        };
        for image in &plan.images {
            let Some(own) = placed(image) else { continue };
            let mut steps = plan.steps.iter().zip(0..);
            let first = steps.find(|(step, _)| step.image_barriers.iter().any(|it| it.image == image.id));
            let Some((_, first)) = first.filter(|(_, first)| *first < own.lifetime[0].0) else { continue };
            earlier += 1;
            for other in plan.images.iter().filter(|other| other.id != image.id) {
                let Some(other) = placed(other).filter(|it| it.heap == own.heap) else { continue };
                let meet = other.offset < own.offset + own.bytes && own.offset < other.offset + other.bytes;
                let lives = other.lifetime[0].0 <= own.lifetime[0].0 && other.lifetime[1].0 >= first;
                assert!(!meet || !lives, "{name}: `{}` before step {first}\n{}", image.name, plan.tree());
            }
        }
    }
    assert!(earlier > 50, "{earlier} images have their first barrier before their lifetime");
}

#[test]
fn no_text_is_left_over_from_a_pipeline_that_is_gone() {
    let names: BTreeSet<String> = all().into_iter().map(|(_, (name, ..))| format!("{name}.snap")).collect();
    let files = std::fs::read_dir(folder()).expect("there are golden Plans");
    let there = files.map(|file| file.expect("the folder can be listed").file_name().to_string_lossy().into_owned());
    let left: Vec<String> = there.filter(|file| file.ends_with(".snap") && !names.contains(file)).collect();
    assert!(left.is_empty(), "delete from {}: {left:?}", folder().display());
}
