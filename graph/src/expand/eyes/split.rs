//! A pipeline is taken apart for two eyes: an image that each eye has of its own is there twice.
//!
//! A pass that draws into such an image runs once for each eye, and reads and writes the images of that eye. All other passes
//! run once. An impossible mixture is a mistake where the frame is drawn for two eyes, and a remark where it is drawn for one.
//! In modes that draw both eyes at once, images hold both eyes' parts where they can, and passes run once for both (`separate_images`).

use super::Eyes;
use super::pass_eyes::{PassEyes, foreign_eyes, handed_on_once, whose};
use super::separate_images::SeparateImages;
use crate::base::{Diagnostic, Span};
use crate::frame::{
    Allowances, Draw, Eye, EyeForm, ImageIndex, NoteKind, Remark, Resource, Stereo, ViewEye, ViewIndex,
};
use crate::language::{self, Forward, Image, ImageRef, Output, Pass, Pipeline, Size, StandIn, View};
use crate::ron::{Name, Spanned};
use std::collections::HashSet;
use std::iter::successors;
use std::sync::Arc;

/// The places of both eyes' images.
struct Images {
    /// By image, whether each eye has its own.
    own: Vec<bool>,
    /// By image, the right eye's image; the left eye's has kept its place. An image with both eyes' parts is its own right one.
    right: Vec<ImageIndex>,
    /// By image, whether it holds both eyes' parts.
    both: Vec<bool>,
}

/// Takes `pipeline` apart for the eyes, and returns remarks: uses that are allowed, but probably a mistake. `extent` is the frame's
/// width and height.
pub(in crate::expand) fn split(
    mut pipeline: Pipeline,
    eyes: &Eyes<'_>,
    extent: [u32; 2],
    errors: &mut Vec<Diagnostic>,
) -> (Pipeline, Vec<Remark>) {
    let (stereo, form) = (eyes.stereo, eyes.form);
    let own = own(&pipeline);
    let before = errors.len();
    if !own.contains(&true) {
        let running = pipeline.passes.iter().filter(|pass| pass.off.is_none());
        running.for_each(|pass| foreign_eyes(&own, pass, &pipeline.images, errors));
        return (pipeline, Vec::new());
    }
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
    let whose: Vec<PassEyes> = pipeline.passes.iter().map(&mut of_pass).collect();
    let mut remarks = [for_one, remarks(&pipeline, &whose)].concat();
    if stereo == Stereo::Off || errors.len() > before {
        return (pipeline, remarks);
    }
    let apart = form.map(|form| SeparateImages::of(&pipeline, &own, &whose, eyes, form));
    remarks.extend(apart.iter().flat_map(|apart| images_apart(apart, &pipeline)));
    let at_once = |pass: &Arc<Pass>| apart.as_ref().is_some_and(|apart| apart.at_once(pass, &own, eyes));
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
                (PassEyes::Each, true) | (PassEyes::Both, _) => vec![of_eye(None, false)],
                (PassEyes::One(eye), _) => vec![of_eye(Some(eye), false)],
                (PassEyes::Each, false) => Eye::BOTH.map(|eye| of_eye(Some(eye), true)).into(),
            }
        })
        .collect();
    let outputs = std::mem::take(&mut pipeline.outputs);
    pipeline.outputs = outputs.into_iter().flat_map(|output| images.output(output)).collect();
    (pipeline, remarks)
}

/// Images that are one for each eye where both are drawn at once, and why.
fn images_apart(apart: &SeparateImages, pipeline: &Pipeline) -> Vec<Remark> {
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
fn remarks(pipeline: &Pipeline, whose: &[PassEyes]) -> Vec<Remark> {
    let passes = || pipeline.passes.iter().zip(whose).filter(|(pass, _)| pass.off.is_none());
    let read: HashSet<ImageIndex> = passes()
        .filter(|(_, whose)| **whose != PassEyes::Both)
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
    passes()
        .filter(|(pass, whose)| **whose == PassEyes::Both && sees(pass))
        .filter_map(|(pass, _)| remark(pass))
        .collect()
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
    for part in pass.image_parts_mut() {
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
