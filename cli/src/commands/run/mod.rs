//! `framewright run`: draws a scene through a pipeline.

mod bisect;
mod report;
mod subject;

use crate::command_line::args::RunArguments;
use crate::drawing::captures::{self, Drawing};
use crate::drawing::pictures;
use crate::error::Error;
use crate::files::inputs;
use crate::files::outputs;
use crate::planning::{device, helper, layer, notes};
use crate::system::{Exit, interrupt, progress, text};
use framewright::{Assets, SceneRenderer};
use framewright_graph::base::ReadFiles;
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::plan::{Buffer, Image, Plan, Resource, Role, Stage};
use framewright_graph::vulkan::{Format, Layout, State, Subresources};
use framewright_lab::outputs::{EncodedPicture, PictureRequest};
use framewright_lab::picture::FileFormat;
use framewright_lab::quantiles::median;
use framewright_lab::timings;
use framewright_passes::scene::Scene;
use framewright_viewer::{TimedDevice, Times, TracedFrame};
use framewright_vulkan::{Device, ExecutorOptions, FrameReport, RenderDoc};
use report::{Report, Validation};
use serde::Serialize;
use std::path::Path;
use std::time::Instant;
use subject::Subject;

pub(crate) use report::DeviceUsed;

/// Draws a scene.
///
/// # Errors
/// If a file is wrong, the device or the layer is missing, or something can't be written.
pub(crate) fn run(arguments: &RunArguments) -> Result<Exit, Error> {
    if arguments.validate {
        layer::under_the_current_one()?;
    }
    draw_and_write(arguments).map_err(interrupted(0, arguments.frames))
}

fn draw_and_write(arguments: &RunArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    Subject::expect(arguments, &read);
    framewright::expect_scene(&arguments.drawn.scene, &read);
    let spare = || outputs::prepare(arguments.written(), &read);
    spare()?;
    let renderdoc = renderdoc(arguments)?;
    let choice = device::to_draw_on(arguments.device.name.as_deref())?;
    let helper = helper::of(&arguments.pipeline)?;
    let mut subject = Subject::read(arguments, &helper, &read)?;
    let scene = inputs::scene(&arguments.drawn.scene, arguments.drawn.reading.strict, &read)?;
    spare()?;
    // Only now: until here nothing is lost when the system ends the program, and a named pipe may keep it waiting forever.
    interrupt::watch();

    let device = device::open(choice, arguments.validate, &helper).inspect_err(|_| {
        if renderdoc.is_some() {
            text::say(
                "note: RenderDoc is loaded: it hides Vulkan 1.3 of devices without `bufferDeviceAddressCaptureReplay`, \
                 as software drivers are",
            );
        }
    })?;
    let canary = if arguments.validate { Some(device.canary()?) } else { None };
    let (plan, frame) = subject.planned(arguments, &scene, &device)?;
    if let Some(note) = subject.made_elsewhere(&device.profile().name) {
        text::say(&note);
    }
    framewright::check_cameras(&plan, frame.as_ref(), &scene)?;
    // Now its shaders are known.
    spare()?;
    if let (Some(mode), Subject::Pipeline(pipeline), Some(frame)) = (arguments.bisect, &mut subject, &frame) {
        return bisect::bisect(arguments, mode, &device, pipeline, (&plan, frame), &scene, &read);
    }
    let requests = pictures::requests(arguments, (&plan, frame.as_ref()))?;
    let modes = &arguments.pipeline.stereo.0;
    if modes.len() > 1 {
        let stereo = plan.stereo;
        let eyes = if stereo == Stereo::Off { "one eye" } else { "two eyes" };
        text::say(&format!("note: it is drawn for {eyes} by `--stereo {}`", stereo.name()));
    }
    // A format or sample count that the device lacks changes the picture.
    for line in notes::lines(plan.notes.iter().filter(|note| note.stage() == Stage::Fit)) {
        text::say(&line);
    }
    for name in not_handed_in(&plan) {
        text::say(&format!("note: nobody hands in `{}` here: all of it is 0", text::escape(name)));
    }
    let drawn = (&plan, frame.as_ref());
    let (traced, pictures) = draw(arguments, drawn, &requests, subject.assets(), &scene, (&device, renderdoc))?;
    let frames: Vec<FrameReport> = traced.iter().map(|frame| frame.report.clone()).collect();
    let over = |time: fn(&FrameReport) -> f64| median(frames.iter().map(time).collect()).unwrap_or_default();
    let mut report = Report {
        format_version: 2,
        pipeline: (!arguments.plan).then(|| shown(&arguments.pipeline.file)),
        plan: arguments.plan.then(|| shown(&arguments.pipeline.file)),
        scene: shown(&arguments.drawn.scene),
        settings: plan.settings.clone(),
        size: plan.extent,
        frames: arguments.frames,
        device: device.summary().into(),
        memory: (&plan.totals).into(),
        barriers: (&plan.totals).into(),
        gpu_milliseconds: over(|frame| frame.milliseconds),
        recording_milliseconds: over(|frame| frame.recording_milliseconds),
        passes: timings::rows(&plan, &frames),
        times: Times::of(&device, &frames),
        notes: plan.notes.clone(),
        scene_notes: scene.mistakes.iter().chain(&scene.notes).cloned().collect(),
        validation: None,
        files: arguments.written().map(shown).collect(),
    };
    if let (Some(folder), Subject::Pipeline(pipeline), Some(frame)) = (&arguments.dump_all, &mut subject, frame) {
        let (options, frames) = (arguments.planning.options(), arguments.frames);
        let drawing = Drawing::new(&device, pipeline, (&plan, &frame), &scene, options);
        let drawing = Drawing { frames, ..drawing };
        dump_all(drawing, folder, &read)?;
    }
    // The layer may have something to say about the device's end too.
    let messages = device.messages();
    let timed_on = TimedDevice::of(&device);
    drop(device);
    report.validation = canary.map(|canary| Validation::new(canary, &messages.distinct()));

    let mut texts = Vec::new();
    if let Some(file) = arguments.report.as_deref() {
        texts.push((file, text::json(&report)?));
    }
    if let Some(file) = arguments.trace.as_deref() {
        if frames.iter().flat_map(|frame| &frame.steps).all(|step| step.began.is_none()) {
            text::say("note: the device measures no times: the trace has what the host did");
        }
        texts.push((file, text::json_text(&framewright_viewer::trace(&plan, &timed_on, &traced)?)));
    }
    if let Some(file) = arguments.save_plan.as_deref() {
        texts.push((file, text::json_text(&plan.to_json()?)));
    }
    let pictures = pictures.iter().map(|picture| (&*picture.path, &*picture.contents));
    let texts = texts.iter().map(|(file, text)| (*file, text.as_bytes()));
    outputs::write(&pictures.chain(texts).collect::<Vec<_>>(), &read)?;
    text::print(&report.table()).map_err(Error::Print)?;
    Ok(if report.validation.is_some_and(|validation| validation.findings > 0) { Exit::Found } else { Exit::Fine })
}

/// Writes every image after every pass that wrote it, and a list of them.
fn dump_all(drawing: Drawing<'_>, folder: &Path, read: &ReadFiles) -> Result<(), Error> {
    outputs::make_folder(folder)?;
    let mut list = Vec::new();
    captures::draw(drawing, |captured| {
        // Bit for bit, where a format of files can.
        let exact = FileFormat::OpenExr.holds(captured.format);
        let (format, ending) = if exact { (FileFormat::OpenExr, "exr") } else { (FileFormat::Png, "png") };
        let file = format!("{}.{ending}", captured.name());
        outputs::write(&[(&folder.join(&file), &captured.encoded(format)?)], read)?;
        list.push(DumpedImage {
            pass: captured.capture.pass.to_string(),
            image: captured.capture.image.to_string(),
            format: captured.format,
            size: captured.extent,
            part: captured.capture.range,
            file,
        });
        Ok(())
    })?;
    let list = text::json(&DumpList { format_version: 1, images: list })?;
    outputs::write(&[(&folder.join("images.json"), list.as_bytes())], read)
}

/// The list of images that were dumped.
#[derive(Serialize)]
struct DumpList {
    format_version: u32,
    images: Vec<DumpedImage>,
}

/// An image that was dumped.
#[derive(Serialize)]
struct DumpedImage {
    /// The pass that wrote it last.
    pass: String,
    image: String,
    format: Format,
    /// Width and height of the picture; layers stand side by side.
    size: [u32; 2],
    /// The part of the image that the pass wrote.
    part: Subresources,
    file: String,
}

/// Errors of the device and of shaders after Ctrl-C are an interrupt: waiting for either was given up.
fn interrupted(frames: u32, wanted: u32) -> impl Fn(Error) -> Error {
    move |error| match error {
        Error::Vulkan(_) | Error::Mistakes { .. } if interrupt::asked() => Error::Interrupted { frames, wanted },
        other => other,
    }
}

/// Names of what the Plan expects to be handed in with contents.
fn not_handed_in(plan: &Plan) -> impl Iterator<Item = &str> {
    let is_output = move |resource| plan.outputs.iter().any(|output| output.resource == resource);
    let before = |role: &Role| match role {
        Role::External { before, .. } => Some(*before),
        Role::Transient(_) | Role::Persistent { .. } => None,
    };
    let has_contents = move |image: &&Image| before(&image.role).is_some_and(|it| it.layout != Layout::Undefined);
    // A buffer may leave the frame and come from outside, too: only its state tells.
    let comes_in = move |buffer: &&Buffer| {
        let used = |it: State| !it.stages.is_empty() || !it.accesses.is_empty();
        before(&buffer.role).is_some_and(|it| used(it) || !is_output(Resource::Buffer(buffer.id)))
    };
    let images = plan.images.iter().filter(has_contents).map(|image| &*image.name);
    images.chain(plan.buffers.iter().filter(comes_in).map(|buffer| &*buffer.name))
}

/// RenderDoc and the number of the frame that it takes, if one is asked for.
fn renderdoc(arguments: &RunArguments) -> Result<Option<(RenderDoc, u32)>, Error> {
    let Some(frame) = arguments.renderdoc else { return Ok(None) };
    Ok(Some((RenderDoc::loaded().ok_or(Error::NoRenderDoc)?, frame)))
}

/// Draws all frames, and encodes the pictures to write.
fn draw(
    arguments: &RunArguments,
    (plan, frame): (&Plan, Option<&Frame>),
    requests: &[PictureRequest<'_>],
    assets: &mut Assets,
    scene: &Scene,
    (device, renderdoc): (&Device, Option<(RenderDoc, u32)>),
) -> Result<(Vec<TracedFrame>, Vec<EncodedPicture>), Error> {
    let options = ExecutorOptions { timestamps: true, ..arguments.executor_options() };
    let mut prepared = SceneRenderer::new(device, (plan, frame), assets, scene, &options)?;
    let progress = progress::frames(arguments.frames);
    let mut frames = Vec::new();
    for drawn in 0..arguments.frames {
        if interrupt::asked() {
            return Err(Error::Interrupted { frames: drawn, wanted: arguments.frames });
        }
        let taking = renderdoc.filter(|(_, frame)| *frame == drawn + 1).map(|(renderdoc, _)| renderdoc);
        taking.iter().for_each(RenderDoc::begin);
        let began = Instant::now();
        let report = prepared.draw().map_err(Error::from).map_err(interrupted(drawn, arguments.frames))?;
        frames.push(TracedFrame { began, ended: Instant::now(), report });
        if let Some(renderdoc) = taking {
            let file = renderdoc.end().ok_or(Error::NothingTaken { frame: drawn + 1 })?;
            text::say(&format!("RenderDoc took frame {}: {}", drawn + 1, text::path(&file)));
        }
        progress.inc(1);
    }
    progress.finish_and_clear();
    let pictures = requests.iter().map(|request| request.encode(&mut prepared.executor, plan, &text::note_once));
    let pictures = pictures.map(|picture| picture.map_err(Error::from)).collect::<Result<Vec<_>, _>>();
    let pictures = pictures.map_err(interrupted(arguments.frames, arguments.frames))?;
    if interrupt::asked() {
        return Err(Error::Interrupted { frames: arguments.frames, wanted: arguments.frames });
    }
    Ok((frames, pictures))
}

fn shown(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
