//! The Plans of every shipped pipeline as text, on the shipped lavapipe profile: with its default settings, with each
//! alternative of each setting, and over a scene of opaque objects alone. The texts under `golden_plans/` are there to be
//! reviewed: a change of the compiler shows as a change of theirs.

#[path = "language/table.rs"]
#[allow(dead_code, reason = "tests of the language use more of it")]
mod table;

use framewright_graph::compile::{Options, compile};
use framewright_graph::describe::{self, Document, PipelineFiles, SettingKind};
use framewright_graph::device::{Estimated, Profile, SHIPPED_PROFILES};
use framewright_graph::expand::{Facts, Inputs, expand};
use framewright_graph::frame::Frame;
use framewright_graph::root::Root;
use framewright_graph::source::Sources;
use framewright_graph::verify::verify;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use table::{INPUTS, Table, shipped};

/// How a changed Plan is accepted.
const ACCEPT: &str = "INSTA_UPDATE=always cargo test -p framewright-graph --test golden_plans";

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
    let mut variants =
        vec![(name.to_owned(), Vec::new(), Facts::UNKNOWN), (format!("{name}@opaque_scene"), Vec::new(), opaque)];
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
    let pipeline = describe::read_with(&mut sources, &mut files, file, file, shipped(file));
    (pipeline.expect("a shipped pipeline is right"), sources)
}

fn expanded(file: &str, inputs: &Inputs<'_>) -> Frame {
    let (pipeline, sources) = document(file);
    let sources = Arc::new(sources);
    expand(&pipeline, sources.clone(), inputs, &mut Table)
        .unwrap_or_else(|errors| panic!("{}", describe::render(&sources, &errors)))
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
    let (_, lavapipe) = SHIPPED_PROFILES.iter().find(|(name, _)| *name == "lavapipe").expect("it is shipped");
    let profile = Profile::from_ron(lavapipe).expect("shipped profiles are read");
    for (file, (name, set, facts)) in all() {
        let inputs = Inputs { set: &set, facts, facts_known: true, ..INPUTS };
        let frame = expanded(&file, &inputs);
        let plan = compile(&frame, &profile, &mut Estimated(&profile), &Options::default())
            .unwrap_or_else(|wrong| panic!("{name}: {wrong:?}"));
        assert_eq!(verify(&plan), [], "{name}");
        insta::with_settings!({
            snapshot_path => folder(), prepend_module_to_snapshot => false, omit_expression => true,
            description => format!("accept with {ACCEPT}"),
        }, { insta::assert_snapshot!(name, plan.tree()) });
    }
}

#[test]
fn no_text_is_left_over_from_a_pipeline_that_is_gone() {
    let names: BTreeSet<String> = all().into_iter().map(|(_, (name, ..))| format!("{name}.snap")).collect();
    let files = std::fs::read_dir(folder()).expect("there are golden Plans");
    let there = files.map(|file| file.expect("the folder can be listed").file_name().to_string_lossy().into_owned());
    let left: Vec<String> = there.filter(|file| file.ends_with(".snap") && !names.contains(file)).collect();
    assert!(left.is_empty(), "delete from {}: {left:?}", folder().display());
}
