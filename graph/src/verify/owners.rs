//! Which image or buffer took each byte of the heaps last.
//!
//! A heap is cut only where a placement begins or ends. So these places are sorted and numbered once, and the walk counts in
//! their numbers. Bytes with one owner are a *piece*, known by the number of the place where it begins.

use crate::plan::Placement;

/// The owners of the bytes of all heaps.
#[derive(Debug)]
pub(super) struct Owners {
    /// For each image and buffer: where its bytes begin and end. Places of several heaps are numbered in one row.
    placed: Vec<[u32; 2]>,
    /// For each place: the piece that begins there, if `begins` says that there is one.
    pieces: Vec<Piece>,
    /// For each place one bit: whether a piece begins there.
    begins: Vec<u64>,
}

/// Bytes that one image or buffer took, and nobody since.
#[derive(Debug, Clone, Copy, Default)]
struct Piece {
    end: u32,
    owner: u32,
}

impl Owners {
    /// Nobody has taken anything yet. `placements`: the transient ones among `resources` images and buffers.
    pub(super) fn new<'p>(
        heaps: usize,
        resources: usize,
        placements: impl Iterator<Item = (u32, &'p Placement)> + Clone,
    ) -> Owners {
        let mut places: Vec<Vec<u64>> = vec![Vec::new(); heaps];
        for (_, placement) in placements.clone() {
            places[placement.heap as usize].extend([placement.offset, placement.offset + placement.bytes]);
        }
        let mut first = Vec::with_capacity(places.len());
        let mut count = 0;
        for places in &mut places {
            places.sort_unstable();
            places.dedup();
            first.push(count);
            count += places.len();
        }
        let mut placed = vec![[0; 2]; resources];
        for (resource, placement) in placements {
            let heap = placement.heap as usize;
            let number = |place: u64| (first[heap] + places[heap].partition_point(|other| *other < place)) as u32;
            placed[resource as usize] = [number(placement.offset), number(placement.offset + placement.bytes)];
        }
        Owners { placed, pieces: vec![Piece::default(); count], begins: vec![0; count.div_ceil(u64::BITS as usize)] }
    }

    /// Gives an image or buffer its bytes; each one that had some of them before is added to `before`.
    pub(super) fn take(&mut self, resource: u32, before: &mut Vec<u32>) {
        let [start, end] = self.placed[resource as usize];
        let piece = &mut self.pieces[start as usize];
        if piece.end == end && self.begins[start as usize / 64] >> (start % 64) & 1 == 1 {
            let owner = std::mem::replace(&mut piece.owner, resource);
            before.extend((owner != resource).then_some(owner));
            return;
        }
        let known = before.len();
        let mut next = self.last_beginning(start).or_else(|| self.first_beginning(start));
        while let Some(from) = next.filter(|from| *from < end) {
            let Piece { end: to, owner } = self.pieces[from as usize];
            next = self.first_beginning(from + 1);
            if to <= start {
                continue;
            }
            self.remove(from);
            if from < start {
                self.insert(from, Piece { end: start, owner });
            }
            if to > end {
                self.insert(end, Piece { end: to, owner });
            }
            if owner != resource && !before[known..].contains(&owner) {
                before.push(owner);
            }
        }
        self.insert(start, Piece { end, owner: resource });
    }

    fn insert(&mut self, place: u32, piece: Piece) {
        self.pieces[place as usize] = piece;
        self.begins[place as usize / 64] |= 1 << (place % 64);
    }

    fn remove(&mut self, place: u32) {
        self.begins[place as usize / 64] &= !(1 << (place % 64));
    }

    /// The last place, at `place` or before it, where a piece begins.
    fn last_beginning(&self, place: u32) -> Option<u32> {
        let mut word = place / 64;
        let mut bits = self.begins[word as usize] & (u64::MAX >> (63 - place % 64));
        while bits == 0 {
            word = word.checked_sub(1)?;
            bits = self.begins[word as usize];
        }
        Some(word * 64 + bits.ilog2())
    }

    /// The first place, at `place` or behind it, where a piece begins.
    fn first_beginning(&self, place: u32) -> Option<u32> {
        let mut word = place as usize / 64;
        let mut bits = self.begins.get(word)? & (u64::MAX << (place % 64));
        while bits == 0 {
            word += 1;
            bits = *self.begins.get(word)?;
        }
        Some(word as u32 * 64 + bits.trailing_zeros())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::StepId;

    /// Held against one owner for each byte.
    #[test]
    fn every_byte_is_taken_from_the_one_that_took_it_last() {
        const BYTES: u64 = 200;
        let mut state = 1_u64;
        let mut random = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        let placements: Vec<Placement> = (0..150)
            .map(|_| {
                let (offset, longest) = (random(BYTES), [3, 10, BYTES][random(3) as usize]);
                let bytes = 1 + random(longest.min(BYTES - offset));
                let lifetime = [StepId(0); 2];
                Placement { heap: random(2) as u32, offset, bytes, alignment: 1, type_bits: 1, lifetime }
            })
            .collect();
        let mut owners = Owners::new(2, placements.len(), (0..).zip(&placements));
        let mut model = [[None; BYTES as usize]; 2];
        for _ in 0..5_000 {
            let resource = random(placements.len() as u64) as u32;
            let Placement { heap, offset, bytes, .. } = placements[resource as usize];
            let mut expected = Vec::new();
            for owner in &mut model[heap as usize][offset as usize..(offset + bytes) as usize] {
                let before = owner.replace(resource).filter(|before| *before != resource && !expected.contains(before));
                expected.extend(before);
            }
            let mut before = Vec::new();
            owners.take(resource, &mut before);
            assert_eq!(before, expected, "{resource} takes {offset} to {}", offset + bytes);
        }
    }
}
