//! Demotion: a full-screen draw that covers every pixel of a multisampled image gains nothing from the samples. Unless
//! geometry is drawn on top of what it draws, or single samples of it are read, it moves to a single-sampled image.

use super::adapter::Input;
use crate::frame::{Draw, Face, Frame, ImageIndex, Pass, ResolveWay, Resource};
use crate::plan::{Note, NoteKind};
use std::collections::BTreeSet;

/// Which draws move, and what is worth saying about images that need no resolve.
#[derive(Debug, Default)]
pub(super) struct Demotions {
    /// Pass and image.
    moved: BTreeSet<(u32, ImageIndex)>,
    /// Images that geometry is drawn into, where more samples would have meant a resolve; until that was said.
    of_geometry: Vec<bool>,
}

impl Demotions {
    /// Whether pass number `pass` draws `image` with a single sample.
    pub(super) fn moves(&self, pass: u32, image: ImageIndex) -> bool {
        !self.moved.is_empty() && self.moved.contains(&(pass, image))
    }

    /// Whether it should be said of an image with one sample that it needs no resolve. Said once.
    pub(super) fn is_worth_a_note(&mut self, image: ImageIndex) -> bool {
        self.of_geometry.get_mut(image.0 as usize).is_some_and(std::mem::take)
    }
}

/// Why a version of an image needs its samples.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Needs {
    /// It doesn't.
    #[default]
    Nothing,
    /// A pass draws geometry onto it.
    Edges(u32),
    /// A pass reads single samples of it.
    Samples(u32),
}

/// Walks back through the frame: what comes later decides whether samples are needed.
pub(super) fn find(input: &Input<'_>, notes: &mut Vec<Note>) -> Demotions {
    let Input { frame, live, negotiated, options, .. } = input;
    let mut demotions = Demotions::default();
    let passes = || live.passes.iter().map(|number| (*number, &frame.passes[*number as usize]));
    if negotiated.attached && passes().any(|(_, pass)| pass.work.draws(Draw::draws_objects)) {
        demotions.of_geometry = vec![false; frame.images.len()];
        for (_, pass) in passes().filter(|(_, pass)| pass.work.draws(Draw::draws_objects)) {
            pass.color.iter().for_each(|target| demotions.of_geometry[target.image.0 as usize] = true);
        }
    }
    let multisampled = |image: ImageIndex| negotiated.samples(image) > 1;
    if !negotiated.multisampled {
        return demotions;
    }
    let mut needs = vec![Needs::Nothing; frame.images.len()];
    for (number, pass) in passes().collect::<Vec<_>>().into_iter().rev() {
        for target in pass.color.iter().filter(|target| multisampled(target.image)) {
            let later = &mut needs[target.image.0 as usize];
            let image = &frame.images[target.image.0 as usize];
            // A draw into some layers keeps the others.
            let keeps = image.layers > 1 || pass.keeps_color(target, image);
            let fixed = image.lifetime.outlives_frame();
            match (is_flat(pass), keeps) {
                // It draws into whichever physical image holds the current version.
                (true, true) => {}
                (true, false) => {
                    let later = std::mem::take(later);
                    let covers = target.clear.is_none();
                    // Light below zero counts as none where samples are weighed, so that one sample isn't the same as four alike.
                    let weighed = image.resolve.as_ref().is_some_and(|resolve| resolve.way == ResolveWay::Weighted);
                    if covers && !fixed && !weighed && options.demote {
                        match later {
                            Needs::Nothing => drop(demotions.moved.insert((number, target.image))),
                            why => notes.push(stays(input, pass, target.image, why)),
                        }
                    }
                }
                (false, true) => *later = Needs::Edges(number),
                (false, false) => *later = Needs::Nothing,
            }
        }
        if let Some([from, to]) = pass.work.forwarded() {
            let later = std::mem::take(&mut needs[to.0 as usize]);
            // An image that outlives the frame has all its samples.
            let fixed = frame.images[to.0 as usize].lifetime.outlives_frame() && multisampled(to);
            match later {
                Needs::Nothing if fixed => needs[from.0 as usize] = Needs::Samples(number),
                Needs::Nothing => {}
                later => needs[from.0 as usize] = later,
            }
        }
        if copies_samples(frame, pass) {
            for used in &pass.transfers {
                if let Resource::Image(image) = used.resource {
                    needs[image.0 as usize] = if used.write { Needs::Nothing } else { Needs::Samples(number) };
                }
            }
        }
        for sampled in pass.sampled.iter().filter(|sampled| sampled.face == Face::Samples) {
            needs[sampled.image.0 as usize] = Needs::Samples(number);
        }
    }
    for (number, image) in &demotions.moved {
        let pass = &frame.passes[*number as usize];
        let name = &frame.images[image.0 as usize].name;
        let text = format!(
            "draws `{name}` with 1 sample instead of {}: it covers every pixel, and no geometry is drawn onto it \
             afterwards",
            negotiated.samples(*image)
        );
        notes.push(Note::new(NoteKind::OneSample, pass.name.clone(), text, frame.sources.place(pass.span)));
    }
    demotions
}

/// Whether a pass could as well draw into a single-sampled image: one that fills its only attachment evenly.
fn is_flat(pass: &Pass) -> bool {
    let once = pass.work.draws_samples_alike();
    once && !has_edges(pass) && pass.depth.is_none() && pass.color.len() == 1
}

fn stays(input: &Input<'_>, pass: &Pass, image: ImageIndex, why: Needs) -> Note {
    let frame = input.frame;
    let name = &frame.images[image.0 as usize].name;
    let because = match why {
        Needs::Nothing => String::new(),
        Needs::Edges(later) => format!("`{}` draws onto it afterwards", frame.passes[later as usize].name),
        Needs::Samples(later) => format!("`{}` reads its single samples", frame.passes[later as usize].name),
    };
    let text = format!("draws `{name}` with {} samples: {because}", input.negotiated.samples(image));
    Note::new(NoteKind::SeveralSamples, pass.name.clone(), text, frame.sources.place(pass.span))
}

/// Whether a pass copies into images sample by sample: then it reads single samples, too.
pub(super) fn copies_samples(frame: &Frame, pass: &Pass) -> bool {
    let target = pass.transfers.iter().find(|used| used.write).map(|used| used.resource);
    let Some(Resource::Image(target)) = target.filter(|_| pass.work.keeps_samples()) else {
        return false;
    };
    frame.images[target.0 as usize].samples > 1
}

/// Whether a draw is made of objects or other geometry that has edges inside the image, or makes edges by its alpha.
fn has_edges(pass: &Pass) -> bool {
    pass.alpha_to_coverage || pass.work.draws(|draw| !draw.is_full_screen())
}
