//! Which passes write each image and buffer.

use super::accesses;
use super::resources::Resources;
use super::state::State;
use crate::base::Span;
use crate::frame::Resource;

/// A pass that writes an image or buffer, and where it names it.
#[derive(Clone, Copy)]
pub(super) struct Writer {
    pub(super) position: usize,
    pub(super) span: Span,
}

/// Writers of each image and buffer, in the order of passes.
pub(super) struct Writers {
    images: usize,
    /// Those that run.
    pub(super) on: Vec<Vec<Writer>>,
    /// Those that are off and have no stand-in.
    pub(super) off: Vec<Vec<Writer>>,
}

impl Writers {
    pub(super) fn find(resources: &Resources<'_>, states: &[State]) -> Writers {
        let images = resources.pipeline.images.len();
        let count = images + resources.pipeline.buffers.len();
        let mut writers = Writers { images, on: vec![Vec::new(); count], off: vec![Vec::new(); count] };
        for (position, state) in states.iter().enumerate() {
            let otherwise = &resources.pipeline.passes[position].otherwise;
            let stood_for = |of: Resource| otherwise.iter().any(|one| of == Resource::Image(one.target().index));
            for pass in state.runs() {
                accesses::for_each_use(resources, pass, |used| {
                    if used.writes {
                        let at = writers.index(used.resource);
                        writers.on[at].push(Writer { position, span: used.span });
                    }
                });
            }
            if let State::Off { would, .. } = state {
                for (resource, span) in accesses::would_write(would).filter(|(of, _)| !stood_for(*of)) {
                    let at = writers.index(resource);
                    writers.off[at].push(Writer { position, span });
                }
            }
        }
        writers
    }

    pub(super) fn index(&self, of: Resource) -> usize {
        match of {
            Resource::Image(index) => index.0 as usize,
            Resource::Buffer(index) => self.images + index.0 as usize,
        }
    }

    /// The last pass before `position` that writes it.
    pub(super) fn last_before(&self, of: Resource, position: usize) -> Option<usize> {
        let all = &self.on[self.index(of)];
        let before = all.partition_point(|writer| writer.position < position);
        before.checked_sub(1).map(|at| all[at].position)
    }
}
