//! `cull`: only what reaches an output stays.

use super::link::Linked;
use crate::frame::{Frame, Resource};

/// What stays.
#[derive(Debug)]
pub(super) struct Live {
    /// Indices of the passes that stay, in frame order.
    pub(super) passes: Vec<u32>,
    /// Indices of the passes that go.
    pub(super) culled: Vec<u32>,
    /// For each image the last pass that stays and touches it.
    pub(super) last_access: Vec<Option<u32>>,
    /// For each image the last pass that stays and writes it.
    pub(super) last_write: Vec<Option<u32>>,
}

pub(super) fn cull(frame: &Frame, linked: &Linked) -> Live {
    let mut needed = vec![false; linked.versions as usize];
    for output in &frame.outputs {
        let Resource::Image(image) = output.resource else { continue };
        if let Some(version) = linked.last[image.0 as usize] {
            needed[version as usize] = true;
        }
    }
    let (mut passes, mut culled) = (Vec::with_capacity(frame.passes.len()), Vec::new());
    let mut last_access = vec![None; frame.images.len()];
    let mut last_write = vec![None; frame.images.len()];
    for pass in (0..frame.passes.len()).rev() {
        let uses = linked.uses(pass);
        let number = pass as u32;
        if !uses.iter().any(|used| used.writes.is_some_and(|version| needed[version as usize])) {
            culled.push(number);
            continue;
        }
        passes.push(number);
        for used in uses {
            let image = used.image.0 as usize;
            last_access[image].get_or_insert(number);
            if used.writes.is_some() {
                last_write[image].get_or_insert(number);
            }
            if let Some(version) = used.reads {
                needed[version as usize] = true;
            }
        }
    }
    passes.reverse();
    culled.reverse();
    Live { passes, culled, last_access, last_write }
}
