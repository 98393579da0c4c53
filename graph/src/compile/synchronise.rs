//! `synchronise`: exact barriers, all of a step in one call.
//!
//! Reads in one layout follow each other without a barrier: the one before the first of them already names them all.
//!
//! Where memory changes hands, the new occupant's first barrier names the *stages* of the previous occupant's last
//! accesses; their writes are named by a memory barrier (see `hand_over`). Frames follow each other, so the first occupant
//! comes after the last.

use super::hand_over::{HandOver, memory_barriers};
use super::model::{Adapted, StoreIndex};
use super::place::Placed;
use super::retain::{EXPORTED, Need, Retained};
use crate::plan::{Hazard, ImageBarrier, ImageId, MemoryBarrier, StepId};
use crate::vocabulary::{Accesses, Layout, Stages};
use std::collections::BTreeMap;

/// Barriers by step.
#[derive(Debug)]
pub(super) struct Barriers {
    pub(super) image: Vec<Vec<ImageBarrier>>,
    pub(super) memory: Vec<Option<MemoryBarrier>>,
}

/// Needs that no barrier separates: reads in one layout, or a single write.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    /// The first and the last step.
    pub(super) first: u32,
    pub(super) last: u32,
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
    layout: Layout,
    keeps: bool,
}

impl Group {
    fn writes(&self) -> bool {
        !self.accesses.writes().is_empty()
    }
}

pub(super) fn synchronise(adapted: &Adapted, retained: &Retained, placed: &Placed, steps: usize) -> Barriers {
    let mut image_barriers = vec![Vec::new(); steps];
    let mut hand_overs = Vec::new();
    let before = occupants_before(retained, placed);
    for (store, at) in adapted.stores.iter().zip(0_u32..) {
        let mut previous: Option<Group> = None;
        for group in groups(retained.of(at)) {
            let barrier = match previous {
                None => first_use(at, &group, &before[at as usize], store.output, retained, &mut hand_overs),
                Some(previous) => between(at, &previous, &group),
            };
            image_barriers[group.first as usize].push(ImageBarrier { range: store.range(), ..barrier });
            previous = Some(group);
        }
    }
    let export = steps.saturating_sub(1);
    for barrier in image_barriers.get_mut(export).into_iter().flatten() {
        barrier.hazard = Hazard::Export;
    }
    let memory = memory_barriers(hand_overs, &image_barriers);
    Barriers { image: image_barriers, memory }
}

/// Splits an image's needs where a barrier is due.
fn groups(needs: &[Need]) -> impl Iterator<Item = Group> + '_ {
    let mut at = 0;
    std::iter::from_fn(move || {
        let first = needs.get(at)?;
        let mut group = Group {
            first: first.step,
            last: first.step,
            stages: first.stages,
            accesses: first.accesses,
            layout: first.layout,
            keeps: first.keeps,
        };
        at += 1;
        while !group.writes()
            && let Some(next) = needs.get(at)
            && next.accesses.writes().is_empty()
            && next.layout == group.layout
        {
            group.last = next.step;
            group.stages |= next.stages;
            group.accesses |= next.accesses;
            at += 1;
        }
        Some(group)
    })
}

/// The barrier between two groups of one image.
fn between(store: StoreIndex, previous: &Group, group: &Group) -> ImageBarrier {
    let hazard = match (previous.writes(), group.writes()) {
        (true, false) => Hazard::ReadAfterWrite,
        (true, true) => Hazard::WriteAfterWrite,
        (false, true) => Hazard::WriteAfterRead,
        (false, false) => Hazard::LayoutChange,
    };
    ImageBarrier {
        src_stages: previous.stages,
        src_accesses: previous.accesses.writes(),
        old_layout: if group.keeps { previous.layout } else { Layout::Undefined },
        hazard,
        after: Some(StepId(previous.last)),
        ..towards(store, group)
    }
}

/// A barrier into a group, from nowhere yet. The range is the caller's.
fn towards(store: StoreIndex, group: &Group) -> ImageBarrier {
    ImageBarrier {
        image: ImageId(store),
        range: crate::plan::Subresources::all(crate::format::Format::R8_UNORM, 1, 1),
        src_stages: Stages::empty(),
        src_accesses: Accesses::empty(),
        dst_stages: group.stages,
        dst_accesses: group.accesses,
        old_layout: Layout::Undefined,
        new_layout: group.layout,
        ownership: None,
        hazard: Hazard::FirstUse,
        after: None,
    }
}

/// The barrier before an image's first use; writes to its memory that it can't name itself become hand-overs.
fn first_use(
    store: StoreIndex,
    group: &Group,
    occupants: &[Occupant],
    output: bool,
    retained: &Retained,
    hand_overs: &mut Vec<HandOver>,
) -> ImageBarrier {
    let mut barrier = towards(store, group);
    if output {
        barrier.src_stages = EXPORTED.0;
        return barrier;
    }
    let first_hand_over = hand_overs.len();
    for occupant in occupants {
        let Some(last) = groups(retained.of(occupant.store)).last() else { continue };
        barrier.src_stages |= last.stages;
        if occupant.this_frame {
            barrier.after = barrier.after.max(Some(StepId(last.last)));
        }
        if last.writes() && occupant.store == store {
            barrier.src_accesses |= last.accesses.writes();
        } else if last.writes() {
            hand_overs.push(HandOver {
                images: [ImageId(occupant.store), ImageId(store)],
                write: last,
                this_frame: occupant.this_frame,
                first: *group,
                waits_for: Stages::empty(),
            });
        }
    }
    for hand_over in &mut hand_overs[first_hand_over..] {
        hand_over.waits_for = barrier.src_stages;
    }
    barrier
}

/// An image whose memory, or part of it, goes to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Occupant {
    store: StoreIndex,
    this_frame: bool,
}

/// For each store, whose memory it takes over: those before it in the frame, or, for bytes that nobody used before it,
/// those that used them last in the frame before.
fn occupants_before(retained: &Retained, placed: &Placed) -> Vec<Vec<Occupant>> {
    let mut previous = vec![Vec::new(); placed.placements.len()];
    let mut members: Vec<Vec<StoreIndex>> = vec![Vec::new(); placed.heaps.len()];
    for (placement, store) in placed.placements.iter().zip(0_u32..) {
        if let Some(placement) = placement {
            members[placement.heap as usize].push(store);
        }
    }
    for stores in &mut members {
        stores.sort_by_key(|store| (retained.of(*store).first().map(|need| need.step), *store));
        let mut map = OccupantMap::default();
        for this_frame in [false, true] {
            for (rank, store) in stores.iter().enumerate() {
                let Some(placement) = &placed.placements[*store as usize] else { continue };
                let found =
                    map.replace(placement.offset, placement.offset + placement.bytes, (*store, this_frame, rank));
                if this_frame {
                    previous[*store as usize] =
                        found.into_iter().map(|(store, this_frame, _)| Occupant { store, this_frame }).collect();
                }
            }
        }
    }
    previous
}

/// Who holds which bytes: store, whether in this frame, and rank in order of first use.
#[derive(Default)]
struct OccupantMap(BTreeMap<u64, (u64, (StoreIndex, bool, usize))>);

impl OccupantMap {
    /// Gives `start..end` to a new holder and returns those who held parts of it, each once, in order of first use.
    fn replace(&mut self, start: u64, end: u64, holder: (StoreIndex, bool, usize)) -> Vec<(StoreIndex, bool, usize)> {
        let mut found = Vec::new();
        while let Some((at, (until, old))) =
            self.0.range(..end).next_back().map(|(at, held)| (*at, *held)).filter(|(_, (until, _))| *until > start)
        {
            self.0.remove(&at);
            if at < start {
                self.0.insert(at, (start, old));
            }
            if until > end {
                self.0.insert(end, (until, old));
            }
            found.push(old);
        }
        if start < end {
            self.0.insert(start, (end, holder));
        }
        found.sort_unstable_by_key(|(store, this_frame, rank)| (*this_frame, *rank, *store));
        found.dedup();
        found
    }
}
