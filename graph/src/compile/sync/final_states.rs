//! Final states: the states in which resources that outlive the frame are found and left.
//!
//! A frame leaves a persistent image in the state in which the next one finds it. Every image has one layout at the end, so
//! subresources in other layouts than the last one are brought into that one. A state that names only reads allows all of
//! these at once, so the barriers before the last reads of each subresource serve them all.

use super::subresource::SubresourceState;
use super::timeline::{AccessTimeline, States};
use crate::compile::history_ring::last_of_ring;
use crate::compile::model::{AdaptedFrame, MemorySource, PhysicalIndex, PhysicalResource};
use crate::compile::steps::NEVER;
use crate::vulkan::{Accesses, Layout, Stages, State};
use std::ops::Range;

/// The states around the frame of each physical resource, `None` if it lives within the frame. The accesses that final
/// states take are added to the timeline, in the step behind all others.
pub(super) fn states(adapted: &AdaptedFrame, timeline: &mut AccessTimeline, final_step: u32) -> Vec<Option<States>> {
    let mut states: Vec<Option<States>> = vec![None; adapted.resources.len()];
    if adapted.resources.iter().all(PhysicalResource::is_transient) {
        return states;
    }
    let mut first = 0;
    while let Some(resource) = adapted.resources.get(first as usize) {
        let last = last_of_ring(adapted, first);
        let ring = first..last + 1;
        first = last + 1;
        if resource.is_transient() {
            continue;
        }
        let imported = if let MemorySource::Imported { before } = resource.memory { Some(before) } else { None };
        let crossed = timeline.queues.is_crossed(ring.start);
        let mut ring = Ring { adapted, timeline, resources: ring, imported, crossed, layouts: Vec::new() };
        let after = ring.leave(final_step);
        let from = after.iter().cycle().skip(after.len() - 1);
        for ((resource, after), from) in ring.resources.zip(&after).zip(from) {
            let before = match adapted.resources[resource as usize].memory {
                MemorySource::Imported { before } => before,
                MemorySource::Persistent { .. } => *from,
                // Its contents are not kept, but the frame before used it too.
                MemorySource::Output | MemorySource::Transient => {
                    State { accesses: after.accesses.writes(), layout: Layout::Undefined, ..*after }
                }
            };
            states[resource as usize] = Some(States { before, after: *after });
        }
    }
    states
}

/// A history ring, or one resource that comes and goes.
struct Ring<'a> {
    adapted: &'a AdaptedFrame,
    timeline: &'a mut AccessTimeline,
    resources: Range<PhysicalIndex>,
    /// The state in which an import is found.
    imported: Option<State>,
    /// Whether several queues use it. Then semaphores alone lead on from its state, which names no stages.
    crossed: bool,
    /// The layout in which each is left.
    layouts: Vec<Layout>,
}

/// The last use of a subresource: stages and accesses since the last write or change of layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct LastUse {
    stages: Stages,
    accesses: Accesses,
}

impl LastUse {
    fn only_reads(self) -> bool {
        self.accesses.writes().is_empty()
    }

    fn and(self, other: LastUse) -> LastUse {
        LastUse { stages: self.stages | other.stages, accesses: self.accesses | other.accesses }
    }

    fn covers(self, other: LastUse) -> bool {
        self.and(other) == self
    }
}

impl From<State> for LastUse {
    fn from(state: State) -> LastUse {
        LastUse { stages: state.stages, accesses: state.accesses }
    }
}

impl From<&SubresourceState> for LastUse {
    fn from(subresource: &SubresourceState) -> LastUse {
        LastUse { stages: subresource.stages, accesses: subresource.accesses }
    }
}

impl Ring<'_> {
    /// Brings each member into one state, which is returned.
    fn leave(&mut self, final_step: u32) -> Vec<State> {
        if self.imported.is_none() && !self.crossed {
            (0..self.resources.len()).for_each(|at| self.read_on(at));
        }
        self.choose_layouts();
        (0..self.resources.len()).for_each(|at| self.bring_into_layout(at, final_step));
        if self.crossed {
            let (stages, accesses) = (Stages::empty(), Accesses::empty());
            return self.layouts.iter().map(|layout| State { stages, accesses, layout: *layout }).collect();
        }
        // A widened barrier of one subresource may widen those of others.
        while (0..self.resources.len()).any(|at| self.share_reads(at, final_step)) {}
        (0..self.resources.len())
            .map(|at| {
                let LastUse { stages, accesses } = self.uses(at);
                self.asked_for(at).unwrap_or(State { stages, accesses, layout: self.layouts[at] })
            })
            .collect()
    }

    fn resource(&self, at: usize) -> &PhysicalResource {
        &self.adapted.resources[self.resources.start as usize + at]
    }

    /// The state that was asked for. Resources that several queues use are left to semaphores.
    fn asked_for(&self, at: usize) -> Option<State> {
        self.resource(at).after.filter(|_| !self.crossed)
    }

    /// The member that becomes number `at` in the next frame.
    fn previous(&self, at: usize) -> usize {
        at.checked_sub(1).unwrap_or(self.resources.len() - 1)
    }

    fn parts(&self) -> Range<u32> {
        0..self.resource(0).subresources().len() as u32
    }

    fn subresource(&self, at: usize, part: u32) -> &SubresourceState {
        &self.timeline.subresources[(self.resource(at).first_subresource + part) as usize]
    }

    /// If a frame begins with reads of a subresource that the frame before read last, in the same layout, widens the barrier
    /// before the last reads to cover the first ones.
    fn read_on(&mut self, at: usize) {
        let from = self.previous(at);
        for part in self.parts() {
            let (last, first) = (*self.subresource(from, part), self.subresource(at, part));
            let Some(begin) = self.timeline.barriers.get(first.first_barrier as usize).copied() else { continue };
            let reads = begin.keeps && begin.dst_accesses.writes().is_empty();
            if reads && last.is_used() && !last.writes() && last.layout == begin.new_layout {
                let subresource = self.resource(from).first_subresource + part;
                self.timeline.read_also(subresource, begin.dst_stages, begin.dst_accesses);
            }
        }
    }

    /// Each member is left in the layout that was asked for, else in that of its last use, else in that it was found in.
    fn choose_layouts(&mut self) {
        let none = if self.resource(0).image().is_some() { Layout::General } else { Layout::Undefined };
        let mut known = self.imported.map_or(none, |state| state.layout);
        // Two rounds, so that unused ring members inherit the layout of the last used one.
        for _ in 0..2 {
            self.layouts.clear();
            for at in 0..self.resources.len() {
                known = self.own_layout(at).unwrap_or(known);
                self.layouts.push(known);
            }
        }
    }

    fn own_layout(&self, at: usize) -> Option<Layout> {
        if let Some(after) = self.asked_for(at) {
            return Some(after.layout);
        }
        let used = self.parts().map(|part| self.subresource(at, part)).filter(|subresource| subresource.is_used());
        let layout = used.max_by_key(|subresource| subresource.last)?.layout;
        Some(self.resource(at).layout_of_all_planes(layout))
    }

    /// Brings all subresources of a member into its layout, or into the state that was asked for.
    fn bring_into_layout(&mut self, at: usize, final_step: u32) {
        let (resource, first) = (self.resources.start + at as u32, self.resource(at).first_subresource);
        let layout = self.layouts[at];
        if let Some(after) = self.asked_for(at) {
            // If the state names no stages, a semaphore waits for everything: then only a layout takes a barrier.
            let is_there = |subresource: &SubresourceState| {
                after.stages.is_empty() && subresource.is_used() && subresource.layout == layout
            };
            let lacking: Vec<u32> = self.parts().filter(|part| !is_there(self.subresource(at, *part))).collect();
            return lacking.into_iter().for_each(|part| self.timeline.leave(resource, first + part, final_step, after));
        }
        let found = self.imported.map_or(self.layouts[self.previous(at)], |state| state.layout);
        let held = |subresource: &SubresourceState| if subresource.is_used() { subresource.layout } else { found };
        if self.parts().all(|part| held(self.subresource(at, part)) == layout) {
            return;
        }
        let used = self.parts().map(|part| self.subresource(at, part)).filter(|subresource| subresource.is_used());
        let LastUse { stages, accesses } = match self.crossed {
            true => LastUse { stages: Stages::ALL_COMMANDS, accesses: Accesses::MEMORY_READ },
            false => used.fold(LastUse::default(), |all, subresource| all.and(subresource.into())),
        };
        let read = State { stages, accesses: accesses.difference(Accesses::WRITES), layout };
        for part in self.parts() {
            if held(self.subresource(at, part)) != layout {
                self.timeline.leave(resource, first + part, final_step, read);
            }
        }
    }

    /// Calls `visit` with each use of a subresource that the next frame has to wait for: the last one of this frame; and, if
    /// there is none or it is a read that waited for nothing, that of the frame before.
    fn each_use(&self, at: usize, part: u32, mut visit: impl FnMut(LastUse, Option<(usize, u32)>)) {
        let mut reads_on = false;
        let mut now = at;
        for _ in 0..self.resources.len() {
            let (subresource, before) = (self.subresource(now, part), self.previous(now));
            if subresource.is_used() {
                if reads_on && subresource.writes() {
                    return;
                }
                visit(subresource.into(), Some((now, part)));
                let found = self.imported.map_or(self.layouts[before], |state| state.layout);
                if subresource.writes() || subresource.second_barrier != NEVER || subresource.layout != found {
                    return;
                }
                reads_on = true;
            }
            now = before;
        }
        if let Some(found) = self.imported.map(LastUse::from)
            && (found.only_reads() || !reads_on)
        {
            visit(found, None);
        }
    }

    /// All uses of a member that the next frame has to wait for.
    fn uses(&self, at: usize) -> LastUse {
        let mut all = LastUse::default();
        self.parts().for_each(|part| self.each_use(at, part, |uses, _| all = all.and(uses)));
        all
    }

    /// If a member is left to be read, widens the barriers of all its subresources to all these reads. Returns whether any
    /// changed.
    fn share_reads(&mut self, at: usize, final_step: u32) -> bool {
        let all = self.uses(at);
        if !all.only_reads() || self.asked_for(at).is_some() {
            return false;
        }
        let mut lacking = Vec::new();
        for part in self.parts() {
            self.each_use(at, part, |uses, subresource| {
                // An import is found in its declared state, even if the frame reads on from it.
                let is_fixed = subresource.is_none() && self.subresource(at, part).is_used();
                if !uses.covers(all) && !is_fixed {
                    lacking.push(subresource.unwrap_or((at, part)));
                }
            });
        }
        for (at, part) in &lacking {
            let subresource = self.resource(*at).first_subresource + part;
            if self.timeline.subresources[subresource as usize].is_used() {
                self.timeline.read_also(subresource, all.stages, all.accesses);
            } else {
                let state = State { stages: all.stages, accesses: all.accesses, layout: self.layouts[*at] };
                self.timeline.leave(self.resources.start + *at as u32, subresource, final_step, state);
            }
        }
        !lacking.is_empty()
    }
}
