//! Sample counts, and a frame's other demands on its images, against the device's limits.

use super::formats::Formats;
use super::needs::{Needs, Supports};
use crate::base::{Code, Diagnostic, Span};
use crate::compile::model::Negotiated;
use crate::device::Profile;
use crate::frame::{Blend, Frame, Image, ImageIndex, Pass, Resource};
use crate::plan::{Note, NoteKind};
use crate::vulkan::{Filter, Format, Sampler, Shape, Usage};
use petgraph::unionfind::UnionFind;
use std::collections::{BTreeMap, BTreeSet};

/// Lowers each sample count to the highest that every image attached together with it supports.
pub(crate) fn negotiate(frame: &Frame, live: &[u32], formats: &Formats<'_>) -> Result<Negotiated, Vec<Diagnostic>> {
    let (needs, supports) = (&formats.needs, &formats.supports);
    let device = supports.device;
    let samples: Vec<u32> = frame.images.iter().map(|image| image.samples).collect();
    let multisampled = samples.iter().any(|count| *count > 1);
    let attachments = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT;
    let attached = needs.iter().any(|needs| needs.usage.intersects(attachments));
    // Nothing is asked of the other passes here.
    let passes = if attached || multisampled || !formats.are_met { live } else { &[] };
    // These serve multisampled images alone.
    let count = if multisampled { frame.images.len() } else { 0 };
    let (mut together, mut forwarded) = (UnionFind::<u32>::new(count), vec![false; count]);
    let mut errors = Vec::new();
    for pass in passes.iter().map(|pass| &frame.passes[*pass as usize]) {
        if multisampled && let Some((first, _)) = pass.attachments().next() {
            pass.attachments().for_each(|(other, _)| _ = together.union(first.0, other.0));
        }
        if !formats.are_met {
            check_operations(frame, pass, supports, &mut errors);
        }
        let (targets, most) = (pass.color.len(), device.max_color_attachments);
        if targets > most as usize {
            let message = format!("`{}` draws into {targets} colour images; `{}` has {most}", pass.name, device.name);
            errors.push(Diagnostic::new(Code::TOO_MANY_TARGETS, pass.span, message).help("split the pass"));
        }
        if multisampled && pass.work.keeps_samples() {
            copied_together(frame, pass, &mut together);
        }
        if multisampled && let Some([from, to]) = pass.work.forwarded() {
            forwarded[to.0 as usize] = true;
            if frame.images[from.0 as usize].samples == frame.images[to.0 as usize].samples {
                together.union(from.0, to.0);
            }
        }
    }
    for (image, needs) in needs.iter().enumerate().filter(|(_, needs)| !needs.usage.is_empty()) {
        check_support(frame, image, needs.usage, supports, &mut errors);
    }
    let mut groups: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (image, forwarded) in forwarded.into_iter().enumerate().filter(|(image, _)| samples[*image] > 1) {
        if !needs[image].usage.is_empty() || forwarded {
            groups.entry(together.find(image as u32)).or_default().push(image);
        }
    }
    let mut negotiated = Negotiated { samples, multisampled, attached, notes: Vec::new() };
    for group in groups.values() {
        lower(frame, group, supports, &mut negotiated);
    }
    negotiated.multisampled &= negotiated.samples.iter().any(|count| *count > 1);
    if errors.is_empty() { Ok(negotiated) } else { Err(errors) }
}

/// The longest side that an image of this shape can have.
fn largest(image: &Image, device: &Profile) -> u32 {
    if image.shape == Shape::D3 { device.max_extent_3d } else { device.max_attachment_extent }
}

/// Joins the images of a copy of single samples: they need equal sample counts.
fn copied_together(frame: &Frame, pass: &Pass, together: &mut UnionFind<u32>) {
    let images = pass.transfers.iter().filter_map(|used| match used.resource {
        Resource::Image(image) if frame.images[image.0 as usize].samples > 1 => Some((image, used.write)),
        _ => None,
    });
    if let Some((to, _)) = images.clone().find(|(_, written)| *written) {
        for (from, _) in images {
            together.union(from.0, to.0);
        }
    }
}

/// An image and all images that need its sample count because passes attach them together.
pub(crate) fn drawn_together(passes: &[Pass], image: ImageIndex) -> BTreeSet<ImageIndex> {
    let mut together = BTreeSet::from([image]);
    loop {
        let before = together.len();
        for pass in passes {
            let drawn = || pass.attachments().map(|(image, _)| image);
            if drawn().any(|image| together.contains(&image)) {
                together.extend(drawn());
            }
        }
        if together.len() == before {
            return together;
        }
    }
}

fn check_support(frame: &Frame, image: usize, used: Usage, supports: &Supports<'_>, errors: &mut Vec<Diagnostic>) {
    let (declared, device) = (&frame.images[image], supports.device);
    let [width, height, depth] = declared.made();
    let largest = largest(declared, device);
    if width.max(height).max(depth) > largest {
        let (size, limit) = match declared.shape {
            Shape::D3 => (format!("{width}×{height}×{depth}"), format!("{largest}×{largest}×{largest}")),
            Shape::D2 | Shape::Cube => (format!("{width}×{height}"), format!("{largest}×{largest}")),
        };
        let message = format!("`{}` is {size}", declared.name);
        let least = if declared.shape == Shape::D3 { "1×1×1" } else { "1×1" };
        let help = format!("`{}` has images from {least} to {limit}", device.name);
        errors.push(Diagnostic::new(Code::IMAGE_TOO_LARGE, declared.span, message).help(help));
    }
    let layers = declared.made_layers();
    if layers > device.max_layers {
        let message = format!("`{}` has {layers} layers", declared.name);
        let help = format!("`{}` has images of up to {} layers", device.name, device.max_layers);
        errors.push(Diagnostic::new(Code::IMAGE_TOO_LARGE, declared.span, message).help(help));
    }
    let supported = supports.of_shape(declared.format, declared.shape).map_or(Usage::empty(), |support| support.usage);
    if !supported.contains(used) {
        let missing = used.difference(supported).iter_names().map(|(name, _)| name).collect::<Vec<_>>().join(", ");
        let message = format!("`{}` can't be {} on `{}`: no {missing}", declared.name, declared.format, device.name);
        let mut wrong = Diagnostic::new(Code::FORMAT_UNSUPPORTED, declared.span, message);
        let mut stored = frame.passes.iter().flat_map(|pass| &pass.storage).filter(|it| it.image.0 as usize == image);
        if let Some(storage) = stored.next().filter(|_| !supported.contains(Usage::STORAGE)) {
            wrong = wrong.label(storage.span, "a shader stores it here");
        }
        errors.push(wrong.help(others(frame, ImageIndex(image as u32), supports)));
    }
}

/// The formats of the same kind that support all uses of an image.
fn others(frame: &Frame, index: ImageIndex, supports: &Supports<'_>) -> String {
    let image = &frame.images[index.0 as usize];
    let format = image.format;
    let needs = Needs::of(frame, frame.passes.iter())[index.0 as usize];
    let alike = |other: &&Format| other.aspects() == format.aspects() && other.is_integer() == format.is_integer();
    let able = |other: &&Format| {
        !other.is_compressed() && supports.of(**other).is_some() && needs.are_met(supports.of(**other))
    };
    let names: Vec<String> = Format::ALL.iter().filter(alike).filter(able).map(|it| format!("`{it}`")).collect();
    match &names[..] {
        [] => format!("`{}` has no format of this kind for that", supports.device.name),
        names => {
            let (names, device) = (names.join(", "), &supports.device.name);
            format!("write another `format` of `{}`: {names}, which `{device}` has for that", image.name)
        }
    }
}

/// Checks that formats support linear filtering and blending where a pass uses them.
fn check_operations(frame: &Frame, pass: &Pass, supports: &Supports<'_>, errors: &mut Vec<Diagnostic>) {
    let mut refuse = |image: ImageIndex, span: Span, what: &str, help: &str| {
        let image = &frame.images[image.0 as usize];
        let message = format!(
            "`{}` can't {what} `{}`: `{}` can't do that with {}",
            pass.name, image.name, supports.device.name, image.format
        );
        errors
            .push(Diagnostic::new(Code::FORMAT_OPERATION, span, message).label(image.span, "declared here").help(help));
    };
    let support = |image: ImageIndex| supports.of(frame.images[image.0 as usize].format);
    for sampled in pass.sampled.iter().filter(|sampled| sampled.sampler.is_linear()) {
        if support(sampled.image).is_some_and(|support| !support.linear_filter) {
            let nearest = |filter: Filter, field: &str| match filter {
                Filter::Linear => format!(", {field}: Nearest"),
                Filter::Nearest => String::new(),
            };
            let Sampler { filter, mips, .. } = sampled.sampler;
            let fields = nearest(filter, "filter") + &nearest(mips, "mip_filter");
            let name = &frame.images[sampled.image.0 as usize].name;
            let help = format!("write `(image: \"{name}\"{fields})`, or choose another format");
            refuse(sampled.image, sampled.span, "filter", &help);
        }
    }
    for target in pass.color.iter().filter(|target| target.blend != Blend::Replace) {
        if support(target.image).is_some_and(|support| !support.blend) {
            refuse(target.image, target.span, "blend into", &others(frame, target.image, supports));
        }
    }
}

fn lower(frame: &Frame, group: &[usize], supports: &Supports<'_>, negotiated: &mut Negotiated) {
    let wanted = group.iter().map(|image| frame.images[*image].samples).max().unwrap_or(1);
    let counts = |format: Format| supports.of(format).map_or(&[][..], |support| &support.samples);
    let supported = |count: u32| group.iter().all(|image| counts(frame.images[*image].format).contains(&count));
    let chosen = (1..=wanted).rev().find(|count| supported(*count)).unwrap_or(1);
    for image in group {
        negotiated.samples[*image] = chosen;
    }
    if chosen != wanted {
        let first = &frame.images[group[0]];
        let mut formats: Vec<&str> = Vec::new();
        for name in group.iter().map(|image| frame.images[*image].format.name()) {
            if !formats.contains(&name) {
                formats.push(name);
            }
        }
        let formats = formats.join(" with ");
        let got = if chosen == 1 { "1 sample".to_owned() } else { format!("{chosen} samples") };
        // One sample is offered by every format that can be drawn into.
        let mut offered: Vec<String> = [1, 2, 4, 8, 16, 32, 64]
            .into_iter()
            .filter(|it| *it == 1 || supported(*it))
            .map(|it| it.to_string())
            .collect();
        let last = offered.pop().unwrap_or_default();
        let offered = if offered.is_empty() { last } else { format!("{} and {last}", offered.join(", ")) };
        let text = format!("{got} instead of {wanted}: `{}` offers {offered} for {formats}", supports.device.name);
        let at = frame.sources.place(first.span);
        negotiated.notes.push(Note::new(NoteKind::OtherSamples, first.name.clone(), text, at));
    }
}
