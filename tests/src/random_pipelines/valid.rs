//! The rules of pipeline files, part by part: which accesses a pass may make after the passes before it.

mod accesses;
mod fits;

use super::pipeline::{
    Count, Draw, Geometry, Image, Life, Part, Pass, Pipeline, Plane, Read, Region, TRIANGLES, Thing, Work,
};
use super::texels;
use accesses::{Access, How, accesses, buffers};
use framewright_graph::frame::Blend;

pub(super) use accesses::{shader, things};
pub(super) use fits::size;

/// The parts that earlier passes of the frame wrote.
#[derive(Debug, Clone)]
pub struct Written {
    /// By image, mip level, layer and plane: stencil is the second.
    images: Vec<Vec<bool>>,
    buffers: Vec<bool>,
    /// By image: an upper bound of its values, for sums.
    greatest: Vec<u64>,
    /// By image: whether all that drew its depth can be drawn again.
    redrawable: Vec<bool>,
}

/// Whether a pipeline may be so: every pass may stand where it stands, and what leaves the frame has contents.
#[must_use]
pub fn is_valid(pipeline: &Pipeline) -> bool {
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

/// Images and buffers that are read from earlier frames, and not written whole in each.
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

/// The places at which the subresources of a part are noted.
fn slots(image: &Image, part: Part) -> Vec<usize> {
    let planes: &[u32] = match part.plane {
        Plane::All => &[0, 1],
        Plane::Depth => &[0],
        Plane::Stencil => &[1],
    };
    let slot =
        |[mip, layer]: [u32; 2]| planes.iter().map(move |plane| ((mip * image.layers + layer) * 2 + plane) as usize);
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
            redrawable: vec![false; pipeline.images.len()],
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
        let valid = self.is_valid(pipeline, pass);
        let greatest = if valid { self.greatest_after(pipeline, pass) } else { None };
        let Some(greatest) = greatest else { return false };
        self.greatest = greatest;
        self.note_depth(pass);
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

    /// Notes whether depth can still be drawn again after a pass.
    fn note_depth(&mut self, pass: &Pass) {
        if let Work::Draw(Draw { depth: Some(depth), .. }) = &pass.work {
            let before = self.redrawable[depth.part.image];
            if depth.write || depth.clear.is_some() {
                self.redrawable[depth.part.image] = fits::draws_again(pass) && (depth.clear.is_some() || before);
            }
        } else {
            let written = accesses(pass).into_iter().filter(|access| access.writes);
            written.for_each(|access| self.redrawable[access.part.image] = false);
            if let Work::Forward { to, .. } = pass.work {
                self.redrawable[to] = false;
            }
        }
    }

    /// Whether the samples of an image can become one value for a shader.
    pub(super) fn single(&self, pipeline: &Pipeline, part: Part) -> bool {
        let image = &pipeline.images[part.image];
        !image.format.is_depth()
            || part.plane != Plane::Stencil && (image.resolve.is_some() || self.redrawable[part.image])
    }

    fn is_valid(&self, pipeline: &Pipeline, pass: &Pass) -> bool {
        let accesses = accesses(pass);
        let exists = accesses.iter().all(|access| fits::part_fits(pipeline, access.part));
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
            && fits::fits(self, pipeline, pass)
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
                        Blend::Alpha | Blend::Premultiplied | Blend::Equation(_) => {
                            (*greatest + new * most_layers(draw)).max(255)
                        }
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
            // Numbers that are kept from frame to frame would grow for ever.
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
