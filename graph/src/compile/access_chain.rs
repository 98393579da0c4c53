//! The rule by which accesses to one subresource depend on each other.
//!
//! Reads in one layout stand beside each other, behind the write before them. A write stands behind all earlier accesses. So
//! does a read in another layout: the layout has to change between them.

use crate::vulkan::Layout;

/// Whether an access stands beside earlier reads, which are in the layout `last`. Else it stands behind them.
#[inline]
pub(super) fn stands_beside_reads(writes: bool, layout: Layout, last: Layout) -> bool {
    !writes && layout == last
}

/// The earlier accesses to a subresource that the next one depends on. A `T` is the place of one access or of several; the default of
/// `T` means no access.
#[derive(Debug, Clone, Copy)]
pub(super) struct AccessChain<T> {
    /// The last write. If the layout changed between reads since then: the reads before that change.
    before: T,
    /// The reads since, in one layout.
    readers: T,
    layout: Layout,
}

impl<T: Copy + Default + PartialEq> AccessChain<T> {
    /// One without accesses.
    pub(super) fn new() -> AccessChain<T> {
        AccessChain { before: T::default(), readers: T::default(), layout: Layout::Undefined }
    }

    /// The last write. If the layout changed between reads since then: the reads before that change.
    #[inline]
    pub(super) fn before(&self) -> T {
        self.before
    }

    /// The accesses that the next one depends on: [`AccessChain::before`], and the reads since, unless it can stand beside them.
    #[inline]
    pub(super) fn behind(&self, writes: bool, layout: Layout) -> [T; 2] {
        [self.before, if stands_beside_reads(writes, layout, self.layout) { T::default() } else { self.readers }]
    }

    /// Adds an access. `place` tells where it stands, together with the reads that it stands beside.
    #[inline]
    pub(super) fn add(&mut self, writes: bool, layout: Layout, place: impl FnOnce(T) -> T) {
        let none = T::default();
        if writes {
            (self.before, self.readers) = (place(none), none);
        } else if stands_beside_reads(writes, layout, self.layout) {
            self.readers = place(self.readers);
        } else {
            self.before = if self.readers == none { self.before } else { self.readers };
            self.readers = place(none);
        }
        self.layout = layout;
    }
}

/// A chain of numbers that rise along it.
impl AccessChain<u32> {
    /// The highest number that an access stands behind; 0 if there is none.
    #[inline]
    pub(super) fn highest_behind(&self, writes: bool, layout: Layout) -> u32 {
        let [before, readers] = self.behind(writes, layout);
        before.max(readers)
    }

    /// Adds an access with this number. Reads that stand beside each other have the highest of theirs.
    #[inline]
    pub(super) fn add_number(&mut self, writes: bool, layout: Layout, number: u32) {
        self.add(writes, layout, |readers| readers.max(number));
    }
}

#[cfg(test)]
mod tests {
    use super::AccessChain;
    use crate::vulkan::Layout::{General, ShaderReadOnlyOptimal as ReadOnly, TransferSrcOptimal as Source};

    #[test]
    fn reads_in_one_layout_stand_beside_each_other_and_all_else_behind_what_came_before() {
        let mut chain = AccessChain::new();
        let mut add = |number: u32, writes, layout| {
            let behind = chain.behind(writes, layout);
            assert_eq!(chain.highest_behind(writes, layout), behind[0].max(behind[1]));
            chain.add_number(writes, layout, number);
            behind
        };
        assert_eq!(add(1, false, ReadOnly), [0, 0]);
        assert_eq!(add(2, false, ReadOnly), [0, 0]);
        assert_eq!(add(3, true, General), [0, 2]);
        assert_eq!(add(4, false, General), [3, 0]);
        assert_eq!(add(5, false, ReadOnly), [3, 4]);
        assert_eq!(add(6, false, ReadOnly), [4, 0]);
        assert_eq!(add(7, false, Source), [4, 6]);
        assert_eq!(add(8, true, Source), [6, 7]);
        assert_eq!(add(9, true, Source), [8, 0]);
    }
}
