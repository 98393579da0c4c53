//! Aliasing: which transient image or buffer had the memory of another one before, within the frame and across frames.

use super::place::Placed;
use crate::compile::model::PhysicalIndex;
use crate::compile::steps::NEVER;

/// An alias edge: `resource` takes bytes of `from`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::compile) struct AliasEdge {
    pub(in crate::compile) resource: PhysicalIndex,
    pub(in crate::compile) from: PhysicalIndex,
    /// Whether `from` had the bytes in this frame, or in the one before.
    pub(in crate::compile) this_frame: bool,
}

/// All alias edges, and the order of offsets that they follow from.
#[derive(Debug, Default)]
pub(in crate::compile) struct Aliasing {
    pub(in crate::compile) edges: Vec<AliasEdge>,
    /// Both ends of all placements: by heap, then by offset.
    ends: Vec<End>,
}

/// An end of a placement.
#[derive(Debug, Clone, Copy)]
struct End {
    resource: PhysicalIndex,
    upper: bool,
    above: Above,
}

/// How an end lies relative to the one before it.
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

impl Aliasing {
    /// `lifetimes`: for each physical resource the first and the last step that use it.
    pub(in crate::compile) fn of(placed: &Placed, lifetimes: &[[u32; 2]]) -> Aliasing {
        let mut aliasing = Aliasing::default();
        let mut pieces = vec![[0; 2]; placed.placements.len()];
        let by_first_step = placed.by_first_step(lifetimes);
        for heap in 0..placed.heaps.len() as u32 {
            aliasing.heap(placed, &by_first_step, heap, &mut pieces);
        }
        aliasing
    }

    /// Whether the ends of all placements are in the same order: then the same memory is taken over.
    pub(in crate::compile) fn still_holds(&self, placed: &Placed) -> bool {
        let mut before = None;
        self.ends.iter().all(|end| {
            let Some(placement) = &placed.placements[end.resource as usize] else { return false };
            let now = (placement.heap, placement.offset + if end.upper { placement.bytes } else { 0 });
            Above::of(before.replace(now), now) == Some(end.above)
        })
    }

    /// Follows the owners of each piece of a heap. The ends of placements cut the heap into pieces.
    ///
    /// `by_first_step`: the placed resources, in the order of first steps. `pieces`: for each physical resource its first
    /// piece, and the first piece behind it.
    fn heap(&mut self, placed: &Placed, by_first_step: &[PhysicalIndex], heap: u32, pieces: &mut [[u32; 2]]) {
        let mut ends: Vec<(u64, PhysicalIndex, bool)> = Vec::with_capacity(2 * placed.placements.len());
        for (placement, resource) in placed.placements.iter().zip(0_u32..) {
            if let Some(placement) = placement.as_ref().filter(|placement| placement.heap == heap) {
                ends.push((placement.offset, resource, false));
                ends.push((placement.offset + placement.bytes, resource, true));
            }
        }
        ends.sort_by_key(|(offset, ..)| *offset);
        self.ends.reserve(ends.len());
        self.edges.reserve(ends.len());
        let mut piece = 0;
        let mut before = None;
        for (offset, resource, upper) in ends {
            let now = (heap, offset);
            let above = Above::of(before.replace(now), now).unwrap_or(Above::Another);
            piece += u32::from(above == Above::Higher);
            pieces[resource as usize][usize::from(upper)] = piece;
            self.ends.push(End { resource, upper, above });
        }
        let mut owners = vec![NEVER; piece as usize];
        let mut from_frame_before: Vec<(PhysicalIndex, u32)> = Vec::new();
        let mut known: Vec<PhysicalIndex> = Vec::new();
        let is_here = |resource: &&PhysicalIndex| {
            placed.placements[**resource as usize].as_ref().is_some_and(|it| it.heap == heap)
        };
        for resource in by_first_step.iter().filter(is_here) {
            let [first, end] = pieces[*resource as usize];
            known.clear();
            for piece in first..end {
                let owner = std::mem::replace(&mut owners[piece as usize], *resource);
                if owner == NEVER {
                    from_frame_before.push((*resource, piece));
                } else if !known.contains(&owner) {
                    known.push(owner);
                    self.edges.push(AliasEdge { resource: *resource, from: owner, this_frame: true });
                }
            }
        }
        let mut taker = NEVER;
        for (resource, piece) in from_frame_before {
            if std::mem::replace(&mut taker, resource) != resource {
                known.clear();
            }
            let from = owners[piece as usize];
            if !known.contains(&from) {
                known.push(from);
                self.edges.push(AliasEdge { resource, from, this_frame: false });
            }
        }
    }
}
