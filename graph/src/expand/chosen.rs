//! The pipeline at hand and the size of its frame.

use crate::base::{Diagnostic, Label};
use crate::frame::{ImageIndex, ViewIndex};
use crate::language::{self, Pipeline, USED_HERE};

/// What expansion asks everywhere.
pub(super) struct Chosen<'a> {
    pub(super) pipeline: &'a Pipeline,
    /// Width and height of the frame.
    pub(super) extent: [u32; 2],
}

impl<'a> Chosen<'a> {
    /// Width and height of a view.
    pub(super) fn extent(&self, view: ViewIndex) -> [u32; 2] {
        self.pipeline.views.get(view.0 as usize).map_or(self.extent, |view| view.extent)
    }

    pub(super) fn image(&self, index: ImageIndex) -> &'a language::Image {
        &self.pipeline.images[index.0 as usize]
    }
}

/// Says of mistakes in a fragment where it was used.
pub(super) fn used_here(pipeline: &Pipeline, instance: Option<u32>, errors: &mut [Diagnostic]) {
    let mut next = instance;
    while let Some(instance) = next.and_then(|at| pipeline.instances.get(at as usize)) {
        for error in errors.iter_mut() {
            error.labels.push(Label { span: instance.span, text: format!("{USED_HERE}`{}`", instance.name) });
        }
        next = instance.within;
    }
}
