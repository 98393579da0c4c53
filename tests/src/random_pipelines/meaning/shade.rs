//! One invocation of a shader: its reads, and its results.

use super::Evaluator;
use crate::random_pipelines::hash::{hash, hash_all, hashes};
use crate::random_pipelines::pipeline::{Extent, Part, Read, SAMPLES};
use crate::random_pipelines::texels::{self, Words};
use crate::random_pipelines::valid::size;
use framewright_graph::frame::Blend;
use framewright_graph::vulkan::Format;

/// The hash at a position before anything is read.
pub(super) fn start(pass: u32, at: Extent) -> u32 {
    hash_all(pass, at)
}

/// A position near `at` inside an image of this size.
pub(super) fn near(size: Extent, state: u32, at: Extent) -> Extent {
    let away = [state & 3, (state >> 2) & 3, (state >> 4) & 3];
    std::array::from_fn(|axis| (at[axis] + away[axis]) % size[axis])
}

/// A texel's components in the hash.
pub(super) fn absorb(state: u32, format: Format, words: Words) -> u32 {
    let parts = texels::parts(format) as usize;
    hash_all(state, words.into_iter().take(parts).map(|word| texels::hashed(format, word)))
}

/// The components that a shader writes.
pub(super) fn values(state: u32, from: u32, format: Format, blend: Blend) -> Words {
    hashes(state, from).map(|bits| texels::word(format, bits & texels::mask(format, blend)))
}

impl Evaluator<'_> {
    /// The hash once an invocation at `at` has read all that it reads.
    pub(super) fn reads(&self, reads: &[Read], state: u32, at: Extent) -> u32 {
        reads.iter().fold(state, |state, read| self.read(*read, state, at))
    }

    fn read(&self, read: Read, state: u32, at: Extent) -> u32 {
        match read {
            Read::Uniform(buffer, frames_ago) => {
                hash(state, self.before.buffers[buffer][frames_ago as usize][(state & 15) as usize].bits)
            }
            Read::Block(buffer, frames_ago) => {
                let words = &self.before.buffers[buffer][frames_ago as usize];
                hash(state, words[(state % words.len() as u32) as usize].bits)
            }
            Read::Own(part) => {
                let image = &self.pipeline.images[part.image];
                let place = [at[0], at[1], part.layer];
                let samples = self.before.images[part.image][0].all_samples(part.mip, place);
                let (format, words) = texels::seen(image.format, part.plane, texels::resolved(image, &samples));
                absorb(state, format, words)
            }
            Read::Storage(part) => self.texel_near(part, 0, false, state, at),
            Read::Sampled { part, frames_ago, per_sample } => {
                let mip = part.mip + (at[0] / 2 + at[1] / 2 + at[2]) % part.mips;
                self.texel_near(Part { mip, mips: 1, ..part }, frames_ago, per_sample, state, at)
            }
        }
    }

    /// The hash with a texel of one mip level near `at`, or with all its samples, each near a place of its own.
    fn texel_near(&self, part: Part, frames_ago: u32, per_sample: bool, state: u32, at: Extent) -> u32 {
        let image = &self.pipeline.images[part.image];
        let contents = &self.before.images[part.image][frames_ago as usize];
        let place = |state| {
            let [x, y, z] = near(size(image, part), state, at);
            [x, y, z + part.layer]
        };
        if per_sample {
            return (0..SAMPLES).fold(state, |state, sample| {
                let words = contents.texel(part.mip, place(state), sample).words;
                let (format, words) = texels::seen(image.format, part.plane, words);
                absorb(state, format, words)
            });
        }
        let words = texels::resolved(image, &contents.all_samples(part.mip, place(state)));
        let (format, words) = texels::seen(image.format, part.plane, words);
        absorb(state, format, words)
    }
}
