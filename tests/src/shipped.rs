//! The shipped pipelines as frames, in every combination of their discrete settings, as long as those are few.

use crate::render::in_repository;
use framewright_graph::base::{self, Root, Sources};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::language::{self, Document, Facts, PipelineFiles, SettingKind};
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::interfaces;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::ShaderLibrary;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

/// A frame and how it came about.
pub struct ShippedFrame {
    /// Pipeline, settings and facts, in words.
    pub how: String,
    /// The frame.
    pub frame: Frame,
}

/// Every value that a setting of few values may have; the ends of one of many.
fn values(kind: &SettingKind) -> Vec<String> {
    match kind {
        SettingKind::Bool { .. } => vec!["false".to_owned(), "true".to_owned()],
        SettingKind::OneOf { of, .. } => of.iter().map(ToString::to_string).collect(),
        SettingKind::Choice { of, .. } => of.iter().map(ToString::to_string).collect(),
        SettingKind::Number { min, max, .. } => vec![min.to_string(), max.to_string()],
        SettingKind::Integer { min, max, .. } => vec![min.to_string(), max.to_string()],
    }
}

/// Of a pipeline whose settings have more combinations those are taken that leave all settings but one at their defaults.
const MOST_COMBINATIONS: usize = 40;

/// Values of the settings of a pipeline, as `--set` takes them.
#[must_use]
pub fn combinations(pipeline: &Document) -> Vec<Vec<(String, String)>> {
    let each = |setting: &language::Setting| {
        let name = setting.name.text.to_string();
        values(&setting.kind).into_iter().map(move |value| vec![(name.clone(), value)])
    };
    if pipeline.settings.iter().map(|setting| values(&setting.kind).len()).product::<usize>() > MOST_COMBINATIONS {
        return std::iter::once(Vec::new()).chain(pipeline.settings.iter().flat_map(each)).collect();
    }
    pipeline.settings.iter().fold(vec![Vec::new()], |combinations, setting| {
        let with = |chosen: &Vec<(String, String)>, value: String| {
            [&chosen[..], &[(setting.name.text.to_string(), value)]].concat()
        };
        let all = combinations.iter();
        all.flat_map(|chosen| values(&setting.kind).into_iter().map(move |value| with(chosen, value))).collect()
    })
}

/// All frames of all shipped pipelines, with everything in the scene and with nothing but opaque objects. They are made once
/// for each extent.
///
/// # Panics
/// If a shipped pipeline isn't right.
#[must_use]
pub fn frames(output_extent: [u32; 2]) -> &'static [ShippedFrame] {
    static MADE: Mutex<BTreeMap<[u32; 2], &'static [ShippedFrame]>> = Mutex::new(BTreeMap::new());
    let mut made = MADE.lock().expect("the shipped pipelines are right");
    made.entry(output_extent).or_insert_with(|| make(output_extent).leak())
}

/// The shaders of shipped pipelines.
#[must_use]
pub fn shaders() -> ShaderLibrary {
    ShaderLibrary::new(Vec::new(), SHADERS, interfaces())
}

/// All shipped pipelines by name, with their sources.
///
/// # Panics
/// If one isn't right.
#[must_use]
pub fn documents() -> Vec<(String, Document, Arc<Sources>)> {
    let folder = std::fs::read_dir(in_repository("examples/pipelines")).expect("pipelines are shipped");
    let mut files: Vec<_> = folder.map(|file| file.expect("the folder can be listed").path()).collect();
    files.sort();
    let read = |file: &PathBuf| {
        let name = file.file_name().expect("a file has a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(file).expect("a shipped pipeline is text");
        let mut sources = Sources::default();
        let mut named = PipelineFiles::beside(Root::new(in_repository("examples/pipelines")), &name, &[]);
        let pipeline = language::read_with(&mut sources, &mut named, &name, &name, text);
        (name, pipeline.expect("a shipped pipeline is right"), Arc::new(sources))
    };
    files.iter().filter(|file| file.extension().is_some_and(|end| end == "ron")).map(read).collect()
}

fn make(output_extent: [u32; 2]) -> Vec<ShippedFrame> {
    let mut shaders = shaders();
    let mut frames = Vec::new();
    for (name, pipeline, sources) in documents() {
        let opaque = Facts { has_alpha_clip: false, has_cross_fade: false, has_transparent: false, ..Facts::UNKNOWN };
        for (set, facts) in combinations(&pipeline).iter().flat_map(|set| [(set, Facts::UNKNOWN), (set, opaque)]) {
            let inputs = Inputs {
                set,
                facts,
                facts_known: true,
                output_extent,
                dump: &[],
                device: None,
                rotation: Rotation::Identity,
                stereo: Stereo::Off,
                window: None,
            };
            let frame = expand(&pipeline, sources.clone(), &inputs, &mut shaders)
                .unwrap_or_else(|wrong| panic!("{}", base::render(&sources, &wrong)));
            frames.push(ShippedFrame { how: format!("{name} {set:?} {facts:?}"), frame });
        }
    }
    frames
}
