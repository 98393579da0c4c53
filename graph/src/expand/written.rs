//! Which parts of images and buffers hold something.

use super::parts::Cells;
use crate::vulkan::Aspects;
use std::collections::BTreeMap;
use std::ops::Range;

/// The parts of one image or buffer that hold something.
#[derive(Default)]
pub(super) struct Written {
    /// Whether all of it does.
    all: bool,
    /// Layers by plane and mip level, in order and apart from each other.
    rows: BTreeMap<(Aspects, u32), Vec<Range<u32>>>,
}

/// One plane, mip level and layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) plane: Aspects,
    pub(super) mip: u32,
    pub(super) layer: u32,
}

impl Cells {
    /// Whether it holds `cell`.
    pub(super) fn contains(&self, cell: Cell) -> bool {
        self.planes.contains(cell.plane) && self.mips.contains(&cell.mip) && self.layers.contains(&cell.layer)
    }
}

impl Written {
    /// Takes down that `cells` hold something; `whole` is everything that there is.
    pub(super) fn add(&mut self, cells: &Cells, whole: &Cells) {
        if self.all || cells == whole {
            *self = Written { all: true, rows: BTreeMap::new() };
            return;
        }
        for plane in cells.planes {
            for mip in cells.mips.clone() {
                let row = self.rows.entry((plane, mip)).or_default();
                let mut added = cells.layers.clone();
                row.retain(|there| {
                    let meets = there.start <= added.end && added.start <= there.end;
                    if meets {
                        added = there.start.min(added.start)..there.end.max(added.end);
                    }
                    !meets
                });
                let at = row.partition_point(|there| there.start < added.start);
                row.insert(at, added);
            }
        }
    }

    /// Whether nothing of it holds anything.
    pub(super) fn is_blank(&self) -> bool {
        !self.all && self.rows.is_empty()
    }

    /// Whether any of `cells` holds something.
    pub(super) fn has_any(&self, cells: &Cells) -> bool {
        let holds = |(plane, mip): (Aspects, u32)| {
            let row = self.rows.get(&(plane, mip)).map_or(&[][..], Vec::as_slice);
            row.iter().any(|there| there.start < cells.layers.end && cells.layers.start < there.end)
        };
        self.all || cells.mips.clone().any(|mip| cells.planes.into_iter().any(|plane| holds((plane, mip))))
    }

    /// The first of `cells` that holds nothing.
    pub(super) fn missing(&self, cells: &Cells) -> Option<Cell> {
        if self.all {
            return None;
        }
        let mips = cells.mips.clone();
        let rows = mips.flat_map(|mip| cells.planes.into_iter().map(move |plane| (plane, mip)));
        rows.into_iter().find_map(|(plane, mip)| {
            let layer = match self
                .rows
                .get(&(plane, mip))
                .and_then(|row| row.iter().find(|there| there.contains(&cells.layers.start)))
            {
                Some(there) if there.end >= cells.layers.end => return None,
                Some(there) => there.end,
                None => cells.layers.start,
            };
            Some(Cell { plane, mip, layer })
        })
    }
}
