//! Before `link`: a frame that was built in memory may hold what no pipeline file can say.

mod eyes;
mod lifetimes;
mod transfers;

use super::parts;
use crate::base::{Diagnostic, Span};
use crate::frame::{
    Buffer, BufferRole, Draw, Frame, Groups, Image, ImageIndex, Lifetime, Output, Pass, Resolve, ResolveWay, Resource,
    Work,
};
use crate::vulkan::states::{Subject, When};
use crate::vulkan::{Aspects, Format, ResolveMode, Shape, Stages, Subresources};

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
        let problem = image_problem(image).or_else(|| eyes::image_problem(image, frame.stereo));
        let problem = problem.map(|what| Diagnostic::new(image.span, format!("`{}` {what}", image.name)));
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
    views(frame, &mut errors);
    for pass in &frame.passes {
        let mut check = Check { frame, pass, errors: &mut errors };
        if check.resources() {
            check.work();
            check.storage();
            check.files();
            eyes::pass(frame, pass, &mut errors);
        }
    }
    outputs(frame, &mut errors);
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Whether a frame is legal that differs from a legal one in nothing but sizes and values.
pub(super) fn still_holds(frame: &Frame) -> bool {
    let sizes = frame.images.iter().all(|image| image_problem(image).is_none());
    if !sizes || frame.buffers.iter().any(|buffer| buffer.bytes == 0) {
        return false;
    }
    let mut errors = Vec::new();
    for pass in &frame.passes {
        match pass.work {
            Work::Copy | Work::Fill { .. } => Check { frame, pass, errors: &mut errors }.transfers(),
            Work::Draw { .. } if !clears_are_finite(pass) => return false,
            _ => {}
        }
    }
    errors.is_empty()
}

fn clears_are_finite(pass: &Pass) -> bool {
    let mut clears = pass.color.iter().filter_map(|target| target.clear).flatten();
    clears.all(f32::is_finite) && pass.depth.as_ref().and_then(|depth| depth.clear).is_none_or(f32::is_finite)
}

/// Each view has a name of its own and a size, and each pass one of them.
fn views(frame: &Frame, errors: &mut Vec<Diagnostic>) {
    for (number, view) in frame.views.iter().enumerate() {
        if view.extent.contains(&0) {
            let [width, height] = view.extent;
            let message = format!("view `{}` is {width}×{height}; each side has at least 1 texel", view.name);
            errors.push(Diagnostic::new(view.span, message));
        }
        if frame.views[..number].iter().any(|other| other.name == view.name) {
            errors.push(Diagnostic::new(view.span, format!("two views are named `{}`", view.name)));
        }
    }
    for pass in frame.passes.iter().filter(|pass| pass.view.0 as usize >= frame.views.len().max(1)) {
        let message = format!("`{}` draws for view number {}, which does not exist", pass.name, pass.view.0);
        errors.push(Diagnostic::new(pass.span, message));
    }
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
        if let Resource::Image(image) = output.resource
            && matches!(frame.images[image.0 as usize].lifetime, Lifetime::File(_))
        {
            let message = format!("`{}` is an output and comes from a file: no pass makes it", subject.name);
            errors.push(Diagnostic::new(output.span, message));
        }
        if let Resource::Image(image) = output.resource
            && let image = &frame.images[image.0 as usize]
            && image.room.is_some()
        {
            // Of what is dumped no file says that it is an output.
            let span = if output.span == Span::NONE { image.span } else { output.span };
            let message = format!("`{}` can't leave the frame: its size may change from frame to frame", subject.name);
            let help = "scale it into an image of a fixed size, and let that leave the frame";
            errors.push(Diagnostic::new(span, message).help(help));
        }
        errors.extend(wrong_encoding(frame, output));
        // Samples are resolved on the way out.
        let subject = Subject { samples: 1, ..subject };
        errors.extend(output.after.and_then(|after| lifetimes::check_state(&after, output.span, subject, When::After)));
    }
}

/// What is wrong with an output's encoding: its format can't hold it.
fn wrong_encoding(frame: &Frame, output: &Output) -> Option<Diagnostic> {
    let encoding = output.encoding?;
    let name = encoding.name();
    let image = match output.resource {
        Resource::Image(image) => &frame.images[image.0 as usize],
        Resource::Buffer(buffer) => {
            let message =
                format!("`{}` is a buffer and has no encoding `{name}`", frame.buffers[buffer.0 as usize].name);
            return Some(Diagnostic::new(output.span, message).help("leave `encoding` out"));
        }
    };
    if encoding.fits(image.format) {
        return None;
    }
    let message = format!("`{}` can't leave the frame as `{name}`: it is {}", image.name, image.format);
    let help = encoding.help(&image.name);
    Some(Diagnostic::new(output.span, message).label(image.span, "declared here").help(help))
}

fn image_problem(image: &Image) -> Option<String> {
    let [width, height, depth] = image.extent;
    let largest = width.max(height).max(depth);
    let levels = largest.checked_ilog2().map_or(0, |log| log + 1);
    let short = image.room.is_some_and(|[wide, high]| wide < width || high < height);
    let changes = image.room.is_some();
    if image.extent.contains(&0) {
        Some(format!("is {width}×{height}×{depth}; each side has at least 1 texel"))
    } else if !(1..=levels).contains(&image.mips) {
        Some(format!("has {} mip levels; its size allows 1 to {levels}", image.mips))
    } else if short {
        Some(format!("is {width}×{height}, and has no room for that"))
    } else if changes && (image.shape != Shape::D2 || image.mips > 1 || image.lifetime != Lifetime::Transient) {
        Some("changes its size, so it is transient, two-dimensional and has one mip level".to_owned())
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
    } else if let Some(Resolve { way, .. }) = &image.resolve
        && !resolvable(image.format, *way)
    {
        Some(format!("can't be resolved as it says: it is {}", image.format))
    } else if matches!(image.lifetime, Lifetime::File(_)) && (image.layers > 1 || image.shape == Shape::Cube) {
        Some("comes from a file and has layers".to_owned())
    } else if image.shape == Shape::Cube && (width != height || !image.layers.is_multiple_of(6)) {
        Some(format!("is a cube of {width}×{height} with {} layers; cubes are square and have 6", image.layers))
    } else {
        None
    }
}

/// Whether images of a format can be resolved in a way.
fn resolvable(format: Format, way: ResolveWay) -> bool {
    match way {
        ResolveWay::DepthOnly => format.is_depth(),
        ResolveWay::By(_) if format.is_depth() => true,
        ResolveWay::By(mode) if format.is_integer() => mode == ResolveMode::SampleZero,
        ResolveWay::By(mode) => mode == ResolveMode::Average,
        ResolveWay::Weighted => !format.is_depth() && !format.is_integer(),
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

    /// What comes from a file is only sampled.
    fn files(&mut self) {
        if let Some((span, what)) = lifetimes::misused_file(self.frame, self.pass) {
            self.wrong(span, &what);
            if let Some(error) = self.errors.last_mut() {
                error.help = Some(
                    "passes only sample a texture: declare an image and draw into that; the shader `copy` copies into it"
                        .to_owned(),
                );
            }
        }
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
        match (attached, matches!(pass.work, Work::Draw { .. })) {
            (true, false) => return self.wrong(pass.span, "has attachments and doesn't draw"),
            (false, true) => return self.wrong(pass.span, "draws into nothing: it has no attachment"),
            _ => {}
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
        if !clears_are_finite(pass) {
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
            if image.room.is_some() {
                let what =
                    format!("accesses `{}` as storage, which changes its size: it can be drawn into", image.name);
                self.wrong(storage.span, &what);
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
