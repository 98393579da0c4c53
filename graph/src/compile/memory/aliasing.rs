//! Aliasing: which transient image or buffer had the memory of another one before, within the frame and across frames.

use super::place::PlacedResources;
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

/// The alias edges so far, and the order of offsets that they follow from.
#[derive(Debug)]
struct Aliasing {
    edges: Vec<AliasEdge>,
    /// For each physical resource the numbers of its first offset and of the one that it ends at; [`NEVER`] if it isn't
    /// placed. Offsets at which placements begin or end are numbered by heap, then upwards.
    ends: Vec<[u32; 2]>,
    /// For each heap the number of its first offset, and that behind its last one.
    heaps: Vec<[u32; 2]>,
}

/// All alias edges. `by_first_step`: the placed resources, in the order of first steps.
pub(in crate::compile) fn alias_edges(placed: &PlacedResources, by_first_step: &[PhysicalIndex]) -> Vec<AliasEdge> {
    let mut aliasing = Aliasing {
        edges: Vec::with_capacity(2 * by_first_step.len()),
        ends: vec![[NEVER; 2]; placed.placements.len()],
        heaps: Vec::with_capacity(placed.heaps.len()),
    };
    for heap in 0..placed.heaps.len() as u32 {
        aliasing.number(placed, heap);
        aliasing.follow(placed, by_first_step, heap);
    }
    aliasing.edges
}

impl Aliasing {
    /// Numbers the offsets of a heap at which placements begin or end.
    fn number(&mut self, placed: &PlacedResources, heap: u32) {
        let first = self.heaps.last().map_or(0, |[_, end]| *end);
        // All offsets are multiples of an alignment.
        let here = || placed.placements.iter().flatten().filter(|it| it.heap == heap);
        let unit = here().fold(0, |bits, it| bits | it.offset | it.bytes).trailing_zeros() % u64::BITS;
        let words = placed.heaps[heap as usize].bytes >> unit >> u64::BITS.ilog2();
        let behind = if words <= placed.placements.len() as u64 {
            self.number_marked(placed, heap, first, (unit, words as usize + 1))
        } else {
            self.number_sorted(placed, heap, first)
        };
        self.heaps.push([first, behind]);
    }

    /// Numbers offsets from `first` on. Each multiple of 2 to the power of `unit` has a bit, which is set where an offset is.
    /// The bits take `words` words. Returns the number behind the last one.
    fn number_marked(&mut self, placed: &PlacedResources, heap: u32, first: u32, (unit, words): (u32, usize)) -> u32 {
        // Each word with the number of its first offset.
        let mut marked = vec![(0_u64, 0_u32); words];
        let place = |offset: u64| (((offset >> unit) / 64) as usize, 1_u64 << ((offset >> unit) % 64));
        for it in placed.placements.iter().flatten().filter(|it| it.heap == heap) {
            for (word, bit) in [place(it.offset), place(it.offset + it.bytes)] {
                marked[word].0 |= bit;
            }
        }
        let mut behind = first;
        for (bits, number) in &mut marked {
            *number = behind;
            behind += bits.count_ones();
        }
        for (ends, placement) in self.ends.iter_mut().zip(&placed.placements) {
            if let Some(it) = placement
                && it.heap == heap
            {
                *ends = [place(it.offset), place(it.offset + it.bytes)].map(|(word, bit)| {
                    let (bits, number) = marked[word];
                    number + (bits & (bit - 1)).count_ones()
                });
            }
        }
        behind
    }

    /// The same, by sorting: for offsets that lie too far apart to mark them.
    fn number_sorted(&mut self, placed: &PlacedResources, heap: u32, first: u32) -> u32 {
        let mut sorted: Vec<(u64, u32)> = Vec::with_capacity(2 * placed.placements.len());
        for (placement, at) in placed.placements.iter().zip(0_u32..) {
            if let Some(it) = placement
                && it.heap == heap
            {
                sorted.extend([(it.offset, 2 * at), (it.offset + it.bytes, 2 * at + 1)]);
            }
        }
        sorted.sort_unstable_by_key(|(offset, _)| *offset);
        let mut behind = first;
        let mut before = None;
        for (offset, end) in sorted {
            behind += u32::from(before.replace(offset) != Some(offset));
            self.ends[(end / 2) as usize][(end % 2) as usize] = behind - 1;
        }
        behind
    }

    /// Follows the owners of each piece of a heap. The ends of placements cut the heap into pieces.
    fn follow(&mut self, placed: &PlacedResources, by_first_step: &[PhysicalIndex], heap: u32) {
        let Some([first_piece, end_piece]) = self.heaps.last().copied() else { return };
        let mut owners = vec![NEVER; (end_piece - first_piece) as usize];
        let mut from_frame_before: Vec<(PhysicalIndex, u32)> = Vec::with_capacity(owners.len());
        let mut known: Vec<PhysicalIndex> = Vec::with_capacity(8);
        let is_here = |resource: &&PhysicalIndex| {
            placed.placements[**resource as usize].as_ref().is_some_and(|it| it.heap == heap)
        };
        for resource in by_first_step.iter().filter(is_here) {
            let [first, end] = self.ends[*resource as usize];
            let (first, end) = (first - first_piece, end - first_piece);
            known.clear();
            for (owner, piece) in owners[first as usize..end as usize].iter_mut().zip(first..) {
                let owner = std::mem::replace(owner, *resource);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Heap, Placement, StepId};

    /// Placements in one heap, each by its offset and bytes.
    fn placed(places: [(u64, u64); 3]) -> PlacedResources {
        let placement = |(offset, bytes)| {
            Some(Placement { heap: 0, offset, bytes, alignment: 1, type_bits: 1, lifetime: [StepId(0); 2] })
        };
        let bytes = places.iter().map(|(offset, bytes)| offset + bytes).max().unwrap_or(0);
        PlacedResources {
            heaps: vec![Heap { bytes, alignment: 1, type_bits: 1, lazily_allocated: false }],
            placements: places.map(placement).to_vec(),
            transient_bytes: 0,
            live_peak_bytes: bytes,
            kept_bytes: 0,
            chosen: Vec::new(),
        }
    }

    const PLACES: [(u64, u64); 3] = [(0, 4), (4, 4), (0, 8)];

    #[test]
    fn offsets_of_all_sizes_give_the_same_edges() {
        let edge = |resource, from, this_frame| AliasEdge { resource, from, this_frame };
        let expected = [edge(2, 0, true), edge(2, 1, true), edge(0, 2, false), edge(1, 2, false)];
        let times = |factor| PLACES.map(|(offset, bytes)| (offset * factor, bytes * factor));
        // Two that are marked in one word, one in several words, and one whose offsets lie too far apart to mark them.
        for places in [times(1 << 16), times(3), [(0, 63), (63, 130), (0, 193)], times((1 << 60) + 1)] {
            assert_eq!(alias_edges(&placed(places), &[0, 1, 2]), expected, "{places:?}");
        }
    }
}
