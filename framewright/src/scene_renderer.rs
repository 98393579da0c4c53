//! A scene that is drawn by one Plan.

use crate::assets::Assets;
use crate::error::Error;
use framewright_graph::base::{Code, Diagnostic, Sources, Span};
use framewright_graph::frame::{Draw, Frame};
use framewright_graph::plan::{Pass, Plan};
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, Executor, ExecutorOptions, FrameReport};

/// A scene that is drawn by one Plan, frame after frame. Nothing is planned anew: [`Renderer`](crate::Renderer) does that.
#[non_exhaustive]
pub struct SceneRenderer<'p> {
    /// The Plan.
    pub plan: &'p Plan,
    /// Its executor.
    pub executor: Executor,
    /// The scene on the device.
    pub source: SceneDrawSource,
}

impl<'p> SceneRenderer<'p> {
    /// Uploads the scene, and makes pipelines and memory. `frame` is the one that the Plan was made of, if there is one: it knows the
    /// places of mistakes.
    ///
    /// # Errors
    /// [`Error::CustomPass`]; mistakes of textures and shaders, or of the device.
    pub fn new(
        device: &Device,
        (plan, frame): (&'p Plan, Option<&Frame>),
        assets: &mut Assets,
        scene: &Scene,
        options: &ExecutorOptions,
    ) -> Result<SceneRenderer<'p>, Error> {
        if let Some(pass) = custom(plan) {
            return Err(Error::CustomPass { pass: pass.name.to_string(), name: pass.shader.to_string() });
        }
        let source = SceneDrawSource::for_plan(device, scene, plan.extent, plan)?;
        let executor = assets.executor(device, plan, options).map_err(|error| of_texture(frame, error))?;
        Ok(SceneRenderer { plan, executor, source })
    }

    /// Draws a frame and waits for it.
    ///
    /// # Errors
    /// Those of [`Executor::frame`].
    pub fn draw(&mut self) -> Result<FrameReport, Error> {
        let frame = self.executor.frame(&mut self.source)?;
        Ok(self.executor.report(frame)?)
    }
}

/// Makes sure that a scene has the cameras that the views of a Plan name. `frame` is the one that the Plan was made of, if there is one:
/// it knows the places of mistakes.
///
/// # Errors
/// [`Error::Mistakes`] with the views whose cameras it doesn't have.
pub fn check_cameras(plan: &Plan, frame: Option<&Frame>, scene: &Scene) -> Result<(), Error> {
    let known: Vec<String> = scene.cameras.iter().map(|it| format!("`{}`", it.name)).collect();
    let known = if known.is_empty() { "none by a name".to_owned() } else { known.join(", ") };
    let missing = plan.views.iter().enumerate().filter(|(_, it)| scene.camera_named(it.camera.as_deref()).is_none());
    let diagnostics: Vec<Diagnostic> = missing
        .map(|(at, view)| {
            let wanted = view.camera.as_deref().unwrap_or_default();
            let message = format!("view `{}` asks for the camera `{wanted}`; the scene has {known}", view.name);
            let span = frame.and_then(|frame| frame.views.get(at)).map_or(Span::NONE, |view| view.span);
            Diagnostic::new(Code::UNKNOWN_CAMERA, span, message)
                .help("name a camera of the scene, or leave `camera` out: the scene's own")
        })
        .collect();
    if diagnostics.is_empty() { Ok(()) } else { Err(wrong(frame, diagnostics)) }
}

/// The first pass that only the program of another draw source can record.
fn custom(plan: &Plan) -> Option<&Pass> {
    plan.steps.iter().find_map(|step| {
        let custom = step.work.is_custom();
        step.work.passes().iter().find(|pass| custom || pass.draw.is_some_and(Draw::is_custom))
    })
}

/// Turns the problem of a damaged texture file into a mistake of the pipeline, with its place. Other errors stay.
fn of_texture(frame: Option<&Frame>, error: Error) -> Error {
    if let Error::Vulkan(framewright_vulkan::Error::Texture { image, path, problem }) = &error
        && let Some(declared) = frame.and_then(|frame| frame.images.iter().find(|it| *it.name == **image))
    {
        return wrong(frame, vec![Diagnostic::new(Code::TEXTURE_FILE, declared.span, format!("`{path}` {problem}"))]);
    }
    error
}

fn wrong(frame: Option<&Frame>, diagnostics: Vec<Diagnostic>) -> Error {
    match frame {
        Some(frame) => Error::mistakes(&frame.sources, diagnostics),
        None => Error::mistakes(&Sources::default(), diagnostics),
    }
}
