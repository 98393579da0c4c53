//! Windows: the graphics steps that can run beside each step that may leave the graphics queue.

use super::step_uses::uses_of;
use crate::compile::access_chain::AccessChain;
use crate::compile::model::{AdaptedFrame, Use};
use crate::compile::scope::Step;
use crate::plan::Queue;
use crate::vulkan::Sharing;

/// The reaches of a subresource in a walk in one direction. A reach is one more than the rank of the last graphics step that
/// a use depends on.
#[derive(Debug, Clone, Copy)]
struct Reach {
    /// The reach of its uses so far.
    uses: AccessChain<u32>,
    /// The reach of all uses on graphics.
    graphics: u32,
}

/// Steps in the order of submission with the queue that each is to run on.
#[derive(Clone, Copy)]
pub(super) struct Steps<'a> {
    pub(super) adapted: &'a AdaptedFrame,
    pub(super) steps: &'a [Step],
    pub(super) queues: &'a [Queue],
    /// How transient images are shared.
    pub(super) sharing: Sharing,
}

impl Steps<'_> {
    /// For each step its window `[from, to)`: it depends on no graphics step in it, and none of them depends on it.
    pub(super) fn beside(&self) -> Vec<[u32; 2]> {
        let count = self.steps.len() as u32;
        let before = self.walk(0..count, |step| step + 1);
        let behind = self.walk((0..count).rev(), |step| count - step);
        before.into_iter().zip(behind).map(|(before, behind)| [before, count - behind]).collect()
    }

    /// For each step its reach, in one direction.
    fn walk(&self, order: impl Iterator<Item = u32>, rank: impl Fn(u32) -> u32) -> Vec<u32> {
        let none = Reach { uses: AccessChain::new(), graphics: 0 };
        let mut subresources = vec![none; self.adapted.subresources as usize];
        let mut behind = vec![0; self.steps.len()];
        for step in order {
            let on_graphics = self.queues[step as usize] == Queue::Graphics;
            let mut most = 0;
            if !on_graphics {
                self.for_each_use(step, |used| {
                    let exclusive = self.is_exclusive_image(used);
                    self.adapted.for_each_subresource(used, |subresource| {
                        let subresource = &subresources[subresource as usize];
                        most = most.max(subresource.uses.highest_behind(used.writes, used.layout));
                        most = if exclusive { most.max(subresource.graphics) } else { most };
                    });
                });
            }
            behind[step as usize] = most;
            let reach = if on_graphics { rank(step) } else { most };
            self.for_each_use(step, |used| {
                self.adapted.for_each_subresource(used, |subresource| {
                    let subresource = &mut subresources[subresource as usize];
                    subresource.uses.add_number(used.writes, used.layout, reach);
                    if on_graphics {
                        subresource.graphics = subresource.graphics.max(reach);
                    }
                });
            });
        }
        behind
    }

    fn is_exclusive_image(&self, used: &Use) -> bool {
        let resource = &self.adapted.resources[used.resource as usize];
        self.sharing == Sharing::Exclusive && resource.is_transient() && resource.image().is_some()
    }

    fn for_each_use(&self, step: u32, visit: impl FnMut(&Use)) {
        uses_of(self.adapted, &self.steps[step as usize]).for_each(visit);
    }
}
