//! `framewright inspect`: the Plan of a pipeline, without a GPU.

use crate::command_line::args::{InspectArguments, PlanFormat};
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::files::outputs;
use crate::inspection::{self, MOST_NODES, OnDevice, Page, Shown};
use crate::planning::{self, Loaded, View, device};
use crate::system::{Exit, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::dataflow::Dataflow;
use framewright_graph::device::Estimated;
use framewright_graph::difference::Differences;
use framewright_graph::frame::DrawList;
use framewright_graph::plan::{Detail, Plan};
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
    let counted = |list| scene.as_ref().map_or(0, |scene| objects(scene, list));
    let objects: Option<&dyn Fn(DrawList) -> usize> = scene.is_some().then_some(&counted);
    let detail = Detail { objects, verbose: arguments.verbose };
    let name = arguments.pipeline.file.to_string_lossy();
    let shown = match arguments.format {
        PlanFormat::Tree => text::escape_lines(&plan.outline(detail).draw()) + "\n",
        PlanFormat::Json => text::json_text(&plan.to_json()?),
        PlanFormat::Dot => inspection::dot(&plan, &Dataflow::of(&plan)),
        PlanFormat::Mermaid => inspection::mermaid(&plan, &Dataflow::of(&plan)),
        PlanFormat::Svg => inspection::svg(&plan, &laid_out(&plan)?),
        PlanFormat::Html => {
            let devices = on_devices(&mut pipeline, view, arguments, (&*name, &plan))?;
            let detail = Detail { verbose: true, ..detail };
            let shown = Shown { name: name.into_owned(), plan: &plan, detail, sources: Some(&pipeline.sources) };
            inspection::page(&Page { plans: vec![shown], differences: None, devices: &devices })?
        }
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

/// The dataflow of a Plan that a picture can hold.
fn laid_out(plan: &Plan) -> Result<Dataflow, Error> {
    let flow = Dataflow::of(plan);
    match flow.nodes.len() {
        nodes if nodes > MOST_NODES => Err(Error::TooManyNodes { nodes, most: MOST_NODES }),
        _ => Ok(flow),
    }
}

/// The differences that every other shipped profile makes.
fn on_devices(
    pipeline: &mut Loaded,
    view: View<'_>,
    arguments: &InspectArguments,
    (name, plan): (&str, &Plan),
) -> Result<Vec<OnDevice>, Error> {
    // The differences of a Plan that is summarised would be longer than its page.
    let shown = plan.steps.len() <= MOST_NODES;
    let others = device::all()?.into_iter().filter(|(_, profile)| shown && profile.name != plan.device.name);
    let options = arguments.planning.options();
    Ok(others
        .map(|(profile, device)| {
            let planned = pipeline.plan(view, &device, &mut Estimated(&device), &options);
            let differences = match planned {
                Ok(other) => Ok(Differences::between((name, plan), (name, &other.plan))),
                Err(error) => Err(error.shown()),
            };
            OnDevice { profile: profile.to_owned(), differences }
        })
        .collect())
}
