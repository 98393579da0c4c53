//! What each operation does to which cells, as far as orders depend on it: spelled out once, since it is walked often.

use crate::compile::model::{Adapted, CellIndex};
use crate::compile::parts::Grids;
use crate::vulkan::Layout;

/// What an operation does to a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub(super) cell: CellIndex,
    pub(super) writes: bool,
    pub(super) layout: Layout,
}

/// What all operations do.
#[derive(Debug)]
pub(super) struct Touches {
    list: Vec<Touch>,
    /// For each operation where its touches begin, and where the last one's end.
    starts: Vec<u32>,
    /// Number of cells.
    pub(super) cells: usize,
}

impl Touches {
    pub(super) fn of(grids: &Grids, adapted: &Adapted) -> Touches {
        let mut list: Vec<Touch> = Vec::with_capacity(adapted.uses.len());
        let mut starts = Vec::with_capacity(adapted.ops.len() + 1);
        for (op, number) in adapted.ops.iter().zip(0_u32..) {
            starts.push(list.len() as u32);
            for used in adapted.uses(number) {
                let touch = |cell| Touch { cell, writes: used.writes, layout: used.layout };
                adapted.for_each_cell(grids, used, |cell| list.push(touch(cell)));
            }
            if op.side_effect {
                // Effects that nothing shows are writes of a cell behind all others.
                list.push(Touch { cell: adapted.cells, writes: true, layout: Layout::Undefined });
            }
        }
        starts.push(list.len() as u32);
        Touches { list, starts, cells: adapted.cells as usize + 1 }
    }

    /// Those of one operation.
    pub(super) fn op(&self, op: u32) -> &[Touch] {
        &self.list[self.starts[op as usize] as usize..self.starts[op as usize + 1] as usize]
    }
}
