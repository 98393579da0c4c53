//! One pass of the frame becomes an operation on physical images and buffers.

use super::access;
use super::adapter::Adapter;
use crate::base::{Code, Diagnostic};
use crate::compile::model::{InitialContents, OpKind, PhysicalIndex, Use};
use crate::frame::{Face, ImageIndex, NoteKind, Pass, SampledImage};
use crate::vulkan::{Aspects, Subresources};

impl Adapter<'_> {
    pub(super) fn pass(&mut self, number: u32) {
        let frame = self.input.frame;
        let pass = &frame.passes[number as usize];
        if let Some((from, to, because)) = pass.work.forward() {
            return self.forward(number, pass, from, to, because);
        }
        self.copies.clear();
        let samples =
            |image: ImageIndex| pass.sampled.iter().any(|sampled| sampled.image == image && sampled.frames_ago == 0);
        self.feeds_back = pass.storage.iter().any(|storage| storage.write && samples(storage.image))
            || pass.color.iter().any(|target| samples(target.image));
        for (entry, sampled) in (0_u32..).zip(&pass.sampled) {
            if let Some(resource) = self.sampled(number, pass, sampled) {
                let range = self.sampled_range(sampled.image, sampled.range);
                self.add_use(access::sampled(sampled, entry, resource, range));
            }
        }
        for (entry, storage) in (0_u32..).zip(&pass.storage) {
            let resource = match storage.write {
                true => self.target(number, pass, storage.image, storage.range, storage.span, storage.read),
                false => self.current(storage.image),
            };
            let range = self.range(storage.image, storage.range);
            self.add_use(access::storage(storage, entry, resource, range));
        }
        for (entry, target) in (0_u32..).zip(&pass.color) {
            let contents = match target.clear {
                Some(_) => InitialContents::Clear,
                None if pass.keeps_color(target, &frame.images[target.image.0 as usize]) => InitialContents::Keep,
                None => InitialContents::Discard,
            };
            let resource =
                self.target(number, pass, target.image, target.range, target.span, contents == InitialContents::Keep);
            let range = self.range(target.image, target.range);
            self.add_use(access::color(target, entry, resource, range, contents));
        }
        if let Some(depth) = &pass.depth {
            let image = &frame.images[depth.image.0 as usize];
            for (plane, clears, writes) in depth.planes(image.format) {
                let contents = match clears {
                    true => InitialContents::Clear,
                    false if pass.keeps_plane(depth, plane, image) => InitialContents::Keep,
                    false => InitialContents::Discard,
                };
                let resource = if writes {
                    self.written(depth.image, contents == InitialContents::Keep)
                } else {
                    self.current(depth.image)
                };
                self.refuse_depth_feedback(pass, depth.image, depth.range, plane, writes);
                let range = self.range(depth.image, Subresources { aspects: plane, ..depth.range });
                self.add_use(access::depth(plane, resource, range, contents, writes, image.format));
            }
        }
        for (entry, used) in (0_u32..).zip(&pass.buffers) {
            let resource = self.buffer(used.buffer, used.frames_ago);
            self.add_use(access::buffer(used, entry, resource));
        }
        for (entry, used) in (0_u32..).zip(&pass.transfers) {
            if let Some((resource, range)) = self.transferred(pass, used) {
                self.transfers(pass, access::transfer(&pass.work, used, entry, resource, range));
            }
        }
        if pass.is_custom() {
            self.uses_of_pass_mut().iter_mut().for_each(|used| access::by_program(used, pass, &frame.images));
        }
        if pass.alpha_to_coverage && !access::has_samples(&self.adapted, self.uses_of_pass()) {
            let text = "alpha_to_coverage is off: its targets have 1 sample".to_owned();
            self.note(NoteKind::NoAlphaToCoverage, &pass.name, text, pass.span);
        }
        let kind = if pass.work.is_draw() { OpKind::Draw(number) } else { OpKind::Pass(number) };
        self.push_pass(kind, pass.side_effect);
    }

    /// Adds the use by a transfer. What the program reads and writes in one pass is one access: the Plan can't stand between the two.
    fn transfers(&mut self, pass: &Pass, used: Use) {
        let part = |adapter: &Self, used: &Use| (used.resource, adapter.adapted.range(used));
        let same = |known: &&Use| known.role.is_transfer() && part(self, known) == part(self, &used);
        let before = if pass.is_custom() { self.uses_of_pass().iter().find(same).copied() } else { None };
        let Some(before) = before.filter(|before| before.writes != used.writes) else { return self.add_use(used) };
        let is_before = |known: &&mut Use| known.role == before.role && known.entry == before.entry;
        self.uses_of_pass_mut()
            .iter_mut()
            .filter(is_before)
            .for_each(|known| *known = access::read_and_written(*known, &used));
    }

    /// The physical image that a sampling pass reads.
    #[inline]
    fn sampled(&mut self, number: u32, pass: &Pass, sampled: &SampledImage) -> Option<PhysicalIndex> {
        let before = self.current(sampled.image);
        if sampled.frames_ago == 0 && sampled.face != Face::Samples && self.samples(before) == 1 {
            return Some(self.sampled_as_it_is(number, pass, sampled, before));
        }
        self.sampled_earlier_or_resolved(number, pass, sampled, before)
    }

    /// The image that it reads if that has one sample, whose current version `before` holds.
    #[inline]
    fn sampled_as_it_is(
        &mut self,
        number: u32,
        pass: &Pass,
        sampled: &SampledImage,
        before: PhysicalIndex,
    ) -> PhysicalIndex {
        if self.demotions.is_worth_a_note(sampled.image) {
            self.note_one_sample(pass, sampled);
        }
        self.version_before(number, pass, sampled, before)
    }

    fn note_one_sample(&mut self, pass: &Pass, sampled: &SampledImage) {
        let text = format!("`{}` samples it as it is: it has 1 sample, so nothing is resolved", pass.name);
        let image = &self.input.frame.images[sampled.image.0 as usize];
        self.note(NoteKind::NotResolved, &image.name, text, sampled.span);
    }

    /// The image that it reads of an earlier frame, or where samples are to be read or resolved.
    fn sampled_earlier_or_resolved(
        &mut self,
        number: u32,
        pass: &Pass,
        sampled: &SampledImage,
        before: PhysicalIndex,
    ) -> Option<PhysicalIndex> {
        let declared = &self.input.frame.images[sampled.image.0 as usize];
        if sampled.frames_ago > 0 {
            let earlier = before + sampled.frames_ago;
            return self.samples_unresolved(pass, sampled, earlier).then_some(earlier);
        }
        let count = self.samples(before);
        let per_sample = sampled.face == Face::Samples;
        if per_sample && count > 1 {
            return Some(self.version_before(number, pass, sampled, before));
        }
        // A shader that adapts does without samples.
        if per_sample && sampled.texture.is_none() {
            let message = format!("`{}` reads single samples of `{}`, which has one sample", pass.name, declared.name);
            let help = format!(
                "declare it `TEXTURE_{0} {0}` in the shader, which fits any number of samples, or sample it as `sampler2D` \
                 where its sample count is 1 ({1} were asked for)",
                sampled.binding, declared.samples
            );
            self.errors.push(Diagnostic::new(Code::SINGLE_SAMPLES, sampled.span, message).help(help));
            return None;
        }
        if count > 1 {
            let because = format!("`{}` samples `{}` and it has {count} samples", pass.name, declared.name);
            if sampled.range.aspects == Aspects::STENCIL {
                self.refuse_stencil(sampled.image, &because, sampled.span);
                return None;
            }
            return self.resolved(sampled.image, sampled.face, because, sampled.span);
        }
        Some(self.sampled_as_it_is(number, pass, sampled, before))
    }

    /// Whether a shader can sample an earlier frame, which is never resolved. Reports it if not.
    fn samples_unresolved(&mut self, pass: &Pass, sampled: &SampledImage, earlier: PhysicalIndex) -> bool {
        let count = self.samples(earlier);
        if count == 1 || sampled.face == Face::Samples {
            return true;
        }
        let name = &self.input.frame.images[sampled.image.0 as usize].name;
        let message = format!(
            "`{}` samples an earlier frame of `{name}`, which has {count} samples; only a frame's own images are resolved",
            pass.name
        );
        let help = "let a pass draw it into an image with 1 sample and `lifetime: History`, and sample an earlier frame of that \
            one; or declare it `sampler2DMS` in the shader";
        self.errors.push(Diagnostic::new(Code::RESOLVE_IMPOSSIBLE, sampled.span, message).help(help));
        false
    }

    /// Whether a pass writes the plane of a depth image that it also samples: it can't be given a copy.
    fn refuse_depth_feedback(
        &mut self,
        pass: &Pass,
        image: ImageIndex,
        range: Subresources,
        plane: Aspects,
        writes: bool,
    ) {
        let range = Subresources { aspects: plane, ..range };
        let declared = &self.input.frame.images[image.0 as usize];
        let same = |sampled: &&SampledImage| {
            let seen = declared.sampled_part(sampled.range);
            sampled.image == image && sampled.frames_ago == 0 && declared.overlap(seen, range)
        };
        if writes && let Some(sampled) = pass.sampled.iter().find(same) {
            let name = &declared.name;
            let message = format!("`{}` samples the depth `{name}` that it also writes", pass.name);
            self.errors.push(
                Diagnostic::new(Code::DEPTH_FEEDBACK, sampled.span, message)
                    .help(format!("test it without writing: say `depth: (image: \"{name}\", write: false)`")),
            );
        }
    }
}
