//! Executing a Plan, frame by frame.

use super::frame_runs::FrameRuns;
use super::frame_slot::FrameExtras;
use super::frames::Frames;
use super::import::Import;
use super::initial_contents::initialise;
use super::options::ExecutorOptions;
use super::output_readback::OutputReadback;
use super::ownership::Ownership;
use super::retired::Retired;
use super::submission::{SemaphorePoint, Submission};
use crate::base::{Error, span};
use crate::gpu::{Device, Gpu, PipelineHold, ScopeFormats};
use crate::prepare::{Frame, PreparedPlan, Refusals, ResourceUses, StagedTexture, check, stage_textures};
use crate::record::{DrawSource, FrameReport, GuardedSource};
use crate::resources::{ProgramSets, RawSet};
use crate::shaders::ShaderLibrary;
use ash::vk;
use framewright_graph::frame::{EyeForm, NoTextures, Stereo, Textures};
use framewright_graph::plan::{BufferId, Plan};
use framewright_graph::vulkan::OutsideOwner;
use std::any::Any;
use std::sync::Arc;

/// A Plan on a device, ready to draw frames.
///
/// [`Executor::frame`] draws one and waits for it. [`Executor::submit`] and [`Executor::wait`] let several be on their way;
/// the pictures are the same.
pub struct Executor {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) plan: Plan,
    /// The number of its first frame.
    pub(super) first_frame: u64,
    pub(super) imports: Vec<Import>,
    readbacks: Vec<OutputReadback>,
    /// The sets that the program binds for all passes.
    pub(super) sets: ProgramSets,
    pub(crate) uses: ResourceUses,
    /// Before what it uses: dropping it waits for every frame.
    pub(crate) frames: Frames,
    pub(crate) prepared: PreparedPlan,
    /// What the program imported before, while frames may use it.
    pub(super) retired: Retired,
    /// What imported images belong to, by the name of the image. Dropped after the frames, and the views of the images.
    pub(crate) owners: Vec<(String, Arc<dyn Any + Send + Sync>)>,
    /// Buffers of the program's that frames use in turn, and how many there are for each.
    pub(super) in_turn: Vec<(BufferId, usize)>,
    /// Images and buffers of the program's that the executors before this one had, and that this one wasn't given yet.
    pub(super) missing: Vec<String>,
    /// Who has images and buffers of the program's that executors before this one had, and that this Plan doesn't know, by name.
    pub(super) elsewhere: Vec<(String, Ownership)>,
    /// The outside owners that the program has told, by name.
    pub(super) told: Vec<(String, Option<OutsideOwner>)>,
    /// Dropped after the frames and all that they use: it may destroy pipelines.
    _pipelines: PipelineHold,
    /// Texels from files, until they are uploaded.
    staged: Vec<StagedTexture>,
    pub(crate) initialised: bool,
    /// Which steps of the next frame run.
    pub(super) runs: FrameRuns,
}

impl Executor {
    /// Makes everything that `plan` needs on `device`: memory, images, buffers, pipelines, descriptor sets.
    ///
    /// # Errors
    /// [`Error::Violations`] if the Plan is wrong in itself, [`Error::BadPlan`] or [`Error::OtherMemoryNeeds`] if this
    /// device can't execute it as it is, [`Error::Shader`] and [`Error::Mismatch`] for shaders, [`Error::OutOfMemory`].
    pub fn new(
        device: &Device,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        options: &ExecutorOptions,
    ) -> Result<Executor, Error> {
        Executor::checked(device, plan, shaders, &mut NoTextures, options, Refusals::Violations)
    }

    /// Like [`Executor::new`], for a Plan that has images from files: their texels are read here, and uploaded before the
    /// first frame.
    ///
    /// # Errors
    /// Those of [`Executor::new`], and [`Error::Texture`].
    pub fn with_textures(
        device: &Device,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        textures: &mut dyn Textures,
        options: &ExecutorOptions,
    ) -> Result<Executor, Error> {
        Executor::checked(device, plan, shaders, textures, options, Refusals::Violations)
    }

    /// Like [`Executor::new`], but hazards in the Plan pass, to see what the validation layer or the poison says of them.
    ///
    /// # Errors
    /// Those of [`Executor::new`]; [`Error::Violations`] only for what is malformed.
    ///
    /// # Safety
    /// Missing barriers, wrong layouts and images that lie over each other are undefined behaviour on the device: either
    /// the Plan has none, or the device is a software driver that executes commands in order.
    pub unsafe fn with_hazards(
        device: &Device,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        options: &ExecutorOptions,
    ) -> Result<Executor, Error> {
        Executor::checked(device, plan, shaders, &mut NoTextures, options, Refusals::Malformed)
    }

    fn checked(
        device: &Device,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        textures: &mut dyn Textures,
        options: &ExecutorOptions,
        refuse: Refusals,
    ) -> Result<Executor, Error> {
        span!("prepare");
        let gpu = &device.gpu;
        check(gpu, plan, refuse, options.poison)?;
        let uses = ResourceUses::new(plan);
        let imports = Import::all(plan, &uses);
        // From here on no pipeline that `prepared` takes is destroyed.
        let pipelines = PipelineHold::new(gpu);
        Ok(Executor {
            gpu: gpu.clone(),
            readbacks: if options.readback { OutputReadback::all(plan, &uses)? } else { Vec::new() },
            frames: Frames::new(gpu, plan, &imports, options)?,
            prepared: PreparedPlan::new(gpu, plan, shaders, options.preparation())?,
            retired: Retired::default(),
            sets: ProgramSets::new(shaders.draws().sets()),
            owners: Vec::new(),
            in_turn: Vec::new(),
            missing: Vec::new(),
            elsewhere: Vec::new(),
            told: Vec::new(),
            _pipelines: pipelines,
            plan: plan.clone(),
            first_frame: 0,
            imports,
            uses,
            staged: stage_textures(gpu, plan, textures)?,
            initialised: false,
            runs: FrameRuns::default(),
        })
    }

    /// Draws a frame, waits until the device is done, and returns the frame's number.
    ///
    /// # Errors
    /// Those of [`Executor::submit`] and [`Executor::wait`].
    pub fn frame(&mut self, source: &mut dyn DrawSource) -> Result<u64, Error> {
        let frame = self.submit(source)?;
        self.wait(frame)?;
        Ok(frame)
    }

    /// Records and submits a frame, and returns its number: from 0, or from where those stopped that it
    /// [goes on from](Executor::migrate_from). If as many frames as may be are on their way, it waits
    /// for the oldest first.
    ///
    /// # Errors
    /// The errors of `source`, [`Error::Recording`] if it misused its recorder or panicked, [`Error::NotImported`],
    /// [`Error::OutOfMemory`], [`Error::DeviceLost`], [`Error::Timeout`].
    pub fn submit(&mut self, source: &mut dyn DrawSource) -> Result<u64, Error> {
        let number = self.next_frame(&[])?;
        let (frames, frame, prepared, extras) = self.parts(number);
        frames.submit(&frame, prepared, &mut GuardedSource(source), &extras, &Submission::default())?;
        self.drawn(number);
        Ok(self.first_frame + number)
    }

    /// Like [`Executor::submit`], among the program's own work: the frame waits for semaphores of the program's, signals others,
    /// and uses the images that are chosen for it. The device is never waited for, except for the oldest frame on its way.
    ///
    /// # Errors
    /// Those of [`Executor::submit`]; [`Error::BadResource`] if there is no such image. After an error nothing was waited for and
    /// nothing will be signalled, unless the device was lost or given up: a part of the frame may be on its way then, and each later
    /// frame is [`Error::DeviceLost`].
    ///
    /// # Safety
    /// The semaphores must be of this executor's device, be in the state that Vulkan demands of what is waited for or signalled,
    /// and live until the frame was waited for. The stages of a wait must hold the first stage in which the frame uses what is waited
    /// for: the first barrier of an image that comes as `Present` waits there, and `ALL_COMMANDS` always fits. The images must be in the state `before` of [`Executor::external_states`] when
    /// the waits are over. After the frame they are in the state `after`.
    pub unsafe fn submit_with(&mut self, source: &mut dyn DrawSource, among: &Submission<'_>) -> Result<u64, Error> {
        let number = self.next_frame(among.images)?;
        let (frames, frame, prepared, extras) = self.parts(number);
        frames.submit(&frame, prepared, &mut GuardedSource(source), &extras, among)?;
        self.drawn(number);
        Ok(self.first_frame + number)
    }

    /// Records a frame into a command buffer of the program's, which the program submits itself, and returns the frame's number.
    /// `images` are those of [`Submission::images`]. `done` is a timeline semaphore and the value that the program has it signalled
    /// with when the commands are done: [`Executor::wait`] waits for that, and so do later frames that take this one's place.
    ///
    /// The commands find and leave external images and buffers in their [`Executor::external_states`]. They change all state of
    /// the command buffer (pipelines, descriptor sets, dynamic state). Before the first frame, contents that the Plan begins with
    /// are made by a submission to the graphics queue, which is waited for.
    ///
    /// # Errors
    /// Those of [`Executor::submit_with`]; [`Error::BadPlan`] if the Plan uses another queue than the one for graphics. After an
    /// error the command buffer must not be submitted.
    ///
    /// # Safety
    /// The command buffer must be of this executor's device, of the family of its graphics queue, primary, recording, and outside
    /// of a rendering scope. It must be submitted once, to the graphics queue, after the frames before this one and before later ones, and `done` must
    /// then be signalled; or it must be given to [`Executor::discard`]. Semaphore and command buffer must live until the frame was waited for. The promises on images are those
    /// of [`Executor::submit_with`].
    pub unsafe fn record_into(
        &mut self,
        commands: vk::CommandBuffer,
        done: SemaphorePoint,
        images: &[(&str, usize)],
        source: &mut dyn DrawSource,
    ) -> Result<u64, Error> {
        let number = self.next_frame(images)?;
        let (frames, frame, prepared, extras) = self.parts(number);
        frames.record_into((commands, done), &frame, prepared, &mut GuardedSource(source), &extras)?;
        self.drawn(number);
        Ok(self.first_frame + number)
    }

    /// How many frames were submitted, or recorded for the program to submit: by this executor, and by those that it
    /// [goes on from](Executor::migrate_from). It is the number of the next one.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.first_frame + self.frames.next()
    }

    /// The oldest frame of this executor whose place no later one has taken: the frame that takes its place waits for it. `None` before
    /// the first.
    #[must_use]
    pub fn oldest_frame(&self) -> Option<u64> {
        let next = self.frames.next();
        let held = (0..next).rev().take_while(|frame| self.frames.holds(*frame)).last();
        held.map(|frame| self.first_frame + frame)
    }

    /// Takes back a frame that [`Executor::record_into`] recorded and that the program never submitted: nothing waits for it. What it
    /// was to leave for later frames isn't there: all steps run in the next frame.
    ///
    /// # Safety
    /// Its command buffer must never have been submitted, and must not be.
    pub unsafe fn discard(&mut self, frame: u64) {
        if let Some(own) = frame.checked_sub(self.first_frame) {
            self.frames.discard(own);
            self.runs.run_all();
            self.imports.iter_mut().for_each(|it| it.ownership.discard(frame));
        }
    }

    /// Says that what passes with `run: WhenDirty("name")` write is out of date: they run in the next frame. A name stays dirty until a
    /// frame was submitted, or recorded for the program to submit.
    ///
    /// # Errors
    /// [`Error::BadResource`] if no pass of the Plan waits for this name.
    pub fn set_dirty(&mut self, name: &str) -> Result<(), Error> {
        self.runs.set_dirty(&self.plan, name)
    }

    /// Has all passes run in the next frame, as in the first one, also those that run once.
    pub fn run_all(&mut self) {
        self.runs.run_all();
    }

    /// Gives the next frame a number of the program's: passes that run every few frames go by it, and it is `frame` in parameters.
    /// Frames are counted on from there, and begin anew with 0 behind the largest number. Without it a frame has the number that [`Executor::frames`] tells before it.
    pub fn set_frame_number(&mut self, number: u64) {
        self.runs.set_number(self.frames(), number);
    }

    /// Sets the time of frames from the next one on, in seconds: `time` in parameters of passes. Without it, it is a sixtieth of the frame's
    /// number.
    ///
    /// # Errors
    /// [`Error::BadResource`] if it is no finite number.
    pub fn set_time(&mut self, seconds: f64) -> Result<(), Error> {
        self.runs.set_time(seconds)
    }

    /// The number by which passes of the next frame go that run every few frames.
    #[must_use]
    pub fn frame_number(&self) -> u64 {
        self.runs.number(self.frames())
    }

    /// Waits for the oldest frame on its way, if as many are as may be.
    pub(crate) fn make_room(&mut self) -> Result<(), Error> {
        let waited = self.frames.make_room();
        self.retired.let_go(&self.frames);
        waited
    }

    /// Waits for every frame on its way.
    pub(super) fn wait_for_all(&mut self) -> Result<(), Error> {
        let waited = self.frames.wait_for_all();
        self.retired.let_go(&self.frames);
        waited
    }

    /// Waits for a frame of this number among its own.
    pub(super) fn wait_for_own(&mut self, own: u64) -> Result<(), Error> {
        let waited = self.frames.wait(own);
        self.retired.let_go(&self.frames);
        waited
    }

    /// The Plan that it executes.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What pipelines must fit that a program binds itself in the pass of this name, by [`crate::Recorder::raw`]; `None` if
    /// no rendering scope has such a pass. So the pipelines can be made before the first frame.
    #[must_use]
    pub fn formats(&self, pass: &str) -> Option<ScopeFormats> {
        self.plan.steps.iter().zip(&self.prepared.steps).find_map(|(step, made)| {
            let number = step.work.scope()?.passes.iter().position(|it| *it.name == *pass)?;
            Some(made.draws()[number].state.formats.clone())
        })
    }

    /// How the pass of this name, in a rendering scope or recorded by the program, is for both eyes at once, and how its images hold both
    /// eyes' parts; `None` if it is for one eye, or for neither. Known before the first frame, as [`Executor::formats`] is.
    #[must_use]
    pub fn both_eyes(&self, pass: &str) -> Option<(Stereo, EyeForm)> {
        let form = self.plan.steps.iter().find_map(|step| {
            let found = step.work.passes().iter().find(|it| *it.name == *pass)?;
            Some(step.work.scope().map_or_else(|| self.plan.both_eyes(found), |scope| self.plan.eyes(scope)))
        });
        form.flatten().map(|form| (self.plan.stereo, form))
    }

    /// Makes ready for the next frame, which uses these images of the program's, and returns its number among its own.
    fn next_frame(&mut self, images: &[(&str, usize)]) -> Result<u64, Error> {
        if let Some(name) = self.not_imported() {
            return Err(Error::NotImported { name: name.to_owned() });
        }
        self.sets.check_all().map_err(|what| Error::BadResource { what })?;
        let of_window = self.owners.iter().find(|(name, _)| images.iter().all(|(chosen, _)| chosen != name));
        if let Some((name, _)) = of_window {
            let what = format!("`{name}` is shown in a window: `present` draws it, or another image is imported first");
            return Err(Error::BadResource { what });
        }
        self.make_room()?;
        self.choose_images(images)?;
        self.ready()?;
        let number = self.frames.next();
        self.prepared.prepare_frame(&self.gpu, &self.plan, number)?;
        let told = self.first_frame + number;
        self.runs.begin(&self.plan, told);
        self.prepared.write_frame_values(number, self.runs.clock(told))?;
        Ok(number)
    }

    /// What recording a frame takes.
    fn parts(&mut self, number: u64) -> (&mut Frames, Frame<'_>, &PreparedPlan, FrameExtras<'_>) {
        let told = self.first_frame + number;
        let (gpu, plan, physical) = (&self.gpu, &self.plan, &self.prepared.physical);
        let clock = self.runs.clock(told);
        let frame =
            Frame { gpu, plan, physical, sets: &self.sets, number, told, left_out: self.runs.left_out(), clock };
        let extras = FrameExtras { imports: &self.imports, readbacks: &self.readbacks };
        (&mut self.frames, frame, &self.prepared, extras)
    }

    /// Waits until the device is done with a frame. Those of executors that it goes on from are done.
    ///
    /// # Errors
    /// [`Error::BadResource`] if it was never submitted, or a later one has taken its place; [`Error::DeviceLost`],
    /// [`Error::Timeout`].
    pub fn wait(&mut self, frame: u64) -> Result<(), Error> {
        let Some(own) = frame.checked_sub(self.first_frame) else { return Ok(()) };
        self.wait_for_own(own)?;
        if self.frames.holds(own) {
            return Ok(());
        }
        Err(Error::BadResource { what: format!("frame {frame} was not submitted, or a later one has taken its place") })
    }

    /// Binds a set that the program makes itself for all passes whose shaders read the set of this number, in frames from now on, with its
    /// dynamic offsets. It takes the place of the one before. An executor that [goes on](Executor::migrate_from) from this one keeps it.
    ///
    /// That the set doesn't fit is an error of the frame ([`Error::Recording`]), and so is a set that a shader reads and nobody has bound. A number
    /// that the program has told no set of is an error of each frame, too ([`Error::BadResource`]).
    pub fn bind_set(&mut self, number: u32, set: RawSet, offsets: &[u32]) {
        self.sets.bind(number, set, offsets);
    }

    /// Lets go of the set of this number: frames from now on don't read it.
    pub fn unbind_set(&mut self, number: u32) {
        self.sets.unbind(number);
    }

    /// The report of a frame, which is waited for: its draws, and how long the device took if [`ExecutorOptions::timestamps`]
    /// is set, and how often fragment shaders ran if [`ExecutorOptions::fragment_counts`] is.
    ///
    /// # Errors
    /// Those of [`Executor::wait`].
    pub fn report(&mut self, frame: u64) -> Result<FrameReport, Error> {
        let own = self.own(frame)?;
        self.wait(frame)?;
        self.frames.report(&self.plan, own)
    }

    /// The number of a frame among its own.
    pub(super) fn own(&self, frame: u64) -> Result<u64, Error> {
        let earlier = || Error::BadResource { what: format!("frame {frame} was drawn by an earlier Plan") };
        frame.checked_sub(self.first_frame).ok_or_else(earlier)
    }

    /// Gives what outlives the frame its first contents, unless that is done.
    pub(crate) fn ready(&mut self) -> Result<(), Error> {
        if !self.initialised {
            initialise(&self.gpu, &self.plan, &self.uses, &self.prepared.physical, &self.staged)?;
            self.staged = Vec::new();
            self.initialised = true;
        }
        Ok(())
    }
}
