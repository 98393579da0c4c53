//! `link`: follows the contents of each part through the passes. Refuses passes that read what nothing wrote, and finds out what
//! is kept and whether all passes are needed.

use super::parts::Parts;
use crate::base::Diagnostic;
use crate::frame::check::contents::{Contents, NOTHING, Reader, Unwritten};
use crate::frame::{BufferIndex, Frame, ImageIndex, Lifetime, Resource};
use std::ops::Range;

/// What a frame leaves, and whether any pass can be culled.
#[derive(Debug)]
pub(super) struct Linked {
    /// The parts that are needed when the frame is done.
    pub(super) kept: Vec<Range<usize>>,
    /// Whether no pass can be culled.
    pub(super) all_are_needed: bool,
}

pub(super) fn link(frame: &Frame, parts: &Parts<'_>) -> Result<Linked, Vec<Diagnostic>> {
    let mut kept: Vec<Range<usize>> = Vec::new();
    let mut contents = Contents::new(parts);
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
    let mut linker = Linker { frame, pass: 0, needed: vec![false; frame.passes.len() + 1], errors: Vec::new() };
    for (pass, number) in frame.passes.iter().zip(1_u32..) {
        linker.pass = number;
        contents.pass(pass, number, &mut linker);
    }
    for output in &frame.outputs {
        contents.output(output.resource, output.span, &mut linker);
        kept.push(parts.of(output.resource));
    }
    let Linker { mut needed, errors, .. } = linker;
    if !errors.is_empty() {
        return Err(errors);
    }
    let writers = kept.iter().flat_map(|parts| &contents.writers[parts.clone()]);
    writers.filter(|writer| **writer != NOTHING).for_each(|writer| needed[*writer as usize] = true);
    // `needed` may mark too many passes, never too few: a read counts even if its pass is culled. `all_are_needed` is exact, because
    // all passes behind the last culled one stay, and none of them reads its writes.
    let all_are_needed = frame.passes.iter().zip(&needed[1..]).all(|(pass, needed)| *needed || pass.side_effect);
    Ok(Linked { kept, all_are_needed })
}

struct Linker<'l> {
    frame: &'l Frame,
    /// The number of the current pass, counted from 1.
    pass: u32,
    /// Whether each pass, counted from 1, wrote what a later one reads; the entry before them stands for contents from before.
    needed: Vec<bool>,
    errors: Vec<Diagnostic>,
}

impl Reader for Linker<'_> {
    #[inline(always)]
    fn reads(&mut self, writer: u32) {
        self.needed[writer as usize] = true;
    }

    #[cold]
    fn unwritten(&mut self, Unwritten { of, access, writes, span, .. }: Unwritten<'_>) {
        let name = self.frame.name(of);
        let pass = || &self.frame.passes[self.pass as usize - 1].name;
        let (message, help) = match (access, writes) {
            (None, _) => {
                (format!("output `{name}` is never written"), "let a pass write it, or take it out of `outputs`")
            }
            (Some(_), true) => {
                let message =
                    format!("`{}` is the first to write `{name}`, and may leave parts of it untouched", pass());
                (message, "clear it")
            }
            (Some(_), false) => {
                let message = format!("`{}` reads `{name}` before anything has written it", pass());
                (message, "a pass reads what passes above it wrote")
            }
        };
        let same = |last: &&Diagnostic| last.labels.first().is_some_and(|label| label.span == span);
        if self.errors.last().filter(same).is_none_or(|last| last.message != message) {
            self.errors.push(Diagnostic::new(span, message).help(help));
        }
    }

    #[cold]
    fn writes_twice(&mut self, of: Resource) {
        let (pass, name) = (&self.frame.passes[self.pass as usize - 1], self.frame.name(of));
        let message = format!("`{}` writes `{name}` in two ways at once", pass.name);
        self.errors.push(Diagnostic::new(pass.span, message));
    }
}
