//! Which images hold both eyes' parts in one, so that a pass can draw both at once.
//!
//! Only draws, fills and copies of whole images work for both eyes at once. An image that other work makes, or reads
//! otherwise than by sampling, is there for each eye; so is every image that is drawn from such an image, or beside it. Where each
//! eye has a layer, a compute pass reaches that of its eye, and the image stays one for both.

use super::Eyes;
use super::pass_eyes::PassEyes;
use crate::frame::{EyeForm, ImageIndex, Stereo};
use crate::language::{
    Image, ImagePart, ImageShape, Layers, Lifetime, Mips, Part, Pass, Pipeline, Sample, StandIn, Use, Work,
};
use crate::shader::element_of;
use crate::vulkan::AddressMode;
use std::sync::Arc;

/// The images that can't hold both eyes' parts. By image, the reason; `None`: it can, or both eyes share the image.
pub(super) struct SeparateImages {
    form: EyeForm,
    why: Vec<Option<String>>,
}

impl SeparateImages {
    /// Finds these images for a mode that keeps both eyes' parts in one image of this form.
    pub(super) fn of(
        pipeline: &Pipeline,
        own: &[bool],
        whose: &[PassEyes],
        eyes: &Eyes<'_>,
        form: EyeForm,
    ) -> SeparateImages {
        let why = pipeline.images.iter().zip(own).map(|(image, own)| own.then(|| by_itself(image, form)).flatten());
        let mut apart = SeparateImages { form, why: why.collect() };
        let running = || pipeline.passes.iter().zip(whose).filter(|(pass, _)| pass.off.is_none());
        for (pass, whose) in running() {
            let name = &pass.name.text;
            let own_part = |part: &&ImagePart| own[index(part.image.index)];
            let by_layer = form == EyeForm::Layers && *whose == PassEyes::Each;
            let beyond = |part: &&ImagePart| !(by_layer && reaches_a_layer(pass, part));
            for part in used_by_texels(pass, may_be_at_once(pass, *whose)).filter(own_part).filter(beyond) {
                apart.part(part.image.index, || format!("`{name}` uses it otherwise than by sampling or drawing"));
            }
            for part in written(pass).filter(own_part).filter(|part| part.eye.is_some() || *whose != PassEyes::Each) {
                apart.part(part.image.index, || format!("`{name}` writes one eye's"));
            }
            let wraps = |sample: &&Sample| {
                let address = sample.address.map(|address| address.value);
                let beyond = address.is_some_and(|address| address != AddressMode::ClampToEdge);
                form == EyeForm::Halves && (beyond || sample.state.reaches_out())
            };
            for sample in pass.sample.iter().filter(wraps).filter(|sample| own_part(&&sample.part)) {
                apart.part(sample.part.image.index, || format!("`{name}` reads beyond its edges"));
            }
            let elements = pass.sample.iter().filter(|sample| element_of(&sample.binding.text).is_some());
            for sample in elements.filter(|sample| own_part(&&sample.part)) {
                apart.part(sample.part.image.index, || format!("`{name}` samples it as an element of an array"));
            }
            let stored = pass.storage.iter().filter(|storage| element_of(&storage.binding.text).is_some());
            for part in stored.filter_map(|storage| image(&storage.part)).filter(own_part) {
                apart.part(part.image.index, || format!("`{name}` accesses it as an element of an array"));
            }
            if let Some([Part::Image(from), Part::Image(to)]) = pass.work.copied()
                && own[index(to.image.index)]
                && !own[index(from.image.index)]
            {
                apart.part(to.image.index, || format!("`{name}` copies to it what both eyes share"));
            }
            if *whose == PassEyes::Each
                && let Some(why) = only_one_by_one(pass, eyes)
            {
                apart.all(written(pass).filter(own_part).filter(beyond), &format!("`{name}` {why}"));
            }
        }
        while apart.spread(pipeline, own, running()) {}
        apart
    }

    /// Whether an image, which each eye has of its own, is one for both.
    pub(super) fn is_one(&self, image: ImageIndex) -> bool {
        self.why[index(image)].is_none()
    }

    /// Whether a pass that runs for each eye does so at once.
    pub(super) fn at_once(&self, pass: &Pass, own: &[bool], eyes: &Eyes<'_>) -> bool {
        let apart =
            |part: &ImagePart| own[index(part.image.index)] && part.eye.is_none() && !self.is_one(part.image.index);
        only_one_by_one(pass, eyes).is_none() && !read(pass).chain(written(pass)).any(apart)
    }

    /// Why an image is one for each eye.
    pub(super) fn why(&self, image: usize) -> Option<&str> {
        self.why[image].as_deref()
    }

    fn part(&mut self, image: ImageIndex, why: impl FnOnce() -> String) -> bool {
        let known = &mut self.why[index(image)];
        let new = known.is_none();
        known.get_or_insert_with(why);
        new
    }

    fn all<'p>(&mut self, parts: impl Iterator<Item = &'p ImagePart>, why: &str) -> bool {
        let mut found = false;
        for part in parts {
            found |= self.part(part.image.index, || why.to_owned());
        }
        found
    }

    /// An image that is drawn from or beside a per-eye image is per-eye, too. Whether that found any.
    fn spread<'p>(
        &mut self,
        pipeline: &Pipeline,
        own: &[bool],
        running: impl Iterator<Item = (&'p Arc<Pass>, &'p PassEyes)>,
    ) -> bool {
        let mut found = false;
        for (pass, _) in running.filter(|(_, whose)| **whose == PassEyes::Each) {
            let is_own = |part: &&ImagePart| own[index(part.image.index)];
            let each = |part: &&ImagePart| is_own(part) && part.eye.is_none();
            let cause = read(pass).chain(written(pass)).filter(each).find(|part| !self.is_one(part.image.index));
            if let Some(cause) = cause {
                let image = &pipeline.images[index(cause.image.index)].name.text;
                let why =
                    format!("`{}` draws it for one eye after the other, as it does with `{image}`", pass.name.text);
                let by_layer = self.form == EyeForm::Layers;
                let beyond = |part: &&ImagePart| !(by_layer && reaches_a_layer(pass, part));
                let drawn = written(pass).chain(used_by_texels(pass, false)).filter(is_own).filter(beyond);
                found |= self.all(drawn, &why);
            }
        }
        // The stand-in of a pass that is off forwards one image for both eyes, or an image for each.
        for pass in pipeline.passes.iter().filter(|pass| pass.off.is_some()) {
            for stand_in in &pass.otherwise {
                let StandIn::Forward(forward) = stand_in else { continue };
                let [from, to] = [forward.from, forward.to].map(|image| image.index);
                let hands_on_one = |image| own[index(image)] && self.is_one(image);
                if hands_on_one(from) != hands_on_one(to) {
                    let why = || format!("`{}` is off and hands it on", pass.name.text);
                    for image in [from, to].into_iter().filter(|image| own[index(*image)]) {
                        found |= self.part(image, why);
                    }
                }
            }
        }
        found
    }
}

fn index(image: ImageIndex) -> usize {
    image.0 as usize
}

/// Why an image can't hold both eyes' parts, apart from its use by passes.
fn by_itself(image: &Image, form: EyeForm) -> Option<String> {
    let what = match () {
        () if image.shape.value != ImageShape::D2 => "it isn't flat",
        () if !matches!(image.layers.value, Layers::Default | Layers::Count(1)) => "it has layers of its own",
        () if form == EyeForm::Halves && image.mips.value != Mips::Count(1) => "it has mip levels",
        () if matches!(image.lifetime.value, Lifetime::File(_)) => "it comes from a file",
        () => return None,
    };
    Some(what.to_owned())
}

/// Why a pass can't work for both eyes at once.
fn only_one_by_one(pass: &Pass, eyes: &Eyes<'_>) -> Option<&'static str> {
    match &pass.work {
        Work::Draw { draw, .. } if draw.is_indirect() && eyes.stereo != Stereo::Multiview => {
            Some("draws the instances that a buffer says")
        }
        // Instances are both eyes' then, and their numbers no longer those of the buffer's elements.
        Work::Draw { .. } if eyes.stereo != Stereo::Multiview && (eyes.by_instance)(pass) => {
            Some("draws vertices with attributes by instance")
        }
        Work::Draw { .. } | Work::Fill { .. } => None,
        Work::Copy { from: Part::Image(_), to: Part::Image(_) } => None,
        Work::Copy { .. } => Some("copies to or from a buffer"),
        Work::Blit { .. } => Some("scales by a blit"),
        Work::Dispatch { .. } => Some("runs a compute shader"),
        // The program's instances are counted for one eye, as the file's are.
        Work::Custom { .. } if pass.both_eyes && eyes.stereo != Stereo::Multiview && (eyes.by_instance)(pass) => {
            Some("draws vertices with attributes by instance")
        }
        Work::Custom { .. } if pass.both_eyes => None,
        Work::Custom { .. } => Some("is recorded by the program"),
    }
}

/// Images that a pass reads, by shaders or by a copy.
fn read(pass: &Pass) -> impl Iterator<Item = &ImagePart> {
    let copied = pass.work.copied().and_then(|[from, _]| image(from));
    pass.sample.iter().map(|sample| &sample.part).chain(copied).chain(used_by_texels(pass, false))
}

/// Images that a pass writes.
fn written(pass: &Pass) -> impl Iterator<Item = &ImagePart> {
    pass.image_parts().filter(|(_, of)| of.writes()).map(|(part, _)| part)
}

/// Whether a pass works for both eyes at once, if what it uses holds both eyes' parts.
fn may_be_at_once(pass: &Pass, whose: PassEyes) -> bool {
    match &pass.work {
        Work::Custom { .. } => pass.both_eyes && whose == PassEyes::Each,
        Work::Draw { .. } | Work::Dispatch { .. } | Work::Copy { .. } | Work::Blit { .. } | Work::Fill { .. } => true,
    }
}

/// Images that a pass uses otherwise than by sampling and drawing. A pass that may be `at_once` uses whole images by copies and fills for
/// both eyes too.
fn used_by_texels(pass: &Pass, at_once: bool) -> impl Iterator<Item = &ImagePart> {
    let partial = !pass.work.transfer_reads().iter().chain(pass.work.transfer_writes()).all(whole);
    let (reads, writes) = match &pass.work {
        Work::Copy { .. } | Work::Fill { .. } | Work::Custom { .. } if at_once => (partial, partial),
        Work::Copy { .. } | Work::Fill { .. } | Work::Blit { .. } | Work::Custom { .. } => (true, false),
        Work::Draw { .. } | Work::Dispatch { .. } => (false, false),
    };
    // Commands of the program's own, outside of rendering scopes, reach both eyes' parts.
    let stores_both = at_once && pass.both_eyes && !pass.is_drawn();
    let used = move |part: &ImagePart, of: Use| match of {
        Use::StorageRead | Use::Storage => !stores_both || is_part(part),
        Use::TransferRead => reads,
        Use::TransferWrite => writes,
        Use::Sampled | Use::LeftOut | Use::Uniform | Use::Drawn | Use::Counts | Use::Measured | Use::Target => false,
    };
    pass.image_parts().filter(move |(part, of)| used(part, *of)).map(|(part, _)| part)
}

/// Whether a pass that runs for one eye accesses only that eye's layer of an image here. What it replaces while it reads it may go on in
/// another image, which then lacks the other eye's layer.
fn reaches_a_layer(pass: &Pass, part: &ImagePart) -> bool {
    let again = |other: &ImagePart| other.image.index == part.image.index && !std::ptr::eq(other, part);
    let level = |part: &ImagePart| part.mips.first.filter(|_| part.mips.count.is_none()).map(|level| level.value);
    let elsewhere = |other: &ImagePart| {
        other.previous.is_some() || level(part).zip(level(other)).is_some_and(|(one, another)| one != another)
    };
    let mut others = pass.image_parts().filter(|(other, of)| *of != Use::Measured && again(other));
    pass.work.is_dispatch() && !is_part(part) && others.all(|(other, _)| elsewhere(other))
}

fn whole(part: &Part) -> bool {
    image(part).is_some_and(|part| !is_part(part))
}

fn is_part(part: &ImagePart) -> bool {
    part.eye.is_some() || part.plane.is_some() || part.previous.is_some()
}

fn image(part: &Part) -> Option<&ImagePart> {
    match part {
        Part::Image(part) => Some(part),
        Part::Buffer(_) => None,
    }
}
