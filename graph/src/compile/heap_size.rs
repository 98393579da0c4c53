//! Whether a device has the memory that a Plan takes.

use crate::base::{Code, Diagnostic, Span, amount};
use crate::device::{ImageDescriptor, MemoryEstimate, MemoryProvider, Profile};
use crate::frame::Frame;
use crate::plan::{Image, Plan};

/// The error for a Plan of `frame` that takes more memory than the largest heap of `device` has; `None` if it fits, or the
/// profile doesn't know the heap's size.
#[must_use]
pub fn too_large(plan: &Plan, frame: &Frame, device: &Profile) -> Option<Diagnostic> {
    let heap = device.memory.heap_bytes?;
    let takes = plan.totals.placed_bytes.saturating_add(plan.totals.kept_bytes);
    if takes <= heap {
        return None;
    }
    let images = plan.images.iter().map(|image| (&*image.name, bytes(image, device)));
    let buffers = plan.buffers.iter().map(|buffer| (&*buffer.name, buffer.bytes));
    let parts: Vec<(&str, u64)> = images.chain(buffers).collect();
    let largest = parts.iter().max_by_key(|(_, bytes)| *bytes).map(|(name, _)| *name);
    let span = largest.map_or(Span::NONE, |name| place(frame, name));
    // The same for all variants of a pipeline that are too large.
    let message = "the frame takes more memory than the device has";
    let help = format!(
        "it takes {} of {}, for {}: make images and buffers smaller or fewer, or choose fewer samples or smaller formats",
        amount::bytes(takes),
        amount::bytes(heap),
        amount::largest(parts)
    );
    Some(Diagnostic::new(Code::TOO_MUCH_MEMORY, span, message).help(help))
}

/// Where the image or buffer of this name is declared. Inserted images have its name and a suffix: "color (resolved)".
fn place(frame: &Frame, name: &str) -> Span {
    let images = frame.images.iter().map(|image| (&*image.name, image.span));
    let declared = images.chain(frame.buffers.iter().map(|buffer| (&*buffer.name, buffer.span)));
    let of = declared.filter(|(declared, _)| {
        name.strip_prefix(declared).is_some_and(|suffix| suffix.is_empty() || suffix.starts_with(" ("))
    });
    // An element of a list is called so too: "level (2)".
    of.max_by_key(|(declared, _)| declared.len()).map_or(Span::NONE, |(_, span)| span)
}

/// The bytes of an image.
fn bytes(image: &Image, device: &Profile) -> u64 {
    if let Some(placement) = image.role.placement() {
        return placement.bytes;
    }
    let Image { format, shape, mips, samples, usage, sharing, .. } = *image;
    let (extent, layers) = (image.made(), image.made_layers());
    MemoryEstimate(device)
        .image(&ImageDescriptor { format, shape, extent, mips, layers, samples, usage, sharing })
        .bytes
}
