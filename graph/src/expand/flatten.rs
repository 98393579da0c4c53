//! A pipeline becomes a frame, stage by stage.

use super::contents::accesses::CutImages;
use super::contents::{history, order, padding, storage_writes};
use super::expander::Expander;
use super::inputs::{Inputs, check_extent, surroundings};
use super::mistakes::{ReportedMistakes, used_here};
use super::outputs::{dumped, kept_dumps, outputs};
use super::passes::{State, casters, depth_only, targets, views};
use super::resources::Resources;
use super::{decisions, eyes, passes, precision, settings, shader};
use crate::base::{Diagnostic, MOST_KEPT, Sources};
use crate::frame::{Frame, Remark, Stereo, SwitchedOff, View};
use crate::language::{self, Document, Read, Reads};
use crate::shader::ShaderInterfaces;
use std::collections::HashSet;
use std::sync::Arc;

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
    expand_reading(document, sources, inputs, shaders, None)
}

/// As [`expand`]. Settings and facts that the result depends on are added to `reads`: the frame of other inputs is the same, but
/// for the values of [`Frame::settings`], if these are the same, and all that is no setting or fact.
///
/// # Errors
/// As [`expand`].
pub fn expand_reading(
    document: &Document,
    sources: Arc<Sources>,
    inputs: &Inputs<'_>,
    shaders: &mut dyn ShaderInterfaces,
    reads: Option<&Reads>,
) -> Result<Frame, Vec<Diagnostic>> {
    for_eyes(document, sources, inputs, shaders, reads, None)
}

/// As [`expand_reading`], with what `kept` has of the last frame.
pub(super) fn for_eyes(
    document: &Document,
    sources: Arc<Sources>,
    inputs: &Inputs<'_>,
    shaders: &mut dyn ShaderInterfaces,
    reads: Option<&Reads>,
    kept: Option<&mut Expander>,
) -> Result<Frame, Vec<Diagnostic>> {
    let expanded = expand_so(document, Arc::clone(&sources), inputs, shaders, reads, kept);
    if expanded.is_ok() || inputs.stereo == Stereo::Off {
        return expanded;
    }
    // A mistake that one eye has, too, is told once.
    let one = expand_so(document, sources, &Inputs { stereo: Stereo::Off, ..*inputs }, shaders, reads, None);
    one.and(expanded)
}

/// Mistakes in `inputs` themselves: settings that the pipeline doesn't have, values that they don't allow, a size that no
/// frame has, names of no image. [`expand`] reports these too; a program that tells its user's command
/// line from its user's files asks here first.
#[must_use]
pub fn check_inputs(document: &Document, inputs: &Inputs<'_>) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    let values = settings::choose(document, inputs.set, &mut errors);
    check_extent(inputs.output_extent, &mut errors);
    if errors.is_empty()
        && !inputs.dump.is_empty()
        && let Ok(pipeline) = document.lower(&settings::values(&values), &surroundings(inputs, None))
    {
        dumped(&pipeline, inputs.dump, &mut Vec::new(), &mut errors);
    }
    errors
}

fn expand_so(
    document: &Document,
    sources: Arc<Sources>,
    inputs: &Inputs<'_>,
    shaders: &mut dyn ShaderInterfaces,
    reads: Option<&Reads>,
    kept: Option<&mut Expander>,
) -> Result<Frame, Vec<Diagnostic>> {
    let (entries, mut kept) = kept.map(|kept| (&mut kept.entries, &mut kept.passes)).unzip();
    let mut errors = Vec::new();
    let values = settings::choose(document, inputs.set, &mut errors);
    if !errors.is_empty()
        && let Some(reads) = reads
    {
        (0..document.settings.len()).for_each(|at| reads.add(Read::Setting(at)));
    }
    let before = errors.len();
    check_extent(inputs.output_extent, &mut errors);
    if errors.len() > before {
        return Err(errors);
    }
    let pipeline = match document.lower_again(&settings::values(&values), &surroundings(inputs, reads), entries) {
        Ok(pipeline) => pipeline,
        Err(mistakes) => {
            errors.extend(mistakes);
            language::users_first(&sources, &mut errors);
            return Err(errors);
        }
    };
    let stereo = inputs.stereo;
    let mut checked = shader::CheckedShaders::new(shaders, &sources);
    let by_instance = |pass: &language::Pass| checked.draws_by_instance(pass);
    let eyes = eyes::Eyes { stereo, form: stereo.form(inputs.device), by_instance: &by_instance };
    let (pipeline, shared) = eyes::split(pipeline, &eyes, inputs.output_extent, &mut errors);
    let mut reported = ReportedMistakes::default();
    reported.each_once(&mut errors, 0);
    let mut resources = Resources::resolve(&pipeline, inputs, &mut reported, &mut errors);
    kept.iter_mut().for_each(|kept| kept.begin(&resources, inputs));

    let mut states = Vec::with_capacity(pipeline.passes.len());
    let mut switched_off = Vec::new();
    for pass in &pipeline.passes {
        let left_out = pass.left_out.iter().filter(|_| pass.off.is_none());
        switched_off.extend(left_out.map(|language::LeftOutSample { binding, off, .. }| SwitchedOff {
            name: pass.name.text.clone(),
            sampled: Some(binding.text.clone()),
            span: off.span,
            because: off.because.clone(),
        }));
        if let Some((lowered, remarks)) = kept.as_mut().and_then(|kept| kept.lowered(pass)) {
            checked.remarks.extend(remarks);
            states.push(State::On(lowered));
            continue;
        }
        let before = errors.len();
        targets::fit(&resources, pass, &mut errors);
        states.push(match &pass.off {
            Some(language::OffReason { span, because }) => {
                let name = pass.name.text.clone();
                switched_off.push(SwitchedOff { name, sampled: None, span: *span, because: because.clone() });
                // Mistakes of a pass that is off do no harm.
                let would = passes::draft(&resources, pass, None, &mut Vec::new());
                let stand_ins = passes::stand_ins(&resources, pass, because, &mut errors);
                State::Off { would, stand_ins, because: because.clone() }
            }
            None => {
                let known = checked.remarks.len();
                let lowered = passes::lower(&resources, pass, &mut checked, &mut errors);
                kept.iter_mut().for_each(|kept| kept.keep(pass, &lowered, &checked.remarks[known..]));
                State::On(lowered)
            }
        });
        reported.once(&mut errors, before);
        if errors.len() >= MOST_KEPT {
            return Err(told(document, &sources, errors));
        }
        used_here(&pipeline, pass.instance, &mut errors[before..]);
    }
    kept.iter_mut().for_each(|kept| kept.end());
    depth_only::note(&resources, &mut states, &mut checked);
    casters::agree(&resources, &states, &mut errors);
    let outputs = outputs(&resources, inputs, &mut errors);
    let cut = CutImages::new(&resources, states.iter().flat_map(State::runs));
    let parts = cut.parts();
    kept_dumps(&resources, (&states, &outputs), &parts, &mut errors);
    let stored = storage_writes::keep(&resources, &mut states, &parts, &mut checked);
    order::check(&resources, &states, &outputs, &parts, (&mut reported, &mut errors));
    if errors.is_empty() {
        history::shorten(&mut resources, &states);
    }
    let decided = decisions::decided(&pipeline, &states, &outputs);
    let depth_range = inputs.facts().depth_range;
    let kept = precision::choose(depth_range, &mut resources, &states, &outputs);
    let coarse = precision::too_coarse(depth_range, &resources, &states);

    let mut passes = if errors.is_empty() { State::into_passes(states) } else { Vec::new() };
    padding::keep(&resources, &mut passes);
    let Resources { images, buffers, .. } = resources;
    let images = images.into_iter().map(|image| image.map(|image| image.image)).collect::<Option<Vec<_>>>();
    match (images, buffers.into_iter().collect::<Option<Vec<_>>>()) {
        (Some(images), Some(buffers)) if errors.is_empty() => {
            let settings = settings::shown(&document.settings, &values);
            let changes = document.changes().to_vec();
            let views = pipeline.views.iter().map(view).collect();
            let remarks =
                each_once([shared, views::remarks(&pipeline), kept, coarse, checked.remarks, stored].concat());
            Ok(Frame {
                sources,
                settings,
                changes,
                extent: inputs.output_extent,
                stereo,
                views,
                images,
                buffers,
                passes,
                outputs,
                decided,
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

/// The remarks without those that were made before of the same place: a pass that runs for each eye by itself is there twice.
fn each_once(mut remarks: Vec<Remark>) -> Vec<Remark> {
    let mut seen = HashSet::new();
    remarks.retain(|remark| seen.insert((remark.span, remark.text.clone())));
    remarks
}
