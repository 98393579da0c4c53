//! Holds what a driver makes of chains, in every way to compile them, against what they mean.

use super::meaning::{self, Shown, State};
use super::text::{Output, QUARTER, Text, What, text};
use super::{Chain, EXTENT, Life};
use crate::render;
use framewright_graph::base::{self, Diagnostic, Root, Sources};
use framewright_graph::compile::{Options, Order, compile};
use framewright_graph::expand::{self, Inputs};
use framewright_graph::frame::{self, Frame, Stereo};
use framewright_graph::language::{self, Facts};
use framewright_graph::plan::{Attachment, AttachmentKind, Hazard, Plan, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{Layout, LoadOp, Rotation};
use framewright_passes::draw::interfaces;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::{Device, DrawSource, Error, Executor, ExecutorOptions, Message, Recorder, ShaderLibrary};
use std::fmt;
use std::sync::Arc;
use tempfile::TempDir;

/// Frames that are drawn: then what is left of the first one has been lost, if it can be.
const FRAMES: u32 = 3;

/// A device with the validation layer awake.
pub struct Judge {
    device: Device,
    findings: usize,
}

/// A mistake on the way from chains to their pictures.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The file is refused.
    Refused(String),
    /// The checker finds fault with a Plan.
    Violations(String),
    /// A Plan couldn't be executed.
    NotExecuted(String),
    /// The validation layer has something to say.
    Findings(String),
    /// A Plan forgets what an image held before the frame, which matters.
    Forgets(String),
    /// A texel is another.
    Differs(String),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::Refused(words) => write!(f, "it is refused: {words}"),
            Fault::Violations(words) => write!(f, "the checker finds: {words}"),
            Fault::NotExecuted(words) => write!(f, "it can't be executed: {words}"),
            Fault::Findings(words) => write!(f, "the validation layer says: {words}"),
            Fault::Forgets(words) | Fault::Differs(words) => write!(f, "{words}"),
        }
    }
}

/// A way to compile and draw chains. None changes a picture.
struct Way {
    name: &'static str,
    options: Options,
    /// Attachments whose contents don't matter, as the Plan says, are cleared to something else.
    loud: bool,
}

/// All ways.
fn ways(seed: u64) -> [Way; 7] {
    let default = Options::default();
    let poison = Options { poison: true, ..default };
    let way = |name, options| Way { name, options, loud: false };
    [
        way("as it is", default),
        way("naive", Options { demote: false, ..default }),
        way("poisoned", poison),
        way("in the file's order", Options { order: Order::File, ..poison }),
        way("in the order of little memory", Options { order: Order::LowMemory, demote: false, ..poison }),
        way("in any order, with one image a pass", Options { order: Order::Random(seed), alias: false, ..poison }),
        Way { loud: true, ..way("with all that it forgets overwritten", default) },
    ]
}

impl Judge {
    /// Opens the device of the tests; `None`, with a message, where there is none.
    #[must_use]
    pub fn new() -> Option<Judge> {
        Some(Judge { device: render::own_device()?, findings: 0 })
    }

    /// Draws chains in every way, frame after frame, and compares what is shown of them.
    ///
    /// # Errors
    /// The first [`Fault`], with the way.
    pub fn judge(&mut self, chains: &[Chain], seed: u64) -> Result<(), Fault> {
        let text = text(chains);
        let folder = tempfile::tempdir().map_err(|error| Fault::NotExecuted(error.to_string()))?;
        let mut shaders = library(&folder, &text).map_err(|error| Fault::NotExecuted(error.to_string()))?;
        let frame = frame_of(&text, &mut shaders)?;
        let expected = expected(chains);
        for way in ways(seed) {
            let judged = self.way(&way, chains, &text, &frame, &mut shaders, &expected);
            let all = self.device.messages().list();
            let new: Vec<&Message> = all.iter().filter(|message| message.is_finding()).skip(self.findings).collect();
            self.findings += new.len();
            if let Some(first) = new.first() {
                return Err(Fault::Findings(format!("{}: {}: {}", way.name, first.id, first.text)));
            }
            judged?;
        }
        Ok(())
    }

    fn way(
        &self,
        way: &Way,
        chains: &[Chain],
        text: &Text,
        frame: &Frame,
        shaders: &mut ShaderLibrary,
        expected: &[Vec<Vec<Shown>>],
    ) -> Result<(), Fault> {
        let plan = compile(frame, &self.device.profile(), &mut self.device.memory(), &way.options);
        let mut plan = plan.map_err(|errors| Fault::Refused(errors.into_iter().map(|it| it.message).collect()))?;
        if let Some(violation) = verify(&plan).first() {
            return Err(Fault::Violations(violation.to_string()));
        }
        forgets(&plan, chains)?;
        if way.loud {
            overwrite(&mut plan);
        }
        let broken = |error: Error| Fault::NotExecuted(format!("{}: {error}", way.name));
        let options = ExecutorOptions { poison: way.options.poison, ..ExecutorOptions::default() };
        let mut executor = Executor::new(&self.device, &plan, shaders, &options).map_err(broken)?;
        for (number, expected) in expected.iter().enumerate() {
            executor.frame(&mut Nothing).map_err(broken)?;
            for (output, it) in text.outputs.iter().enumerate() {
                let found = executor.read(output).map_err(broken)?.bytes;
                if let Some(words) = different(it, &expected[it.chain][it.shown], &found) {
                    let Output { chain, shown, what } = it;
                    let words = format!("{}: frame {number}, a{chain}, shown {shown}, {what:?}: {words}", way.name);
                    return Err(Fault::Differs(words));
                }
            }
        }
        Ok(())
    }
}

/// The smallest part of chains that fails in the same way.
pub fn shrunk(judge: &mut Judge, chains: &[Chain], fault: &Fault, seed: u64) -> (Vec<Chain>, Fault) {
    let (mut smallest, mut why) = (chains.to_vec(), fault.clone());
    loop {
        let smaller = (0..smallest.len()).flat_map(|chain| {
            let links = smallest[chain].links.len();
            (0..=links).map(move |link| (chain, link))
        });
        let found = smaller.collect::<Vec<_>>().into_iter().find_map(|(chain, link)| {
            let mut tried = smallest.clone();
            if link == tried[chain].links.len() {
                tried.remove(chain);
            } else {
                tried[chain].links.remove(link);
                tried[chain].links.last_mut()?.shown = true;
            }
            let fails = judge.judge(&tried, seed).err()?;
            (!tried.is_empty() && std::mem::discriminant(&fails) == std::mem::discriminant(fault))
                .then_some((tried, fails))
        });
        let Some((tried, fails)) = found else { return (smallest, why) };
        (smallest, why) = (tried, fails);
    }
}

/// A library over shaders that are written into a folder.
fn library(folder: &TempDir, text: &Text) -> std::io::Result<ShaderLibrary> {
    for (name, text) in &text.shaders {
        std::fs::write(folder.path().join(name), text)?;
    }
    Ok(ShaderLibrary::new(vec![Root::new(folder.path().to_owned())], SHADERS, interfaces()))
}

fn frame_of(text: &Text, shaders: &mut ShaderLibrary) -> Result<Frame, Fault> {
    let mut sources = Sources::default();
    let read = language::read(&mut sources, "partial.ron", "partial.ron", text.pipeline.clone());
    let sources = Arc::new(sources);
    let refused = |mistakes: Vec<Diagnostic>| Fault::Refused(base::render(&sources, &mistakes));
    let inputs = Inputs {
        set: &[],
        facts: Facts::UNKNOWN,
        facts_known: false,
        output_extent: EXTENT,
        rotation: Rotation::Identity,
        dump: &[],
        device: None,
        stereo: Stereo::Off,
        window: None,
    };
    expand::expand(&read.map_err(refused)?, sources.clone(), &inputs, shaders).map_err(refused)
}

/// What is shown, by frame, chain and state.
fn expected(chains: &[Chain]) -> Vec<Vec<Vec<Shown>>> {
    let mut states: Vec<State> = chains.iter().map(State::new).collect();
    let mut frame = || {
        let mut all = Vec::new();
        for (chain, state) in chains.iter().zip(&mut states) {
            let (shown, after) = meaning::frame(chain, state);
            *state = after;
            all.push(shown);
        }
        all
    };
    (0..FRAMES).map(|_| frame()).collect()
}

/// Drivers keep what a barrier from `UNDEFINED` forgets, so no picture shows it: what mustn't be forgotten is found on the CPU.
fn forgets(plan: &Plan, chains: &[Chain]) -> Result<(), Fault> {
    for (number, chain) in chains.iter().enumerate().filter(|(_, chain)| chain.life == Life::Persistent) {
        let before = State::new(chain);
        if meaning::frame(chain, &before) == meaning::frame(chain, &before.changed()) {
            continue;
        }
        let name = format!("a{number}");
        let barriers = plan.steps.iter().flat_map(|step| &step.image_barriers);
        let mut first = barriers.filter(|it| it.hazard == Hazard::FirstUse && it.old_layout == Layout::Undefined);
        if first.any(|barrier| *plan.image(barrier.image).name == *name) {
            return Err(Fault::Forgets(format!(
                "each frame forgets what `{name}` held before it, and shows some of it"
            )));
        }
    }
    Ok(())
}

/// Clears attachments whose contents don't matter, as a Plan has it.
fn overwrite(plan: &mut Plan) {
    for step in &mut plan.steps {
        let Work::Render(scope) = &mut step.work else { continue };
        let clear = |attachment: &mut Attachment, value: [f64; 4]| {
            if attachment.load == LoadOp::DontCare {
                (attachment.load, attachment.clear) = (LoadOp::Clear, Some(value));
            }
        };
        for attachment in &mut scope.attachments {
            match attachment.kind {
                AttachmentKind::Color => clear(attachment, [0.9, 0.1, 0.8, 0.3]),
                AttachmentKind::Depth => clear(attachment, [1.0, 0.0, 0.0, 0.0]),
                AttachmentKind::Stencil => clear(attachment, [3.0, 0.0, 0.0, 0.0]),
            }
        }
    }
}

/// The first texel that is another, in words.
fn different(output: &Output, expected: &Shown, found: &[u8]) -> Option<String> {
    let texels = expected.iter().zip(found.as_chunks::<4>().0).enumerate();
    let mut wrong = texels.filter_map(|(at, ((color, depth), found))| {
        let (expected, found) = match output.what {
            What::Color => (*color, *found),
            What::Depth => ([depth * QUARTER; 4], *found),
            What::Word => ([color[0]; 4], *found),
        };
        let place = [at as u32 % EXTENT[0], at as u32 / EXTENT[0]];
        (expected != found).then(|| format!("{place:?} should be {expected:?} and is {found:?}"))
    });
    let first = wrong.next()?;
    Some(format!("{first}, and {} more", wrong.count()))
}

/// The program around chains: it draws nothing.
struct Nothing;

impl DrawSource for Nothing {
    fn record(&mut self, draw: frame::Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Err(Error::DrawSource { what: format!("nobody draws {draw:?}") })
    }
}
