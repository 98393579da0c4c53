//! The accesses of each pass of a frame, as plain data. Graphs of other systems are built of it.

use framewright_graph::frame::{self, Frame, Image};

/// Images and passes.
pub(crate) struct Accesses {
    pub(crate) images: Vec<Image>,
    pub(crate) passes: Vec<Pass>,
}

/// The accesses of one pass. Images are numbers.
pub(crate) struct Pass {
    /// Images that it samples.
    pub(crate) sampled: Vec<u32>,
    /// Images that it writes as storage, without a look at what is there.
    pub(crate) written: Vec<u32>,
    /// Images that it reads and writes as storage.
    pub(crate) changed: Vec<u32>,
}

/// Which pass waits for which: numbers of passes, the earlier one first. Each pair is there once.
pub(crate) type Edges = Vec<[u32; 2]>;

impl Accesses {
    pub(crate) fn of(frame: &Frame) -> Accesses {
        let pass = |pass: &frame::Pass| {
            let stored = |read: bool| {
                let stored = pass.storage.iter().filter(move |storage| storage.read == read);
                stored.map(|storage| storage.image.0).collect()
            };
            let sampled = pass.sampled.iter().map(|sampled| sampled.image.0).collect();
            Pass { sampled, written: stored(false), changed: stored(true) }
        };
        Accesses { images: frame.images.clone(), passes: frame.passes.iter().map(pass).collect() }
    }

    /// A pass waits for whatever wrote what it accesses, and for whatever read what it writes.
    pub(crate) fn edges(&self) -> Edges {
        let mut edges = Edges::new();
        let mut last_writer: Vec<Option<u32>> = vec![None; self.images.len()];
        let mut readers_since: Vec<Vec<u32>> = vec![Vec::new(); self.images.len()];
        for (number, pass) in (0_u32..).zip(&self.passes) {
            let first = edges.len();
            for image in &pass.sampled {
                edges.extend(last_writer[*image as usize].map(|writer| [writer, number]));
            }
            for image in pass.written.iter().chain(&pass.changed) {
                let writer = last_writer[*image as usize].replace(number);
                let readers = readers_since[*image as usize].drain(..);
                edges.extend(writer.into_iter().chain(readers).map(|before| [before, number]));
            }
            pass.sampled.iter().for_each(|image| readers_since[*image as usize].push(number));
            edges[first..].sort_unstable();
        }
        edges.dedup();
        edges
    }
}
