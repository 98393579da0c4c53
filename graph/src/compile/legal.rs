//! Before `link`: a frame that was built in memory may hold what no pipeline file can say.

use crate::describe::Diagnostic;
use crate::frame::{Frame, Image, ImageIndex, Lifetime, Pass, Resource, Work};
use crate::vocabulary::{Stages, Subresources};

/// Reports what no device could do, and what a Plan has no place for yet.
pub(super) fn check(frame: &Frame) -> Result<(), Vec<Diagnostic>> {
    let mut errors = Vec::new();
    for image in &frame.images {
        errors.extend(image_problem(image).map(|what| Diagnostic::new(image.span, format!("`{}` {what}", image.name))));
    }
    for pass in &frame.passes {
        errors.extend(pass_problem(pass).map(|what| Diagnostic::new(pass.span, format!("`{}` {what}", pass.name))));
        errors.extend(flat_problem(frame, pass));
    }
    errors.extend(frame.passes.iter().filter_map(|pass| not_yet(frame, pass)));
    let mut listed = vec![false; frame.images.len()];
    for output in &frame.outputs {
        let Resource::Image(image) = output.resource else { continue };
        if listed.get_mut(image.0 as usize).is_some_and(|listed| std::mem::replace(listed, true)) {
            let name = &frame.images[image.0 as usize].name;
            errors.push(Diagnostic::new(output.span, format!("`{name}` is an output twice")));
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
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
    } else if image.samples > 1 && (image.mips > 1 || depth > 1) {
        Some("is multisampled and has mip levels or depth".to_owned())
    } else {
        None
    }
}

fn pass_problem(pass: &Pass) -> Option<String> {
    let possible = match pass.work {
        Work::Draw { .. } => Stages::VERTEX_SHADER | Stages::FRAGMENT_SHADER,
        Work::Dispatch { .. } => Stages::COMPUTE_SHADER,
        _ => Stages::empty(),
    };
    let attached = !pass.color.is_empty() || pass.depth.is_some();
    if attached && !matches!(pass.work, Work::Draw { .. }) {
        return Some("has attachments and doesn't draw".to_owned());
    }
    let bound = pass.sampled.iter().map(|sampled| (&sampled.binding, sampled.stages));
    let mut bound = bound.chain(pass.storage.iter().map(|storage| (&storage.binding, storage.stages)));
    if let Some((binding, _)) = bound.find(|(_, stages)| stages.is_empty() || !possible.contains(*stages)) {
        return Some(format!("accesses `{binding}` in stages that it doesn't have"));
    }
    if let Some(storage) = pass.storage.iter().find(|storage| !storage.read && !storage.write) {
        return Some(format!("neither reads nor writes `{}`", storage.binding));
    }
    let clears = pass.color.iter().filter_map(|target| target.clear).flatten();
    let mut clears = clears.chain(pass.depth.as_ref().and_then(|depth| depth.clear));
    clears.any(|value| !value.is_finite()).then(|| "clears to what is not a finite number".to_owned())
}

/// What is drawn into or forwarded has one mip level and no depth, what a storage access shares with another nothing.
fn flat_problem(frame: &Frame, pass: &Pass) -> Option<Diagnostic> {
    let image = |index: ImageIndex| frame.images.get(index.0 as usize);
    let forwarded = match pass.work {
        Work::Forward { from, to, .. } => [Some(from), Some(to)],
        _ => [None, None],
    };
    let attached = pass.color.iter().map(|target| target.image).chain(pass.depth.as_ref().map(|depth| depth.image));
    let mut drawn = attached.chain(forwarded.into_iter().flatten()).filter_map(image);
    if let Some(deep) = drawn.find(|image| image.mips > 1 || image.extent[2] > 1) {
        let message = format!("`{}` draws into `{}`, which has mip levels or depth", pass.name, deep.name);
        return Some(Diagnostic::new(pass.span, message));
    }
    let storages = || pass.storage.iter();
    for (at, storage) in storages().enumerate() {
        let other = storages().take(at).any(|other| other.image == storage.image)
            || pass.color.iter().any(|target| target.image == storage.image)
            || pass.depth.as_ref().is_some_and(|depth| depth.image == storage.image);
        let name = &image(storage.image)?.name;
        if other {
            let message = format!("`{}` accesses `{name}` as storage and in another way", pass.name);
            return Some(Diagnostic::new(storage.span, message).help("access it once, for reading and writing"));
        }
        let sampled = pass.sampled.iter().any(|sampled| sampled.image == storage.image);
        if sampled && storage.read && storage.write && image(storage.image)?.mips > 1 {
            let message = format!("`{}` samples `{name}` while it writes it, and it has mip levels", pass.name);
            return Some(Diagnostic::new(storage.span, message));
        }
    }
    None
}

/// What the stages after this one don't know yet.
fn not_yet(frame: &Frame, pass: &Pass) -> Option<Diagnostic> {
    let whole = |range: &Subresources| *range == Subresources::WHOLE;
    let known = matches!(pass.work, Work::Draw { .. } | Work::Dispatch { .. } | Work::Forward { .. })
        && pass.buffers.is_empty()
        && pass.transfers.is_empty()
        && !pass.side_effect
        && pass.sampled.iter().all(|sampled| whole(&sampled.range) && sampled.frames_ago == 0)
        && pass.storage.iter().all(|storage| whole(&storage.range))
        && pass.color.iter().all(|target| whole(&target.range))
        && pass.depth.iter().all(|depth| whole(&depth.range) && depth.stencil.is_none())
        && frame.images.iter().all(|image| image.lifetime == Lifetime::Transient);
    (!known).then(|| Diagnostic::new(pass.span, format!("`{}` needs what can't be compiled yet", pass.name)))
}
