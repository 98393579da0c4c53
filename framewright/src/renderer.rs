//! A pipeline that is drawn frame after frame, while its settings and files change.

mod captures;

pub use captures::CapturedTexels;

use crate::choices::Choices;
use crate::error::{Error, Mistakes};
use crate::options::RendererOptions;
use crate::pipeline::{Origin, Pipeline};
use framewright_graph::base::{ReadFiles, Sources};
use framewright_graph::compile::Compiler;
use framewright_graph::device::Profile;
use framewright_graph::frame::Stereo;
use framewright_graph::language::{Document, Facts};
use framewright_graph::plan::{Plan, UsedFeature};
use framewright_graph::vulkan::Rotation;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, DeviceFeatures, DrawSource, Executor, FrameReport, RawSet, Texels};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A pipeline that is drawn frame after frame.
///
/// It reads the pipeline, plans it when something has changed since the last frame, and executes the Plan. What is wrong with a choice
/// or a file is an error of the call that brought it, and leaves the last good Plan drawing.
pub struct Renderer {
    device: Device,
    pub(crate) profile: Arc<Profile>,
    origin: Origin,
    options: RendererOptions,
    pipeline: Pipeline,
    /// The files that were read last, by a reload that failed too.
    read: ReadFiles,
    pub(crate) chosen: DrawnChoices,
    compiler: Compiler,
    /// The sets of the program's that the next executor begins with.
    sets: BTreeMap<u32, (RawSet, Vec<u32>)>,
    /// What is drawn.
    drawn: Option<DrawnPlan>,
    /// Whether anything changed since it was planned.
    changed: bool,
    /// How often it was planned.
    plans: u64,
    /// What of a frame is captured.
    capturing: captures::CaptureState,
    id: u64,
    refused: Option<RefusedChange>,
}

/// What was asked for last and isn't drawn, since it is wrong: files that were read anew, or choices. What is drawn stays.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RefusedChange {
    /// The error, in words.
    pub message: String,
    /// Its mistakes with their places; `None`: it has none.
    pub mistakes: Option<Mistakes>,
}

impl RefusedChange {
    fn of(error: &Error) -> RefusedChange {
        let mistakes = match error {
            Error::Mistakes { mistakes } => Some((**mistakes).clone()),
            _ => None,
        };
        RefusedChange { message: error.to_string(), mistakes }
    }
}

/// What was chosen.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct DrawnChoices {
    /// Values of settings, by name. One that the file doesn't have, or no longer, waits for it.
    set: BTreeMap<String, String>,
    preset: Option<String>,
    /// All else.
    pub(crate) frame: Choices,
}

/// The executor of the Plan that is drawn, and the choices that the Plan was made for.
pub(crate) struct DrawnPlan {
    pub(crate) executor: Executor,
    chosen: DrawnChoices,
}

/// The Plan of the next frame.
#[derive(Debug)]
#[non_exhaustive]
pub struct PreparedFrame<'r> {
    /// The Plan, verified.
    pub plan: &'r Plan,
    /// What became another one since the last call.
    pub change: Change,
}

/// What became another one when a frame was prepared.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Change {
    /// Nothing: nothing was planned.
    Nothing,
    /// At most values in the Plan: the executor stays. A draw source that goes by the Plan's views follows it with
    /// [`SceneDrawSource::change`](crate::SceneDrawSource::change).
    Values,
    /// The Plan and its executor: what a program imported is to be imported again, and a draw source that goes by the Plan is to be
    /// made anew.
    Executor {
        /// Names of the images and buffers that keep their contents, such as a history; empty for the first Plan.
        carried_over: Vec<String>,
    },
}

/// The id of the next renderer.
static NEXT_ID: AtomicU64 = AtomicU64::new(1);

impl Renderer {
    /// Reads the pipeline in the file `pipeline`; where there is none, the shipped one of that name. Until it is told otherwise, the
    /// frame has 1280×720 texels, and the scene may hold everything.
    ///
    /// # Errors
    /// If there is neither, or it is wrong in itself.
    pub fn open(device: &Device, pipeline: impl AsRef<Path>, options: RendererOptions) -> Result<Renderer, Error> {
        Renderer::begin(device, Origin::File(pipeline.as_ref().to_owned()), options)
    }

    /// Does the same with a pipeline that the program carries within itself, which messages call `name`. The files and shaders that it
    /// names are shipped ones, or of the folders in [`RendererOptions::shaders`].
    ///
    /// # Errors
    /// If it is wrong in itself, or an extension can't be read.
    pub fn carried(device: &Device, name: &str, text: &str, options: RendererOptions) -> Result<Renderer, Error> {
        Renderer::begin(device, Origin::Text { name: name.to_owned(), text: text.to_owned() }, options)
    }

    fn begin(device: &Device, origin: Origin, mut options: RendererOptions) -> Result<Renderer, Error> {
        options.compile.readable |= options.executor.check_uses;
        let read = ReadFiles::default();
        Ok(Renderer {
            pipeline: Pipeline::of(&origin, &options, &read)?,
            read,
            device: device.clone(),
            profile: Arc::new(device.profile()),
            origin,
            options,
            chosen: DrawnChoices::default(),
            compiler: Compiler::new(),
            sets: BTreeMap::new(),
            drawn: None,
            changed: true,
            plans: 0,
            capturing: captures::CaptureState::default(),
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            refused: None,
        })
    }

    /// Gives a setting a value, which is stronger than presets and settings files: what `--set` takes, a number, `true`, `false` or a
    /// name.
    ///
    /// # Errors
    /// [`Error::Mistakes`] if the pipeline has no such setting, or it doesn't allow the value. It keeps the one that it had.
    pub fn set(&mut self, setting: &str, value: impl Display) -> Result<(), Error> {
        let mut choices = self.chosen.of(self.document());
        let value = value.to_string();
        choices.set.push((setting.to_owned(), value.clone()));
        self.pipeline.check([&choices])?;
        self.changed |= self.chosen.set.get(setting) != Some(&value);
        self.chosen.set.insert(setting.to_owned(), value);
        Ok(())
    }

    /// Takes back what [`Renderer::set`] gave a setting.
    pub fn unset(&mut self, setting: &str) {
        self.changed |= self.chosen.set.remove(setting).is_some();
    }

    /// Puts a preset in force, in place of the one before; `None`: that of the settings files, if they name one.
    ///
    /// # Errors
    /// [`Error::Mistakes`] if the pipeline has no such preset. The one before stays in force.
    pub fn preset(&mut self, name: Option<&str>) -> Result<(), Error> {
        self.pipeline.choose(name)?;
        self.take(|chosen| chosen.preset = name.map(str::to_owned));
        Ok(())
    }

    /// Tells the facts of the scene, as conditions of the pipeline ask for them; `None`: it may hold everything.
    pub fn set_facts(&mut self, facts: Option<Facts>) {
        self.take(|chosen| chosen.frame.facts = facts);
    }

    /// Tells the facts of `scene`.
    pub fn set_scene(&mut self, scene: &Scene) {
        self.set_facts(Some(scene.facts()));
    }

    /// Sets width and height of the output.
    ///
    /// # Errors
    /// [`Error::Mistakes`] if no frame has that size. It keeps the one that it had.
    pub fn set_extent(&mut self, extent: [u32; 2]) -> Result<(), Error> {
        self.pipeline.check([&Choices { extent, ..self.chosen.of(self.document()) }])?;
        self.take(|chosen| chosen.frame.extent = extent);
        Ok(())
    }

    /// Has images of these names leave the frame beside its outputs, so that they can be read.
    ///
    /// # Errors
    /// [`Error::Mistakes`] if there is no image of a name. It keeps those that it had.
    pub fn set_dump(&mut self, images: &[&str]) -> Result<(), Error> {
        let dump: Vec<String> = images.iter().map(|image| (*image).to_owned()).collect();
        self.pipeline.check([&Choices { dump: dump.clone(), ..self.chosen.of(self.document()) }])?;
        self.take(|chosen| chosen.frame.dump = dump);
        Ok(())
    }

    /// Says by how much the screen is turned that shows the picture. What is read back is upright.
    pub fn set_rotation(&mut self, rotation: Rotation) {
        self.take(|chosen| chosen.frame.rotation = rotation);
    }

    /// Says how the frame is drawn for two eyes. [`Stereo::first_fit`] finds a way that the device has.
    ///
    /// # Errors
    /// [`Error::Stereo`] if the device can't draw so. The way stays that it was.
    pub fn set_stereo(&mut self, stereo: Stereo) -> Result<(), Error> {
        let choices = Choices { stereo: vec![stereo], ..self.chosen.frame.clone() };
        choices.stereo_on(&self.profile)?;
        self.take(|chosen| chosen.frame = choices);
        Ok(())
    }

    pub(crate) fn take(&mut self, choose: impl FnOnce(&mut DrawnChoices)) {
        let mut chosen = self.chosen.clone();
        choose(&mut chosen);
        self.changed |= self.chosen != chosen;
        self.chosen = chosen;
    }

    /// Plans the next frame if anything changed since the last call; every frame begins with it. A Plan that differs in values alone
    /// goes to the executor that there is. Any other gets a new one, which takes over the contents of what persists in both, and
    /// counts frames on.
    ///
    /// # Errors
    /// The mistakes of the pipeline, its shaders and choices, or those of making an executor. The last good Plan stays, with the
    /// choices that it was made for; if there is none, the next call tries again.
    pub fn prepare(&mut self) -> Result<PreparedFrame<'_>, Error> {
        let change = match self.changed || self.capturing.is_asked() {
            true => self.renew(false).inspect_err(|error| {
                self.refused = Some(RefusedChange::of(error));
                self.go_back();
            })?,
            false => Change::Nothing,
        };
        Ok(PreparedFrame { plan: self.drawn()?.executor.plan(), change })
    }

    /// Another renderer of the pipeline, with the choices of this one. It reads the files anew, and has drawn nothing. Choices can be
    /// tried with it on another thread, and [`Renderer::make_pipelines`] called, while this one draws.
    ///
    /// # Errors
    /// Those of [`Renderer::open`]; [`Error::Mistakes`] if the files no longer have the preset.
    pub fn try_clone(&self) -> Result<Renderer, Error> {
        let mut other = Renderer::begin(&self.device, self.origin.clone(), self.options.clone())?;
        other.pipeline.choose(self.chosen.preset.as_deref())?;
        other.chosen = self.chosen.clone();
        Ok(other)
    }

    /// Makes all pipelines that the next frame needs, on several threads. The device keeps them while there is an executor, so that another
    /// renderer that comes to the same choices finds them made. Called for a [clone](Renderer::try_clone) in the background, it prepares what
    /// the user may choose next. Compiled shaders are each renderer's own: a [`Helper`](crate::Helper) with a cache, or precompiled ones, spare
    /// the other one that work.
    ///
    /// # Errors
    /// The mistakes of the pipeline, its shaders and choices, or those of making pipelines. The choices stay.
    pub fn make_pipelines(&mut self) -> Result<(), Error> {
        let Renderer { device, profile, options, pipeline, chosen, compiler, .. } = self;
        let choices = chosen.of(&pipeline.document);
        let plan = pipeline.plan(compiler, device, profile, &choices, &options.compile)?;
        Ok(device.make_pipelines(plan, &mut pipeline.assets.shaders)?)
    }

    /// Goes back to the choices that the last good Plan was made for.
    fn go_back(&mut self) {
        if let Some(drawn) = &self.drawn {
            self.chosen = drawn.chosen.clone();
            // The pipeline has the preset: it was in force before.
            self.changed = self.pipeline.choose(self.chosen.preset.as_deref()).is_err() || self.capturing.is_over();
        }
    }

    /// Plans, and has an executor of the Plan; a new one if `anew`.
    fn renew(&mut self, anew: bool) -> Result<Change, Error> {
        if let Some(change) = self.renew_captured()? {
            return Ok(change);
        }
        if !anew && !self.changed {
            return Ok(Change::Nothing);
        }
        let Renderer { device, profile, options, pipeline, chosen, compiler, sets, drawn, plans, capturing, .. } = self;
        let choices = chosen.of(&pipeline.document);
        let plan = pipeline.plan(compiler, device, profile, &choices, &options.compile)?;
        let stays = |drawn: &&mut DrawnPlan| !anew && drawn.executor.differs_beyond_values(plan).is_none();
        let change = if let Some(drawn) = drawn.as_mut().filter(stays) {
            drawn.executor.change(plan)?;
            drawn.chosen.clone_from(chosen);
            Change::Values
        } else {
            // An executor that goes on from another one ends it: what can't have its owners leaves it drawing.
            drawn.as_ref().map_or(Ok(()), |drawn| drawn.executor.check_owners(plan))?;
            let mut executor = pipeline.assets.executor(device, plan, &options.executor)?;
            sets.iter().for_each(|(number, (set, offsets))| executor.bind_set(*number, *set, offsets));
            let before = drawn.take().map(|before| executor.migrate_from(before.executor));
            let carried_over = before.transpose()?.unwrap_or_default();
            *drawn = Some(DrawnPlan { executor, chosen: chosen.clone() });
            Change::Executor { carried_over }
        };
        // The Plan of before is no other one.
        *plans += u64::from(capturing.end(plan) != Some(true));
        self.changed = false;
        self.refused = None;
        Ok(change)
    }

    /// What is drawn. After [`Renderer::prepare`] there is something, unless the device gave up while contents were carried over.
    pub(crate) fn drawn(&mut self) -> Result<&mut DrawnPlan, Error> {
        let none = || framewright_vulkan::Error::BadPlan { what: "there is none yet".to_owned() };
        Ok(self.drawn.as_mut().ok_or_else(none)?)
    }

    /// Binds a set that the program makes itself, in frames from now on and whatever is planned: see [`Executor::bind_set`].
    pub fn bind_set(&mut self, number: u32, set: RawSet, offsets: &[u32]) {
        self.sets.insert(number, (set, offsets.to_vec()));
        if let Some(drawn) = &mut self.drawn {
            drawn.executor.bind_set(number, set, offsets);
        }
    }

    /// Lets go of the set of this number: see [`Executor::unbind_set`].
    pub fn unbind_set(&mut self, number: u32) {
        self.sets.remove(&number);
        if let Some(drawn) = &mut self.drawn {
            drawn.executor.unbind_set(number);
        }
    }

    /// Whether a file that was read is another one by now, or is gone, or one that was looked for is there.
    #[must_use]
    pub fn files_changed(&self) -> bool {
        self.read.changed()
    }

    /// Reads the pipeline, its shaders and pictures anew, and plans. Values of settings that the file no longer has wait until it has
    /// them again.
    ///
    /// # Errors
    /// Those of [`Renderer::open`] and [`Renderer::prepare`]: mistakes in the files leave all as it was.
    pub fn reload(&mut self) -> Result<Change, Error> {
        self.read_anew().inspect_err(|error| self.refused = Some(RefusedChange::of(error)))
    }

    fn read_anew(&mut self) -> Result<Change, Error> {
        self.read = ReadFiles::default();
        let mut pipeline = Pipeline::of(&self.origin, &self.options, &self.read)?;
        pipeline.choose(self.chosen.preset.as_deref())?;
        let before = std::mem::replace(&mut self.pipeline, pipeline);
        self.renew(true).inspect_err(|_| self.pipeline = before)
    }

    /// Draws a frame, waits until the device is done, and returns the frame's number, from 0. Numbers rise by
    /// one, over Plans too, unless contents couldn't be carried over to a new one.
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`] and [`Executor::frame`].
    pub fn frame(&mut self, source: &mut dyn DrawSource) -> Result<u64, Error> {
        let frame = self.submit(source)?;
        self.wait(frame)?;
        Ok(frame)
    }

    /// Records and submits a frame, and returns its number, from 0: see [`Executor::submit`].
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`] and [`Executor::submit`].
    pub fn submit(&mut self, source: &mut dyn DrawSource) -> Result<u64, Error> {
        self.prepare()?;
        Ok(self.drawn()?.executor.submit(source)?)
    }

    /// Waits until the device is done with a frame. A frame of an earlier executor counts as done.
    ///
    /// # Errors
    /// Those of [`Executor::wait`].
    pub fn wait(&mut self, frame: u64) -> Result<(), Error> {
        Ok(self.drawn()?.executor.wait(frame)?)
    }

    /// The report of a frame of the executor that there is, which is waited for.
    ///
    /// # Errors
    /// Those of [`Executor::report`].
    pub fn report(&mut self, frame: u64) -> Result<FrameReport, Error> {
        Ok(self.drawn()?.executor.report(frame)?)
    }

    /// The texels of the output `name`, an image, as the last frame left it: see [`Executor::read`].
    ///
    /// # Errors
    /// [`Error::UnknownOutput`], and those of [`Executor::read`].
    pub fn read(&mut self, name: &str) -> Result<Texels, Error> {
        let drawn = self.drawn()?;
        let output = drawn.output(name)?;
        Ok(drawn.executor.read(output)?)
    }

    /// The texels that a frame left in the output `name`, an image: see [`Executor::read_back_image`]. The executor's options must
    /// have `readback` set.
    ///
    /// # Errors
    /// [`Error::UnknownOutput`], and those of [`Executor::read_back_image`].
    pub fn read_back(&mut self, frame: u64, name: &str) -> Result<Texels, Error> {
        let drawn = self.drawn()?;
        let output = drawn.output(name)?;
        Ok(drawn.executor.read_back_image(frame, output)?)
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The pipeline as it was read last: its settings, presets and changes.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.pipeline.document
    }

    /// Whether the pipeline is a shipped one, since there was no file of that name when it was read last.
    #[must_use]
    pub fn is_shipped(&self) -> bool {
        self.pipeline.is_shipped()
    }

    /// The Plan that is drawn; `None` before the first one. [`Renderer::prepare`] makes it.
    #[must_use]
    pub fn plan(&self) -> Option<&Plan> {
        self.drawn.as_ref().map(|drawn| drawn.executor.plan())
    }

    /// How many Plans it has made: another number, another Plan.
    #[must_use]
    pub fn plans(&self) -> u64 {
        self.plans
    }

    /// What tells it from every other renderer of this process.
    #[must_use]
    pub fn id(&self) -> u64 {
        self.id
    }

    /// What was asked for last and is wrong; `None`: what is drawn is what was asked for. A setting, a preset or a size that is refused at
    /// once isn't told here.
    #[must_use]
    pub fn refused(&self) -> Option<&RefusedChange> {
        self.refused.as_ref()
    }

    /// The texts of the pipeline's files, as they were read last.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.pipeline.sources
    }

    /// The name of the pipeline, for people: that of its file, or the one that the program gave it.
    #[must_use]
    pub fn name(&self) -> String {
        match &self.origin {
            Origin::File(file) => file.to_string_lossy().into_owned(),
            Origin::Text { name, .. } => name.clone(),
        }
    }

    /// The features of a device that the Plan of the next frame uses, with the first that uses each: see [`Plan::features`]. A device
    /// that is made with these alone ([`DeviceFeatures::exactly`](framewright_vulkan::DeviceFeatures::exactly)) draws it too.
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`].
    pub fn features(&mut self) -> Result<Vec<UsedFeature>, Error> {
        self.prepare()?;
        let plan = self.drawn.as_ref().map(|drawn| drawn.executor.plan());
        plan.map_or(Ok(Vec::new()), |plan| self.pipeline.features(plan))
    }

    /// Those of them as the chain of features, and the extensions, with which a program makes a device of the same physical device. Of several
    /// renderers, or settings, take the names of all: [`DeviceFeatures::exactly`].
    ///
    /// # Errors
    /// Those of [`Renderer::features`].
    pub fn device_features(&mut self) -> Result<DeviceFeatures, Error> {
        let used = self.features()?;
        let names: Vec<&str> = used.iter().map(|feature| feature.name).collect();
        Ok(self.device.exact_features(&names)?)
    }

    /// Its executor.
    #[must_use]
    pub fn executor(&self) -> Option<&Executor> {
        self.drawn.as_ref().map(|drawn| &drawn.executor)
    }

    /// The same to change, as it is: it plans nothing, unlike [`Renderer::executor_mut`]. A frame that was recorded and not submitted is
    /// taken back by it.
    pub fn current_executor_mut(&mut self) -> Option<&mut Executor> {
        self.drawn.as_mut().map(|drawn| &mut drawn.executor)
    }

    /// The executor of the next frame, for all that this type has no method for: imports, contents that are written, frames among the
    /// program's own work. It must stay with its Plan: [`Executor::change`] is for [`Renderer::prepare`].
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`].
    pub fn executor_mut(&mut self) -> Result<&mut Executor, Error> {
        self.prepare()?;
        Ok(&mut self.drawn()?.executor)
    }
}

impl DrawnChoices {
    /// What it means for a frame of a pipeline.
    fn of(&self, document: &Document) -> Choices {
        let has = |name: &str| document.settings.iter().any(|setting| *setting.name.text == *name);
        let known = self.set.iter().filter(|(name, _)| has(name));
        let set = known.map(|(name, value)| (name.clone(), value.clone())).collect();
        Choices { set, ..self.frame.clone() }
    }
}

impl DrawnPlan {
    /// The number of an output.
    fn output(&self, name: &str) -> Result<usize, Error> {
        let outputs = &self.executor.plan().outputs;
        outputs.iter().position(|output| *output.name == *name).ok_or_else(|| {
            let known = outputs.iter().map(|output| output.name.to_string()).collect();
            Error::UnknownOutput { name: name.to_owned(), known }
        })
    }
}

#[cfg(test)]
mod told_owners;
