//! What shaders and states ask of the device, and how large buffers are that shaders see, against the device's features and limits.

use crate::base::{Code, Diagnostic, Span};
use crate::device::{Abilities, Limit, NeedKind, Profile};
use crate::frame::{Draw, Frame, Lifetime, Pass};
use crate::plan::{Note, NoteKind};
use crate::vulkan::{Sampler, State};

/// Vulkan's name of the feature that draws with counts in a buffer need, if their first instance isn't 0.
const FIRST_INSTANCE: &str = "drawIndirectFirstInstance";

/// Reports what passes need and the device doesn't have; returns notes about what can't be known.
pub(crate) fn check_needs(frame: &Frame, live: &[u32], device: &Profile) -> Result<Vec<Note>, Vec<Diagnostic>> {
    let (mut errors, mut notes) = (Vec::new(), Vec::new());
    for pass in live.iter().map(|pass| &frame.passes[*pass as usize]) {
        if !pass.needs.is_empty() {
            needs(pass, device, &mut errors, |text| notes.push(note(NoteKind::UnknownSpirv, frame, pass, text)));
        }
        for declared in &pass.uses {
            if let Some(missing) = declared.state.features().find(|feature| !device.has_feature(feature)) {
                let name = frame.name(declared.resource);
                let message = format!(
                    "`{}` uses `{name}` in a way that needs the feature {missing}, which `{}` doesn't have",
                    pass.name, device.name
                );
                errors.push(Diagnostic::new(Code::STATE_NEEDS, declared.span, message));
            }
        }
        if pass.work.draws(Draw::is_indirect) && !device.has_feature(FIRST_INSTANCE) {
            let text = format!("the first instance in its counts must be 0: `{}` lacks {FIRST_INSTANCE}", device.name);
            notes.push(note(NoteKind::FirstInstance, frame, pass, text));
        }
    }
    for pass in live.iter().map(|pass| &frame.passes[*pass as usize]) {
        draws(pass, device, &mut errors);
        raster(pass, device, &mut errors);
        samplers(frame, pass, device, &mut errors);
    }
    buffers(frame, live, device, &mut errors);
    states(frame, device, &mut errors);
    if errors.is_empty() { Ok(notes) } else { Err(errors) }
}

fn needs(pass: &Pass, device: &Profile, errors: &mut Vec<Diagnostic>, mut tell: impl FnMut(String)) {
    let name = format!("`{}`", device.name);
    let abilities = Abilities {
        device: &name,
        limits: device.limits.as_ref(),
        has: &|feature| device.has_feature(feature),
        reads_vertices: &|format| device.reads_vertices(format),
    };
    for need in &pass.needs {
        if let Some(what) = need.unmet(&abilities) {
            let message = format!("the shader of `{}` can't be used on {name}: {what}", pass.name);
            errors.push(Diagnostic::new(Code::SHADER_NEEDS, pass.span, message));
        }
        if let NeedKind::Unjudged(words) = &need.kind {
            tell(format!("whether {} is valid SPIR-V isn't known: {words}", need.place));
        }
    }
}

/// Reports indirect draws that the device doesn't make.
fn draws(pass: &Pass, device: &Profile, errors: &mut Vec<Diagnostic>) {
    let Some(draws) = pass.work.draw().and_then(|(draw, _)| draw.indirect()) else { return };
    let missing = draws.features().find(|(feature, _)| !device.has_feature(feature));
    let most = device.limits.as_ref().map(|limits| limits.of(Limit::IndirectDraws));
    let what = match (missing, most) {
        (Some((feature, what)), _) => format!("{what} needs the feature {feature}"),
        (None, Some(most)) if u64::from(draws.draws) > most => {
            format!("it makes {} draws, and {most} are allowed ({})", draws.draws, Limit::IndirectDraws.name())
        }
        (None, _) => return,
    };
    let message = format!("pass `{}` can't be drawn on `{}`: {what}", pass.name, device.name);
    errors.push(Diagnostic::new(Code::DRAW_NEEDS, pass.span, message));
}

/// Reports raster state that the device doesn't have.
fn raster(pass: &Pass, device: &Profile, errors: &mut Vec<Diagnostic>) {
    let mut report = |span: Span, what: String| {
        let message = format!("pass `{}` can't be drawn on `{}`: {what}", pass.name, device.name);
        errors.push(Diagnostic::new(Code::RASTER_NEEDS, if span == Span::NONE { pass.span } else { span }, message));
    };
    let missing = |(feature, what): (&str, &str)| {
        (!device.has_feature(feature)).then(|| format!("{what} needs the feature {feature}"))
    };
    if !pass.raster.is_usual() {
        let lacks: Vec<String> = pass.raster.features().filter_map(missing).collect();
        let has_all = lacks.is_empty();
        lacks.into_iter().for_each(|what| report(pass.raster_span, what));
        for (limit, value, what) in pass.raster.limits() {
            let Some(most) = device.limits.as_ref().map(|limits| limits.of(limit)) else { continue };
            #[allow(clippy::cast_precision_loss, reason = "such limits are small")]
            let exceeds = value > most as f32;
            if exceeds && has_all {
                report(pass.raster_span, format!("{what} is {value}, and {most} is allowed ({})", limit.name()));
            }
        }
    }
    for target in &pass.color {
        target.blend.feature().and_then(missing).into_iter().for_each(|what| report(target.span, what));
    }
}

/// Reports samplers that the device doesn't have.
fn samplers(frame: &Frame, pass: &Pass, device: &Profile, errors: &mut Vec<Diagnostic>) {
    for sampled in &pass.sampled {
        let (sampler, image) = (&sampled.sampler, &frame.images[sampled.image.0 as usize]);
        if *sampler == Sampler::new(sampler.filter) {
            continue;
        }
        let missing = sampler.features().find(|(feature, _)| !device.has_feature(feature));
        let reduced = !sampler.reduces() || device.format(image.format).is_none_or(|support| support.minmax_filter);
        let beyond = device.limits.as_ref().and_then(|limits| limits.exceeded_by(sampler));
        let what = match (missing, beyond) {
            (Some((feature, what)), _) => format!("{what} needs the feature {feature}"),
            (None, _) if !reduced => format!("it finds no least and greatest of {}", image.format),
            (None, Some(what)) => what,
            (None, None) => continue,
        };
        let message = format!("pass `{}` can't sample `{}` on `{}`: {what}", pass.name, image.name, device.name);
        errors.push(Diagnostic::new(Code::SAMPLER_NEEDS, sampled.span, message));
    }
}

fn note(kind: NoteKind, frame: &Frame, pass: &Pass, text: String) -> Note {
    Note::new(kind, pass.name.clone(), text, frame.sources.place(pass.span))
}

/// Reports states in which images and buffers come and go, if they name what the device doesn't have.
fn states(frame: &Frame, device: &Profile, errors: &mut Vec<Diagnostic>) {
    let images = frame.images.iter().map(|image| (&image.name, &image.lifetime, image.span));
    let buffers = frame.buffers.iter().map(|buffer| (&buffer.name, &buffer.lifetime, buffer.span));
    let imported = images.chain(buffers).filter_map(|(name, lifetime, span)| match lifetime {
        Lifetime::Imported { before, after, .. } => Some((name, span, [Some(before), after.as_ref()])),
        Lifetime::File(_) | Lifetime::Transient | Lifetime::Persistent { .. } | Lifetime::History { .. } => None,
    });
    let left =
        frame.outputs.iter().map(|output| (frame.name(output.resource), output.span, [None, output.after.as_ref()]));
    for (name, span, states) in imported.chain(left) {
        let mut features = states.into_iter().flatten().flat_map(State::features);
        if let Some(missing) = features.find(|feature| !device.has_feature(feature)) {
            let message =
                format!("the state of `{name}` needs the feature {missing}, which `{}` doesn't have", device.name);
            errors.push(Diagnostic::new(Code::STATE_NEEDS, span, message));
        }
    }
}

/// Reports buffers that are larger than the device allows.
fn buffers(frame: &Frame, live: &[u32], device: &Profile, errors: &mut Vec<Diagnostic>) {
    let (Some(limits), Some(largest)) = (&device.limits, frame.buffers.iter().map(|buffer| buffer.bytes).max()) else {
        return;
    };
    // Most frames have none that any device would refuse.
    if largest <= limits.uniform_bytes {
        return;
    }
    let wrong = |what: String, limit: Limit| {
        format!("{what}; `{}` allows {} ({})", device.name, limits.of(limit), limit.name())
    };
    for buffer in frame.buffers.iter().filter(|buffer| buffer.bytes > limits.buffer_bytes) {
        let message = wrong(format!("`{}` has {} bytes", buffer.name, buffer.bytes), Limit::BufferBytes);
        errors.push(Diagnostic::new(Code::BUFFER_TOO_LARGE, buffer.span, message));
    }
    for pass in live.iter().map(|pass| &frame.passes[*pass as usize]) {
        for used in &pass.buffers {
            let Some((limit, what)) = used.role.limit() else { continue };
            let buffer = &frame.buffers[used.buffer.0 as usize];
            if buffer.bytes > limits.of(limit) && buffer.bytes <= limits.buffer_bytes {
                let what =
                    format!("`{}` has {} bytes, and `{}` sees it as a {what}", buffer.name, buffer.bytes, pass.name);
                let wrong = Diagnostic::new(Code::BUFFER_TOO_LARGE, used.span, wrong(what, limit))
                    .label(buffer.span, "declared here");
                errors.push(wrong.help("make it smaller, or have several buffers"));
            }
        }
    }
}
