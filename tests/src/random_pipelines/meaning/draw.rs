//! The contents that a draw leaves in its attachments.

use super::{Evaluator, shade};
use crate::random_pipelines::hash::{Quarter, hash};
use crate::random_pipelines::pipeline::{Count, DepthTarget, Draw, Geometry, Part, Plane, Target};
use crate::random_pipelines::texels::{self, Words};
use framewright_graph::frame::Blend;
use framewright_graph::vulkan::{ColorComponents, CompareOp, Format, StencilOp};

/// One triangle: `None` covers all at depth 0.
type Triangle = Option<(Quarter, u32)>;

impl Evaluator<'_> {
    pub(super) fn draw(&mut self, draw: &Draw) {
        for target in &draw.color {
            if let Some(clear) = target.clear {
                self.clear(target.part, clear);
            }
        }
        if let Some(DepthTarget { part, clear, stencil, .. }) = draw.depth {
            if let Some(clear) = clear {
                self.clear(part, clear);
            }
            if let Some(clear) = stencil.and_then(|stencil| stencil.clear) {
                self.clear(Part { plane: Plane::Stencil, ..part }, clear);
            }
        }
        let part = draw.color.first().map(|target| target.part).or(draw.depth.map(|depth| depth.part));
        let Some(part) = part else { return };
        let image = &self.pipeline.images[part.image];
        let (extent, samples) = (image.extent_of(part.mip), image.samples);
        for triangle in self.triangles(draw, extent) {
            for y in 0..extent[1] {
                for x in 0..extent[0] {
                    if triangle.is_none_or(|(quarter, _)| quarter.covers([x, y])) {
                        self.pixel(draw, triangle, [x, y, 0], samples);
                    }
                }
            }
        }
    }

    fn clear(&mut self, part: Part, value: u8) {
        self.fill(crate::random_pipelines::pipeline::Region::Image(part), value);
    }

    /// The triangles in the order in which they are drawn, each with what its vertex shader hands over.
    fn triangles(&self, draw: &Draw, extent: [u32; 3]) -> Vec<Triangle> {
        let Geometry::Triangles { count, vertices, indices } = draw.geometry else { return vec![None] };
        let [count, instances, first, _] = match count {
            Count::Direct(triangles, instances) => [3 * triangles, instances, 0, 0],
            Count::Indirect(buffer) => [0, 1, 2, 3].map(|word| self.before.buffers[buffer][0][word].bits),
        };
        let mut all = Vec::new();
        for instance in 0..instances {
            for number in (first..first + count).step_by(3) {
                let vertex = indices.map_or(number, |buffer| self.before.buffers[buffer][0][number as usize].bits);
                let quarter = Quarter::new(self.pass.number, vertex / 3, instance, extent);
                let seed = vertices.map_or(0, |buffer| self.before.buffers[buffer][0][vertex as usize].bits);
                let reads = &draw.reads[..draw.vertex_reads];
                all.push(Some((quarter, self.reads(reads, hash(quarter.state, seed), [0; 3]))));
            }
        }
        all
    }

    fn pixel(&mut self, draw: &Draw, triangle: Triangle, at: [u32; 3], samples: u32) {
        let depth = triangle.map_or(0, |(quarter, _)| quarter.depth);
        let passing: Vec<u32> = (0..samples).filter(|sample| self.passes(draw, depth, at, *sample)).collect();
        let mut state = shade::start(self.pass.number, at);
        if let Some((_, handed_over)) = triangle {
            state = hash(state, handed_over);
        }
        let invocations: Vec<(u32, Vec<u32>)> = if draw.per_sample {
            passing.into_iter().map(|sample| (hash(state, sample), vec![sample])).collect()
        } else if passing.is_empty() {
            Vec::new()
        } else {
            vec![(state, passing)]
        };
        for (state, samples) in invocations {
            let state = self.reads(&draw.reads[draw.vertex_reads..], state, at);
            if draw.discards && state & 7 == 0 {
                continue;
            }
            for (number, target) in draw.color.iter().enumerate() {
                let new = color(self.pipeline.images[target.part.image].format, target.blend, state, number as u32);
                for sample in &samples {
                    self.blend(target, new, at, *sample);
                }
            }
            if let Some(target) = draw.depth {
                samples.iter().for_each(|sample| self.update(&target, depth, at, *sample));
            }
            self.stores(&draw.stores, state, at, 0);
        }
    }

    fn passes(&self, draw: &Draw, depth: u32, at: [u32; 3], sample: u32) -> bool {
        let Some(target) = draw.depth else { return true };
        let there =
            self.after.images[target.part.image][0].texel(target.part.mip, [at[0], at[1], target.part.layer], sample);
        let nearer = compares(target.test, depth as f32 / 256.0, f32::from_bits(there.words[0]));
        let stencil = target
            .stencil
            .is_none_or(|stencil| compares(stencil.test, f32::from(stencil.reference), there.words[1] as f32));
        nearer && stencil
    }

    /// The depth and stencil that a sample leaves which passed all tests.
    fn update(&mut self, target: &DepthTarget, depth: u32, at: [u32; 3], sample: u32) {
        let part = target.part;
        let place = [at[0], at[1], part.layer];
        if target.write {
            let words = texels::words(self.pipeline.images[part.image].format, [depth, 0, 0, 0]);
            self.put(part, part.mip, place, sample, words);
        }
        let Some(stencil) = target.stencil.filter(|stencil| stencil.pass != StencilOp::Keep) else { return };
        let old = self.after.images[part.image][0].texel(part.mip, place, sample).words[1] as u8;
        let new = match stencil.pass {
            StencilOp::Keep => old,
            StencilOp::Zero => 0,
            StencilOp::Replace => stencil.reference,
            StencilOp::IncrementAndClamp => old.saturating_add(1),
            StencilOp::DecrementAndClamp => old.saturating_sub(1),
            StencilOp::Invert => !old,
        };
        self.put(Part { plane: Plane::Stencil, ..part }, part.mip, place, sample, [0, new.into(), 0, 0]);
    }

    fn blend(&mut self, target: &Target, new: Words, at: [u32; 3], sample: u32) {
        let part = target.part;
        let place = [at[0], at[1], part.layer];
        let format = self.pipeline.images[part.image].format;
        let old = self.after.images[part.image][0].texel(part.mip, place, sample).words;
        let added = || std::array::from_fn(|component| texels::sum(format, new[component], old[component]));
        // Alpha is 0 or 1.
        let opaque = texels::float(format, new[3]) == 1.0;
        let words = match target.blend {
            Blend::Replace => new,
            Blend::Additive => added(),
            Blend::Alpha | Blend::Premultiplied if opaque => new,
            Blend::Alpha => old,
            Blend::Premultiplied => added(),
            Blend::Equation(_) => unreachable!("none is made at random"),
        };
        let channels = [ColorComponents::R, ColorComponents::G, ColorComponents::B, ColorComponents::A];
        let written = |component: usize| target.write_mask.contains(channels[component]);
        let words = std::array::from_fn(|component| if written(component) { words[component] } else { old[component] });
        let texel = self.texel(words);
        *self.image(part.image).texel_mut(part.mip, place, sample) = texel;
    }
}

fn compares(test: CompareOp, new: f32, old: f32) -> bool {
    match test {
        CompareOp::Never => false,
        CompareOp::Less => new < old,
        CompareOp::Equal => new == old,
        CompareOp::LessOrEqual => new <= old,
        CompareOp::Greater => new > old,
        CompareOp::NotEqual => new != old,
        CompareOp::GreaterOrEqual => new >= old,
        CompareOp::Always => true,
    }
}

/// The value that a fragment shader writes to a colour target.
fn color(format: Format, blend: Blend, state: u32, number: u32) -> Words {
    let mut words = shade::values(state, 4 * number, format, blend);
    if matches!(blend, Blend::Alpha | Blend::Premultiplied) {
        let one = if texels::divisor(format) == 1.0 { 1 } else { 255 };
        words[3] = texels::word(format, (hash(state, 4 * number + 3) & 1) * one);
    }
    words
}
