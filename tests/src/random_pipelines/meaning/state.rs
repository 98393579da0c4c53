//! Contents of images and buffers, with the pass that wrote each texel or word.

use super::super::hash::hash_all;
use super::super::pipeline::{Buffer, Extent, Image, Life, Pipeline};
use super::super::texels::{self, Words};
use framewright_graph::frame::Blend;
use framewright_graph::vulkan::Shape;
use std::sync::Arc;

/// One sample of a texel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Texel {
    /// Its components.
    pub words: Words,
    /// The number of the pass that wrote it last; `None`: it was there before any.
    pub writer: Option<u32>,
}

/// One word of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word {
    /// Its value.
    pub bits: u32,
    /// The number of the pass that wrote it last; `None`: it was there before any.
    pub writer: Option<u32>,
}

/// The contents of an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Filled {
    /// By mip level: extent, layers counting as depth, and texels, sample by sample, row by row.
    levels: Vec<(Extent, Vec<Texel>)>,
    samples: u32,
}

impl Filled {
    fn new(image: &Image, texel: impl Fn(u32) -> Words) -> Filled {
        let level = |mip| {
            let [width, height, depth] = image.extent_of(mip);
            let extent = [width, height, if image.shape == Shape::D3 { depth } else { image.layers }];
            let count = extent.iter().product::<u32>() * image.samples;
            let texels = (0..count).map(|at| Texel { words: texel(at + (mip << 24)), writer: None });
            (extent, texels.collect())
        };
        Filled { levels: (0..image.mips).map(level).collect(), samples: image.samples }
    }

    fn index(&self, mip: u32, [x, y, z]: Extent, sample: u32) -> usize {
        let [width, height, _] = self.levels[mip as usize].0;
        (((z * height + y) * width + x) * self.samples + sample) as usize
    }

    /// A sample of a texel; z is the layer, or the depth of a deep image.
    #[must_use]
    pub fn texel(&self, mip: u32, at: Extent, sample: u32) -> Texel {
        self.levels[mip as usize].1[self.index(mip, at, sample)]
    }

    /// A sample of a texel, to be changed.
    pub fn texel_mut(&mut self, mip: u32, at: Extent, sample: u32) -> &mut Texel {
        let index = self.index(mip, at, sample);
        &mut self.levels[mip as usize].1[index]
    }

    /// All samples of a texel.
    #[must_use]
    pub fn all_samples(&self, mip: u32, at: Extent) -> Vec<Words> {
        (0..self.samples).map(|sample| self.texel(mip, at, sample).words).collect()
    }

    /// Extent of a mip level, layers counting as depth.
    #[must_use]
    pub fn extent(&self, mip: u32) -> Extent {
        self.levels[mip as usize].0
    }
}

/// The contents of all images and buffers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct State {
    /// By image: this frame's contents, then those of the frames before, as far as they can be read.
    pub images: Vec<Vec<Arc<Filled>>>,
    /// By buffer, likewise.
    pub buffers: Vec<Vec<Arc<Vec<Word>>>>,
}

/// The value of parts that are not written yet: valid pipelines never read it.
const JUNK: u32 = 0xDEAD_BEEF;

impl State {
    /// Before the first frame.
    #[must_use]
    pub fn new(pipeline: &Pipeline) -> State {
        let kept = |life| if let Life::History(frames, _) = life { frames as usize + 1 } else { 1 };
        let image = |image: &Image| {
            let words = match image.life {
                Life::Persistent(value) | Life::History(_, value) => texels::plain_texel(image.format, value),
                Life::Transient | Life::Target | Life::Imported => [JUNK; 4],
            };
            let filled = Arc::new(Filled::new(image, |_| words));
            vec![filled; kept(image.life)]
        };
        let buffer = |buffer: &Buffer| {
            let bits = match buffer.life {
                Life::Persistent(value) | Life::History(_, value) => value.into(),
                Life::Transient | Life::Target | Life::Imported => JUNK,
            };
            let words = Arc::new(vec![Word { bits, writer: None }; buffer.words as usize]);
            vec![words; kept(buffer.life)]
        };
        State {
            images: pipeline.images.iter().map(image).collect(),
            buffers: pipeline.buffers.iter().map(buffer).collect(),
        }
    }

    /// The state in which frame number `frame` begins.
    #[must_use]
    pub fn next_frame(&self, pipeline: &Pipeline, frame: u32) -> State {
        let mut next = self.clone();
        for (number, image) in pipeline.images.iter().enumerate() {
            match image.life {
                Life::Imported => next.images[number] = vec![Arc::new(imported_image(image, number, frame))],
                // The oldest is written anew.
                Life::History(..) => next.images[number].rotate_right(1),
                Life::Transient | Life::Target | Life::Persistent(_) => {}
            }
        }
        for (number, buffer) in pipeline.buffers.iter().enumerate() {
            match buffer.life {
                Life::Imported => {
                    let bits = imported_buffer(buffer, number, frame);
                    let words = bits.into_iter().map(|bits| Word { bits, writer: None }).collect();
                    next.buffers[number] = vec![Arc::new(words)];
                }
                Life::History(..) => next.buffers[number].rotate_right(1),
                Life::Transient | Life::Target | Life::Persistent(_) => {}
            }
        }
        next
    }
}

/// The contents that the embedding program hands in for an image.
#[must_use]
pub fn imported_image(image: &Image, number: usize, frame: u32) -> Filled {
    let mask = texels::mask(image.format, Blend::Replace);
    Filled::new(image, |at| {
        let bits = |component| hash_all(0x1111, [number as u32, frame, at, component]);
        texels::words(image.format, [0, 1, 2, 3].map(|component| bits(component) & mask))
    })
}

/// The contents that the embedding program hands in for a buffer of [`super::super::pipeline::Contents::Words`].
#[must_use]
pub fn imported_buffer(buffer: &Buffer, number: usize, frame: u32) -> Vec<u32> {
    (0..buffer.words).map(|at| hash_all(0x2222, [number as u32, frame, at])).collect()
}
