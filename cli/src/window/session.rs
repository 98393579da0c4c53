//! What a window shows: a scene through a pipeline, with the choices of the user, frame after frame.

use super::choices;
use super::orbit::Orbit;
use crate::command_line::windows::WindowArguments;
use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::picture::{FileFormat, Picture};
use crate::planning::draws;
use crate::system::{Exit, text};
use framewright::{Presentation, ReadFiles, Renderer, RendererOptions, Scene, SceneDrawSource, Stereo, Swapchain};
use framewright_graph::language::Setting;
use framewright_graph::plan::Resource;
use framewright_graph::vulkan::Rotation;
use framewright_vulkan::{Device, Helper, Surface, SwapchainOptions};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The title of the window is written this often.
const TITLE: Duration = Duration::from_millis(500);
/// Files are looked at this often.
const FILES: Duration = Duration::from_millis(100);
/// Files that change stay as they are for this long before they are read.
const AT_REST: Duration = Duration::from_millis(50);

/// What a window shows.
pub(super) struct Session<'a> {
    arguments: &'a WindowArguments,
    renderer: Renderer,
    scene: Scene,
    scene_read: ReadFiles,
    /// Draws the scene; `None` until it is made for the Plan.
    source: Option<SceneDrawSource>,
    swapchain: Swapchain,
    orbit: Orbit,
    rotation: Rotation,
    stereo: Stereo,
    /// The size of the window, where the surface leaves that to the program.
    size: [u32; 2],
    /// Whether the images no longer fit the window.
    refit: bool,
    /// The setting that keys turn.
    setting: usize,
    /// Values that keys gave to settings since the frame that is shown was planned.
    turned: BTreeMap<String, String>,
    /// The last frame that was shown.
    last: Option<u64>,
    /// How many were shown.
    shown: u32,
    /// Whether the next one is to be written.
    picture_wanted: bool,
    /// What keeps the files from being shown as they are, until they are read again.
    mistake: Option<String>,
    /// What keeps the newest choices from being shown, until a frame is.
    refused: Option<String>,
    looked: Instant,
    title: Title,
}

/// The title of the window, and what it counts.
struct Title {
    since: Instant,
    frames: u32,
    milliseconds: f64,
}

impl<'a> Session<'a> {
    /// Reads pipeline and scene, and makes images for the window.
    ///
    /// # Errors
    /// Those of the files, the command line and the device.
    pub(super) fn new(
        arguments: &'a WindowArguments,
        device: &Device,
        helper: Helper,
        surface: &Surface,
        size: [u32; 2],
    ) -> Result<Session<'a>, Error> {
        let (read, scene_read) = (ReadFiles::default(), ReadFiles::default());
        // Says that it is a shipped one.
        drop(inputs::pipeline(&arguments.pipeline, &read)?);
        let scene = inputs::scene(&arguments.scene, &scene_read)?;
        let mut options = RendererOptions::default();
        options.files = inputs::options(&arguments.pipeline);
        options.settings.clone_from(&arguments.pipeline.settings);
        options.draws = draws(&arguments.pipeline, &read)?;
        options.helper = Some(helper);
        options.compile = arguments.planning.options();
        options.executor.poison = arguments.planning.poison;
        options.executor.frames_in_flight = 2;
        options.executor.timestamps = true;
        options.executor.readback = true;
        let mut renderer = Renderer::open(device, &arguments.pipeline.file, options)?;
        let of_command_line = |error: framewright::Error| match Error::from(error) {
            Error::Mistakes { mut mistakes } => {
                mistakes.exit = Exit::Usage;
                Error::Mistakes { mistakes }
            }
            other => other,
        };
        if arguments.pipeline.preset.is_some() {
            renderer.preset(arguments.pipeline.preset.as_deref()).map_err(of_command_line)?;
        }
        for one in &arguments.pipeline.set {
            renderer.set(&one.name, &one.value).map_err(of_command_line)?;
        }
        renderer.set_scene(&scene);
        let stereo = Stereo::first_fit(&arguments.pipeline.stereo.0, &device.profile());
        let stereo = stereo.map_err(|why| Error::Stereo { why })?;
        let swapchain = SwapchainOptions { extent: size, turned: true, ..SwapchainOptions::default() };
        let mut session = Session {
            arguments,
            orbit: Orbit::new(&scene),
            scene,
            scene_read,
            source: None,
            swapchain: Swapchain::new(surface, &swapchain)?,
            rotation: arguments.planning.rotate,
            stereo,
            size,
            refit: false,
            setting: 0,
            turned: BTreeMap::new(),
            last: None,
            shown: 0,
            picture_wanted: false,
            mistake: None,
            refused: None,
            looked: Instant::now(),
            title: Title { since: Instant::now(), frames: 0, milliseconds: 0.0 },
            renderer,
        };
        session.fit()?;
        // A pipeline that is wrong to begin with is no reason for a window.
        session.prepare()?;
        Ok(session)
    }

    /// Draws and shows a frame. Returns whether the window has an area.
    ///
    /// # Errors
    /// Those of the device and of the window, which no change to a file mends.
    pub(super) fn frame(&mut self) -> Result<bool, Error> {
        if self.refit {
            if !self.swapchain.resize(self.size)? {
                return Ok(false);
            }
            self.refit = false;
            let fitted = self.fit();
            self.note(fitted)?;
        }
        self.follow_files()?;
        let prepared = self.prepare();
        self.note(prepared)?;
        let Some(source) = &mut self.source else { return Ok(false) };
        source.set_camera(self.orbit.camera())?;
        match self.renderer.present(source, &mut self.swapchain) {
            Ok(Presentation::Shown(frame)) => self.count(frame)?,
            Ok(Presentation::Suboptimal(frame)) => {
                self.count(frame)?;
                self.refit = true;
            }
            Ok(Presentation::OutOfDate) => self.refit = true,
            Ok(_) => {
                self.refit = true;
                return Ok(false);
            }
            // The last good frame has another size or form than the window has now.
            Err(framewright::Error::Vulkan(error @ framewright_vulkan::Error::BadResource { .. }))
                if self.shown > 0 =>
            {
                self.note(Err(error.into()))?;
                return Ok(false);
            }
            Err(error) => return Err(error.into()),
        }
        Ok(true)
    }

    /// Fits the frame to the window's images.
    fn fit(&mut self) -> Result<(), Error> {
        let Some(extent) = self.swapchain.extent() else { return Ok(()) };
        // A preview: the window isn't turned, and shows the picture as a turned screen would be given it.
        let [width, height] = self.rotation.extent(extent);
        let two = self.stereo != Stereo::Off;
        if two && width % 2 == 1 {
            text::say("note: a picture of an odd width can't be halved for two eyes: one is shown");
        }
        let two = two && width.is_multiple_of(2);
        self.renderer.set_stereo(if two { self.stereo } else { Stereo::Off })?;
        self.renderer.fit(&self.swapchain)?;
        if self.rotation.turns() {
            self.renderer.set_extent([if two { width / 2 } else { width }, height])?;
            self.renderer.set_rotation(self.rotation);
        }
        Ok(())
    }

    /// Plans what changed, and has the scene drawn by it.
    fn prepare(&mut self) -> Result<(), Error> {
        use framewright::Change;
        let device = self.renderer.device().clone();
        // They are in the Plan now, or were refused.
        self.turned.clear();
        let framewright::Prepared { plan, change, .. } = self.renderer.prepare()?;
        match (&mut self.source, change) {
            (Some(_), Change::Nothing) => {}
            (Some(source), Change::Values) => source.change(plan)?,
            (source, _) => {
                let mut made = SceneDrawSource::for_plan(&device, &self.scene, plan.extent, plan)?;
                made.set_camera(self.orbit.camera())?;
                (*source, self.last) = (Some(made), None);
            }
        }
        Ok(())
    }

    /// Keeps what another choice can mend, and says it once. The last good frame stays.
    fn note(&mut self, result: Result<(), Error>) -> Result<(), Error> {
        keep(result, &mut self.refused)
    }

    /// Reads files anew that have changed.
    fn follow_files(&mut self) -> Result<(), Error> {
        if self.looked.elapsed() < FILES {
            return Ok(());
        }
        self.looked = Instant::now();
        if self.renderer.files_changed() {
            std::thread::sleep(AT_REST);
            let reloaded = self.renderer.reload().map_err(Error::from);
            // What was chosen while the file was wrong counts again.
            let reloaded = reloaded.and_then(|_| {
                self.source = None;
                self.renderer.set_scene(&self.scene);
                self.fit()
            });
            let fine = reloaded.is_ok();
            keep(reloaded, &mut self.mistake)?;
            if fine {
                self.mistake = None;
                text::say(&format!("`{}` is drawn as it is now", text::path(&self.arguments.pipeline.file)));
            }
        }
        if self.scene_read.changed() {
            std::thread::sleep(AT_REST);
            self.scene_read = ReadFiles::default();
            let read = inputs::scene(&self.arguments.scene, &self.scene_read);
            let read = read.map(|scene| {
                self.renderer.set_scene(&scene);
                self.orbit.follow(&scene);
                (self.scene, self.source) = (scene, None);
            });
            if read.is_ok() {
                self.mistake = None;
            }
            keep(read, &mut self.mistake)?;
        }
        Ok(())
    }

    fn count(&mut self, frame: u64) -> Result<(), Error> {
        (self.last, self.shown) = (Some(frame), self.shown.saturating_add(1));
        self.refused = None;
        self.title.frames += 1;
        // The frame before is done, or nearly: nothing waits for the one that was just begun.
        if let Some(before) = frame.checked_sub(1)
            && let Ok(report) = self.renderer.report(before)
        {
            self.title.milliseconds = report.milliseconds;
        }
        if std::mem::take(&mut self.picture_wanted) { self.write_by_a_free_name() } else { Ok(()) }
    }

    /// How many frames were shown.
    pub(super) fn shown(&self) -> u32 {
        self.shown
    }

    /// The title of the window, if it is time for another.
    pub(super) fn title(&mut self) -> Option<String> {
        let elapsed = self.title.since.elapsed();
        if elapsed < TITLE {
            return None;
        }
        let each_second = f64::from(self.title.frames) / elapsed.as_secs_f64();
        (self.title.since, self.title.frames) = (Instant::now(), 0);
        let name = self.arguments.pipeline.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let [width, height] = self.swapchain.extent().unwrap_or_default();
        let milliseconds = self.title.milliseconds;
        let setting = self.setting().map(|(setting, value)| format!(" · {} = {value}", setting.name.text));
        let setting = setting.unwrap_or_default();
        let wrong = if self.mistake.is_some() || self.refused.is_some() {
            " · the last good frame is shown: see the terminal"
        } else {
            ""
        };
        let title =
            format!("{name} · {width}×{height} · {milliseconds:.1} ms · {each_second:.0} frames/s{setting}{wrong}");
        Some(text::escape(&title))
    }

    /// The window has another size.
    pub(super) fn resized(&mut self, size: [u32; 2]) {
        (self.size, self.refit) = (size, true);
    }

    /// The camera that the mouse moves.
    pub(super) fn orbit(&mut self) -> &mut Orbit {
        &mut self.orbit
    }

    /// Chooses the next setting for keys to turn, or the one before, and says which.
    pub(super) fn choose_setting(&mut self, forwards: bool) {
        let count = self.renderer.document().settings.len();
        if count > 0 {
            self.setting = (self.setting.min(count - 1) + if forwards { 1 } else { count - 1 }) % count;
        }
        if let Some((setting, value)) = self.setting() {
            let about = setting.about.as_ref().map_or_else(String::new, |about| format!(": {about}"));
            let line = format!("{} = {value}{about} ({})", setting.name.text, setting.kind.allowed());
            text::say(&text::escape(&line));
        }
    }

    /// Gives the setting its next value, or the one before.
    ///
    /// # Errors
    /// Those of [`Session::frame`].
    pub(super) fn turn_setting(&mut self, forwards: bool) -> Result<(), Error> {
        let Some((setting, value)) = self.setting() else { return Ok(()) };
        let (name, next) = (setting.name.text.to_string(), choices::next(setting, value, forwards));
        let Some(next) = next else { return Ok(()) };
        let set = self.renderer.set(&name, &next).map_err(Error::from);
        if set.is_ok() {
            text::say(&text::escape(&format!("{name} = {next}")));
            self.turned.insert(name, next);
        }
        self.note(set)
    }

    /// The setting that keys turn, and its value: in the next frame, or in the one that is shown.
    fn setting(&self) -> Option<(&Setting, &str)> {
        let settings = &self.renderer.document().settings;
        let setting = settings.get(self.setting.min(settings.len().checked_sub(1)?))?;
        if let Some(value) = self.turned.get(&*setting.name.text) {
            return Some((setting, value));
        }
        let used = &self.renderer.plan()?.settings;
        let used = used.iter().find(|used| *used.name == *setting.name.text)?;
        Some((setting, &used.value))
    }

    /// Shows one eye's picture, or both beside each other.
    ///
    /// # Errors
    /// Those of [`Session::frame`].
    pub(super) fn turn_eyes(&mut self) -> Result<(), Error> {
        self.stereo = if self.stereo == Stereo::Off { Stereo::DoubleWide } else { Stereo::Off };
        let mut fitted = self.fit().and_then(|()| self.prepare());
        if self.stereo != Stereo::Off && fitted.is_ok() && !self.shows_two_eyes() {
            text::say("note: the first output has no picture for each eye: one is shown");
            self.stereo = Stereo::Off;
            fitted = self.fit();
        } else if fitted.is_ok() {
            text::say(if self.stereo == Stereo::Off { "one eye" } else { "both eyes beside each other" });
        }
        self.note(fitted)
    }

    /// Whether the first output has the pictures of both eyes beside each other.
    fn shows_two_eyes(&self) -> bool {
        let plan = self.renderer.plan();
        let output = plan.and_then(|plan| Some((plan, plan.outputs.first()?.resource)));
        matches!(output, Some((plan, Resource::Image(image))) if plan.image(image).eyes.is_some())
    }

    /// Turns the picture by a quarter, as screens that are mounted turned are given it.
    ///
    /// # Errors
    /// Those of [`Session::frame`].
    pub(super) fn turn_screen(&mut self) -> Result<(), Error> {
        let at = Rotation::ALL.iter().position(|rotation| *rotation == self.rotation).unwrap_or(0);
        self.rotation = Rotation::ALL[(at + 1) % Rotation::ALL.len()];
        text::say(&format!("rotated by {}°", self.rotation.degrees()));
        let fitted = self.fit();
        self.note(fitted)
    }

    /// Has the next frame that is shown written beside where the command was called.
    pub(super) fn take_picture(&mut self) {
        self.picture_wanted = true;
    }

    /// Writes the picture that was shown last, by a name that is free.
    fn write_by_a_free_name(&mut self) -> Result<(), Error> {
        let stem = self.arguments.pipeline.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut names = (1..1000).map(|number| PathBuf::from(format!("{stem}-{number:03}.png")));
        if let (Some(path), Some(picture)) = (names.find(|path| !path.exists()), self.picture()?) {
            match outputs::write_new(&path, &picture) {
                Ok(()) => text::say(&format!("wrote `{}`", text::path(&path))),
                Err(error) => text::say(&error.shown()),
            }
        }
        Ok(())
    }

    /// Writes the picture that was shown last.
    ///
    /// # Errors
    /// Those of [`Session::picture`], and of the disk.
    pub(super) fn write(&mut self, path: &Path) -> Result<(), Error> {
        match self.picture()? {
            Some(picture) => outputs::write(&[(path, &picture)], &self.scene_read),
            None => Ok(()),
        }
    }

    /// The picture that was shown last, as a PNG file, upright.
    fn picture(&mut self) -> Result<Option<Vec<u8>>, Error> {
        let (Some(frame), Some(plan)) = (self.last, self.renderer.plan()) else { return Ok(None) };
        let Some(output) = plan.outputs.first() else { return Ok(None) };
        let (name, encoding) = (output.name.to_string(), output.encoding);
        let texels = self.renderer.read_back(frame, &name)?;
        let [width, height, _] = texels.extent;
        let picture = Picture { format: texels.format, encoding, extent: [width, height], bytes: &texels.bytes };
        let encoded = FileFormat::Png.encode(&picture);
        encoded.map(Some).map_err(|problem| Error::Picture { image: name, problem })
    }
}

/// Keeps an error that a change to a file or another choice can mend, and says it, unless it was said last.
fn keep(result: Result<(), Error>, kept: &mut Option<String>) -> Result<(), Error> {
    match result {
        Err(error) if error.can_be_mended_in_files() => {
            let shown = error.shown();
            if kept.as_ref() != Some(&shown) {
                text::say(&shown);
                *kept = Some(shown);
            }
            Ok(())
        }
        other => other,
    }
}
