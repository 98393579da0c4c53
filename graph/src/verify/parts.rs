//! Which subresources stand for which parts of images.
//!
//! Parts that every range of the Plan names together are one subresource: an image that is only used as a whole has one, a mip
//! chain that is built level by level has one a level. So the work grows with what the Plan tells apart, not with the
//! number of subresources. Images and buffers are numbered in one row, buffers after images; a buffer is one subresource.

use crate::plan::{Image, Plan, Role};
use crate::vulkan::{Aspects, Subresources};
use std::collections::BTreeMap;

/// Most subresources that all images together may have, and that all ranges together may name.
const MOST_PARTS: u64 = 1 << 24;

/// A range of an image that steps name; the whole of an image or buffer is the range 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct RangeId(u32);

impl RangeId {
    /// The whole of any image or buffer.
    pub(super) const WHOLE: RangeId = RangeId(0);
}

/// Ranges that are less than their images, before they are cut.
#[derive(Debug, Default)]
pub(super) struct Ranges {
    ranges: Vec<(u32, Subresources)>,
}

/// The subresources of all images and buffers.
#[derive(Debug)]
pub(super) struct SubresourceMap {
    /// The first subresource of each image and buffer, and behind all of them the number of subresources.
    first: Vec<u32>,
    grids: BTreeMap<u32, Grid>,
    /// For each range, where its subresources stand in `listed`.
    ranges: Vec<[u32; 2]>,
    listed: Vec<u32>,
}

/// The subresources of a range: numbers, or places in a list of numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    next: u32,
    end: u32,
    listed: bool,
}

/// Where the subresources of an image are cut.
#[derive(Debug, Clone)]
struct Grid {
    /// First level of each part, rising, then the number of levels.
    mips: Vec<u32>,
    /// First layer of each part, rising, then the number of layers.
    layers: Vec<u32>,
    /// Planes.
    planes: Vec<Aspects>,
}

/// Whether two ranges of one image share anything.
pub(super) fn overlap(one: Subresources, other: Subresources) -> bool {
    let meet = |base: u32, count: u32, other_base: u32, other_count: u32| {
        base < other_base.saturating_add(other_count) && other_base < base.saturating_add(count)
    };
    one.aspects.intersects(other.aspects)
        && meet(one.base_mip, one.mips, other.base_mip, other.mips)
        && meet(one.base_layer, one.layers, other.base_layer, other.layers)
}

/// Whether a range lies within its image.
pub(super) fn fits(image: &Image, range: Subresources) -> bool {
    let within = |base: u32, count: u32, all: u32| count > 0 && base.checked_add(count).is_some_and(|end| end <= all);
    !range.aspects.is_empty()
        && image.format.aspects().contains(range.aspects)
        && within(range.base_mip, range.mips, image.mips)
        && within(range.base_layer, range.layers, image.layers)
}

/// Whether a range is all of its image.
pub(super) fn is_whole(image: &Image, range: Subresources) -> bool {
    range == Subresources::all(image.format, image.mips, image.layers)
}

impl Ranges {
    /// The number of a range that lies within its image, and is not all of it.
    pub(super) fn number(&mut self, image: u32, range: Subresources) -> RangeId {
        // Steps name the same range several times in a row.
        if self.ranges.last() != Some(&(image, range)) {
            self.ranges.push((image, range));
        }
        RangeId(self.ranges.len() as u32)
    }

    /// The range with this number; `None`: the whole of any image.
    pub(super) fn get(&self, range: RangeId) -> Option<Subresources> {
        let index = range.0.checked_sub(1)?;
        Some(self.ranges[index as usize].1)
    }
}

impl Grid {
    fn whole(image: &Image) -> Grid {
        let planes = image.format.aspects().iter().collect();
        Grid { mips: vec![0, image.mips], layers: vec![0, image.layers], planes }
    }

    fn cut(&mut self, range: Subresources) {
        self.mips.extend([range.base_mip, range.base_mip + range.mips]);
        self.layers.extend([range.base_layer, range.base_layer + range.layers]);
    }

    fn sort(&mut self) {
        for cuts in [&mut self.mips, &mut self.layers] {
            cuts.sort_unstable();
            cuts.dedup();
        }
    }

    fn count(&self) -> u64 {
        (self.mips.len() as u64 - 1) * (self.layers.len() as u64 - 1) * self.planes.len() as u64
    }

    /// The parts between cuts that lie in a range: those of levels and those of layers.
    fn within(&self, range: Subresources) -> [std::ops::Range<usize>; 2] {
        let part = |cuts: &[u32], base: u32, count: u32| {
            cuts.partition_point(|cut| *cut < base)..cuts.partition_point(|cut| *cut < base + count)
        };
        [part(&self.mips, range.base_mip, range.mips), part(&self.layers, range.base_layer, range.layers)]
    }

    /// How many subresources a range has at most.
    fn count_within(&self, range: Subresources) -> u64 {
        let [mips, layers] = self.within(range).map(|part| part.len() as u64);
        mips * layers * self.planes.len() as u64
    }

    /// Adds the subresources of `range`, counted from `first`, to `listed`.
    fn list(&self, first: u32, range: Subresources, listed: &mut Vec<u32>) {
        let [mips, layers] = [self.mips.len() - 1, self.layers.len() - 1];
        let [of_mips, of_layers] = self.within(range);
        for (plane, aspect) in self.planes.iter().enumerate() {
            if !range.aspects.intersects(*aspect) {
                continue;
            }
            for layer in of_layers.clone() {
                for mip in of_mips.clone() {
                    listed.push(first + ((plane * layers + layer) * mips + mip) as u32);
                }
            }
        }
    }
}

impl SubresourceMap {
    /// Subresources, cut so that each of `ranges` is made of whole subresources. Images that become each other are cut alike.
    /// `None`: there are too many, or they stand in too many ranges.
    pub(super) fn new(plan: &Plan, ranges: &Ranges) -> Option<SubresourceMap> {
        let mut grids = BTreeMap::new();
        for (id, range) in &ranges.ranges {
            let mut image = *id;
            loop {
                let described = &plan.images[image as usize];
                grids.entry(image).or_insert_with(|| Grid::whole(described)).cut(*range);
                match described.role {
                    Role::Persistent { becomes, .. } if becomes != *id => image = becomes,
                    _ => break,
                }
            }
        }
        grids.values_mut().for_each(Grid::sort);
        let listed = ranges.ranges.iter().map(|(image, range)| grids[image].count_within(*range));
        let counts = grids.values().map(Grid::count).chain(listed);
        if counts.fold(0, u64::saturating_add) > MOST_PARTS {
            return None;
        }
        let resources = plan.images.len() + plan.buffers.len();
        let mut first = Vec::with_capacity(resources + 1);
        let mut subresources = 0;
        for resource in 0..resources as u32 {
            first.push(subresources);
            subresources += grids.get(&resource).map_or(1, |grid| grid.count() as u32);
        }
        first.push(subresources);
        let mut parts = SubresourceMap { first, grids, ranges: vec![[0, 0]], listed: Vec::new() };
        for (image, range) in &ranges.ranges {
            let start = parts.listed.len() as u32;
            parts.grids[image].list(parts.first[*image as usize], *range, &mut parts.listed);
            parts.ranges.push([start, parts.listed.len() as u32]);
        }
        Some(parts)
    }

    /// How many subresources there are.
    pub(super) fn count(&self) -> usize {
        self.first.last().map_or(0, |subresources| *subresources as usize)
    }

    /// The subresources of a range of an image, or of a buffer.
    pub(super) fn of(&self, resource: u32, range: RangeId) -> Part {
        if range == RangeId::WHOLE {
            return self.whole(resource);
        }
        let [next, end] = self.ranges[range.0 as usize];
        Part { next, end, listed: true }
    }

    /// Every subresource of an image or buffer.
    pub(super) fn whole(&self, resource: u32) -> Part {
        Part { next: self.first[resource as usize], end: self.first[resource as usize + 1], listed: false }
    }

    /// The next subresource of a part.
    pub(super) fn next(&self, part: &mut Part) -> Option<usize> {
        let place = part.next;
        (place < part.end).then(|| {
            part.next += 1;
            if part.listed { self.listed[place as usize] as usize } else { place as usize }
        })
    }

    /// The part of `image` that a subresource stands for.
    pub(super) fn range(&self, image: &Image, subresource: usize) -> Subresources {
        let Some(grid) = self.grids.get(&image.id.0) else {
            return Subresources::all(image.format, image.mips, image.layers);
        };
        let index = subresource - self.first[image.id.0 as usize] as usize;
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
