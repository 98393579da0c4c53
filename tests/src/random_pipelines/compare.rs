//! Compares the contents of an output with the expected ones.

use super::meaning::{Filled, State};
use super::pipeline::{Extent, Pipeline, Plane, Thing};
use super::texels;
use framewright_graph::vulkan::Format;

/// The first place at which an output holds something else.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The frame, from 0.
    pub frame: u32,
    /// The output.
    pub thing: Thing,
    /// The place in it.
    pub place: String,
    /// The bytes that it should hold.
    pub expected: Vec<u8>,
    /// The bytes that it holds.
    pub found: Vec<u8>,
    /// The number of the pass that should have written them; `None`: they were there before any.
    pub writer: Option<u32>,
}

/// The first place at which `found` isn't what `state` says.
pub(super) fn compare(
    pipeline: &Pipeline,
    state: &State,
    thing: Thing,
    frame: u32,
    found: &[u8],
) -> Option<Difference> {
    let mut at = 0;
    for (place, expected, writer) in places(pipeline, state, thing) {
        let end = at + expected.len();
        let here = found.get(at..end.min(found.len())).unwrap_or(&[]);
        if here != expected {
            return Some(Difference { frame, thing, place: place(), expected, found: here.to_vec(), writer });
        }
        at = end;
    }
    (at != found.len()).then(|| Difference {
        frame,
        thing,
        place: "beyond its end".to_owned(),
        expected: Vec::new(),
        found: found[at..].to_vec(),
        writer: None,
    })
}

/// A place in words, the bytes there, and who wrote them.
type Place<'p> = (Box<dyn Fn() -> String + 'p>, Vec<u8>, Option<u32>);

/// Everything that an output holds, in the order in which it is read.
fn places<'p>(pipeline: &'p Pipeline, state: &'p State, thing: Thing) -> Box<dyn Iterator<Item = Place<'p>> + 'p> {
    match thing {
        Thing::Buffer(buffer) => Box::new(state.buffers[buffer][0].iter().enumerate().map(|(at, word)| {
            let place: Box<dyn Fn() -> String> = Box::new(move || format!("word {at}"));
            (place, word.bits.to_le_bytes().to_vec(), word.writer)
        })),
        Thing::Image(number) => {
            let image = &pipeline.images[number];
            let contents = &state.images[number][0];
            Box::new(levels(image.mips, image.format).flat_map(move |(mip, plane)| {
                texels_of(contents, mip).map(move |at| {
                    let words = texels::resolved(image, &contents.all_samples(mip, at));
                    let (format, words) = texels::seen(image.format, plane, words);
                    let stencil = if plane == Plane::Stencil { "stencil of " } else { "" };
                    let place: Box<dyn Fn() -> String> = Box::new(move || format!("{stencil}mip {mip}, texel {at:?}"));
                    (place, texels::bytes(format, words), contents.texel(mip, at, 0).writer)
                })
            }))
        }
    }
}

/// The positions of a mip level's texels, in the order in which they are read.
pub(super) fn texels_of(contents: &Filled, mip: u32) -> impl Iterator<Item = Extent> + use<> {
    let [width, height, depth] = contents.extent(mip);
    (0..width * height * depth).map(move |line| [line % width, line / width % height, line / width / height])
}

/// The parts that are read and written at once: mip levels and planes of an image.
pub(super) fn levels(mips: u32, format: Format) -> impl Iterator<Item = (u32, Plane)> {
    (0..mips).flat_map(move |mip| texels::planes(format).iter().map(move |plane| (mip, *plane)))
}
