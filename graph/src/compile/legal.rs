//! Before `link`: a frame that was built in memory may hold what no pipeline file can say.

mod lifetimes;

use super::parts;
use crate::describe::Diagnostic;
use crate::format::Format;
use crate::frame::{
    Buffer, BufferRole, Draw, Frame, Groups, Image, ImageIndex, Lifetime, Pass, Resource, Shape, TransferUse, Work,
};
use crate::source::Span;
use crate::states::{Subject, When};
use crate::vocabulary::{Aspects, Stages, Subresources};
use lifetimes::value_problem;

/// Most images, buffers and passes of a frame: their numbers have room to spare in 32 bits.
const MOST: usize = 1 << 24;

/// Reports what no device could do, and what does not fit together.
pub(super) fn check(frame: &Frame) -> Result<(), Vec<Diagnostic>> {
    let mut errors = Vec::new();
    if frame.images.len().max(frame.buffers.len()).max(frame.passes.len()) > MOST {
        let message = format!("a frame has at most {MOST} images, buffers and passes each");
        return Err(vec![Diagnostic::new(Span::NONE, message)]);
    }
    for image in &frame.images {
        let problem = image_problem(image).map(|what| Diagnostic::new(image.span, format!("`{}` {what}", image.name)));
        errors.extend(problem.or_else(|| lifetimes::check(&image.lifetime, image.span, of_image(image))));
    }
    for buffer in &frame.buffers {
        let empty =
            (buffer.bytes == 0).then(|| Diagnostic::new(buffer.span, format!("`{}` has no bytes", buffer.name)));
        errors.extend(empty.or_else(|| lifetimes::check(&buffer.lifetime, buffer.span, of_buffer(buffer))));
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    for pass in &frame.passes {
        let mut check = Check { frame, pass, errors: &mut errors };
        if check.resources() {
            check.work();
            check.storage();
        }
    }
    outputs(frame, &mut errors);
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

fn of_image(image: &Image) -> Subject<'_> {
    Subject { name: &image.name, format: Some(image.format), samples: image.samples }
}

fn of_buffer(buffer: &Buffer) -> Subject<'_> {
    Subject { name: &buffer.name, format: None, samples: 1 }
}

/// Each output exists, once, and can be left in its state.
fn outputs(frame: &Frame, errors: &mut Vec<Diagnostic>) {
    let mut listed = vec![false; frame.images.len() + frame.buffers.len()];
    for output in &frame.outputs {
        let (number, subject) = match output.resource {
            Resource::Image(image) => (image.0 as usize, frame.images.get(image.0 as usize).map(of_image)),
            Resource::Buffer(buffer) => {
                let at = buffer.0 as usize;
                (frame.images.len() + at, frame.buffers.get(at).map(of_buffer))
            }
        };
        let Some(subject) = subject else {
            errors.push(Diagnostic::new(output.span, "an output does not exist".to_owned()));
            continue;
        };
        if std::mem::replace(&mut listed[number], true) {
            errors.push(Diagnostic::new(output.span, format!("`{}` is an output twice", subject.name)));
        }
        // Samples are resolved on the way out.
        let subject = Subject { samples: 1, ..subject };
        errors.extend(output.after.and_then(|after| lifetimes::check_state(&after, output.span, subject, When::After)));
    }
}

fn image_problem(image: &Image) -> Option<String> {
    let [width, height, depth] = image.extent;
    let largest = width.max(height).max(depth);
    let levels = largest.checked_ilog2().map_or(0, |log| log + 1);
    if image.extent.contains(&0) {
        Some(format!("is {width}×{height}×{depth}; each side has at least 1 texel"))
    } else if !(1..=levels).contains(&image.mips) {
        Some(format!("has {} mip levels; its size allows 1 to {levels}", image.mips))
    } else if image.layers == 0 {
        Some("has no layers".to_owned())
    } else if !matches!(image.samples, 1 | 2 | 4 | 8 | 16) {
        Some(format!("has {} samples; 1, 2, 4, 8 or 16 are possible", image.samples))
    } else if image.samples > 1 && (image.mips > 1 || image.shape != Shape::D2 || depth > 1) {
        Some("is multisampled and has mip levels or depth".to_owned())
    } else if depth > 1 && image.shape != Shape::D3 {
        Some("has depth and is not three-dimensional".to_owned())
    } else if image.shape == Shape::D3 && image.layers > 1 {
        Some("is three-dimensional and has layers".to_owned())
    } else if image.shape == Shape::D3 && image.format.is_depth() {
        Some("is three-dimensional and can't hold depth".to_owned())
    } else if image.shape == Shape::Cube && (width != height || !image.layers.is_multiple_of(6)) {
        Some(format!("is a cube of {width}×{height} with {} layers; cubes are square and have 6", image.layers))
    } else {
        None
    }
}

struct Check<'c> {
    frame: &'c Frame,
    pass: &'c Pass,
    errors: &'c mut Vec<Diagnostic>,
}

impl Check<'_> {
    fn wrong(&mut self, span: Span, what: &str) {
        self.errors.push(Diagnostic::new(span, format!("`{}` {what}", self.pass.name)));
    }

    /// Whether all images and buffers exist, and the parts of them that are named.
    fn resources(&mut self) -> bool {
        let before = self.errors.len();
        let pass = self.pass;
        for sampled in &pass.sampled {
            self.image(sampled.image, sampled.range, sampled.frames_ago, sampled.span);
        }
        pass.storage.iter().for_each(|storage| self.image(storage.image, storage.range, 0, storage.span));
        for target in &pass.color {
            self.image(target.image, target.range, 0, target.span);
            self.one_mip(target.image, target.range, target.span);
        }
        if let Some(depth) = &pass.depth {
            self.image(depth.image, Subresources { aspects: Aspects::empty(), ..depth.range }, 0, depth.span);
            self.one_mip(depth.image, depth.range, depth.span);
            if self.frame.images.get(depth.image.0 as usize).is_some_and(|image| !image.format.is_depth()) {
                self.wrong(depth.span, "tests depth in an image that has none");
            }
        }
        for used in &pass.buffers {
            self.buffer(used.buffer.0, used.frames_ago, used.span);
        }
        for used in &pass.transfers {
            match used.resource {
                Resource::Image(image) => self.image(image, used.range, used.frames_ago, used.span),
                Resource::Buffer(buffer) => self.buffer(buffer.0, used.frames_ago, used.span),
            }
            if used.write && used.frames_ago > 0 {
                self.wrong(used.span, "writes into an earlier frame");
            }
        }
        if let Work::Forward { from, to, .. } = pass.work {
            for image in [from, to] {
                self.image(image, Subresources::WHOLE, 0, pass.span);
                self.one_mip(image, Subresources::WHOLE, pass.span);
            }
        }
        self.errors.len() == before
    }

    fn image(&mut self, index: ImageIndex, range: Subresources, frames_ago: u32, span: Span) {
        let Some(image) = self.frame.images.get(index.0 as usize) else {
            return self.wrong(span, &format!("names image number {}, which does not exist", index.0));
        };
        self.history(&image.lifetime, frames_ago, &image.name, span);
        if range == Subresources::WHOLE {
            return;
        }
        let part = parts::resolve(image, range);
        let inside = |base: u32, count: u32, all: u32| count > 0 && base < all && count <= all - base;
        let planes = !part.aspects.is_empty() && image.format.aspects().contains(part.aspects);
        if !planes || !inside(part.base_mip, part.mips, image.mips) {
            let what =
                format!("names a part of `{}` that it doesn't have: it has {} mip levels", image.name, image.mips);
            self.wrong(span, &what);
        } else if !inside(part.base_layer, part.layers, image.layers) {
            let what = format!("names a part of `{}` that it doesn't have: it has {} layers", image.name, image.layers);
            self.wrong(span, &what);
        }
    }

    fn buffer(&mut self, index: u32, frames_ago: u32, span: Span) {
        match self.frame.buffers.get(index as usize) {
            None => self.wrong(span, &format!("names buffer number {index}, which does not exist")),
            Some(buffer) => self.history(&buffer.lifetime, frames_ago, &buffer.name, span),
        }
    }

    fn history(&mut self, lifetime: &Lifetime, frames_ago: u32, name: &str, span: Span) {
        let most = if let Lifetime::History { frames, .. } = lifetime { *frames } else { 0 };
        if frames_ago > most {
            self.wrong(span, &format!("reads `{name}` of {frames_ago} frames ago, and it keeps {most}"));
        }
    }

    /// What is drawn into or forwarded is one mip level of a flat image.
    fn one_mip(&mut self, index: ImageIndex, range: Subresources, span: Span) {
        let Some(image) = self.frame.images.get(index.0 as usize) else { return };
        if image.shape == Shape::D3 {
            self.wrong(span, &format!("draws into `{}`, which is three-dimensional", image.name));
        } else if parts::resolve(image, range).mips > 1 {
            self.wrong(span, &format!("draws into `{}`, which has mip levels: it can be only one of them", image.name));
        }
    }

    fn work(&mut self) {
        let pass = self.pass;
        let attached = !pass.color.is_empty() || pass.depth.is_some();
        let shaded = match pass.work {
            Work::Draw { .. } => Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER,
            Work::Dispatch { .. } => Stages::COMPUTE_SHADER,
            Work::Custom { .. } => Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER | Stages::COMPUTE_SHADER,
            Work::Copy | Work::Blit { .. } | Work::Fill { .. } | Work::Forward { .. } => Stages::empty(),
        };
        if attached && !matches!(pass.work, Work::Draw { .. }) {
            return self.wrong(pass.span, "has attachments and doesn't draw");
        }
        let fits = |stages: Stages| !stages.is_empty() && shaded.contains(stages);
        let sampled = pass.sampled.iter().filter(|sampled| !fits(sampled.stages)).map(|sampled| &sampled.binding);
        let storage = pass.storage.iter().filter(|storage| !fits(storage.stages)).map(|storage| &storage.binding);
        let buffers = pass.buffers.iter().filter(|used| match used.role {
            BufferRole::Uniform | BufferRole::Storage { .. } => !fits(used.stages),
            BufferRole::Vertex | BufferRole::Index | BufferRole::Indirect => !used.stages.is_empty(),
        });
        let buffers = buffers.map(|used| &self.frame.buffers[used.buffer.0 as usize].name);
        if let Some(name) = sampled.chain(storage).chain(buffers).next() {
            return self.wrong(pass.span, &format!("accesses `{name}` in stages that it doesn't have"));
        }
        let clears = pass.color.iter().filter_map(|target| target.clear).flatten();
        let mut clears = clears.chain(pass.depth.as_ref().and_then(|depth| depth.clear));
        if clears.any(|value| !value.is_finite()) {
            return self.wrong(pass.span, "clears to what is not a finite number");
        }
        let counts = pass.buffers.iter().filter(|used| used.role == BufferRole::Indirect).count();
        let indirect = match &pass.work {
            Work::Draw { draw, .. } => *draw == Draw::Indirect,
            Work::Dispatch { groups, .. } => matches!(groups, Groups::Indirect { .. }),
            _ => false,
        };
        if counts != usize::from(indirect) {
            return self.wrong(pass.span, "needs one buffer of counts if it is indirect, and else none");
        }
        self.transfers();
    }

    fn transfers(&mut self) {
        let pass = self.pass;
        let writes: Vec<bool> = pass.transfers.iter().map(|used| used.write).collect();
        match (&pass.work, &writes[..]) {
            (Work::Copy, [false, true]) => self.copy(&pass.transfers[0], &pass.transfers[1]),
            (Work::Blit { .. }, [false, true]) => self.blit(&pass.transfers[0], &pass.transfers[1]),
            (Work::Copy | Work::Blit { .. }, _) => self.wrong(pass.span, "needs one source and one target"),
            (Work::Fill { value }, [true]) => {
                let format = match pass.transfers[0].resource {
                    Resource::Image(image) => Some(self.frame.images[image.0 as usize].format),
                    Resource::Buffer(_) => None,
                };
                if let Some(what) = value_problem(value, format) {
                    self.wrong(pass.span, &format!("fills with {what}"));
                }
            }
            (Work::Fill { .. }, _) => self.wrong(pass.span, "fills one image or buffer"),
            (Work::Custom { .. }, _) | (_, []) => {}
            _ => self.wrong(pass.span, "transfers and is no copy, blit, fill or custom pass"),
        }
    }

    /// The extent of the one mip level that a transfer is about, its layers and its image.
    fn level(&mut self, used: &TransferUse) -> Option<(Subresources, [u32; 3], &Image)> {
        let Resource::Image(image) = used.resource else { return None };
        let image = &self.frame.images[image.0 as usize];
        let part = parts::resolve(image, used.range);
        Some((part, image.extent.map(|side| (side >> part.base_mip.min(31)).max(1)), image))
    }

    fn copy(&mut self, source: &TransferUse, target: &TransferUse) {
        let span = self.pass.span;
        let bytes = |side: &TransferUse| match side.resource {
            Resource::Buffer(buffer) => self.frame.buffers[buffer.0 as usize].bytes,
            Resource::Image(_) => 0,
        };
        let buffers = [bytes(source), bytes(target)];
        let from = self.level(source).map(|(part, extent, image)| (part, extent, image.format, image.samples));
        let to = self.level(target).map(|(part, extent, image)| (part, extent, image.format, image.samples));
        let problem = match (from, to) {
            (None, None) if buffers[0] > buffers[1] => Some("copies into a buffer that is too small"),
            (None, None) => None,
            (Some((from, size, format, count)), Some((to, other, target_format, samples))) => {
                let same = format == target_format && size == other && from.layers == to.layers;
                let counts = samples == 1 || samples == count;
                let one = from.mips == 1 && to.mips == 1 && from.aspects == to.aspects && counts;
                (!same || !one).then_some("copies between images that differ in format, size, layers or samples")
            }
            (Some((part, extent, format, samples)), None) | (None, Some((part, extent, format, samples))) => {
                let texels = extent.iter().fold(u64::from(part.layers), |all, side| all.saturating_mul((*side).into()));
                let size = buffers[0].max(buffers[1]);
                if part.mips != 1 || samples > 1 && to.is_some() {
                    Some("copies several mip levels or samples at once")
                } else if format.aspects().contains(Aspects::STENCIL) {
                    Some("copies depth with stencil to or from a buffer")
                } else if texels.saturating_mul(format.texel_bytes()) > size {
                    Some("copies between a buffer and an image that is larger")
                } else {
                    None
                }
            }
        };
        if let Some(what) = problem {
            self.wrong(span, what);
        }
        self.apart(source, target);
    }

    fn blit(&mut self, source: &TransferUse, target: &TransferUse) {
        let from = self.level(source).map(|(part, _, image)| (part, image.format, image.samples));
        let to = self.level(target).map(|(part, _, image)| (part, image.format, image.samples));
        let fits = match (from, to) {
            (Some((from, format, samples)), Some((to, target_format, target_samples))) => {
                let kind = |format: Format| (format.is_integer(), format.is_depth());
                let depth = format.is_depth() && format != target_format;
                let counts = (from.mips, to.mips, samples, target_samples) == (1, 1, 1, 1);
                counts && from.layers == to.layers && kind(format) == kind(target_format) && !depth
            }
            _ => false,
        };
        if !fits {
            self.wrong(self.pass.span, "blits between what is not two images of one kind with one sample");
        }
        self.apart(source, target);
    }

    /// Source and target of a transfer may be parts of one image that don't overlap.
    fn apart(&mut self, source: &TransferUse, target: &TransferUse) {
        if source.resource != target.resource || source.frames_ago != target.frames_ago {
            return;
        }
        let overlaps = match source.resource {
            Resource::Buffer(_) => true,
            Resource::Image(image) => parts::overlap(&self.frame.images[image.0 as usize], source.range, target.range),
        };
        if overlaps {
            self.wrong(self.pass.span, "transfers from and to the same part");
        }
    }

    /// A part that is accessed as storage is accessed in no other way, but for being sampled as it was before.
    fn storage(&mut self) {
        let pass = self.pass;
        for (at, storage) in pass.storage.iter().enumerate() {
            if !storage.read && !storage.write {
                self.wrong(storage.span, &format!("neither reads nor writes `{}`", storage.binding));
            }
            let image = &self.frame.images[storage.image.0 as usize];
            if image.samples > 1 {
                self.wrong(storage.span, &format!("accesses `{}` as storage, which has several samples", image.name));
            }
            let meets = |other: ImageIndex, range: Subresources| {
                other == storage.image && parts::overlap(image, range, storage.range)
            };
            let others = pass.storage.iter().take(at).any(|other| meets(other.image, other.range))
                || pass.color.iter().any(|target| meets(target.image, target.range))
                || pass.depth.as_ref().is_some_and(|depth| meets(depth.image, depth.range));
            if others {
                let message = format!("`{}` accesses `{}` as storage and in another way", pass.name, image.name);
                let help = "access it once, for reading and writing";
                self.errors.push(Diagnostic::new(storage.span, message).help(help));
            }
        }
        for (at, used) in pass.buffers.iter().enumerate() {
            let writes = |role: BufferRole| matches!(role, BufferRole::Storage { write: true, .. });
            let twice = pass.buffers.iter().take(at).any(|other| {
                (other.buffer, other.frames_ago) == (used.buffer, used.frames_ago)
                    && (writes(other.role) || writes(used.role))
            });
            let name = &self.frame.buffers[used.buffer.0 as usize].name;
            if twice {
                self.wrong(used.span, &format!("writes `{name}` and accesses it in another way"));
            } else if matches!(used.role, BufferRole::Storage { read: false, write: false }) {
                self.wrong(used.span, &format!("neither reads nor writes `{name}`"));
            } else if writes(used.role) && used.frames_ago > 0 {
                self.wrong(used.span, &format!("writes `{name}` of an earlier frame"));
            }
        }
    }
}
