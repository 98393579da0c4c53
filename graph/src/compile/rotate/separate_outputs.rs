//! An output that passes read becomes two images: one that stays upright and is read, and one that leaves the frame turned.

use crate::base::Span;
use crate::frame::{Access, Frame, Image, ImageIndex, Lifetime, Pass, Resource, Work};
use std::sync::Arc;

/// The frame with an upright image in place of `image` up to where it is drawn anew, and not read after that; `None`: there
/// is no such place.
pub(super) fn where_drawn_anew(frame: &Frame, live: &[u32], image: ImageIndex) -> Option<Frame> {
    let declared = &frame.images[image.0 as usize];
    if !matches!(declared.lifetime, Lifetime::Transient | Lifetime::Imported { .. }) {
        return None;
    }
    let pass = |number: &u32| &frame.passes[*number as usize];
    let last = live.iter().rposition(|number| reads(pass(number), image))?;
    let anew = (last..live.len()).find(|at| {
        let pass = pass(&live[*at]);
        replaces(frame, pass, image) && (*at > last || only_samples(pass, image))
    })?;
    let anew = live[anew];
    let mut split = frame.clone();
    let upright = upright_of(&mut split, image);
    for (pass, number) in split.passes.iter_mut().zip(0_u32..) {
        if number < anew {
            rename(pass, image, upright);
        } else if number == anew {
            pass.sampled.iter_mut().filter(|it| it.image == image).for_each(|it| it.image = upright);
        }
    }
    Some(split)
}

/// Has all passes use an upright image in place of `image`, and adds one that draws it into `image`. Returns that one's
/// number.
pub(super) fn draw_upright(frame: &mut Frame, live: &[u32], image: ImageIndex, why: String, at: Span) -> u32 {
    let upright = upright_of(frame, image);
    frame.passes.iter_mut().for_each(|pass| rename(pass, image, upright));
    let declared = &mut frame.images[image.0 as usize];
    (declared.samples, declared.resolve) = (1, None);
    if !matches!(declared.lifetime, Lifetime::Imported { .. }) {
        let lifetime = std::mem::take(&mut declared.lifetime);
        frame.images[upright.0 as usize].lifetime = lifetime;
    }
    let writes = |number: &&u32| writes(frame, &frame.passes[**number as usize], upright);
    let view = live.iter().rev().find(writes).map(|number| frame.passes[*number as usize].view).unwrap_or_default();
    let name = format!("{} (rotated)", frame.images[image.0 as usize].name);
    let work = Work::Forward { from: upright, to: image, because: String::new() };
    frame.passes.push(Pass { span: at, view, inserted: Some(why.into()), ..Pass::new(&name, work) });
    frame.passes.len() as u32 - 1
}

/// Adds an image like `image` that stays upright.
fn upright_of(frame: &mut Frame, image: ImageIndex) -> ImageIndex {
    let declared = &frame.images[image.0 as usize];
    let name: Arc<str> = format!("{} (upright)", declared.name).into();
    let upright = Image { name, lifetime: Lifetime::Transient, ..declared.clone() };
    frame.images.push(upright);
    ImageIndex(frame.images.len() as u32 - 1)
}

fn only_samples(pass: &Pass, image: ImageIndex) -> bool {
    let mut sampled = pass.sampled.iter().filter(|it| it.image == image);
    sampled.all(|it| it.frames_ago == 0) && !reads_otherwise(pass, image)
}

fn reads(pass: &Pass, image: ImageIndex) -> bool {
    pass.sampled.iter().any(|it| it.image == image) || reads_otherwise(pass, image)
}

/// Whether a pass reads the image otherwise than by sampling it, or needs it upright.
fn reads_otherwise(pass: &Pass, image: ImageIndex) -> bool {
    let copies = pass.work.is_transfer() && pass.work.filled().is_none();
    accesses(pass, image).any(|access| match access {
        Access::Storage(_) | Access::ForwardSource(..) => true,
        Access::Transfer(used) => copies || !used.write,
        _ => false,
    })
}

/// Whether a pass replaces the whole contents of the image.
fn replaces(frame: &Frame, pass: &Pass, image: ImageIndex) -> bool {
    let declared = &frame.images[image.0 as usize];
    let mut targets = pass.color.iter().filter(|target| target.image == image);
    targets.any(|target| declared.layers == 1 && !pass.keeps_color(target, declared))
        || pass.work.forwarded().is_some_and(|[_, to]| to == image)
        || pass.transfers.iter().any(|it| it.write && it.resource == Resource::Image(image) && declared.layers == 1)
}

fn writes(frame: &Frame, pass: &Pass, image: ImageIndex) -> bool {
    accesses(pass, image).any(|access| access.writes(pass, frame.images.get(image.0 as usize)))
}

fn accesses(pass: &Pass, image: ImageIndex) -> impl Iterator<Item = Access<'_>> {
    pass.accesses().filter(move |access| access.resource() == Resource::Image(image))
}

/// Has a pass use `to` in place of `from`.
fn rename(pass: &mut Pass, from: ImageIndex, to: ImageIndex) {
    let color = pass.color.iter_mut().map(|it| &mut it.image);
    let depth = pass.depth.iter_mut().map(|it| &mut it.image);
    let sampled = pass.sampled.iter_mut().map(|it| &mut it.image);
    let storage = pass.storage.iter_mut().map(|it| &mut it.image);
    color.chain(depth).chain(sampled).chain(storage).filter(|it| **it == from).for_each(|it| *it = to);
    for transfer in pass.transfers.iter_mut().filter(|it| it.resource == Resource::Image(from)) {
        transfer.resource = Resource::Image(to);
    }
    for declared in pass.uses.iter_mut().filter(|it| it.resource == Resource::Image(from)) {
        declared.resource = Resource::Image(to);
    }
    let forwarded = pass.work.forwarded_mut().into_iter().flatten();
    forwarded.filter(|it| **it == from).for_each(|it| *it = to);
}
