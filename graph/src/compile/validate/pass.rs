//! Checks of one pass: its images and buffers, and its work.

use super::lifetimes;
use crate::base::{Code, Diagnostic, Span};
use crate::frame::check::raster::{self, RasterPlace};
use crate::frame::check::samplers;
use crate::frame::check::targets::{Target, agree, not_forwarded, undrawable, without_depth};
use crate::frame::{Access, Draw, Frame, Image, ImageIndex, Lifetime, Pass, Resource, VisitAccess, check};
use crate::vulkan::{Stages, Subresources};

/// The check of a pass.
pub(super) struct Check<'c> {
    pub(super) frame: &'c Frame,
    pub(super) pass: &'c Pass,
    pub(super) errors: &'c mut Vec<Diagnostic>,
}

impl VisitAccess<'_> for Check<'_> {
    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    fn visit(&mut self, access: Access<'_>) {
        match access.resource() {
            Resource::Image(image) => self.image(image, &access),
            Resource::Buffer(buffer) => self.buffer(buffer.0, access.frames_ago(), access.span()),
        }
        if access.frames_ago() > 0 && matches!(access, Access::Transfer(used) if used.write) {
            self.wrong(Code::EARLIER_FRAME, access.span(), "writes into an earlier frame");
        }
    }
}

impl Check<'_> {
    pub(super) fn wrong(&mut self, code: Code, span: Span, what: &str) {
        self.errors.push(Diagnostic::new(code, span, format!("`{}` {what}", self.pass.name)));
    }

    /// Whether all images and buffers exist, and the parts of them that are named.
    pub(super) fn resources(&mut self) -> bool {
        let before = self.errors.len();
        let pass = self.pass;
        pass.visit_accesses(self);
        for declared in &pass.uses {
            match declared.resource {
                Resource::Buffer(buffer) => self.buffer(buffer.0, 0, declared.span),
                Resource::Image(image) => match self.frame.images.get(image.0 as usize) {
                    Some(image) => self.inside(image, declared.range, declared.span),
                    None => self.no_image(image, declared.span),
                },
            }
        }
        self.errors.len() == before
    }

    /// Images that come from a file are only sampled.
    pub(super) fn files(&mut self) {
        if let Some((span, what)) = lifetimes::misused_file(self.frame, self.pass) {
            self.wrong(Code::TEXTURE_WRITTEN, span, &what);
            if let Some(error) = self.errors.last_mut() {
                error.help = Some(
                    "passes only sample a texture: declare an image and draw into that; the shader `copy` copies into it"
                        .to_owned(),
                );
            }
        }
    }

    /// Images in compressed formats are only sampled.
    pub(super) fn compressed(&mut self) {
        if let Some((span, what)) = lifetimes::misused_compression(self.frame, self.pass) {
            self.wrong(Code::FORMAT_COMPRESSED, span, &what);
            if let Some(error) = self.errors.last_mut() {
                error.help = Some(super::UNCOMPRESSED.to_owned());
            }
        }
    }

    // Inlined: `VisitAccess::visit` says why.
    #[inline(always)]
    fn image(&mut self, index: ImageIndex, access: &Access<'_>) {
        let (range, span) = (access.range(), access.span());
        let Some(image) = self.frame.images.get(index.0 as usize) else {
            return self.no_image(index, span);
        };
        if access.frames_ago() > 0 {
            self.history(&image.lifetime, access.frames_ago(), &image.name, span);
        }
        if !range.is_whole() {
            self.inside(image, range, span);
        }
        if access.attaches() {
            self.within(undrawable(image, range, image, [span, span]));
        } else if matches!(access, Access::ForwardSource(..) | Access::ForwardTarget(..)) {
            self.within(not_forwarded(image, image, span));
        }
        if let Access::Depth(_) = access {
            self.within(without_depth(image, image, span));
        }
    }

    /// Reports a mistake in what the pass uses, with the name of the pass.
    fn within(&mut self, wrong: impl IntoIterator<Item = Diagnostic>) {
        let of_pass =
            |wrong: Diagnostic| Diagnostic { message: format!("`{}`: {}", self.pass.name, wrong.message), ..wrong };
        self.errors.extend(wrong.into_iter().map(of_pass));
    }

    fn no_image(&mut self, index: ImageIndex, span: Span) {
        self.wrong(Code::NO_SUCH_NUMBER, span, &format!("names image number {}, which does not exist", index.0));
    }

    fn inside(&mut self, image: &Image, range: Subresources, span: Span) {
        let part = image.part(range);
        let inside = |base: u32, count: u32, all: u32| count > 0 && base < all && count <= all - base;
        let planes = !part.aspects.is_empty() && image.format.aspects().contains(part.aspects);
        if !planes || !inside(part.base_mip, part.mips, image.mips) {
            let what =
                format!("names a part of `{}` that it doesn't have: it has {} mip levels", image.name, image.mips);
            self.wrong(Code::NO_SUCH_PART, span, &what);
        } else if !inside(part.base_layer, part.layers, image.layers) {
            let what = format!("names a part of `{}` that it doesn't have: it has {} layers", image.name, image.layers);
            self.wrong(Code::NO_SUCH_PART, span, &what);
        }
    }

    fn buffer(&mut self, index: u32, frames_ago: u32, span: Span) {
        match self.frame.buffers.get(index as usize) {
            None => {
                self.wrong(Code::NO_SUCH_NUMBER, span, &format!("names buffer number {index}, which does not exist"))
            }
            Some(buffer) => self.history(&buffer.lifetime, frames_ago, &buffer.name, span),
        }
    }

    fn history(&mut self, lifetime: &Lifetime, frames_ago: u32, name: &str, span: Span) {
        let most = if let Lifetime::History { frames, .. } = lifetime { *frames } else { 0 };
        if frames_ago > most {
            self.wrong(
                Code::NOT_KEPT,
                span,
                &format!("reads `{name}` of {frames_ago} frames ago, and it keeps {most}"),
            );
        }
    }

    pub(super) fn work(&mut self) {
        let pass = self.pass;
        let attached = !pass.color.is_empty() || pass.depth.is_some();
        let shaded = pass.work.shader_stages();
        match (attached, pass.work.is_draw()) {
            (true, false) => return self.wrong(Code::PASS_PARTS, pass.span, "has attachments and doesn't draw"),
            (false, true) => {
                return self.wrong(Code::PASS_DOES_NOTHING, pass.span, "draws into nothing: it has no attachment");
            }
            _ => {}
        }
        self.targets();
        self.state();
        let fits = |stages: Stages| !stages.is_empty() && shaded.contains(stages);
        if let Some(sampled) = pass.sampled.iter().find(|sampled| !fits(sampled.stages)) {
            return self.wrong_stages(&sampled.binding);
        }
        if let Some(storage) = pass.storage.iter().find(|storage| !fits(storage.stages)) {
            return self.wrong_stages(&storage.binding);
        }
        let wrong = pass.buffers.iter().find(|used| match used.role.is_of_shaders() {
            true => !fits(used.stages),
            false => !used.stages.is_empty(),
        });
        if let Some(used) = wrong {
            return self.wrong_stages(&self.frame.buffers[used.buffer.0 as usize].name);
        }
        if let Some(image) = wrong_clear(self.frame, pass) {
            let Image { name, format, .. } = image;
            return self.wrong(Code::FILL_UNFIT, pass.span, &format!("clears `{name}` to what {format} doesn't hold"));
        }
        let counts = pass.buffers.iter().filter(|used| used.role.is_indirect()).count();
        if counts != usize::from(pass.work.is_indirect()) {
            return self.wrong(
                Code::INDIRECT_COUNTS,
                pass.span,
                "needs one buffer of counts if it is indirect, and else none",
            );
        }
        let counted = pass.buffers.iter().filter(|used| used.role.is_count()).count();
        if counted != usize::from(pass.work.draws(Draw::is_counted)) {
            return self.wrong(
                Code::INDIRECT_COUNTS,
                pass.span,
                "needs one buffer for the number of its draws if that is in a buffer, and else none",
            );
        }
        let indexed = pass.buffers.iter().any(|used| used.role.is_index());
        let draws = pass.work.draw().and_then(|(draw, _)| draw.indirect());
        if let Some(fault) = draws.and_then(|draws| draws.fault(indexed)) {
            return self.wrong(Code::INDIRECT_UNFIT, pass.span, &fault);
        }
        self.transfers();
    }

    /// The images that it draws into agree.
    fn targets(&mut self) {
        let Check { frame, pass, errors } = self;
        if pass.color.len() + usize::from(pass.depth.is_some()) > 1 {
            let targets = pass.color.iter().map(Access::Color).chain(pass.depth.iter().map(Access::Depth));
            let targets = targets.filter_map(|target| {
                let image = &frame.images[target.image_index()?.0 as usize];
                Some(Target { image, range: target.range(), span: target.span(), samples_because: None })
            });
            agree(&pass.name, targets, errors);
        }
    }

    /// Raster state goes with what it draws, and samplers with the images.
    fn state(&mut self) {
        let Check { frame, pass, errors } = self;
        let at = |place| match place {
            RasterPlace::State if pass.raster_span != Span::NONE => pass.raster_span,
            RasterPlace::State => pass.span,
            RasterPlace::Blend(number) => pass.color[number].span,
        };
        if !pass.raster.is_usual() && pass.color.is_empty() && pass.depth.is_none() {
            errors.push(raster::draws_into_nothing(&pass.name, at(RasterPlace::State)));
        }
        raster::check(pass, at, errors);
        samplers::check(*frame, pass, errors);
    }

    /// Declared uses are of what the pass names, and can be.
    pub(super) fn uses(&mut self) {
        if !self.pass.uses.is_empty() || self.pass.any_queue {
            let mut wrong = Vec::new();
            check::uses::check(self.frame, self.pass, &mut wrong);
            self.within(wrong);
        }
    }

    /// Both sides of a transfer fit together.
    pub(super) fn transfers(&mut self) {
        let is_transfer = self.pass.work.is_transfer();
        if is_transfer || !self.pass.transfers.is_empty() {
            self.check_transfers();
        }
    }

    fn check_transfers(&mut self) {
        let (frame, pass) = (self.frame, self.pass);
        let mut wrong = Vec::new();
        check::transfers::check(frame, pass, &mut wrong);
        self.within(wrong);
        if let Some(why) = check::transfers::looks_beyond(frame, pass) {
            self.errors.push(Diagnostic::new(
                Code::BLIT_OF_PART,
                pass.span,
                format!("{why}: texels beyond that part are mixed in"),
            ));
        }
    }

    fn wrong_stages(&mut self, name: &str) {
        self.wrong(Code::STAGES, self.pass.span, &format!("accesses `{name}` in stages that it doesn't have"));
    }

    /// Checks the accesses to storage images and to buffers: each reads or writes, and nothing else of the pass accesses the
    /// same part, except that a storage image may also be sampled as it was before the pass.
    pub(super) fn storage(&mut self) {
        let pass = self.pass;
        for (at, storage) in pass.storage.iter().enumerate() {
            if !storage.read && !storage.write {
                self.wrong(Code::NO_ACCESS, storage.span, &format!("neither reads nor writes `{}`", storage.binding));
            }
            let image = &self.frame.images[storage.image.0 as usize];
            if image.samples > 1 {
                self.wrong(
                    Code::STORAGE_IMAGE,
                    storage.span,
                    &format!("accesses `{}` as storage, which has several samples", image.name),
                );
            }
            let meets =
                |other: ImageIndex, range: Subresources| other == storage.image && image.overlap(range, storage.range);
            let others = pass.storage.iter().take(at).any(|other| meets(other.image, other.range))
                || pass.attachments().any(|(image, range)| meets(image, range));
            if others {
                let message = format!("`{}` accesses `{}` as storage and in another way", pass.name, image.name);
                let help = "access it once, for reading and writing";
                self.errors.push(Diagnostic::new(Code::USED_TWICE, storage.span, message).help(help));
            }
        }
        for (at, used) in pass.buffers.iter().enumerate() {
            let twice = pass.buffers.iter().take(at).any(|other| {
                (other.buffer, other.frames_ago) == (used.buffer, used.frames_ago)
                    && (other.role.writes() || used.role.writes())
            });
            let name = &self.frame.buffers[used.buffer.0 as usize].name;
            if twice {
                self.wrong(Code::USED_TWICE, used.span, &format!("writes `{name}` and accesses it in another way"));
            } else if !used.role.reads() && !used.role.writes() {
                self.wrong(Code::NO_ACCESS, used.span, &format!("neither reads nor writes `{name}`"));
            } else if used.role.writes() && used.frames_ago > 0 {
                self.wrong(Code::EARLIER_FRAME, used.span, &format!("writes `{name}` of an earlier frame"));
            }
        }
    }
}

/// An image that it clears to what the format doesn't hold, if there is one.
pub(super) fn wrong_clear<'f>(frame: &'f Frame, pass: &Pass) -> Option<&'f Image> {
    let image = |image: ImageIndex| &frame.images[image.0 as usize];
    let colors = pass.color.iter().filter_map(|target| Some((image(target.image), target.clear?)));
    let wrong = |(image, clear): &(&Image, [f64; 4])| {
        image.format.lacks(*clear).is_some() || clear.iter().any(|number| !number.is_finite())
    };
    let depth = || {
        let (depth, clear) = pass.depth.as_ref().and_then(|depth| Some((depth.image, depth.clear?)))?;
        (!(0.0..=1.0).contains(&clear)).then(|| image(depth))
    };
    colors.filter(wrong).map(|(image, _)| image).next().or_else(depth)
}
