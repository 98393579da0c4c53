//! First part of `adapt`: sample counts, formats and sizes meet what the device has.

use super::model::Samples;
use crate::describe::Diagnostic;
use crate::device::Profile;
use crate::format::Format;
use crate::frame::{Blend, Frame, ImageIndex, Pass, Work};
use crate::plan::{Note, Stage};
use crate::source::Span;
use crate::vocabulary::{Filter, Usage};
use petgraph::unionfind::UnionFind;
use std::collections::BTreeMap;

/// Lowers each sample count to the highest that every image attached together with it supports.
pub(super) fn negotiate(frame: &Frame, live: &[u32], device: &Profile) -> Result<Samples, Vec<Diagnostic>> {
    let mut together = UnionFind::<u32>::new(frame.images.len());
    let mut usage = vec![Usage::empty(); frame.images.len()];
    let mut touched = vec![false; frame.images.len()];
    let mut errors = Vec::new();
    for pass in live.iter().map(|pass| &frame.passes[*pass as usize]) {
        note_usage(frame, pass, &mut usage);
        let attached = attachments(pass);
        for pair in attached.windows(2) {
            together.union(pair[0].0, pair[1].0);
        }
        errors.extend(disagreement(frame, pass, &attached));
        check_operations(frame, pass, device, &mut errors);
        let (targets, most) = (pass.color.len(), device.max_color_attachments);
        if targets > most as usize {
            let message = format!("`{}` draws into {targets} colour images; `{}` has {most}", pass.name, device.name);
            errors.push(Diagnostic::new(pass.span, message).help("split the pass"));
        }
        if let Work::Forward { from, to, .. } = pass.work {
            touched[to.0 as usize] = true;
            if frame.images[from.0 as usize].samples == frame.images[to.0 as usize].samples {
                together.union(from.0, to.0);
            }
        }
    }
    let mut groups: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (image, used) in usage.iter().enumerate().filter(|(image, used)| touched[*image] || !used.is_empty()) {
        check_support(frame, image, *used, device, &mut errors);
        if frame.images[image].samples > 1 {
            groups.entry(together.find(image as u32)).or_default().push(image);
        }
    }
    let mut samples = Samples { of: frame.images.iter().map(|image| image.samples).collect(), notes: Vec::new() };
    for group in groups.values() {
        lower(frame, group, device, &mut samples);
    }
    if errors.is_empty() { Ok(samples) } else { Err(errors) }
}

fn attachments(pass: &Pass) -> Vec<ImageIndex> {
    pass.color.iter().map(|target| target.image).chain(pass.depth.as_ref().map(|depth| depth.image)).collect()
}

fn note_usage(frame: &Frame, pass: &Pass, usage: &mut [Usage]) {
    let mut add = |image: ImageIndex, used: Usage| usage[image.0 as usize] |= used;
    let shape = |image: ImageIndex| {
        let image = &frame.images[image.0 as usize];
        (image.format, image.extent)
    };
    pass.sampled.iter().for_each(|sampled| add(sampled.image, Usage::SAMPLED));
    pass.storage.iter().for_each(|storage| add(storage.image, Usage::STORAGE));
    pass.color.iter().for_each(|target| add(target.image, Usage::COLOR_ATTACHMENT));
    pass.depth.iter().for_each(|depth| add(depth.image, Usage::DEPTH_STENCIL_ATTACHMENT));
    if let Work::Forward { from, to, .. } = pass.work
        && shape(from) != shape(to)
    {
        add(from, Usage::SAMPLED);
        add(to, Usage::COLOR_ATTACHMENT);
    }
}

/// Attachments of one pass must have one size and one sample count.
fn disagreement(frame: &Frame, pass: &Pass, attached: &[ImageIndex]) -> Option<Diagnostic> {
    let (first, rest) = attached.split_first()?;
    let shape = |image: &ImageIndex| {
        let image = &frame.images[image.0 as usize];
        (image.extent, image.layers, image.samples)
    };
    let other = rest.iter().find(|other| shape(other) != shape(first))?;
    let words = |image: &ImageIndex| {
        let image = &frame.images[image.0 as usize];
        format!("{}×{} with {} samples", image.extent[0], image.extent[1], image.samples)
    };
    let (a, b) = (&frame.images[first.0 as usize], &frame.images[other.0 as usize]);
    Some(
        Diagnostic::new(
            pass.span,
            format!(
                "`{}` draws into `{}` and `{}`, which differ in size, layers or samples",
                pass.name, a.name, b.name
            ),
        )
        .label(a.span, words(first))
        .label(b.span, words(other))
        .help(format!("let one follow the other: `size: Like(\"{}\"), samples: Like(\"{}\")`", a.name, a.name)),
    )
}

fn check_support(frame: &Frame, image: usize, used: Usage, device: &Profile, errors: &mut Vec<Diagnostic>) {
    let declared = &frame.images[image];
    let largest = declared.extent[0].max(declared.extent[1]);
    if largest > device.max_attachment_extent || declared.extent.contains(&0) {
        let [width, height, _] = declared.extent;
        let message = format!("`{}` is {width}×{height}", declared.name);
        let limit =
            format!("`{}` has images from 1×1 to {limit}×{limit}", device.name, limit = device.max_attachment_extent);
        errors.push(Diagnostic::new(declared.span, message).help(limit));
    }
    let supported = device.format(declared.format).map_or(Usage::empty(), |support| support.usage);
    if !supported.contains(used) {
        let missing = used.difference(supported).iter_names().map(|(name, _)| name).collect::<Vec<_>>().join(", ");
        let message = format!("`{}` can't be {} on `{}`: no {missing}", declared.name, declared.format, device.name);
        errors.push(Diagnostic::new(declared.span, message).help("choose another format"));
    }
}

/// A format can be sampled without being filtered, and drawn into without being blended.
fn check_operations(frame: &Frame, pass: &Pass, device: &Profile, errors: &mut Vec<Diagnostic>) {
    let mut refuse = |image: ImageIndex, span: Span, what: &str, help: &str| {
        let image = &frame.images[image.0 as usize];
        let message = format!(
            "`{}` can't {what} `{}`: `{}` can't do that with {}",
            pass.name, image.name, device.name, image.format
        );
        errors.push(Diagnostic::new(span, message).label(image.span, "declared here").help(help));
    };
    let support = |image: ImageIndex| device.format(frame.images[image.0 as usize].format);
    for sampled in pass.sampled.iter().filter(|sampled| sampled.filter == Filter::Linear) {
        if support(sampled.image).is_some_and(|support| !support.linear_filter) {
            refuse(sampled.image, sampled.span, "filter", "write `filter: Nearest`, or choose another format");
        }
    }
    for target in pass.color.iter().filter(|target| target.blend != Blend::Replace) {
        if support(target.image).is_some_and(|support| !support.blend) {
            refuse(target.image, target.span, "blend into", "choose another format");
        }
    }
}

fn lower(frame: &Frame, group: &[usize], device: &Profile, samples: &mut Samples) {
    let wanted = group.iter().map(|image| frame.images[*image].samples).max().unwrap_or(1);
    let counts = |format: Format| device.format(format).map_or(&[][..], |support| &support.samples);
    let supported = |count: u32| group.iter().all(|image| counts(frame.images[*image].format).contains(&count));
    let chosen = (1..=wanted).rev().find(|count| supported(*count)).unwrap_or(1);
    for image in group {
        samples.of[*image] = chosen;
    }
    if chosen != wanted {
        let first = &frame.images[group[0]];
        let formats = group.iter().map(|image| frame.images[*image].format.name()).collect::<Vec<_>>().join(" with ");
        samples.notes.push(Note {
            stage: Stage::Adapt,
            subject: first.name.clone(),
            text: format!(
                "{wanted} samples were asked for, {chosen} are used: the most, up to {wanted}, that `{}` has for {formats}",
                device.name
            ),
            at: frame.sources.place(first.span),
        });
    }
}
