//! The eyes that each pass runs for, and what is wrong about them.

use crate::base::{Code, Diagnostic, Span};
use crate::frame::Eye;
use crate::language::{Forward, Image, ImagePart, ImageRef, PartRef, Pass, StandIn, Use};
use crate::ron::Name;
use std::sync::Arc;

/// The eyes that a pass runs for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PassEyes {
    /// Once, for neither eye or for both together.
    Both,
    /// For one eye.
    One(Eye),
    /// For each eye by itself.
    Each,
}

/// The eyes that a pass runs for. Reports contradictions.
pub(super) fn whose(own: &[bool], pass: &Pass, images: &[Arc<Image>], errors: &mut Vec<Diagnostic>) -> PassEyes {
    let name = &pass.name.text;
    // The first that both eyes would write.
    let mut shared: Option<(Option<&Name>, Span)> = written_buffer(pass).map(|span| (None, span));
    let (mut read, mut written, mut eyes) = (None, None, Vec::new());
    for (part, write) in parts(pass) {
        let at = part.image.index.0 as usize;
        match (own[at], part.eye, write) {
            (true, None, true) => written = written.or(Some(part.image)),
            (true, None, false) => read = read.or(Some(part.image)),
            (true, Some(eye), true) => eyes.push((eye.value, part.image)),
            (false, _, true) => shared = shared.or(Some((Some(&images[at].name), part.image.span))),
            (false, _, false) | (true, Some(_), false) => {}
        }
    }
    let image = |of: ImageRef| &images[of.index.0 as usize].name.text;
    match (written, eyes.first(), shared, read) {
        (Some(written), _, Some((shared, span)), _) => {
            let message = format!("pass `{name}` runs once for each eye, and both would write this");
            let wrong = Diagnostic::new(Code::WRITTEN_BY_BOTH_EYES, span, message);
            let wrong = wrong.label(written.span, "each eye has its own");
            errors.push(wrong.help(match shared {
                Some(image) => format!("say `per_eye: true` of `{}`, or write it in a pass of its own", image.text),
                None => "write it in a pass of its own; if it is only read, say `access: Read` of it".to_owned(),
            }));
            PassEyes::Each
        }
        (Some(written), Some((_, one)), ..) => {
            let message =
                format!("pass `{name}` runs once for each eye, and both would write this one's `{}`", image(*one));
            let wrong = Diagnostic::new(Code::WRITTEN_BY_BOTH_EYES, one.span, message)
                .label(written.span, "each eye has its own");
            errors.push(wrong.help(format!("write `\"{}\"` in place of `Eye(…)`: each eye's is meant", image(*one))));
            PassEyes::Each
        }
        (Some(_), None, None, _) => PassEyes::Each,
        (None, Some((eye, _)), None, _) if eyes.iter().all(|(other, _)| other == eye) => PassEyes::One(*eye),
        (None, _, _, Some(read)) if !eyes.is_empty() || shared.is_some() => {
            let message = format!("pass `{name}` runs once, and each eye has a `{}` of its own", image(read));
            let mut wrong = Diagnostic::new(Code::EYE_UNSAID, read.span, message);
            let target = shared.map(|(_, span)| span).or_else(|| eyes.first().map(|(_, image)| image.span));
            if let Some(target) = target {
                wrong = wrong.label(target, "what it writes is there once");
            }
            let shared = shared.and_then(|(name, _)| name);
            let own = shared.map_or_else(String::new, |name| format!("say `per_eye: true` of `{}`, or ", name.text));
            errors.push(wrong.help(format!("{own}read one eye's: `Eye(Left, \"{}\")`", image(read))));
            PassEyes::Both
        }
        (None, None, None, Some(_)) => PassEyes::Each,
        (None, ..) => PassEyes::Both,
    }
}

/// Says where an eye of something is named that both share.
pub(super) fn foreign_eyes(own: &[bool], pass: &Pass, images: &[Arc<Image>], errors: &mut Vec<Diagnostic>) {
    for (part, _) in parts(pass) {
        let at = part.image.index.0 as usize;
        if part.eye.is_some() && !own[at] {
            let name = &images[at].name.text;
            let wrong = Diagnostic::new(
                Code::SAME_FOR_BOTH_EYES,
                part.image.span,
                format!("`{name}` is the same for both eyes"),
            );
            let wrong = wrong.label(images[at].name.span, "declared here");
            errors.push(
                wrong.help(format!("write `\"{name}\"` in place of `Eye(…)`, or say `per_eye: true` of `{name}`")),
            );
        }
    }
}

/// Reports an image of each eye that would take the place of an image that both eyes share: the eye would be unknown.
pub(super) fn handed_on_once(own: &[bool], pass: &Pass, images: &[Arc<Image>], errors: &mut Vec<Diagnostic>) {
    for stand_in in &pass.otherwise {
        let StandIn::Forward(Forward { from, to }) = stand_in else { continue };
        let [from_own, to_own] = [from, to].map(|image| own[image.index.0 as usize]);
        if from_own && !to_own {
            let [source, target] = [from, to].map(|image| &images[image.index.0 as usize].name.text);
            let message = format!("pass `{}` is off, and `{target}` would take each eye's `{source}`", pass.name.text);
            let wrong = Diagnostic::new(Code::WRITTEN_BY_BOTH_EYES, from.span, message).label(to.span, "is there once");
            errors.push(wrong.help(format!("say `per_eye: true` of `{target}`, or forward what both eyes share")));
        }
    }
}

/// The parts of images that a pass names, and whether it writes them. Only the size of an image that workgroups are
/// counted by matters, which is the same for both eyes.
fn parts(pass: &Pass) -> impl Iterator<Item = (&ImagePart, bool)> {
    pass.image_parts().filter(|(_, of)| *of != Use::Measured).map(|(part, of)| (part, of.writes()))
}

/// Where the first buffer is named that a pass writes: both eyes share it.
fn written_buffer(pass: &Pass) -> Option<Span> {
    pass.parts().filter(|(_, of)| of.writes()).find_map(|(part, _)| match part {
        PartRef::Buffer(part) => Some(part.buffer.span),
        PartRef::Image(_) => None,
    })
}
