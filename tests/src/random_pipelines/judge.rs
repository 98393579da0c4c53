//! Holds what a driver makes of a pipeline against what the pipeline means.

pub use super::compare::Difference;
use super::compare::{compare, levels, texels_of};
use super::meaning::{self, State, imported_buffer, imported_image};
use super::pipeline::{Count, Draw, Geometry, Life, Pass, Pipeline, Work};
use super::spoil::Spoil;
use super::{shader, texels, to_frame, to_ron};
use framewright_graph::base::{self, Diagnostic, Root, Sources};
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::device::{Profile, Queues};
use framewright_graph::expand::{self, Inputs};
use framewright_graph::frame::{self, Eye, Frame, Stereo};
use framewright_graph::language::{self, Facts};
use framewright_graph::plan::{Plan, Resource};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Rotation, Sharing};
use framewright_passes::draw::interfaces;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::{
    CustomRecorder, Device, DeviceOptions, DrawSource, Error, Executor, ExecutorOptions, Message, Recorder,
    ShaderLibrary,
};
use std::any::Any;
use std::collections::HashSet;
use std::fmt;
use std::iter::Peekable;
use std::ops::Range;
use std::panic::AssertUnwindSafe;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;

/// A device with the validation layer awake, and the shaders that it has met.
pub struct Judge {
    device: Device,
    profile: Profile,
    folder: TempDir,
    shaders: ShaderLibrary,
    known: HashSet<String>,
    findings: usize,
    /// The change that spoils Plans before they are executed, to see that it is noticed.
    pub spoil: Option<Spoil>,
    /// How two eyes are drawn for, which see the same in images of their own.
    stereo: Stereo,
}

/// A mistake on the way from a pipeline to its outputs.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The pipeline is valid, and was refused.
    Refused(Vec<String>),
    /// The compiler or the checker panicked.
    Panicked(String),
    /// The checker finds fault with its Plan.
    Violations(Vec<String>),
    /// A pass with side effects isn't in its Plan.
    Culled(u32),
    /// The Plan couldn't be executed.
    NotExecuted(String),
    /// The validation layer has something to say.
    Findings(Vec<String>),
    /// An output holds something else.
    Difference(Difference),
}

impl Fault {
    /// Whether two faults are of one kind.
    #[must_use]
    pub fn is_like(&self, other: &Fault) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::Refused(messages) => write!(f, "it is refused: {}", messages.join("\n")),
            Fault::Panicked(words) => write!(f, "the compiler or the checker panics: {words}"),
            Fault::Violations(violations) => write!(f, "the checker finds: {}", violations.join("\n")),
            Fault::Culled(pass) => write!(f, "p{pass} has side effects and was culled"),
            Fault::NotExecuted(error) => write!(f, "it can't be executed: {error}"),
            Fault::Findings(findings) => write!(f, "the validation layer says: {}", findings.join("\n")),
            Fault::Difference(Difference { frame, thing, place, expected, found, writer }) => {
                write!(f, "frame {frame}: {thing} {place} should be {expected:02x?}, ")?;
                match writer {
                    Some(writer) => write!(f, "from p{writer}")?,
                    None => write!(f, "from before the first pass")?,
                }
                write!(f, ", and is {found:02x?}")
            }
        }
    }
}

/// A pipeline's outputs as the CPU has them, frame by frame.
#[must_use]
pub fn expected(pipeline: &Pipeline, frames: u32) -> Vec<State> {
    let mut state = State::new(pipeline);
    (0..frames)
        .map(|frame| {
            state = meaning::frame(pipeline, &state, frame);
            state.clone()
        })
        .collect()
}

/// How many frames show what a pipeline does across frames: its longest history, and around.
#[must_use]
pub fn frames(pipeline: &Pipeline) -> u32 {
    let images = pipeline.images.iter().map(|image| image.life);
    let lives = images.chain(pipeline.buffers.iter().map(|buffer| buffer.life));
    let each = lives.map(|life| match life {
        Life::Transient | Life::Target | Life::Imported => 2,
        Life::Persistent(_) => 3,
        Life::History(frames, _) => frames + 2,
    });
    each.max().unwrap_or(2)
}

/// How a pipeline is compiled: with poison, so that a pass that reads memory of another image shows it. Every fourth one is `readable`.
#[must_use]
pub fn options(order: Order, seed: u64) -> Options {
    Options { alias: true, poison: true, readable: seed & 3 == 2, order, demote: seed & 1 == 0, queues: true }
}

impl Judge {
    /// Opens the device that the environment offers.
    ///
    /// # Errors
    /// If there is none, or no validation layer that is awake, or no place for shaders.
    pub fn new() -> Result<Judge, Box<dyn std::error::Error>> {
        let device = Device::open(&DeviceOptions { validation: true, ..DeviceOptions::default() })?;
        device.canary()?;
        let folder = tempfile::tempdir()?;
        let shaders = ShaderLibrary::new(vec![Root::new(folder.path().to_owned())], SHADERS, interfaces());
        Ok(Judge {
            profile: device.profile(),
            device,
            folder,
            shaders,
            known: HashSet::new(),
            findings: 0,
            spoil: None,
            stereo: Stereo::Off,
        })
    }

    /// Has pipelines drawn for two eyes: each image is there for each eye, in the form that the mode and the device have for it.
    ///
    /// # Errors
    /// What the device lacks, in words.
    pub fn for_two_eyes(mut self, stereo: Stereo) -> Result<Judge, String> {
        self.stereo = stereo;
        stereo.lacks(&self.profile).map_or(Ok(self), Err)
    }

    /// Has Plans made for a device with three queues, which share images or hand them over. They run on the queues that there are.
    #[must_use]
    pub fn with_three_queues(mut self, sharing: Sharing) -> Judge {
        self.profile.queues = Queues { compute: true, transfer: true, sharing, wait_bytes: 0 };
        self
    }

    /// The device's name.
    #[must_use]
    pub fn device(&self) -> &str {
        &self.device.summary().name
    }

    /// Compiles, checks and executes a pipeline, frame after frame, and compares each output with `expected`.
    ///
    /// # Errors
    /// The first [`Fault`].
    pub fn judge(&mut self, pipeline: &Pipeline, expected: &[State], options: &Options) -> Result<(), Fault> {
        let frame = self.frame(pipeline)?;
        let mut plan = self.plan(pipeline, &frame, options)?;
        if let Some(spoil) = self.spoil {
            spoil.spoil(&mut plan);
        }
        let outcome = self.execute(pipeline, &plan, expected, options.readable);
        // The layer's findings explain more than the differences that follow from them.
        let all = self.device.messages().list();
        let new: Vec<&Message> = all.iter().filter(|message| message.is_finding()).skip(self.findings).collect();
        self.findings += new.len();
        let findings: Vec<String> = new.into_iter().take(2).map(shown).collect();
        if findings.is_empty() { outcome } else { Err(Fault::Findings(findings)) }
    }

    fn text(&self, pipeline: &Pipeline) -> String {
        to_ron::to_ron(pipeline, self.stereo != Stereo::Off)
    }

    /// The frame of a pipeline, out of a pipeline file and its shaders.
    ///
    /// # Errors
    /// [`Fault::Refused`], or [`Fault::NotExecuted`] if its shaders can't be written.
    pub fn frame(&mut self, pipeline: &Pipeline) -> Result<Frame, Fault> {
        self.write_shaders(pipeline).map_err(|error| Fault::NotExecuted(error.to_string()))?;
        let mut sources = Sources::default();
        let read = language::read(&mut sources, "random.ron", "random.ron", self.text(pipeline));
        let sources = Arc::new(sources);
        let refused = |mistakes: Vec<Diagnostic>| Fault::Refused(vec![base::render(&sources, &mistakes)]);
        let described = read.map_err(refused)?;
        let inputs = Inputs {
            set: &[],
            facts: Facts::UNKNOWN,
            facts_known: false,
            output_extent: [1, 1],
            rotation: Rotation::Identity,
            dump: &[],
            device: (self.stereo != Stereo::Off).then_some(&self.profile),
            stereo: self.stereo,
            window: None,
        };
        expand::expand(&described, sources.clone(), &inputs, &mut self.shaders).map_err(refused)
    }

    /// The Plan of a pipeline's frame, with which the checker is content.
    ///
    /// # Errors
    /// [`Fault::Refused`], [`Fault::Violations`] or [`Fault::Culled`].
    pub fn plan(&self, pipeline: &Pipeline, frame: &Frame, options: &Options) -> Result<Plan, Fault> {
        // A panic is a fault like any other, that can be shrunk.
        let compiled = AssertUnwindSafe(|| compile(frame, &self.profile, &mut self.device.memory(), options));
        let plan = std::panic::catch_unwind(compiled)
            .map_err(|payload| Fault::Panicked(words(&*payload)))?
            .map_err(|errors| Fault::Refused(errors.into_iter().map(|error| error.message).collect()))?;
        let violations =
            std::panic::catch_unwind(|| verify(&plan)).map_err(|payload| Fault::Panicked(words(&*payload)))?;
        let violations: Vec<String> = violations.iter().map(ToString::to_string).collect();
        if !violations.is_empty() {
            return Err(Fault::Violations(violations));
        }
        let tree = plan.tree();
        let missing = |name: &str| !tree.split(|at: char| !at.is_alphanumeric()).any(|word| word == name);
        let culled = pipeline.passes.iter().find(|pass| pass.side_effect && missing(&format!("p{}", pass.number)));
        culled.map_or(Ok(plan), |pass| Err(Fault::Culled(pass.number)))
    }

    /// Writes a pipeline file, its shaders and, as text, its Plan into a folder.
    ///
    /// # Errors
    /// If the folder or a file can't be written.
    pub fn write(&mut self, pipeline: &Pipeline, options: &Options, folder: &Path) -> std::io::Result<()> {
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join("random.ron"), self.text(pipeline))?;
        for shader in pipeline.passes.iter().filter_map(|pass| shader::shader(pipeline, pass)) {
            for (name, text) in shader.files {
                std::fs::write(folder.join(name), text)?;
            }
        }
        let Ok(frame) = self.frame(pipeline) else { return Ok(()) };
        let compiled = AssertUnwindSafe(|| compile(&frame, &self.profile, &mut self.device.memory(), options));
        match std::panic::catch_unwind(compiled) {
            Ok(Ok(plan)) => std::fs::write(folder.join("plan.txt"), plan.tree()),
            _ => Ok(()),
        }
    }

    fn write_shaders(&mut self, pipeline: &Pipeline) -> std::io::Result<()> {
        for shader in pipeline.passes.iter().filter_map(|pass| shader::shader(pipeline, pass)) {
            if self.known.insert(shader.name) {
                for (name, text) in shader.files {
                    std::fs::write(self.folder.path().join(name), text)?;
                }
            }
        }
        Ok(())
    }

    /// `check_uses`: whether custom passes, all of which are honest, are held against what they declare.
    fn execute(&mut self, pipeline: &Pipeline, plan: &Plan, expected: &[State], check_uses: bool) -> Result<(), Fault> {
        let broken = |error: Error| Fault::NotExecuted(error.to_string());
        // Many frames leave their traces in the last; some are looked at one by one.
        let flight = 1 + (pipeline.passes.len() % 3) as u32;
        let timestamps = flight > 1;
        let options = ExecutorOptions {
            poison: true,
            check_uses,
            frames_in_flight: flight,
            timestamps,
            ..ExecutorOptions::default()
        };
        let mut executor = Executor::new(&self.device, plan, &mut self.shaders, &options).map_err(broken)?;
        for (number, state) in (0..).zip(expected) {
            hand_in(pipeline, plan, &mut executor, number).map_err(broken)?;
            let frame = executor.submit(&mut Program(pipeline)).map_err(broken)?;
            if flight > 1 && number + 1 < expected.len() as u32 {
                continue;
            }
            if timestamps {
                executor.report(frame).map_err(broken)?;
            }
            let mut outputs = (0..plan.outputs.len()).peekable();
            for thing in &pipeline.outputs {
                for found in self.read_each_eye(plan, &mut executor, &mut outputs).map_err(broken)? {
                    if let Some(difference) = compare(pipeline, state, *thing, number, &found) {
                        return Err(Fault::Difference(difference));
                    }
                }
            }
        }
        Ok(())
    }
}

impl Judge {
    /// All bytes of the next output, as each eye has it: of two outputs, or of the layers of one.
    fn read_each_eye(
        &self,
        plan: &Plan,
        executor: &mut Executor,
        outputs: &mut Peekable<Range<usize>>,
    ) -> Result<Vec<Vec<u8>>, Error> {
        let Some(at) = outputs.next() else { return Ok(vec![Vec::new()]) };
        let first = read(plan, executor, at)?;
        let holds_both = match plan.outputs[at].resource {
            Resource::Image(image) => plan.image(image).eyes.is_some(),
            Resource::Buffer(_) => false,
        };
        if holds_both {
            let eye = |number: usize| {
                let parts = first.iter().filter_map(|plane| plane.chunks(plane.len().div_ceil(2).max(1)).nth(number));
                parts.collect::<Vec<_>>().concat()
            };
            return Ok(vec![eye(0), eye(1)]);
        }
        let other = outputs.next_if(|_| self.stereo != Stereo::Off);
        let second = other.map(|at| read(plan, executor, at)).transpose()?;
        Ok([first].into_iter().chain(second).map(|planes| planes.concat()).collect())
    }
}

/// An image by its name in a Plan, as often as it is there for eyes, and how many copies of one eye's bytes each holds.
fn held_as(plan: &Plan, name: &str) -> Vec<(String, usize)> {
    let names = [name.to_owned()].into_iter().chain(Eye::BOTH.map(|eye| eye.named(name).to_string()));
    // Images that no pass needs aren't in the Plan.
    let held = names.filter_map(|name| {
        let image = plan.images.iter().find(|planned| *planned.name == *name)?;
        let copies = if image.eyes.is_some() { 2 } else { 1 };
        Some((name, copies))
    });
    held.collect()
}

/// Gives a frame what is imported.
fn hand_in(pipeline: &Pipeline, plan: &Plan, executor: &mut Executor, frame: u32) -> Result<(), Error> {
    for (number, image) in pipeline.images.iter().enumerate().filter(|(_, image)| image.life == Life::Imported) {
        for (name, copies) in held_as(plan, &format!("i{number}")) {
            let contents = imported_image(image, number, frame);
            for (mip, plane) in levels(image.mips, image.format) {
                let texel = |at| texels::seen(image.format, plane, contents.texel(mip, at, 0).words);
                let bytes: Vec<u8> = texels_of(&contents, mip)
                    .map(texel)
                    .flat_map(|(format, words)| texels::bytes(format, words))
                    .collect();
                executor.write_image(&name, plane.aspects(image.format), mip, &bytes.repeat(copies))?;
            }
        }
    }
    for (number, buffer) in pipeline.buffers.iter().enumerate().filter(|(_, buffer)| buffer.life == Life::Imported) {
        let name = format!("b{number}");
        if plan.buffers.iter().any(|planned| *planned.name == *name) {
            let words = imported_buffer(buffer, number, frame);
            let bytes: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
            executor.write_buffer(&name, &bytes)?;
        }
    }
    Ok(())
}

/// All bytes of an output, plane by plane of each mip level.
fn read(plan: &Plan, executor: &mut Executor, output: usize) -> Result<Vec<Vec<u8>>, Error> {
    match plan.outputs[output].resource {
        Resource::Image(id) => {
            let image = plan.image(id);
            let mut all = Vec::new();
            for (mip, plane) in levels(image.mips, image.format) {
                all.push(executor.read_image(&image.name, plane.aspects(image.format), mip)?.bytes);
            }
            Ok(all)
        }
        Resource::Buffer(id) => Ok(vec![executor.read_buffer(&plan.buffers[id.0 as usize].name)?]),
    }
}

/// The message of a panic.
fn words(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str).or(payload.downcast_ref::<&str>().copied());
    text.unwrap_or("without words").to_owned()
}

fn shown(message: &Message) -> String {
    let text: String = message.text.chars().take(400).collect();
    format!("{}: {text}", message.id)
}

/// Whether a pass of a Plan is this one, for an eye or for both.
fn is_named(pass: &Pass, name: &str) -> bool {
    name.split(' ').next() == Some(&format!("p{}", pass.number))
}

/// The program around a random pipeline: it has no objects, and records custom passes.
struct Program<'p>(&'p Pipeline);

impl DrawSource for Program<'_> {
    fn record(&mut self, draw: frame::Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let named = |pass: &&Pass| is_named(pass, recorder.pass());
        let work = self.0.passes.iter().find(named).map(|pass| &pass.work);
        let Some(Work::Draw(Draw { geometry: Geometry::Triangles { count, .. }, custom: true, .. })) = work else {
            return Err(Error::DrawSource { what: format!("`{}` draws {draw:?}", recorder.pass()) });
        };
        if let Count::Direct(triangles, instances) = *count {
            recorder.draw(0..3 * triangles, 0..instances);
        }
        Ok(1)
    }

    fn custom(&mut self, _: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        let named = |pass: &&Pass| is_named(pass, recorder.pass());
        let Some(Pass { work: Work::Custom { to, value, .. }, .. }) = self.0.passes.iter().find(named) else {
            return Err(Error::DrawSource { what: format!("`{}` is no custom pass", recorder.pass()) });
        };
        let source = recorder.sources().next().map(str::to_owned);
        let Some(target) = recorder.targets().next().map(str::to_owned) else {
            return Err(Error::DrawSource { what: format!("`{}` writes nothing", recorder.pass()) });
        };
        match source {
            Some(source) => recorder.copy(&source, &target),
            None => recorder.fill(&target, to_frame::fill(self.0, *to, *value)),
        }
        Ok(())
    }
}
