//! `link`: follows the contents of each part through the passes. Checks that earlier passes wrote all that is read, and finds
//! out what is kept and whether all passes are needed.
//!
//! Order in the frame gives meaning: a pass reads the versions that stand before itself, even of images it also writes.

use super::parts::Parts;
use crate::base::Diagnostic;
use crate::frame::{Access, BufferIndex, Frame, ImageIndex, Lifetime, Pass, Resource};
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
    let mut linker = Linker {
        parts,
        writers: vec![NOTHING; parts.len()],
        needed: vec![false; frame.passes.len() + 1],
        written: Vec::with_capacity(8),
        errors: Vec::new(),
    };
    let mut begin = |resource: Resource, lifetime: &Lifetime| {
        kept.push(parts.of(resource));
        if lifetime.has_contents(resource) {
            linker.writers[parts.of(resource)].fill(BEFORE);
        }
    };
    for (image, number) in frame.images.iter().zip(0..).filter(|(image, _)| image.lifetime.outlives_frame()) {
        begin(Resource::Image(ImageIndex(number)), &image.lifetime);
    }
    for (buffer, number) in frame.buffers.iter().zip(0..).filter(|(buffer, _)| buffer.lifetime.outlives_frame()) {
        begin(Resource::Buffer(BufferIndex(number)), &buffer.lifetime);
    }
    for (pass, number) in frame.passes.iter().zip(1_u32..) {
        linker.pass(pass, number);
    }
    for output in &frame.outputs {
        let of_output = parts.of(output.resource);
        if linker.writers[of_output.clone()].contains(&NOTHING) {
            let name = parts.name(output.resource);
            linker.errors.push(
                Diagnostic::new(output.span, format!("output `{name}` is never written"))
                    .help("let a pass write it, or take it out of `outputs`"),
            );
        }
        kept.push(of_output);
    }
    let Linker { writers, mut needed, errors, .. } = linker;
    if !errors.is_empty() {
        return Err(errors);
    }
    for writer in kept.iter().flat_map(|parts| &writers[parts.clone()]).filter(|writer| **writer != NOTHING) {
        needed[*writer as usize] = true;
    }
    // `needed` may mark too many passes, never too few: a read counts even if its pass is culled. `all_are_needed` is exact, because
    // all passes behind the last culled one stay, and none of them reads its writes.
    let all_are_needed = frame.passes.iter().zip(&needed[1..]).all(|(pass, needed)| *needed || pass.side_effect);
    Ok(Linked { kept, all_are_needed })
}

/// A part has no contents.
const NOTHING: u32 = u32::MAX;
/// A part has contents from before the first pass.
const BEFORE: u32 = 0;

struct Linker<'l> {
    parts: &'l Parts<'l>,
    /// The last pass that wrote each part, counted from 1; [`NOTHING`], [`BEFORE`].
    writers: Vec<u32>,
    /// Whether each pass, counted from 1, wrote what a later one reads; the entry before them stands for contents from before.
    needed: Vec<bool>,
    /// The parts that the current pass writes.
    written: Vec<u32>,
    errors: Vec<Diagnostic>,
}

impl Linker<'_> {
    /// Links one pass. Later passes alone can read its writes, so these are noted once all its reads are known.
    #[inline]
    fn pass(&mut self, pass: &Pass, number: u32) {
        let parts = self.parts;
        parts.for_each_access(pass, |access, part, reads, writes| {
            if reads {
                if self.writers[part as usize] == NOTHING {
                    // Reported once for each part.
                    self.writers[part as usize] = BEFORE;
                    self.report_unwritten(pass, access, writes);
                }
                self.needed[self.writers[part as usize] as usize] = true;
            }
            if writes {
                self.written.push(part);
            }
        });
        for part in &self.written {
            if std::mem::replace(&mut self.writers[*part as usize], number) == number {
                let name = parts.name_of(*part);
                let message = format!("`{}` writes `{name}` in two ways at once", pass.name);
                self.errors.push(Diagnostic::new(pass.span, message));
            }
        }
        self.written.clear();
    }

    /// Reports an access that needs contents where nothing has written any.
    fn report_unwritten(&mut self, pass: &Pass, access: &Access<'_>, writes: bool) {
        let (name, pass, span) = (self.parts.name(access.resource()), &pass.name, access.span());
        let message = if writes {
            format!("`{pass}` is the first to write `{name}`, and may leave parts of it untouched")
        } else {
            format!("`{pass}` reads `{name}` before anything has written it")
        };
        let help = if writes { "clear it" } else { "a pass reads what passes above it wrote" };
        let repeated = self
            .errors
            .last()
            .is_some_and(|last| last.message == message && last.labels.first().is_some_and(|label| label.span == span));
        if !repeated {
            self.errors.push(Diagnostic::new(span, message).help(help));
        }
    }
}
