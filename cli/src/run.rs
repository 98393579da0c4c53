//! `framewright run`: draws a scene through a pipeline.

use crate::args::Run;
use crate::error::{Error, Exit};
use crate::files::{self, What};
use crate::planning::{self, Loaded, Planned, View};
use crate::report::{Report, Setting, Validation};
use crate::values::OutputFile;
use crate::{interrupt, notes, output, picture, placed, progress, rows, text};
use framewright_graph::base::{ReadFiles, Span};
use framewright_graph::frame::{Eye, EyeForm, Frame, Image, Lifetime, Resource, Stereo};
use framewright_graph::plan::{self, Stage, Totals};
use framewright_graph::vulkan::Layout;
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, DeviceChoice, DeviceOptions, Executor, ExecutorOptions, FrameReport, Texels};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A picture that is ready to be written.
struct Picture {
    path: PathBuf,
    contents: Vec<u8>,
}

/// Draws a scene.
///
/// # Errors
/// If a file is wrong, the device or the layer is missing, or something can't be written.
pub(crate) fn run(arguments: &Run) -> Result<Exit, Error> {
    draw_and_write(arguments).map_err(interrupted(0, arguments.frames))
}

fn draw_and_write(arguments: &Run) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    files::expect(&arguments.pipeline, &read);
    read.expect(What::SCENE.recorded, &arguments.scene);
    let spare = || output::prepare(arguments.written(), &read);
    spare()?;
    let choice = choice(arguments.device.as_deref())?;
    let mut pipeline = planning::load(&arguments.pipeline, &read)?;
    let scene = files::scene(&arguments.scene, &read)?;
    spare()?;
    // Only now: until here nothing is lost when the system ends the program, and a named pipe may keep it waiting forever.
    interrupt::watch();

    let helper = Some(pipeline.helper.clone());
    let device = Device::open(&DeviceOptions { choice, validation: arguments.validate, helper })?;
    device.cancel_when(interrupt::asked);
    let canary = if arguments.validate { Some(device.canary()?) } else { None };
    let planned = planned(arguments, &mut pipeline, &scene, &device)?;
    placed::cameras(&planned.frame, &scene)?;
    // Now its shaders are known.
    spare()?;
    let wanted = wanted(arguments, &planned)?;
    let modes = &arguments.pipeline.stereo.0;
    if modes.len() > 1 {
        let stereo = planned.plan.stereo;
        let eyes = if stereo == Stereo::Off { "one eye" } else { "two eyes" };
        text::say(&format!("note: it is drawn for {eyes} by `--stereo {}`", stereo.name()));
    }
    // What was asked for and isn't had changes the picture.
    for line in notes::lines(planned.plan.notes.iter().filter(|note| note.stage == Stage::Fit)) {
        text::say(&line);
    }
    for name in not_handed_in(&planned.frame) {
        text::say(&format!("note: nobody hands in `{}` here: all of it is 0", text::escape(name)));
    }
    let (frames, pictures) = draw(arguments, &planned, wanted, &mut pipeline, &scene, &device)?;
    let mut report = Report {
        format_version: 2,
        pipeline: shown(&arguments.pipeline.file),
        scene: shown(&arguments.scene),
        settings: planned
            .plan
            .settings
            .iter()
            .map(|one| Setting { name: one.name.to_string(), value: one.value.clone() })
            .collect(),
        size: [arguments.size.width, arguments.size.height],
        frames: arguments.frames,
        device: device.summary().into(),
        memory: (&planned.plan.totals).into(),
        barriers: (&planned.plan.totals).into(),
        gpu_milliseconds: rows::median(frames.iter().map(|frame| frame.milliseconds).collect()),
        recording_milliseconds: rows::median(frames.iter().map(|frame| frame.recording_milliseconds).collect()),
        passes: rows::rows(&planned.plan, &frames),
        notes: planned.plan.notes.clone(),
        scene_notes: scene.notes.clone(),
        validation: None,
        files: arguments.written().map(shown).collect(),
    };
    // The layer may have something to say about the device's end too.
    let messages = device.messages();
    drop(device);
    report.validation = canary.map(|canary| Validation::new(canary, &messages.list()));

    let json = if arguments.report.is_some() { text::json(&report)? } else { String::new() };
    let pictures = pictures.iter().map(|picture| (&*picture.path, &*picture.contents));
    let files = pictures.chain(arguments.report.as_deref().map(|file| (file, json.as_bytes())));
    output::write(&files.collect::<Vec<_>>(), &read)?;
    text::print(&report.table()).map_err(Error::Print)?;
    Ok(if report.validation.is_some_and(|validation| validation.findings > 0) { Exit::Found } else { Exit::Fine })
}

/// Ctrl-C gives up waits for the device and for what compiles shaders: what comes of that is no fault of theirs.
fn interrupted(frames: u32, wanted: u32) -> impl Fn(Error) -> Error {
    move |error| match error {
        Error::Vulkan(_) | Error::Wrong { .. } if interrupt::asked() => Error::Interrupted { frames, wanted },
        other => other,
    }
}

/// The device that `--device` names.
///
/// # Errors
/// If it is a profile's file.
pub(crate) fn choice(device: Option<&OsStr>) -> Result<DeviceChoice, Error> {
    let Some(name) = device else { return Ok(DeviceChoice::Default) };
    let name = name.to_string_lossy().into_owned();
    match name.parse() {
        Ok(index) => Ok(DeviceChoice::Index(index)),
        Err(_) if Path::new(&name).extension().is_some_and(|end| end == "ron") => {
            Err(Error::ProfileIsNoDevice { name })
        }
        Err(_) => Ok(DeviceChoice::Name(name)),
    }
}

/// Plans the frame for the device, and says what dumping changes.
fn planned(arguments: &Run, pipeline: &mut Loaded, scene: &Scene, device: &Device) -> Result<Planned, Error> {
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

/// What a Plan has that another hasn't, in words.
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

/// Draws all frames and reads back what is to be written.
fn draw(
    arguments: &Run,
    planned: &Planned,
    wanted: Vec<Wanted<'_>>,
    pipeline: &mut Loaded,
    scene: &Scene,
    device: &Device,
) -> Result<(Vec<FrameReport>, Vec<Picture>), Error> {
    let size = [arguments.size.width, arguments.size.height];
    let mut source = SceneDrawSource::for_plan(device, scene, size, &planned.plan)?;
    let options = ExecutorOptions { poison: arguments.planning.poison, ..ExecutorOptions::default() };
    let Loaded { shaders, textures, .. } = pipeline;
    let mut executor = Executor::with_textures(device, &planned.plan, shaders, textures, &options)
        .map_err(|problem| placed::texture(&planned.frame, problem))?;
    let progress = progress::frames(arguments.frames);
    let mut frames = Vec::new();
    for drawn in 0..arguments.frames {
        if interrupt::asked() {
            return Err(Error::Interrupted { frames: drawn, wanted: arguments.frames });
        }
        let frame = executor.frame(&mut source).map_err(Error::from);
        frames.push(frame.map_err(interrupted(drawn, arguments.frames))?);
        progress.inc(1);
    }
    progress.finish_and_clear();
    let mut pictures = Vec::new();
    for Wanted { outputs, in_layers, name, path, file } in wanted {
        let read = outputs.iter().map(|output| executor.read(*output)).collect::<Result<Vec<_>, _>>();
        let read = read.map_err(Error::from).map_err(interrupted(arguments.frames, arguments.frames))?;
        let eyes = read.into_iter().flat_map(|texels| if in_layers { layers(texels) } else { vec![texels] }).collect();
        let Texels { format, extent: [width, height, _], bytes, .. } = side_by_side(eyes);
        let encoding = planned.plan.outputs.get(outputs[0]).and_then(|output| output.encoding);
        let picture = picture::Picture { format, encoding, extent: [width, height], bytes: &bytes };
        let contents = file.write(&picture).map_err(|problem| Error::Picture { image: name.to_owned(), problem })?;
        if let Some(loss) = file.loses(format) {
            text::say(&format!("note: `{}` is {format}: in its picture {loss}", text::escape(name)));
        }
        pictures.push(Picture { path: path.to_owned(), contents });
    }
    if interrupt::asked() {
        return Err(Error::Interrupted { frames: arguments.frames, wanted: arguments.frames });
    }
    Ok((frames, pictures))
}

/// An output that is written.
struct Wanted<'a> {
    /// Its number, or those of both eyes.
    outputs: Vec<usize>,
    /// Whether its layers are both eyes'.
    in_layers: bool,
    /// Its image's name.
    name: &'a str,
    /// Where to.
    path: &'a Path,
    /// As what.
    file: picture::File,
}

/// Outputs that are written.
///
/// # Errors
/// If there is no image to write, or the kind of file can't hold it.
fn wanted<'a>(arguments: &'a Run, planned: &'a Planned) -> Result<Vec<Wanted<'a>>, Error> {
    let (frame, plan) = (&planned.frame, &planned.plan);
    let image = |output: usize| match frame.outputs.get(output)?.resource {
        Resource::Image(image) => frame.images.get(image.0 as usize).map(|image| &*image.name),
        Resource::Buffer(_) => None,
    };
    let written = |outputs: Vec<usize>, name: &'a str, path: &'a Path| {
        let file = picture::File::of(path).unwrap_or(picture::File::Png);
        let planned = match plan.outputs.get(outputs[0]).map(|output| output.resource) {
            Some(plan::Resource::Image(image)) => Some(plan.image(image)),
            _ => None,
        };
        match planned {
            Some(image) if !file.holds(image.format) => {
                Err(Error::NotFloats { image: name.to_owned(), format: image.format })
            }
            image => {
                let in_layers = image.is_some_and(|image| image.eyes == Some(EyeForm::Layers));
                Ok(Wanted { outputs, in_layers, name, path, file })
            }
        }
    };
    let all = 0..frame.outputs.len();
    let mut wanted = Vec::new();
    for OutputFile { output, file } in &arguments.output {
        let at = match output {
            Some(name) => outputs_named(frame, name, declared(frame)),
            None => of_both_eyes(frame, 0),
        };
        let first = at.first().copied().ok_or_else(|| no_output(frame, output.as_deref().unwrap_or_default()))?;
        let name = image(first).ok_or_else(|| Error::NoPicture { output: output_name(frame, first) })?;
        wanted.push(written(at, name, file)?);
    }
    for dump in &arguments.dump {
        let outputs = outputs_named(frame, &dump.image, all.clone());
        if let Some(name) = outputs.first().and_then(|at| image(*at)) {
            wanted.push(written(outputs, name, &dump.file)?);
        }
    }
    Ok(wanted)
}

/// The output of that name among some, or else those of both eyes that have it.
fn outputs_named(frame: &Frame, name: &str, among: impl Iterator<Item = usize> + Clone) -> Vec<usize> {
    let is = |at: &usize, name: &str| output_name(frame, *at) == name;
    let one = among.clone().find(|at| is(at, name));
    let of = |eye: Eye| among.clone().find(|at| is(at, &eye.named(name)));
    one.map_or_else(|| Eye::BOTH.into_iter().filter_map(of).collect(), |one| vec![one])
}

/// An output, with the right eye's behind it if it is the left one's.
fn of_both_eyes(frame: &Frame, output: usize) -> Vec<usize> {
    let eye = |at: usize| frame.outputs.get(at).and_then(|output| output.eye);
    let both = eye(output) == Some(Eye::Left) && eye(output + 1) == Some(Eye::Right);
    (output..frame.outputs.len()).take(if both { 2 } else { 1 }).collect()
}

/// The layers of an image by themselves.
fn layers(texels: Texels) -> Vec<Texels> {
    let bytes = texels.bytes.len() / texels.layers.max(1) as usize;
    let layer = |bytes: &[u8]| Texels { layers: 1, bytes: bytes.to_vec(), ..texels };
    texels.bytes.chunks(bytes.max(1)).map(layer).collect()
}

/// Pictures of the same size and format beside each other, the first one on the left.
fn side_by_side(mut eyes: Vec<Texels>) -> Texels {
    let mut all = eyes.swap_remove(0);
    for other in eyes {
        let row = |texels: &Texels| texels.bytes.len() / texels.extent[1].max(1) as usize;
        let rows = all.bytes.chunks(row(&all)).zip(other.bytes.chunks(row(&other)));
        all.bytes = rows.flat_map(|(left, right)| [left, right].concat()).collect();
        all.extent[0] += other.extent[0];
    }
    all
}

/// The name of an output.
fn output_name(frame: &Frame, output: usize) -> String {
    let name = match frame.outputs.get(output).map(|output| output.resource) {
        Some(Resource::Image(image)) => frame.images.get(image.0 as usize).map(|image| &image.name),
        Some(Resource::Buffer(buffer)) => frame.buffers.get(buffer.0 as usize).map(|buffer| &buffer.name),
        None => None,
    };
    name.map_or_else(String::new, ToString::to_string)
}

/// Numbers of the outputs that the pipeline names; dumped images stand in no file.
fn declared(frame: &Frame) -> impl Iterator<Item = usize> + Clone {
    (0..frame.outputs.len()).filter(|at| frame.outputs[*at].span != Span::NONE)
}

fn no_output(frame: &Frame, name: &str) -> Error {
    Error::NoOutput {
        name: name.to_owned(),
        outputs: declared(frame).map(|at| output_name(frame, at)).collect(),
        image: frame.images.iter().any(|image| *image.name == *name),
    }
}

fn shown(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
