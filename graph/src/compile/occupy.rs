//! Whose memory each transient image and buffer takes over, through the frame and into the next.

use super::model::StoreIndex;
use super::place::Placed;
use super::synchronise::NEVER;

/// `store` takes bytes of `from`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Taken {
    pub(super) store: StoreIndex,
    pub(super) from: StoreIndex,
    /// Whether that was in this frame, or in the one before.
    pub(super) this_frame: bool,
}

/// Who takes whose memory, and what about offsets makes it so.
#[derive(Debug, Default)]
pub(super) struct Occupancy {
    pub(super) taken: Vec<Taken>,
    /// Both ends of all that lies in heaps: by heap, then by offset.
    ends: Vec<End>,
}

/// An end of what a store takes of its heap.
#[derive(Debug, Clone, Copy)]
struct End {
    store: StoreIndex,
    upper: bool,
    above: Above,
}

/// How an end lies to the one before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Above {
    /// At the same offset.
    Same,
    /// Higher in the same heap.
    Higher,
    /// In another heap.
    Another,
}

impl Above {
    fn of(before: Option<(u32, u64)>, now: (u32, u64)) -> Option<Above> {
        match before {
            Some((heap, offset)) if heap == now.0 && offset == now.1 => Some(Above::Same),
            Some((heap, offset)) if heap == now.0 => (offset < now.1).then_some(Above::Higher),
            _ => Some(Above::Another),
        }
    }
}

impl Occupancy {
    /// `lifetimes`: for each store the first and the last step that use it.
    pub(super) fn of(placed: &Placed, lifetimes: &[[u32; 2]]) -> Occupancy {
        let mut occupancy = Occupancy::default();
        let mut pieces = vec![[0; 2]; placed.placements.len()];
        let by_first_step = placed.by_first_step(lifetimes);
        for heap in 0..placed.heaps.len() as u32 {
            occupancy.heap(placed, &by_first_step, heap, &mut pieces);
        }
        occupancy
    }

    /// Whether the ends of all placements lie to each other as they did: then the same memory is taken over.
    pub(super) fn still_holds(&self, placed: &Placed) -> bool {
        let mut before = None;
        self.ends.iter().all(|end| {
            let Some(placement) = &placed.placements[end.store as usize] else { return false };
            let now = (placement.heap, placement.offset + if end.upper { placement.bytes } else { 0 });
            Above::of(before.replace(now), now) == Some(end.above)
        })
    }

    /// Follows who holds which bytes of a heap. `by_first_step`: what has a place, in the order in which it begins. `pieces`: for each store the first of the pieces that its ends cut the heap
    /// into, and the first behind it.
    fn heap(&mut self, placed: &Placed, by_first_step: &[StoreIndex], heap: u32, pieces: &mut [[u32; 2]]) {
        let mut ends: Vec<(u64, StoreIndex, bool)> = Vec::with_capacity(2 * placed.placements.len());
        for (placement, store) in placed.placements.iter().zip(0_u32..) {
            if let Some(placement) = placement.as_ref().filter(|placement| placement.heap == heap) {
                ends.push((placement.offset, store, false));
                ends.push((placement.offset + placement.bytes, store, true));
            }
        }
        ends.sort_by_key(|(offset, ..)| *offset);
        self.ends.reserve(ends.len());
        self.taken.reserve(ends.len());
        let mut piece = 0;
        let mut before = None;
        for (offset, store, upper) in ends {
            let now = (heap, offset);
            let above = Above::of(before.replace(now), now).unwrap_or(Above::Another);
            piece += u32::from(above == Above::Higher);
            pieces[store as usize][usize::from(upper)] = piece;
            self.ends.push(End { store, upper, above });
        }
        let mut holders = vec![NEVER; piece as usize];
        let mut from_frame_before: Vec<(StoreIndex, u32)> = Vec::new();
        let mut known: Vec<StoreIndex> = Vec::new();
        let is_here =
            |store: &&StoreIndex| placed.placements[**store as usize].as_ref().is_some_and(|it| it.heap == heap);
        for store in by_first_step.iter().filter(is_here) {
            let [first, end] = pieces[*store as usize];
            known.clear();
            for piece in first..end {
                let holder = std::mem::replace(&mut holders[piece as usize], *store);
                if holder == NEVER {
                    from_frame_before.push((*store, piece));
                } else if !known.contains(&holder) {
                    known.push(holder);
                    self.taken.push(Taken { store: *store, from: holder, this_frame: true });
                }
            }
        }
        let mut taker = NEVER;
        for (store, piece) in from_frame_before {
            if std::mem::replace(&mut taker, store) != store {
                known.clear();
            }
            let from = holders[piece as usize];
            if !known.contains(&from) {
                known.push(from);
                self.taken.push(Taken { store, from, this_frame: false });
            }
        }
    }
}
