//! From a seed to a pipeline: passes are proposed at random, and kept if they may stand where they would.

mod resources;

use super::allowed::{Allowed, Kind};
use super::pipeline::{
    Compute, Contents, Count, DepthTarget, Draw, Extent, Geometry, Groups, Image, Life, Part, Pass, Pipeline, Plane,
    Read, Region, Store, StoreAccess, TRIANGLES, Target, Thing, WORKGROUP, Work,
};
use super::rng::Rng;
use super::texels;
use super::valid::{self, Written, size};
use framewright_graph::frame::{Blend, StencilState};
use framewright_graph::vulkan::{Aspects, ColorComponents, CompareOp, Shape, StencilOp};

/// How often a pass of one kind is proposed before another kind has its turn.
const PROPOSALS: u32 = 60;

/// A pipeline of about `passes` passes, always the same for the same seed, with only what is `allowed`.
#[must_use]
pub fn pipeline(seed: u64, passes: u32, allowed: &Allowed) -> Pipeline {
    let mut rng = Rng::new(seed ^ 0x5EED_0F0F);
    loop {
        // Few passes may leave nothing that can be an output.
        let made = attempt(Rng::new(rng.bits()), passes, allowed);
        if !made.outputs.is_empty() {
            return made;
        }
    }
}

fn attempt(mut rng: Rng, passes: u32, allowed: &Allowed) -> Pipeline {
    let pipeline = Pipeline { images: resources::images(&mut rng, passes, allowed), ..Pipeline::default() };
    let mut maker = Maker { written: Written::new(&pipeline), pipeline, rng, allowed, extent: [0; 3] };
    maker.pipeline.buffers = maker.buffers(passes);
    maker.written = Written::new(&maker.pipeline);
    for _ in 0..passes * 4 {
        if maker.pipeline.passes.len() as u32 == passes {
            break;
        }
        let kind = maker.kind();
        (0..PROPOSALS).any(|_| maker.try_pass(kind));
    }
    maker.write_history();
    maker.outputs();
    maker.pipeline
}

/// A pipeline that grows.
struct Maker<'a> {
    pipeline: Pipeline,
    written: Written,
    rng: Rng,
    allowed: &'a Allowed,
    /// The extent of the attachments of the draw that is being made.
    extent: Extent,
}

impl Maker<'_> {
    fn image(&mut self) -> usize {
        self.rng.below(self.pipeline.images.len() as u32) as usize
    }

    fn buffer(&mut self, contents: Contents) -> Option<usize> {
        let of: Vec<usize> = (0..self.pipeline.buffers.len())
            .filter(|buffer| self.pipeline.buffers[*buffer].contents == contents)
            .collect();
        self.rng.pick(&of).copied()
    }

    /// Some part of an image, of at most `most_mips` mip levels and `most_layers` layers.
    fn part(&mut self, image: usize, most_mips: u32, most_layers: u32) -> Part {
        let Image { mips, layers, shape, format, .. } = self.pipeline.images[image];
        let planes = [Plane::All, Plane::Depth, Plane::Depth, Plane::Stencil];
        let plane = if texels::planes(format).len() > 1 { self.rng.of(planes) } else { Plane::All };
        let mip = self.rng.below(mips);
        let mips = 1 + self.rng.below((mips - mip).min(most_mips));
        if shape == Shape::Cube && most_layers > 1 {
            return Part { image, mip, mips, layer: 0, layers, plane };
        }
        let layer = self.rng.below(layers);
        let layers = 1 + self.rng.below((layers - layer).min(most_layers));
        Part { image, mip, mips, layer, layers, plane }
    }

    /// Proposes a pass, and whether it may stand there.
    fn try_pass(&mut self, kind: Kind) -> bool {
        let Some(work) = self.propose(kind) else { return false };
        let number = self.pipeline.passes.len() as u32;
        let side_effect = self.allowed.has(Kind::SideEffect) && self.rng.one_in(20);
        let pass = Pass { number, work, side_effect };
        let may_stand = self.written.take(&self.pipeline, &pass);
        if may_stand {
            self.pipeline.passes.push(pass);
        }
        may_stand
    }

    fn kind(&mut self) -> Kind {
        self.rng.of([
            Kind::FullScreen,
            Kind::FullScreen,
            Kind::Triangles,
            Kind::Triangles,
            Kind::Compute,
            Kind::Compute,
            Kind::Compute,
            Kind::Copy,
            Kind::Blit,
            Kind::Fill,
            Kind::Forward,
            Kind::Custom,
        ])
    }

    fn propose(&mut self, kind: Kind) -> Option<Work> {
        if !self.allowed.has(kind) {
            return None;
        }
        match kind {
            Kind::FullScreen => self.draw(Geometry::FullScreen),
            Kind::Triangles => {
                let geometry = self.triangles();
                self.draw(geometry)
            }
            Kind::Compute => self.compute(),
            Kind::Custom => {
                let from = if self.rng.one_in(2) { Some(self.region()) } else { None };
                Some(Work::Custom { from, to: self.region(), value: self.rng.below(61) as u8 })
            }
            Kind::Copy => {
                let from = self.region();
                let frames_ago = self.frames_ago(match from {
                    Region::Image(part) => self.pipeline.images[part.image].life,
                    Region::Buffer(buffer) => self.pipeline.buffers[buffer].life,
                });
                let to = self.region();
                Some(Work::Copy { from, frames_ago, to })
            }
            Kind::Blit => {
                let (from, to) = (self.image(), self.image());
                Some(Work::Blit { from: self.part(from, 1, 1), to: self.part(to, 1, 1) })
            }
            Kind::Fill => {
                let to = match self.region() {
                    Region::Image(part) => Region::Image(self.part(part.image, u32::MAX, u32::MAX)),
                    buffer => buffer,
                };
                Some(Work::Fill { to, value: self.rng.below(61) as u8 })
            }
            _ => Some(Work::Forward { from: self.image(), to: self.image() }),
        }
    }

    fn region(&mut self) -> Region {
        let buffers = self.pipeline.buffers.len() as u32;
        if buffers > 0 && self.rng.one_in(3) {
            return Region::Buffer(self.rng.below(buffers) as usize);
        }
        let image = self.image();
        Region::Image(self.part(image, 1, u32::MAX))
    }

    fn triangles(&mut self) -> Geometry {
        let vertices = self.sometimes(Kind::VertexBuffer, Contents::Vertices);
        let indices = self.sometimes(Kind::IndexBuffer, Contents::Indices);
        let commands = if indices.is_some() { Contents::IndexedDraw } else { Contents::Draw };
        let count = match self.sometimes(Kind::IndirectDraw, commands) {
            Some(buffer) => Count::Indirect(buffer),
            None => Count::Direct(1 + self.rng.below(TRIANGLES), 1 + self.rng.below(3)),
        };
        Geometry::Triangles { count, vertices, indices }
    }

    fn sometimes(&mut self, kind: Kind, contents: Contents) -> Option<usize> {
        if self.allowed.has(kind) && self.rng.one_in(2) { self.buffer(contents) } else { None }
    }

    fn draw(&mut self, geometry: Geometry) -> Option<Work> {
        let before = self.attachments();
        let first = before.first().map_or_else(|| self.image(), |part| part.image);
        let samples = self.pipeline.images[first].samples;
        let discards = self.rng.one_in(6);
        let direct =
            matches!(geometry, Geometry::Triangles { count: Count::Direct(..), vertices: None, indices: None });
        let mut draw = Draw {
            geometry,
            custom: direct && self.allowed.has(Kind::Custom) && self.rng.one_in(4),
            discards,
            per_sample: samples > 1 && self.allowed.has(Kind::PerSample) && self.rng.one_in(3),
            reads: Vec::new(),
            vertex_reads: 0,
            color: Vec::new(),
            depth: None,
            stores: Vec::new(),
        };
        let part = before.first().copied().unwrap_or_else(|| self.part(first, 1, 1));
        self.extent = self.pipeline.images[first].extent_of(part.mip);
        self.attach(&mut draw, part);
        before.iter().skip(1).for_each(|part| self.attach(&mut draw, *part));
        for _ in 0..if before.is_empty() { self.rng.below(3) } else { 0 } {
            let image = self.image();
            let part = self.part(image, 1, 1);
            if self.pipeline.images[image].extent_of(part.mip) == self.extent {
                self.attach(&mut draw, part);
            }
        }
        if self.allowed.has(Kind::FragmentStores) && self.rng.one_in(8) {
            draw.stores.extend(self.store(true));
        }
        draw.reads = self.reads();
        if draw.geometry != Geometry::FullScreen && self.allowed.has(Kind::VertexRead) && self.rng.one_in(2) {
            draw.vertex_reads = self.rng.below(draw.reads.len() as u32 + 1) as usize;
        }
        if self.allowed.has(Kind::OwnPixel) && self.rng.one_in(4) {
            let image = self.image();
            draw.reads.push(Read::Own(self.part(image, 1, 1)));
        }
        Some(Work::Draw(draw))
    }

    /// The attachments of the pass before, if that draws, for every third draw: both can share a rendering scope.
    fn attachments(&mut self) -> Vec<Part> {
        let again = self.rng.one_in(3);
        match self.pipeline.passes.last() {
            Some(Pass { work: Work::Draw(draw), .. }) if again => {
                draw.color.iter().map(|target| target.part).chain(draw.depth.map(|depth| depth.part)).collect()
            }
            _ => Vec::new(),
        }
    }

    fn attach(&mut self, draw: &mut Draw, part: Part) {
        let format = self.pipeline.images[part.image].format;
        let clear = if !self.written.part(&self.pipeline, part) || self.rng.one_in(5) {
            let covers = draw.geometry == Geometry::FullScreen && self.rng.one_in(2);
            (!covers).then(|| self.rng.below(61) as u8)
        } else {
            None
        };
        if format.is_depth() {
            let test = self.rng.of([
                CompareOp::GreaterOrEqual,
                CompareOp::Greater,
                CompareOp::Less,
                CompareOp::Always,
                CompareOp::NotEqual,
            ]);
            let write = self.rng.one_in(2);
            let has_stencil = format.aspects().contains(Aspects::STENCIL);
            let part = Part { plane: if has_stencil { Plane::Depth } else { Plane::All }, ..part };
            let stencil = (has_stencil && self.rng.one_in(2)).then(|| self.stencil(part));
            draw.depth.get_or_insert(DepthTarget { part, clear, test, write, stencil });
        } else if draw.color.len() < 3 {
            let blends = self.allowed.has(Kind::Blend) && !texels::is_uint(format) && self.rng.one_in(2);
            let blend = if blends {
                self.rng.of([Blend::Additive, Blend::Alpha, Blend::Premultiplied])
            } else {
                Blend::Replace
            };
            // Where there is nothing yet, nothing can be left out. All else of a seed's pipeline is as it is without masks.
            let mut aside = self.rng.clone();
            let there = clear.is_some() || self.written.part(&self.pipeline, part);
            let channels = if there && aside.one_in(4) { aside.below(16) as u8 } else { 15 };
            let write_mask = ColorComponents::from_bits_truncate(channels);
            draw.color.push(Target { part, clear, blend, write_mask });
        }
    }

    fn stencil(&mut self, part: Part) -> StencilState {
        let there = self.written.part(&self.pipeline, Part { plane: Plane::Stencil, ..part });
        let clear = (!there || self.rng.one_in(4)).then(|| self.rng.below(61) as u8);
        let test = self.rng.of([
            CompareOp::Always,
            CompareOp::Equal,
            CompareOp::NotEqual,
            CompareOp::Less,
            CompareOp::GreaterOrEqual,
        ]);
        let pass = self.rng.of([
            StencilOp::Keep,
            StencilOp::Zero,
            StencilOp::Replace,
            StencilOp::IncrementAndClamp,
            StencilOp::DecrementAndClamp,
            StencilOp::Invert,
        ]);
        StencilState { clear, test, reference: self.rng.below(61) as u8, pass }
    }

    fn reads(&mut self) -> Vec<Read> {
        (0..self.rng.below(4)).filter_map(|_| self.read()).collect()
    }

    fn read(&mut self) -> Option<Read> {
        if self.rng.one_in(4) {
            let buffers: Vec<usize> = (0..self.pipeline.buffers.len()).collect();
            let buffer = *self.rng.pick(&buffers)?;
            let ago = self.frames_ago(self.pipeline.buffers[buffer].life);
            let uniform = self.allowed.has(Kind::Uniform) && self.rng.one_in(2);
            return Some(if uniform { Read::Uniform(buffer, ago) } else { Read::Block(buffer, ago) });
        }
        let there: Vec<usize> =
            (0..self.pipeline.images.len()).filter(|image| self.written.all(Thing::Image(*image))).collect();
        // Parts of images may be there too.
        let image = if self.rng.one_in(3) { self.image() } else { *self.rng.pick(&there)? };
        let Image { samples, life, format, .. } = self.pipeline.images[image];
        if self.allowed.has(Kind::StorageRead) && self.rng.one_in(6) {
            return Some(Read::Storage(self.part(image, 1, u32::MAX)));
        }
        let per_sample = samples > 1 && self.rng.one_in(if format.is_depth() { 2 } else { 3 });
        let part = self.part(image, u32::MAX, u32::MAX);
        Some(Read::Sampled { part, frames_ago: self.frames_ago(life), per_sample })
    }

    fn frames_ago(&mut self, life: Life) -> u32 {
        match life {
            Life::History(frames, _) if self.rng.one_in(2) => 1 + self.rng.below(frames),
            _ => 0,
        }
    }

    fn store(&mut self, image_only: bool) -> Option<Store> {
        let access = self.rng.of([StoreAccess::Write, StoreAccess::Write, StoreAccess::Modify, StoreAccess::Add]);
        let kind = if access == StoreAccess::Add { Kind::Atomics } else { Kind::Modify };
        if access != StoreAccess::Write && !self.allowed.has(kind) {
            return None;
        }
        let buffers: Vec<usize> = (0..self.pipeline.buffers.len()).collect();
        if !image_only && self.rng.one_in(3) {
            return Some(Store { region: Region::Buffer(*self.rng.pick(&buffers)?), access });
        }
        let image = self.image();
        let part = self.part(image, 1, if image_only { 1 } else { u32::MAX });
        Some(Store { region: Region::Image(part), access })
    }

    fn compute(&mut self) -> Option<Work> {
        let stores: Vec<Store> = (0..1 + self.rng.below(2)).filter_map(|_| self.store(false)).collect();
        let mut grid = [1; 3];
        let mut words = 1;
        for store in &stores {
            match store.region {
                Region::Image(part) => {
                    let size = size(&self.pipeline.images[part.image], part);
                    grid = std::array::from_fn(|axis| grid[axis].max(size[axis]));
                }
                Region::Buffer(buffer) => words = words.max(self.pipeline.buffers[buffer].words),
            }
        }
        if grid == [1; 3] {
            grid[0] = words;
        } else if grid.iter().product::<u32>() < words {
            grid[2] *= words.div_ceil(grid.iter().product());
        }
        let cover = [grid[0].div_ceil(WORKGROUP), grid[1].div_ceil(WORKGROUP), grid[2]];
        let groups = match self.rng.below(4) {
            0 if self.allowed.has(Kind::IndirectDispatch) => {
                Groups::Indirect(self.buffer(Contents::Dispatch)?, self.rng.below(13))
            }
            1 => Groups::Count(cover),
            2 => Groups::Count(cover.map(|groups| 1 + self.rng.below(groups))),
            _ => Groups::Cover,
        };
        Some(Work::Compute(Compute { grid, groups, reads: self.reads(), stores }))
    }

    /// Fills what is read of earlier frames and nothing has written yet.
    fn write_history(&mut self) {
        for thing in valid::unwritten_history(&self.pipeline, &self.written) {
            let to = match thing {
                Thing::Image(image) => {
                    let Image { mips, layers, .. } = self.pipeline.images[image];
                    Region::Image(Part { image, mip: 0, mips, layer: 0, layers, plane: Plane::All })
                }
                Thing::Buffer(buffer) => Region::Buffer(buffer),
            };
            let value = self.rng.below(61) as u8;
            let number = self.pipeline.passes.len() as u32;
            let pass = Pass { number, work: Work::Fill { to, value }, side_effect: false };
            if self.written.take(&self.pipeline, &pass) {
                self.pipeline.passes.push(pass);
            }
        }
    }

    /// Chooses what leaves the frame among what has contents.
    fn outputs(&mut self) {
        let images = (0..self.pipeline.images.len()).map(Thing::Image);
        let buffers = (0..self.pipeline.buffers.len()).map(Thing::Buffer);
        let possible: Vec<Thing> = images
            .chain(buffers)
            .filter(|thing| {
                self.written.all(*thing) && valid::is_touched(&self.pipeline, *thing) && self.leaves(*thing)
            })
            .collect();
        for _ in 0..2 + self.rng.below(4) {
            let Some(thing) = self.rng.pick(&possible).copied() else { return };
            if !self.pipeline.outputs.contains(&thing) {
                self.pipeline.outputs.push(thing);
            }
        }
    }

    /// Whether a thing can be an output: depth of several samples has no one value.
    fn leaves(&self, thing: Thing) -> bool {
        match thing {
            Thing::Image(image) => {
                let Image { format, samples, .. } = self.pipeline.images[image];
                samples == 1 || !format.is_depth()
            }
            Thing::Buffer(_) => self.allowed.has(Kind::BufferOutput),
        }
    }
}
