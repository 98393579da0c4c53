//! Evaluates a random pipeline on the CPU: pass after pass in the order of the file, each as a whole.
//!
//! Nothing here knows of Plans, or of anything that a compiler does. A pass reads the state that the passes above it left,
//! also of what it writes itself.

mod draw;
mod shade;
mod state;

pub use state::{Filled, State, Texel, Word, imported_buffer, imported_image};

use super::hash::hash;
use super::pipeline::{Compute, Groups, Part, Pass, Pipeline, Region, Store, StoreAccess, WORKGROUP, Work};
use super::texels;
use super::valid::size;
use std::sync::Arc;

/// The state after the passes of one more frame; `frame` counts from 0.
#[must_use]
pub fn frame(pipeline: &Pipeline, state: &State, frame: u32) -> State {
    let mut state = state.next_frame(pipeline, frame);
    for pass in &pipeline.passes {
        let before = state.clone();
        Evaluator { pipeline, pass, before: &before, after: &mut state }.pass();
    }
    state
}

/// The evaluation of one pass.
struct Evaluator<'e> {
    pipeline: &'e Pipeline,
    pass: &'e Pass,
    before: &'e State,
    after: &'e mut State,
}

impl Evaluator<'_> {
    fn pass(&mut self) {
        match &self.pass.work {
            Work::Draw(draw) => self.draw(draw),
            Work::Compute(compute) => self.compute(compute),
            Work::Copy { from, frames_ago, to } => self.copy(*from, *frames_ago as usize, *to),
            Work::Blit { from, to } => self.blit(*from, *to),
            Work::Fill { to, value } | Work::Custom { from: None, to, value } => self.fill(*to, *value),
            Work::Custom { from: Some(from), to, .. } => self.copy(*from, 0, *to),
            Work::Forward { from, to } => self.forward(*from, *to),
        }
    }

    fn texel(&self, words: texels::Words) -> Texel {
        Texel { words, writer: Some(self.pass.number) }
    }

    fn word(&self, bits: u32) -> Word {
        Word { bits, writer: Some(self.pass.number) }
    }

    fn image(&mut self, image: usize) -> &mut Filled {
        Arc::make_mut(&mut self.after.images[image][0])
    }

    /// Replaces the planes of a texel that a part has.
    fn put(&mut self, part: Part, mip: u32, at: [u32; 3], sample: u32, words: texels::Words) {
        let writer = Some(self.pass.number);
        let texel = self.image(part.image).texel_mut(mip, at, sample);
        *texel = Texel { words: texels::merged(part.plane, texel.words, words), writer };
    }

    fn buffer(&mut self, buffer: usize) -> &mut Vec<Word> {
        Arc::make_mut(&mut self.after.buffers[buffer][0])
    }

    fn copy(&mut self, from: Region, frames_ago: usize, to: Region) {
        let linear = |evaluator: &Self, part: Part| {
            let [width, height, depth] = size(&evaluator.pipeline.images[part.image], part);
            let at = move |line: u32| [line % width, line / width % height, line / width / height + part.layer];
            (0..width * height * depth).map(at)
        };
        match (from, to) {
            (Region::Image(from), Region::Image(to)) => {
                let source = self.before.images[from.image][frames_ago].clone();
                for (read, written) in linear(self, from).zip(linear(self, to)) {
                    for sample in 0..self.pipeline.images[to.image].samples {
                        let words = source.texel(from.mip, read, sample).words;
                        self.put(to, to.mip, written, sample, words);
                    }
                }
            }
            (Region::Buffer(from), Region::Buffer(to)) => {
                let words = self.before.buffers[from][frames_ago].iter().map(|word| self.word(word.bits)).collect();
                *self.buffer(to) = words;
            }
            (Region::Image(from), Region::Buffer(to)) => {
                let format = self.pipeline.images[from.image].format;
                let source = &self.before.images[from.image][frames_ago];
                let texel = |at| texels::bytes(format, source.texel(from.mip, at, 0).words);
                let bytes: Vec<u8> = linear(self, from).flat_map(texel).collect();
                let word =
                    |bytes: &[u8]| self.word(bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte)));
                *self.buffer(to) = bytes.chunks(4).map(word).collect();
            }
            (Region::Buffer(from), Region::Image(to)) => {
                let format = self.pipeline.images[to.image].format;
                let bytes: Vec<u8> =
                    self.before.buffers[from][frames_ago].iter().flat_map(|word| word.bits.to_le_bytes()).collect();
                let texels = bytes.chunks(format.texel_bytes() as usize);
                for (at, bytes) in linear(self, to).zip(texels) {
                    let texel = self.texel(integers(bytes, bytes.len() / format.components() as usize));
                    *self.image(to.image).texel_mut(to.mip, at, 0) = texel;
                }
            }
        }
    }

    fn blit(&mut self, from: Part, to: Part) {
        let source = self.before.images[from.image][0].clone();
        let [read, written] = [from, to].map(|part| size(&self.pipeline.images[part.image], part));
        for layer in 0..to.layers {
            for y in 0..written[1] {
                for x in 0..written[0] {
                    // The texel in which the middle of the target's texel lies.
                    let place = |axis: usize, at: u32| (2 * at + 1) * read[axis] / (2 * written[axis]);
                    let texel = source.texel(from.mip, [place(0, x), place(1, y), from.layer + layer], 0);
                    let texel = self.texel(texel.words);
                    *self.image(to.image).texel_mut(to.mip, [x, y, to.layer + layer], 0) = texel;
                }
            }
        }
    }

    fn fill(&mut self, to: Region, value: u8) {
        match to {
            Region::Image(part) => {
                let words = texels::plain_texel(self.pipeline.images[part.image].format, value);
                let image = &self.pipeline.images[part.image];
                let samples = image.samples;
                for mip in part.mip..part.mip + part.mips {
                    let [width, height, depth] = size(image, Part { mip, ..part });
                    for at in 0..width * height * depth {
                        let place = [at % width, at / width % height, at / width / height + part.layer];
                        for sample in 0..samples {
                            self.put(part, mip, place, sample, words);
                        }
                    }
                }
            }
            Region::Buffer(buffer) => {
                let word = self.word(value.into());
                self.buffer(buffer).fill(word);
            }
        }
    }

    fn forward(&mut self, from: usize, to: usize) {
        let source = self.before.images[from][0].clone();
        let [read, written] = [from, to].map(|image| &self.pipeline.images[image]);
        let (samples, resolves) = (written.samples, read.samples > written.samples);
        let [width, height, _] = written.extent;
        for at in 0..width * height {
            let place = [at % width, at / width, 0];
            for sample in 0..samples {
                let words = if resolves {
                    texels::resolved(read, &source.all_samples(0, place))
                } else {
                    source.texel(0, place, sample).words
                };
                let texel = self.texel(words);
                *self.image(to).texel_mut(0, place, sample) = texel;
            }
        }
    }

    fn compute(&mut self, compute: &Compute) {
        let groups = match compute.groups {
            Groups::Cover => [u32::MAX / WORKGROUP, u32::MAX / WORKGROUP, u32::MAX],
            Groups::Count(groups) => groups,
            Groups::Indirect(buffer, word) => {
                let words = &self.before.buffers[buffer][0];
                [0, 1, 2].map(|axis| words[(word + axis) as usize].bits)
            }
        };
        let invocations = [groups[0].saturating_mul(WORKGROUP), groups[1].saturating_mul(WORKGROUP), groups[2]];
        let [width, height, depth] = [0, 1, 2].map(|axis| compute.grid[axis].min(invocations[axis]));
        let together = compute.stores.iter().find_map(|store| match store.region {
            Region::Buffer(buffer) => Some(self.pipeline.buffers[buffer].contents.group()),
            Region::Image(_) => None,
        });
        let together = together.unwrap_or(1);
        for z in 0..depth {
            for y in 0..height {
                for x in 0..width {
                    let position = [x - x % together, y, z];
                    let state = self.reads(&compute.reads, shade::start(self.pass.number, position), position);
                    let line = (z * compute.grid[1] + y) * compute.grid[0] + x;
                    self.stores(&compute.stores, state, [x, y, z], line);
                }
            }
        }
    }

    /// Writes without attachments of a shader's invocation at a position.
    fn stores(&mut self, stores: &[Store], state: u32, at: [u32; 3], line: u32) {
        for (number, store) in stores.iter().enumerate() {
            let from = 64 + 4 * number as u32;
            match store.region {
                Region::Buffer(buffer) => self.store_word(buffer, store.access, state, from, line),
                Region::Image(part) => self.store_texel(part, store.access, state, from, at),
            }
        }
    }

    fn store_word(&mut self, buffer: usize, access: StoreAccess, state: u32, from: u32, line: u32) {
        let contents = self.pipeline.buffers[buffer].contents;
        let words = &self.after.buffers[buffer][0];
        let count = words.len() as u32;
        let at = if access == StoreAccess::Add { state % count } else { line };
        let Some(old) = words.get(at as usize) else { return };
        let bits = match access {
            StoreAccess::Write => super::hash::content(contents, at, hash(state, from)),
            StoreAccess::Modify => hash(hash(state, from), old.bits),
            StoreAccess::Add => old.bits.wrapping_add(state >> 20),
        };
        let word = self.word(bits);
        self.buffer(buffer)[at as usize] = word;
    }

    fn store_texel(&mut self, part: Part, access: StoreAccess, state: u32, from: u32, at: [u32; 3]) {
        let image = &self.pipeline.images[part.image];
        let (format, size) = (image.format, size(image, part));
        let at = if access == StoreAccess::Add { shade::near(size, state, at) } else { at };
        if (0..3).any(|axis| at[axis] >= size[axis]) {
            return;
        }
        let place = [at[0], at[1], at[2] + part.layer];
        let old = self.after.images[part.image][0].texel(part.mip, place, 0).words;
        let words = match access {
            StoreAccess::Write => shade::values(state, from, format, framewright_graph::frame::Blend::Replace),
            StoreAccess::Modify => {
                let state = shade::absorb(state, format, old);
                shade::values(state, from, format, framewright_graph::frame::Blend::Replace)
            }
            StoreAccess::Add => [old[0].wrapping_add(state >> 20), old[1], old[2], old[3]],
        };
        let texel = self.texel(words);
        *self.image(part.image).texel_mut(part.mip, place, 0) = texel;
    }
}

/// Little-endian integers of this many bytes.
fn integers(bytes: &[u8], each: usize) -> texels::Words {
    let mut words = [0; 4];
    for (word, bytes) in words.iter_mut().zip(bytes.chunks(each)) {
        *word = bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
    }
    words
}
