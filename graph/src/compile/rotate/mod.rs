//! `rotate`: outputs that leave the frame rotated are drawn rotated. So are the images that are attached beside them, and
//! multisampled images that are resolved into them, since a resolve rotates nothing.
//!
//! Images that a shader reads stay upright: it looks texels up where the upright picture has them. So an output that passes
//! also read becomes two images where it is drawn anew, or it is drawn upright and rotated by one more draw.

mod separate_outputs;
mod turn_search;

use super::cull;
use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Frame, Image, ImageIndex, Lifetime, Output, Resource};
use crate::vulkan::{Layout, Rotation, Shape};
use std::collections::BTreeSet;
use turn_search::{Hindrance, TurnSearch, becomes, degrees};

/// The frame with turned images; `None`: nothing is turned.
pub(super) fn rotate(frame: &Frame) -> Result<Option<Frame>, Vec<Diagnostic>> {
    if let Some(image) = frame.images.iter().find(|image| image.rotation.turns()) {
        let message = format!("`{}` is turned, which only the compiler does", image.name);
        return Err(vec![
            Diagnostic::new(Code::TURNED_IMAGE, image.span, message).help("set the rotation of an output"),
        ]);
    }
    if !frame.outputs.iter().any(|output| output.rotation.turns()) {
        return Ok(None);
    }
    let live = cull::live(frame)?.1.passes;
    let mut turner = Turner { frame: frame.clone(), live, errors: Vec::new() };
    for output in frame.outputs.iter().filter(|output| output.rotation.turns()) {
        turner.output(output);
    }
    turner.forwarded();
    if turner.errors.is_empty() { Ok(Some(turner.frame)) } else { Err(turner.errors) }
}

struct Turner {
    frame: Frame,
    /// Passes that stay.
    live: Vec<u32>,
    errors: Vec<Diagnostic>,
}

impl Turner {
    fn output(&mut self, output: &Output) {
        let Resource::Image(image) = output.resource else {
            let message = "a buffer leaves the frame rotated: only images can".to_owned();
            return self.errors.push(Diagnostic::new(Code::ROTATION_UNFIT, output.span, message));
        };
        let declared = &self.frame.images[image.0 as usize];
        if declared.rotation == output.rotation {
            return;
        }
        if let Some(what) = unfit(declared) {
            let message = format!("`{}` leaves the frame {}, and {what}", declared.name, degrees(output.rotation));
            return self.errors.push(Diagnostic::new(Code::ROTATION_UNFIT, output.span, message));
        }
        let hindrance = match self.together(&self.frame, image, output.rotation, true) {
            Ok(together) => return self.turn(&together, output.rotation),
            Err(Hindrance::Wrong(wrong)) => return self.errors.push(*wrong),
            Err(Hindrance::Upright(because, at)) => (because, at),
        };
        // Its contents are turned already: no draw can begin upright.
        if before(declared).is_some_and(|before| before != Layout::Undefined) {
            let (because, at) = hindrance;
            let message = format!("`{}` is handed in {}, and {because}", declared.name, degrees(output.rotation));
            return self
                .errors
                .push(Diagnostic::new(Code::ROTATION_UNFIT, output.span, message).label(at, "needs it upright"));
        }
        if let Some(split) = separate_outputs::where_drawn_anew(&self.frame, &self.live, image) {
            match self.together(&split, image, output.rotation, true) {
                Ok(together) => {
                    self.frame = split;
                    return self.turn(&together, output.rotation);
                }
                Err(Hindrance::Wrong(wrong)) => return self.errors.push(*wrong),
                Err(Hindrance::Upright(..)) => {}
            }
        }
        self.by_a_draw(image, output, hindrance);
    }

    /// Draws an output upright, and turns it at the end.
    fn by_a_draw(&mut self, image: ImageIndex, output: &Output, (because, at): (String, Span)) {
        let name = self.frame.images[image.0 as usize].name.clone();
        let why = format!("`{name}` leaves the frame {}, and {because}", degrees(output.rotation));
        let last = separate_outputs::draw_upright(&mut self.frame, &self.live, image, why, at);
        self.live.push(last);
        self.turn(&BTreeSet::from([image]), output.rotation);
    }

    /// Turns images that are forwarded to turned ones where it can, which saves a draw.
    fn forwarded(&mut self) {
        loop {
            let forwards = self.live.iter().filter_map(|pass| self.frame.passes[*pass as usize].work.forwarded());
            let images = &self.frame.images;
            let found =
                forwards.filter(|[from, _]| !images[from.0 as usize].rotation.turns()).find_map(|[from, to]| {
                    let (source, target) = (&images[from.0 as usize], &images[to.0 as usize]);
                    let rotation = target.rotation;
                    let may = rotation.turns() && becomes(source, target, rotation);
                    may.then(|| self.together(&self.frame, from, rotation, false).ok())
                        .flatten()
                        .map(|all| (all, rotation))
                });
            let Some((together, rotation)) = found else { return };
            self.turn(&together, rotation);
        }
    }

    fn together(
        &self,
        frame: &Frame,
        image: ImageIndex,
        rotation: Rotation,
        is_output: bool,
    ) -> Result<BTreeSet<ImageIndex>, Hindrance> {
        TurnSearch { frame, live: &self.live, rotation, start: image, is_output }.find()
    }

    fn turn(&mut self, images: &BTreeSet<ImageIndex>, rotation: Rotation) {
        for image in images {
            let image = &mut self.frame.images[image.0 as usize];
            if image.rotation == rotation {
                continue;
            }
            let [width, height, depth] = image.extent;
            let [width, height] = rotation.extent([width, height]);
            image.extent = [width, height, depth];
            image.allocated = image.allocated.map(|allocated| rotation.extent(allocated));
            image.rotation = rotation;
        }
    }
}

/// Why an output can't leave the frame turned, apart from its use by passes.
fn unfit(image: &Image) -> Option<&'static str> {
    match image.lifetime {
        _ if image.format.is_depth() => Some("holds depth: only colour can be rotated"),
        _ if image.shape != Shape::D2 => Some("isn't flat: only flat images can be rotated"),
        _ if image.mips > 1 => Some("has several mip levels: only images of one can be rotated"),
        // What was presented is turned as the screen wants it.
        _ if before(image).is_some_and(|it| !matches!(it, Layout::Undefined | Layout::PresentSrcKhr)) => {
            Some("is handed in with contents: nobody could tell how they are turned")
        }
        _ => None,
    }
}

/// The layout in which an image is handed in; `None`: it isn't.
fn before(image: &Image) -> Option<Layout> {
    match image.lifetime {
        Lifetime::Imported { before, .. } => Some(before.layout),
        _ => None,
    }
}
