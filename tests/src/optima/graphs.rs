//! Small random frames whose every pass is needed.

use super::orders::touched;
use crate::frames::Builder;
use framewright_graph::frame::{Blend, Frame, ImageIndex, Resource};
use framewright_graph::vulkan::Format::{D32_SFLOAT, R8G8B8A8_UNORM};
use std::collections::BTreeSet;

/// Numbers that look random (a 64-bit linear congruential generator).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, below: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % below.max(1)
    }
}

/// An image while a frame is made.
#[derive(Clone, Copy)]
struct Known {
    image: ImageIndex,
    samples: u32,
    side: u32,
    attached: bool,
}

/// The frame of a seed: between three and `most` passes.
#[must_use]
pub fn frame(seed: u64, most: usize) -> Frame {
    let mut numbers = Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 12345);
    numbers.below(2);
    let mut builder = Builder::default();
    let mut known: Vec<Known> = Vec::new();
    let passes = 3 + numbers.below(most - 2);
    for number in 0..passes - 1 {
        let name = format!("p{number}");
        match numbers.below(4) {
            0 => dispatch(&mut numbers, &mut builder, &mut known, &name),
            1 => objects(&mut numbers, &mut builder, &mut known, &name),
            _ => full_screen(&mut numbers, &mut builder, &mut known, &name),
        }
    }
    // Images that no pass has sampled by now come together in the last pass.
    let sampled: BTreeSet<ImageIndex> =
        builder.0.passes.iter().flat_map(|pass| pass.sampled.iter().map(|sampled| sampled.image)).collect();
    let left: Vec<ImageIndex> =
        known.iter().map(|known| known.image).filter(|image| !sampled.contains(image)).collect();
    let last = fresh(&mut numbers, &mut builder, &mut known, true).image;
    let pass = builder.full_screen("last").color(last, Blend::Replace);
    left.into_iter().fold(pass, |pass, source| pass.sample(source));
    let mut outputs = BTreeSet::from([last]);
    if numbers.below(3) == 0 {
        outputs.insert(known[numbers.below(known.len())].image);
    }
    let outputs: Vec<ImageIndex> = outputs.into_iter().collect();
    needed(builder.outputs(&outputs))
}

fn fresh(numbers: &mut Numbers, builder: &mut Builder, known: &mut Vec<Known>, multisampled: bool) -> Known {
    let side = [32, 64, 64, 128][numbers.below(4)];
    let samples = if multisampled && numbers.below(2) == 0 { 4 } else { 1 };
    let image = builder.image(&format!("i{}", known.len()), R8G8B8A8_UNORM, side, samples);
    let made = Known { image, samples, side, attached: false };
    known.push(made);
    made
}

/// Up to two images that are there, other than `but`.
fn sources(numbers: &mut Numbers, known: &[Known], but: Option<ImageIndex>) -> BTreeSet<ImageIndex> {
    let among: Vec<ImageIndex> = known.iter().map(|known| known.image).filter(|image| Some(*image) != but).collect();
    (0..numbers.below(3)).filter_map(|_| among.get(numbers.below(among.len())).copied()).collect()
}

fn dispatch(numbers: &mut Numbers, builder: &mut Builder, known: &mut Vec<Known>, name: &str) {
    let there = known.clone();
    let stored: Vec<Known> = there.iter().copied().filter(|known| known.samples == 1 && !known.attached).collect();
    let (target, read) = match stored.get(numbers.below(4 * stored.len().max(1))) {
        Some(target) => (*target, true),
        None => (fresh(numbers, builder, known, false), false),
    };
    let sources = sources(numbers, &there, Some(target.image));
    let pass = builder.dispatch(name).store(target.image, read);
    sources.into_iter().fold(pass, |pass, source| pass.sample(source));
}

fn objects(numbers: &mut Numbers, builder: &mut Builder, known: &mut Vec<Known>, name: &str) {
    let drawn: Vec<Known> = known.iter().copied().filter(|known| known.attached).collect();
    if let Some(target) = drawn.get(numbers.below(2 * drawn.len().max(1))) {
        builder.objects(name).color(target.image, Blend::Alpha);
        return;
    }
    let target = fresh(numbers, builder, known, true);
    if let Some(known) = known.last_mut() {
        known.attached = true;
    }
    let depth = (numbers.below(2) == 0)
        .then(|| builder.image(&format!("{name} depth"), D32_SFLOAT, target.side, target.samples));
    let pass = builder.objects(name).clear(target.image);
    if let Some(depth) = depth {
        pass.depth(depth, Some(0.0), true);
    }
}

fn full_screen(numbers: &mut Numbers, builder: &mut Builder, known: &mut Vec<Known>, name: &str) {
    let there = known.clone();
    let drawn: Vec<Known> = there.iter().copied().filter(|known| known.attached).collect();
    let (target, blend) = match drawn.get(numbers.below(3 * drawn.len().max(1))) {
        Some(target) => (*target, Blend::Alpha),
        None => {
            let target = fresh(numbers, builder, known, true);
            if let Some(known) = known.last_mut() {
                known.attached = true;
            }
            (target, Blend::Replace)
        }
    };
    let sources = sources(numbers, &there, Some(target.image));
    let pass = builder.full_screen(name).color(target.image, blend);
    sources.into_iter().fold(pass, |pass, source| pass.sample(source));
}

/// The frame without passes that no output needs. No pass here replaces what an earlier one made, so a pass is needed if it
/// writes an output, or an image that a later needed pass reads or writes.
fn needed(frame: Frame) -> Frame {
    let mut wanted: BTreeSet<ImageIndex> = frame
        .outputs
        .iter()
        .filter_map(|output| if let Resource::Image(image) = output.resource { Some(image) } else { None })
        .collect();
    let mut passes = Vec::new();
    for pass in frame.passes.into_iter().rev() {
        let [reads, writes] = touched(&pass);
        if !writes.is_disjoint(&wanted) {
            wanted.extend(reads.into_iter().chain(writes));
            passes.push(pass);
        }
    }
    passes.reverse();
    Frame { passes, ..frame }
}
