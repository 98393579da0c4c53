//! Checks a frame before `link`: a frame that was built in memory may hold contradictions that no pipeline file can state.

mod eyes;
mod lifetimes;
mod pass;

use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Buffer, Frame, Image, Lifetime, Output, Resource, Stereo, check};
use crate::vulkan::Layout;
use crate::vulkan::states::{StateTime, Subject};
use pass::{Check, wrong_clear};

/// Most images, buffers and passes of a frame: their numbers have room to spare in 32 bits.
const MOST: usize = 1 << 24;

/// The help where an image in a compressed format is no texture.
const UNCOMPRESSED: &str = "compressed images are textures of files, or imported: choose another format";

/// Reports work that no device could do, and parts that do not fit together.
pub(super) fn check(frame: &Frame) -> Result<(), Vec<Diagnostic>> {
    let mut errors = Vec::new();
    if frame.images.len().max(frame.buffers.len()).max(frame.passes.len()) > MOST {
        let message = format!("a frame has at most {MOST} images, buffers and passes each");
        return Err(vec![Diagnostic::new(Code::FRAME_TOO_LARGE, Span::NONE, message)]);
    }
    let (mut has_eyes, mut has_files, mut has_compressed) = (false, false, false);
    for image in &frame.images {
        has_eyes |= image.eyes.is_some();
        has_files |= matches!(image.lifetime, Lifetime::File(_));
        has_compressed |= image.format.is_compressed();
        let before = errors.len();
        check::images::check(image, image, &mut errors);
        if errors.len() > before {
            continue;
        }
        if let Some((code, what)) = problem(image, frame.stereo) {
            errors.push(Diagnostic::new(code, image.span, format!("`{}` {what}", image.name)));
        } else if let Some(wrong) = lifetimes::check(&image.lifetime, image.span, || of_image(image)) {
            errors.push(wrong);
        } else if let Some(what) = lifetimes::compression_problem(image) {
            let wrong = Diagnostic::new(Code::FORMAT_COMPRESSED, image.span, format!("`{}` {what}", image.name));
            errors.push(wrong.help(UNCOMPRESSED));
        }
    }
    for buffer in &frame.buffers {
        let empty = (buffer.bytes == 0)
            .then(|| Diagnostic::new(Code::BUFFER_SIZE, buffer.span, format!("`{}` has no bytes", buffer.name)));
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
            check.uses();
            if has_files {
                check.files();
            }
            if has_compressed {
                check.compressed();
            }
            if has_eyes || pass.both_eyes {
                eyes::pass(frame, pass, &mut errors);
            }
        }
    }
    outputs(frame, &mut errors);
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Whether a frame is valid that differs from a valid one in nothing but values: those of fills and clears can be wrong.
pub(super) fn still_holds(frame: &Frame) -> bool {
    let mut errors = Vec::new();
    for pass in &frame.passes {
        if pass.work.filled().is_some() {
            Check { frame, pass, errors: &mut errors }.transfers();
        } else if pass.work.is_draw() && wrong_clear(frame, pass).is_some() {
            return false;
        }
    }
    errors.is_empty()
}

/// What is wrong with how an image is resolved, holds eyes, or comes from a file.
fn problem(image: &Image, stereo: Stereo) -> Option<(Code, String)> {
    let unfit = image.resolve.as_ref().is_some_and(|resolve| !resolve.way.fits(image.format));
    if unfit {
        return Some((Code::RESOLVE_UNFIT, format!("can't be resolved as it says: it is {}", image.format)));
    }
    let of_eyes = eyes::image_problem(image, stereo).map(|what| (Code::BOTH_EYES, what));
    of_eyes.or_else(|| lifetimes::shape_problem(image).map(|what| (Code::LIFETIME, what)))
}

/// Each view has a name of its own and a size, and each pass one of them.
fn views(frame: &Frame, errors: &mut Vec<Diagnostic>) {
    for (number, view) in frame.views.iter().enumerate() {
        if view.extent.contains(&0) {
            let [width, height] = view.extent;
            let message = format!("view `{}` is {width}×{height}; each side has at least 1 texel", view.name);
            errors.push(Diagnostic::new(Code::SIZE_OUTSIDE, view.span, message));
        }
        if frame.views[..number].iter().any(|other| other.name == view.name) {
            errors.push(Diagnostic::new(Code::NAME_TAKEN, view.span, format!("two views are named `{}`", view.name)));
        }
    }
    for pass in frame.passes.iter().filter(|pass| pass.view.0 as usize >= frame.views.len().max(1)) {
        let message = format!("`{}` draws for view number {}, which does not exist", pass.name, pass.view.0);
        errors.push(Diagnostic::new(Code::NO_SUCH_NUMBER, pass.span, message));
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
            errors.push(Diagnostic::new(Code::NO_SUCH_NUMBER, output.span, "an output does not exist".to_owned()));
            continue;
        };
        if std::mem::replace(&mut listed[number], true) {
            errors.push(Diagnostic::new(
                Code::LISTED_TWICE,
                output.span,
                format!("`{}` is an output twice", subject.name),
            ));
        }
        if let Resource::Image(image) = output.resource
            && matches!(frame.images[image.0 as usize].lifetime, Lifetime::File(_))
        {
            let message = format!("`{}` is an output and comes from a file: no pass makes it", subject.name);
            errors.push(Diagnostic::new(Code::TEXTURE_WRITTEN, output.span, message));
        } else if let Some(format) = subject.format.filter(|format| format.is_compressed()) {
            let message = format!("`{}` is an output and is {format}, a compressed format", subject.name);
            errors.push(Diagnostic::new(Code::FORMAT_COMPRESSED, output.span, message).help(UNCOMPRESSED));
        }
        if let Resource::Image(image) = output.resource
            && let image = &frame.images[image.0 as usize]
            && image.allocated.is_some()
            && output.after.is_some_and(|after| after.layout == Layout::PresentSrcKhr)
        {
            // The program may ask for a state by itself.
            let span = if output.span == Span::NONE { image.span } else { output.span };
            let message =
                format!("`{}` can't be shown in a window: its size may change from frame to frame", subject.name);
            let help = "scale it into an image of the size `Output`, and show that";
            errors.push(Diagnostic::new(Code::SHOWN_SIZE, span, message).help(help));
        }
        errors.extend(wrong_encoding(frame, output));
        // Samples are resolved on the way out.
        let subject = Subject { samples: 1, ..subject };
        errors.extend(
            output.after.and_then(|after| lifetimes::check_state(&after, output.span, subject, StateTime::After)),
        );
    }
}

/// The mistake in an output's encoding, if the output's format can't hold it.
fn wrong_encoding(frame: &Frame, output: &Output) -> Option<Diagnostic> {
    let encoding = output.encoding?;
    match output.resource {
        Resource::Image(image) => {
            let image = &frame.images[image.0 as usize];
            check::images::wrong_encoding(image, encoding, image, output.span)
        }
        Resource::Buffer(_) => {
            let message =
                format!("`{}` is a buffer and has no encoding `{}`", frame.name(output.resource), encoding.name());
            Some(Diagnostic::new(Code::ENCODING, output.span, message).help("leave `encoding` out"))
        }
    }
}
