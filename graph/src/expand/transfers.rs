//! Copies, blits and fills: the source must fit the target.

use super::fills;
use super::parts::{self, Cells};
use super::resources::Resources;
use crate::base::Diagnostic;
use crate::frame::{Image, Pass, Resource, TransferUse, Work};
use crate::language::{self, Fill, ImagePart, Part};
use crate::ron::Spanned;
use crate::vulkan::{Aspects, Filter, Shape};

/// One side of a transfer that is an image.
struct Side<'a> {
    image: &'a Image,
    part: &'a ImagePart,
    cells: Cells,
    extent: [u32; 3],
}

impl Side<'_> {
    fn layers(&self) -> u32 {
        self.cells.layers.end - self.cells.layers.start
    }

    /// "640×360", "64×64×64", "640×360, 6 layers"
    fn size(&self) -> String {
        let [width, height, depth] = self.extent;
        let deep = if depth > 1 { format!("×{depth}") } else { String::new() };
        let layers = match self.layers() {
            1 => String::new(),
            several => format!(", {several} layers"),
        };
        format!("{width}×{height}{deep}{layers}")
    }
}

/// The side as an image of one mip level. `None` if it is a buffer, or after a mistake was reported.
fn side<'a>(
    resources: &'a Resources<'_>,
    part: &'a Part,
    transfer: &TransferUse,
    errors: &mut Vec<Diagnostic>,
) -> Option<Side<'a>> {
    let Part::Image(part) = part else { return None };
    let image = &resources.image(part.image.index)?.image;
    let cells = parts::cells(image, &transfer.range);
    one_mip(resources, image, part, &cells, "is copied", errors)?;
    let extent = image.extent_at(cells.mips.start);
    Some(Side { image, part, cells, extent })
}

/// Reports a part of several mip levels where one is needed.
pub(super) fn one_mip(
    resources: &Resources<'_>,
    image: &Image,
    part: &ImagePart,
    cells: &Cells,
    what: &str,
    errors: &mut Vec<Diagnostic>,
) -> Option<()> {
    if cells.mips.len() == 1 {
        return Some(());
    }
    let (name, count) = (&image.name, image.mips);
    let message = format!("`{name}` has {count} mip levels: say which one {what}");
    let declared = resources.declared(part.image.index).mips.span;
    errors.push(
        Diagnostic::new(parts::place(part), message)
            .label(declared, "declared here")
            .help(format!("write `(image: \"{name}\", mip: 0)`")),
    );
    None
}

/// Reports a copy that can't be.
pub(super) fn copy(resources: &Resources<'_>, [from, to]: [&Part; 2], lowered: &Pass, errors: &mut Vec<Diagnostic>) {
    let [source, target] = &lowered.transfers[..] else { return };
    match (from, to) {
        (Part::Buffer(one), Part::Buffer(other)) => {
            let (Some(source), Some(target)) =
                (resources.buffer(one.buffer.index), resources.buffer(other.buffer.index))
            else {
                return;
            };
            if one.buffer.index == other.buffer.index && one.previous.is_none() {
                errors.push(Diagnostic::new(other.buffer.span, "a buffer can't be copied to itself"));
            } else if source.bytes != target.bytes {
                let message = format!(
                    "`{}` has {} bytes and `{}` has {}: a copy fills its target whole",
                    source.name, source.bytes, target.name, target.bytes
                );
                let help =
                    format!("let one follow the other: say `bytes: Like(\"{}\")` of `{}`", source.name, target.name);
                errors.push(Diagnostic::new(other.buffer.span, message).help(help));
            }
        }
        (Part::Image(_), Part::Image(_)) => {
            let (one, other) = (side(resources, from, source, errors), side(resources, to, target, errors));
            if let (Some(one), Some(other)) = (one, other) {
                images_fit([&one, &other], [source, target], errors);
                same_texels(resources, &one, &other, errors);
            }
        }
        (Part::Image(_), Part::Buffer(buffer)) => {
            if let Some(image) = side(resources, from, source, errors) {
                rows_fit(resources, &image, &buffer.buffer, true, errors);
            }
        }
        (Part::Buffer(buffer), Part::Image(_)) => {
            if let Some(image) = side(resources, to, target, errors) {
                rows_fit(resources, &image, &buffer.buffer, false, errors);
            }
        }
    }
}

/// Texels have as many bytes, samples and planes, and lie in as large images.
fn same_texels(resources: &Resources<'_>, from: &Side<'_>, to: &Side<'_>, errors: &mut Vec<Diagnostic>) {
    let (one, other) = (from.image, to.image);
    let alike = one.format.copies_to(other.format) && from.cells.planes == to.cells.planes;
    let formats = |span| (span, format!("{}", one.format));
    if !alike {
        let message = format!("`{}` can't be copied to `{}`: their texels differ", one.name, other.name);
        let (span, remark) = formats(from.part.image.span);
        errors.push(
            Diagnostic::new(to.part.image.span, message)
                .remark(format!("{}", other.format))
                .label(span, remark)
                .help("a copy takes bits as they are: a blit or a draw converts"),
        );
    }
    if one.samples != other.samples {
        let message = format!("`{}` can't be copied to `{}`: their sample counts differ", one.name, other.name);
        let declared = resources.declared(from.part.image.index).samples.span;
        errors.push(
            Diagnostic::new(to.part.image.span, message)
                .remark(format!("{}× a texel", other.samples))
                .label(declared, format!("{}× a texel", one.samples)),
        );
    }
    if from.size() != to.size() {
        let message = format!("`{}` can't be copied to `{}`: their sizes differ", one.name, other.name);
        errors.push(
            Diagnostic::new(to.part.image.span, message)
                .remark(to.size())
                .label(from.part.image.span, from.size())
                .help("a blit scales"),
        );
    }
}

/// An image is not copied onto itself.
fn images_fit([from, to]: [&Side<'_>; 2], [source, target]: [&TransferUse; 2], errors: &mut Vec<Diagnostic>) {
    let one = source.resource == target.resource && source.frames_ago == 0;
    if one && from.image.overlap(source.range, target.range) {
        let itself = Diagnostic::new(to.part.image.span, "a part of an image can't be copied to itself");
        errors.push(itself.label(from.part.image.span, "copied from here"));
    }
}

/// The texels of one plane fill the buffer, or lie in it.
fn rows_fit(
    resources: &Resources<'_>,
    image: &Side<'_>,
    buffer: &language::BufferRef,
    filled: bool,
    errors: &mut Vec<Diagnostic>,
) {
    let name = &image.image.name;
    if image.image.samples > 1 {
        let message = format!("`{name}` has {} samples, which a buffer can't take or give", image.image.samples);
        errors.push(Diagnostic::new(image.part.image.span, message));
    }
    if image.cells.planes.bits().count_ones() > 1 {
        let message = format!("`{name}` has depth and stencil ({}): say which of them", image.image.format);
        let help = format!("write `(image: \"{name}\", plane: Depth)`");
        errors.push(Diagnostic::new(image.part.image.span, message).help(help));
    }
    let Some(there) = resources.buffer(buffer.index) else { return };
    let [width, height, depth] = image.extent.map(u64::from);
    // At most 2^14 to the third, 2^11 layers and 2^4 bytes: no more than 2^57.
    let format = image.image.format;
    let texel = format.plane_bytes(image.cells.planes).or(format.plane_bytes(Aspects::DEPTH)).unwrap_or(0);
    let bytes = width * height * depth * u64::from(image.layers()) * texel;
    let fits = if filled { bytes.next_multiple_of(4) == there.bytes } else { bytes <= there.bytes };
    if !fits {
        let wanted = bytes.next_multiple_of(4);
        let message = format!("`{}` has {} bytes, but the texels of `{name}` take {bytes}", there.name, there.bytes);
        let help =
            if filled { format!("a copy fills its target whole: give it `bytes: {wanted}`") } else { String::new() };
        let wrong = Diagnostic::new(buffer.span, message).remark("too small").label(there.span, "declared here");
        let wrong = if filled && bytes < there.bytes { wrong.remark("only a part would be filled") } else { wrong };
        errors.push(if help.is_empty() { wrong } else { wrong.help(help) });
    }
}

/// Reports a blit that can't be.
pub(super) fn blit(
    resources: &Resources<'_>,
    [from, to]: [&Part; 2],
    filter: Option<Spanned<Filter>>,
    lowered: &Pass,
    errors: &mut Vec<Diagnostic>,
) {
    let [source, target] = &lowered.transfers[..] else { return };
    let (one, other) = (side(resources, from, source, errors), side(resources, to, target, errors));
    let (Some(one), Some(other)) = (one, other) else { return };
    images_fit([&one, &other], [source, target], errors);
    for side in [&one, &other] {
        if side.image.samples > 1 {
            let message = format!("`{}` has {} samples and can't be scaled", side.image.name, side.image.samples);
            let help = "draw it, or let a pass that samples it have it resolved";
            errors.push(Diagnostic::new(side.part.image.span, message).help(help));
        }
    }
    let format = one.image.format;
    if !format.blits_to(other.image.format) {
        let message = format!("`{}` can't be scaled into `{}`", one.image.name, other.image.name);
        errors.push(
            Diagnostic::new(other.part.image.span, message)
                .remark(format!("{}", other.image.format))
                .label(one.part.image.span, format!("{}", one.image.format))
                .help(
                    "unsigned integers go to unsigned ones, signed ones to signed ones, and depth to the same format",
                ),
        );
    }
    if let Some(filter) = filter
        && filter.value == Filter::Linear
        && (format.is_integer() || format.is_depth())
    {
        let held = if format.is_integer() { "integers" } else { "depth" };
        let why = format!("`{}` holds {held} ({format})", one.image.name);
        errors.push(Diagnostic::new(filter.span, format!("a linear filter can't be used: {why}")));
    }
    // The last levels of a volume are one texel deep.
    let volumes = [one.image, other.image].iter().all(|image| image.shape == Shape::D3);
    if one.layers() != other.layers() || !volumes && (one.extent[2] > 1) != (other.extent[2] > 1) {
        let message = format!("`{}` can't be scaled into `{}`: their layers differ", one.image.name, other.image.name);
        let wrong = Diagnostic::new(other.part.image.span, message).remark(other.size());
        errors.push(wrong.label(one.part.image.span, one.size()));
    }
}

/// A linear filter mixes in texels beyond the part of an image that a frame uses, which nobody wrote: a blit clamps at the image's edge.
/// A draw clamps at the part's.
pub(super) fn draw_part(resources: &Resources<'_>, lowered: &mut Pass, errors: &mut Vec<Diagnostic>) {
    let (Some(Filter::Linear), [source, target]) = (lowered.work.filter(), &lowered.transfers[..]) else { return };
    let (Resource::Image(from), Resource::Image(to)) = (source.resource, target.resource) else { return };
    let (Some(one), Some(other)) = (resources.image(from), resources.image(to)) else { return };
    let (one, other) = (&one.image, &other.image);
    if one.allocated.is_none() {
        return;
    }
    let why = format!("`{}` scales `{}`, of which a frame uses a part, with a linear filter", lowered.name, one.name);
    if other.part(target.range) != other.whole() || other.layers > 1 || other.mips > 1 {
        let message = format!("{why}, and a blit would mix in texels beyond that part");
        let help =
            format!("draw it: `draw: FullScreen(\"copy\"), sample: {{\"source\": \"{}\"}}, color: […]`", one.name);
        return errors.push(Diagnostic::new(target.span, message).label(source.span, one.name.to_string()).help(help));
    }
    lowered.work = Work::Forward { from, to, because: why.clone() };
    lowered.transfers.clear();
    lowered.inserted = Some(why.into());
}

/// Reports a fill whose value doesn't fit.
pub(super) fn fill(resources: &Resources<'_>, to: &Part, value: Spanned<Fill>, errors: &mut Vec<Diagnostic>) {
    let name = match to {
        Part::Image(part) => resources.image(part.image.index).map(|image| &image.image.name),
        Part::Buffer(part) => resources.buffer(part.buffer.index).map(|buffer| &buffer.name),
    };
    let Some(name) = name else { return };
    if let Err((message, help)) = fills::typed(value.value, resources.filled(to)) {
        errors.push(Diagnostic::new(value.span, format!("`{name}` can't be filled: {message}")).help(help));
    }
}
