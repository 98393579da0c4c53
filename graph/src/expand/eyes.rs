//! A pipeline is taken apart for two eyes: an image that each eye has of its own is there twice.
//!
//! A pass that draws into such an image runs once for each eye, and reads and writes the images of that eye. All other passes
//! run once. An impossible mixture is a mistake where the frame is drawn for two eyes, and a remark where it is drawn for one.
//! In modes that draw both eyes at once, images hold both eyes' parts where they can, and passes run once for both (`at_once`).

mod at_once;

use crate::base::{Code, Diagnostic, Span};
use crate::frame::{
    Allowances, Draw, Eye, EyeForm, ImageIndex, NoteKind, Remark, Resource, Stereo, ViewEye, ViewIndex,
};
use crate::language::{
    self, Forward, Image, ImagePart, ImageRef, Output, Part, Pass, Pipeline, Size, StandIn, StorageAccess, View, Work,
};
use crate::ron::{Name, Spanned};
use at_once::Apart;
use std::collections::HashSet;
use std::iter::successors;
use std::sync::Arc;

/// The eyes that a pass runs for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum For {
    /// Once, for neither eye or for both together.
    Both,
    /// For one eye.
    One(Eye),
    /// For each eye by itself.
    Each,
}

/// The places of both eyes' images.
struct Images {
    /// By image, whether each eye has its own.
    own: Vec<bool>,
    /// By image, the right eye's image; the left eye's has kept its place. An image with both eyes' parts is its own right one.
    right: Vec<ImageIndex>,
    /// By image, whether it holds both eyes' parts.
    both: Vec<bool>,
}

/// Takes `pipeline` apart for the eyes that `stereo` asks for, and returns remarks: uses that are allowed, but probably a
/// mistake. `form` is how images hold both eyes' parts, `extent` the frame's width and height.
pub(super) fn split(
    mut pipeline: Pipeline,
    (stereo, form): (Stereo, Option<EyeForm>),
    extent: [u32; 2],
    errors: &mut Vec<Diagnostic>,
) -> (Pipeline, Vec<Remark>) {
    let own = own(&pipeline);
    let before = errors.len();
    let (mut none, mut for_one) = (Vec::new(), Vec::new());
    let mut of_pass = |pass: &Arc<Pass>| {
        if pass.off.is_some() && stereo != Stereo::Off {
            handed_on_once(&own, pass, &pipeline.images, errors);
        }
        // Mistakes of a pass that is off do no harm.
        let errors = if pass.off.is_some() { &mut none } else { &mut *errors };
        foreign_eyes(&own, pass, &pipeline.images, errors);
        if stereo != Stereo::Off || pass.off.is_some() {
            return whose(&own, pass, &pipeline.images, errors);
        }
        // For one eye nothing is wrong about it.
        let mut mistakes = Vec::new();
        let found = whose(&own, pass, &pipeline.images, &mut mistakes);
        for_one.extend(mistakes.into_iter().map(|mistake| Remark {
            kind: NoteKind::NotForTwoEyes,
            subject: pass.name.text.clone(),
            span: mistake.labels.first().map_or(pass.name.span, |label| label.span),
            text: format!("can't be drawn for two eyes: {}", mistake.message),
        }));
        found
    };
    let whose: Vec<For> = pipeline.passes.iter().map(&mut of_pass).collect();
    let mut remarks = [for_one, remarks(&own, &pipeline, &whose)].concat();
    if stereo == Stereo::Off || !own.contains(&true) || errors.len() > before {
        return (pipeline, remarks);
    }
    let apart = form.map(|form| Apart::of(&pipeline, &own, &whose, stereo, form));
    remarks.extend(apart.iter().flat_map(|apart| images_apart(apart, &pipeline)));
    let at_once = |pass: &Arc<Pass>| apart.as_ref().is_some_and(|apart| apart.at_once(pass, &own, stereo));
    let at_once: Vec<bool> = pipeline.passes.iter().map(at_once).collect();
    let views = views(&mut pipeline, extent);
    let both =
        own.iter().zip(0..).map(|(own, at)| *own && apart.as_ref().is_some_and(|apart| apart.is_one(ImageIndex(at))));
    let images = images(&mut pipeline, both.collect(), own, form);
    let passes = std::mem::take(&mut pipeline.passes);
    pipeline.passes = passes
        .into_iter()
        .zip(whose.into_iter().zip(at_once))
        .flat_map(|(pass, whose)| {
            let of_eye = |eye, twice| Arc::new(of_eye(&images, &views, Pass::clone(&pass), eye, twice));
            match whose {
                (For::Each, true) | (For::Both, _) => vec![of_eye(None, false)],
                (For::One(eye), _) => vec![of_eye(Some(eye), false)],
                (For::Each, false) => Eye::BOTH.map(|eye| of_eye(Some(eye), true)).into(),
            }
        })
        .collect();
    let outputs = std::mem::take(&mut pipeline.outputs);
    pipeline.outputs = outputs.into_iter().flat_map(|output| images.output(output)).collect();
    (pipeline, remarks)
}

/// Images that are one for each eye where both are drawn at once, and why.
fn images_apart(apart: &Apart, pipeline: &Pipeline) -> Vec<Remark> {
    let images = pipeline.images.iter().enumerate();
    let remark = |(at, image): (usize, &Arc<Image>)| {
        let why = apart.why(at)?;
        let text = format!("is drawn for one eye after the other: {why}");
        Some(Remark { kind: NoteKind::EyesApart, subject: image.name.text.clone(), span: image.name.span, text })
    };
    images.filter_map(remark).collect()
}

/// Remarks on passes that draw a camera's picture into an image that both eyes share, where passes for each eye look it up:
/// this is allowed, but neither eye then sees the scene from its own position.
fn remarks(own: &[bool], pipeline: &Pipeline, whose: &[For]) -> Vec<Remark> {
    if !own.contains(&true) {
        return Vec::new();
    }
    let passes = || pipeline.passes.iter().zip(whose).filter(|(pass, _)| pass.off.is_none());
    let read: HashSet<ImageIndex> = passes()
        .filter(|(_, whose)| **whose != For::Both)
        .flat_map(|(pass, _)| pass.sample.iter().map(|sample| sample.part.image.index))
        .collect();
    let sees = |pass: &Pass| pass.work.draws(Draw::shows_scene);
    let remark = |pass: &Pass| {
        let shared = pass.color.iter().map(|color| color.part.image).find(|image| read.contains(&image.index))?;
        let name = &pipeline.images[shared.index.0 as usize].name.text;
        let text = format!(
            "draws `{name}` once for both eyes, and what each eye sees is made of it: say `per_eye: true` of it"
        );
        Some(Remark { kind: NoteKind::SharedByEyes, subject: pass.name.text.clone(), span: shared.span, text })
    };
    passes().filter(|(pass, whose)| **whose == For::Both && sees(pass)).filter_map(|(pass, _)| remark(pass)).collect()
}

/// By image, whether each eye has its own: as the file says, or as the image whose size it follows.
fn own(pipeline: &Pipeline) -> Vec<bool> {
    let follows = |at: usize| match pipeline.images[at].size.value {
        Size::Like(of) | Size::Scaled { of: Some(of), .. } | Size::Dynamic { of: Some(of), .. } => Some(of.index),
        _ => None,
    };
    let mut known: Vec<Option<bool>> =
        pipeline.images.iter().map(|image| image.per_eye.map(|per_eye| per_eye.value)).collect();
    for at in 0..known.len() {
        // No image follows itself: that was refused before.
        let followed = |at: &usize| follows(*at).map(|next| next.0 as usize);
        let chain = || successors(Some(at), followed);
        let found = chain().find_map(|at| known[at]).unwrap_or(false);
        for at in chain() {
            if known[at].is_some() {
                break;
            }
            known[at] = Some(found);
        }
    }
    known.into_iter().map(Option::unwrap_or_default).collect()
}

/// Shows every part of an image that a pass names, and whether the pass writes it.
fn visit<'p>(pass: &'p Pass, see: &mut dyn FnMut(&'p ImagePart, bool)) {
    let left_out = pass.left_out.iter().filter_map(|left_out| left_out.sample.as_ref());
    pass.sample.iter().chain(left_out).for_each(|sample| see(&sample.part, false));
    for storage in &pass.storage {
        let reads = storage.access.is_some_and(|access| access.value == StorageAccess::Read);
        of_part(&storage.part, !reads, see);
    }
    pass.color.iter().for_each(|color| see(&color.part, true));
    pass.depth.iter().for_each(|depth| see(&depth.part, true));
    match &pass.work {
        Work::Copy { from, to } | Work::Blit { from, to, .. } => {
            of_part(from, false, see);
            of_part(to, true, see);
        }
        Work::Fill { to, .. } => of_part(to, true, see),
        Work::Custom { reads, writes, .. } => {
            reads.iter().for_each(|part| of_part(part, false, see));
            writes.iter().for_each(|part| of_part(part, true, see));
        }
        // Of an image that workgroups are counted by, only the size matters. It is the same for both eyes.
        Work::Dispatch { .. } | Work::Draw { .. } => {}
    }
}

fn of_part<'p>(part: &'p Part, write: bool, see: &mut dyn FnMut(&'p ImagePart, bool)) {
    if let Part::Image(part) = part {
        see(part, write);
    }
}

/// The parts of images that [`visit`] shows, to be changed.
fn parts_mut(pass: &mut Pass) -> impl Iterator<Item = &mut ImagePart> {
    let Pass { sample, left_out, storage, color, depth, work, .. } = pass;
    let transfers: Vec<&mut Part> = match work {
        Work::Copy { from, to } | Work::Blit { from, to, .. } => vec![from, to],
        Work::Fill { to, .. } => vec![to],
        Work::Custom { reads, writes, .. } => reads.iter_mut().chain(writes).collect(),
        Work::Dispatch { .. } | Work::Draw { .. } => Vec::new(),
    };
    let left_out = left_out.iter_mut().filter_map(|left_out| left_out.sample.as_mut());
    let sampled = sample.iter_mut().chain(left_out).map(|sample| &mut sample.part);
    let targets = color.iter_mut().map(|color| &mut color.part).chain(depth.as_mut().map(|depth| &mut depth.part));
    let others = storage.iter_mut().map(|storage| &mut storage.part).chain(transfers);
    let others = others.filter_map(|part| if let Part::Image(part) = part { Some(part) } else { None });
    sampled.chain(targets).chain(others)
}

/// Where buffers are named that a pass writes: both eyes share them.
fn written_buffers(pass: &Pass) -> impl Iterator<Item = Span> {
    let storage = pass.storage.iter().filter_map(|storage| {
        let reads = storage.access.is_some_and(|access| access.value == StorageAccess::Read);
        (!reads).then_some(&storage.part)
    });
    let transfers: Vec<&Part> = match &pass.work {
        Work::Copy { to, .. } | Work::Blit { to, .. } | Work::Fill { to, .. } => vec![to],
        Work::Custom { writes, .. } => writes.iter().collect(),
        Work::Draw { .. } | Work::Dispatch { .. } => Vec::new(),
    };
    storage.chain(transfers).filter_map(|part| match part {
        Part::Buffer(part) => Some(part.buffer.span),
        Part::Image(_) => None,
    })
}

/// Says where an eye of something is named that both share.
fn foreign_eyes(own: &[bool], pass: &Pass, images: &[Arc<Image>], errors: &mut Vec<Diagnostic>) {
    visit(pass, &mut |part, _| {
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
    });
}

/// Reports an image of each eye that would take the place of an image that both eyes share: the eye would be unknown.
fn handed_on_once(own: &[bool], pass: &Pass, images: &[Arc<Image>], errors: &mut Vec<Diagnostic>) {
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

/// The eyes that a pass runs for. Reports contradictions.
fn whose(own: &[bool], pass: &Pass, images: &[Arc<Image>], errors: &mut Vec<Diagnostic>) -> For {
    let name = &pass.name.text;
    // The first that both eyes would write.
    let mut shared: Option<(Option<&Name>, Span)> = written_buffers(pass).next().map(|span| (None, span));
    let (mut read, mut written, mut eyes) = (None, None, Vec::new());
    visit(pass, &mut |part, write| {
        let at = part.image.index.0 as usize;
        match (own[at], part.eye, write) {
            (true, None, true) => written = written.or(Some(part.image)),
            (true, None, false) => read = read.or(Some(part.image)),
            (true, Some(eye), true) => eyes.push((eye.value, part.image)),
            (false, _, true) => shared = shared.or(Some((Some(&images[at].name), part.image.span))),
            (false, _, false) | (true, Some(_), false) => {}
        }
    });
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
            For::Each
        }
        (Some(written), Some((_, one)), ..) => {
            let message =
                format!("pass `{name}` runs once for each eye, and both would write this one's `{}`", image(*one));
            let wrong = Diagnostic::new(Code::WRITTEN_BY_BOTH_EYES, one.span, message)
                .label(written.span, "each eye has its own");
            errors.push(wrong.help(format!("write `\"{}\"` in place of `Eye(…)`: each eye's is meant", image(*one))));
            For::Each
        }
        (Some(_), None, None, _) => For::Each,
        (None, Some((eye, _)), None, _) if eyes.iter().all(|(other, _)| other == eye) => For::One(*eye),
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
            For::Both
        }
        (None, None, None, Some(_)) => For::Each,
        (None, ..) => For::Both,
    }
}

/// By view, those of both eyes; they are added.
fn views(pipeline: &mut Pipeline, extent: [u32; 2]) -> Vec<[ViewIndex; 2]> {
    if pipeline.views.is_empty() {
        let name = Name { text: "main".into(), span: Span::NONE };
        let allows = Allowances::default();
        pipeline.views.push(View { name, extent, camera: None, allows, jitter: None, eye: None });
    }
    let count = pipeline.views.len();
    let mut added = |of: usize, eye: Eye| {
        let at = index(pipeline.views.len());
        let mut view = pipeline.views[of].clone();
        view.name.text = eye.named(&view.name.text);
        view.eye = Some(ViewEye { eye, of: ViewIndex(index(of)) });
        pipeline.views.push(view);
        ViewIndex(at)
    };
    (0..count).map(|of| Eye::BOTH.map(|eye| added(of, eye))).collect()
}

/// Makes each image that each eye has of its own twice, or once with both eyes' parts.
fn images(pipeline: &mut Pipeline, both: Vec<bool>, own: Vec<bool>, form: Option<EyeForm>) -> Images {
    let mut right: Vec<ImageIndex> = (0..own.len()).map(|at| ImageIndex(index(at))).collect();
    for (at, _) in own.iter().enumerate().filter(|(_, own)| **own) {
        if both[at] {
            Arc::make_mut(&mut pipeline.images[at]).eyes = form;
            continue;
        }
        let mut image = Image::clone(&pipeline.images[at]);
        right[at] = ImageIndex(index(pipeline.images.len()));
        image.name.text = Eye::Right.named(&image.name.text);
        pipeline.images.push(Arc::new(image));
        let left = &mut Arc::make_mut(&mut pipeline.images[at]).name.text;
        *left = Eye::Left.named(left);
    }
    Images { own, right, both }
}

/// No pipeline has as many images or views as don't fit.
fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

impl Images {
    /// One eye's image, where each has its own.
    fn of(&self, eye: Option<Eye>, image: &mut ImageRef) {
        if eye == Some(Eye::Right) {
            image.index = self.right[image.index.0 as usize];
        }
    }

    /// The outputs for one declared output: one for each eye if each eye has its own.
    fn output(&self, output: Output) -> Vec<Output> {
        match output.resource.resource {
            Resource::Image(image) if self.own[image.0 as usize] && !self.both[image.0 as usize] => {
                let right = language::ResourceRef {
                    resource: Resource::Image(self.right[image.0 as usize]),
                    ..output.resource
                };
                vec![
                    Output { eye: Some(Eye::Left), ..output },
                    Output { resource: right, eye: Some(Eye::Right), ..output },
                ]
            }
            _ => vec![output],
        }
    }
}

/// A pass as it is for an eye, by a name of its own if it runs for the other one too.
fn of_eye(images: &Images, views: &[[ViewIndex; 2]], mut pass: Pass, eye: Option<Eye>, twice: bool) -> Pass {
    for part in parts_mut(&mut pass) {
        let eye = part.eye.map(|eye| eye.value).or(eye);
        // An image for both eyes stays one image: the eye chooses its layer or half.
        if images.both[part.image.index.0 as usize] {
            part.eye = eye.map(|value| Spanned { value, span: part.image.span });
        }
        images.of(eye, &mut part.image);
    }
    for stand_in in &mut pass.otherwise {
        match stand_in {
            StandIn::Forward(Forward { from, to }) => {
                images.of(eye, from);
                images.of(eye, to);
            }
            StandIn::Clear { to, .. } => images.of(eye, to),
        }
    }
    if let Some(eye) = eye {
        pass.view = views[pass.view.0 as usize][eye as usize];
        if twice {
            pass.name.text = eye.named(&pass.name.text);
        }
    }
    pass
}
