//! What each pass of a frame accesses, as plain data. Graphs of other systems are built of it.

use framewright_graph::frame::{Frame, Image};

/// Images, passes, and which pass must wait for which.
pub(crate) struct Accesses {
    pub(crate) images: Vec<Image>,
    pub(crate) passes: Vec<Pass>,
}

/// One pass. Images and passes are numbers.
#[derive(Default)]
pub(crate) struct Pass {
    /// Images that it samples.
    pub(crate) sampled: Vec<usize>,
    /// Images that it writes as storage, without a look at what is there.
    pub(crate) written: Vec<usize>,
    /// Images that it reads and writes as storage.
    pub(crate) changed: Vec<usize>,
    /// Earlier passes that must be over, each once: whatever wrote what this pass accesses, and whatever read what it writes.
    pub(crate) after: Vec<usize>,
}

impl Accesses {
    pub(crate) fn of(frame: &Frame) -> Accesses {
        let mut passes: Vec<Pass> = Vec::new();
        let mut last_writer: Vec<Option<usize>> = vec![None; frame.images.len()];
        let mut readers_since: Vec<Vec<usize>> = vec![Vec::new(); frame.images.len()];
        for pass in &frame.passes {
            let number = passes.len();
            let sampled: Vec<usize> = pass.sampled.iter().map(|sampled| sampled.image.0 as usize).collect();
            let stored = |read: bool| {
                let stored = pass.storage.iter().filter(move |storage| storage.read == read);
                stored.map(|storage| storage.image.0 as usize).collect::<Vec<_>>()
            };
            let (written, changed) = (stored(false), stored(true));
            let mut after: Vec<usize> = sampled.iter().filter_map(|image| last_writer[*image]).collect();
            for image in written.iter().chain(&changed) {
                after.extend(last_writer[*image]);
                after.append(&mut readers_since[*image]);
                last_writer[*image] = Some(number);
            }
            sampled.iter().for_each(|image| readers_since[*image].push(number));
            after.sort_unstable();
            after.dedup();
            passes.push(Pass { sampled, written, changed, after });
        }
        Accesses { images: frame.images.clone(), passes }
    }
}
