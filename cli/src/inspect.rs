//! `framewright inspect`: the Plan of a pipeline, without a GPU.

use crate::args::{Inspect, PlanFormat};
use crate::error::{Error, Exit};
use crate::files::{self, What};
use crate::planning::{self, View};
use crate::{output, profiles, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::device::Estimated;
use framewright_graph::frame::DrawList;
use framewright_passes::scene::Scene;
use std::path::Path;

/// Prints or writes a Plan.
///
/// # Errors
/// If the pipeline, the scene or the profile is wrong, or the result can't be written.
pub(crate) fn inspect(arguments: &Inspect) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    files::expect(&arguments.pipeline, &read);
    arguments.scene.iter().for_each(|file| read.expect(What::SCENE.recorded, file));
    arguments.device.iter().for_each(|file| read.expect(What::PROFILE.recorded, Path::new(file)));
    let spare = || output::prepare(arguments.output.as_deref().into_iter(), &read);
    spare()?;
    let profile = profiles::choose(arguments.device.as_deref(), &read)?;
    let mut pipeline = planning::load(&arguments.pipeline, &read)?;
    let scene = arguments.scene.as_deref().map(|file| files::scene(file, &read)).transpose()?;
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
        Some(file) => output::write(&[(file, shown.as_bytes())], &read)?,
        None => text::print(&shown).map_err(Error::Print)?,
    }
    Ok(Exit::Fine)
}

/// How many objects of a scene are in a draw list.
fn objects(scene: &Scene, list: DrawList) -> usize {
    scene.objects.iter().filter(|object| scene.draw_list(object) == list).count()
}
