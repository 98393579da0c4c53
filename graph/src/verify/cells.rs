//! What is known about each part of each image while the walk goes on.
//!
//! Parts that every range of the Plan names together are one cell: an image that is only used as a whole has one, a mip
//! chain that is built level by level has one a level. So the work grows with what the Plan tells apart, not with the
//! number of subresources.

use super::clocks::{Availability, Time};
use super::scopes::{PairSet, STAGES, StageSet};
use crate::plan::{Image, ImageId, Subresources};
use crate::vocabulary::{Aspects, Layout};

/// Accesses, layout and contents of one part of an image.
#[derive(Debug, Clone)]
pub(super) struct Cell {
    /// The layout it is in.
    pub(super) layout: Layout,
    /// The last writes: one entry for each pair of the step that wrote last, or one layout change.
    pub(super) writes: Vec<Write>,
    /// Reads since then: the last one of each stage.
    pub(super) reads: Reads,
    /// Whether there is something to read.
    pub(super) contents: Contents,
    /// When contents were last written; 0 for never.
    pub(super) filled: Time,
    /// A mistake was reported that concerns the last writes: what follows from it isn't reported again.
    pub(super) excused: bool,
    /// The last scope that wrote it as an attachment: what else that scope does to it follows in rasterisation order.
    pub(super) rasterised: Time,
    /// Which occupation of the image's memory it belongs to; 0 for none yet.
    pub(super) occupation: u32,
}

/// A write, or a layout change.
#[derive(Debug, Clone, Copy)]
pub(super) struct Write {
    /// When.
    pub(super) time: Time,
    pair: Option<u8>,
    /// Pairs that image barriers have made it visible to.
    pub(super) visible: PairSet,
    /// Image barriers that it became available by.
    barriers: [Availability; Write::BARRIERS],
    count: u8,
}

impl Write {
    /// More image barriers than these on one unchanged write are forgotten: the checker then asks for a barrier more
    /// than Vulkan would, and never for one less.
    const BARRIERS: usize = 4;

    /// A write in the pair `pair`.
    pub(super) fn access(time: Time, pair: usize) -> Write {
        let none = Availability { time: 0, stages: StageSet(0) };
        Write { time, pair: Some(pair as u8), visible: PairSet(0), barriers: [none; Write::BARRIERS], count: 0 }
    }

    /// A layout change by an image barrier: available by itself, visible to what the barrier says.
    pub(super) fn layout_change(barrier: Availability, visible: PairSet) -> Write {
        let mut write = Write { pair: None, visible, ..Write::access(barrier.time, 0) };
        write.became_available(barrier);
        write
    }

    /// The pair of stage and access; `None` for a layout change.
    pub(super) fn pair(&self) -> Option<usize> {
        self.pair.map(usize::from)
    }

    pub(super) fn became_available(&mut self, barrier: Availability) {
        if let Some(place) = self.barriers.get_mut(usize::from(self.count)) {
            *place = barrier;
            self.count += 1;
        }
    }

    /// The image barriers that it became available by.
    pub(super) fn barriers(&self) -> &[Availability] {
        &self.barriers[..usize::from(self.count)]
    }
}

/// The last read of each stage.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Reads {
    stages: StageSet,
    times: [Time; STAGES],
}

impl Reads {
    pub(super) fn insert(&mut self, stages: StageSet, time: Time) {
        self.stages = StageSet(self.stages.0 | stages.0);
        stages.iter().for_each(|stage| self.times[stage] = time);
    }

    /// Stages with their last read.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, Time)> {
        self.stages.iter().map(|stage| (stage, self.times[stage]))
    }

    pub(super) fn clear(&mut self) {
        self.stages = StageSet(0);
    }
}

/// Whether there is something to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contents {
    /// Yes.
    Defined,
    /// Nothing in this frame has written it.
    Unwritten,
    /// It was written, then lost.
    Lost(Lost, Time),
}

/// How contents were lost, see [`super::Loss`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lost {
    Forgotten,
    NotLoaded,
    NotStored,
    Taken(ImageId),
}

/// The cells of all images.
#[derive(Debug, Default)]
pub(super) struct Cells {
    cells: Vec<Cell>,
    first: Vec<usize>,
    grids: Vec<Option<Box<Grid>>>,
}

/// Where the cells of an image are cut.
#[derive(Debug, Clone)]
struct Grid {
    /// First level of each part, rising, then the number of levels.
    mips: Vec<u32>,
    /// First layer of each part, rising, then the number of layers.
    layers: Vec<u32>,
    /// Planes.
    planes: Vec<Aspects>,
}

/// The cells that a range covers: indices, without borrowing anything.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cover {
    first: usize,
    mips: [usize; 2],
    layers: [usize; 2],
    planes: [usize; 2],
    pitch: [usize; 2],
    next: usize,
}

impl Grid {
    fn whole(image: &Image) -> Grid {
        let planes = image.format.aspects().iter().collect();
        Grid { mips: vec![0, image.mips], layers: vec![0, image.layers], planes }
    }

    fn count(&self) -> usize {
        (self.mips.len() - 1) * (self.layers.len() - 1) * self.planes.len()
    }
}

impl Cells {
    /// Cells for `images`, cut so that each of `ranges` is made of whole cells. Ranges lie within their images.
    pub(super) fn new(images: &[Image], ranges: impl Iterator<Item = (ImageId, Subresources)>) -> Cells {
        let mut grids: Vec<Option<Box<Grid>>> = vec![None; images.len()];
        for (id, range) in ranges {
            let image = &images[id.0 as usize];
            if range != Subresources::all(image.format, image.mips, image.layers) {
                let grid = grids[id.0 as usize].get_or_insert_with(|| Box::new(Grid::whole(image)));
                grid.mips.extend([range.base_mip, range.base_mip + range.mips]);
                grid.layers.extend([range.base_layer, range.base_layer + range.layers]);
            }
        }
        let mut cells = Cells { grids, ..Cells::default() };
        let fresh = Cell {
            layout: Layout::Undefined,
            writes: Vec::new(),
            reads: Reads::default(),
            contents: Contents::Unwritten,
            filled: 0,
            excused: false,
            rasterised: 0,
            occupation: 0,
        };
        for grid in &mut cells.grids {
            cells.first.push(cells.cells.len());
            let count = grid.as_mut().map_or(1, |grid| {
                for cuts in [&mut grid.mips, &mut grid.layers] {
                    cuts.sort_unstable();
                    cuts.dedup();
                }
                grid.count()
            });
            cells.cells.extend(std::iter::repeat_n(fresh.clone(), count));
        }
        cells
    }

    /// The cell numbered `index`.
    pub(super) fn at(&mut self, index: usize) -> &mut Cell {
        &mut self.cells[index]
    }

    /// Cells of a part of an image.
    pub(super) fn cover(&self, image: ImageId, range: Subresources) -> Cover {
        let first = self.first[image.0 as usize];
        let Some(grid) = &self.grids[image.0 as usize] else {
            return Cover { first, mips: [0, 1], layers: [0, 1], planes: [0, 1], pitch: [1, 1], next: 0 };
        };
        let part = |cuts: &[u32], base: u32, count: u32| {
            let start = cuts.partition_point(|cut| *cut < base);
            [start, cuts.partition_point(|cut| *cut < base + count) - start]
        };
        let planes = grid.planes.iter().filter(|plane| range.aspects.intersects(**plane)).count();
        let start = grid.planes.iter().take_while(|plane| !range.aspects.intersects(**plane)).count();
        Cover {
            first,
            mips: part(&grid.mips, range.base_mip, range.mips),
            layers: part(&grid.layers, range.base_layer, range.layers),
            planes: [start, planes],
            pitch: [grid.mips.len() - 1, grid.layers.len() - 1],
            next: 0,
        }
    }

    /// Every cell of an image.
    pub(super) fn all(&self, image: ImageId) -> std::ops::Range<usize> {
        let next = self.first.get(image.0 as usize + 1).copied().unwrap_or(self.cells.len());
        self.first[image.0 as usize]..next
    }

    /// The part of `image` that a cell stands for.
    pub(super) fn range(&self, image: &Image, cell: usize) -> Subresources {
        let Some(grid) = &self.grids[image.id.0 as usize] else {
            return Subresources::all(image.format, image.mips, image.layers);
        };
        let index = cell - self.first[image.id.0 as usize];
        let [mips, layers] = [grid.mips.len() - 1, grid.layers.len() - 1];
        let (mip, layer) = (index % mips, index / mips % layers);
        Subresources {
            aspects: grid.planes[index / (mips * layers)],
            base_mip: grid.mips[mip],
            mips: grid.mips[mip + 1] - grid.mips[mip],
            base_layer: grid.layers[layer],
            layers: grid.layers[layer + 1] - grid.layers[layer],
        }
    }
}

impl Iterator for Cover {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        let [mips, layers] = [self.mips[1], self.layers[1]];
        let index = self.next;
        if index >= mips * layers * self.planes[1] {
            return None;
        }
        self.next += 1;
        let (mip, layer, plane) = (index % mips, index / mips % layers, index / (mips * layers));
        let row = (self.planes[0] + plane) * self.pitch[1] + self.layers[0] + layer;
        Some(self.first + row * self.pitch[0] + self.mips[0] + mip)
    }
}
