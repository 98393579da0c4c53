//! The flat lists of images, buffers and passes that become a pipeline.

use crate::language::model::{Buffer, Image, Instance, Pass};
use crate::language::scope::Properties;
use std::sync::Arc;

/// Images, buffers, passes and instances that were evaluated so far; `None` where a mistake was reported. Those that the file
/// says as they are belong to the document, too.
#[derive(Default)]
pub(super) struct FlatLists {
    pub(super) images: Vec<Option<Arc<Image>>>,
    /// Properties of images.
    pub(super) properties: Vec<Option<Properties>>,
    pub(super) buffers: Vec<Option<Buffer>>,
    pub(super) passes: Vec<Option<Arc<Pass>>>,
    pub(super) instances: Vec<Instance>,
}

/// The lengths of the lists of images, buffers, passes and instances.
#[derive(Clone, Copy)]
pub(super) struct Lengths {
    images: usize,
    buffers: usize,
    pub(super) passes: usize,
    instances: usize,
}

impl FlatLists {
    /// Lists of images and buffers of which only the number is known.
    pub(super) fn nothing_known(images: u32, buffers: u32) -> Self {
        let mut flat = FlatLists::default();
        flat.images.resize_with(images as usize, || None);
        flat.properties.resize_with(images as usize, || None);
        flat.buffers.resize_with(buffers as usize, || None);
        flat
    }

    pub(super) const fn lengths(&self) -> Lengths {
        let FlatLists { images, buffers, passes, instances, .. } = self;
        Lengths { images: images.len(), buffers: buffers.len(), passes: passes.len(), instances: instances.len() }
    }

    /// Removes all entries since the lists had these lengths.
    pub(super) fn truncate(&mut self, to: Lengths) {
        self.images.truncate(to.images);
        self.properties.truncate(to.images);
        self.buffers.truncate(to.buffers);
        self.passes.truncate(to.passes);
        self.instances.truncate(to.instances);
    }

    /// Notes that a mistake was reported which has no place in the lists: there is no pipeline then.
    pub(super) fn fail(&mut self) {
        self.passes.push(None);
    }
}
