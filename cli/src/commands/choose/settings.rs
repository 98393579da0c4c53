//! The settings file that is written, read back as `run` reads it.

use super::settings_file;
use crate::command_line::args::{CachingArguments, PipelineArguments, ShaderLimits};
use crate::command_line::values::Modes;
use crate::error::Error;
use crate::planning;
use crate::system::{Exit, text};
use framewright_graph::base::{ReadFiles, Sources};
use framewright_graph::frame::Stereo;
use framewright_graph::language::Document;
use framewright_graph::ron::Tree;
use framewright_lab::results::Results;
use std::collections::BTreeMap;

/// The text of a settings file.
///
/// # Errors
/// If it can't be read as RON: a value of the results is none that a setting can have.
pub(super) fn file(results: &Results, settings: &BTreeMap<String, String>, read: &ReadFiles) -> Result<String, Error> {
    let pipeline = &results.subject.pipeline;
    let about = format!("Chosen by `framewright choose` for {pipeline} on {}.", results.subject.device);
    let document = document(pipeline, read);
    let contents = settings_file::text(settings, document.as_ref(), &about);
    let mut sources = Sources::default();
    let Some(document) = document else {
        text::say(&format!(
            "note: the settings were not checked with the pipeline: `{}` can't be read here",
            text::escape(pipeline)
        ));
        let mut mistakes = Vec::new();
        let file = sources.add("settings.ron", "settings.ron", contents.clone());
        let _ = Tree::read(file, contents.clone().into(), &mut mistakes);
        return if mistakes.is_empty() { Ok(contents) } else { Err(Error::mistakes(sources, mistakes, Exit::Found)) };
    };
    if let Err(mistakes) = document.read_settings(&mut sources, "settings.ron", "settings.ron", contents.clone()) {
        let first = mistakes.first().map_or_else(String::new, |mistake| mistake.message.clone());
        text::say(&format!(
            "note: `{}` as it is here refuses these settings: {}; if they need an extension, `run --extend` applies it",
            text::escape(pipeline),
            text::escape(&first)
        ));
    }
    Ok(contents)
}

/// The pipeline that was measured, if it is here.
fn document(pipeline: &str, read: &ReadFiles) -> Option<Document> {
    let arguments = PipelineArguments {
        file: pipeline.into(),
        preset: None,
        settings: Vec::new(),
        set: Vec::new(),
        extend: Vec::new(),
        root: None,
        allow_outside: false,
        interface: None,
        precompiled: None,
        shader_compiler: Vec::new(),
        stereo: Modes(vec![Stereo::Off]),
        caching: CachingArguments { no_cache: true },
        limits: ShaderLimits { shader_seconds: 10, shader_memory: 1024, shader_stack: 8 },
    };
    planning::load(&arguments, read).ok().map(|loaded| loaded.document)
}
