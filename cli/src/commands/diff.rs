//! `framewright diff`: the differences between two Plans, without a GPU.

use crate::command_line::args::PipelineArguments;
use crate::command_line::differing::{DiffArguments, DifferenceFormat};
use crate::command_line::values::{self, Assignment, DEFAULT_SIZE, Modes, Size};
use crate::error::Error;
use crate::files::inputs;
use crate::files::outputs;
use crate::inspection::{self, Page, Shown};
use crate::planning::{self, View, device, plan_file};
use crate::system::{Exit, text};
use framewright_graph::base::{ReadFiles, Sources};
use framewright_graph::device::Estimated;
use framewright_graph::difference::Differences;
use framewright_graph::plan::{Detail, Plan};
use framewright_passes::scene::Scene;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Prints or writes the differences.
///
/// # Errors
/// If a pipeline, a Plan, the scene or a profile is wrong, or the result can't be written.
pub(crate) fn diff(arguments: &DiffArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    inputs::expect(&arguments.pipeline, &read);
    let spare = || outputs::prepare(arguments.output.as_deref().into_iter(), &read);
    spare()?;
    let first = &arguments.pipeline.file;
    let second = arguments.other.as_ref().unwrap_or(first);
    if plan_file::is_one(first) && plan_file::is_one(second) {
        let DiffArguments { scene, device, size, .. } = arguments;
        let own = [("--scene", scene.is_some()), ("--device", device.is_some()), ("--size", *size != DEFAULT_SIZE)];
        plan_file::nothing_chosen(&arguments.pipeline, arguments.planning, &own)?;
    }
    let [name_a, name_b] = [first, second].map(|file| file.to_string_lossy().into_owned());
    let (a, sources_a) = plan(arguments, first, "--a", &arguments.a, &read)?;
    let (b, sources_b) = plan(arguments, second, "--b", &arguments.b, &read)?;
    spare()?;
    let differences = Differences::between((&name_a, &a), (&name_b, &b));
    let shown = match arguments.format {
        DifferenceFormat::Human => text::escape_lines(&differences.text()) + "\n",
        DifferenceFormat::Json => text::json(&differences)?,
        DifferenceFormat::Markdown => text::escape_lines(&differences.markdown()) + "\n",
        DifferenceFormat::Html => {
            let detail = Detail { verbose: true, ..Detail::default() };
            let plans = vec![
                Shown { name: name_a, plan: &a, detail, sources: sources_a.as_deref() },
                Shown { name: name_b, plan: &b, detail, sources: sources_b.as_deref() },
            ];
            inspection::page(&Page { plans, differences: Some(&differences), devices: &[], captures: &[] })?
        }
    };
    match &arguments.output {
        Some(file) => outputs::write(&[(file, shown.as_bytes())], &read)?,
        None => text::print(&shown).map_err(Error::Print)?,
    }
    Ok(Exit::Fine)
}

/// The Plan in a file, or that of a pipeline with the texts that it was read from.
fn plan(
    arguments: &DiffArguments,
    file: &Path,
    option: &'static str,
    own: &[Assignment],
    read: &ReadFiles,
) -> Result<(Plan, Option<Arc<Sources>>), Error> {
    if plan_file::is_one(file) {
        return match own.is_empty() {
            true => Ok((plan_file::read(file, read)?, None)),
            false => Err(Error::ChoiceForPlan { option, path: file.to_owned() }),
        };
    }
    let chosen = Choice::of(arguments, option, own)?;
    let pipeline = PipelineArguments {
        file: file.to_owned(),
        set: chosen.settings,
        stereo: chosen.stereo,
        ..arguments.pipeline.clone()
    };
    let profile = device::choose(chosen.device.as_deref(), read)?;
    let mut loaded = planning::load(&pipeline, read)?;
    let scene = chosen.scene.as_deref().map(|file| inputs::scene(file, arguments.reading.strict, read)).transpose()?;
    let view = View {
        facts: scene.as_ref().map(Scene::facts),
        size: chosen.size,
        rotation: arguments.planning.rotate,
        dump: &[],
    };
    let planned = loaded.plan(view, &profile, &mut Estimated(&profile), &arguments.planning.options())?;
    Ok((planned.plan, Some(Arc::clone(&loaded.sources))))
}

/// The choices for one of the Plans.
struct Choice {
    settings: Vec<Assignment>,
    device: Option<OsString>,
    scene: Option<PathBuf>,
    size: Size,
    stereo: Modes,
}

impl Choice {
    /// Those for both Plans, and on top of them its own.
    fn of(arguments: &DiffArguments, option: &'static str, own: &[Assignment]) -> Result<Choice, Error> {
        let mut choice = Choice {
            settings: arguments.pipeline.set.clone(),
            device: arguments.device.clone(),
            scene: arguments.scene.clone(),
            size: arguments.size,
            stereo: arguments.pipeline.stereo.clone(),
        };
        for Assignment { name, value } in own {
            let wrong = |problem: String| Error::OwnChoice { option, name: name.clone(), problem };
            match &**name {
                "@device" => choice.device = Some(OsStr::new(value).to_owned()),
                "@scene" => choice.scene = Some(value.into()),
                "@size" => choice.size = value.parse().map_err(wrong)?,
                "@stereo" => choice.stereo = values::stereo(value).map_err(wrong)?,
                other if other.starts_with('@') => {
                    return Err(wrong("expected a setting, @device, @scene, @size or @stereo".to_owned()));
                }
                _ => choice.settings.push(Assignment { name: name.clone(), value: value.clone() }),
            }
        }
        Ok(choice)
    }
}
