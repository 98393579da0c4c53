//! `framewright run`: draws a scene through a pipeline.

mod layer;
mod report;

use crate::command_line::args::RunArguments;
use crate::drawing::captures::{self, Drawing};
use crate::drawing::pictures::{EncodedPicture, PictureRequest};
use crate::drawing::{Prepared, diagnostics, pictures, timings};
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::files::outputs;
use crate::picture::FileFormat;
use crate::planning::{self, Loaded, Planned, View, device, notes};
use crate::system::quantiles::median;
use crate::system::{Exit, interrupt, progress, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::frame::{Frame, Image, Lifetime, Stereo};
use framewright_graph::plan::{Stage, Totals};
use framewright_graph::vulkan::{Format, Layout, Subresources};
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, DeviceOptions, ExecutorOptions, FrameReport};
use report::{Report, Validation};
use serde::Serialize;
use std::path::Path;

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
    inputs::expect(&arguments.pipeline, &read);
    read.expect(FileRole::SCENE.recorded, &arguments.scene);
    let spare = || outputs::prepare(arguments.written(), &read);
    spare()?;
    let choice = device::to_draw_on(arguments.device.as_deref())?;
    let mut pipeline = planning::load(&arguments.pipeline, &read)?;
    let scene = inputs::scene(&arguments.scene, &read)?;
    spare()?;
    // Only now: until here nothing is lost when the system ends the program, and a named pipe may keep it waiting forever.
    interrupt::watch();

    let helper = Some(pipeline.helper.clone());
    let device = Device::open(&DeviceOptions { choice, validation: arguments.validate, helper })?;
    device.cancel_when(interrupt::asked);
    let canary = if arguments.validate { Some(device.canary()?) } else { None };
    let planned = planned(arguments, &mut pipeline, &scene, &device)?;
    diagnostics::cameras(&planned.frame, &scene)?;
    // Now its shaders are known.
    spare()?;
    let requests = pictures::requests(arguments, &planned)?;
    let modes = &arguments.pipeline.stereo.0;
    if modes.len() > 1 {
        let stereo = planned.plan.stereo;
        let eyes = if stereo == Stereo::Off { "one eye" } else { "two eyes" };
        text::say(&format!("note: it is drawn for {eyes} by `--stereo {}`", stereo.name()));
    }
    // A format or sample count that the device lacks changes the picture.
    for line in notes::lines(planned.plan.notes.iter().filter(|note| note.stage == Stage::Fit)) {
        text::say(&line);
    }
    for name in not_handed_in(&planned.frame) {
        text::say(&format!("note: nobody hands in `{}` here: all of it is 0", text::escape(name)));
    }
    let (frames, pictures) = draw(arguments, &planned, &requests, &mut pipeline, &scene, &device)?;
    let over = |time: fn(&FrameReport) -> f64| median(frames.iter().map(time).collect()).unwrap_or_default();
    let mut report = Report {
        format_version: 2,
        pipeline: shown(&arguments.pipeline.file),
        scene: shown(&arguments.scene),
        settings: planned.plan.settings.clone(),
        size: [arguments.size.width, arguments.size.height],
        frames: arguments.frames,
        device: device.summary().into(),
        memory: (&planned.plan.totals).into(),
        barriers: (&planned.plan.totals).into(),
        gpu_milliseconds: over(|frame| frame.milliseconds),
        recording_milliseconds: over(|frame| frame.recording_milliseconds),
        passes: timings::rows(&planned.plan, &frames),
        notes: planned.plan.notes.clone(),
        scene_notes: scene.notes.clone(),
        validation: None,
        files: arguments.written().map(shown).collect(),
    };
    if let Some(folder) = &arguments.dump_all {
        let options = arguments.planning.options();
        let (scene, size, frames) = (&scene, arguments.size, arguments.frames);
        let drawing =
            Drawing { device: &device, pipeline: &mut pipeline, planned: &planned, scene, size, options, frames };
        dump_all(drawing, folder, &read)?;
    }
    // The layer may have something to say about the device's end too.
    let messages = device.messages();
    drop(device);
    report.validation = canary.map(|canary| Validation::new(canary, &messages.list()));

    let json = if arguments.report.is_some() { text::json(&report)? } else { String::new() };
    let pictures = pictures.iter().map(|picture| (&*picture.path, &*picture.contents));
    let files = pictures.chain(arguments.report.as_deref().map(|file| (file, json.as_bytes())));
    outputs::write(&files.collect::<Vec<_>>(), &read)?;
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
    let list = text::json(&Dumped { format_version: 1, images: list })?;
    outputs::write(&[(&folder.join("images.json"), list.as_bytes())], read)
}

/// The list of images that were dumped.
#[derive(Serialize)]
struct Dumped {
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

/// Plans the frame for the device, and says what dumping changes.
fn planned(arguments: &RunArguments, pipeline: &mut Loaded, scene: &Scene, device: &Device) -> Result<Planned, Error> {
    let dump: Vec<String> = arguments.dump.iter().map(|dump| dump.image.clone()).collect();
    let rotation = arguments.planning.rotate;
    let view = View { facts: Some(scene.facts()), size: arguments.size, rotation, dump: &dump };
    let options = arguments.planning.options();
    let (profile, mut memory) = (device.profile(), device.memory());
    if interrupt::asked() {
        // The device may not have been tested.
        return Err(Error::Interrupted { frames: 0, wanted: arguments.frames });
    }
    let planned = pipeline.plan(view, &profile, &mut memory, &options)?;
    if !dump.is_empty() {
        let without = pipeline.plan(View { dump: &[], ..view }, &profile, &mut memory, &options)?;
        text::say(&format!("note: dumping {}", difference(&without.plan.totals, &planned.plan.totals)));
    }
    Ok(planned)
}

/// Names of what the frame expects to be handed in with contents.
fn not_handed_in(frame: &Frame) -> impl Iterator<Item = &str> {
    let imported = |lifetime: &Lifetime| match lifetime {
        Lifetime::Imported { before, .. } => Some(*before),
        Lifetime::Transient | Lifetime::Persistent { .. } | Lifetime::History { .. } | Lifetime::File(_) => None,
    };
    let has_contents = move |image: &&Image| imported(&image.lifetime).is_some_and(|it| it.layout != Layout::Undefined);
    let images = frame.images.iter().filter(has_contents).map(|image| &*image.name);
    let buffers = frame.buffers.iter().filter(move |buffer| imported(&buffer.lifetime).is_some());
    images.chain(buffers.map(|buffer| &*buffer.name))
}

/// How the totals of two Plans differ, in words.
fn difference(before: &Totals, after: &Totals) -> String {
    let count = |name: &str, before: u32, after: u32| (before != after).then(|| format!("{name} {before} → {after}"));
    let bytes = |name: &str, before: u64, after: u64| {
        (before != after).then(|| format!("{name} {} → {}", text::bytes(before), text::bytes(after)))
    };
    let changes: Vec<String> = [
        count("passes", before.passes + before.inserted_passes, after.passes + after.inserted_passes),
        count("rendering scopes", before.scopes, after.scopes),
        count("resolves", before.resolves, after.resolves),
        count("copies", before.copies, after.copies),
        count("barriers", before.image_barriers + before.memory_barriers, after.image_barriers + after.memory_barriers),
        bytes("transient memory", before.placed_bytes, after.placed_bytes),
        bytes("kept memory", before.kept_bytes, after.kept_bytes),
    ]
    .into_iter()
    .flatten()
    .collect();
    if changes.is_empty() {
        "changes no sum of the Plan".to_owned()
    } else {
        format!("changes the Plan: {}", changes.join(", "))
    }
}

/// Draws all frames, and encodes the pictures to write.
fn draw(
    arguments: &RunArguments,
    planned: &Planned,
    requests: &[PictureRequest<'_>],
    pipeline: &mut Loaded,
    scene: &Scene,
    device: &Device,
) -> Result<(Vec<FrameReport>, Vec<EncodedPicture>), Error> {
    let options = ExecutorOptions { poison: arguments.planning.poison, timestamps: true, ..ExecutorOptions::default() };
    let mut prepared = Prepared::new(device, planned, pipeline, scene, arguments.size, &options)?;
    let progress = progress::frames(arguments.frames);
    let mut frames = Vec::new();
    for drawn in 0..arguments.frames {
        if interrupt::asked() {
            return Err(Error::Interrupted { frames: drawn, wanted: arguments.frames });
        }
        frames.push(prepared.draw().map_err(interrupted(drawn, arguments.frames))?);
        progress.inc(1);
    }
    progress.finish_and_clear();
    let pictures = requests.iter().map(|request| request.encode(&mut prepared.executor, &planned.plan));
    let pictures = pictures.collect::<Result<Vec<_>, _>>().map_err(interrupted(arguments.frames, arguments.frames))?;
    if interrupt::asked() {
        return Err(Error::Interrupted { frames: arguments.frames, wanted: arguments.frames });
    }
    Ok((frames, pictures))
}

fn shown(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
