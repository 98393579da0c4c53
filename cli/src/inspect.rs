//! `framewright inspect`: the Plan of a pipeline, without a GPU.

use crate::args::{Inspect, PlanFormat};
use crate::error::{Error, Exit};
use crate::planning::{self, View};
use crate::{files, output, profiles, text};
use framewright_graph::device::Estimated;
use framewright_graph::frame::DrawList;
use framewright_passes::scene::Scene;
use std::path::Path;

/// Prints or writes a Plan.
///
/// # Errors
/// If the pipeline, the scene or the profile is wrong, or the result can't be written.
pub(crate) fn inspect(arguments: &Inspect) -> Result<Exit, Error> {
    let settings = arguments.pipeline.settings.iter().map(|file| Some(("settings file", file.as_path())));
    let read = [
        Some(("pipeline", arguments.pipeline.file.as_path())),
        arguments.scene.as_deref().map(|file| ("scene", file)),
        arguments.device.as_ref().map(|file| ("device profile", Path::new(file))),
    ];
    output::prepare(arguments.output.iter(), &read.into_iter().chain(settings).flatten().collect::<Vec<_>>())?;
    let profile = profiles::choose(arguments.device.as_deref())?;
    let mut pipeline = planning::load(&arguments.pipeline)?;
    pipeline.spare(arguments.output.iter())?;
    let scene = arguments.scene.as_deref().map(files::scene).transpose()?;
    let facts = scene.as_ref().map(Scene::facts);
    let view = View { facts, size: arguments.size, rotation: arguments.planning.rotate, dump: &[] };
    let plan = pipeline.plan(view, &profile, &mut Estimated(&profile), &arguments.planning.options())?.plan;
    // Now its shaders are known.
    pipeline.spare(arguments.output.iter())?;
    let shown = match arguments.format {
        PlanFormat::Tree => {
            let tree = scene.as_ref().map_or_else(|| plan.tree(), |scene| plan.tree_of(&|list| objects(scene, list)));
            text::escape_lines(&tree) + "\n"
        }
        PlanFormat::Json => text::json_text(&plan.to_json()?),
    };
    match &arguments.output {
        Some(file) => output::write(file, shown.as_bytes())?,
        None => text::print(&shown).map_err(Error::Print)?,
    }
    Ok(Exit::Fine)
}

/// How many objects of a scene are in a draw list.
fn objects(scene: &Scene, list: DrawList) -> usize {
    scene.objects.iter().filter(|object| scene.draw_list(object) == list).count()
}
