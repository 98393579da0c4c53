//! Settings, conditions, facts and sizes are put in: a pipeline becomes one flat frame.
//!
//! ```text
//! Pipeline ─► settings ─► images and buffers ─► conditions ─► passes (parts, shaders) ─► order ─► Frame
//! ```
//! Every stage goes on past mistakes, so that all independent ones are reported at once.

mod conditions;
mod fills;
mod images;
mod local;
mod order;
mod params;
mod parts;
mod passes;
mod sampled;
mod settings;
mod shader;
mod shapes;
mod states;
mod storage;
mod supplied;
mod targets;
mod things;
mod touches;
mod transfers;
mod waits;
mod work;
mod written;

pub use crate::facts::Facts;

use crate::describe::{self, Diagnostic, LARGEST_SIZE, Pipeline, suggestion};
use crate::frame::{Frame, ImageIndex, Output, ParamValue, Resource, SwitchedOff};
use crate::interface::ShaderInterfaces;
use crate::source::{Sources, Span};
use std::sync::Arc;
use things::Things;

/// What a pipeline is put together with.
#[derive(Debug, Clone, Copy)]
pub struct Inputs<'a> {
    /// Chosen settings, name and value as the user wrote them; of several values for one setting the last counts.
    pub set: &'a [(String, String)],
    /// What is known about the scene.
    pub facts: Facts,
    /// Whether there is a scene at all; if not, [`Facts::UNKNOWN`] counts.
    pub facts_known: bool,
    /// Width and height of the frame, in texels, 1 to 16384 each.
    pub output_extent: [u32; 2],
    /// Names of further images that leave the frame.
    pub dump: &'a [String],
}

/// What expansion asks everywhere: the pipeline, and the values of its settings.
struct Chosen<'a> {
    pipeline: &'a Pipeline,
    values: Vec<settings::SettingValue>,
    facts: Facts,
}

/// What is wrong with `inputs` themselves: settings that the pipeline doesn't have or values that they don't allow, a size
/// that no frame has, names of no image. [`expand`] reports these too; a program that tells its user's command line from
/// its user's files asks here first.
#[must_use]
pub fn check_inputs(pipeline: &Pipeline, inputs: &Inputs<'_>) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    settings::choose(pipeline, inputs.set, &mut errors);
    check_extent(inputs.output_extent, &mut errors);
    dumped(pipeline, inputs.dump, &mut Vec::new(), &mut errors);
    errors
}

fn check_extent(extent: [u32; 2], errors: &mut Vec<Diagnostic>) {
    let [width, height] = extent;
    if extent.iter().any(|extent| !(1..=LARGEST_SIZE).contains(extent)) {
        errors.push(nowhere(format!("the frame can't be {width}×{height}: 1 to {LARGEST_SIZE} texels are allowed")));
    }
}

/// Puts settings, facts and sizes into a pipeline and checks it against its shaders. `sources` are those that the
/// pipeline was read into.
///
/// # Errors
/// Everything that is wrong with these inputs, with the order of passes, and between passes and shaders.
pub fn expand(
    pipeline: &Pipeline,
    sources: Arc<Sources>,
    inputs: &Inputs<'_>,
    shaders: &mut dyn ShaderInterfaces,
) -> Result<Frame, Vec<Diagnostic>> {
    let mut errors = Vec::new();
    let facts = if inputs.facts_known { inputs.facts } else { Facts::UNKNOWN };
    let chosen = Chosen { pipeline, values: settings::choose(pipeline, inputs.set, &mut errors), facts };
    let before = errors.len();
    check_extent(inputs.output_extent, &mut errors);
    if errors.len() > before {
        return Err(errors);
    }
    let things = Things::resolve(&chosen, inputs.output_extent, &mut errors);

    let mut checked = shader::Checked::new(shaders);
    let mut states = Vec::with_capacity(pipeline.passes.len());
    let mut switched_off = Vec::new();
    for pass in &pipeline.passes {
        targets::fit(&chosen, &things, pass, &mut errors);
        let because = pass.when.as_ref().and_then(|condition| conditions::failing(&chosen, condition));
        states.push(match (because, &pass.when) {
            (Some(because), Some(condition)) => {
                let name = pass.name.text.clone();
                switched_off.push(SwitchedOff { name, span: condition.span, because: because.clone() });
                // What a pass that is off would do wrong does no harm.
                let would = passes::draft(&chosen, &things, pass, None, &mut Vec::new());
                order::State::Off { would, stand_in: passes::stand_in(pass, because.clone()).map(Box::new), because }
            }
            _ => order::State::On(passes::lower(&chosen, &things, pass, &mut checked, &mut errors)),
        });
    }
    let outputs = outputs(&chosen, &things, inputs.dump, &mut errors);
    order::check(&chosen, &things, &states, &outputs, &mut errors);

    let Things { images, buffers } = things;
    let images = images.into_iter().map(|image| image.map(|image| image.image)).collect::<Option<Vec<_>>>();
    match (images, buffers.into_iter().collect::<Option<Vec<_>>>()) {
        (Some(images), Some(buffers)) if errors.is_empty() => {
            let settings = settings::shown(pipeline, &chosen.values);
            let passes = states.into_iter().filter_map(order::State::into_pass).collect();
            Ok(Frame { sources, settings, views: Vec::new(), images, buffers, passes, outputs, switched_off })
        }
        _ => {
            errors.sort_by_key(|error| error.labels.first().map_or(0, |label| label.span.start));
            Err(errors)
        }
    }
}

/// The pipeline's outputs, then dumped images that aren't among them.
fn outputs(chosen: &Chosen<'_>, things: &Things, dump: &[String], errors: &mut Vec<Diagnostic>) -> Vec<Output> {
    let pipeline = chosen.pipeline;
    let mut outputs = Vec::with_capacity(pipeline.outputs.len() + dump.len());
    for output in &pipeline.outputs {
        let describe::ResourceRef { resource, span } = output.resource;
        let after = output.after.and_then(|after| things.left(chosen, resource, after, errors));
        outputs.push(Output { resource, span, after });
    }
    dumped(pipeline, dump, &mut outputs, errors);
    outputs
}

/// Adds images that are dumped.
fn dumped(pipeline: &Pipeline, dump: &[String], outputs: &mut Vec<Output>, errors: &mut Vec<Diagnostic>) {
    for name in dump {
        let Some(index) = pipeline.images.iter().position(|image| *image.name.text == **name) else {
            let help = suggestion(name, pipeline.images.iter().map(|image| &*image.name.text));
            errors.push(Diagnostic { help, ..nowhere(format!("there is no image named `{name}` to dump")) });
            continue;
        };
        let Ok(index) = u32::try_from(index) else { continue };
        let resource = Resource::Image(ImageIndex(index));
        if outputs.iter().all(|output| output.resource != resource) {
            outputs.push(Output { resource, span: Span::NONE, after: None });
        }
    }
}

/// A mistake that stands in no file.
fn nowhere(message: String) -> Diagnostic {
    Diagnostic { message, labels: Vec::new(), help: None }
}

impl<'a> Chosen<'a> {
    fn image(&self, index: ImageIndex) -> &'a describe::Image {
        &self.pipeline.images[index.0 as usize]
    }

    fn setting(&self, reference: describe::SettingRef) -> (&'a describe::Setting, settings::SettingValue) {
        (&self.pipeline.settings[reference.index], self.values[reference.index])
    }

    /// A constant, or the value of a whole-number setting. `None` only for what reading a pipeline rules out.
    fn whole<T: TryFrom<i64>>(&self, value: describe::Value<T>) -> Option<T> {
        match value {
            describe::Value::Constant(value) => Some(value),
            describe::Value::Setting(reference) => match self.setting(reference).1 {
                ParamValue::Integer(value) => T::try_from(value).ok(),
                ParamValue::Bool(_) | ParamValue::Number(_) => None,
            },
        }
    }
}
