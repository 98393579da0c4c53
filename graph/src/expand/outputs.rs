//! Outputs of the frame: the pipeline's outputs, and images that are dumped.

use super::inputs::Inputs;
use super::passes;
use super::resources::Resources;
use crate::base::{Code, Diagnostic, Span, suggestion};
use crate::frame::check::images::wrong_encoding;
use crate::frame::tracked_parts::Parts;
use crate::frame::{Eye, ImageIndex, Lifetime, Output, Pass, Resource};
use crate::language::{self, Pipeline, State};
use crate::ron::Spanned;
use crate::vulkan::{AccessKind, Encoding, Rotation};

/// The pipeline's outputs, then dumped images that aren't among them.
pub(super) fn outputs(resources: &Resources<'_>, inputs: &Inputs<'_>, errors: &mut Vec<Diagnostic>) -> Vec<Output> {
    let dump = inputs.dump;
    let pipeline = resources.pipeline;
    let mut outputs = Vec::with_capacity(pipeline.outputs.len() + dump.len());
    for output in &pipeline.outputs {
        let language::ResourceRef { resource, span } = output.resource;
        let encoding = output.encoding.filter(|encoding| encoded(resources, resource, *encoding, errors));
        let encoding = encoding.map(|encoding| encoding.value);
        let shown = shown(resources, resource, encoding);
        let rotation = if shown { inputs.rotation } else { Rotation::Identity };
        let presented = Spanned { value: State::Word(AccessKind::Present), span };
        let after = output.after.or((shown && inputs.window.is_some()).then_some(presented));
        let after = after.and_then(|after| resources.left(resource, after, errors));
        outputs.push(Output { resource, span, after, encoding, rotation, eye: output.eye });
    }
    if inputs.rotation.turns() && !outputs.iter().any(|output| output.rotation.turns()) {
        let degrees = inputs.rotation.degrees();
        let message = format!("nothing can be rotated by {degrees}°: no output is made to be shown on a screen");
        let span = pipeline.outputs.first().map_or(Span::NONE, |output| output.resource.span);
        let images = pipeline.outputs.iter().filter_map(|output| match output.resource.resource {
            Resource::Image(image) => Some(&resources.declared(image).name.text),
            Resource::Buffer(_) => None,
        });
        let wrong = Diagnostic::new(Code::NOTHING_TO_ROTATE, span, message);
        errors.push(match images.into_iter().next() {
            Some(image) => wrong.help(format!("say `format: Output` of `{image}`")),
            None => wrong.help("let an image leave the frame"),
        });
    }
    dumped(pipeline, dump, &mut outputs, errors);
    outputs
}

/// Whether an output is made to be shown on a screen.
fn shown(resources: &Resources<'_>, resource: Resource, encoding: Option<Encoding>) -> bool {
    let Resource::Image(image) = resource else { return false };
    resources.declared(image).format.value == language::Format::Output || encoding == Some(Encoding::Hdr10)
}

/// Whether an output's format can hold its encoding.
fn encoded(resources: &Resources<'_>, of: Resource, encoding: Spanned<Encoding>, errors: &mut Vec<Diagnostic>) -> bool {
    let Resource::Image(index) = of else { return false };
    let Some(image) = resources.image(index) else { return false };
    let wrong = wrong_encoding(&image.image, encoding.value, resources.declared(index), encoding.span);
    let fits = wrong.is_none();
    errors.extend(wrong);
    fits
}

/// Adds images that are dumped.
pub(super) fn dumped(pipeline: &Pipeline, dump: &[String], outputs: &mut Vec<Output>, errors: &mut Vec<Diagnostic>) {
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
            errors.push(Diagnostic {
                help,
                ..Diagnostic::nowhere(Code::UNKNOWN_IMAGE, format!("there is no image named `{name}` to dump"))
            });
        }
        for (index, eye) in found {
            if let language::Lifetime::File(file) = &pipeline.images[index].lifetime.value {
                let why = format!("`{name}` can't be dumped: no pass makes it, it comes from `{}`", file.path);
                errors.push(Diagnostic::nowhere(Code::TEXTURE_WRITTEN, why));
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

/// Reports dumped images that stay from frame to frame. A dump leaves the frame, which writes it anew.
pub(super) fn kept_dumps(
    resources: &Resources<'_>,
    (states, outputs): (&[passes::State], &[Output]),
    parts: &Parts<'_>,
    errors: &mut Vec<Diagnostic>,
) {
    let dumped = &outputs[resources.pipeline.outputs.len()..];
    if dumped.is_empty() || states.iter().flat_map(passes::State::runs).all(|pass| pass.run.is_always()) {
        return;
    }
    let mut writers: Vec<Option<&Pass>> = vec![None; parts.len()];
    for pass in states.iter().flat_map(passes::State::runs) {
        parts.for_each_access(pass, |_, part, _, writes| {
            if writes {
                writers[part as usize] = Some(pass);
            }
        });
    }
    for Output { resource, .. } in dumped {
        let is_transient = resources.lifetime(*resource).is_some_and(|it| *it == Lifetime::Transient);
        let last = writers[parts.of(*resource)].iter().flatten().find(|pass| !pass.run.is_always());
        if let Some(pass) = last.filter(|_| is_transient) {
            let name = &resources.name(*resource).text;
            let message = format!(
                "`{name}` can't be dumped: `{}` runs {}, and what is dumped is written in each frame",
                pass.name, pass.run
            );
            let help = "let another pass copy it in each frame, and dump the copy";
            errors.push(Diagnostic::new(Code::KEPT_UNFIT, pass.span, message).help(help));
        }
    }
}
