//! Targets of passes: formats that fit, targets that agree, and shaders that feed them.

use crate::base::{Code, Diagnostic};
use crate::expand::resources::{FrameImage, Resources, fills, parts};
use crate::expand::shader::coverage;
use crate::frame::check::targets::{Target, agree, not_forwarded, undrawable, without_depth};
use crate::frame::{Blend, NoteKind, Remark};
use crate::language::{self, ImagePart, ImageRef};
use crate::ron::Name;
use crate::shader::{ShaderInterface, UnsetOutput};
use crate::vulkan::{Aspects, Component, Numeric, Shape};

/// Targets have formats that fit their use, and agree in size and sample count; a stand-in keeps to one kind of image.
pub(in crate::expand) fn fit(resources: &Resources<'_>, pass: &language::Pass, errors: &mut Vec<Diagnostic>) {
    let resolved = |image: ImageRef| resources.image(image.index);
    let declared = |image: ImageRef| resources.declared(image.index).format.span;
    for target in &pass.color {
        let Some(image) = resolved(target.part.image) else { continue };
        let format = image.image.format;
        if format.is_depth() {
            let message = format!("`{}` is a depth image ({format}) and can't be a colour target", image.image.name);
            errors.push(
                Diagnostic::new(Code::TARGET_UNFIT, target.part.image.span, message)
                    .label(declared(target.part.image), "its format"),
            );
        } else if format.is_integer() && target.blend.value != Blend::Replace {
            let message = format!("`{}` holds integers ({format}), which can't be blended", image.image.name);
            errors.push(
                Diagnostic::new(Code::BLEND_UNFIT, target.blend.span, message)
                    .label(declared(target.part.image), "its format"),
            );
        } else if let Some(clear) = target.clear
            && let Err((at, message, help)) = fills::held(clear.map(|number| number.value), format)
        {
            let message = format!("`{}` can't be cleared: {message}", image.image.name);
            let wrong = Diagnostic::new(Code::FILL_UNFIT, clear[at].span, message)
                .label(declared(target.part.image), "its format");
            errors.push(wrong.help(help));
        }
    }
    if let Some(target) = &pass.depth
        && let Some(image) = resolved(target.part.image)
    {
        let declared = resources.declared(target.part.image.index);
        errors.extend(without_depth(&image.image, declared, target.part.image.span));
    }
    if let Some(target) = &pass.depth
        && let (Some(stencil), Some(image)) = (target.stencil, resolved(target.part.image))
        && image.image.format.is_depth()
        && !image.image.format.aspects().contains(Aspects::STENCIL)
    {
        let message = format!("`{}` has no stencil plane ({})", image.image.name, image.image.format);
        let wrong =
            Diagnostic::new(Code::PLANE, stencil.span, message).label(declared(target.part.image), "its format");
        errors.push(wrong.help(format!("say `format: DepthStencil` of `{}`", image.image.name)));
    }
    let parts = pass.color.iter().map(|target| &target.part).chain(pass.depth.as_ref().map(|target| &target.part));
    let targets: Vec<Target<'_>> = parts.filter_map(|part| drawn(resources, part, errors)).collect();
    agree(&pass.name.text, targets, errors);
    for stand_in in &pass.otherwise {
        let language::StandIn::Forward(forward) = stand_in else { continue };
        for side in [forward.from, forward.to] {
            let declared = resources.declared(side.index);
            errors.extend(resolved(side).and_then(|it| not_forwarded(&it.image, declared, side.span)));
        }
        if let (Some(from), Some(to)) = (resolved(forward.from), resolved(forward.to))
            && kind(from) != kind(to)
        {
            let message = format!("`{}` can't take what `{}` holds", to.image.name, from.image.name);
            errors.push(
                Diagnostic::new(Code::STAND_IN_UNFIT, forward.from.span, message)
                    .remark(format!("{} ({})", kind(from), from.image.format))
                    .label(forward.to.span, format!("{} ({})", kind(to), to.image.format)),
            );
        }
    }
}

/// The kind of values that an image holds, in words.
fn kind(image: &FrameImage) -> &'static str {
    match image.image.format {
        format if format.is_depth() => "depth",
        format if format.numeric() == Numeric::Sint => "signed integers",
        format if format.is_integer() => "integers",
        _ => "colour",
    }
}

/// The one mip level, and the layers, that are drawn into. `None` if that can't be; mistakes were reported then.
fn drawn<'a>(resources: &'a Resources<'_>, part: &'a ImagePart, errors: &mut Vec<Diagnostic>) -> Option<Target<'a>> {
    let resolved = resources.image(part.image.index)?;
    let (image, name, declared) = (&resolved.image, &resolved.image.name, resources.declared(part.image.index));
    let mut known = Vec::new();
    let range = parts::range(resources, part, &mut known);
    // Parts out of range are reported with the pass.
    if !known.is_empty() && image.shape != Shape::D3 {
        return None;
    }
    if let Some(wrong) = undrawable(image, range, declared, [part.image.span, parts::place(part)]) {
        errors.push(wrong);
        return None;
    }
    let layers = image.part(range).layers;
    if layers > 1 && part.layers.first.is_none() && part.layers.count.is_none() {
        let declared = declared.layers.span;
        let message = format!("`{name}` has {layers} layers: say which one is drawn into");
        let help = format!(
            "write `(image: \"{name}\", layer: 0)`: a draw reaches one layer; `layers: Rest` clears them all as well"
        );
        errors.push(
            Diagnostic::new(Code::PART_UNSAID, part.image.span, message).label(declared, "declared here").help(help),
        );
        return None;
    }
    Some(Target { image, range, span: part.image.span, samples_because: resolved.samples_because.as_deref() })
}

/// Every output that a target takes is set: one that some path leaves is a mistake, or told of where that isn't sure.
pub(in crate::expand) fn set(
    pass: &language::Pass,
    interface: &ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) -> Vec<Remark> {
    let Some(Name { text: shader, span }) = pass.shader() else { return Vec::new() };
    let mut remarks = Vec::new();
    for UnsetOutput { location, what, refused, place, .. } in coverage::unset(pass, interface) {
        let target =
            location.and_then(|location| pass.color.get(location as usize)).map(|target| target.part.image.span);
        let at = coverage::at(place.as_deref());
        let message = format!("shader `{shader}` {what}{at}: its value would be undefined");
        if *refused {
            let help = "set it at the beginning of `main`; `discard` leaves texels as they were";
            errors.push(Diagnostic::new(Code::OUTPUT_UNSET, target.unwrap_or(*span), message).help(help));
        } else {
            let text = format!(
                "{message} where a loop has no rounds, or an index leaves it; set it at the beginning of `main`"
            );
            remarks.push(Remark { kind: NoteKind::Unset, subject: pass.name.text.clone(), span: *span, text });
        }
    }
    remarks
}

/// Notes outputs of the shader that no target takes: they are allowed, and the validation layer warns of them.
pub(super) fn untaken(pass: &language::Pass, interface: &ShaderInterface, remarks: &mut Vec<Remark>) {
    let Some(shader) = pass.shader() else { return };
    let untaken = interface.outputs.iter().filter(|output| output.location as usize >= pass.color.len());
    let names: Vec<String> =
        untaken.map(|output| format!("`{}` (location {})", output.name, output.location)).collect();
    if names.is_empty() {
        return;
    }
    let taken = match pass.color.len() {
        0 => "the pass draws no colour".to_owned(),
        1 => "the pass has one colour target".to_owned(),
        count => format!("the pass has {count} colour targets"),
    };
    let text = format!(
        "shader `{}` writes {}, which goes nowhere: {taken}; leave it out of the shader, or give it a target in `color`",
        shader.text,
        names.join(" and ")
    );
    remarks.push(Remark { kind: NoteKind::Untaken, subject: pass.name.text.clone(), span: shader.span, text });
}

/// Every colour target is fed by an output of the same type.
pub(super) fn fed(
    resources: &Resources<'_>,
    pass: &language::Pass,
    interface: &ShaderInterface,
    errors: &mut Vec<Diagnostic>,
) {
    let shader = pass.shader().map_or("", |shader| &*shader.text);
    if let Some(span) = pass.alpha_to_coverage {
        let first = interface.outputs.iter().find(|output| output.location == 0);
        let why = match (pass.color.is_empty(), first) {
            (true, _) => Some("it draws no colour".to_owned()),
            (false, Some(output)) if output.component != Component::Float || output.components < 4 => {
                Some(format!("shader `{shader}` writes no alpha to `{}`", output.name))
            }
            (false, _) => None,
        };
        if let Some(why) = why {
            let message = format!("pass `{}` has no alpha that could say what is covered: {why}", pass.name.text);
            errors.push(Diagnostic::new(Code::ALPHA_TO_COVERAGE, span, message).help("leave `alpha_to_coverage` out"));
        }
    }
    for (location, target) in (0..).zip(&pass.color) {
        let Some(image) = resources.image(target.part.image.index) else { continue };
        let (name, format) = (&image.image.name, image.image.format);
        let Some(output) = interface.outputs.iter().find(|output| output.location == location) else {
            let message = format!("shader `{shader}` has no output at location {location} for `{name}`");
            let help = match interface.outputs.len() {
                0 => "it writes no colour at all".to_owned(),
                1 => "it writes one colour".to_owned(),
                count => format!("it writes {count} colours"),
            };
            errors.push(Diagnostic::new(Code::OUTPUT_MISSING, target.part.image.span, message).help(help));
            continue;
        };
        let holds = Component::of(format);
        if output.component != holds {
            let (written, held) = (output.component.words(), holds.words());
            let message = format!(
                "shader `{shader}` writes {written} to `{}`, but `{name}` holds {held} ({format})",
                output.name
            );
            errors.push(Diagnostic::new(Code::COMPONENT_TYPE, target.part.image.span, message));
        } else if output.components < format.components() {
            let message = format!(
                "shader `{shader}` writes {} of the {} components of `{name}` ({format}): the others would be undefined",
                output.components,
                format.components()
            );
            errors.push(Diagnostic::new(Code::OUTPUT_MISSING, target.part.image.span, message));
        }
    }
}
