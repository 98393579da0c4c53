//! What a page carries so that it compiles its pipeline anew: the compiler as a module of WebAssembly, the pipeline's files, and the
//! interfaces that its shaders have for the choices that people try first.

use crate::error::Error;
use crate::system::progress;
use framewright::{Choices, DrawInterfaces, Pipeline};
use framewright_graph::base::SourceFile;
use framewright_graph::compile::Options;
use framewright_graph::device::{Profile, SHIPPED_PROFILES};
use framewright_graph::language::Document;
use framewright_graph::plan::Plan;
use framewright_lab::sweep::values;
use framewright_viewer::{Controls, WhatIf};
use framewright_what_if::{
    Choices as SubjectChoices, FORMAT, NamedProfile, PathUse, ShaderRecorder, ShaderTable, Subject, TextFile,
};
use std::env;
use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read};
use std::path::PathBuf;

/// The name of the module. It lies beside the command, or in a checkout beside the folder that the command was built in.
const MODULE: &str = "what-if.wasm";

/// The module has at most this many bytes.
const LARGEST: u64 = 16 << 20;

/// At most this many choices are tried for their shaders.
const MOST_TRIED: usize = 400;

/// A pipeline as it was planned for a page.
pub(crate) struct PlannedSubject<'a> {
    /// Its name for people.
    pub(crate) name: &'a str,
    /// The preset in force.
    pub(crate) preset: Option<&'a str>,
    /// What was chosen for its frame.
    pub(crate) choices: &'a Choices,
    /// What its draws bring along.
    pub(crate) draws: &'a DrawInterfaces,
    /// The device as the command line names it, and its profile.
    pub(crate) device: (Option<&'a OsStr>, &'a Profile),
    /// How the Plan was made.
    pub(crate) options: Options,
    /// The Plan.
    pub(crate) plan: &'a Plan,
}

/// The module.
///
/// # Errors
/// If there is none.
pub(crate) fn module() -> Result<Vec<u8>, Error> {
    let command = env::current_exe().map_err(Error::Helper)?;
    let places: Vec<PathBuf> = command.ancestors().skip(1).take(2).map(|folder| folder.join(MODULE)).collect();
    for place in &places {
        let mut bytes = Vec::new();
        match File::open(place).and_then(|file| file.take(LARGEST).read_to_end(&mut bytes)) {
            Ok(_) => return Ok(bytes),
            Err(source) if source.kind() == io::ErrorKind::NotFound => {}
            Err(source) => return Err(Error::Read { what: "compiler for pages", path: place.clone(), source }),
        }
    }
    Err(Error::NoModule { places })
}

/// What the page of a planned pipeline carries.
///
/// # Errors
/// If the module is none, or the profile has no text.
pub(crate) fn carried(module: &[u8], pipeline: &mut Pipeline, planned: &PlannedSubject<'_>) -> Result<WhatIf, Error> {
    let busy = progress::busy("compiling shaders for other choices");
    let mut subject = subject(pipeline, planned)?;
    let passes = removable(planned.plan);
    let mut recorder = ShaderRecorder::new(&mut pipeline.assets.shaders);
    for choices in tried(&subject, &pipeline.document, &passes) {
        // What is wrong then is told in the page.
        drop(subject.planned_with(&choices, &mut recorder));
    }
    subject.shaders = recorder.table();
    drop(busy);
    let controls = Controls::of(&pipeline.document, planned.plan);
    WhatIf::new(module, &subject, controls, passes).map_err(|_| Error::BadModule)
}

/// The subject, without the interfaces of shaders.
fn subject(pipeline: &Pipeline, planned: &PlannedSubject<'_>) -> Result<Subject, Error> {
    let PlannedSubject { name, preset, choices, draws, options, .. } = planned;
    let (device, profiles) = device(planned.device)?;
    let [files, settings] = pipeline.texts().map(|files| files.into_iter().map(text).collect::<Vec<_>>());
    let links = &pipeline.links;
    let number = |path: String| files.iter().position(|file: &TextFile| file.path == path);
    let paths = links.paths.iter();
    Ok(Subject {
        format: FORMAT,
        name: (*name).to_owned(),
        extensions: links.extensions.iter().filter_map(|file| number(file.to_string())).collect(),
        paths: paths
            .map(|(from, path, to)| PathUse { from: from.to_string(), path: path.clone(), to: to.to_string() })
            .collect(),
        pictures: links.pictures.clone(),
        draws: draws.to_ron(),
        profiles,
        facts: choices.facts,
        options: *options,
        shaders: ShaderTable::default(),
        own: SubjectChoices {
            device,
            extent: choices.extent,
            preset: preset.map(str::to_owned),
            set: choices.set.clone(),
            stereo: choices.stereo.clone(),
            rotation: choices.rotation,
            left_out: Vec::new(),
            texts: Default::default(),
        },
        settings,
        files,
    })
}

fn text(file: &SourceFile) -> TextFile {
    TextFile { shown: file.shown.clone(), path: file.relative.to_string(), text: file.text.to_string() }
}

/// The name of a device in a page, with its profile where that isn't shipped.
fn device((name, profile): (Option<&OsStr>, &Profile)) -> Result<(String, Vec<NamedProfile>), Error> {
    let mut shipped = SHIPPED_PROFILES.iter().map(|(shipped, _)| *shipped);
    let name = match name {
        None => return Ok((shipped.take(1).collect(), Vec::new())),
        Some(name) => name,
    };
    if let Some(shipped) = shipped.find(|shipped| name == OsStr::new(shipped)) {
        return Ok((shipped.to_owned(), Vec::new()));
    }
    let name = name.to_string_lossy().into_owned();
    let text = profile.to_ron().map_err(|problem| Error::Unwritable(problem.to_string()))?;
    Ok((name.clone(), vec![NamedProfile { name, text }]))
}

/// The names of passes and of uses of fragments that a Plan's passes come from: `glow` of `glow.bloom.mix`.
fn removable(plan: &Plan) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for pass in plan.steps.iter().flat_map(|step| step.work.passes()) {
        let declared = pass.name.split(['.', '[', ' ']).next().unwrap_or_default();
        if !names.iter().any(|known| known == declared) {
            names.push(declared.to_owned());
        }
    }
    names
}

/// The choices whose shaders a page carries: its own and each preset on every device; on its own device each value of each setting, and
/// each pass left out.
fn tried(subject: &Subject, document: &Document, passes: &[String]) -> Vec<SubjectChoices> {
    let own = &subject.own;
    let presets = document.presets.iter().map(|preset| Some(preset.name.text.to_string()));
    let presets = [own.preset.clone()].into_iter().chain(presets);
    let devices = || subject.devices().into_iter().map(str::to_owned);
    let on_devices = presets.flat_map(|preset| {
        devices().map(move |device| SubjectChoices { device, preset: preset.clone(), ..own.clone() })
    });
    let settings = document.settings.iter().flat_map(|setting| {
        values(&setting.kind).into_iter().map(move |value| {
            let set = own.set.iter().cloned().chain([(setting.name.text.to_string(), value)]).collect();
            SubjectChoices { set, ..own.clone() }
        })
    });
    let left_out = passes.iter().map(|pass| SubjectChoices { left_out: vec![pass.clone()], ..own.clone() });
    on_devices.chain(settings).chain(left_out).take(MOST_TRIED).collect()
}
