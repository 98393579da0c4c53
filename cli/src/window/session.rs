//! What a window shows: a scene through a pipeline, with the choices of the user, frame after frame.

use super::chosen_setting::ChosenSetting;
use super::followed_files::FollowedFiles;
use super::list::{Contents, List, NoObjects};
use super::orbit::Orbit;
use super::pace::{Pace, Speed};
use super::problems::Problems;
use super::view::View;
use super::{opening, pictures, view};
use crate::command_line::windows::WindowArguments;
use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::system::text;
use framewright::{Presentation, ReadFiles, Renderer, Scene, SceneDrawSource, Stereo, Swapchain};
use framewright_vulkan::{Device, Helper, Surface, SwapchainOptions};
use std::path::Path;

/// What a window shows.
pub(super) struct Session<'a> {
    arguments: &'a WindowArguments,
    renderer: Renderer,
    scene: Scene,
    /// Draws the scene; `None` until it is made for the Plan.
    source: Option<SceneDrawSource>,
    swapchain: Swapchain,
    orbit: Orbit,
    view: View,
    /// The size of the window, where the surface leaves that to the program.
    size: [u32; 2],
    /// Whether the images no longer fit the window.
    refit: bool,
    chosen: ChosenSetting,
    /// The last frame that was shown.
    last: Option<u64>,
    /// How many were shown.
    shown: u32,
    /// Whether the next one is to be written.
    picture_wanted: bool,
    problems: Problems,
    following: FollowedFiles,
    pace: Pace,
    /// The speed that was told last.
    speed: Option<Speed>,
    list: List,
    /// Pixels of the screen for one of a usual screen, along each side.
    scale: f64,
}

/// What became of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FrameOutcome {
    /// It was shown.
    Shown,
    /// The window's images were no longer right.
    OutOfDate,
    /// There is nothing to draw, or nothing to draw into.
    Nothing,
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
        let scene_read = ReadFiles::default();
        let mut renderer = opening::renderer(arguments, device, helper.clone())?;
        let scene = inputs::scene(&arguments.drawn.scene, arguments.drawn.reading.strict, &scene_read)?;
        renderer.set_scene(&scene);
        let stereo = Stereo::first_fit(&arguments.pipeline.stereo.0, &device.profile());
        let stereo = stereo.map_err(|why| Error::Stereo { why })?;
        let swapchain = SwapchainOptions { extent: size, turned: true, ..SwapchainOptions::default() };
        let mut session = Session {
            arguments,
            orbit: Orbit::new(&scene),
            scene,
            source: None,
            swapchain: Swapchain::new(surface, &swapchain)?,
            view: View::new(arguments.planning.rotate, stereo),
            size,
            refit: false,
            chosen: ChosenSetting::default(),
            last: None,
            shown: 0,
            picture_wanted: false,
            problems: Problems::default(),
            following: FollowedFiles::new(scene_read),
            pace: Pace::new(),
            speed: None,
            list: List::new(arguments.list, opening::list_options(arguments, helper)),
            scale: 1.0,
            renderer,
        };
        session.fit()?;
        // A pipeline that is wrong to begin with is no reason for a window.
        session.prepare()?;
        Ok(session)
    }

    /// Draws and shows a frame. `before_shown` is called when it is drawn and not yet shown.
    ///
    /// # Errors
    /// Those of the device and of the window, which no change to a file mends.
    pub(super) fn frame(&mut self, before_shown: impl FnOnce()) -> Result<FrameOutcome, Error> {
        if self.refit {
            if !self.swapchain.resize(self.size)? {
                return Ok(FrameOutcome::Nothing);
            }
            self.refit = false;
            let fitted = self.fit();
            self.problems.refuse(fitted)?;
            self.list.changed();
        }
        self.follow_files()?;
        let prepared = self.prepare();
        self.problems.refuse(prepared)?;
        if self.list.is_due() {
            self.show_list()?;
        }
        let Some(source) = &mut self.source else { return Ok(FrameOutcome::Nothing) };
        source.set_camera(self.orbit.camera())?;
        before_shown();
        let presented = match self.list.renderer() {
            Some(list) => self.renderer.present_with_overlay(source, &mut self.swapchain, list, &mut NoObjects),
            None => self.renderer.present(source, &mut self.swapchain),
        };
        match presented {
            Ok(Presentation::Shown(frame)) => self.count(frame)?,
            Ok(Presentation::Suboptimal(frame)) => {
                self.count(frame)?;
                self.refit = true;
            }
            Ok(Presentation::OutOfDate) => {
                self.refit = true;
                return Ok(FrameOutcome::OutOfDate);
            }
            Ok(_) => {
                self.refit = true;
                return Ok(FrameOutcome::Nothing);
            }
            // The last good frame has another size or form than the window has now.
            Err(framewright::Error::Vulkan(error @ framewright_vulkan::Error::BadResource { .. }))
                if self.shown > 0 =>
            {
                self.problems.refuse(Err(error.into()))?;
                return Ok(FrameOutcome::Nothing);
            }
            Err(error) => return Err(error.into()),
        }
        Ok(FrameOutcome::Shown)
    }

    /// Fits the frame to the window's images.
    fn fit(&mut self) -> Result<(), Error> {
        self.view.fit(&mut self.renderer, &self.swapchain)
    }

    /// Plans what changed, and has the scene drawn by it.
    fn prepare(&mut self) -> Result<(), Error> {
        use framewright::Change;
        let device = self.renderer.device().clone();
        self.chosen.planned();
        let framewright::PreparedFrame { plan, change, .. } = self.renderer.prepare()?;
        match (&mut self.source, change) {
            (Some(_), Change::Nothing) => {}
            (Some(source), Change::Values) => source.change(plan)?,
            (source, _) => {
                let mut made = SceneDrawSource::for_plan(&device, &self.scene, plan.extent, plan)?;
                made.set_camera(self.orbit.camera())?;
                (*source, self.last) = (Some(made), None);
                self.list.replanned();
            }
        }
        Ok(())
    }

    /// Reads files anew that have changed.
    fn follow_files(&mut self) -> Result<(), Error> {
        if !self.following.is_due() {
            return Ok(());
        }
        if let Some(reloaded) = self.following.pipeline(&mut self.renderer) {
            // What was chosen while the file was wrong counts again.
            let reloaded = reloaded.and_then(|()| {
                self.source = None;
                self.renderer.set_scene(&self.scene);
                self.fit()
            });
            let fine = reloaded.is_ok();
            self.problems.mistake(reloaded)?;
            if fine {
                self.problems.mended();
                text::say(&format!("`{}` is drawn as it is now", text::path(&self.arguments.pipeline.file)));
            }
        }
        let drawn = &self.arguments.drawn;
        if let Some(read) = self.following.scene(&drawn.scene, drawn.reading.strict) {
            let read = read.map(|scene| {
                self.renderer.set_scene(&scene);
                self.orbit.follow(&scene);
                (self.scene, self.source) = (scene, None);
            });
            if read.is_ok() {
                self.problems.mended();
            }
            self.problems.mistake(read)?;
        }
        Ok(())
    }

    fn count(&mut self, frame: u64) -> Result<(), Error> {
        (self.last, self.shown) = (Some(frame), self.shown.saturating_add(1));
        self.pace.count();
        // The frame before is done, or nearly: nothing waits for the one that was just begun.
        if let Some(before) = frame.checked_sub(1)
            && let Ok(report) = self.renderer.report(before)
        {
            self.pace.took(report.milliseconds);
            self.list.took(report);
        }
        if std::mem::take(&mut self.picture_wanted)
            && let Some(picture) = self.picture()?
        {
            pictures::write_by_a_free_name(&self.arguments.pipeline.file, &picture);
        }
        Ok(())
    }

    /// How many frames were shown.
    pub(super) fn shown(&self) -> u32 {
        self.shown
    }

    /// The title of the window, if it is time for another.
    pub(super) fn title(&mut self) -> Option<String> {
        let speed = self.pace.told()?;
        self.speed = Some(speed);
        let name = pictures::name(&self.arguments.pipeline.file);
        let [width, height] = self.swapchain.extent().unwrap_or_default();
        let setting = self.chosen.setting(&self.renderer);
        let setting = setting.map(|(setting, value)| format!(" · {} = {value}", setting.name.text)).unwrap_or_default();
        let wrong = match self.problems.first() {
            Some(_) => " · the last good frame is shown: see the terminal",
            None => "",
        };
        let Speed { milliseconds, each_second } = speed;
        let title =
            format!("{name} · {width}×{height} · {milliseconds:.1} ms · {each_second:.0} frames/s{setting}{wrong}");
        Some(text::escape(&title))
    }

    /// Makes the list anew.
    fn show_list(&mut self) -> Result<(), Error> {
        let (Some(extent), Some(plan)) = (self.swapchain.extent(), self.renderer.plan()) else { return Ok(()) };
        let name = pictures::name(&self.arguments.pipeline.file);
        let (wrong, times) = (self.problems.first(), self.list.times(plan));
        let contents = Contents::of(&name, extent, &self.renderer, &self.chosen, self.speed, wrong, times);
        match self.list.show(&contents, self.scale, self.renderer.device(), &self.swapchain) {
            // Shaders of the list that can't be compiled are no reason to end: the picture needs none of them.
            Err(error) if error.can_be_mended_in_files() => {
                text::say(&format!("note: the list can't be shown\n{}", error.shown()));
                self.list.turn();
                Ok(())
            }
            shown => shown,
        }
    }

    /// Shows the list of settings and times, or takes it away.
    pub(super) fn turn_list(&mut self) {
        self.list.turn();
    }

    /// The screen has another scale factor.
    pub(super) fn rescaled(&mut self, scale: f64) {
        self.scale = scale;
        self.list.changed();
    }

    /// The window has another size.
    pub(super) fn resized(&mut self, size: [u32; 2]) {
        self.problems.choices_changed();
        (self.size, self.refit) = (size, true);
    }

    /// The camera that the mouse moves.
    pub(super) fn orbit(&mut self) -> &mut Orbit {
        &mut self.orbit
    }

    /// Chooses the next setting for keys to turn, or the one before, and says which.
    pub(super) fn choose_setting(&mut self, forwards: bool) {
        self.chosen.choose(&self.renderer, forwards);
        self.list.changed();
    }

    /// Gives the setting its next value, or the one before.
    ///
    /// # Errors
    /// Those of [`Session::frame`].
    pub(super) fn turn_setting(&mut self, forwards: bool) -> Result<(), Error> {
        self.problems.choices_changed();
        let turned = self.chosen.turn(&mut self.renderer, forwards);
        self.list.changed();
        self.problems.refuse(turned)
    }

    /// Shows one eye's picture, or both beside each other.
    ///
    /// # Errors
    /// Those of [`Session::frame`].
    pub(super) fn turn_eyes(&mut self) -> Result<(), Error> {
        self.problems.choices_changed();
        self.list.changed();
        self.view.turn_eyes();
        let mut fitted = self.fit().and_then(|()| self.prepare());
        if self.view.wants_two_eyes() && fitted.is_ok() && !self.renderer.plan().is_some_and(view::shows_two_eyes) {
            text::say("note: the first output has no picture for each eye: one is shown");
            self.view.turn_eyes();
            fitted = self.fit();
        } else if fitted.is_ok() {
            text::say(if self.view.wants_two_eyes() { "both eyes beside each other" } else { "one eye" });
        }
        self.problems.refuse(fitted)
    }

    /// Turns the picture by a quarter, as screens that are mounted turned are given it.
    ///
    /// # Errors
    /// Those of [`Session::frame`].
    pub(super) fn turn_screen(&mut self) -> Result<(), Error> {
        self.problems.choices_changed();
        self.list.changed();
        self.view.turn_screen();
        let fitted = self.fit();
        self.problems.refuse(fitted)
    }

    /// Has the next frame that is shown written beside where the command was called.
    pub(super) fn take_picture(&mut self) {
        self.picture_wanted = true;
    }

    /// Writes the picture that was shown last.
    ///
    /// # Errors
    /// Those of the device and of the disk.
    pub(super) fn write(&mut self, path: &Path) -> Result<(), Error> {
        match self.picture()? {
            Some(picture) => outputs::write(&[(path, &picture)], self.following.scene_files()),
            None => Ok(()),
        }
    }

    /// The picture that was shown last, as a PNG file, upright.
    fn picture(&mut self) -> Result<Option<Vec<u8>>, Error> {
        self.last.map_or(Ok(None), |frame| pictures::encoded(&mut self.renderer, frame))
    }
}
