//! `link`: each access of a pass becomes a read of one version of an image, the making of the next, or both.
//!
//! Order in the frame gives meaning: a pass reads the versions that stand before itself, even of images it also writes.

use crate::describe::Diagnostic;
use crate::frame::{Blend, ColorTarget, Draw, Frame, ImageIndex, Pass, Resource, Work};
use crate::source::Span;
use crate::vocabulary::CompareOp;
use std::ops::Range;

/// A version of an image: what one pass made of it.
pub(super) type Version = u32;

/// What a pass does with one image.
#[derive(Debug, Clone, Copy)]
pub(super) struct VersionUse {
    pub(super) image: ImageIndex,
    /// The version that must be there before: it is sampled, loaded or kept.
    pub(super) reads: Option<Version>,
    /// The version that the pass makes.
    pub(super) writes: Option<Version>,
}

/// All passes' uses, pass by pass.
#[derive(Debug)]
pub(super) struct Linked {
    uses: Vec<VersionUse>,
    starts: Vec<u32>,
    /// Number of versions of all images.
    pub(super) versions: u32,
    /// The last version of each image, if anything writes it.
    pub(super) last: Vec<Option<Version>>,
}

impl Linked {
    /// The uses of pass number `pass`.
    pub(super) fn uses(&self, pass: usize) -> &[VersionUse] {
        &self.uses[self.range(pass)]
    }

    fn range(&self, pass: usize) -> Range<usize> {
        self.starts[pass] as usize..self.starts[pass + 1] as usize
    }
}

/// Whether a draw replaces every pixel of its colour target.
pub(super) fn covers(pass: &Pass, target: &ColorTarget) -> bool {
    let Work::Draw { draw: Draw::FullScreen, discards: false, .. } = pass.work else { return false };
    let tested = pass.depth.as_ref().is_some_and(|depth| depth.test != CompareOp::Always);
    target.blend == Blend::Replace && !tested
}

pub(super) fn link(frame: &Frame) -> Result<Linked, Vec<Diagnostic>> {
    let mut linker = Linker {
        frame,
        current: vec![None; frame.images.len()],
        uses: Vec::with_capacity(frame.passes.len() * 4),
        versions: 0,
        errors: Vec::new(),
    };
    let mut starts = Vec::with_capacity(frame.passes.len() + 1);
    starts.push(0);
    for pass in &frame.passes {
        let first = linker.uses.len();
        linker.pass(pass);
        linker.commit(pass, first);
        starts.push(linker.uses.len() as u32);
    }
    for output in &frame.outputs {
        let Resource::Image(image) = output.resource else { continue };
        if linker.known(image, output.span) && linker.current[image.0 as usize].is_none() {
            let name = &frame.images[image.0 as usize].name;
            linker.errors.push(
                Diagnostic::new(output.span, format!("output `{name}` is never written"))
                    .help("let a pass write it, or take it out of `outputs`"),
            );
        }
    }
    if linker.errors.is_empty() {
        Ok(Linked { uses: linker.uses, starts, versions: linker.versions, last: linker.current })
    } else {
        Err(linker.errors)
    }
}

struct Linker<'f> {
    frame: &'f Frame,
    current: Vec<Option<Version>>,
    uses: Vec<VersionUse>,
    versions: Version,
    errors: Vec<Diagnostic>,
}

impl Linker<'_> {
    fn pass(&mut self, pass: &Pass) {
        for sampled in &pass.sampled {
            self.access(pass, sampled.image, sampled.span, true, false);
        }
        for storage in &pass.storage {
            self.access(pass, storage.image, storage.span, storage.read, storage.write);
        }
        for target in &pass.color {
            self.access(pass, target.image, target.span, target.clear.is_none() && !covers(pass, target), true);
        }
        if let Some(depth) = &pass.depth {
            self.access(pass, depth.image, depth.span, depth.clear.is_none(), depth.write || depth.clear.is_some());
        }
        if let Work::Forward { from, to, .. } = pass.work {
            self.access(pass, from, pass.span, true, false);
            self.access(pass, to, pass.span, false, true);
        }
    }

    fn known(&mut self, image: ImageIndex, span: Span) -> bool {
        let known = (image.0 as usize) < self.frame.images.len();
        if !known {
            self.errors.push(Diagnostic::new(span, format!("image number {} does not exist", image.0)));
        }
        known
    }

    /// Notes one access. Versions that are made count from [`Linker::commit`] on.
    fn access(&mut self, pass: &Pass, image: ImageIndex, span: Span, reads: bool, writes: bool) {
        if !self.known(image, span) {
            return;
        }
        let before = self.current[image.0 as usize];
        if reads && before.is_none() {
            let (name, pass) = (&self.frame.images[image.0 as usize].name, &pass.name);
            let message = if writes {
                format!("`{pass}` is the first to write `{name}`, and may leave pixels of it untouched")
            } else {
                format!("`{pass}` reads `{name}` before anything has written it")
            };
            let help = if writes { "clear it" } else { "a pass reads what passes above it wrote" };
            self.errors.push(Diagnostic::new(span, message).help(help));
        }
        let made = writes.then(|| {
            self.versions += 1;
            self.versions - 1
        });
        self.uses.push(VersionUse { image, reads: before.filter(|_| reads), writes: made });
    }

    /// Makes the versions that a pass wrote current, once all its reads are known.
    fn commit(&mut self, pass: &Pass, first: usize) {
        for at in first..self.uses.len() {
            let VersionUse { image, writes: Some(version), .. } = self.uses[at] else { continue };
            let twice = self.uses[first..at].iter().any(|earlier| earlier.image == image && earlier.writes.is_some());
            if twice {
                let name = &self.frame.images[image.0 as usize].name;
                let message = format!("`{}` writes `{name}` in two ways at once", pass.name);
                self.errors.push(Diagnostic::new(pass.span, message));
            }
            self.current[image.0 as usize] = Some(version);
        }
    }
}
