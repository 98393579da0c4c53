//! Whether each transient image has its bytes to itself while it lives, and takes them over properly.
//!
//! **The rule of a hand-over.** An image takes its bytes with its first barrier from `UNDEFINED` and keeps them until
//! another one takes some of them. When B takes bytes of A, in the same frame or with A's use in the frame before:
//! 1. no access of A in this frame may come before *and* another one after that: their uses don't interleave;
//! 2. B's first barrier on each part of itself must be execution-ordered after every last access of A;
//! 3. A's last write must be available by then: by an image barrier on A, by a memory barrier in the batch of B's
//!    barrier or earlier, or because B's barrier names that write's stage and access in its own source scopes. (An
//!    image barrier's memory scope is its own image; sharing the bytes, B is taken to speak for A.)

use super::clocks::Clock;
use super::dependencies::{Missing, before_layout_change};
use super::scopes::PairSet;
use super::violation::{Rule, StepName};
use super::walk::Walk;
use super::{Finding, cells::Contents, cells::Lost};
use crate::plan::{ImageId, Placement, Plan, Role, StepId, Subresources};
use std::collections::BTreeMap;

/// Who has which bytes.
#[derive(Debug)]
pub(super) struct Memory {
    /// For each heap: start of a piece → its end and the image that took it last.
    owners: Vec<BTreeMap<u64, (u64, ImageId)>>,
    /// For each image: how often it took its bytes.
    occupations: Vec<u32>,
    /// For each image: whether it still has all of them.
    held: Vec<bool>,
    /// For each image: from whom it took them last.
    predecessors: Vec<Vec<ImageId>>,
}

impl Memory {
    pub(super) fn new(plan: &Plan) -> Memory {
        Memory {
            owners: vec![BTreeMap::new(); plan.heaps.len()],
            occupations: vec![0; plan.images.len()],
            held: vec![false; plan.images.len()],
            predecessors: vec![Vec::new(); plan.images.len()],
        }
    }

    /// Which occupation an image's parts belong to now.
    pub(super) fn occupation(&self, image: ImageId) -> u32 {
        self.occupations[image.0 as usize]
    }

    /// Gives the bytes of `placement` to `image`; who had them before.
    fn take(&mut self, image: ImageId, placement: &Placement) -> Vec<ImageId> {
        let owners = &mut self.owners[placement.heap as usize];
        let (start, end) = (placement.offset, placement.offset + placement.bytes);
        let first = owners.range(..=start).next_back().map_or(start, |(first, _)| *first);
        let pieces: Vec<_> = owners
            .range(first..end)
            .map(|(from, (to, owner))| (*from, *to, *owner))
            .filter(|(_, to, _)| *to > start)
            .collect();
        let mut before = Vec::new();
        for (from, to, owner) in pieces {
            owners.remove(&from);
            if from < start {
                owners.insert(from, (start, owner));
            }
            if to > end {
                owners.insert(end, (to, owner));
            }
            if owner != image && !before.contains(&owner) {
                before.push(owner);
            }
        }
        owners.insert(start, (end, image));
        before
    }
}

impl Walk<'_, '_> {
    /// `image` takes its bytes, unless it has them, with a barrier on `range`.
    pub(super) fn occupy(&mut self, step: StepId, image: ImageId, range: Subresources) {
        let Role::Transient(placement) = &self.plan.image(image).role else { return };
        if std::mem::replace(&mut self.memory.held[image.0 as usize], true) {
            return;
        }
        self.memory.occupations[image.0 as usize] += 1;
        let mut before = self.memory.take(image, placement);
        before.retain(|owner| {
            if let Some(last) = self.needs_until(*owner, step) {
                let with = self.plan.image(*owner).name.clone();
                self.found.push(Finding {
                    rule: Rule::Overlap { with },
                    step,
                    other: Some(StepName::new(self.plan, last, false)),
                    image,
                    range: Some(range),
                    bytes: self.shared_bytes(image, *owner),
                });
                return false;
            }
            true
        });
        for owner in &before {
            self.memory.held[owner.0 as usize] = false;
            let now = self.now(step);
            let frame_start = self.frame_start();
            for index in self.cells.all(*owner) {
                let cell = self.cells.at(index);
                cell.layout = crate::vocabulary::Layout::Undefined;
                cell.contents = match cell.contents {
                    Contents::Defined if cell.filled > frame_start => Contents::Lost(Lost::Taken(image), now),
                    Contents::Defined => Contents::Unwritten,
                    lost => lost,
                };
            }
        }
        self.memory.predecessors[image.0 as usize] = before;
    }

    /// The last step that touches `image` in a frame, if `step` lies between its first and its last.
    fn needs_until(&self, image: ImageId, step: StepId) -> Option<StepId> {
        let [first, last] = self.touched[image.0 as usize]?;
        (first..=last).contains(&step.0).then_some(StepId(last))
    }

    /// Rules 2 and 3 for one part of `image`, whose barrier comes after `before`; `source`: the writes that the barrier
    /// and the memory barriers beside it make available.
    pub(super) fn check_hand_over(
        &mut self,
        step: StepId,
        image: ImageId,
        cell: usize,
        before: &Clock,
        source: PairSet,
    ) {
        for at in 0..self.memory.predecessors[image.0 as usize].len() {
            let from = self.memory.predecessors[image.0 as usize][at];
            let gap = self.cells.all(from).find_map(|index| before_layout_change(self.cells.at(index), before, source));
            if let Some(gap) = gap {
                let name = self.plan.image(from).name.clone();
                let waited = gap.missing == Missing::Availability;
                self.found.push(Finding {
                    rule: Rule::HandOver { from: name, earlier: gap.earlier, waited },
                    step,
                    other: self.name_at(gap.time, from),
                    image,
                    range: Some(self.cells.range(self.plan.image(image), cell)),
                    bytes: self.shared_bytes(image, from),
                });
            }
        }
    }

    fn shared_bytes(&self, one: ImageId, other: ImageId) -> Option<[u64; 2]> {
        match (&self.plan.image(one).role, &self.plan.image(other).role) {
            (Role::Transient(one), Role::Transient(other)) => {
                let end = (one.offset + one.bytes).min(other.offset + other.bytes);
                Some([one.offset.max(other.offset), end])
            }
            _ => None,
        }
    }
}
