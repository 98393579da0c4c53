//! The boundary of frames: the state in which a frame finds images and buffers, and in which it leaves them.
//!
//! An external image or buffer is found in its stated state each time, however the frame before left it. A persistent one is
//! found in its stated state by the first frame. Later frames find it in the state in which the frame before really left it,
//! which must be the stated one too. After the last step of a frame, a user that relies on the stated state puts a barrier
//! behind it that names this state as its source. If the state names no stages, the user takes a semaphore, which waits for
//! everything. At least one of the reads that the state names can be made at once.

use super::dependencies::{before_access, before_layout_change};
use super::findings::role;
use super::frames::Frames;
use super::scopes::{PairSet, StageSet, stage_of};
use super::subresources::{Contents, Owner, SubresourceState, Write};
use super::violation::Accessed;
use super::walk::Walk;
use crate::plan::{Resource, Role, StepId};
use crate::vulkan::{Layout, State};

impl<const Q: usize> Walk<'_, '_, Q> {
    pub(super) fn begin_frame(&mut self) {
        self.begin_signals();
        let time = self.frame_start();
        for resource in 0..self.program.used.len() as u32 {
            let (before, persistent) = match role(self.plan, resource) {
                Role::External { before, .. } => (before, false),
                Role::Persistent { before, .. } if self.frame == 0 => (before, true),
                _ => continue,
            };
            let (stages, pairs) = scopes(before);
            let is_image = (resource as usize) < self.plan.images.len();
            let unknown = is_image && !persistent && before.layout == Layout::Undefined;
            let queue = self.program.used[resource as usize].queue;
            let mut part = self.parts.whole(resource);
            while let Some(index) = self.parts.next(&mut part) {
                let state = &mut self.subresources[index];
                *state = SubresourceState::FRESH;
                state.layout = before.layout;
                state.contents = if unknown { Contents::Unwritten } else { Contents::Defined };
                // An external image or buffer was last used on the queue that uses it first. A persistent one was prepared,
                // and its preparation was waited for.
                if !persistent {
                    state.write = Write::before_frame(queue, pairs, time);
                    state.reads.insert(queue, stages, time);
                }
            }
        }
    }

    /// The next user of an image or buffer finds it in its stated state.
    pub(super) fn end_frame(&mut self) {
        let last = StepId(self.program.steps() - 1);
        for resource in 0..self.program.used.len() as u32 {
            let (after, persistent) = match role(self.plan, resource) {
                Role::External { after, .. } => (*after, false),
                Role::Persistent { after, .. } => (*after, true),
                Role::Transient(_) => continue,
            };
            let mut part = self.parts.whole(resource);
            while let Some(index) = self.parts.next(&mut part) {
                if !persistent {
                    self.check_acquired(last, resource, index);
                }
                self.check_layout(last, resource, index, after.layout);
                self.check_state(last, resource, index, &after);
                if persistent || matches!(self.subresources[index].contents, Contents::Lost(..) | Contents::InPart(_)) {
                    self.read(last, resource, index);
                }
            }
        }
        for output in &self.plan.outputs {
            let resource = match output.resource {
                Resource::Image(image) => image.0,
                Resource::Buffer(buffer) => self.plan.images.len() as u32 + buffer.0,
            };
            let mut part = self.parts.whole(resource);
            while let Some(index) = self.parts.next(&mut part) {
                self.read(last, resource, index);
            }
        }
    }

    /// Whether a barrier that names the stated state as its source waits for everything, and makes it available.
    fn check_state(&mut self, last: StepId, resource: u32, index: usize, after: &State) {
        let state = &self.subresources[index];
        if state.excused || matches!(state.owner, Owner::Released(_)) || after.stages.is_empty() {
            return;
        }
        let (stages, pairs) = scopes(after);
        let before = self.clocks.after_all_queues(stages.and_earlier(), self.now(last) + 1);
        // Parts may have been read last in different stages, of which the state lists all.
        let mut reads = if pairs.writes().is_empty() { pairs } else { PairSet::default() }.iter();
        let queue = self.program.used[resource as usize].last_queue;
        let read = |pair| before_access(state, &self.clocks, queue, StageSet(1 << stage_of(pair)), PairSet::only(pair));
        let unread = || {
            let first = read(reads.next()?)?;
            reads.all(|pair| read(pair).is_some()).then_some(first)
        };
        if let Some(mut gap) = before_layout_change(state, &before, pairs).or_else(unread) {
            gap.later = Accessed::AfterFrame;
            self.subresources[index].excused = true;
            self.report(last, resource, index, gap.rule(), gap.time);
        }
    }

    /// At the end of a frame each image and buffer becomes the one that it is in the next frame.
    pub(super) fn become_next(&mut self, frames: &Frames) {
        for circle in &frames.circles {
            for pair in circle.windows(2).rev() {
                self.exchange(pair[0], pair[1]);
            }
        }
    }

    fn exchange(&mut self, one: u32, other: u32) {
        let (mut one, mut other) = (self.parts.whole(one), self.parts.whole(other));
        while let (Some(one), Some(other)) = (self.parts.next(&mut one), self.parts.next(&mut other)) {
            self.subresources.swap(one, other);
        }
    }
}

fn scopes(state: &State) -> (StageSet, PairSet) {
    (StageSet::of(state.stages), PairSet::of(state.stages, state.accesses))
}
