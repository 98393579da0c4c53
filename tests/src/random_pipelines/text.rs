//! A random pipeline as text that a person reads: one line for each image, buffer and pass.

use super::pipeline::{
    Count, DepthTarget, Geometry, Groups, Life, Part, Pass, Pipeline, Plane, Read, Region, StoreAccess, Thing, Work,
};
use super::{to_frame, valid};
use framewright_graph::frame::{Blend, StencilState};
use framewright_graph::vulkan::{ColorComponents, Shape, name_of};
use std::fmt;

impl fmt::Display for Pipeline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let used = self.used();
        for (number, image) in
            self.images.iter().enumerate().filter(|(number, _)| used.contains(&Thing::Image(*number)))
        {
            let [width, height, depth] = image.extent;
            write!(f, "image i{number}: {} {width}×{height}", image.format)?;
            match image.shape {
                Shape::D2 => {}
                Shape::D3 => write!(f, "×{depth}")?,
                Shape::Cube => write!(f, " cube")?,
            }
            for (count, what) in [(image.mips, "mips"), (image.layers, "layers"), (image.samples, "samples")] {
                if count > 1 {
                    write!(f, ", {count} {what}")?;
                }
            }
            if let Some(mode) = image.resolve {
                write!(f, ", resolved by {mode:?}")?;
            }
            writeln!(f, "{}{}", image.life, owned(image.life, number))?;
        }
        for (number, buffer) in
            self.buffers.iter().enumerate().filter(|(number, _)| used.contains(&Thing::Buffer(*number)))
        {
            let owned = owned(buffer.life, number);
            writeln!(f, "buffer b{number}: {} words, {:?}{}{owned}", buffer.words, buffer.contents, buffer.life)?;
        }
        self.passes.iter().try_for_each(|pass| writeln!(f, "{pass}"))?;
        let outputs: Vec<String> = self.outputs.iter().map(ToString::to_string).collect();
        writeln!(f, "outputs: {}", outputs.join(", "))
    }
}

impl Pipeline {
    /// The images and buffers that a pass or an output names.
    #[must_use]
    pub fn used(&self) -> Vec<Thing> {
        let mut used: Vec<Thing> = self.passes.iter().flat_map(valid::things).chain(self.outputs.clone()).collect();
        used.sort_unstable();
        used.dedup();
        used
    }
}

/// What is said of an outside owner.
fn owned(life: Life, number: usize) -> String {
    to_frame::owner(life, number).map_or(String::new(), |owner| format!(", {} has it between frames", owner.words()))
}

impl fmt::Display for Life {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Life::Transient => Ok(()),
            Life::Persistent(value) => write!(f, ", persistent, first {value}"),
            Life::History(frames, value) => write!(f, ", history of {frames}, first {value}"),
            Life::Target => write!(f, ", imported without contents"),
            Life::Imported => write!(f, ", imported"),
        }
    }
}

impl fmt::Display for Thing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Thing::Image(image) => write!(f, "i{image}"),
            Thing::Buffer(buffer) => write!(f, "b{buffer}"),
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let span = |first: u32, count: u32| {
            if count == 1 { first.to_string() } else { format!("{first}–{}", first + count - 1) }
        };
        write!(f, "i{}[mip {}, layer {}", self.image, span(self.mip, self.mips), span(self.layer, self.layers))?;
        match self.plane {
            Plane::All => write!(f, "]"),
            Plane::Depth => write!(f, ", depth]"),
            Plane::Stencil => write!(f, ", stencil]"),
        }
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Region::Image(part) => part.fmt(f),
            Region::Buffer(buffer) => write!(f, "b{buffer}"),
        }
    }
}

impl fmt::Display for Read {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ago = |f: &mut fmt::Formatter<'_>, frames: u32| match frames {
            0 => Ok(()),
            frames => write!(f, " of {frames} frames ago"),
        };
        match self {
            Read::Sampled { part, frames_ago, per_sample } => {
                write!(f, "samples {}{part}", if *per_sample { "each sample of " } else { "" })?;
                ago(f, *frames_ago)
            }
            Read::Own(part) => write!(f, "samples its own pixel of {part}"),
            Read::Storage(part) => write!(f, "loads {part}"),
            Read::Uniform(buffer, frames_ago) => {
                write!(f, "reads uniforms b{buffer}")?;
                ago(f, *frames_ago)
            }
            Read::Block(buffer, frames_ago) => {
                write!(f, "reads b{buffer}")?;
                ago(f, *frames_ago)
            }
        }
    }
}

impl fmt::Display for Pass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "p{}: ", self.number)?;
        match &self.work {
            Work::Draw(draw) => {
                match draw.geometry {
                    Geometry::FullScreen => write!(f, "full-screen draw")?,
                    Geometry::Triangles { count, vertices, indices } => {
                        match count {
                            Count::Direct(triangles, instances) => {
                                write!(f, "draw of {triangles} triangles × {instances}")?
                            }
                            Count::Indirect(buffer) => write!(f, "draw of what b{buffer} says")?,
                        }
                        vertices.map_or(Ok(()), |buffer| write!(f, ", vertices b{buffer}"))?;
                        indices.map_or(Ok(()), |buffer| write!(f, ", indices b{buffer}"))?;
                    }
                }
                if draw.custom {
                    write!(f, ", recorded by the program")?;
                }
                if draw.discards {
                    write!(f, ", discards")?;
                }
                if draw.per_sample {
                    write!(f, ", per sample")?;
                }
                for target in &draw.color {
                    write!(f, ", color {}", target.part)?;
                    target.clear.map_or(Ok(()), |clear| write!(f, " cleared to {clear}"))?;
                    if target.blend != Blend::Replace {
                        write!(f, " blend {:?}", target.blend)?;
                    }
                    if target.write_mask != ColorComponents::RGBA {
                        write!(f, " writes {}", name_of(&target.write_mask))?;
                    }
                }
                if let Some(DepthTarget { part, clear, test, write, stencil }) = &draw.depth {
                    write!(f, ", depth {part}")?;
                    clear.map_or(Ok(()), |clear| write!(f, " cleared to {clear}"))?;
                    write!(f, " {test:?}{}", if *write { ", written" } else { "" })?;
                    if let Some(StencilState { clear, test, reference, pass }) = stencil {
                        write!(f, ", stencil")?;
                        clear.map_or(Ok(()), |clear| write!(f, " cleared to {clear}"))?;
                        write!(f, " {test:?} {reference} {pass:?}")?;
                    }
                }
            }
            Work::Compute(compute) => {
                let [x, y, z] = compute.grid;
                write!(f, "dispatch over {x}×{y}×{z}")?;
                match compute.groups {
                    Groups::Cover => {}
                    Groups::Count(groups) => write!(f, " in {groups:?} groups")?,
                    Groups::Indirect(buffer, word) => write!(f, " in groups from b{buffer}, word {word}")?,
                }
            }
            Work::Copy { from, frames_ago: 0, to } => write!(f, "copy {from} to {to}")?,
            Work::Copy { from, frames_ago, to } => write!(f, "copy {from} of {frames_ago} frames ago to {to}")?,
            Work::Blit { from, to } => write!(f, "blit {from} to {to}")?,
            Work::Fill { to, value } => write!(f, "fill {to} with {value}")?,
            Work::Custom { from: Some(from), to, .. } => write!(f, "custom copy {from} to {to}")?,
            Work::Custom { from: None, to, value } => write!(f, "custom fill {to} with {value}")?,
            Work::Forward { from, to } => write!(f, "forward i{from} to i{to}")?,
        }
        let (reads, stores) = valid::shader(self);
        let vertex_reads = if let Work::Draw(draw) = &self.work { draw.vertex_reads } else { 0 };
        for (number, read) in reads.iter().enumerate() {
            write!(f, ", {}{read}", if number < vertex_reads { "its vertex shader " } else { "" })?;
        }
        for store in stores {
            let how = match store.access {
                StoreAccess::Write => "writes",
                StoreAccess::Modify => "modifies",
                StoreAccess::Add => "adds to",
            };
            write!(f, ", {how} {}", store.region)?;
        }
        if to_frame::both_eyes(self) {
            write!(f, ", for both eyes at once")?;
        }
        if self.side_effect { write!(f, ", has side effects") } else { Ok(()) }
    }
}
