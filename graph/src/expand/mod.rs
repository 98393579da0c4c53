//! Settings, facts, the view and the device are put in: a pipeline becomes one flat frame.
//!
//! ```text
//! Document ─► settings ─► language::lower ─► images and buffers ─► passes (parts, shaders) ─► order ─► Frame
//! ```
//! Every stage goes on past mistakes, so that all independent ones are reported at once.

mod accesses;
mod casters;
mod depth_only;
mod eyes;
mod fills;
mod follow;
mod halves;
mod history;
mod images;
mod local;
mod once;
mod order;
mod params;
mod parts;
mod passes;
mod precision;
mod rotation;
mod sampled;
mod settings;
mod shader;
mod shapes;
mod states;
mod storage;
mod supplied;
mod targets;
mod things;
mod transfers;
mod variant;
mod views;
mod waits;
mod work;
mod written;

pub use crate::language::Facts;

use crate::base::{Diagnostic, Label, Sources, Span, suggestion};
use crate::device::Profile;
use crate::frame::{Allowances, Eye, Frame, ImageIndex, Output, Resource, Stereo, SwitchedOff, View, ViewIndex};
use crate::language::{self, Document, LARGEST_SIZE, Pipeline, Surroundings, USED_HERE};
use crate::ron::Spanned;
use crate::shader::ShaderInterfaces;
use crate::vulkan::{Encoding, Rotation};
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
    /// The device that the frame is for; `None`: one that can do just what Vulkan 1.3 demands. Only pipelines that ask for
    /// properties of the device depend on it, and frames of instances for both eyes: in layers or in halves.
    pub device: Option<&'a Profile>,
    /// By how much what is shown on a screen is turned: outputs whose image has `format: Output`, or that leave the frame as
    /// `Hdr10`. Sizes are those of the upright picture.
    pub rotation: Rotation,
    /// Names of further images that leave the frame.
    pub dump: &'a [String],
    /// How it is drawn for two eyes.
    pub stereo: Stereo,
}

/// What expansion asks everywhere.
struct Chosen<'a> {
    pipeline: &'a Pipeline,
    /// Width and height of the frame.
    extent: [u32; 2],
}

/// What is wrong with `inputs` themselves: settings that the pipeline doesn't have or values that they don't allow, a size
/// that no frame has, names of no image. [`expand`] reports these too; a program that tells its user's command line from
/// its user's files asks here first.
#[must_use]
pub fn check_inputs(document: &Document, inputs: &Inputs<'_>) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    let values = settings::choose(document, inputs.set, &mut errors);
    check_extent(inputs.output_extent, &mut errors);
    if errors.is_empty()
        && !inputs.dump.is_empty()
        && let Ok(pipeline) = document.lower(&settings::values(&values), &surroundings(inputs))
    {
        dumped(&pipeline, inputs.dump, &mut Vec::new(), &mut errors);
    }
    errors
}

fn surroundings<'a>(inputs: &Inputs<'a>) -> Surroundings<'a> {
    let facts = if inputs.facts_known { inputs.facts } else { Facts::UNKNOWN };
    let eyes = if inputs.stereo == Stereo::Off { 1 } else { 2 };
    let allows = Allowances::default();
    Surroundings { facts, extent: inputs.output_extent, eyes, allows, device: inputs.device }
}

fn check_extent(extent: [u32; 2], errors: &mut Vec<Diagnostic>) {
    let [width, height] = extent;
    if extent.iter().any(|extent| !(1..=LARGEST_SIZE).contains(extent)) {
        errors.push(Diagnostic::nowhere(format!(
            "the frame can't be {width}×{height}: 1 to {LARGEST_SIZE} texels are allowed"
        )));
    }
}

/// Puts settings, facts, sizes and the device into a pipeline and checks it against its shaders. `sources` are those that
/// the document was read into.
///
/// # Errors
/// Everything that is wrong with these inputs, with the file, with the order of passes, and between passes and shaders.
pub fn expand(
    document: &Document,
    sources: Arc<Sources>,
    inputs: &Inputs<'_>,
    shaders: &mut dyn ShaderInterfaces,
) -> Result<Frame, Vec<Diagnostic>> {
    let expanded = expand_so(document, Arc::clone(&sources), inputs, shaders);
    if expanded.is_ok() || inputs.stereo == Stereo::Off {
        return expanded;
    }
    // What is wrong for one eye is told once.
    let one = expand_so(document, sources, &Inputs { stereo: Stereo::Off, ..*inputs }, shaders);
    one.and(expanded)
}

fn expand_so(
    document: &Document,
    sources: Arc<Sources>,
    inputs: &Inputs<'_>,
    shaders: &mut dyn ShaderInterfaces,
) -> Result<Frame, Vec<Diagnostic>> {
    let mut errors = Vec::new();
    let values = settings::choose(document, inputs.set, &mut errors);
    let before = errors.len();
    check_extent(inputs.output_extent, &mut errors);
    if errors.len() > before {
        return Err(errors);
    }
    let pipeline = match document.lower(&settings::values(&values), &surroundings(inputs)) {
        Ok(pipeline) => pipeline,
        Err(mistakes) => {
            errors.extend(mistakes);
            language::users_first(&sources, &mut errors);
            return Err(errors);
        }
    };
    let stereo = inputs.stereo;
    let (pipeline, shared) =
        eyes::split(pipeline, (stereo, stereo.form(inputs.device)), inputs.output_extent, &mut errors);
    let chosen = Chosen { pipeline: &pipeline, extent: inputs.output_extent };
    let mut said = once::Said::default();
    let mut things = Things::resolve(&chosen, &mut errors);
    said.each_once(&mut errors, 0);

    let mut checked = shader::Checked::new(shaders, &sources);
    let mut states = Vec::with_capacity(pipeline.passes.len());
    let mut switched_off = Vec::new();
    for pass in &pipeline.passes {
        let before = errors.len();
        targets::fit(&chosen, &things, pass, &mut errors);
        let left_out = pass.left_out.iter().filter(|_| pass.off.is_none());
        switched_off.extend(left_out.map(|language::LeftOut { binding, off, .. }| SwitchedOff {
            name: pass.name.text.clone(),
            sampled: Some(binding.text.clone()),
            span: off.span,
            because: off.because.clone(),
        }));
        states.push(match &pass.off {
            Some(language::Off { span, because }) => {
                let name = pass.name.text.clone();
                switched_off.push(SwitchedOff { name, sampled: None, span: *span, because: because.clone() });
                // What a pass that is off would do wrong does no harm.
                let would = passes::draft(&chosen, &things, pass, None, &mut Vec::new());
                let stand_ins = passes::stand_ins(&things, pass, because, &mut errors);
                order::State::Off { would, stand_ins, because: because.clone() }
            }
            None => order::State::On(passes::lower(&chosen, &things, pass, &mut checked, &mut errors)),
        });
        said.once(&mut errors, before);
        if errors.len() >= crate::base::MOST_KEPT {
            return Err(told(document, &sources, errors));
        }
        used_here(&pipeline, pass.instance, &mut errors[before..]);
    }
    depth_only::note(&chosen, &things, &mut states, &mut checked);
    casters::agree(&pipeline, &states, &mut errors);
    let outputs = outputs(&chosen, &things, inputs, &mut errors);
    let before = errors.len();
    order::check(&chosen, &things, &states, &outputs, &mut errors);
    said.each_once(&mut errors, before);
    if errors.is_empty() {
        history::shorten(&mut things, &states);
    }
    let kept = precision::choose(
        &chosen,
        surroundings(inputs).facts.depth_range,
        &mut things,
        &states,
        &outputs,
        &mut checked,
    );

    let Things { images, buffers } = things;
    let images = images.into_iter().map(|image| image.map(|image| image.image)).collect::<Option<Vec<_>>>();
    match (images, buffers.into_iter().collect::<Option<Vec<_>>>()) {
        (Some(images), Some(buffers)) if errors.is_empty() => {
            let settings = settings::shown(&document.settings, &values);
            let passes = states.into_iter().flat_map(order::State::into_passes).collect();
            let changes = document.changes().to_vec();
            let views = pipeline.views.iter().map(view).collect();
            let remarks = [shared, views::remarks(&chosen), kept].concat();
            Ok(Frame {
                sources,
                settings,
                changes,
                stereo,
                views,
                images,
                buffers,
                passes,
                outputs,
                switched_off,
                remarks,
            })
        }
        _ => Err(told(document, &sources, errors)),
    }
}

/// Mistakes in their order, each with how its file came in.
fn told(document: &Document, sources: &Sources, mut errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    document.tell_origins(&mut errors);
    language::users_first(sources, &mut errors);
    language::in_order(errors)
}

fn view(described: &language::View) -> View {
    let language::View { name, extent, camera, allows, jitter, eye } = described;
    let camera = camera.as_ref().map(|camera| camera.text.clone());
    let (allows, jitter) = (*allows, jitter.clone());
    View { name: name.text.clone(), span: name.span, extent: *extent, camera, allows, jitter, eye: *eye }
}

/// Says of mistakes in a fragment where it was used.
fn used_here(pipeline: &Pipeline, instance: Option<u32>, errors: &mut [Diagnostic]) {
    let mut next = instance;
    while let Some(instance) = next.and_then(|at| pipeline.instances.get(at as usize)) {
        for error in errors.iter_mut() {
            error.labels.push(Label { span: instance.span, text: format!("{USED_HERE}`{}`", instance.name) });
        }
        next = instance.within;
    }
}

/// The pipeline's outputs, then dumped images that aren't among them.
fn outputs(chosen: &Chosen<'_>, things: &Things, inputs: &Inputs<'_>, errors: &mut Vec<Diagnostic>) -> Vec<Output> {
    let dump = inputs.dump;
    let pipeline = chosen.pipeline;
    let mut outputs = Vec::with_capacity(pipeline.outputs.len() + dump.len());
    for output in &pipeline.outputs {
        let language::ResourceRef { resource, span } = output.resource;
        let after = output.after.and_then(|after| things.left(chosen, resource, after, errors));
        let encoding = output.encoding.filter(|encoding| encoded(chosen, things, resource, *encoding, errors));
        let encoding = encoding.map(|encoding| encoding.value);
        let rotation = if shown(chosen, resource, encoding) { inputs.rotation } else { Rotation::Identity };
        outputs.push(Output { resource, span, after, encoding, rotation, eye: output.eye });
    }
    if inputs.rotation.turns() && !outputs.iter().any(|output| output.rotation.turns()) {
        let degrees = inputs.rotation.degrees();
        let message = format!("nothing can be rotated by {degrees}°: no output is made to be shown on a screen");
        let span = pipeline.outputs.first().map_or(Span::NONE, |output| output.resource.span);
        let images = pipeline.outputs.iter().filter_map(|output| match output.resource.resource {
            Resource::Image(image) => Some(&chosen.image(image).name.text),
            Resource::Buffer(_) => None,
        });
        let wrong = Diagnostic::new(span, message);
        errors.push(match images.into_iter().next() {
            Some(image) => wrong.help(format!("say `format: Output` of `{image}`")),
            None => wrong.help("let an image leave the frame"),
        });
    }
    dumped(pipeline, dump, &mut outputs, errors);
    outputs
}

/// Whether an output is made to be shown on a screen.
fn shown(chosen: &Chosen<'_>, resource: Resource, encoding: Option<Encoding>) -> bool {
    let Resource::Image(image) = resource else { return false };
    chosen.image(image).format.value == language::Format::Output || encoding == Some(Encoding::Hdr10)
}

/// Whether an output's format can hold its encoding.
fn encoded(
    chosen: &Chosen<'_>,
    things: &Things,
    of: Resource,
    encoding: Spanned<Encoding>,
    errors: &mut Vec<Diagnostic>,
) -> bool {
    let Resource::Image(index) = of else { return false };
    let Some(format) = things.image(index).map(|image| image.image.format) else { return false };
    let fits = encoding.value.fits(format);
    if !fits {
        let (image, word) = (chosen.image(index), encoding.value.name());
        let message = format!("`{}` can't leave the frame as `{word}`: it is {format}", image.name.text);
        let wrong = Diagnostic::new(encoding.span, message).label(image.format.span, "its format");
        errors.push(wrong.help(encoding.value.help(&image.name.text)));
    }
    fits
}

/// Adds images that are dumped.
fn dumped(pipeline: &Pipeline, dump: &[String], outputs: &mut Vec<Output>, errors: &mut Vec<Diagnostic>) {
    for name in dump {
        let of_eyes = Eye::BOTH.map(|eye| eye.named(name));
        let is_it = |image: &language::Image| *image.name.text == **name || of_eyes.contains(&image.name.text);
        let found: Vec<(usize, Option<Eye>)> = (0..)
            .zip(&pipeline.images)
            .filter(|(_, image)| is_it(image))
            .map(|(at, image)| (at, Eye::BOTH.into_iter().find(|eye| of_eyes[*eye as usize] == image.name.text)))
            .collect();
        if found.is_empty() {
            let help = suggestion(name, pipeline.images.iter().map(|image| &*image.name.text));
            errors
                .push(Diagnostic { help, ..Diagnostic::nowhere(format!("there is no image named `{name}` to dump")) });
        }
        for (index, eye) in found {
            if let language::Lifetime::File(file) = &pipeline.images[index].lifetime.value {
                let why = format!("`{name}` can't be dumped: no pass makes it, it comes from `{}`", file.path);
                errors.push(Diagnostic::nowhere(why));
                continue;
            }
            let Ok(index) = u32::try_from(index) else { continue };
            let resource = Resource::Image(ImageIndex(index));
            if outputs.iter().all(|output| output.resource != resource) {
                outputs.push(Output { eye, ..resource.into() });
            }
        }
    }
}

impl<'a> Chosen<'a> {
    /// Width and height of a view.
    fn extent(&self, view: ViewIndex) -> [u32; 2] {
        self.pipeline.views.get(view.0 as usize).map_or(self.extent, |view| view.extent)
    }

    fn image(&self, index: ImageIndex) -> &'a language::Image {
        &self.pipeline.images[index.0 as usize]
    }
}
