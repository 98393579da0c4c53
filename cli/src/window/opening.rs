//! What a window begins with: a renderer of the pipeline, with all that the command line says.

use crate::command_line::windows::WindowArguments;
use crate::error::Error;
use crate::files::inputs;
use crate::planning::{draws, precompiled};
use crate::system::Exit;
use framewright::{ReadFiles, Renderer, RendererOptions};
use framewright_vulkan::{Device, Helper};

/// A renderer of the pipeline that the command line names.
///
/// # Errors
/// Those of the pipeline, the command line and the device.
pub(super) fn renderer(arguments: &WindowArguments, device: &Device, helper: Helper) -> Result<Renderer, Error> {
    let read = ReadFiles::default();
    // Says that it is a shipped one.
    drop(inputs::pipeline(&arguments.pipeline, &read)?);
    let mut options = RendererOptions::default();
    options.files = inputs::options(&arguments.pipeline);
    options.settings.clone_from(&arguments.pipeline.settings);
    options.draws = draws(&arguments.pipeline, &read)?;
    options.helper = Some(helper);
    options.precompiled = precompiled(&arguments.pipeline);
    options.compile = arguments.planning.options();
    options.executor.poison = arguments.planning.poison;
    options.executor.frames_in_flight = 2;
    options.executor.timestamps = true;
    options.executor.readback = true;
    let mut renderer = Renderer::open(device, &arguments.pipeline.file, options)?;
    if arguments.pipeline.preset.is_some() {
        renderer.preset(arguments.pipeline.preset.as_deref()).map_err(of_command_line)?;
    }
    for one in &arguments.pipeline.set {
        renderer.set(&one.name, &one.value).map_err(of_command_line)?;
    }
    Ok(renderer)
}

/// What the list of a window is drawn with.
pub(super) fn list_options(arguments: &WindowArguments, helper: Helper) -> RendererOptions {
    let mut options = RendererOptions::default();
    options.helper = Some(helper);
    options.precompiled = precompiled(&arguments.pipeline);
    options.executor.frames_in_flight = 2;
    options
}

/// A mistake that the command line made.
fn of_command_line(error: framewright::Error) -> Error {
    match Error::from(error) {
        Error::Mistakes { mut mistakes } => {
            mistakes.exit = Exit::Usage;
            Error::Mistakes { mistakes }
        }
        other => other,
    }
}
