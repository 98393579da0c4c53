//! Outputs of the Plan, and where each gets its encoding.

use super::stage_results::{StageResults, resource_id};
use crate::frame::{Frame, ImageIndex, Pass, Resource as Declared, Work};
use crate::plan::Output;
use crate::vulkan::{Encoding, Format, Numeric};

/// The outputs in the frame's order.
pub(super) fn outputs(results: &StageResults<'_>) -> Vec<Output> {
    let frame = results.frame;
    let resources = results.adapted.outputs.iter().map(|resource| &results.adapted.resources[*resource as usize]);
    let outputs = resources.zip(&frame.outputs).map(|(resource, declared)| {
        let format = resource.image().map(|image| image.format);
        let encoding = declared.encoding.or_else(|| format.and_then(Encoding::of));
        let encoded = match (declared.resource, format, encoding) {
            (Declared::Image(image), Some(format), Some(Encoding::Srgb | Encoding::Hdr10)) => {
                Some(encoded(frame, image, format))
            }
            _ => None,
        };
        Output {
            name: frame.name(declared.resource).clone(),
            resource: resource_id(resource),
            encoding,
            encoded,
            eye: declared.eye,
        }
    });
    outputs.collect()
}

/// Where an image gets its encoding: from its last writer.
fn encoded(frame: &Frame, image: ImageIndex, format: Format) -> String {
    let by_format = format.numeric() == Numeric::Srgb;
    let (mut image, mut before) = (image, frame.passes.len());
    // A copy doesn't change bits, so its source was encoded earlier.
    while let Some((at, pass)) = last_writer(frame, image, before) {
        let name = &pass.name;
        let from = match pass.work.is_copy() {
            true => source(pass),
            false => pass.work.forwarded().map(|[from, _]| from),
        };
        if let Some(from) =
            from.filter(|from| frame.images[from.0 as usize].format == frame.images[image.0 as usize].format)
        {
            (image, before) = (from, at);
            continue;
        }
        return match &pass.work {
            Work::Copy => format!("before pass `{name}` copies it"),
            Work::Custom { callback } => format!("by `{callback}`, which pass `{name}` calls"),
            _ if by_format => format!("by the format, when `{name}` stores"),
            Work::Draw { shader, .. } | Work::Dispatch { shader, .. } => {
                format!("by shader `{shader}` of pass `{name}`")
            }
            Work::Fill { .. } => format!("in the value that pass `{name}` fills it with"),
            Work::Blit { .. } | Work::Forward { .. } => format!("before pass `{name}` passes it on"),
        };
    }
    format!("before the frame: no pass writes `{}`", frame.images[image.0 as usize].name)
}

/// The last pass before number `before` that writes `image`, with its number.
fn last_writer(frame: &Frame, image: ImageIndex, before: usize) -> Option<(usize, &Pass)> {
    let declared = frame.images.get(image.0 as usize);
    let writes =
        |pass: &Pass| pass.accesses().any(|it| it.resource() == Declared::Image(image) && it.writes(pass, declared));
    frame.passes[..before].iter().enumerate().rev().find(|(_, pass)| writes(pass))
}

/// The image that a copy reads.
fn source(copy: &Pass) -> Option<ImageIndex> {
    copy.transfers.iter().find(|used| !used.write).and_then(|used| match used.resource {
        Declared::Image(image) => Some(image),
        Declared::Buffer(_) => None,
    })
}
