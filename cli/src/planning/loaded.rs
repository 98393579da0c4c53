//! A pipeline that was read: it is expanded to a frame, and compiled to a verified Plan.

use crate::command_line::args;
use crate::command_line::subject::SubjectArguments;
use crate::command_line::values::{DEFAULT_SIZE, Modes, Size};
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::planning::{Assets, device, helper};
use crate::system::Exit;
use framewright::Pipeline;
use framewright_graph::base::{Diagnostic, ReadFiles, Sources};
use framewright_graph::compile::{self, Options, heap_size, shaders};
use framewright_graph::device::{Estimated, MemoryProvider, Profile};
use framewright_graph::expand::{self, Inputs};
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::language::{self, Document, Facts};
use framewright_graph::plan::Plan;
use framewright_graph::verify;
use framewright_graph::vulkan::Rotation;
use framewright_passes::scene::Scene;
use framewright_vulkan::Helper;
use std::collections::BTreeSet;
use std::sync::Arc;

/// A pipeline that was read, and where its shaders come from.
pub(crate) struct Loaded {
    pub(crate) pipeline: Document,
    /// The texts that it was read from.
    pub(crate) sources: Arc<Sources>,
    /// Shaders and pictures beside the pipeline file, and shipped shaders.
    pub(crate) assets: Assets,
    /// The paths of those that the pipeline names.
    pub(crate) pictures: BTreeSet<Arc<str>>,
    /// Settings that the user chose, and their values, of which the last counts.
    pub(crate) set: Vec<(String, String)>,
    /// How it is drawn for two eyes.
    pub(crate) stereo: Modes,
}

/// A frame and its Plan.
#[derive(Debug)]
pub(crate) struct Planned {
    pub(crate) frame: Frame,
    /// Its Plan, verified.
    pub(crate) plan: Plan,
}

impl Planned {
    /// The Plan, with the frame that it was made of.
    pub(crate) fn parts(&self) -> (&Plan, Option<&Frame>) {
        (&self.plan, Some(&self.frame))
    }
}

/// The inputs of a frame besides its pipeline and settings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View<'a> {
    /// Facts of the scene; `None`: it may hold everything.
    pub(crate) facts: Option<Facts>,
    /// Size of the output.
    pub(crate) size: Size,
    /// The rotation of the screen.
    pub(crate) rotation: Rotation,
    /// Names of images that are dumped.
    pub(crate) dump: &'a [String],
}

/// Reads a pipeline file. It and all files that it names, now or later, are recorded in `read`.
///
/// # Errors
/// If it can't be read or is wrong in itself.
pub(crate) fn load(arguments: &args::PipelineArguments, read: &ReadFiles) -> Result<Loaded, Error> {
    load_with(arguments, read, helper::with(&arguments.limits, arguments.caching)?)
}

/// Does the same with a helper that there is already.
///
/// # Errors
/// Those of [`load`].
pub(crate) fn load_with(
    arguments: &args::PipelineArguments,
    read: &ReadFiles,
    helper: Helper,
) -> Result<Loaded, Error> {
    let file = inputs::pipeline(arguments, read)?;
    let Assets { shaders, helper, .. } = Assets::of(file.root(), arguments, helper, read)?;
    let Pipeline { mut document, sources, textures, pictures, .. } = file.read()?;
    let mut sources = Arc::unwrap_or_clone(sources);
    choose(arguments, &mut document, &mut sources, read)?;
    Ok(Loaded {
        pipeline: document,
        sources: Arc::new(sources),
        assets: Assets { shaders, helper, textures },
        pictures,
        set: arguments.set.iter().map(|one| (one.name.clone(), one.value.clone())).collect(),
        stereo: arguments.stereo.clone(),
    })
}

/// Reads a pipeline and the scene and profile that are named beside it, and plans it. Nothing is drawn.
///
/// # Errors
/// Those of [`load`], [`device::choose`], [`inputs::scene`] and [`Loaded::plan`].
pub(crate) fn planned(
    pipeline: &args::PipelineArguments,
    subject: &SubjectArguments,
    read: &ReadFiles,
) -> Result<(Loaded, Planned), Error> {
    let profile = device::choose(subject.device.as_deref(), read)?;
    let mut loaded = load(pipeline, read)?;
    let scene = subject.scene.as_deref().map(|file| inputs::scene(file, subject.reading.strict, read)).transpose()?;
    let view = View::of(subject, scene.as_ref());
    let planned = loaded.plan(view, &profile, &mut Estimated(&profile), &subject.planning.options())?;
    Ok((loaded, planned))
}

/// Applies settings files and a preset.
fn choose(
    arguments: &args::PipelineArguments,
    pipeline: &mut Document,
    sources: &mut Sources,
    read: &ReadFiles,
) -> Result<(), Error> {
    let mut files = Vec::with_capacity(arguments.settings.len());
    let mut mistakes = Vec::new();
    for path in &arguments.settings {
        let text = inputs::text(FileRole::SETTINGS, path, language::LARGEST_FILE, read)?;
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        match pipeline.read_settings(sources, &path.to_string_lossy(), &name, text) {
            Ok(file) => files.push(file),
            Err(diagnostics) => mistakes.extend(diagnostics),
        }
    }
    if !mistakes.is_empty() {
        return Err(wrong(sources, mistakes));
    }
    pipeline
        .choose(arguments.preset.as_deref(), &files)
        .map_err(|unknown| Error::mistakes(sources.clone(), vec![unknown], Exit::Usage))
}

impl View<'_> {
    /// One at the default size, without a scene.
    pub(crate) fn without_scene(rotation: Rotation) -> View<'static> {
        View::at(DEFAULT_SIZE, rotation)
    }

    /// The one that the command line asks for, with a scene that was read.
    pub(crate) fn of(subject: &SubjectArguments, scene: Option<&Scene>) -> View<'static> {
        View { facts: scene.map(Scene::facts), ..View::at(subject.size, subject.planning.rotate) }
    }

    /// One without a scene.
    pub(crate) fn at(size: Size, rotation: Rotation) -> View<'static> {
        View { facts: None, size, rotation, dump: &[] }
    }
}

impl Loaded {
    /// Puts in settings, facts and sizes, compiles for a device, and has the result verified.
    ///
    /// # Errors
    /// The mistakes of the command line, the pipeline or its shaders; or the violations that `verify` found.
    pub(crate) fn plan(
        &mut self,
        view: View<'_>,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Planned, Error> {
        let frame = self.frame(view, device)?;
        let plan = self.compile(&frame, device, memory, options)?;
        Ok(Planned { frame, plan })
    }

    /// Expands the pipeline to a frame: puts in settings, facts, sizes and the device's features.
    ///
    /// # Errors
    /// The mistakes of the command line, the pipeline or its shaders.
    pub(crate) fn frame(&mut self, view: View<'_>, device: &Profile) -> Result<Frame, Error> {
        self.check_command_line(view)?;
        let stereo = Stereo::first_fit(&self.stereo.0, device).map_err(|why| Error::Stereo { why })?;
        let inputs = inputs(&self.set, stereo, view, Some(device));
        expand::expand(&self.pipeline, Arc::clone(&self.sources), &inputs, &mut self.assets.shaders)
            .map_err(|diagnostics| wrong(&self.sources, diagnostics))
    }

    /// Checks settings and sizes by themselves.
    ///
    /// # Errors
    /// The mistakes of the command line.
    pub(crate) fn check_command_line(&self, view: View<'_>) -> Result<(), Error> {
        let diagnostics = expand::check_inputs(&self.pipeline, &inputs(&self.set, self.stereo.0[0], view, None));
        if diagnostics.is_empty() {
            return Ok(());
        }
        Err(Error::mistakes(Sources::clone(&self.sources), diagnostics, Exit::Usage))
    }

    /// Makes sure that the device that a profile describes has the memory that a Plan takes.
    ///
    /// # Errors
    /// The memory that it takes, and the images that take most.
    pub(crate) fn fits(&self, plan: &Plan, frame: &Frame, device: &Profile) -> Result<(), Error> {
        heap_size::too_large(plan, frame, device).map_or(Ok(()), |large| Err(wrong(&self.sources, vec![large])))
    }

    /// Compiles a frame for a device, has the result verified, and the shaders compiled as its passes are drawn.
    ///
    /// # Errors
    /// The mistakes of the frame or its shaders, features that the device lacks, or the violations that `verify` found.
    pub(crate) fn compile(
        &mut self,
        frame: &Frame,
        device: &Profile,
        memory: &mut dyn MemoryProvider,
        options: &Options,
    ) -> Result<Plan, Error> {
        let plan = compile::compile(frame, device, memory, options)
            .map_err(|diagnostics| wrong(&self.sources, diagnostics))?;
        let violations: Vec<_> =
            verify::verify(&plan).iter().map(|one| crate::system::text::escape(&one.to_string())).collect();
        if !violations.is_empty() {
            return Err(Error::Violations { violations });
        }
        let diagnostics = shaders::wrong(&plan, frame, &mut self.assets.shaders);
        if diagnostics.is_empty() { Ok(plan) } else { Err(wrong(&self.sources, diagnostics)) }
    }
}

/// The inputs of a frame that is drawn so, with these settings.
pub(crate) fn inputs<'a>(
    set: &'a [(String, String)],
    stereo: Stereo,
    view: View<'a>,
    device: Option<&'a Profile>,
) -> Inputs<'a> {
    Inputs {
        set,
        facts: view.facts.unwrap_or(Facts::UNKNOWN),
        facts_known: view.facts.is_some(),
        output_extent: [view.size.width, view.size.height],
        rotation: view.rotation,
        window: None,
        dump: view.dump,
        device,
        stereo,
    }
}

fn wrong(sources: &Sources, diagnostics: Vec<Diagnostic>) -> Error {
    Error::mistakes(sources.clone(), diagnostics, Exit::Found)
}
