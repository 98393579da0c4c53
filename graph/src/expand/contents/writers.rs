//! Which passes write each image and buffer.

use super::accesses;
use crate::base::Span;
use crate::expand::passes::State;
use crate::expand::resources::Resources;
use crate::frame::Resource;

/// A pass that writes an image or buffer, and where it names it.
#[derive(Clone, Copy)]
pub(super) struct Writer {
    pub(in crate::expand) position: usize,
    pub(in crate::expand) span: Span,
}

/// Writers of each image and buffer, in the order of passes.
pub(super) struct Writers {
    images: usize,
    /// Those that run.
    pub(in crate::expand) on: Vec<Vec<Writer>>,
    /// Those that are off and have no stand-in.
    pub(in crate::expand) off: Vec<Vec<Writer>>,
}

impl Writers {
    pub(in crate::expand) fn find(resources: &Resources<'_>, states: &[State]) -> Writers {
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

    pub(in crate::expand) fn index(&self, of: Resource) -> usize {
        match of {
            Resource::Image(index) => index.0 as usize,
            Resource::Buffer(index) => self.images + index.0 as usize,
        }
    }

    /// The last pass before `position` that writes it.
    pub(in crate::expand) fn last_before(&self, of: Resource, position: usize) -> Option<usize> {
        let all = &self.on[self.index(of)];
        let before = all.partition_point(|writer| writer.position < position);
        before.checked_sub(1).map(|at| all[at].position)
    }
}
