//! Parts of images that are tracked by themselves: planes, and the mip levels and layers that accesses tell apart.
//!
//! An image that is only ever used whole is one part. Else its planes, mip levels and layers are cut where an access begins
//! or ends, and each piece of that grid is a part.

use crate::frame::{Access, BufferIndex, Effect, Frame, Image, ImageIndex, Pass, Resource, VisitAccess};
use crate::vulkan::{Aspects, Subresources};
use std::ops::Range;
use std::sync::Arc;

/// How one image is cut. Parts are numbered plane by plane, in each mip level by mip level, in each layer by layer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Grid {
    planes: Aspects,
    /// Where mip levels are cut: rising, from 0 to their number.
    mips: Vec<u32>,
    /// Where layers are cut: rising, from 0 to their number.
    layers: Vec<u32>,
}

/// How all images are cut.
#[derive(Debug, Default)]
pub(super) struct Grids {
    grids: Vec<Arc<Grid>>,
    /// For each image of the frame its grid, [`WHOLE`] if it is one part; empty if all are.
    of: Vec<u32>,
}

/// The grid of an image that is one part.
const WHOLE: u32 = u32::MAX;

impl Grids {
    /// Cuts images as the passes of `frame` use them; ranges must lie inside their images.
    pub(super) fn new(frame: &Frame) -> Grids {
        let mut grids = Grids::default();
        if !frame.images.iter().any(can_be_cut) {
            return grids;
        }
        for (image, number) in frame.images.iter().zip(0_u32..) {
            if image.format.aspects().bits().count_ones() > 1 {
                grids.grid(frame, ImageIndex(number), image);
            }
        }
        for pass in &frame.passes {
            pass.accesses().for_each(|access| {
                if let (Some(image), range) = (access.image_index(), access.range())
                    && !range.is_whole()
                {
                    grids.cut(frame, image, range);
                }
            });
            grids.cut_copies(frame, pass);
        }
        grids
    }

    fn grid(&mut self, frame: &Frame, index: ImageIndex, image: &Image) -> &mut Grid {
        if self.of.is_empty() {
            self.of.resize(frame.images.len(), WHOLE);
        }
        let at = &mut self.of[index.0 as usize];
        if *at == WHOLE {
            *at = self.grids.len() as u32;
            let (mips, layers) = (vec![0, image.mips], vec![0, image.layers]);
            self.grids.push(Arc::new(Grid { planes: image.format.aspects(), mips, layers }));
        }
        Arc::make_mut(&mut self.grids[*at as usize])
    }

    fn cut(&mut self, frame: &Frame, index: ImageIndex, range: Subresources) {
        let image = &frame.images[index.0 as usize];
        let range = image.part(range);
        if range == image.whole() {
            return;
        }
        let grid = self.grid(frame, index, image);
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
    fn cut_copies(&mut self, frame: &Frame, pass: &Pass) {
        for sampled in &pass.sampled {
            let written = pass.color.iter().any(|target| target.image == sampled.image)
                || pass.storage.iter().any(|storage| storage.image == sampled.image);
            let mips = frame.images[sampled.image.0 as usize].mips;
            if written && mips > 1 {
                for base_mip in 0..mips {
                    let level = Subresources { base_mip, mips: 1, ..Subresources::WHOLE };
                    self.cut(frame, sampled.image, level);
                }
            }
        }
    }

    /// How an image of the frame is cut; `None`: it is one part.
    pub(super) fn of(&self, image: ImageIndex) -> Option<&Arc<Grid>> {
        let at = *self.of.get(image.0 as usize)?;
        self.grids.get(at as usize)
    }
}

/// The parts of all images, then the buffers, each of which is one part, by number.
pub(super) struct Parts<'f> {
    frame: &'f Frame,
    grids: &'f Grids,
    /// For each image its first part, and that of the first buffer; empty if each image is one part, and has its number.
    firsts: Vec<u32>,
}

impl<'f> Parts<'f> {
    pub(super) fn new(frame: &'f Frame, grids: &'f Grids) -> Parts<'f> {
        let mut firsts = Vec::new();
        if !grids.grids.is_empty() {
            let mut first = 0;
            for number in 0..frame.images.len() as u32 {
                firsts.push(first);
                first += grids.of(ImageIndex(number)).map_or(1, |grid| grid.len());
            }
            firsts.push(first);
        }
        Parts { frame, grids, firsts }
    }

    /// Number of parts.
    pub(super) fn len(&self) -> usize {
        self.first(Resource::Buffer(BufferIndex(self.frame.buffers.len() as u32))) as usize
    }

    /// The first part of an image or buffer.
    #[inline]
    fn first(&self, resource: Resource) -> u32 {
        match resource {
            Resource::Image(image) if self.firsts.is_empty() => image.0,
            Resource::Image(image) => self.firsts[image.0 as usize],
            Resource::Buffer(buffer) => {
                self.firsts.last().map_or(self.frame.images.len() as u32, |first| *first) + buffer.0
            }
        }
    }

    /// How an image is cut; `None`: it is one part.
    #[inline]
    fn grid(&self, image: ImageIndex) -> Option<&'f Arc<Grid>> {
        // Few frames have any.
        if self.firsts.is_empty() { None } else { self.grids.of(image) }
    }

    /// All parts of an image or buffer.
    pub(super) fn of(&self, resource: Resource) -> Range<usize> {
        let first = self.first(resource) as usize;
        let count = match resource {
            Resource::Image(image) => self.grid(image).map_or(1, |grid| grid.len()),
            Resource::Buffer(_) => 1,
        };
        first..first + count as usize
    }

    /// The name of an image or buffer.
    pub(super) fn name(&self, resource: Resource) -> &'f str {
        match resource {
            Resource::Image(image) => &self.frame.images[image.0 as usize].name,
            Resource::Buffer(buffer) => &self.frame.buffers[buffer.0 as usize].name,
        }
    }

    /// The name of the image or buffer that has this part.
    pub(super) fn name_of(&self, part: u32) -> &'f str {
        let buffers = self.first(Resource::Buffer(BufferIndex(0)));
        match part.checked_sub(buffers) {
            Some(buffer) => self.name(Resource::Buffer(BufferIndex(buffer))),
            None if self.firsts.is_empty() => self.name(Resource::Image(ImageIndex(part))),
            None => {
                let image = self.firsts.partition_point(|first| *first <= part) - 1;
                self.name(Resource::Image(ImageIndex(image as u32)))
            }
        }
    }

    /// Calls `visit` with each access of a pass to a part as it is in this frame, and whether the access needs the contents,
    /// and whether it changes them.
    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    pub(super) fn for_each_access(&self, pass: &Pass, visit: impl FnMut(&Access<'_>, u32, bool, bool)) {
        pass.visit_accesses(&mut EachPart { parts: self, pass, visit });
    }
}

/// Visits accesses part by part.
struct EachPart<'p, F> {
    parts: &'p Parts<'p>,
    pass: &'p Pass,
    visit: F,
}

impl<F: FnMut(&Access<'_>, u32, bool, bool)> VisitAccess<'_> for EachPart<'_, F> {
    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    fn visit(&mut self, access: Access<'_>) {
        if access.frames_ago() > 0 {
            return;
        }
        let EachPart { parts, pass, visit } = self;
        let first = parts.first(access.resource());
        let (image, grid) = match access.resource() {
            Resource::Image(index) => (parts.frame.images.get(index.0 as usize), parts.grid(index)),
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

/// Whether an image has more than one plane, mip level and layer.
fn can_be_cut(image: &Image) -> bool {
    image.mips > 1 || image.layers > 1 || image.format.aspects().bits().count_ones() > 1
}

impl Grid {
    /// Number of parts.
    pub(super) fn len(&self) -> u32 {
        self.planes.bits().count_ones() * self.mip_rows() * self.layer_columns()
    }

    fn mip_rows(&self) -> u32 {
        self.mips.len() as u32 - 1
    }

    fn layer_columns(&self) -> u32 {
        self.layers.len() as u32 - 1
    }

    /// The parts that `range` (resolved) covers, by number.
    pub(super) fn cover(&self, range: Subresources) -> impl Iterator<Item = u32> + '_ {
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
    pub(super) fn range(&self, part: u32) -> Subresources {
        let (rows, columns) = (self.mip_rows(), self.layer_columns());
        let (layer, mip, plane) = (part % columns, part / columns % rows, part / columns / rows);
        let span = |cuts: &[u32], at: u32| (cuts[at as usize], cuts[at as usize + 1] - cuts[at as usize]);
        let ((base_mip, mips), (base_layer, layers)) = (span(&self.mips, mip), span(&self.layers, layer));
        let aspects = self.planes.iter().nth(plane as usize).unwrap_or(self.planes);
        Subresources { aspects, base_mip, mips, base_layer, layers }
    }
}

/// Joins two parts of one image into one range, if together they are one.
pub(super) fn join(a: Subresources, b: Subresources) -> Option<Subresources> {
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
