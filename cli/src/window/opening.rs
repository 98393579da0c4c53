//! What a window begins with: a renderer of the pipeline, with all that the command line says.

use crate::command_line::windows::WindowArguments;
use crate::error::Error;
use crate::files::inputs;
use crate::planning;
use framewright::{ReadFiles, Renderer, RendererOptions};
use framewright_vulkan::{Device, Helper};

/// A renderer of the pipeline that the command line names.
///
/// # Errors
/// Those of the pipeline, the command line and the device.
pub(super) fn renderer(arguments: &WindowArguments, device: &Device, helper: Helper) -> Result<Renderer, Error> {
    let mut options = planning::options(&arguments.pipeline, helper, &ReadFiles::default())?;
    options.compile = arguments.planning.options();
    options.executor.poison = arguments.planning.poison;
    options.executor.frames_in_flight = 2;
    options.executor.timestamps = true;
    options.executor.readback = true;
    let mut renderer = Renderer::open(device, &arguments.pipeline.file, options)?;
    if renderer.is_shipped() {
        inputs::say_shipped("pipeline", &arguments.pipeline.file);
    }
    if arguments.pipeline.preset.is_some() {
        renderer.preset(arguments.pipeline.preset.as_deref())?;
    }
    for one in &arguments.pipeline.set {
        renderer.set(&one.name, &one.value)?;
    }
    Ok(renderer)
}

/// What the list of a window is drawn with.
pub(super) fn list_options(arguments: &WindowArguments, helper: Helper) -> RendererOptions {
    let mut options = RendererOptions::default();
    options.helper = Some(helper);
    options.precompiled = planning::precompiled(&arguments.pipeline);
    options.executor.frames_in_flight = 2;
    options
}
