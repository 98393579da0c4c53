//! The live page: a pipeline and a scene that are drawn anew whenever their files or choices change. What is wrong leaves the last good frame.

mod changes;
mod pictures;

use crate::command_line::serving::ServeArguments;
use crate::drawing::captures::{self, CapturedImage, Drawing};
use crate::error::Error;
use crate::files::inputs;
use crate::planning::{self, totals};
use crate::system::{Exit, interrupt, text};
use changes::Changes;
use framewright::{Choices, Pipeline, PlannedFrame, SceneRenderer};
use framewright_graph::base::ReadFiles;
use framewright_graph::frame::{Capture, CaptureName, DrawList};
use framewright_graph::plan::{Detail, SettingUsed};
use framewright_lab::outputs;
use framewright_lab::picture::FileFormat;
use framewright_passes::scene::{Scene, SceneError};
use framewright_viewer::{
    About, Choice, Controls, History, KeptState, LastFrames, LiveState, Output, Page, PublishedState, ShownMistakes,
    ShownPlan, Thumbnail, Times,
};
use framewright_vulkan::{Device, ExecutorOptions, Helper};
use std::collections::BTreeMap;
use std::hash::{BuildHasher, RandomState};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// The longer side of the pictures that a page begins with, in texels.
const SMALL: u32 = 128;
/// Files that never rest are read all the same, after this many waits.
const MOST_WAITS: u32 = 20;

/// What is drawn, and what was drawn last.
pub(crate) struct Session<'a> {
    arguments: &'a ServeArguments,
    device: &'a Device,
    helper: Helper,
    scene: FileValue<Scene>,
    pipeline: FileValue<Pipeline>,
    /// Settings that were chosen in the page.
    chosen: BTreeMap<String, String>,
    /// The preset that was chosen in the page.
    preset: Option<String>,
    /// What tells this server from earlier ones of the same address.
    server: Arc<str>,
    /// The number of the last state.
    version: u64,
    /// Whether a frame was drawn, or tried.
    begun: bool,
    good: GoodFrame,
    /// What keeps a newer frame from being drawn.
    wrong: ShownMistakes,
    /// What changed since the last good frame.
    changes: Changes,
    history: Arc<History>,
}

/// A thing that was read, with the files that it was read from; `None`: they were wrong.
struct FileValue<T> {
    value: Option<T>,
    read: ReadFiles,
}

/// The last good frame.
#[derive(Default)]
struct GoodFrame {
    /// The state that had it first.
    version: u64,
    page: Option<String>,
    controls: Controls,
    outputs: Vec<Output>,
    pictures: Arc<BTreeMap<String, Arc<[u8]>>>,
    took: String,
    /// What was drawn.
    planned: Option<PlannedFrame>,
    /// What was captured of it.
    captured: BTreeMap<CaptureName, CapturedImage>,
    /// The Plan's JSON form, with what it was drawn with.
    plan: Arc<str>,
    settings: Vec<SettingUsed>,
    times: Option<Times>,
}

impl<T> FileValue<T> {
    fn nothing() -> FileValue<T> {
        FileValue { value: None, read: ReadFiles::default() }
    }
}

impl<'a> Session<'a> {
    /// One that has drawn nothing.
    pub(crate) fn new(arguments: &'a ServeArguments, device: &'a Device, helper: Helper) -> Session<'a> {
        // Each has other random keys.
        let server = format!("{:016x}", RandomState::new().hash_one(()));
        Session {
            arguments,
            device,
            helper,
            scene: FileValue::nothing(),
            pipeline: FileValue::nothing(),
            chosen: BTreeMap::new(),
            preset: None,
            server: server.into(),
            version: 0,
            begun: false,
            good: GoodFrame::default(),
            wrong: ShownMistakes::default(),
            changes: Changes::default(),
            history: Arc::default(),
        }
    }

    /// Whether a file that was read is another one by now, or a missing one is there.
    #[must_use]
    pub(crate) fn files_changed(&self) -> bool {
        self.scene.read.changed() || self.pipeline.read.changed()
    }

    /// Waits until files stay as they are for `time`: editors write them in several steps.
    pub(crate) fn let_files_rest(&self, time: Duration) {
        for _ in 0..MOST_WAITS {
            let now = [&self.scene.read, &self.pipeline.read].map(ReadFiles::now);
            std::thread::sleep(time);
            if !now.iter().any(ReadFiles::changed) {
                return;
            }
        }
    }

    /// Takes a choice. The next frame has it.
    pub(crate) fn choose(&mut self, choice: Choice) {
        match choice {
            Choice::Set(values) => self.chosen.extend(values),
            Choice::Preset(preset) => self.begin_with(preset),
            Choice::Exactly { preset, set } => {
                if preset != self.preset {
                    self.begin_with(preset);
                }
                self.chosen = set;
            }
        }
    }

    /// Takes back all that was chosen, and chooses a preset.
    fn begin_with(&mut self, preset: Option<String>) {
        self.chosen.clear();
        self.preset = preset;
        // Presets are chosen when a pipeline is read.
        self.changes.add(self.pipeline.read.changes());
        self.pipeline = FileValue::nothing();
    }

    /// Draws anew, and says on standard error how that went. What is wrong leaves the last good frame.
    ///
    /// # Errors
    /// Those of the device, which no change to a file mends; a wrong command line, before the first frame.
    pub(crate) fn draw(&mut self) -> Result<(), Error> {
        let begun = Instant::now();
        self.version += 1;
        let first = !std::mem::replace(&mut self.begun, true);
        self.changes.add(self.scene.read.changes());
        self.changes.add(self.pipeline.read.changes());
        match self.drawn() {
            Ok(good) => {
                let seconds = begun.elapsed().as_secs_f64();
                if good.page.is_some() {
                    self.remember(&good);
                }
                self.good = GoodFrame { took: format!("{}, drawn in {seconds:.2} s", good.took), ..good };
                self.wrong = ShownMistakes::default();
                text::say(&self.good.took);
                Ok(())
            }
            Err(error) if error.can_be_mended_in_files() && !(first && is_about_the_command_line(&error)) => {
                self.wrong = shown_mistakes(&error);
                text::say(&self.wrong.message);
                Ok(())
            }
            Err(error) => Err(error),
        }
    }

    /// Keeps a frame, so that later ones can be compared with it.
    fn remember(&mut self, good: &GoodFrame) {
        let before = self.history.last().map(|_| &*self.good.settings);
        let of_outputs = good.outputs.iter().filter_map(|output| {
            let address = output.picture.strip_prefix("picture/")?;
            Some((address.to_owned(), Arc::clone(good.pictures.get(address)?)))
        });
        let state = KeptState {
            version: good.version,
            drawn_at: SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .map_or(0, |since| u64::try_from(since.as_millis()).unwrap_or(u64::MAX)),
            changed: self.changes.take(before, &good.settings),
            chosen: self.chosen.clone(),
            preset: self.preset.clone(),
            name: self.arguments.pipeline.file.to_string_lossy().into_owned(),
            plan: Arc::clone(&good.plan),
            times: good.times.clone(),
            took: good.took.clone(),
            pictures: of_outputs.collect(),
        };
        Arc::make_mut(&mut self.history).keep(state);
    }

    /// The state of the page.
    ///
    /// # Errors
    /// If it has no JSON form.
    pub(crate) fn published(&mut self, busy: bool) -> Result<PublishedState, Error> {
        self.version += 1;
        let live = LiveState {
            format_version: About::FORMAT_VERSION,
            server: &self.server,
            version: self.version,
            frame: self.good.version,
            busy,
            mistakes: &self.wrong.mistakes,
            message: &self.wrong.message,
            sources: &self.wrong.sources,
            controls: &self.good.controls,
            chosen: &self.chosen,
            preset: self.preset.as_deref(),
            outputs: &self.good.outputs,
            took: &self.good.took,
            program: None,
            times: None,
        };
        let live = serde_json::to_string(&live)?;
        let page = self.good.page.as_deref().unwrap_or("null");
        let history = self.history.listed()?;
        let json = format!("{{\"live\":{live},\"page\":{page},\"history\":{history}}}").into();
        let mut pictures = (*self.good.pictures).clone();
        pictures.extend(self.history.pictures());
        Ok(PublishedState {
            version: self.version,
            server: Arc::clone(&self.server),
            json,
            pictures: Arc::new(pictures),
            history: Arc::clone(&self.history),
        })
    }

    fn drawn(&mut self) -> Result<GoodFrame, Error> {
        // Both are read before a mistake in either is told: a file that isn't read again counts as changed for ever.
        let (scene, pipeline) = (self.read_scene(), self.read_pipeline());
        scene.and(pipeline)?;
        let (Some(scene), Some(pipeline)) = (&self.scene.value, &mut self.pipeline.value) else {
            return Ok(GoodFrame::default());
        };
        // A setting that the file doesn't have, or no longer, can't be chosen.
        self.chosen.retain(|name, _| pipeline.document.settings.iter().any(|setting| *setting.name.text == **name));
        // A preset that was chosen in the page counts more than a setting of the command line.
        let arguments = self.arguments;
        let mut choices = planning::choices(&arguments.pipeline, arguments.size, arguments.planning.rotate);
        if self.preset.is_some() {
            choices.set.clear();
        }
        choices.set.extend(self.chosen.clone());
        choices.facts = Some(scene.facts());
        drawn(arguments, self.device, scene, (pipeline, &choices), self.version)
    }

    fn read_scene(&mut self) -> Result<(), Error> {
        if self.scene.value.is_none() || self.scene.read.changed() {
            self.scene = FileValue::nothing();
            let drawn = &self.arguments.drawn;
            self.scene.value = Some(inputs::scene(&drawn.scene, drawn.reading.strict, &self.scene.read)?);
        }
        Ok(())
    }

    fn read_pipeline(&mut self) -> Result<(), Error> {
        if self.pipeline.value.is_none() || self.pipeline.read.changed() {
            self.pipeline = FileValue::nothing();
            let mut of_page = self.arguments.pipeline.clone();
            of_page.preset = self.preset.clone().or(of_page.preset);
            let mut loaded = planning::load_with(&of_page, &self.pipeline.read, self.helper.clone());
            // A preset that the file doesn't have any more can't be chosen in the page any more.
            if self.preset.is_some() && loaded.as_ref().is_err_and(|error| error.exit() == Exit::Usage) {
                self.preset = None;
                let of_command_line = &self.arguments.pipeline;
                loaded = planning::load_with(of_command_line, &self.pipeline.read, self.helper.clone());
            }
            self.pipeline.value = Some(loaded?);
        }
        Ok(())
    }
}

/// Whether the command line is wrong, or asks for what the device lacks: no edit mends that.
fn is_about_the_command_line(error: &Error) -> bool {
    error.exit() == Exit::Usage || matches!(error, Error::Stereo { .. })
}

/// Draws a frame, and gathers what the page shows of it.
fn drawn(
    arguments: &ServeArguments,
    device: &Device,
    scene: &Scene,
    (pipeline, choices): (&mut Pipeline, &Choices),
    version: u64,
) -> Result<GoodFrame, Error> {
    let (options, profile) = (arguments.planning.options(), device.profile());
    let planned = pipeline.planned(choices, &profile, &mut device.memory(), &options)?;
    framewright::check_cameras(&planned.plan, Some(&planned.frame), scene)?;
    let mut files = BTreeMap::new();
    let mut kept = |name: String, png: Vec<u8>| {
        files.insert(format!("{version}/{name}"), png.into());
        format!("picture/{version}/{name}")
    };
    let mut outputs = Vec::new();
    let drawn = draw_frames(arguments, device, scene, pipeline, &planned)?;
    for (name, png) in drawn.pictures {
        let picture = kept(format!("{}.png", outputs.len()), png);
        outputs.push(Output { name, picture });
    }
    let mut thumbnails: Vec<Thumbnail> = Vec::new();
    if arguments.capture {
        let (made, frames) = ((&planned.plan, &planned.frame), arguments.frames);
        captures::draw(Drawing { frames, ..Drawing::new(device, pipeline, made, scene, options) }, |captured| {
            let address = kept(format!("{}.png", captured.name()), captured.encoded(FileFormat::Png)?);
            thumbnails.push(captured.small(SMALL).with_file(address));
            Ok(())
        })?;
    } else {
        let to_ask_for = captures::of(&planned.plan, &planned.frame).of_passes;
        thumbnails.extend(to_ask_for.iter().map(Capture::name).map(Thumbnail::to_ask_for));
    }
    let (plan, times) = (&planned.plan, drawn.times);
    let name = arguments.pipeline.file.to_string_lossy();
    let (kept_plan, settings) = (plan.to_json()?.into(), plan.settings.clone());
    let devices = planning::on_other_devices(pipeline, choices, &options, (&*name, plan))?;
    let objects = |list: DrawList| scene.count(list);
    let detail = Detail { objects: Some(&objects), verbose: true };
    let shown =
        ShownPlan { name: name.into_owned(), plan, detail, sources: Some(&pipeline.sources), times: times.as_ref() };
    let page = Page { plans: vec![shown], differences: None, devices: &devices, captures: &thumbnails };
    Ok(GoodFrame {
        version,
        page: Some(framewright_viewer::page_data(&page)?),
        controls: Controls::of(&pipeline.document, plan),
        outputs,
        pictures: Arc::new(files),
        took: totals::sentence(&plan.totals),
        planned: Some(planned),
        captured: BTreeMap::new(),
        plan: kept_plan,
        settings,
        times,
    })
}

/// What was drawn for the page.
struct DrawnFrames {
    /// Every output of the last frame: its name, and its picture as a PNG file.
    pictures: Vec<(String, Vec<u8>)>,
    times: Option<Times>,
}

/// Draws the frames.
fn draw_frames(
    arguments: &ServeArguments,
    device: &Device,
    scene: &Scene,
    pipeline: &mut Pipeline,
    planned: &PlannedFrame,
) -> Result<DrawnFrames, Error> {
    let poison = arguments.planning.poison;
    let options = ExecutorOptions { poison, timestamps: true, ..ExecutorOptions::default() };
    let mut last = LastFrames::on(device);
    let mut prepared = SceneRenderer::new(device, planned.parts(), &mut pipeline.assets, scene, &options)?;
    for drawn in 0..arguments.frames {
        if interrupt::asked() {
            return Err(Error::Interrupted { frames: drawn, wanted: arguments.frames });
        }
        last.add(prepared.draw()?);
    }
    let requests = outputs::of_all_outputs(&planned.plan);
    let encoded = requests.iter().map(|request| {
        let picture = request.encode(&mut prepared.executor, &planned.plan, &text::note_once)?;
        Ok((request.name.to_owned(), picture.contents))
    });
    Ok(DrawnFrames { pictures: encoded.collect::<Result<_, Error>>()?, times: last.times() })
}

fn shown_mistakes(error: &Error) -> ShownMistakes {
    let message = error.shown();
    match error {
        Error::Mistakes { mistakes } => ShownMistakes::placed(message, &mistakes.sources, &mistakes.diagnostics),
        Error::Scene(problem) => match &**problem {
            SceneError::Text { sources, mistakes } => ShownMistakes::placed(message, sources, mistakes),
            _ => ShownMistakes::unplaced(message),
        },
        _ => ShownMistakes::unplaced(message),
    }
}
