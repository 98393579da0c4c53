//! Images that hold both eyes' parts are used for both eyes at once.

use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Draw, EyeForm, Frame, Image, ImageIndex, Pass, Resource, Stereo};
use crate::vulkan::Shape;
use std::collections::HashSet;

/// Why an image can't hold both eyes' parts in its `eyes` form.
pub(super) fn image_problem(image: &Image, stereo: Stereo) -> Option<String> {
    let form = image.eyes?;
    let fits = match stereo {
        Stereo::Off | Stereo::MultiPass => false,
        Stereo::DoubleWide => form == EyeForm::Halves,
        Stereo::Instanced => true,
        Stereo::Multiview => form == EyeForm::Layers,
    };
    if !fits {
        Some(format!("holds both eyes' parts, which isn't how the frame is drawn for two eyes ({})", stereo.name()))
    } else if image.shape != Shape::D2 || image.layers > 1 {
        Some("holds both eyes' parts, so each is flat and has one layer".to_owned())
    } else if form == EyeForm::Halves && image.mips > 1 {
        Some("holds both eyes' parts side by side, so it has one mip level".to_owned())
    } else {
        None
    }
}

/// Reports uses of such images by a pass that aren't for both eyes at once.
pub(super) fn pass(frame: &Frame, pass: &Pass, errors: &mut Vec<Diagnostic>) {
    let eyes = |image: ImageIndex| frame.images[image.0 as usize].eyes;
    let mut wrong = |image: ImageIndex, span: Span, what: &str| {
        let name = &frame.images[image.0 as usize].name;
        errors.push(Diagnostic::new(
            Code::BOTH_EYES,
            span,
            format!("`{}` {what} `{name}`, which holds both eyes' parts", pass.name),
        ));
    };
    let target = pass.attachments().next().filter(|(image, _)| eyes(*image).is_some());
    if let Some((image, _)) = target.filter(|_| pass.work.draws(Draw::is_custom) && !pass.both_eyes) {
        wrong(image, pass.span, "is recorded by a program that doesn't say `both_eyes`, and draws into");
    }
    if let Some((image, _)) = target.filter(|_| pass.work.draws(Draw::is_indirect) && frame.stereo.is_by_instance()) {
        wrong(image, pass.span, "draws the instances that a buffer says into");
    }
    // A draw is for whom its target is. Outside of rendering scopes the program says it.
    let draws = pass.work.is_draw();
    let recorded = pass.both_eyes && pass.is_custom() && !draws;
    let own = target.is_some() || recorded;
    let dispatch = pass.work.groups().is_some();
    for storage in &pass.storage {
        let wrong_so = match (eyes(storage.image), storage.eye) {
            (None, _) => continue,
            (Some(EyeForm::Layers), Some(_)) if dispatch => continue,
            (Some(_), _) if recorded => continue,
            (Some(_), _) => "accesses as storage",
        };
        wrong(storage.image, storage.span, wrong_so);
    }
    for sampled in pass.sampled.iter().filter(|it| eyes(it.image).is_some() && it.eye.is_none() && !own) {
        wrong(sampled.image, sampled.span, "draws for one eye and doesn't say which it samples of");
    }
    let transfers = || {
        pass.transfers.iter().filter_map(|it| match it.resource {
            Resource::Image(image) => Some((image, it.span)),
            Resource::Buffer(_) => None,
        })
    };
    let all_alike = transfers().map(|(image, _)| eyes(image)).collect::<HashSet<_>>().len() < 2;
    let copied_whole = pass.work.is_copy() && all_alike && transfers().count() == 2;
    let whole = copied_whole || pass.work.filled().is_some() || recorded;
    for (image, span) in transfers().filter(|(image, _)| eyes(*image).is_some() && !whole) {
        wrong(image, span, "transfers");
    }
    if let Some([from, to]) = pass.work.forwarded()
        && eyes(from) != eyes(to)
    {
        wrong(if eyes(from).is_some() { from } else { to }, pass.span, "forwards from or to");
    }
    let sampled = pass.sampled.iter().map(|it| (it.image, it.eye, it.span, "samples"));
    let stored = pass.storage.iter().map(|it| (it.image, it.eye, it.span, "accesses"));
    for (image, _, span, does) in
        sampled.chain(stored).filter(|(image, eye, ..)| eye.is_some() && eyes(*image).is_none())
    {
        let name = &frame.images[image.0 as usize].name;
        let what = format!("`{}` {does} one eye's part of `{name}`, which holds one picture", pass.name);
        errors.push(Diagnostic::new(Code::BOTH_EYES, span, what));
    }
    errors.extend(claim_problem(frame, pass).map(|what| {
        Diagnostic::new(Code::CLAIMS_BOTH_EYES, pass.span, format!("`{}` says `both_eyes`, and {what}", pass.name))
    }));
}

/// Why a pass can't say that the program records it for both eyes at once, if it says so.
fn claim_problem(frame: &Frame, pass: &Pass) -> Option<&'static str> {
    if !pass.both_eyes {
        return None;
    }
    let eyes = |image: ImageIndex| frame.images[image.0 as usize].eyes.is_some();
    if !pass.is_custom() {
        return Some("no program records it");
    }
    if pass.work.is_draw() {
        let of_both = pass.attachments().next().is_some_and(|(image, _)| eyes(image));
        return (!of_both).then_some("draws into nothing that holds both eyes' parts");
    }
    let sampled = pass.sampled.iter().filter(|it| it.eye.is_none()).map(|it| it.image);
    let transferred = pass.transfers.iter().filter_map(|it| match it.resource {
        Resource::Image(image) => Some(image),
        Resource::Buffer(_) => None,
    });
    let mut touched = sampled.chain(pass.storage.iter().map(|it| it.image)).chain(transferred);
    (!touched.any(eyes)).then_some("touches nothing that holds both eyes' parts")
}
