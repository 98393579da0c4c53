//! Checks a frame before `link`: a frame that was built in memory may hold contradictions that no pipeline file can state.

mod eyes;
mod lifetimes;
mod pass;
mod transfers;

use crate::base::{Diagnostic, Span};
use crate::frame::{Buffer, Frame, Image, Lifetime, Output, Resolve, Resource, SAMPLE_COUNTS};
use crate::vulkan::Shape;
use crate::vulkan::states::{Subject, When};
use pass::{Check, wrong_clear};

/// Most images, buffers and passes of a frame: their numbers have room to spare in 32 bits.
const MOST: usize = 1 << 24;

/// Reports work that no device could do, and parts that do not fit together.
pub(super) fn check(frame: &Frame) -> Result<(), Vec<Diagnostic>> {
    let mut errors = Vec::new();
    if frame.images.len().max(frame.buffers.len()).max(frame.passes.len()) > MOST {
        let message = format!("a frame has at most {MOST} images, buffers and passes each");
        return Err(vec![Diagnostic::new(Span::NONE, message)]);
    }
    let (mut has_eyes, mut has_files) = (false, false);
    for image in &frame.images {
        has_eyes |= image.eyes.is_some();
        has_files |= matches!(image.lifetime, Lifetime::File(_));
        if let Some(what) = image_problem(image).or_else(|| eyes::image_problem(image, frame.stereo)) {
            errors.push(Diagnostic::new(image.span, format!("`{}` {what}", image.name)));
        } else if let Some(wrong) = lifetimes::check(&image.lifetime, image.span, || of_image(image)) {
            errors.push(wrong);
        }
    }
    for buffer in &frame.buffers {
        let empty =
            (buffer.bytes == 0).then(|| Diagnostic::new(buffer.span, format!("`{}` has no bytes", buffer.name)));
        errors.extend(empty.or_else(|| lifetimes::check(&buffer.lifetime, buffer.span, || of_buffer(buffer))));
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
            if has_files {
                check.files();
            }
            if has_eyes {
                eyes::pass(frame, pass, &mut errors);
            }
        }
    }
    outputs(frame, &mut errors);
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Whether a frame is valid that differs from a valid one in nothing but values.
pub(super) fn still_holds(frame: &Frame) -> bool {
    let mut errors = Vec::new();
    for pass in &frame.passes {
        if pass.work.is_transfer() {
            Check { frame, pass, errors: &mut errors }.transfers();
        } else if pass.work.is_draw() && wrong_clear(frame, pass).is_some() {
            return false;
        }
    }
    errors.is_empty()
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
            && image.allocated.is_some()
        {
            // No file declares a dumped image as an output.
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

/// The mistake in an output's encoding, if the output's format can't hold it.
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
    let [width, height, _] = image.extent;
    if let Some(problem) = size_problem(image) {
        Some(problem)
    } else if image.allocated.is_some()
        && (image.shape != Shape::D2 || image.mips > 1 || image.lifetime != Lifetime::Transient)
    {
        Some("changes its size, so it is transient, two-dimensional and has one mip level".to_owned())
    } else if image.layers == 0 {
        Some("has no layers".to_owned())
    } else if !SAMPLE_COUNTS.contains(&image.samples) {
        Some(format!("has {} samples; 1, 2, 4, 8 or 16 are possible", image.samples))
    } else if image.samples > 1 && (image.mips > 1 || image.shape != Shape::D2) {
        Some("is multisampled and has mip levels or depth".to_owned())
    } else if image.shape == Shape::D3 && image.layers > 1 {
        Some("is three-dimensional and has layers".to_owned())
    } else if image.shape == Shape::D3 && image.format.is_depth() {
        Some("is three-dimensional and can't hold depth".to_owned())
    } else if let Some(Resolve { way, .. }) = &image.resolve
        && !way.fits(image.format)
    {
        Some(format!("can't be resolved as it says: it is {}", image.format))
    } else if matches!(image.lifetime, Lifetime::File(_)) && (image.layers > 1 || image.shape == Shape::Cube) {
        Some("comes from a file and has layers".to_owned())
    } else if image.shape == Shape::Cube && !image.layers.is_multiple_of(6) {
        Some(not_a_cube(width, height, image.layers))
    } else {
        None
    }
}

/// What is wrong with the size of an image, or with what else the size decides about.
#[inline]
fn size_problem(image: &Image) -> Option<String> {
    let [width, height, depth] = image.extent;
    let levels = || width.max(height).max(depth).checked_ilog2().map_or(0, |log| log + 1);
    if image.extent.contains(&0) {
        Some(format!("is {width}×{height}×{depth}; each side has at least 1 texel"))
    } else if image.mips != 1 && !(1..=levels()).contains(&image.mips) {
        Some(format!("has {} mip levels; its size allows 1 to {}", image.mips, levels()))
    } else if image.allocated.is_some_and(|[wide, high]| wide < width || high < height) {
        Some(format!("is {width}×{height}, and has no room for that"))
    } else if depth > 1 && image.shape != Shape::D3 {
        Some("has depth and is not three-dimensional".to_owned())
    } else if image.shape == Shape::Cube && width != height {
        Some(not_a_cube(width, height, image.layers))
    } else {
        None
    }
}

fn not_a_cube(width: u32, height: u32, layers: u32) -> String {
    format!("is a cube of {width}×{height} with {layers} layers; cubes are square and have 6")
}
