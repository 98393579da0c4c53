//! `synchronise`, after `batch`: barriers whose work others do anyway are left out.
//!
//! Each barrier was found for one cell, whatever else stands between the steps that it keeps in order. Where it changes no
//! layout, all that it brings is order, and makes writes visible; chains of other barriers between the same steps may bring
//! just that. Most such barriers are those between frames: a buffer that the frame before read is written anew, and many
//! steps stand between.
//!
//! One after the other is left out for a trial: it stays out if what it was found for is still so, and what those before it
//! were found for that relied on it. So whatever is left out is always done by barriers that stay, and of those that stay
//! none could be left out as well.

use super::batch::Batched;
use super::hand_over::MemoryScopes;
use super::logical_order::{and_earlier, and_later};
use super::model::{Adapted, Home};
use super::outlive::earlier;
use super::synchronise::{NEVER, Pending, Walked};
use super::take_over::TakenOver;
use crate::states::pairs;
use crate::vocabulary::{Accesses, Stages};
use std::ops::Range;

/// Calls before a step among which others are looked for that do a barrier's work, so that the time that this takes grows
/// with the number of barriers alone.
const LOOK_BACK: usize = 64;

/// Barriers that rely on one call; more aren't looked at again to find out whether it could be left out too.
const MOST_RELYING: usize = 64;

/// What is left when all is left out that others do; `None`: all. `memory`: barriers that stay, with their steps.
pub(super) fn prune(
    adapted: &Adapted,
    walked: &Walked,
    taken: &TakenOver,
    memory: &[(u32, MemoryScopes)],
    batched: &[Batched],
) -> Option<Vec<Batched>> {
    if !walked.barriers.iter().any(is_candidate) {
        return None;
    }
    let mut pruning = Pruning { adapted, walked, taken, batched, calls: Vec::new(), candidates: Vec::new() };
    pruning.gather(memory);
    for candidate in 0..pruning.candidates.len() as u32 {
        pruning.try_without(candidate);
    }
    let mut stays = vec![true; batched.len()];
    for candidate in pruning.candidates.iter().filter(|candidate| !candidate.stays) {
        stays[candidate.entries.start as usize..candidate.entries.end as usize].fill(false);
    }
    let left = batched.iter().zip(&stays).filter(|(_, stays)| **stays).map(|(it, _)| *it);
    stays.contains(&false).then(|| left.collect())
}

/// Whether nothing but order is asked of it. What has no scope waits for a semaphore, or leads to one.
fn is_candidate(pending: &Pending) -> bool {
    pending.in_layout && pending.step != NEVER && !pending.src_stages.is_empty() && !pending.dst_stages.is_empty()
}

/// What a barrier brings into order: of an image no memory but its own, so nothing that concerns others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Scopes {
    src_stages: Stages,
    src_accesses: Accesses,
    dst_stages: Stages,
    dst_accesses: Accesses,
}

impl Scopes {
    const NOTHING: Scopes = Scopes {
        src_stages: Stages::empty(),
        src_accesses: Accesses::empty(),
        dst_stages: Stages::empty(),
        dst_accesses: Accesses::empty(),
    };

    fn of_image(pending: &Pending) -> Scopes {
        Scopes { src_stages: pending.src_stages, dst_stages: pending.dst_stages, ..Scopes::NOTHING }
    }

    fn and(self, pending: &Pending) -> Scopes {
        Scopes {
            src_stages: self.src_stages | pending.src_stages,
            src_accesses: self.src_accesses | pending.src_accesses,
            dst_stages: self.dst_stages | pending.dst_stages,
            dst_accesses: self.dst_accesses | pending.dst_accesses,
        }
    }
}

impl From<&MemoryScopes> for Scopes {
    fn from(memory: &MemoryScopes) -> Scopes {
        let MemoryScopes { src_stages, src_accesses, dst_stages, dst_accesses, .. } = *memory;
        Scopes { src_stages, src_accesses, dst_stages, dst_accesses }
    }
}

/// All barriers before one step.
struct Call {
    at: u32,
    /// What those bring into order that aren't candidates; no two are the same.
    scopes: Vec<Scopes>,
    candidates: Range<u32>,
    /// Candidates that are left out, and rely on candidates of this call.
    relying: Vec<u32>,
}

/// What may be left out: the barrier of a buffer, or those of neighbouring parts of an image that become one.
struct Candidate {
    /// Into what is batched.
    entries: Range<u32>,
    call: u32,
    is_of_buffer: bool,
    stays: bool,
}

struct Pruning<'p> {
    adapted: &'p Adapted,
    walked: &'p Walked,
    taken: &'p TakenOver,
    batched: &'p [Batched],
    calls: Vec<Call>,
    candidates: Vec<Candidate>,
}

/// When something happened: in the frame that is looked at, or before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Moment {
    /// More than one frame ago.
    Earlier,
    /// By a step of the frame before.
    FrameBefore(u32),
    /// When the frame began.
    Begin,
    /// By a step of the frame.
    Step(u32),
}

impl Pruning<'_> {
    fn pending(&self, entry: u32) -> &Pending {
        &self.walked.barriers[self.batched[entry as usize].barrier as usize]
    }

    /// Sorts barriers into calls and candidates.
    fn gather(&mut self, memory: &[(u32, MemoryScopes)]) {
        let mut memory = memory.iter().peekable();
        let mut start = 0;
        for here in self.batched.chunk_by(|one, next| one.at == next.at) {
            let entries = start..start + here.len() as u32;
            start = entries.end;
            let first = self.candidates.len() as u32;
            let call = self.calls.len() as u32;
            let mut scopes: Vec<Scopes> = Vec::new();
            while let Some((_, brought)) = memory.next_if(|(at, _)| *at <= here[0].at) {
                scopes.push(brought.into());
            }
            let mut from = entries.start;
            while from < entries.end {
                let pending = *self.pending(from);
                let is_of_buffer = pending.is_of_buffer();
                let alike = |at: &u32| !is_of_buffer && become_one(&pending, self.pending(*at));
                let run = from..from + 1 + (from + 1..entries.end).take_while(alike).count() as u32;
                from = run.end;
                if run.clone().all(|entry| is_candidate(self.pending(entry))) {
                    self.candidates.push(Candidate { entries: run, call, is_of_buffer, stays: true });
                } else {
                    let brought = if is_of_buffer { Scopes::NOTHING.and(&pending) } else { Scopes::of_image(&pending) };
                    if !scopes.contains(&brought) {
                        scopes.push(brought);
                    }
                }
            }
            let candidates = first..self.candidates.len() as u32;
            self.calls.push(Call { at: here[0].at, scopes, candidates, relying: Vec::new() });
        }
    }

    /// Leaves a candidate out, unless it is missed.
    fn try_without(&mut self, candidate: u32) {
        let call = self.candidates[candidate as usize].call as usize;
        if self.calls[call].relying.len() > MOST_RELYING {
            return;
        }
        self.candidates[candidate as usize].stays = false;
        let mut relied_on: Vec<(u32, u32)> = Vec::new();
        let all = [candidate].into_iter().chain(self.calls[call].relying.iter().copied());
        let missed = all.into_iter().any(|left_out| !self.is_done(left_out, &mut relied_on));
        if missed {
            self.candidates[candidate as usize].stays = true;
            return;
        }
        for (call, left_out) in relied_on {
            let relying = &mut self.calls[call as usize].relying;
            if !relying.contains(&left_out) {
                relying.push(left_out);
            }
        }
    }

    /// Whether others do all that a candidate was found for; notes on which calls that relies.
    fn is_done(&self, candidate: u32, relied_on: &mut Vec<(u32, u32)>) -> bool {
        let Candidate { entries, call, .. } = &self.candidates[candidate as usize];
        entries.clone().all(|entry| {
            let pending = self.pending(entry);
            let (moment, is_promised) = self.moment(entry);
            let between = self.between(moment, pending.step);
            let required: Vec<(Stages, Accesses)> = pairs(pending.dst_stages, pending.dst_accesses).collect();
            let mut sources: Vec<(Stages, Accesses)> = pairs(pending.src_stages, pending.src_accesses).collect();
            // Of the other stages there is nothing to be seen.
            let seen = sources.iter().fold(Stages::empty(), |all, (stage, _)| all | *stage);
            sources.extend(pending.src_stages.difference(seen).iter().map(|stage| (stage, Accesses::empty())));
            sources.into_iter().all(|source| {
                let mut way =
                    Way { source, after: Stages::empty(), seen: vec![false; required.len()], required: &required };
                for (number, is_last) in between.iter().rev() {
                    let own = *is_last && *number == *call;
                    if self.pass(&mut way, *number, own) {
                        relied_on.push((*number, candidate));
                    }
                }
                // Reads see what was written before earlier reads too; a write only has to come after those.
                let is_read = source.1.is_empty() && !is_promised;
                let free = |access: Accesses| is_read && (pending.is_shown || !access.writes().is_empty());
                let visible = way.seen.iter().zip(&required).all(|(seen, (_, access))| *seen || free(*access));
                visible && way.after.contains(pending.dst_stages)
            })
        })
    }

    /// The last calls between a moment and the work of a step, the last one first, each with whether it is one of the same
    /// frame as the step.
    fn between(&self, from: Moment, step: u32) -> Vec<(u32, bool)> {
        let until = |step: u32| self.calls.partition_point(|call| call.at <= step) as u32;
        let (start, before) = match from {
            Moment::Step(last) => (until(last), None),
            Moment::Begin => (0, None),
            Moment::FrameBefore(last) => (0, Some(until(last))),
            Moment::Earlier => (0, Some(0)),
        };
        let before = before.map_or(0..0, |before| before..self.calls.len() as u32);
        let this = (start..until(step)).rev().map(|call| (call, true));
        this.chain(before.rev().map(|call| (call, false))).take(LOOK_BACK).collect()
    }

    /// The last moment that a barrier waits for, and whether what it waits for was only promised to whom it may concern.
    fn moment(&self, entry: u32) -> (Moment, bool) {
        let pending = self.pending(entry);
        if pending.after != NEVER {
            return (Moment::Step(pending.after), false);
        }
        let store = &self.adapted.stores[pending.store as usize];
        match store.home {
            Home::Output | Home::Imported { .. } => (Moment::Begin, false),
            Home::Transient => {
                let barrier = self.batched[entry as usize].barrier;
                let taken = &self.taken.from_frame_before;
                let start = taken.partition_point(|(by, _)| *by < barrier);
                let last = taken[start..].iter().take_while(|(by, _)| *by == barrier).map(|(_, last)| *last).max();
                (last.map_or(Moment::Begin, Moment::FrameBefore), false)
            }
            Home::Persistent { .. } => {
                let part = pending.cell - store.first_cell;
                let used = earlier(self.adapted, pending.store).find_map(|(ago, store)| {
                    let cell = &self.walked.cells[(self.adapted.stores[store as usize].first_cell + part) as usize];
                    let is_promised = cell.last > self.walked.lifetimes[store as usize][1];
                    let moment = if ago == 1 { Moment::FrameBefore(cell.last) } else { Moment::Earlier };
                    cell.is_touched().then_some((moment, is_promised))
                });
                used.unwrap_or((Moment::Begin, true))
            }
        }
    }

    /// Goes on behind a call, whose barriers don't order each other. `own`: the one that the way stands in for: buffers
    /// of it share a barrier. Returns whether candidates led on.
    fn pass(&self, way: &mut Way<'_>, call: u32, own: bool) -> bool {
        let Call { scopes, candidates, .. } = &self.calls[call as usize];
        let before = way.after;
        scopes.iter().for_each(|brought| way.follow(before, brought));
        let fixed = (way.after, way.seen.iter().filter(|seen| **seen).count());
        let candidates = &self.candidates[candidates.start as usize..candidates.end as usize];
        let mut of_buffers = Scopes::NOTHING;
        for candidate in candidates.iter().filter(|candidate| candidate.stays) {
            let pending = self.pending(candidate.entries.start);
            if !candidate.is_of_buffer {
                way.follow(before, &Scopes::of_image(pending));
            } else if !own {
                of_buffers = of_buffers.and(pending);
            }
        }
        way.follow(before, &of_buffers);
        fixed != (way.after, way.seen.iter().filter(|seen| **seen).count())
    }
}

/// Whether barriers of two parts become one.
fn become_one(one: &Pending, other: &Pending) -> bool {
    let layouts = |of: &Pending| (of.store, of.old_layout, of.new_layout);
    let scopes = |of: &Pending| (of.src_stages, of.src_accesses, of.dst_stages, of.dst_accesses);
    layouts(one) == layouts(other) && scopes(one) == scopes(other)
}

/// What comes after one stage's accesses, further and further on.
struct Way<'r> {
    /// The stage, and what it wrote; nothing: it read.
    source: (Stages, Accesses),
    /// Stages in which everything from here on comes after that, and finds it available.
    after: Stages,
    /// Accesses that must see it, and which of them do.
    required: &'r [(Stages, Accesses)],
    seen: Vec<bool>,
}

impl Way<'_> {
    /// Goes on over a barrier, if it leads on from `before`.
    fn follow(&mut self, before: Stages, brought: &Scopes) {
        let (stage, write) = self.source;
        let begins = match write.is_empty() {
            true => and_earlier(brought.src_stages).contains(stage),
            false => brought.src_stages.contains(stage) && takes_in(brought.src_accesses, write),
        };
        if !begins && !and_earlier(brought.src_stages).intersects(before) {
            return;
        }
        self.after |= and_later(brought.dst_stages);
        for (seen, (stage, access)) in self.seen.iter_mut().zip(self.required) {
            *seen |= brought.dst_stages.contains(*stage) && takes_in(brought.dst_accesses, *access);
        }
    }
}

/// Whether an access scope takes in one access.
fn takes_in(scope: Accesses, access: Accesses) -> bool {
    let any = if access.writes().is_empty() { Accesses::MEMORY_READ } else { Accesses::MEMORY_WRITE };
    scope.contains(access) || scope.contains(any)
}
