//! Frames of one document, one after the other: what doesn't depend on what changed is kept.

use super::flatten;
use super::inputs::Inputs;
use super::resources::Resources;
use crate::base::{Diagnostic, Sources};
use crate::frame::{Buffer, Frame, Pass, Remark, Resource};
use crate::language::{self, Document, Memory, PartRef, Pipeline, Resolves, View};
use crate::shader::ShaderInterfaces;
use crate::vulkan::Format;
use std::collections::HashMap;
use std::sync::Arc;

/// Makes frames of a document, one after the other. Entries that ask for no value that changed since the last frame are not
/// evaluated again, and passes whose images and buffers are as they were are not checked against their shaders again. So shaders have
/// to stay what they are: begin with a new one where they change. With another document it begins anew by itself.
#[derive(Default)]
pub struct Expander {
    pub(super) entries: Memory,
    pub(super) passes: LoweredPasses,
}

impl Expander {
    /// As [`expand`](super::expand()).
    ///
    /// # Errors
    /// As [`expand`](super::expand()).
    pub fn expand(
        &mut self,
        document: &Document,
        sources: Arc<Sources>,
        inputs: &Inputs<'_>,
        shaders: &mut dyn ShaderInterfaces,
    ) -> Result<Frame, Vec<Diagnostic>> {
        let expanded = flatten::for_eyes(document, sources, inputs, shaders, None, Some(self));
        if expanded.is_err() {
            *self = Expander::default();
        }
        expanded
    }
}

/// The passes of the last frame, as they were before they met each other.
#[derive(Default)]
pub(super) struct LoweredPasses {
    /// By the address of the pass in the pipeline.
    passes: HashMap<usize, LoweredPass>,
    /// Those of the frame before, while one is made.
    before: HashMap<usize, LoweredPass>,
    /// What images and buffers were made of.
    made_of: Option<MadeOf>,
    /// By image, whether it is as it was in the frame before.
    images: Vec<bool>,
    /// By buffer, whether it is.
    buffers: Vec<bool>,
}

/// A pass, and all that was found out about it alone.
struct LoweredPass {
    #[expect(dead_code, reason = "it is held, so that no other pass gets its address")]
    described: Arc<language::Pass>,
    lowered: Pass,
    remarks: Vec<Remark>,
}

/// What the images and buffers of a frame are made of.
struct MadeOf {
    extent: [u32; 2],
    window: Option<Format>,
    views: Vec<View>,
    depth: Option<Resolves>,
    images: Vec<Arc<language::Image>>,
    buffers: Vec<Option<Buffer>>,
}

impl LoweredPasses {
    /// Begins a frame with these images and buffers.
    pub(super) fn begin(&mut self, resources: &Resources<'_>, inputs: &Inputs<'_>) {
        let Pipeline { views, depth, images, .. } = resources.pipeline;
        let (extent, window) = (inputs.output_extent, inputs.window);
        self.before = std::mem::take(&mut self.passes);
        let before = self.made_of.take().filter(|before| {
            before.extent == extent && before.window == window && before.views == *views && before.depth == *depth
        });
        let buffers = &resources.buffers;
        (self.images, self.buffers) = match before {
            None => (vec![false; images.len()], vec![false; buffers.len()]),
            Some(before) => {
                let same = |at: usize| before.buffers.get(at).is_some_and(|known| *known == buffers[at]);
                (unchanged(&before.images, images), (0..buffers.len()).map(same).collect())
            }
        };
        let (views, depth, images, buffers) = (views.clone(), depth.clone(), images.clone(), buffers.clone());
        self.made_of = Some(MadeOf { extent, window, views, depth, images, buffers });
    }

    /// A pass as it was lowered for the frame before, and its remarks, if its images and buffers are as they were.
    pub(super) fn lowered(&mut self, pass: &Arc<language::Pass>) -> Option<(Pass, Vec<Remark>)> {
        let at = Arc::as_ptr(pass).addr();
        let known = self.before.remove(&at)?;
        let unchanged = |(part, _): (PartRef<'_>, language::Use)| match part.resource().resource {
            Resource::Image(index) => self.images.get(index.0 as usize) == Some(&true),
            Resource::Buffer(index) => self.buffers.get(index.0 as usize) == Some(&true),
        };
        if !pass.parts().all(unchanged) {
            return None;
        }
        let found = (known.lowered.clone(), known.remarks.clone());
        self.passes.insert(at, known);
        Some(found)
    }

    /// Keeps a pass for the next frame.
    pub(super) fn keep(&mut self, pass: &Arc<language::Pass>, lowered: &Pass, remarks: &[Remark]) {
        let (lowered, remarks) = (lowered.clone(), remarks.to_vec());
        self.passes.insert(Arc::as_ptr(pass).addr(), LoweredPass { described: Arc::clone(pass), lowered, remarks });
    }

    /// Ends a frame.
    pub(super) fn end(&mut self) {
        self.before.clear();
    }
}

/// By image, whether it is the very one that it was before, as all that it follows are.
fn unchanged(before: &[Arc<language::Image>], images: &[Arc<language::Image>]) -> Vec<bool> {
    let same = |(at, image)| before.get(at).is_some_and(|known| Arc::ptr_eq(known, image));
    let mut unchanged: Vec<bool> = images.iter().enumerate().map(same).collect();
    while unchanged.contains(&false) {
        let follows = |at: usize| images[at].followed().any(|image| !unchanged[image.index.0 as usize]);
        let changed: Vec<usize> = (0..images.len()).filter(|at| unchanged[*at] && follows(*at)).collect();
        if changed.is_empty() {
            break;
        }
        changed.into_iter().for_each(|at| unchanged[at] = false);
    }
    unchanged
}
