//! `framewright inspect`: the Plan of a pipeline, without a GPU.

use crate::command_line::args::{InspectArguments, PlanFormat};
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::files::outputs;
use crate::planning::{self, View, device};
use crate::system::{Exit, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::device::Estimated;
use framewright_graph::frame::DrawList;
use framewright_passes::scene::Scene;
use std::path::Path;

/// Prints or writes a Plan.
///
/// # Errors
/// If the pipeline, the scene or the profile is wrong, or the result can't be written.
pub(crate) fn inspect(arguments: &InspectArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    inputs::expect(&arguments.pipeline, &read);
    arguments.scene.iter().for_each(|file| read.expect(FileRole::SCENE.recorded, file));
    arguments.device.iter().for_each(|file| read.expect(FileRole::PROFILE.recorded, Path::new(file)));
    let spare = || outputs::prepare(arguments.output.as_deref().into_iter(), &read);
    spare()?;
    let profile = device::choose(arguments.device.as_deref(), &read)?;
    let mut pipeline = planning::load(&arguments.pipeline, &read)?;
    let scene = arguments.scene.as_deref().map(|file| inputs::scene(file, &read)).transpose()?;
    spare()?;
    let facts = scene.as_ref().map(Scene::facts);
    let view = View { facts, size: arguments.size, rotation: arguments.planning.rotate, dump: &[] };
    let plan = pipeline.plan(view, &profile, &mut Estimated(&profile), &arguments.planning.options())?.plan;
    let shown = match arguments.format {
        PlanFormat::Tree => {
            let tree = scene.as_ref().map_or_else(|| plan.tree(), |scene| plan.tree_of(&|list| objects(scene, list)));
            text::escape_lines(&tree) + "\n"
        }
        PlanFormat::Json => text::json_text(&plan.to_json()?),
    };
    match &arguments.output {
        Some(file) => outputs::write(&[(file, shown.as_bytes())], &read)?,
        None => text::print(&shown).map_err(Error::Print)?,
    }
    Ok(Exit::Fine)
}

/// How many objects of a scene are in a draw list.
fn objects(scene: &Scene, list: DrawList) -> usize {
    scene.objects.iter().filter(|object| scene.draw_list(object) == list).count()
}
