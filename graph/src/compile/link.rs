//! `link`: follows the contents of each part through the passes. Refuses passes that read what nothing wrote, and finds out what
//! is kept and whether all passes are needed.

use crate::base::{Code, Diagnostic};
use crate::frame::check::contents::{Contents, MissingContents, NOTHING};
use crate::frame::tracked_parts::Parts;
use crate::frame::{BufferIndex, Frame, ImageIndex, Lifetime, Resource};
use std::ops::Range;

/// What a frame leaves, and whether any pass can be culled.
#[derive(Debug)]
pub(super) struct FrameLinks {
    /// The parts that are needed when the frame is done.
    pub(super) kept: Vec<Range<usize>>,
    /// Whether no pass can be culled; `false` where that isn't known, because a pass doesn't run in every frame.
    pub(super) all_are_needed: bool,
}

pub(super) fn link(frame: &Frame, parts: &Parts<'_>) -> Result<FrameLinks, Vec<Diagnostic>> {
    let mut kept: Vec<Range<usize>> = Vec::new();
    let mut contents = Contents::new(parts, frame.passes.len());
    let mut begin = |of: Resource, lifetime: &Lifetime| {
        kept.push(parts.of(of));
        if lifetime.has_contents(of) {
            contents.begin(of);
        }
    };
    for (image, number) in frame.images.iter().zip(0..).filter(|(image, _)| image.lifetime.outlives_frame()) {
        begin(Resource::Image(ImageIndex(number)), &image.lifetime);
    }
    for (buffer, number) in frame.buffers.iter().zip(0..).filter(|(buffer, _)| buffer.lifetime.outlives_frame()) {
        begin(Resource::Buffer(BufferIndex(number)), &buffer.lifetime);
    }
    let mut errors = Vec::new();
    for (pass, number) in frame.passes.iter().zip(1_u32..) {
        for found in contents.pass(pass, number) {
            unwritten(frame, &pass.name, &found, &mut errors);
        }
    }
    for output in &frame.outputs {
        if contents.output(output.resource, output.span).is_some() {
            let message = format!("output `{}` is never written", frame.name(output.resource));
            let help = "let a pass write it, or take it out of `outputs`";
            errors.push(Diagnostic::new(Code::NEVER_WRITTEN, output.span, message).help(help));
        }
        kept.push(parts.of(output.resource));
    }
    let Contents { writers, mut needed, twice, .. } = contents;
    for (number, of) in twice {
        let pass = &frame.passes[number as usize - 1];
        let message = format!("`{}` writes `{}` in two ways at once", pass.name, frame.name(of));
        errors.push(Diagnostic::new(Code::WRITTEN_IN_TWO_WAYS, pass.span, message));
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    for writer in kept.iter().flat_map(|parts| &writers[parts.clone()]).filter(|writer| **writer != NOTHING) {
        needed[*writer as usize] = true;
    }
    // `needed` may mark too many passes, never too few: a read counts even if its pass is culled. Where all passes run in every frame,
    // `all_are_needed` is exact, because all passes behind the last culled one stay, and none of them reads its writes. A pass that
    // runs in some frames needs what it overwrites only if that is read.
    let all_are_needed = frame.passes.iter().all(|pass| pass.run.is_always());
    let all_are_needed =
        all_are_needed && frame.passes.iter().zip(&needed[1..]).all(|(pass, needed)| *needed || pass.side_effect);
    Ok(FrameLinks { kept, all_are_needed })
}

/// Says that a pass needs what nothing has written, once for all planes.
fn unwritten(frame: &Frame, pass: &str, found: &MissingContents, errors: &mut Vec<Diagnostic>) {
    let name = frame.name(found.of);
    let (code, message, help) = if found.writes {
        let message = format!("`{pass}` is the first to write `{name}`, and may leave parts of it untouched");
        (Code::NOT_CLEARED, message, "clear it")
    } else {
        let message = format!("`{pass}` reads `{name}` before anything has written it");
        (Code::READ_BEFORE_WRITTEN, message, "a pass reads what passes above it wrote")
    };
    let wrong = Diagnostic::new(code, found.span, message).help(help);
    if errors.last() != Some(&wrong) {
        errors.push(wrong);
    }
}
