//! `framewright inspect`: the Plan of a pipeline, without a GPU.

use crate::command_line::args::{CapturedPictures, InspectArguments, PlanFormat};
use crate::drawing::captures::{self, Drawing};
use crate::drawing::timed;
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::files::outputs;
use crate::files::report;
use crate::planning::what_if::{self, PlannedSubject};
use crate::planning::{self, device, helper, plan_file};
use crate::system::{Exit, interrupt, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::dataflow::Dataflow;
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::DrawList;
use framewright_graph::plan::{Detail, Plan};
use framewright_lab::picture::FileFormat;
use framewright_viewer::{MOST_NODES, Page, ShownPlan, Thumbnail, Times};
use framewright_vulkan::{Device, Helper};
use std::path::Path;

/// The longer side of the pictures on a page, in texels.
const ON_PAGE: u32 = 256;

/// Prints or writes a Plan.
///
/// # Errors
/// If the pipeline, the scene or the profile is wrong, or the result can't be written.
pub(crate) fn inspect(arguments: &InspectArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    if plan_file::is_one(&arguments.pipeline.file) {
        return inspect_plan(arguments, &read);
    }
    inputs::expect(&arguments.pipeline, &read);
    let subject = &arguments.subject;
    subject.scene.iter().for_each(|file| framewright::expect_scene(file, &read));
    subject.device.iter().for_each(|file| read.expect(FileRole::PROFILE.recorded, Path::new(file)));
    arguments.report.iter().for_each(|file| read.expect(FileRole::REPORT.recorded, file));
    let spare = || outputs::prepare(arguments.output.as_deref().into_iter(), &read);
    spare()?;
    let helper = helper::of(&arguments.pipeline)?;
    let mut pipeline = planning::load_with(&arguments.pipeline, &read, helper.clone())?;
    let scene = subject.scene.as_deref().map(|file| inputs::scene(file, subject.reading.strict, &read)).transpose()?;
    spare()?;
    expect_page(arguments)?;
    let module = arguments.what_if.then(what_if::module).transpose()?;
    let drawn_on = if arguments.capture.is_some() { Some(open(&helper)?) } else { None };
    let profile = match &drawn_on {
        Some(device) => device.profile(),
        None => device::choose(subject.device.as_deref(), &read)?,
    };
    let choices = planning::undrawn(&arguments.pipeline, subject, scene.as_ref());
    let options = subject.planning.options();
    let planned = match &drawn_on {
        Some(device) => pipeline.planned(&choices, &profile, &mut device.memory(), &options)?,
        None => pipeline.planned(&choices, &profile, &mut MemoryEstimate(&profile), &options)?,
    };
    let plan = &planned.plan;
    let counted = |list| scene.as_ref().map_or(0, |scene| scene.count(list));
    let objects: Option<&dyn Fn(DrawList) -> usize> = scene.is_some().then_some(&counted);
    let detail = Detail { objects, verbose: arguments.verbose };
    let name = arguments.pipeline.file.to_string_lossy();
    let shown = shown(arguments.format, plan, detail, || {
        let devices = planning::on_other_devices(&mut pipeline, &choices, &options, (&*name, plan))?;
        let (captures, times) = match (&drawn_on, &scene, &arguments.output, arguments.capture) {
            (Some(device), Some(scene), Some(page), Some(wanted)) => {
                let (made, pipeline) = ((plan, &planned.frame), &mut pipeline);
                let times = timed::times(device, made, &mut pipeline.assets, scene)?;
                (captured(Drawing::new(device, pipeline, made, scene, options), wanted, page, &read)?, times)
            }
            _ => (Vec::new(), reported(arguments, plan, &read)?),
        };
        let what_if = module.map(|module| {
            let draws = planning::draws(&arguments.pipeline, &read)?;
            let (preset, device) = (arguments.pipeline.preset.as_deref(), (subject.device.as_deref(), &profile));
            let planned =
                PlannedSubject { name: &name, preset, choices: &choices, draws: &draws, device, options, plan };
            what_if::carried(&module, &mut pipeline, &planned)
        });
        let what_if = what_if.transpose()?;
        let detail = Detail { verbose: true, ..detail };
        let (sources, times) = ((!arguments.no_sources).then_some(&*pipeline.sources), times.as_ref());
        let shown = ShownPlan { name: name.into_owned(), plan, detail, sources, times };
        let page = Page { plans: vec![shown], differences: None, devices: &devices, captures: &captures };
        let Some(what_if) = &what_if else { return Ok(framewright_viewer::page(&page)?) };
        Ok(framewright_viewer::page_with_what_if(&page, what_if)?)
    })?;
    put(arguments, &shown, &read)
}

/// Prints or writes the Plan in a file, as it is.
fn inspect_plan(arguments: &InspectArguments, read: &ReadFiles) -> Result<Exit, Error> {
    let InspectArguments { pipeline, subject, capture, what_if, .. } = arguments;
    let own = capture.map(|_| "--capture").or(what_if.then_some("--what-if"));
    plan_file::nothing_chosen(pipeline, subject, own)?;
    expect_page(arguments)?;
    read.expect(FileRole::PLAN.recorded, &pipeline.file);
    arguments.report.iter().for_each(|file| read.expect(FileRole::REPORT.recorded, file));
    let spare = || outputs::prepare(arguments.output.as_deref().into_iter(), read);
    spare()?;
    let plan = plan_file::read(&pipeline.file, read)?;
    spare()?;
    let detail = Detail { verbose: arguments.verbose, ..Detail::default() };
    let shown = shown(arguments.format, &plan, detail, || {
        let times = reported(arguments, &plan, read)?;
        let shown = ShownPlan {
            name: pipeline.file.to_string_lossy().into_owned(),
            plan: &plan,
            detail: Detail { verbose: true, ..detail },
            sources: None,
            times: times.as_ref(),
        };
        Ok(framewright_viewer::page(&Page { plans: vec![shown], differences: None, devices: &[], captures: &[] })?)
    })?;
    put(arguments, &shown, read)
}

/// Makes sure that options about a page have one.
fn expect_page(arguments: &InspectArguments) -> Result<(), Error> {
    let InspectArguments { format, capture, what_if, report, no_sources, .. } = arguments;
    let given = [
        (capture.is_some(), "--capture"),
        (*what_if, "--what-if"),
        (report.is_some(), "--report"),
        (*no_sources, "--no-sources"),
    ];
    match given.into_iter().find(|(is_given, _)| *is_given && *format != PlanFormat::Html) {
        Some((_, option)) => Err(Error::WithoutPage { option }),
        None => Ok(()),
    }
}

/// The times in the report that the command line names.
fn reported(arguments: &InspectArguments, plan: &Plan, read: &ReadFiles) -> Result<Option<Times>, Error> {
    arguments.report.as_deref().map(|file| report::times(file, plan, read)).transpose()
}

/// A Plan in a form; `page` makes that of a page.
fn shown(
    format: PlanFormat,
    plan: &Plan,
    detail: Detail<'_>,
    page: impl FnOnce() -> Result<String, Error>,
) -> Result<String, Error> {
    Ok(match format {
        PlanFormat::Tree => text::escape_lines(&plan.outline(detail).draw()) + "\n",
        PlanFormat::Json => text::json_text(&plan.to_json()?),
        PlanFormat::Dot => framewright_viewer::dot(plan, &Dataflow::of(plan)),
        PlanFormat::Mermaid => {
            let (shown, beyond) = framewright_viewer::mermaid(plan, &Dataflow::of(plan));
            beyond.iter().for_each(|limit| text::say(&format!("note: {limit}")));
            shown
        }
        PlanFormat::Svg => framewright_viewer::svg(plan, &laid_out(plan)?),
        PlanFormat::Html => page()?,
    })
}

/// Prints what is shown, or writes it to the file that is named.
fn put(arguments: &InspectArguments, shown: &str, read: &ReadFiles) -> Result<Exit, Error> {
    match &arguments.output {
        Some(file) => outputs::write(&[(file, shown.as_bytes())], read)?,
        None => text::print(shown).map_err(Error::Print)?,
    }
    Ok(Exit::Fine)
}

/// The device that captures are drawn on.
fn open(helper: &Helper) -> Result<Device, Error> {
    // Until here nothing is lost when the system ends the program.
    interrupt::watch();
    device::open(device::to_draw_on(None)?, false, helper)
}

/// Draws every image after every pass that wrote it. With `--capture=full` the whole pictures go to a folder beside the page.
fn captured(
    drawing: Drawing<'_>,
    wanted: CapturedPictures,
    page: &Path,
    read: &ReadFiles,
) -> Result<Vec<Thumbnail>, Error> {
    let stem = page.file_stem().unwrap_or(page.as_os_str()).to_string_lossy();
    let name = format!("{stem}.images");
    let folder = page.with_file_name(&name);
    let full = wanted == CapturedPictures::Full;
    if full {
        outputs::make_folder(&folder)?;
    }
    let mut thumbnails = Vec::new();
    captures::draw(drawing, |captured| {
        let small = captured.small(ON_PAGE);
        if !full {
            thumbnails.push(small);
            return Ok(());
        }
        let file = captured.name();
        outputs::write(&[(&folder.join(format!("{file}.png")), &captured.encoded(FileFormat::Png)?)], read)?;
        if FileFormat::OpenExr.holds(captured.format) {
            let exact = captured.encoded(FileFormat::OpenExr)?;
            outputs::write(&[(&folder.join(format!("{file}.exr")), &exact)], read)?;
        }
        thumbnails.push(small.with_file(format!("{name}/{file}.png")));
        Ok(())
    })?;
    Ok(thumbnails)
}

/// The dataflow of a Plan that a picture can hold.
fn laid_out(plan: &Plan) -> Result<Dataflow, Error> {
    let flow = Dataflow::of(plan);
    match flow.nodes.len() {
        nodes if nodes > MOST_NODES => Err(Error::TooManyNodes { nodes, most: MOST_NODES }),
        _ => Ok(flow),
    }
}
