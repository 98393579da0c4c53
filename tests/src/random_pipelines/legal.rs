//! What a pass may do, given what passes before it wrote: the rules of pipeline files, part by part.

use super::pipeline::{
    Compute, Contents, Count, DepthTarget, Draw, Geometry, Groups, Image, Life, Part, Pass, Pipeline, Plane, Read, Region,
    Store, StoreAccess, TRIANGLES, Thing, WORKGROUP, Work,
};
use super::texels;
use framewright_graph::frame::{Blend, Shape};
use framewright_graph::vocabulary::{Aspects, CompareOp, StencilOp};

/// What earlier passes of the frame wrote.
#[derive(Debug, Clone)]
pub struct Written {
    /// By image, mip level, layer and plane: stencil is the second.
    images: Vec<Vec<bool>>,
    buffers: Vec<bool>,
    /// By image: an upper bound of its values, for sums.
    greatest: Vec<u64>,
}

/// How a pass accesses a part of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum How {
    Sampled,
    Storage,
    Attachment,
    Transfer,
}

/// One access to a part of an image of this frame.
struct Access {
    part: Part,
    how: How,
    reads: bool,
    writes: bool,
}

/// Whether a draw replaces every texel of its colour targets.
fn covers(draw: &Draw) -> bool {
    draw.geometry == Geometry::FullScreen
        && !draw.discards
        && draw.depth.is_none_or(|depth| depth.test == CompareOp::Always && depth.stencil.is_none())
}

/// Every access to images of this frame.
fn accesses(pass: &Pass) -> Vec<Access> {
    let mut all = Vec::new();
    let mut add = |part, how, reads, writes| all.push(Access { part, how, reads, writes });
    let (reads, stores) = shader(pass);
    for read in reads {
        match *read {
            Read::Sampled { part, frames_ago: 0, .. } | Read::Own(part) => add(part, How::Sampled, true, false),
            Read::Storage(part) => add(part, How::Storage, true, false),
            _ => {}
        }
    }
    for store in stores {
        if let Region::Image(part) = store.region {
            add(part, How::Storage, store.access != StoreAccess::Write, true);
        }
    }
    match &pass.work {
        Work::Draw(draw) => {
            for target in &draw.color {
                let keeps = target.clear.is_none() && !(covers(draw) && target.blend == Blend::Replace);
                add(target.part, How::Attachment, keeps, true);
            }
            if let Some(DepthTarget { part, clear, write, stencil, .. }) = draw.depth {
                add(part, How::Attachment, clear.is_none(), write || clear.is_some());
                if let Some(stencil) = stencil {
                    let writes = stencil.clear.is_some() || stencil.pass != StencilOp::Keep;
                    let part = Part { plane: Plane::Stencil, ..part };
                    add(part, How::Attachment, stencil.clear.is_none(), writes);
                }
            }
        }
        Work::Copy { .. } | Work::Custom { .. } => {
            let (from, to) = copied(pass);
            if let Some(Region::Image(part)) = from {
                add(part, How::Transfer, true, false);
            }
            if let Some(Region::Image(part)) = to {
                add(part, How::Transfer, false, true);
            }
        }
        Work::Blit { from, to } => {
            add(*from, How::Transfer, true, false);
            add(*to, How::Transfer, false, true);
        }
        Work::Fill { to: Region::Image(part), .. } => add(*part, How::Transfer, false, true),
        Work::Fill { .. } | Work::Forward { .. } | Work::Compute(_) => {}
    }
    all
}

/// What a copy or a custom pass reads and writes.
fn copied(pass: &Pass) -> (Option<Region>, Option<Region>) {
    match pass.work {
        Work::Copy { from, frames_ago, to } => ((frames_ago == 0).then_some(from), Some(to)),
        Work::Custom { from, to, .. } => (from, Some(to)),
        _ => (None, None),
    }
}

/// What a pass's shaders read and write beside attachments.
pub(super) fn shader(pass: &Pass) -> (&[Read], &[Store]) {
    match &pass.work {
        Work::Draw(Draw { reads, stores, .. }) | Work::Compute(Compute { reads, stores, .. }) => (reads, stores),
        _ => (&[], &[]),
    }
}

/// Every buffer of this frame that a pass accesses: which, whether it reads and writes it.
fn buffers(pass: &Pass) -> Vec<(usize, bool, bool)> {
    let mut all = Vec::new();
    let (reads, stores) = shader(pass);
    for read in reads {
        if let Read::Uniform(buffer, 0) | Read::Block(buffer, 0) = *read {
            all.push((buffer, true, false));
        }
    }
    for store in stores {
        if let Region::Buffer(buffer) = store.region {
            all.push((buffer, store.access != StoreAccess::Write, true));
        }
    }
    match &pass.work {
        Work::Draw(Draw { geometry: Geometry::Triangles { count, vertices, indices }, .. }) => {
            let counts = if let Count::Indirect(buffer) = count { Some(*buffer) } else { None };
            all.extend([*vertices, *indices, counts].into_iter().flatten().map(|buffer| (buffer, true, false)));
        }
        Work::Compute(Compute { groups: Groups::Indirect(buffer, _), .. }) => all.push((*buffer, true, false)),
        Work::Copy { .. } | Work::Custom { .. } => {
            let (from, to) = copied(pass);
            if let Some(Region::Buffer(buffer)) = from {
                all.push((buffer, true, false));
            }
            if let Some(Region::Buffer(buffer)) = to {
                all.push((buffer, false, true));
            }
        }
        Work::Fill { to: Region::Buffer(buffer), .. } => all.push((*buffer, false, true)),
        _ => {}
    }
    all
}

/// Every image and buffer that a pass names, of this frame or of earlier ones.
pub(super) fn things(pass: &Pass) -> Vec<Thing> {
    let mut all: Vec<Thing> = accesses(pass).into_iter().map(|access| Thing::Image(access.part.image)).collect();
    all.extend(buffers(pass).into_iter().map(|(buffer, ..)| Thing::Buffer(buffer)));
    for read in shader(pass).0 {
        all.push(match *read {
            Read::Sampled { part, .. } | Read::Own(part) | Read::Storage(part) => Thing::Image(part.image),
            Read::Uniform(buffer, _) | Read::Block(buffer, _) => Thing::Buffer(buffer),
        });
    }
    match pass.work {
        Work::Forward { from, to } => all.extend([Thing::Image(from), Thing::Image(to)]),
        Work::Copy { from: Region::Image(part), .. } => all.push(Thing::Image(part.image)),
        Work::Copy { from: Region::Buffer(buffer), .. } => all.push(Thing::Buffer(buffer)),
        _ => {}
    }
    all
}

/// Whether a pipeline may be so: every pass may stand where it stands, and what leaves the frame has contents.
#[must_use]
pub fn is_legal(pipeline: &Pipeline) -> bool {
    let mut written = Written::new(pipeline);
    let sound = |image: &Image| {
        let levels = image.extent.iter().max().map_or(0, |side| u32::BITS - side.leading_zeros());
        image.mips <= levels
    };
    pipeline.images.iter().all(sound)
        && !pipeline.outputs.is_empty()
        && pipeline.passes.iter().all(|pass| written.take(pipeline, pass))
        && pipeline.outputs.iter().all(|output| written.all(*output) && is_touched(pipeline, *output))
        && unwritten_history(pipeline, &written).is_empty()
}

/// Whether a pass writes a thing, or part of it.
pub(super) fn is_touched(pipeline: &Pipeline, thing: Thing) -> bool {
    pipeline.passes.iter().any(|pass| match thing {
        Thing::Image(image) => {
            accesses(pass).iter().any(|access| access.writes && access.part.image == image)
                || matches!(pass.work, Work::Forward { to, .. } if to == image)
        }
        Thing::Buffer(buffer) => buffers(pass).iter().any(|(of, _, writes)| *of == buffer && *writes),
    })
}

/// What is read of earlier frames, and not written whole in each.
pub(super) fn unwritten_history(pipeline: &Pipeline, written: &Written) -> Vec<Thing> {
    let earlier = |read: &Read| match *read {
        Read::Sampled { part, frames_ago: 1.., .. } => Some(Thing::Image(part.image)),
        Read::Uniform(buffer, 1..) | Read::Block(buffer, 1..) => Some(Thing::Buffer(buffer)),
        _ => None,
    };
    let copied = pipeline.passes.iter().filter_map(|pass| match pass.work {
        Work::Copy { from: Region::Image(part), frames_ago: 1.., .. } => Some(Thing::Image(part.image)),
        Work::Copy { from: Region::Buffer(buffer), frames_ago: 1.., .. } => Some(Thing::Buffer(buffer)),
        _ => None,
    });
    let read = pipeline.passes.iter().flat_map(|pass| shader(pass).0).filter_map(earlier).chain(copied);
    let mut unwritten: Vec<Thing> = read.filter(|thing| !written.all(*thing)).collect();
    unwritten.sort_unstable();
    unwritten.dedup();
    unwritten
}

/// The greatest value that is written to an image without blending.
fn plain(image: &Image) -> u64 {
    texels::mask(image.format, Blend::Replace).into()
}

/// Where the subresources of a part are noted.
fn slots(image: &Image, part: Part) -> Vec<usize> {
    let planes: &[u32] = match part.plane {
        Plane::All => &[0, 1],
        Plane::Depth => &[0],
        Plane::Stencil => &[1],
    };
    let slot = |[mip, layer]: [u32; 2]| planes.iter().map(move |plane| ((mip * image.layers + layer) * 2 + plane) as usize);
    part.subresources().flat_map(slot).collect()
}

impl Written {
    /// Before the first pass of a frame of `pipeline`.
    #[must_use]
    pub fn new(pipeline: &Pipeline) -> Written {
        let there = |life| matches!(life, Life::Persistent(_) | Life::Imported);
        let slots = |image: &Image| vec![there(image.life); (2 * image.mips * image.layers) as usize];
        Written {
            images: pipeline.images.iter().map(slots).collect(),
            buffers: pipeline.buffers.iter().map(|buffer| there(buffer.life)).collect(),
            greatest: pipeline.images.iter().map(plain).collect(),
        }
    }

    /// Whether all of a thing has contents.
    #[must_use]
    pub fn all(&self, thing: Thing) -> bool {
        match thing {
            Thing::Image(image) => self.images[image].iter().all(|written| *written),
            Thing::Buffer(buffer) => self.buffers[buffer],
        }
    }

    /// Whether all of a part has contents.
    #[must_use]
    pub fn part(&self, pipeline: &Pipeline, part: Part) -> bool {
        slots(&pipeline.images[part.image], part).into_iter().all(|slot| self.images[part.image][slot])
    }

    /// Takes note of a pass, if it may stand here; else returns false and notes nothing.
    pub fn take(&mut self, pipeline: &Pipeline, pass: &Pass) -> bool {
        let legal = self.is_legal(pipeline, pass);
        let greatest = if legal { self.greatest_after(pipeline, pass) } else { None };
        let Some(greatest) = greatest else { return false };
        self.greatest = greatest;
        for access in accesses(pass).iter().filter(|access| access.writes) {
            let image = access.part.image;
            slots(&pipeline.images[image], access.part).into_iter().for_each(|slot| self.images[image][slot] = true);
        }
        for (buffer, _, writes) in buffers(pass) {
            self.buffers[buffer] |= writes;
        }
        if let Work::Forward { to, .. } = pass.work {
            self.images[to].fill(true);
        }
        true
    }

    fn is_legal(&self, pipeline: &Pipeline, pass: &Pass) -> bool {
        let accesses = accesses(pass);
        let exists = accesses.iter().all(|access| part_fits(pipeline, access.part));
        let apart = accesses.iter().enumerate().all(|(at, one)| {
            accesses[..at].iter().all(|other| {
                // A pass may sample what it draws into, but for depth that it changes.
                let depth = |access: &Access| pipeline.images[access.part.image].format.is_depth() && access.writes;
                let shares = match (one.how, other.how) {
                    (How::Sampled, How::Sampled) => true,
                    (How::Sampled, How::Attachment) => !depth(other),
                    (How::Attachment, How::Sampled) => !depth(one),
                    _ => false,
                };
                shares || !one.part.overlaps(other.part)
            })
        });
        let buffers = buffers(pass);
        let buffers_apart = buffers
            .iter()
            .enumerate()
            .all(|(at, one)| buffers[..at].iter().all(|other| one.0 != other.0 || !(one.2 || other.2)));
        exists
            && apart
            && buffers_apart
            && accesses.iter().all(|access| !access.reads || self.part(pipeline, access.part))
            && buffers.iter().all(|(buffer, reads, _)| !reads || self.buffers[*buffer])
            && self.fits(pipeline, pass)
    }

    fn fits(&self, pipeline: &Pipeline, pass: &Pass) -> bool {
        let (reads, stores) = shader(pass);
        reads.iter().all(|read| read_fits(pipeline, *read))
            && match &pass.work {
                Work::Draw(draw) => draw_fits(pipeline, draw),
                Work::Compute(compute) => {
                    let own = reads.iter().any(|read| matches!(read, Read::Own(_)));
                    let grid = whole_grid(compute);
                    stores.iter().all(|store| store_fits(pipeline, *store, compute.grid, grid))
                        && structure_fits(pipeline, compute)
                        && !stores.is_empty()
                        && !own
                }
                Work::Copy { from, frames_ago, to } => copy_fits(pipeline, *from, *frames_ago, *to),
                Work::Blit { from, to } => blit_fits(pipeline, *from, *to),
                Work::Custom { from: Some(from), to, .. } => copy_fits(pipeline, *from, 0, *to),
                Work::Fill { to, value } | Work::Custom { from: None, to, value } => fill_fits(pipeline, *to, *value),
                Work::Forward { from, to } => self.all(Thing::Image(*from)) && forward_fits(pipeline, *from, *to),
            }
    }

    /// The bounds of values after a pass; `None` if a sum might not be exact.
    fn greatest_after(&self, pipeline: &Pipeline, pass: &Pass) -> Option<Vec<u64>> {
        let mut greatest = self.greatest.clone();
        for store in shader(pass).1 {
            if let Region::Image(part) = store.region {
                greatest[part.image] = greatest[part.image].max(plain(&pipeline.images[part.image]));
            }
        }
        match &pass.work {
            Work::Draw(draw) => {
                for target in &draw.color {
                    let image = &pipeline.images[target.part.image];
                    let greatest = &mut greatest[target.part.image];
                    if let Some(clear) = target.clear.filter(|_| image.mips * image.layers == 1) {
                        *greatest = u64::from(clear) & u64::from(texels::mask(image.format, Blend::Replace));
                    }
                    let new = u64::from(texels::mask(image.format, target.blend));
                    *greatest = match target.blend {
                        Blend::Replace => (*greatest).max(new),
                        Blend::Additive => *greatest + new * most_layers(draw),
                        // Alpha may be 1, which is 255 of 255.
                        Blend::Alpha | Blend::Premultiplied => (*greatest + new * most_layers(draw)).max(255),
                    };
                }
            }
            Work::Copy { from: Region::Image(from), to: Region::Image(to), .. }
            | Work::Custom { from: Some(Region::Image(from)), to: Region::Image(to), .. }
            | Work::Blit { from, to } => {
                greatest[to.image] = greatest[to.image].max(greatest[from.image]);
            }
            Work::Forward { from, to } => greatest[*to] = greatest[*to].max(greatest[*from]),
            Work::Fill { to: Region::Image(part), .. } | Work::Custom { to: Region::Image(part), .. } => {
                greatest[part.image] = greatest[part.image].max(plain(&pipeline.images[part.image]));
            }
            _ => {}
        }
        let exact = pipeline.images.iter().zip(&greatest).all(|(image, greatest)| {
            // What is kept from frame to frame would grow for ever.
            let kept = image.life != Life::Transient;
            *greatest <= if kept { plain(image) } else { texels::limit(image.format).max(plain(image)) }
        });
        exact.then_some(greatest)
    }
}

/// How often a draw may paint one pixel.
fn most_layers(draw: &Draw) -> u64 {
    match draw.geometry {
        Geometry::FullScreen => 1,
        Geometry::Triangles { count: Count::Direct(triangles, instances), .. } => u64::from(triangles * instances),
        Geometry::Triangles { .. } => u64::from(2 * TRIANGLES),
    }
}

/// Whether an image has such a part.
fn part_fits(pipeline: &Pipeline, part: Part) -> bool {
    let image = &pipeline.images[part.image];
    let plane = part.plane == Plane::All || image.format.aspects().contains(Aspects::STENCIL);
    plane && part.mip + part.mips <= image.mips && part.layer + part.layers <= image.layers
}

/// Whether a part has one plane: shaders and attachments know no more.
fn one_plane(pipeline: &Pipeline, part: Part) -> bool {
    (part.plane == Plane::All) != pipeline.images[part.image].format.aspects().contains(Aspects::STENCIL)
}

/// Whether what lives so can be read so many frames later.
fn lasts(life: Life, frames_ago: u32) -> bool {
    frames_ago == 0 || matches!(life, Life::History(frames, _) if frames_ago <= frames)
}

fn read_fits(pipeline: &Pipeline, read: Read) -> bool {
    match read {
        Read::Sampled { part, frames_ago, per_sample } => {
            let image = &pipeline.images[part.image];
            let whole_cube = image.shape != Shape::Cube || part.layers == 6 || part.layers == 1;
            let several = image.samples > 1;
            lasts(image.life, frames_ago)
                && part_fits(pipeline, part)
                && one_plane(pipeline, part)
                && whole_cube
                && (several || !per_sample)
                && !(several && image.format.is_depth() && !per_sample)
                && !(per_sample && part.layers > 1)
        }
        Read::Own(part) => {
            let flat = pipeline.images[part.image].shape != Shape::D3;
            (part.mips, part.layers) == (1, 1) && flat && one_plane(pipeline, part)
        }
        Read::Storage(part) => storage_fits(pipeline, part),
        Read::Uniform(buffer, frames_ago) | Read::Block(buffer, frames_ago) => {
            lasts(pipeline.buffers[buffer].life, frames_ago)
        }
    }
}

/// Whether part of an image can be bound as a storage image.
fn storage_fits(pipeline: &Pipeline, part: Part) -> bool {
    let image = &pipeline.images[part.image];
    let format = image.format;
    let whole_cube = image.shape != Shape::Cube || part.layers == 6 || part.layers == 1;
    // Devices need not offer R8_UINT there.
    let possible = !format.is_depth() && format.texel_bytes() > 1;
    possible && whole_cube && image.samples == 1 && part.mips == 1
}

fn draw_fits(pipeline: &Pipeline, draw: &Draw) -> bool {
    let parts: Vec<Part> =
        draw.color.iter().map(|target| target.part).chain(draw.depth.map(|depth| depth.part)).collect();
    let Some(first) = parts.first() else { return false };
    let extent = |part: &Part| pipeline.images[part.image].extent_of(part.mip);
    let samples = |part: &Part| pipeline.images[part.image].samples;
    let attachable = |part: &Part| {
        part.mips == 1
            && part.layers == 1
            && pipeline.images[part.image].shape != Shape::D3
            && (extent(part), samples(part)) == (extent(first), samples(first))
    };
    let color = draw.color.iter().all(|target| {
        let format = pipeline.images[target.part.image].format;
        // A mean of alphas of 0 and 1 is no whole number of 255ths.
        let mixes = matches!(target.blend, Blend::Alpha | Blend::Premultiplied);
        let mean = mixes && samples(first) > 1 && format.numeric() == framewright_graph::format::Numeric::Unorm;
        !format.is_depth() && (target.blend == Blend::Replace || !texels::is_uint(format)) && !mean
    });
    let depth = draw.depth.is_none_or(|depth| {
        let format = pipeline.images[depth.part.image].format;
        let stencil = format.aspects().contains(Aspects::STENCIL);
        let plane = if stencil { Plane::Depth } else { Plane::All };
        format.is_depth() && depth.part.plane == plane && (stencil || depth.stencil.is_none())
    });
    let plain = draw.stores.is_empty()
        || (draw.geometry == Geometry::FullScreen && !draw.discards && !draw.per_sample && draw.depth.is_none());
    let of =
        |buffer: Option<usize>, contents| buffer.is_none_or(|buffer| pipeline.buffers[buffer].contents == contents);
    let geometry = match draw.geometry {
        Geometry::FullScreen => true,
        Geometry::Triangles { count, vertices, indices } => {
            let commands = if indices.is_some() { Contents::IndexedDraw } else { Contents::Draw };
            let counts = match count {
                Count::Direct(triangles, instances) => triangles <= TRIANGLES && instances <= 3,
                Count::Indirect(buffer) => of(Some(buffer), commands),
            };
            counts && of(vertices, Contents::Vertices) && of(indices, Contents::Indices)
        }
    };
    let own = draw.reads.iter().all(|read| match read {
        Read::Own(part) => {
            let image = &pipeline.images[part.image];
            extent(part) == extent(first) && !(image.samples > 1 && image.format.is_depth())
        }
        _ => true,
    });
    parts.iter().all(attachable)
        && own
        && color
        && depth
        && plain
        && geometry
        && draw.vertex_reads <= draw.reads.len()
        && (draw.vertex_reads == 0 || draw.geometry != Geometry::FullScreen)
        && !draw.reads[..draw.vertex_reads].iter().any(|read| matches!(read, Read::Own(_)))
        && (!draw.custom || matches!(draw.geometry, Geometry::Triangles { count: Count::Direct(..), vertices: None, indices: None }))
        && (!draw.per_sample || samples(first) > 1)
        && draw.stores.iter().all(|store| store_fits(pipeline, *store, extent(first), true))
}

/// Whether a dispatch is sure to have an invocation at every position of its grid.
fn whole_grid(compute: &Compute) -> bool {
    match compute.groups {
        Groups::Cover => true,
        Groups::Indirect(..) => false,
        Groups::Count([x, y, z]) => {
            let [width, height, depth] = compute.grid;
            x * WORKGROUP >= width && y * WORKGROUP >= height && z >= depth
        }
    }
}

/// Whether a store fits: what is replaced is replaced whole, by a `grid` of which every position is sure to run.
fn store_fits(pipeline: &Pipeline, store: Store, grid: Extent3, whole: bool) -> bool {
    let replaced = |covered: bool| store.access != StoreAccess::Write || (whole && covered);
    match store.region {
        Region::Image(part) => {
            let image = &pipeline.images[part.image];
            let access = match store.access {
                StoreAccess::Write => true,
                StoreAccess::Modify => texels::is_uint(image.format),
                StoreAccess::Add => image.format == framewright_graph::format::Format::R32_UINT,
            };
            storage_fits(pipeline, part) && access && replaced((0..3).all(|axis| grid[axis] >= size(image, part)[axis]))
        }
        Region::Buffer(buffer) => {
            let buffer = &pipeline.buffers[buffer];
            let access = store.access == StoreAccess::Write || buffer.contents == Contents::Words;
            access && replaced(grid.iter().product::<u32>() >= buffer.words)
        }
    }
}

type Extent3 = super::pipeline::Extent;

/// Texels of the first mip level of a part; layers count as depth.
pub(super) fn size(image: &Image, part: Part) -> Extent3 {
    let [width, height, depth] = image.extent_of(part.mip);
    [width, height, if image.shape == Shape::D3 { depth } else { part.layers }]
}

/// What has a structure is written alone, by a row of invocations.
fn structure_fits(pipeline: &Pipeline, compute: &Compute) -> bool {
    let contents = |store: &Store| match store.region {
        Region::Buffer(buffer) => pipeline.buffers[buffer].contents,
        Region::Image(_) => Contents::Words,
    };
    let structured = compute.stores.iter().any(|store| contents(store) != Contents::Words);
    let counted = match compute.groups {
        Groups::Indirect(buffer, word) => {
            let buffer = &pipeline.buffers[buffer];
            buffer.contents == Contents::Dispatch && word + 3 <= buffer.words
        }
        _ => true,
    };
    counted && (!structured || (compute.stores.len() == 1 && compute.grid[1..] == [1, 1]))
}

fn fill_fits(pipeline: &Pipeline, to: Region, value: u8) -> bool {
    match to {
        Region::Image(part) => pipeline.images[part.image].samples == 1,
        Region::Buffer(buffer) => match pipeline.buffers[buffer].contents {
            Contents::Words | Contents::Vertices => true,
            Contents::Dispatch => (1..=3).contains(&value),
            Contents::Draw | Contents::IndexedDraw => value == 0,
            Contents::Indices => false,
        },
    }
}

fn copy_fits(pipeline: &Pipeline, from: Region, frames_ago: u32, to: Region) -> bool {
    let life = match from {
        Region::Image(part) if !part_fits(pipeline, part) => return false,
        Region::Image(part) => pipeline.images[part.image].life,
        Region::Buffer(buffer) => pipeline.buffers[buffer].life,
    };
    if !lasts(life, frames_ago) {
        return false;
    }
    let beside = |part: Part, buffer: usize| {
        let image = &pipeline.images[part.image];
        let bytes = size(image, part).iter().product::<u32>() * image.format.texel_bytes() as u32;
        image.samples == 1
            && texels::is_uint(image.format)
            && part.mips == 1
            && pipeline.buffers[buffer].contents == Contents::Words
            && pipeline.buffers[buffer].words * 4 == bytes
    };
    match (from, to) {
        (Region::Image(from), Region::Image(to)) => {
            let (source, target) = (&pipeline.images[from.image], &pipeline.images[to.image]);
            // Lavapipe copies depth and stencil when asked for one of them.
            let planes = from.plane == Plane::All && to.plane == Plane::All;
            from.mips == 1
                && to.mips == 1
                && planes
                && (source.format, source.samples) == (target.format, target.samples)
                && (source.shape == Shape::D3) == (target.shape == Shape::D3)
                && size(source, from) == size(target, to)
        }
        (Region::Buffer(from), Region::Buffer(to)) => {
            let (source, target) = (&pipeline.buffers[from], &pipeline.buffers[to]);
            (from != to || frames_ago > 0) && (source.words, source.contents) == (target.words, target.contents)
        }
        (Region::Image(part), Region::Buffer(buffer)) | (Region::Buffer(buffer), Region::Image(part)) => {
            beside(part, buffer)
        }
    }
}

/// Upwards by any factor and downwards by 3 no position lies on the border of two texels.
fn blit_fits(pipeline: &Pipeline, from: Part, to: Part) -> bool {
    let (source, target) = (&pipeline.images[from.image], &pipeline.images[to.image]);
    let (size_from, size_to) = (size(source, from), size(target, to));
    let exact = |axis: usize| size_to[axis].is_multiple_of(size_from[axis]) || (size_to[axis] * 3 == size_from[axis]);
    let plain = |image: &Image| image.samples == 1 && image.shape != Shape::D3 && !image.format.is_depth();
    plain(source)
        && plain(target)
        && source.format == target.format
        && from.layers == to.layers
        && (from.mips, to.mips) == (1, 1)
        && exact(0)
        && exact(1)
}

fn forward_fits(pipeline: &Pipeline, from: usize, to: usize) -> bool {
    let [source, target] = [from, to].map(|image| &pipeline.images[image]);
    let alike = |image: &Image| (image.format, image.extent, image.mips, image.layers, image.shape);
    let resolves = source.samples > target.samples && !source.format.is_depth();
    from != to
        && alike(source) == alike(target)
        && (source.mips, source.layers, source.shape) == (1, 1, Shape::D2)
        && (source.samples == target.samples || resolves)
        && source.life == Life::Transient
        && target.life == Life::Transient
}
