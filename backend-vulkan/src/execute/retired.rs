//! What the program imported before, for frames on their way that use it: no later frame does.

use super::frames::Frames;
use crate::prepare::Replaced;
use framewright_graph::plan::Resource;
use std::any::Any;
use std::sync::Arc;

/// Images and buffers that others took the place of, with all that was made for them.
#[derive(Default)]
pub(super) struct Retired(Vec<RetiredImport>);

/// What stood for an external image or buffer in frames before. Fields are dropped in this order.
struct RetiredImport {
    resource: Resource,
    /// The first frame that doesn't use it.
    until: u64,
    _replaced: Replaced,
    /// What the images belong to.
    _owners: Vec<Arc<dyn Any + Send + Sync>>,
}

impl Retired {
    /// Keeps what was replaced until the frames that were submitted are done.
    pub(super) fn keep(
        &mut self,
        frames: &Frames,
        resource: Resource,
        replaced: Replaced,
        owners: Vec<Arc<dyn Any + Send + Sync>>,
    ) {
        let until = frames.next();
        // What was imported since the last frame was used by none.
        if !self.0.iter().any(|it| it.resource == resource && it.until == until) {
            self.0.push(RetiredImport { resource, until, _replaced: replaced, _owners: owners });
        }
        self.let_go(frames);
    }

    /// Lets go of what no frame on its way uses. Nothing is waited for.
    pub(super) fn let_go(&mut self, frames: &Frames) {
        self.0.retain(|it| !frames.are_done_before(it.until));
    }
}
