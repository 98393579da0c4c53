//! The demands of each kind of pass on the images and buffers that it names.

use super::Written;
use super::accesses::shader;
use crate::random_pipelines::pipeline::{
    Compute, Contents, Count, Draw, Extent, Geometry, Groups, Image, Life, Part, Pass, Pipeline, Plane, Read, Region,
    Store, StoreAccess, TRIANGLES, Thing, WORKGROUP, Work,
};
use crate::random_pipelines::texels;
use framewright_graph::frame::Blend;
use framewright_graph::vulkan::{Aspects, Format, Numeric, Shape};

/// Whether the work of a pass fits the images and buffers that it names, for any contents.
pub(super) fn fits(written: &Written, pipeline: &Pipeline, pass: &Pass) -> bool {
    let (reads, stores) = shader(pass);
    reads.iter().all(|read| read_fits(written, pipeline, *read))
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
            Work::Forward { from, to } => written.all(Thing::Image(*from)) && forward_fits(pipeline, *from, *to),
        }
}

/// Whether an image has such a part.
pub(super) fn part_fits(pipeline: &Pipeline, part: Part) -> bool {
    let image = &pipeline.images[part.image];
    let plane = part.plane == Plane::All || image.format.aspects().contains(Aspects::STENCIL);
    plane && part.mip + part.mips <= image.mips && part.layer + part.layers <= image.layers
}

/// Whether a part has one plane: shaders and attachments know no more.
fn one_plane(pipeline: &Pipeline, part: Part) -> bool {
    (part.plane == Plane::All) != pipeline.images[part.image].format.aspects().contains(Aspects::STENCIL)
}

/// Whether the depth that a pass draws can be drawn again, alone: nothing that it reads may have changed.
pub(super) fn draws_again(pass: &Pass) -> bool {
    let (reads, stores) = shader(pass);
    let Work::Draw(draw) = &pass.work else { return false };
    let plain = match draw.geometry {
        Geometry::FullScreen => true,
        Geometry::Triangles { count, vertices, indices } => {
            matches!(count, Count::Direct(..)) && vertices.is_none() && indices.is_none()
        }
    };
    let tests_stencil = draw.depth.is_some_and(|depth| depth.stencil.is_some());
    plain && !draw.custom && !tests_stencil && reads.is_empty() && stores.is_empty()
}

/// Whether something with this lifetime can be read this many frames later.
fn lasts(life: Life, frames_ago: u32) -> bool {
    frames_ago == 0 || matches!(life, Life::History(frames, _) if frames_ago <= frames)
}

fn read_fits(written: &Written, pipeline: &Pipeline, read: Read) -> bool {
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
                && (!several || per_sample || written.single(pipeline, part))
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
        let mean = mixes && samples(first) > 1 && format.numeric() == Numeric::Unorm;
        !format.is_depth() && (target.blend == Blend::Replace || !texels::is_uint(format)) && !mean
    });
    let depth = draw.depth.is_none_or(|depth| {
        let format = pipeline.images[depth.part.image].format;
        let stencil = format.aspects().contains(Aspects::STENCIL);
        let plane = if stencil { Plane::Depth } else { Plane::All };
        format.is_depth() && depth.part.plane == plane && (stencil || depth.stencil.is_none())
    });
    // Of a fragment with several samples a device may run the shader more than once.
    let once = samples(first) == 1 || draw.stores.iter().all(|store| store.access == StoreAccess::Write);
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
        && once
        && geometry
        && draw.vertex_reads <= draw.reads.len()
        && (draw.vertex_reads == 0 || draw.geometry != Geometry::FullScreen)
        && !draw.reads[..draw.vertex_reads].iter().any(|read| matches!(read, Read::Own(_)))
        && (!draw.custom
            || matches!(draw.geometry, Geometry::Triangles { count: Count::Direct(..), vertices: None, indices: None }))
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
fn store_fits(pipeline: &Pipeline, store: Store, grid: Extent, whole: bool) -> bool {
    let replaced = |covered: bool| store.access != StoreAccess::Write || (whole && covered);
    match store.region {
        Region::Image(part) => {
            let image = &pipeline.images[part.image];
            let access = match store.access {
                StoreAccess::Write => true,
                StoreAccess::Modify => texels::is_uint(image.format),
                StoreAccess::Add => image.format == Format::R32_UINT,
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

/// Texels of the first mip level of a part; layers count as depth.
pub(in crate::random_pipelines) fn size(image: &Image, part: Part) -> Extent {
    let [width, height, depth] = image.extent_of(part.mip);
    [width, height, if image.shape == Shape::D3 { depth } else { part.layers }]
}

/// A buffer with a structure is written alone, by a row of invocations.
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
