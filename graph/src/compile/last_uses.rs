//! How something was last used, over all its parts: what is the same of many parts is said once, so that an image of many
//! parts can take over the memory of another without looking at each pair of them.

use super::model::CellIndex;
use crate::vocabulary::{Accesses, Stages};

/// The last uses of some cells that have stages and writes in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct LastUse {
    pub(super) stages: Stages,
    pub(super) writes: Accesses,
    /// The latest step.
    pub(super) last: u32,
    /// The cell that it used.
    cell: CellIndex,
    /// The latest step that used another one.
    before: Option<u32>,
}

impl LastUse {
    /// The latest step that used another cell than `cell`.
    pub(super) fn apart_from(&self, cell: CellIndex) -> Option<u32> {
        if self.cell == cell { self.before } else { Some(self.last) }
    }
}

/// The last uses of all cells: most often they are all alike.
#[derive(Debug, Clone, Default)]
pub(super) struct LastUses {
    first: Option<LastUse>,
    others: Vec<LastUse>,
}

impl LastUses {
    /// Adds how `cell` was used last, in `step`. Each cell is added once.
    pub(super) fn add(&mut self, cell: CellIndex, stages: Stages, accesses: Accesses, step: u32) {
        let writes = accesses.writes();
        match self.first.iter_mut().chain(&mut self.others).find(|it| it.stages == stages && it.writes == writes) {
            Some(same) if step > same.last => *same = LastUse { last: step, cell, before: Some(same.last), ..*same },
            Some(same) => same.before = same.before.max(Some(step)),
            None => {
                let new = LastUse { stages, writes, last: step, cell, before: None };
                match self.first {
                    None => self.first = Some(new),
                    Some(_) => self.others.push(new),
                }
            }
        }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &LastUse> {
        self.first.iter().chain(&self.others)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uses_alike_are_one_and_a_cell_is_told_from_the_others() {
        let mut uses = LastUses::default();
        for (cell, step) in [(0, 3), (1, 7), (2, 5)] {
            uses.add(cell, Stages::CLEAR, Accesses::TRANSFER_WRITE, step);
        }
        uses.add(3, Stages::COPY, Accesses::TRANSFER_READ, 9);
        let [cleared, read] = uses.iter().collect::<Vec<_>>()[..] else { panic!("two kinds of uses") };
        assert_eq!((cleared.last, cleared.apart_from(0), cleared.apart_from(1)), (7, Some(7), Some(5)));
        assert_eq!((read.writes, read.last, read.apart_from(3)), (Accesses::empty(), 9, None));
    }
}
