//! Mistakes that only a run can find, with their places in the pipeline's files.

use crate::error::Error;
use crate::system::Exit;
use framewright_graph::base::{Diagnostic, Sources, Span};
use framewright_graph::frame::Frame;
use framewright_graph::plan::Plan;
use framewright_passes::scene::Scene;

/// Makes sure that the scene has the cameras that views name. `frame` is the one that the Plan was made of, if there is one:
/// it knows the places.
///
/// # Errors
/// The views whose cameras it doesn't have.
pub(crate) fn cameras(plan: &Plan, frame: Option<&Frame>, scene: &Scene) -> Result<(), Error> {
    let known: Vec<String> = scene.cameras.iter().map(|it| format!("`{}`", it.name)).collect();
    let known = if known.is_empty() { "none by a name".to_owned() } else { known.join(", ") };
    let missing = plan.views.iter().enumerate().filter(|(_, it)| scene.camera_named(it.camera.as_deref()).is_none());
    let diagnostics: Vec<Diagnostic> = missing
        .map(|(at, view)| {
            let wanted = view.camera.as_deref().unwrap_or_default();
            let message = format!("view `{}` asks for the camera `{wanted}`; the scene has {known}", view.name);
            let span = frame.and_then(|frame| frame.views.get(at)).map_or(Span::NONE, |view| view.span);
            Diagnostic::new(span, message).help("name a camera of the scene, or leave `camera` out: the scene's own")
        })
        .collect();
    if diagnostics.is_empty() { Ok(()) } else { Err(wrong(frame, diagnostics)) }
}

/// Turns the problem of a damaged texture file into a mistake of the pipeline, with its place. Other problems stay.
pub(super) fn texture(frame: Option<&Frame>, problem: framewright_vulkan::Error) -> Error {
    if let framewright_vulkan::Error::Texture { image, path, problem } = &problem
        && let Some(declared) = frame.and_then(|frame| frame.images.iter().find(|it| *it.name == **image))
    {
        return wrong(frame, vec![Diagnostic::new(declared.span, format!("`{path}` {problem}"))]);
    }
    Error::Vulkan(problem)
}

fn wrong(frame: Option<&Frame>, diagnostics: Vec<Diagnostic>) -> Error {
    let sources = frame.map_or_else(Sources::default, |frame| Sources::clone(&frame.sources));
    Error::mistakes(sources, diagnostics, Exit::Found)
}
