//! Last accesses: until when each image of the frame is used.

use crate::compile::cull::LivePasses;
use crate::frame::{Access, Frame, ImageIndex};

/// For each image of the frame the last pass that stays and accesses it, and the last that writes it.
#[derive(Debug, Default)]
pub(super) struct LastAccesses {
    pub(super) access: Vec<Option<u32>>,
    pub(super) write: Vec<Option<u32>>,
}

impl LastAccesses {
    pub(super) fn of(frame: &Frame, live: &LivePasses) -> LastAccesses {
        let mut last = LastAccesses { access: vec![None; frame.images.len()], write: vec![None; frame.images.len()] };
        for number in &live.passes {
            let pass = &frame.passes[*number as usize];
            pass.visit_accesses(&mut |access: Access<'_>| {
                let Some(ImageIndex(image)) = access.image_index() else { return };
                last.access[image as usize] = Some(*number);
                if access.writes(pass, Some(&frame.images[image as usize])) {
                    last.write[image as usize] = Some(*number);
                }
            });
        }
        last
    }
}
