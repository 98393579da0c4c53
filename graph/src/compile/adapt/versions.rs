//! Which physical image holds the version that a pass reads, and which takes the one that it writes.

use super::adapter::Adapter;
use crate::base::Span;
use crate::compile::model::{OpKind, PhysicalIndex};
use crate::frame::{Face, ImageIndex, Pass, SampledImage};
use crate::vulkan::Subresources;

impl Adapter<'_> {
    /// A pass that samples what it also writes reads the version before itself, which `before` holds.
    #[inline]
    pub(super) fn version_before(
        &mut self,
        number: u32,
        pass: &Pass,
        sampled: &SampledImage,
        before: PhysicalIndex,
    ) -> PhysicalIndex {
        if self.feeds_back { self.version_before_feedback(number, pass, sampled, before) } else { before }
    }

    /// As `version_before`, for a pass that feeds back.
    fn version_before_feedback(
        &mut self,
        number: u32,
        pass: &Pass,
        sampled: &SampledImage,
        before: PhysicalIndex,
    ) -> PhysicalIndex {
        if let Some((_, copy)) = self.copies.iter().find(|(of, _)| *of == before) {
            return *copy;
        }
        if !self.overwrites(number, pass, sampled) {
            return before;
        }
        self.copied(pass, sampled, before)
    }

    /// A copy of the parts of `before` that a pass samples while it writes the image.
    fn copied(&mut self, pass: &Pass, sampled: &SampledImage, before: PhysicalIndex) -> PhysicalIndex {
        let image = sampled.image;
        let declared = &self.input.frame.images[image.0 as usize];
        let because = format!("`{}` samples `{}` while it writes it", pass.name, declared.name);
        let why = self.reason(because, sampled.span);
        let samples = self.samples(before);
        let copy = self.second(image, "copy", why.clone(), samples);
        // All that the pass samples of the image is read from the copy.
        let also = pass.sampled.iter().filter(|other| other.image == image && other.frames_ago == 0);
        let mut copied: Vec<Subresources> = Vec::new();
        for range in also.map(|other| declared.part(other.range)) {
            for mip in range.base_mip..range.base_mip + range.mips {
                let level = Subresources { base_mip: mip, mips: 1, ..range };
                if !copied.contains(&level) {
                    copied.push(level);
                    let level = self.range(image, level);
                    self.push_transfer(OpKind::Copy(why.clone()), before, copy, level);
                }
            }
        }
        self.copies.push((before, copy));
        copy
    }

    /// Whether a pass writes what it samples, in the very image that it samples.
    fn overwrites(&self, number: u32, pass: &Pass, sampled: &SampledImage) -> bool {
        let image = sampled.image;
        let declared = &self.input.frame.images[image.0 as usize];
        let moves = |range: Subresources, keeps: bool| self.moves_on(number, image, range, keeps);
        let overlaps = |range: Subresources| declared.overlap(range, sampled.range);
        let mut color = pass.color.iter().filter(|target| target.image == image && overlaps(target.range));
        let color = color.any(|target| !moves(target.range, pass.keeps_color(target, declared)));
        let mut storage = pass.storage.iter().filter(|storage| storage.image == image && storage.write);
        color || storage.any(|storage| overlaps(storage.range) && !moves(storage.range, storage.read))
    }

    /// Whether a pass that samples an image and writes `range` of it goes on in a second image: it replaces all of it,
    /// and nobody relies on where it lies.
    fn moves_on(&self, number: u32, image: ImageIndex, range: Subresources, keeps: bool) -> bool {
        let declared = &self.input.frame.images[image.0 as usize];
        self.demotions.moves(number, image)
            || !keeps && declared.part(range) == declared.whole() && !declared.lifetime.outlives_frame()
    }

    /// The physical image that a pass writes; a second one if the pass also samples what it replaces.
    pub(super) fn target(
        &mut self,
        number: u32,
        pass: &Pass,
        image: ImageIndex,
        range: Subresources,
        span: Span,
        keeps: bool,
    ) -> PhysicalIndex {
        if self.demotions.moves(number, image) {
            self.demoted(pass, image, span)
        } else if self.feeds_back {
            self.target_beside_source(number, pass, image, range, span, keeps)
        } else {
            self.written(image, keeps)
        }
    }

    /// As `target`, for a pass that feeds back.
    fn target_beside_source(
        &mut self,
        number: u32,
        pass: &Pass,
        image: ImageIndex,
        range: Subresources,
        span: Span,
        keeps: bool,
    ) -> PhysicalIndex {
        let declared = &self.input.frame.images[image.0 as usize];
        let wanted = self.input.negotiated.samples(image);
        let samples_it = pass.sampled.iter().any(|sampled| {
            let same = sampled.image == image && sampled.frames_ago == 0 && declared.overlap(sampled.range, range);
            same && (sampled.face == Face::Samples || wanted == 1)
        });
        let there = || self.resource_of[image.0 as usize].is_some_and(|resource| self.samples(resource) == wanted);
        if samples_it && there() && self.moves_on(number, image, range, keeps) {
            let because = format!("`{}` samples `{}` while it replaces it", pass.name, declared.name);
            let why = self.reason(because, span);
            return self.replace(image, "next", why, wanted);
        }
        self.written(image, keeps)
    }

    /// The single-sampled image that a demoted draw goes on in.
    fn demoted(&mut self, pass: &Pass, image: ImageIndex, span: Span) -> PhysicalIndex {
        let samples_it = pass.sampled.iter().any(|sampled| sampled.image == image && sampled.frames_ago == 0);
        if self.resource_of[image.0 as usize].is_some() && self.current_samples(image) == 1 && !samples_it {
            return self.continued(image);
        }
        let name = &self.input.frame.images[image.0 as usize].name;
        let why = self.reason(format!("`{}` covers `{name}` and gains nothing from several samples", pass.name), span);
        self.replace(image, "1 sample", why, 1)
    }
}
