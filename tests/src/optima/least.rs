//! The least cost of one order.
//!
//! **Resolves.** Each version of a multisampled image of which a pass wants one value a texel is resolved once, for all passes
//! that want it. Not so if the version comes from full-screen draws alone since one that covers: then all its samples are
//! equal, and it may as well live in an image of one sample.
//!
//! **Image barriers.** Each image takes one when it is first used. After that it takes one wherever a write and any other
//! access follow each other in different rendering scopes, and none between reads. Neighbouring draws share a scope if
//! they draw into the same images, none samples what the scope writes, and no version in between is resolved.
//!
//! **Memory.** Each transient image lives from the first scope or dispatch that touches it to the last; so does the
//! resolved copy of each version. Outputs have memory of their own.

use super::orders::touched;
use super::packing::{Piece, least};
use framewright_graph::frame::{Blend, Draw, Frame, ImageIndex, Pass, Resource, Work};
use framewright_graph::vulkan::CompareOp;
use std::collections::{BTreeMap, BTreeSet};

/// The cost of an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cost {
    /// Resolves.
    pub resolves: u32,
    /// Image barriers.
    pub barriers: u32,
    /// Bytes of transient memory.
    pub bytes: u64,
}

/// The holder of a version of an image: the image as declared, or one of a single sample instead of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Home {
    image: ImageIndex,
    single: bool,
}

/// The least that a frame costs whose passes run as they stand.
#[must_use]
pub fn costs(frame: &Frame) -> Cost {
    let single = single_sampled(frame);
    let resolved = resolved_versions(frame, &single);
    let steps = steps(frame, &single, &resolved);
    Cost {
        resolves: resolved.len() as u32,
        barriers: barriers(frame, &single, &resolved, &steps),
        bytes: least(&pieces(frame, &single, &resolved, &steps)),
    }
}

fn samples(frame: &Frame, image: ImageIndex) -> u32 {
    frame.images[image.0 as usize].samples
}

fn is_output(frame: &Frame, image: ImageIndex) -> bool {
    frame.outputs.iter().any(|output| output.resource == Resource::Image(image))
}

/// Whether a pass draws the full screen and nothing else decides which samples it reaches.
fn uniform(pass: &Pass) -> bool {
    let full_screen = matches!(pass.work, Work::Draw { draw: Draw::FullScreen, per_sample: false, .. });
    full_screen && pass.depth.as_ref().is_none_or(|depth| depth.test == CompareOp::Always)
}

fn covers(pass: &Pass, image: ImageIndex) -> bool {
    let target = pass.color.iter().find(|target| target.image == image);
    let whole = matches!(pass.work, Work::Draw { draw: Draw::FullScreen, discards: false, .. }) && pass.depth.is_none();
    target.is_some_and(|target| target.clear.is_some() || whole && target.blend == Blend::Replace)
}

/// Passes that write an image.
fn writers(frame: &Frame, image: ImageIndex) -> Vec<usize> {
    (0..frame.passes.len()).filter(|pass| touched(&frame.passes[*pass])[1].contains(&image)).collect()
}

/// Passes and multisampled targets of theirs that may as well have one sample: from a covering full-screen draw on, as
/// long as only full-screen draws follow.
fn single_sampled(frame: &Frame) -> BTreeSet<(usize, ImageIndex)> {
    let mut single = BTreeSet::new();
    let images = (0..frame.images.len() as u32).map(ImageIndex);
    for image in images.filter(|image| samples(frame, *image) > 1) {
        let writers = writers(frame, image);
        let pure = |writer: &usize| {
            let pass = &frame.passes[*writer];
            uniform(pass) && pass.color.len() == 1
        };
        let start = (0..writers.len())
            .find(|start| covers(&frame.passes[writers[*start]], image) && writers[*start..].iter().all(pure));
        single.extend(writers[start.unwrap_or(writers.len())..].iter().map(|writer| (*writer, image)));
    }
    single
}

/// Multisampled versions, each by the pass that writes it, that somebody samples or that leave the frame.
fn resolved_versions(frame: &Frame, single: &BTreeSet<(usize, ImageIndex)>) -> BTreeSet<(usize, ImageIndex)> {
    let mut resolved = BTreeSet::new();
    for image in (0..frame.images.len() as u32).map(ImageIndex).filter(|image| samples(frame, *image) > 1) {
        for (number, pass) in frame.passes.iter().enumerate() {
            if pass.sampled.iter().any(|sampled| sampled.image == image) {
                resolved
                    .extend(writers(frame, image).into_iter().rfind(|writer| *writer < number).map(|by| (by, image)));
            }
        }
        if is_output(frame, image) {
            resolved.extend(writers(frame, image).last().map(|by| (*by, image)));
        }
    }
    resolved.difference(single).copied().collect()
}

/// For each pass the number of its step: neighbouring draws that may share a scope share one.
fn steps(
    frame: &Frame,
    single: &BTreeSet<(usize, ImageIndex)>,
    resolved: &BTreeSet<(usize, ImageIndex)>,
) -> Vec<usize> {
    let targets = |number: usize| -> Vec<(ImageIndex, bool)> {
        let pass = &frame.passes[number];
        pass.color.iter().map(|target| (target.image, single.contains(&(number, target.image)))).collect()
    };
    let mut steps: Vec<usize> = Vec::new();
    let mut written: BTreeSet<ImageIndex> = BTreeSet::new();
    let mut depth: Option<ImageIndex> = None;
    for (number, pass) in frame.passes.iter().enumerate() {
        let before = number.checked_sub(1);
        let draws = |at: usize| matches!(frame.passes[at].work, Work::Draw { .. });
        let own = pass.depth.as_ref().map(|depth| depth.image);
        let shares = before.is_some_and(|before| {
            draws(before)
                && draws(number)
                && targets(before) == targets(number)
                && (own == depth || own.is_none() || depth.is_none())
                && !resolved.iter().any(|(by, _)| *by == before)
                && pass.sampled.iter().all(|sampled| !written.contains(&sampled.image))
                // A target that would have to be cleared in the middle of a scope begins one.
                && pass.color.iter().all(|target| target.clear.is_none())
                && pass.depth.as_ref().is_none_or(|depth| depth.clear.is_none())
        });
        if !shares {
            written.clear();
            depth = None;
        }
        written.extend(touched(pass)[1].iter().copied());
        depth = depth.or(own);
        let step = steps.last().map_or(0, |last| last + usize::from(!shares));
        steps.push(step);
    }
    steps
}

/// Where a pass finds the version that it samples: `None` if in a resolved copy.
fn sampled_home(
    frame: &Frame,
    (pass, image): (usize, ImageIndex),
    single: &BTreeSet<(usize, ImageIndex)>,
) -> Option<Home> {
    let by = writers(frame, image).into_iter().rfind(|writer| *writer < pass)?;
    let single = single.contains(&(by, image));
    (single || samples(frame, image) == 1).then_some(Home { image, single })
}

fn barriers(
    frame: &Frame,
    single: &BTreeSet<(usize, ImageIndex)>,
    resolved: &BTreeSet<(usize, ImageIndex)>,
    steps: &[usize],
) -> u32 {
    // The last access to each image: in which step, and whether it writes.
    let mut last: BTreeMap<Home, (usize, bool)> = BTreeMap::new();
    let mut count = 0;
    let mut touch = |home: Home, step: usize, writes: bool, within: bool| {
        let before = last.insert(home, (step, writes));
        count += u32::from(match before {
            None => true,
            Some((at, wrote)) => (wrote || writes) && (at != step || !within),
        });
    };
    for (number, pass) in frame.passes.iter().enumerate() {
        for sampled in pass.sampled.iter().map(|sampled| sampled.image).collect::<BTreeSet<_>>() {
            if let Some(home) = sampled_home(frame, (number, sampled), single) {
                touch(home, steps[number], false, true);
            }
        }
        let attached = pass.color.iter().map(|target| (target.image, true));
        let depth = pass.depth.as_ref().map(|depth| (depth.image, depth.write || depth.clear.is_some()));
        for (image, writes) in attached.chain(depth) {
            let home = Home { image, single: single.contains(&(number, image)) };
            let sampled = pass.sampled.iter().any(|sampled| sampled.image == image);
            touch(
                home,
                steps[number],
                writes,
                !(sampled && sampled_home(frame, (number, image), single) == Some(home)),
            );
        }
        for storage in &pass.storage {
            touch(Home { image: storage.image, single: false }, steps[number], true, true);
        }
    }
    // A resolved copy is written, and then read if a pass samples it.
    let sampled = |(by, image): &(usize, ImageIndex)| {
        let next = writers(frame, *image).into_iter().find(|writer| writer > by).unwrap_or(frame.passes.len());
        let reads = |pass: &Pass| pass.sampled.iter().any(|sampled| sampled.image == *image);
        (by + 1..=next.min(frame.passes.len().saturating_sub(1))).any(|pass| reads(&frame.passes[pass]))
    };
    count + resolved.iter().map(|version| 1 + u32::from(sampled(version))).sum::<u32>()
}

fn pieces(
    frame: &Frame,
    single: &BTreeSet<(usize, ImageIndex)>,
    resolved: &BTreeSet<(usize, ImageIndex)>,
    steps: &[usize],
) -> Vec<Piece> {
    let bytes = |image: ImageIndex, samples: u32| {
        let image = &frame.images[image.0 as usize];
        let texels = u64::from(image.extent[0]) * u64::from(image.extent[1]);
        (texels * image.format.texel_bytes() * u64::from(samples)).next_multiple_of(256)
    };
    let mut lives: BTreeMap<Home, (usize, usize)> = BTreeMap::new();
    let mut live = |home: Home, step: usize| {
        let life = lives.entry(home).or_insert((step, step));
        *life = (life.0.min(step), life.1.max(step));
    };
    let mut copies: BTreeMap<(usize, ImageIndex), (usize, usize)> =
        resolved.iter().map(|version| (*version, (steps[version.0], steps[version.0]))).collect();
    for (number, pass) in frame.passes.iter().enumerate() {
        for image in pass.sampled.iter().map(|sampled| sampled.image) {
            match sampled_home(frame, (number, image), single) {
                Some(home) => live(home, steps[number]),
                None => {
                    let by = writers(frame, image).into_iter().rfind(|writer| *writer < number);
                    if let Some(copy) = by.and_then(|by| copies.get_mut(&(by, image))) {
                        copy.1 = steps[number];
                    }
                }
            }
        }
        let depth = pass.depth.iter().map(|depth| depth.image);
        let stored = pass.storage.iter().map(|storage| storage.image);
        for image in pass.color.iter().map(|target| target.image).chain(depth).chain(stored) {
            live(Home { image, single: single.contains(&(number, image)) }, steps[number]);
        }
    }
    let leaves = |home: &Home| is_output(frame, home.image) && (home.single || samples(frame, home.image) == 1);
    let images = lives.iter().filter(|(home, _)| !leaves(home)).map(|(home, (first, last))| {
        let samples = if home.single { 1 } else { samples(frame, home.image) };
        (*first, *last, bytes(home.image, samples))
    });
    let last_version =
        |(by, image): &(usize, ImageIndex)| is_output(frame, *image) && writers(frame, *image).last() == Some(by);
    let copies = copies.iter().filter(|(version, _)| !last_version(version));
    images.chain(copies.map(|((_, image), (first, last))| (*first, *last, bytes(*image, 1)))).collect()
}
