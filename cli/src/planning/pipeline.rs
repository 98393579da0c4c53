//! The pipeline that the command line names, and what is chosen for its frame.

use super::{device, helper};
use crate::command_line::args::PipelineArguments;
use crate::command_line::subject::SubjectArguments;
use crate::command_line::values::Size;
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::system::Exit;
use framewright::{
    Choices, DrawInterfaces, Helper, Pipeline, PlannedFrame, PrecompiledShaders, RendererOptions, ShaderCompilers,
};
use framewright_graph::base::{ReadFiles, Sources};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::shader;
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw;
use framewright_passes::scene::Scene;

/// What the command line says of a pipeline's files, but for the preset.
///
/// # Errors
/// If the interface that it names is wrong.
pub(crate) fn options(
    arguments: &PipelineArguments,
    helper: Helper,
    read: &ReadFiles,
) -> Result<RendererOptions, Error> {
    let mut options = RendererOptions::default();
    options.files = inputs::options(arguments);
    options.settings.clone_from(&arguments.settings);
    options.draws = draws(arguments, read)?;
    options.helper = Some(helper);
    options.precompiled = precompiled(arguments);
    options.shader_compilers = compilers(arguments)?;
    Ok(options)
}

/// The folder of precompiled shaders, if the command line names one. Those that are compiled are added to it.
pub(crate) fn precompiled(arguments: &PipelineArguments) -> Option<PrecompiledShaders> {
    arguments.precompiled.as_ref().map(|folder| PrecompiledShaders::in_folder(folder).adding())
}

/// The commands that compile shaders: those of the command line are stronger than those of the environment.
fn compilers(arguments: &PipelineArguments) -> Result<ShaderCompilers, Error> {
    let mut compilers =
        ShaderCompilers::of_environment().map_err(|bad| Error::ShaderCompiler { what: bad.to_string() })?;
    arguments.shader_compiler.iter().for_each(|stronger| compilers.and(stronger));
    Ok(compilers)
}

/// What draws bring along: those of the program whose interface the command line names, or of a scene.
///
/// # Errors
/// If the interface is wrong.
pub(crate) fn draws(arguments: &PipelineArguments, read: &ReadFiles) -> Result<DrawInterfaces, Error> {
    let Some(path) = arguments.interface.as_deref() else { return Ok(draw::interfaces()) };
    let text = inputs::text(FileRole::INTERFACE, path, shader::LARGEST_INTERFACE, read)?;
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let mut sources = Sources::default();
    DrawInterfaces::read(&mut sources, &path.to_string_lossy(), &name, text)
        .map_err(|mistakes| Error::mistakes(sources, mistakes, Exit::Found))
}

/// Reads a pipeline file. It and all files that it names, now or later, are recorded in `read`.
///
/// # Errors
/// If it can't be read or is wrong in itself.
pub(crate) fn load(arguments: &PipelineArguments, read: &ReadFiles) -> Result<Pipeline, Error> {
    load_with(arguments, read, helper::of(arguments)?)
}

/// Does the same with a helper that there is already.
///
/// # Errors
/// Those of [`load`].
pub(crate) fn load_with(arguments: &PipelineArguments, read: &ReadFiles, helper: Helper) -> Result<Pipeline, Error> {
    let mut pipeline = Pipeline::open(&arguments.file, &options(arguments, helper, read)?, read)?;
    if pipeline.is_shipped() {
        inputs::say_shipped("pipeline", &arguments.file);
    }
    pipeline.choose(arguments.preset.as_deref())?;
    Ok(pipeline)
}

/// What the command line chooses for a frame of this size without a scene.
pub(crate) fn choices(arguments: &PipelineArguments, size: Size, rotation: Rotation) -> Choices {
    let mut choices = Choices::default();
    choices.set = arguments.set.iter().map(|one| (one.name.clone(), one.value.clone())).collect();
    choices.stereo.clone_from(&arguments.stereo.0);
    (choices.extent, choices.rotation) = (size.into(), rotation);
    choices
}

/// What the command line chooses for a frame that isn't drawn, with a scene that was read.
pub(crate) fn undrawn(arguments: &PipelineArguments, subject: &SubjectArguments, scene: Option<&Scene>) -> Choices {
    let mut choices = choices(arguments, subject.size, subject.planning.rotate);
    choices.facts = scene.map(Scene::facts);
    choices
}

/// Reads a pipeline and the scene and profile that are named beside it, and plans it. Nothing is drawn.
///
/// # Errors
/// Those of [`load`], [`device::choose`], [`inputs::scene`] and [`Pipeline::planned`].
pub(crate) fn planned(
    arguments: &PipelineArguments,
    subject: &SubjectArguments,
    read: &ReadFiles,
) -> Result<(Pipeline, PlannedFrame), Error> {
    let profile = device::choose(subject.device.as_deref(), read)?;
    let mut pipeline = load(arguments, read)?;
    let scene = subject.scene.as_deref().map(|file| inputs::scene(file, subject.reading.strict, read)).transpose()?;
    let choices = undrawn(arguments, subject, scene.as_ref());
    let planned = pipeline.planned(&choices, &profile, &mut MemoryEstimate(&profile), &subject.planning.options())?;
    Ok((pipeline, planned))
}
