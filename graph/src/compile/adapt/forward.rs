//! Stand-ins for passes that are off: their target takes the contents of another image.

use super::access;
use super::adapter::Adapter;
use crate::base::{Code, Diagnostic};
use crate::compile::model::{OpKind, PhysicalIndex, Use};
use crate::device::ImageDescriptor;
use crate::frame::{Image, ImageIndex, NoteKind, Pass, Resource};
use crate::vulkan::{Filter, Rotation};

impl Adapter<'_> {
    /// `to` takes what `from` holds: as the same image if nothing tells them apart, else by a copy or a draw.
    pub(super) fn forward(&mut self, number: u32, pass: &Pass, from: ImageIndex, to: ImageIndex, because: &str) {
        let frame = self.input.frame;
        if from == to {
            let name = &frame.images[to.0 as usize].name;
            return self.note(
                NoteKind::Untouched,
                name,
                format!("`{}` is off ({because}) and leaves it as it is", pass.name),
                pass.span,
            );
        }
        let (source_image, target_image) = (&frame.images[from.0 as usize], &frame.images[to.0 as usize]);
        let count = self.current_samples(from);
        let mut wanted = self.input.negotiated.samples(to);
        // Where draws moved to a single sample, their stand-in needs no more samples either.
        let moved = count < wanted && self.input.negotiated.samples(from) == wanted;
        if moved && !target_image.lifetime.outlives_frame() {
            wanted = count;
        }
        let size = |image: &Image| (image.extent, image.allocated, image.rotation, image.eyes);
        let alike = (source_image.format, size(source_image)) == (target_image.format, size(target_image));
        let alike = alike && count == wanted;
        let resolves = count > 1 && !alike;
        let why = pass.inserted.as_deref().map_or_else(
            || {
                let [from, to] = [source_image, target_image].map(|image| &image.name);
                format!("`{}` is off ({because}) and forwards `{from}` to `{to}`", pass.name)
            },
            str::to_owned,
        );
        let source = if resolves {
            let why = format!("{why}; `{}` has {count} samples", source_image.name);
            match self.resolved_as_it_is((from, source_image.format.aspects()), why, pass.span) {
                Some(source) => source,
                None => return,
            }
        } else {
            self.current(from)
        };
        let same = self.adapted.resources[source as usize].image().is_some_and(|held| {
            let ImageDescriptor { format, shape, extent, mips, layers, samples, .. } = *held;
            let held = (extent, self.adapted.allocated(source), self.rotation(source), self.adapted.eyes(source));
            (format, shape, held) == (target_image.format, target_image.shape, size(target_image))
                && (mips, layers, samples) == (target_image.mips, target_image.layers, wanted)
        });
        if same && self.may_share(number, source, from, to) {
            let name = target_image.name.clone();
            let why_inserted = self.reason(why.clone(), pass.span);
            let resource = &mut self.adapted.resources[source as usize];
            if !resolves {
                resource.inserted = Some(why_inserted);
            }
            resource.renamed = Some(name.clone());
            self.renamed = true;
            self.resource_of[to.0 as usize] = Some(source);
            let what = if resolves { "the resolve goes straight into it" } else { "they are one image" };
            return self.note(NoteKind::OneImage, &name, format!("{why}: {what}"), pass.span);
        }
        if same {
            let why = self.reason(format!("{why}; one of them is used again later"), pass.span);
            let target = if wanted == self.input.negotiated.samples(to) {
                self.written(to, false)
            } else {
                self.replace(to, "1 sample", why.clone(), wanted)
            };
            return self.push_transfer(OpKind::ForwardCopy(why), source, target, Use::ALL);
        }
        self.forward_by_draw(number, pass, source, to, why);
    }

    /// Help for an image that must take another one's texels as they are.
    fn alike(&self, pass: &Pass, held: &ImageDescriptor, to: &Image) -> String {
        let Some([from, _]) = pass.work.forwarded() else { return String::new() };
        let from = &self.input.frame.images[from.0 as usize];
        let fields = [
            (held.format != to.format, format!("`format: {}`", held.format)),
            (held.extent != to.extent, format!("`size: Like(\"{}\")`", from.name)),
            (from.samples != to.samples, format!("`samples: Like(\"{}\")`", from.name)),
            (held.layers != to.layers, format!("`layers: Like(\"{}\")`", from.name)),
        ];
        let differ: Vec<String> = fields.into_iter().filter_map(|(differs, field)| differs.then_some(field)).collect();
        match &differ[..] {
            [] => "give both the same format, size, samples, mip levels and shape".to_owned(),
            differ => format!("say {} of `{}`", differ.join(", and "), to.name),
        }
    }

    fn forward_by_draw(&mut self, number: u32, pass: &Pass, source: PhysicalIndex, to: ImageIndex, why: String) {
        let target_image = &self.input.frame.images[to.0 as usize];
        let Some(held) = self.adapted.resources[source as usize].image().copied() else { return };
        let drawable = |depth: bool, integer: bool| !depth && !integer;
        if !drawable(held.format.is_depth(), held.format.is_integer())
            || !drawable(target_image.format.is_depth(), target_image.format.is_integer())
            || held.layers > 1
            || target_image.layers > 1
        {
            let message = format!("{why}, but {} can't be drawn into {}", held.format, target_image.format);
            self.errors.push(Diagnostic::new(Code::FORWARD_IMPOSSIBLE, pass.span, message).help(self.alike(
                pass,
                &held,
                target_image,
            )));
            return;
        }
        let rotation = self.rotation(source);
        let upright = |extent: [u32; 3], rotation: Rotation| rotation.extent([extent[0], extent[1]]);
        let same_size = upright(held.extent, rotation) == upright(target_image.extent, target_image.rotation)
            && self.adapted.allocated(source) == target_image.allocated;
        let filtered = !same_size && self.input.device.format(held.format).is_some_and(|support| support.linear_filter);
        let filter = if filtered { Filter::Linear } else { Filter::Nearest };
        let differ = match (held.format == target_image.format, same_size) {
            (false, true) => format!("formats differ ({} and {})", held.format, target_image.format),
            (true, false) => "sizes differ".to_owned(),
            (false, false) => "formats and sizes differ".to_owned(),
            (true, true) if rotation != target_image.rotation => "orientations differ".to_owned(),
            (true, true) => "sample counts differ".to_owned(),
        };
        let target = self.written(to, false);
        let why = self.reason(format!("{why}; {differ}"), pass.span);
        let uses = access::forward_draw(source, target);
        self.push(OpKind::ForwardDraw { pass: number, filter, why }, &uses);
    }

    /// Whether `to` may share `resource` from pass `number` on. It may not if a later pass writes the resource under one
    /// name while it is still used under another, or if one of the images has memory of its own.
    fn may_share(&mut self, number: u32, resource: PhysicalIndex, from: ImageIndex, to: ImageIndex) -> bool {
        let images = &self.input.frame.images;
        let cut = self.input.grids.of(from) != self.input.grids.of(to);
        if cut || [from, to].iter().any(|image| images[image.0 as usize].lifetime.outlives_frame()) {
            return false;
        }
        let Adapter { last_accesses, resource_of, versions, is_output, known_as, adapted, .. } = self;
        let after = |pass: Option<u32>| pass.is_some_and(|pass| pass > number);
        let held = |image: ImageIndex| resource_of[image.0 as usize] == Some(resource) || image == to;
        let first = match adapted.resources[resource as usize].of {
            Resource::Image(image) => vec![image],
            Resource::Buffer(_) => Vec::new(),
        };
        let known = known_as.entry(resource).or_insert(first);
        // Names that are not used any more are dropped, so that a long chain of forwards makes no long list.
        let used = |image: &ImageIndex| after(last_accesses.access[image.0 as usize]) || is_output[image.0 as usize];
        known.retain(|image| used(image) && *image != to);
        let resolved = |image: ImageIndex| {
            resource_of[image.0 as usize]
                .and_then(|held| versions[held as usize].resolved)
                .map(|(_, resolved)| resolved)
        };
        known.retain(|image| held(*image) || resolved(*image) == Some(resource));
        known.push(to);
        let both_leave = known.iter().filter(|image| is_output[image.0 as usize]).count() > 1;
        let told_apart =
            known.len() > 1 && known.iter().any(|image| held(*image) && after(last_accesses.write[image.0 as usize]));
        !both_leave && !told_apart
    }
}
