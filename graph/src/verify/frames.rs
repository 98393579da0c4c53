//! What crosses frames: the state in which they find images and buffers and leave them, and what becomes what.
//!
//! Something external is found in its stated state each time, whatever the frame before left. Something persistent is
//! found in its stated state by the first frame; by later ones in that in which the frame before really left it, which
//! must be the one that is stated too. After the last step of a frame whoever relies on the stated state puts a barrier
//! behind it that names it as its source; where it names no stages, a semaphore, which waits for everything. Of the reads
//! that it names, at least one can be made at once.

use super::Findings;
use super::cells::{Cell, Contents, Owner, Write};
use super::dependencies::{before_access, before_layout_change};
use super::scopes::{PairSet, StageSet, stage_of};
use super::violation::Touched;
use super::walk::Walk;
use crate::plan::{Buffer, Image, Plan, Resource, Role, StepId};
use crate::vulkan::{Layout, State};

/// How many frames are walked, and what becomes what between them.
#[derive(Debug)]
pub(super) struct Frames {
    pub(super) count: u32,
    /// Images and buffers of which each becomes the next, and the last one the first.
    circles: Vec<Vec<u32>>,
}

/// Most images or buffers that become each other: history is followed as deep as that, less one.
const LONGEST_CIRCLE: usize = 33;

/// Finds out what becomes what; `None` after a report if it is no permutation of what is alike.
pub(super) fn circles(plan: &Plan, found: &mut Findings) -> Option<Frames> {
    let before = found.violations.len();
    let mut circles = Vec::new();
    let images: Vec<&Role> = plan.images.iter().map(|image| &image.role).collect();
    let buffers: Vec<&Role> = plan.buffers.iter().map(|buffer| &buffer.role).collect();
    for (roles, offset) in [(&images, 0), (&buffers, images.len() as u32)] {
        let next = |index: u32| match roles[index as usize] {
            Role::Persistent { becomes, .. } => Some(*becomes),
            _ => None,
        };
        let mut reached = vec![false; roles.len()];
        for index in 0..roles.len() as u32 {
            let Some(becomes) = next(index) else { continue };
            if std::mem::replace(&mut reached[becomes as usize], true) {
                found.structure(None, Some(offset + becomes), "is what two others become in the next frame");
            }
            if next(becomes).is_none() {
                let what = "is what something persistent becomes in the next frame, and not persistent itself";
                found.structure(None, Some(offset + becomes), what);
            }
        }
        if found.violations.len() > before {
            continue;
        }
        let mut placed = vec![false; roles.len()];
        for index in 0..roles.len() as u32 {
            let mut circle = Vec::new();
            let mut at = Some(index);
            while let Some(member) = at.filter(|member| !placed[*member as usize] && next(*member).is_some()) {
                placed[member as usize] = true;
                circle.push(offset + member);
                at = next(member);
            }
            if circle.len() > LONGEST_CIRCLE {
                let what = format!("is one of {} that become each other, at most {LONGEST_CIRCLE} can", circle.len());
                found.structure(None, Some(offset + index), what);
            }
            if circle.len() > 1 {
                circles.push(circle);
            }
        }
    }
    check_alike(plan, found);
    let longest = circles.iter().map(Vec::len).max().unwrap_or(1);
    (found.violations.len() == before).then_some(Frames { count: longest as u32 + 1, circles })
}

/// What becomes something else must be like it, and leave the frame as that one is found by the next.
fn check_alike(plan: &Plan, found: &mut Findings) {
    for (image, index) in plan.images.iter().zip(0..) {
        if let Role::Persistent { becomes, .. } = image.role {
            let other = &plan.images[becomes as usize];
            let of = |image: &Image| {
                let extent = (
                    image.format,
                    image.shape,
                    (image.extent, image.room, image.rotation),
                    image.mips,
                    image.layers,
                    image.samples,
                );
                (extent, image.usage, image.sharing)
            };
            check_pair(found, index, of(image) == of(other), [&image.role, &other.role]);
        }
    }
    for (buffer, index) in plan.buffers.iter().zip(plan.images.len() as u32..) {
        if let Role::Persistent { becomes, .. } = buffer.role {
            let other = &plan.buffers[becomes as usize];
            let of = |buffer: &Buffer| (buffer.bytes, buffer.usage, buffer.sharing);
            check_pair(found, index, of(buffer) == of(other), [&buffer.role, &other.role]);
        }
    }
}

fn check_pair(found: &mut Findings, index: u32, alike: bool, roles: [&Role; 2]) {
    if let [Role::Persistent { initial: one, after, .. }, Role::Persistent { initial: other, before, .. }] = roles {
        if !alike || one != other {
            found.structure(None, Some(index), "becomes something of another kind in the next frame");
        }
        if after != before {
            found.structure(None, Some(index), "is left in another state than the next frame finds what it becomes in");
        }
    }
}

impl<const Q: usize> Walk<'_, '_, Q> {
    pub(super) fn begin_frame(&mut self) {
        self.begin_signals();
        let time = self.frame_start();
        for resource in 0..self.program.used.len() as u32 {
            let (before, persistent) = match super::role(self.plan, resource) {
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
                let cell = &mut self.cells[index];
                *cell = Cell::FRESH;
                cell.layout = before.layout;
                cell.contents = if unknown { Contents::Unwritten } else { Contents::Defined };
                // What is handed in was used on the queue that uses it first. What persists was prepared, and who did so
                // waited until that was done.
                if !persistent {
                    cell.write = Write::before_frame(queue, pairs, time);
                    cell.reads.insert(queue, stages, time);
                }
            }
        }
    }

    /// Whoever relies on the stated state finds it so.
    pub(super) fn end_frame(&mut self) {
        let last = StepId(self.program.steps() - 1);
        for resource in 0..self.program.used.len() as u32 {
            let (after, persistent) = match super::role(self.plan, resource) {
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
                if persistent || matches!(self.cells[index].contents, Contents::Lost(..) | Contents::InPart(_)) {
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
        let cell = &self.cells[index];
        if cell.excused || matches!(cell.owner, Owner::Released(_)) || after.stages.is_empty() {
            return;
        }
        let (stages, pairs) = scopes(after);
        let before = self.clocks.after_all_queues(stages.and_earlier(), self.now(last) + 1);
        // Parts may have been read last in different stages, of which the state lists all.
        let mut reads = if pairs.writes().is_empty() { pairs } else { PairSet::default() }.iter();
        let queue = self.program.used[resource as usize].last_queue;
        let read = |pair| before_access(cell, &self.clocks, queue, StageSet(1 << stage_of(pair)), PairSet::only(pair));
        let unread = || {
            let first = read(reads.next()?)?;
            reads.all(|pair| read(pair).is_some()).then_some(first)
        };
        if let Some(mut gap) = before_layout_change(cell, &before, pairs).or_else(unread) {
            gap.later = Touched::AfterFrame;
            self.cells[index].excused = true;
            self.report(last, resource, index, gap.rule(), gap.time);
        }
    }

    /// At the end of a frame everything becomes what it is in the next one.
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
            self.cells.swap(one, other);
        }
    }
}

fn scopes(state: &State) -> (StageSet, PairSet) {
    (StageSet::of(state.stages), PairSet::of(state.stages, state.accesses))
}
