//! Parts of images that are tracked by themselves: planes, and the mip levels and layers that accesses tell apart.
//!
//! An image that is only ever used whole is one part. Else its planes, mip levels and layers are cut where an access begins
//! or ends, and each piece of that grid is a part.

use super::{Access, BufferIndex, Effect, Image, ImageIndex, Pass, Resource, VisitAccess};
use crate::vulkan::{Aspects, Subresources};
use std::ops::Range;
use std::sync::Arc;

/// How one image is cut. Parts are numbered plane by plane, in each mip level by mip level, in each layer by layer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Grid {
    planes: Aspects,
    /// Where mip levels are cut: rising, from 0 to their number.
    mips: Vec<u32>,
    /// Where layers are cut: rising, from 0 to their number.
    layers: Vec<u32>,
}

/// How all images are cut.
#[derive(Debug, Default)]
pub(crate) struct Grids {
    grids: Vec<Arc<Grid>>,
    /// For each image of the frame its grid, [`WHOLE`] if it is one part; empty if all are.
    of: Vec<u32>,
}

/// The grid of an image that is one part.
const WHOLE: u32 = u32::MAX;

impl Grids {
    /// Cuts images as `passes` use them; ranges must lie inside their images.
    pub(crate) fn new<'p>(images: &[Image], passes: impl Iterator<Item = &'p Pass>) -> Grids {
        let mut grids = Grids::default();
        if !images.iter().any(can_be_cut) {
            return grids;
        }
        for (image, number) in images.iter().zip(0_u32..) {
            if image.format.aspects().bits().count_ones() > 1 {
                grids.grid(images, ImageIndex(number), image);
            }
        }
        for pass in passes {
            pass.visit_accesses(&mut |access: Access<'_>| {
                if let (Some(image), range) = (access.image_index(), access.range())
                    && !range.is_whole()
                {
                    grids.cut(images, image, range);
                }
            });
            grids.cut_copies(images, pass);
        }
        grids
    }

    fn grid(&mut self, images: &[Image], index: ImageIndex, image: &Image) -> &mut Grid {
        if self.of.is_empty() {
            self.of.resize(images.len(), WHOLE);
        }
        let at = &mut self.of[index.0 as usize];
        if *at == WHOLE {
            *at = self.grids.len() as u32;
            let (mips, layers) = (vec![0, image.mips], vec![0, image.layers]);
            self.grids.push(Arc::new(Grid { planes: image.format.aspects(), mips, layers }));
        }
        Arc::make_mut(&mut self.grids[*at as usize])
    }

    fn cut(&mut self, images: &[Image], index: ImageIndex, range: Subresources) {
        let image = &images[index.0 as usize];
        let range = image.part(range);
        if range == image.whole() {
            return;
        }
        let grid = self.grid(images, index, image);
        for (cuts, at) in [
            (&mut grid.mips, [range.base_mip, range.base_mip + range.mips]),
            (&mut grid.layers, [range.base_layer, range.base_layer + range.layers]),
        ] {
            for at in at {
                if let Err(place) = cuts.binary_search(&at) {
                    cuts.insert(place, at);
                }
            }
        }
    }

    /// Cuts images that a pass samples while it writes them: they are copied mip level by mip level.
    fn cut_copies(&mut self, images: &[Image], pass: &Pass) {
        for sampled in &pass.sampled {
            let written = pass.color.iter().any(|target| target.image == sampled.image)
                || pass.storage.iter().any(|storage| storage.image == sampled.image);
            let mips = images[sampled.image.0 as usize].mips;
            if written && mips > 1 {
                for base_mip in 0..mips {
                    let level = Subresources { base_mip, mips: 1, ..Subresources::WHOLE };
                    self.cut(images, sampled.image, level);
                }
            }
        }
    }

    /// How an image of the frame is cut; `None`: it is one part.
    pub(crate) fn of(&self, image: ImageIndex) -> Option<&Arc<Grid>> {
        let at = *self.of.get(image.0 as usize)?;
        self.grids.get(at as usize)
    }
}

/// The parts of all images by number, then the buffers. A buffer is one part.
pub(crate) struct Parts<'f> {
    images: &'f [Image],
    buffers: u32,
    grids: &'f Grids,
    /// For each image its first part, and that of the first buffer; empty if each image is one part, and has its number.
    firsts: Vec<u32>,
}

impl<'f> Parts<'f> {
    /// Those of `images`, cut by `grids`, and of a number of buffers.
    pub(crate) fn new(images: &'f [Image], buffers: usize, grids: &'f Grids) -> Parts<'f> {
        let mut firsts = Vec::new();
        if !grids.grids.is_empty() {
            let mut first = 0;
            for number in 0..images.len() as u32 {
                firsts.push(first);
                first += grids.of(ImageIndex(number)).map_or(1, |grid| grid.len());
            }
            firsts.push(first);
        }
        Parts { images, buffers: buffers as u32, grids, firsts }
    }

    /// Number of parts.
    pub(crate) fn len(&self) -> usize {
        self.first(Resource::Buffer(BufferIndex(self.buffers))) as usize
    }

    /// The first part of an image or buffer.
    #[inline]
    fn first(&self, resource: Resource) -> u32 {
        match resource {
            Resource::Image(image) if self.firsts.is_empty() => image.0,
            Resource::Image(image) => self.firsts[image.0 as usize],
            Resource::Buffer(buffer) => self.firsts.last().map_or(self.images.len() as u32, |first| *first) + buffer.0,
        }
    }

    /// How an image is cut; `None`: it is one part.
    #[inline]
    fn grid(&self, image: ImageIndex) -> Option<&'f Arc<Grid>> {
        // Few frames have any.
        if self.firsts.is_empty() { None } else { self.grids.of(image) }
    }

    fn grid_of(&self, of: Resource) -> Option<&'f Arc<Grid>> {
        match of {
            Resource::Image(image) => self.grid(image),
            Resource::Buffer(_) => None,
        }
    }

    /// All parts of an image or buffer.
    pub(crate) fn of(&self, resource: Resource) -> Range<usize> {
        let first = self.first(resource) as usize;
        let count = self.grid_of(resource).map_or(1, |grid| grid.len());
        first..first + count as usize
    }

    /// The image or buffer that has this part.
    pub(crate) fn owner(&self, part: u32) -> Resource {
        let buffers = self.first(Resource::Buffer(BufferIndex(0)));
        match part.checked_sub(buffers) {
            Some(buffer) => Resource::Buffer(BufferIndex(buffer)),
            None if self.firsts.is_empty() => Resource::Image(ImageIndex(part)),
            None => Resource::Image(ImageIndex(self.firsts.partition_point(|first| *first <= part) as u32 - 1)),
        }
    }

    /// An image, if it is one.
    pub(crate) fn image(&self, of: Resource) -> Option<&'f Image> {
        match of {
            Resource::Image(index) => self.images.get(index.0 as usize),
            Resource::Buffer(_) => None,
        }
    }

    /// What `range` means of an image or buffer, with planes named.
    pub(crate) fn part(&self, of: Resource, range: Subresources) -> Subresources {
        part_of(self.image(of), range)
    }

    /// The parts that `range` (resolved) covers.
    pub(crate) fn cover(&self, of: Resource, range: Subresources) -> Vec<u32> {
        let first = self.first(of);
        match self.grid_of(of) {
            Some(grid) => grid.cover(range).map(|part| first + part).collect(),
            None => vec![first],
        }
    }

    /// The subresources of one of the parts of an image or buffer.
    pub(crate) fn range(&self, of: Resource, part: u32) -> Subresources {
        match self.grid_of(of) {
            Some(grid) => grid.range(part - self.first(of)),
            None => self.part(of, Subresources::WHOLE),
        }
    }

    /// Calls `visit` with each access of a pass to a part as it is in this frame, and whether the access needs the contents,
    /// and whether it changes them.
    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    pub(crate) fn for_each_access(&self, pass: &Pass, visit: impl FnMut(&Access<'_>, u32, bool, bool)) {
        pass.visit_accesses(&mut PartVisitor { parts: self, pass, visit });
    }
}

/// Visits accesses part by part.
struct PartVisitor<'p, F> {
    parts: &'p Parts<'p>,
    pass: &'p Pass,
    visit: F,
}

impl<F: FnMut(&Access<'_>, u32, bool, bool)> VisitAccess<'_> for PartVisitor<'_, F> {
    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    fn visit(&mut self, access: Access<'_>) {
        if access.frames_ago() > 0 {
            return;
        }
        let PartVisitor { parts, pass, visit } = self;
        let first = parts.first(access.resource());
        let (image, grid) = match access.resource() {
            Resource::Image(index) => (parts.images.get(index.0 as usize), parts.grid(index)),
            Resource::Buffer(_) => (None, None),
        };
        match (image, grid) {
            (Some(image), Some(grid)) => {
                access.for_each_effect(pass, Some(image), |Effect { range, reads, writes }| {
                    grid.cover(image.part(range)).for_each(|part| visit(&access, first + part, reads, writes));
                });
            }
            _ => access.for_each_effect(pass, image, |it| visit(&access, first, it.reads, it.writes)),
        }
    }
}

/// What `range` means of an image, with planes named; `None`: a buffer, which is one part.
pub(crate) fn part_of(image: Option<&Image>, range: Subresources) -> Subresources {
    let buffer = Subresources { aspects: Aspects::COLOR, base_mip: 0, mips: 1, base_layer: 0, layers: 1 };
    image.map_or(buffer, |image| image.part(range))
}

/// Whether an image has more than one plane, mip level and layer.
fn can_be_cut(image: &Image) -> bool {
    image.mips > 1 || image.layers > 1 || image.format.aspects().bits().count_ones() > 1
}

impl Grid {
    /// Number of parts.
    pub(crate) fn len(&self) -> u32 {
        self.planes.bits().count_ones() * self.mip_rows() * self.layer_columns()
    }

    fn mip_rows(&self) -> u32 {
        self.mips.len() as u32 - 1
    }

    fn layer_columns(&self) -> u32 {
        self.layers.len() as u32 - 1
    }

    /// The parts that `range` (resolved) covers, by number.
    pub(crate) fn cover(&self, range: Subresources) -> impl Iterator<Item = u32> + '_ {
        let place = |cuts: &[u32], at: u32| cuts.partition_point(|cut| *cut < at) as u32;
        let (rows, columns) = (self.mip_rows(), self.layer_columns());
        let mips = place(&self.mips, range.base_mip)..place(&self.mips, range.base_mip + range.mips);
        let layers = place(&self.layers, range.base_layer)..place(&self.layers, range.base_layer + range.layers);
        let planes = self.planes.iter().zip(0_u32..).filter(move |(plane, _)| range.aspects.contains(*plane));
        planes.flat_map(move |(_, plane)| {
            let layers = layers.clone();
            mips.clone().flat_map(move |mip| layers.clone().map(move |layer| (plane * rows + mip) * columns + layer))
        })
    }

    /// The subresources of part number `part`.
    pub(crate) fn range(&self, part: u32) -> Subresources {
        let (rows, columns) = (self.mip_rows(), self.layer_columns());
        let (layer, mip, plane) = (part % columns, part / columns % rows, part / columns / rows);
        let span = |cuts: &[u32], at: u32| (cuts[at as usize], cuts[at as usize + 1] - cuts[at as usize]);
        let ((base_mip, mips), (base_layer, layers)) = (span(&self.mips, mip), span(&self.layers, layer));
        let aspects = self.planes.iter().nth(plane as usize).unwrap_or(self.planes);
        Subresources { aspects, base_mip, mips, base_layer, layers }
    }
}

/// Joins two parts of one image into one range, if together they are one.
pub(crate) fn join(a: Subresources, b: Subresources) -> Option<Subresources> {
    let same_mips = (a.base_mip, a.mips) == (b.base_mip, b.mips);
    let same_layers = (a.base_layer, a.layers) == (b.base_layer, b.layers);
    if a.aspects == b.aspects && same_mips && a.base_layer + a.layers == b.base_layer {
        Some(Subresources { layers: a.layers + b.layers, ..a })
    } else if a.aspects == b.aspects && same_layers && a.base_mip + a.mips == b.base_mip {
        Some(Subresources { mips: a.mips + b.mips, ..a })
    } else if same_mips && same_layers && !a.aspects.intersects(b.aspects) {
        Some(Subresources { aspects: a.aspects | b.aspects, ..a })
    } else {
        None
    }
}
