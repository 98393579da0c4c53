//! A pipeline's files as they were read, with the shaders that they name.

use super::choices::Choices;
use crate::error::Error;
use crate::files::PipelineFile;
use crate::options::RendererOptions;
use crate::pipeline::{Pipeline, shaders};
use framewright_graph::base::{Diagnostic, ReadFiles};
use framewright_graph::compile::{Compiler, heap_size};
use framewright_graph::device::Profile;
use framewright_graph::expand::{self, Inputs};
use framewright_graph::frame::Frame;
use framewright_graph::language::{Document, SettingsFile};
use framewright_graph::plan::Plan;
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderLibrary};
use std::path::PathBuf;
use std::sync::Arc;

/// Where a pipeline comes from.
#[derive(Debug, Clone)]
pub(super) enum Origin {
    /// A file, or a shipped pipeline.
    File(PathBuf),
    /// The program itself.
    Text {
        /// What messages call it.
        name: String,
        /// The pipeline.
        text: String,
    },
}

/// What was read.
pub(super) struct Reading {
    pub(super) pipeline: Pipeline,
    settings: Vec<SettingsFile>,
    shaders: ShaderLibrary,
}

impl Reading {
    /// Reads the pipeline of `origin`. All files that are read, now or later, are recorded in `read`.
    pub(super) fn begin(origin: &Origin, options: &RendererOptions, read: &ReadFiles) -> Result<Reading, Error> {
        let file = match origin {
            Origin::File(path) => PipelineFile::find(path, &options.files, read)?,
            Origin::Text { name, text } => PipelineFile::carried(name, text),
        };
        let shaders = shaders(file.root(), &options.shaders, options.draws.clone(), options.helper.as_ref(), read);
        let shaders = shaders.with_precompiled(options.precompiled.clone());
        let mut pipeline = file.read()?;
        let settings = pipeline.read_settings(&options.settings, read)?;
        let mut reading = Reading { pipeline, settings, shaders };
        reading.choose(None)?;
        Ok(reading)
    }

    pub(super) fn document(&self) -> &Document {
        &self.pipeline.document
    }

    /// Puts a preset in force; `None`: that of the settings files.
    pub(super) fn choose(&mut self, preset: Option<&str>) -> Result<(), Error> {
        let chosen = self.pipeline.document.choose(preset, &self.settings);
        chosen.map_err(|unknown| self.wrong(vec![unknown]))
    }

    pub(super) fn wrong(&self, diagnostics: Vec<Diagnostic>) -> Error {
        Error::mistakes(&self.pipeline.sources, diagnostics)
    }

    /// The Plan of a frame of these choices, made by `compiler`.
    pub(super) fn plan<'c>(
        &mut self,
        compiler: &'c mut Compiler,
        device: &Device,
        profile: &Arc<Profile>,
        choices: &Choices,
        options: &RendererOptions,
    ) -> Result<&'c Plan, Error> {
        let set = choices.known(self.document());
        let frame = Arc::new(self.expand(&choices.inputs(&set, &options.dump, Some(profile)))?);
        let plan = compiler.compile(&frame, profile, &mut device.memory(), &options.compile);
        let plan = plan.map_err(|diagnostics| self.wrong(diagnostics))?;
        match heap_size::too_large(plan, &frame, profile) {
            Some(too_large) => Err(self.wrong(vec![too_large])),
            None => Ok(plan),
        }
    }

    /// The frame of these inputs.
    fn expand(&mut self, inputs: &Inputs<'_>) -> Result<Frame, Error> {
        let Pipeline { document, sources, .. } = &self.pipeline;
        let frame = expand::expand(document, Arc::clone(sources), inputs, &mut self.shaders);
        frame.map_err(|diagnostics| self.wrong(diagnostics))
    }

    /// Makes the pipelines of `plan`.
    pub(super) fn make_pipelines(&mut self, device: &Device, plan: &Plan) -> Result<(), Error> {
        Ok(device.make_pipelines(plan, &mut self.shaders)?)
    }

    /// An executor of `plan`.
    pub(super) fn executor(
        &mut self,
        device: &Device,
        plan: &Plan,
        options: &ExecutorOptions,
    ) -> Result<Executor, Error> {
        let Reading { pipeline, shaders, .. } = self;
        Ok(Executor::with_textures(device, plan, shaders, &mut pipeline.textures, options)?)
    }
}
