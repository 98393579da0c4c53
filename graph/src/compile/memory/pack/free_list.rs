//! A free list: memory from offset 0 upwards, cut into ranges that are allocated or free. Allocating and freeing take
//! constant time.
//!
//! Ranges are linked in the order of offsets, so that a free one finds its neighbours. Free ones are listed by size, eight
//! lists for each power of two.

use super::block::align;

/// Lists for each power of two, as a power of two.
const FINE_BITS: u32 = 3;
/// Free ranges of a list that are looked at for the smallest that fits.
const LOOKED_AT: usize = 16;
/// No range; an empty list.
pub(super) const NONE: u32 = u32::MAX;
/// Marks a range that is in no list of free ranges: allocated, fresh, or joined to another.
const TAKEN: u32 = u32::MAX - 1;

/// One piece of memory.
#[derive(Debug, Clone, Copy)]
struct Range {
    offset: u64,
    bytes: u64,
    /// The neighbours by offset.
    below: u32,
    above: u32,
    /// The neighbour in a list of free ranges, or [`TAKEN`].
    previous: u32,
    /// The other neighbour. Allocated: the next range that is freed with it. Joined to another: the next unused index.
    next: u32,
}

impl Range {
    fn fits(&self, bytes: u64, alignment: u64) -> bool {
        self.bytes >= bytes && self.bytes - bytes >= align(self.offset, alignment) - self.offset
    }
}

/// An end of a free range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    Low,
    High,
}

/// Ranges of memory, allocated and free.
pub(super) struct FreeList {
    ranges: Vec<Range>,
    /// The first unused index: that of the last range that was joined to another.
    unused: u32,
    /// The highest range.
    top: u32,
    /// A free range in no list that was never allocated. It is allocated before those in lists.
    fresh: u32,
    /// Whether free neighbours stay apart.
    apart: bool,
    /// The first and the last of each list of free ranges.
    heads: [u32; 64 << FINE_BITS],
    tails: [u32; 64 << FINE_BITS],
    /// Which powers of two have a list that is not empty, and which of their lists.
    coarse: u64,
    fine: [u8; 64],
}

impl FreeList {
    /// Free memory of that many bytes, at least 1, which grows where it has to.
    ///
    /// Memory that was never allocated goes first, then the range that was freed first. Free neighbours stay apart as long as
    /// free ranges fit. Reserves one range for each of that many allocations; more may be
    /// needed.
    pub(super) fn spread(bytes: u64, allocations: usize) -> FreeList {
        let mut ranges = Vec::with_capacity(allocations + 2);
        ranges.push(Range { offset: 0, bytes, below: NONE, above: NONE, previous: TAKEN, next: NONE });
        FreeList {
            ranges,
            unused: NONE,
            top: 0,
            fresh: 0,
            apart: true,
            heads: [NONE; 64 << FINE_BITS],
            tails: [NONE; 64 << FINE_BITS],
            coarse: 0,
            fine: [0; 64],
        }
    }

    /// Free memory of that many bytes, at least 1, which grows where it has to. Small free ranges are allocated first.
    pub(super) fn tight(bytes: u64, allocations: usize) -> FreeList {
        let mut memory = FreeList::spread(bytes, allocations);
        memory.join_all();
        memory
    }

    /// Where a range begins.
    pub(super) fn offset(&self, range: u32) -> u64 {
        self.ranges[range as usize].offset
    }

    /// Allocates `bytes`, at least 1, at one end of the fresh range or of a small one that fits, or grows the top.
    pub(super) fn take(&mut self, bytes: u64, alignment: u64, end: End) -> u32 {
        let (at, fresh) = self.find(bytes, alignment);
        let Range { offset, bytes: size, below, above, .. } = self.ranges[at as usize];
        let mut padding = align(offset, alignment) - offset;
        let mut rest = size - padding - bytes;
        if end == End::High {
            let moved = rest - rest % alignment.max(1);
            (padding, rest) = (padding + moved, rest - moved);
        }
        self.ranges[at as usize].offset = offset + padding;
        self.ranges[at as usize].bytes = bytes;
        if padding > 0 {
            let range = Range { offset, bytes: padding, below, above: at, previous: TAKEN, next: NONE };
            self.insert(range, fresh && end == End::High);
        }
        if rest > 0 {
            let offset = offset + padding + bytes;
            let range = Range { offset, bytes: rest, below: at, above, previous: TAKEN, next: NONE };
            self.insert(range, fresh && end == End::Low);
        }
        at
    }

    /// Lets an allocated range be freed together with those of the list that begins with `head`, as the first of them.
    pub(super) fn free_together(&mut self, at: u32, head: &mut u32) {
        self.ranges[at as usize].next = std::mem::replace(head, at);
    }

    /// Frees the ranges of a list that begins with `head`.
    pub(super) fn free(&mut self, head: u32) {
        let mut at = head;
        while at != NONE {
            let next = self.ranges[at as usize].next;
            if !self.apart {
                self.join(at);
            }
            self.list(at);
            at = next;
        }
    }

    /// Joins a range, in no list, with its free neighbours.
    fn join(&mut self, at: u32) {
        let Range { below, above, .. } = self.ranges[at as usize];
        if self.is_free(below) {
            self.unlist(below);
            let joined = self.ranges[below as usize];
            self.ranges[at as usize].offset = joined.offset;
            self.ranges[at as usize].bytes += joined.bytes;
            self.link(joined.below, at);
            self.keep_index(below);
        }
        if self.is_free(above) {
            self.unlist(above);
            let joined = self.ranges[above as usize];
            self.ranges[at as usize].bytes += joined.bytes;
            self.link(at, joined.above);
            self.keep_index(above);
        }
    }

    /// Joins all free neighbours, and from now on each range that is freed.
    fn join_all(&mut self) {
        self.apart = false;
        if self.fresh != NONE {
            self.list(self.fresh);
            self.fresh = NONE;
        }
        let mut at = self.top;
        while at != NONE {
            if self.is_free(at) {
                self.unlist(at);
                self.join(at);
                self.list(at);
            }
            at = self.ranges[at as usize].below;
        }
    }

    /// A range, in no list, in which that many bytes fit, and whether it is the fresh one.
    fn find(&mut self, bytes: u64, alignment: u64) -> (u32, bool) {
        if self.fresh != NONE && self.ranges[self.fresh as usize].fits(bytes, alignment) {
            return (std::mem::replace(&mut self.fresh, NONE), true);
        }
        let mut found = self.smallest(bytes, alignment);
        if found.is_none() && self.apart {
            self.join_all();
            found = self.smallest(bytes, alignment);
        }
        match found {
            Some(at) => {
                self.unlist(at);
                (at, false)
            }
            None => (self.grow(bytes, alignment), false),
        }
    }

    /// The smallest free range found that fits, of equal ones that which was freed first.
    fn smallest(&self, bytes: u64, alignment: u64) -> Option<u32> {
        let (mut power, first) = list_of(bytes);
        let mut lists = self.fine[power] & (u8::MAX << first);
        loop {
            while lists != 0 {
                let list = power << FINE_BITS | lists.trailing_zeros() as usize;
                if let Some(found) = self.smallest_of(self.heads[list], bytes, alignment) {
                    return Some(found);
                }
                lists &= lists - 1;
            }
            let higher = self.coarse & (u64::MAX << power << 1);
            if higher == 0 {
                return None;
            }
            power = higher.trailing_zeros() as usize;
            lists = self.fine[power];
        }
    }

    /// The smallest range that fits among the first of a list.
    fn smallest_of(&self, mut at: u32, bytes: u64, alignment: u64) -> Option<u32> {
        let mut found = None;
        let mut least = u64::MAX;
        for _ in 0..LOOKED_AT {
            if at == NONE {
                break;
            }
            let range = &self.ranges[at as usize];
            if range.fits(bytes, alignment) {
                if range.bytes == bytes {
                    return Some(at);
                }
                if range.bytes < least {
                    (found, least) = (Some(at), range.bytes);
                }
            }
            at = range.next;
        }
        found
    }

    /// A range at the top, in no list, in which that many bytes fit.
    fn grow(&mut self, bytes: u64, alignment: u64) -> u32 {
        if !self.is_free(self.top) {
            let Range { offset, bytes, .. } = self.ranges[self.top as usize];
            let (offset, below) = (offset + bytes, self.top);
            self.top = self.push(Range { offset, bytes: 0, below, above: NONE, previous: TAKEN, next: NONE });
            self.link(below, self.top);
        } else {
            self.unlist(self.top);
        }
        let range = &mut self.ranges[self.top as usize];
        range.bytes = align(range.offset, alignment) - range.offset + bytes;
        self.top
    }

    /// Adds a free range between two others, neither of them in a list.
    fn insert(&mut self, range: Range, fresh: bool) {
        let at = self.push(range);
        self.link(range.below, at);
        self.link(at, range.above);
        if fresh {
            self.fresh = at;
        } else {
            self.list(at);
        }
    }

    fn push(&mut self, range: Range) -> u32 {
        let at = self.unused;
        if at == NONE {
            self.ranges.push(range);
            return self.ranges.len() as u32 - 1;
        }
        self.unused = std::mem::replace(&mut self.ranges[at as usize], range).next;
        at
    }

    /// Keeps the index of a range that was joined to another, for a new one.
    fn keep_index(&mut self, at: u32) {
        self.ranges[at as usize].next = std::mem::replace(&mut self.unused, at);
    }

    /// Makes two ranges neighbours by offset.
    fn link(&mut self, below: u32, above: u32) {
        if below != NONE {
            self.ranges[below as usize].above = above;
        }
        if above != NONE {
            self.ranges[above as usize].below = below;
        } else {
            self.top = below;
        }
    }

    fn is_free(&self, at: u32) -> bool {
        at != NONE && self.ranges[at as usize].previous != TAKEN
    }

    /// Puts a range last in the list of its size.
    fn list(&mut self, at: u32) {
        let (power, fine) = list_of(self.ranges[at as usize].bytes);
        let list = power << FINE_BITS | fine;
        let previous = std::mem::replace(&mut self.tails[list], at);
        self.ranges[at as usize].previous = previous;
        self.ranges[at as usize].next = NONE;
        if previous == NONE {
            self.heads[list] = at;
            self.coarse |= 1 << power;
            self.fine[power] |= 1 << fine;
        } else {
            self.ranges[previous as usize].next = at;
        }
    }

    /// Takes a range out of its list.
    fn unlist(&mut self, at: u32) {
        let Range { bytes, previous, next, .. } = self.ranges[at as usize];
        self.ranges[at as usize].previous = TAKEN;
        if previous != NONE && next != NONE {
            self.ranges[previous as usize].next = next;
            self.ranges[next as usize].previous = previous;
            return;
        }
        let (power, fine) = list_of(bytes);
        let list = power << FINE_BITS | fine;
        match next {
            NONE => self.tails[list] = previous,
            _ => self.ranges[next as usize].previous = previous,
        }
        match previous {
            NONE => self.heads[list] = next,
            _ => self.ranges[previous as usize].next = next,
        }
        if self.heads[list] == NONE {
            self.fine[power] &= !(1 << fine);
            if self.fine[power] == 0 {
                self.coarse &= !(1 << power);
            }
        }
    }
}

/// The list for ranges of that many bytes, at least 1: the power of two that they reach, and the eighth above it.
fn list_of(bytes: u64) -> (usize, usize) {
    let power = bytes.ilog2();
    let fine = if power >= FINE_BITS { bytes >> (power - FINE_BITS) } else { bytes << (FINE_BITS - power) };
    (power as usize, fine as usize & ((1 << FINE_BITS) - 1))
}
