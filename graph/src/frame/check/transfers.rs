//! Copies, blits and fills: both sides fit together.

use super::{CheckContext, Place, Property};
use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Buffer, BufferIndex, Draw, Image, ImageIndex, Pass, Resource, TransferUse, Work};
use crate::vulkan::{Aspects, Filter, Shape, Subresources};

/// Reports what is wrong with the transfers of a pass. The parts that it names lie within their images.
pub(crate) fn check(checked: &impl CheckContext, pass: &Pass, errors: &mut Vec<Diagnostic>) {
    let mut check = Check { checked, errors };
    match (&pass.work, &pass.transfers[..]) {
        (Work::Copy, [source, target]) if !source.write && target.write => check.copy([source, target]),
        (Work::Blit { filter }, [source, target]) if !source.write && target.write => {
            check.blit([source, target], *filter);
        }
        (Work::Copy | Work::Blit { .. }, _) => {
            check.wrong(Code::PASS_PARTS, pass.span, "it needs one source and one target")
        }
        (Work::Fill { value }, [target]) if target.write => {
            let format = check.side(target).map(|side| side.image.format);
            if let Some(what) = value.problem(format) {
                check.wrong(Code::FILL_UNFIT, target.span, format!("it fills with {what}"));
            }
        }
        (Work::Fill { .. }, _) => check.wrong(Code::PASS_PARTS, pass.span, "it fills one image or buffer"),
        (Work::Custom { .. }, transfers) => check.one_part(transfers),
        (Work::Draw { draw: Draw::Custom, .. }, [used, ..]) => {
            let drawn = Diagnostic::new(Code::PASS_PARTS, used.span, "nothing is transferred beside targets");
            check.errors.push(drawn.help("name it in `storage`, or in `uniform`, and say in `uses` how it is used"));
        }
        (Work::Draw { .. } | Work::Dispatch { .. } | Work::Forward { .. }, transfers) => {
            if !transfers.is_empty() {
                check.wrong(Code::PASS_PARTS, pass.span, "it transfers and is no copy, blit, fill or custom pass");
            }
        }
    }
}

/// Why a blit mixes in texels that nobody wrote, if it does: a linear filter looks beyond the part of its source that a frame uses.
pub(crate) fn looks_beyond(checked: &impl CheckContext, pass: &Pass) -> Option<String> {
    let (Work::Blit { filter: Filter::Linear }, Some([from, _])) = (&pass.work, pass.moved_images()) else {
        return None;
    };
    let image = checked.image(from).filter(|image| image.allocated.is_some())?;
    Some(format!("`{}` scales `{}`, of which a frame uses a part, with a linear filter", pass.name, image.name))
}

/// A part of an image with several mip levels where one is needed, named at `here`. `declared`: where the image's are declared.
pub(crate) fn several_levels(image: &Image, [here, declared]: [Span; 2], what: &str) -> Diagnostic {
    let name = &image.name;
    Diagnostic::new(Code::PART_UNSAID, here, format!("`{name}` has {} mip levels: say which one {what}", image.mips))
        .label(declared, "declared here")
        .help(format!("write `(image: \"{name}\", mip: 0)`"))
}

/// A copy of what an earlier frame left in an image that changes its size.
fn another_size(Image { name, .. }: &Image, here: Span) -> Diagnostic {
    let message =
        format!("`{name}` may have had another size in that frame, and a copy moves as many texels in each frame");
    let help = format!(
        "draw it: `draw: FullScreen(\"copy\")` with `sample: {{\"source\": (image: \"{name}\", previous: 1)}}` is told how large it was"
    );
    Diagnostic::new(Code::EARLIER_SIZE, here, message).help(help)
}

/// A side that is an image.
struct Side<'c> {
    span: Span,
    index: ImageIndex,
    image: &'c Image,
    /// Its part, with planes named.
    part: Subresources,
    /// Width, height and depth of the first mip level of the part.
    extent: [u32; 3],
}

impl Side<'_> {
    /// "640×360", "64×64×64", "640×360, 6 layers"
    fn size(&self) -> String {
        let [width, height, depth] = self.extent;
        let deep = if depth > 1 { format!("×{depth}") } else { String::new() };
        let layers = match self.part.layers {
            1 => String::new(),
            several => format!(", {several} layers"),
        };
        format!("{width}×{height}{deep}{layers}")
    }

    /// "D32_SFLOAT_S8_UINT", "stencil of D32_SFLOAT_S8_UINT"
    fn texels(&self) -> String {
        let format = self.image.format;
        match self.part.aspects {
            planes if planes == format.aspects() => format.to_string(),
            Aspects::STENCIL => format!("stencil of {format}"),
            _ => format!("depth of {format}"),
        }
    }
}

struct Check<'c, C> {
    checked: &'c C,
    errors: &'c mut Vec<Diagnostic>,
}

impl<'c, C: CheckContext> Check<'c, C> {
    #[track_caller]
    fn wrong(&mut self, code: Code, at: Span, message: impl Into<String>) {
        self.errors.push(Diagnostic::new(code, at, message));
    }

    /// A side as an image; `None` if it is a buffer, or nothing is known of it.
    fn side(&self, used: &TransferUse) -> Option<Side<'c>> {
        let Resource::Image(index) = used.resource else { return None };
        let image = self.checked.image(index)?;
        let part = image.part(used.range);
        Some(Side { span: used.span, index, image, part, extent: image.extent_at(part.base_mip) })
    }

    /// A side as an image of one mip level. `None` if it is a buffer, or after a mistake was reported.
    fn one_level(&mut self, at: usize, used: &TransferUse) -> Option<Side<'c>> {
        let side = self.side(used)?;
        if used.frames_ago > 0 && side.image.allocated.is_some() {
            self.errors.push(another_size(side.image, side.span));
            return None;
        }
        if side.part.mips == 1 {
            return Some(side);
        }
        let places =
            [Place::PartOfSide(at), Place::Image(side.index, Property::Mips)].map(|place| self.checked.span(place));
        self.errors.push(several_levels(side.image, places, "is copied"));
        None
    }

    /// What a pass of the program reads and writes is one part of an image, not parts that overlap: it is in one layout.
    fn one_part(&mut self, transfers: &[TransferUse]) {
        for written in transfers.iter().filter(|used| used.write) {
            let Resource::Image(index) = written.resource else { continue };
            let Some(image) = self.checked.image(index).filter(|image| image.samples == 1) else { continue };
            let overlaps = |read: &&TransferUse| {
                !read.write
                    && (read.resource, read.frames_ago) == (written.resource, written.frames_ago)
                    && image.part(read.range) != image.part(written.range)
                    && image.overlap(read.range, written.range)
            };
            if let Some(read) = transfers.iter().find(overlaps) {
                let message = format!("it reads and writes parts of `{}` that overlap and aren't the same", image.name);
                let wrong = Diagnostic::new(Code::PASS_PARTS, written.span, message).label(read.span, "read here");
                self.errors.push(wrong.help("name the same parts in `reads` and `writes`, one by one"));
            }
        }
    }

    fn copy(&mut self, sides: [&TransferUse; 2]) {
        let [source, target] = sides;
        match (source.resource, target.resource) {
            (Resource::Buffer(from), Resource::Buffer(to)) => {
                if let (Some(from), Some(to)) = (self.checked.buffer(from), self.checked.buffer(to)) {
                    self.buffers(sides, from, to);
                }
            }
            (Resource::Image(_), Resource::Image(_)) => {
                let (from, to) = (self.one_level(0, source), self.one_level(1, target));
                if let (Some(from), Some(to)) = (from, to) {
                    self.apart(sides, &from, &to);
                    self.same_texels(&from, &to);
                }
            }
            (Resource::Image(_), Resource::Buffer(buffer)) => {
                if let Some(image) = self.one_level(0, source) {
                    self.rows(&image, (target, buffer), true);
                }
            }
            (Resource::Buffer(buffer), Resource::Image(_)) => {
                if let Some(image) = self.one_level(1, target) {
                    self.rows(&image, (source, buffer), false);
                }
            }
        }
    }

    /// A buffer is not copied onto itself. A copy fills its target whole; a program's may say that it keeps the rest.
    fn buffers(&mut self, [source, target]: [&TransferUse; 2], from: &Buffer, to: &Buffer) {
        let fits = from.bytes == to.bytes || target.keeps && from.bytes < to.bytes;
        if (source.resource, source.frames_ago) == (target.resource, target.frames_ago) {
            self.wrong(Code::TRANSFER_TO_ITSELF, target.span, "a buffer can't be copied to itself");
        } else if !fits {
            let rule =
                if from.bytes < to.bytes { "a copy fills its target whole" } else { "it has no room for a copy" };
            let message =
                format!("`{}` has {} bytes and `{}` has {}: {rule}", from.name, from.bytes, to.name, to.bytes);
            let help = format!("let one follow the other: say `bytes: Like(\"{}\")` of `{}`", from.name, to.name);
            self.errors.push(Diagnostic::new(Code::BUFFER_SIZE_UNFIT, target.span, message).help(help));
        }
    }

    /// A part of an image is not copied or scaled onto itself.
    fn apart(&mut self, [source, target]: [&TransferUse; 2], from: &Side<'_>, to: &Side<'_>) {
        let one = (source.resource, source.frames_ago) == (target.resource, target.frames_ago);
        if one && from.image.overlap(source.range, target.range) {
            let itself =
                Diagnostic::new(Code::TRANSFER_TO_ITSELF, to.span, "a part of an image can't be copied to itself");
            self.errors.push(itself.label(from.span, "copied from here"));
        }
    }

    /// Reports, by `wrong`, texels that can't become those of the other side: their formats don't go together, or their planes differ.
    fn same_planes(&mut self, [from, to]: [&Side<'_>; 2], go_together: bool, wrong: impl FnOnce() -> Diagnostic) {
        if !go_together || from.part.aspects != to.part.aspects {
            self.errors.push(wrong().remark(to.texels()).label(from.span, from.texels()));
        }
    }

    /// Texels have as many bytes, samples and planes, and lie in as large images. A program's samples may be resolved on the way.
    fn same_texels(&mut self, from: &Side<'_>, to: &Side<'_>) {
        let (one, other) = (from.image, to.image);
        let differ = |what| {
            let message = format!("`{}` can't be copied to `{}`: their {what} differ", one.name, other.name);
            Diagnostic::new(Code::COPY_UNFIT, to.span, message)
        };
        self.same_planes([from, to], one.format.copies_to(other.format), || {
            differ("texels").help("a copy takes bits as they are: a blit or a draw converts")
        });
        if one.samples != other.samples && (C::OF_FILE || other.samples > 1) {
            let declared = self.checked.span(Place::Image(from.index, Property::Samples));
            let wrong = differ("sample counts").remark(format!("{}× a texel", other.samples));
            self.errors.push(wrong.label(declared, format!("{}× a texel", one.samples)));
        }
        if (from.extent, from.part.layers) != (to.extent, to.part.layers) {
            self.errors.push(differ("sizes").remark(to.size()).label(from.span, from.size()).help("a blit scales"));
        }
    }

    /// The texels of one plane lie in the buffer. A copy fills its target whole: a file's up to a multiple of 4 bytes, and a program's
    /// may say that it keeps the rest. A program's samples may be resolved on the way.
    fn rows(&mut self, side: &Side<'_>, (used, buffer): (&TransferUse, BufferIndex), filled: bool) {
        let Image { name, format, samples, .. } = side.image;
        if *samples > 1 && (C::OF_FILE || !filled) {
            let message = format!("`{name}` has {samples} samples, which a buffer can't take or give");
            self.errors.push(Diagnostic::new(Code::COPY_UNFIT, side.span, message));
        }
        let texel = format.plane_bytes(side.part.aspects);
        if texel.is_none() {
            let message = format!("`{name}` has depth and stencil ({format}): say which of them");
            let help = format!("write `(image: \"{name}\", plane: Depth)`");
            self.errors.push(Diagnostic::new(Code::PLANE, side.span, message).help(help));
        }
        let Some(there) = self.checked.buffer(buffer) else { return };
        let texel = texel.or(format.plane_bytes(Aspects::DEPTH)).unwrap_or(0);
        let layers = u64::from(side.part.layers);
        let texels = side.extent.iter().fold(layers, |all, side| all.saturating_mul((*side).into()));
        let bytes = texels.saturating_mul(texel);
        let wanted = bytes.checked_next_multiple_of(4);
        let too_small = bytes > there.bytes;
        let all = if C::OF_FILE { wanted == Some(there.bytes) } else { bytes == there.bytes || used.keeps };
        if !too_small && (!filled || all) {
            return;
        }
        let message = format!("`{}` has {} bytes, but the texels of `{name}` take {bytes}", there.name, there.bytes);
        let wrong = Diagnostic::new(Code::BUFFER_SIZE_UNFIT, used.span, message);
        let wrong = wrong.remark(if too_small { "too small" } else { "only a part would be filled" });
        let wrong = wrong.label(there.span, "declared here");
        self.errors.push(match wanted.filter(|_| filled) {
            Some(wanted) => wrong.help(format!("a copy fills its target whole: give it `bytes: {wanted}`")),
            None => wrong,
        });
    }

    /// Two images of one sample, with as many layers, and formats that can be converted and filtered. A program may scale between deep
    /// and flat ones.
    fn blit(&mut self, sides: [&TransferUse; 2], filter: Filter) {
        if sides.iter().any(|side| matches!(side.resource, Resource::Buffer(_))) {
            return self.wrong(Code::BLIT_UNFIT, sides[0].span, "a buffer can't be scaled");
        }
        let (Some(from), Some(to)) = (self.one_level(0, sides[0]), self.one_level(1, sides[1])) else { return };
        self.apart(sides, &from, &to);
        for Side { span, image: Image { name, samples, .. }, .. } in [&from, &to] {
            if *samples > 1 {
                let message = format!("`{name}` has {samples} samples and can't be scaled");
                let help = "draw it, or let a pass that samples it have it resolved";
                self.errors.push(Diagnostic::new(Code::BLIT_UNFIT, *span, message).help(help));
            }
        }
        let (one, other) = (from.image, to.image);
        let format = one.format;
        let message = format!("`{}` can't be scaled into `{}`", one.name, other.name);
        self.same_planes([&from, &to], format.blits_to(other.format), || {
            let depth = "and depth to the same planes of the same format";
            let help = format!("unsigned integers go to unsigned ones, signed ones to signed ones, {depth}");
            Diagnostic::new(Code::BLIT_UNFIT, to.span, &*message).help(help)
        });
        if filter == Filter::Linear && (format.is_integer() || format.is_depth()) {
            let held = if format.is_integer() { "integers" } else { "depth" };
            let why = format!("`{}` holds {held} ({format})", one.name);
            self.wrong(
                Code::LINEAR_FILTER,
                self.checked.span(Place::Filter),
                format!("a linear filter can't be used: {why}"),
            );
        }
        // The last levels of a volume are one texel deep.
        let volumes = [one, other].iter().all(|image| image.shape == Shape::D3);
        let depths = C::OF_FILE && !volumes && (from.extent[2] > 1) != (to.extent[2] > 1);
        if from.part.layers != to.part.layers || depths {
            let wrong =
                Diagnostic::new(Code::BLIT_UNFIT, to.span, format!("{message}: their layers differ")).remark(to.size());
            self.errors.push(wrong.label(from.span, from.size()));
        }
    }
}
