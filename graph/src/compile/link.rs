//! `link`: finds the parts that each pass reads and writes, and checks that earlier passes wrote all that is read.
//!
//! Order in the frame gives meaning: a pass reads the versions that stand before itself, even of images it also writes.

use super::parts::Grids;
use crate::base::Diagnostic;
use crate::frame::{Access, BufferIndex, Effect, Frame, ImageIndex, Pass, Resource, SAMPLING, VisitAccess};

/// The access of one pass to one part of an image, or to a buffer.
#[derive(Debug, Clone, Copy)]
pub(super) struct PartUse(u32);

impl PartUse {
    const READS: u32 = 1;
    const WRITES: u32 = 2;

    fn new(part: u32, reads: bool, writes: bool) -> PartUse {
        PartUse((part << 2) | (u32::from(reads) * PartUse::READS) | (u32::from(writes) * PartUse::WRITES))
    }

    /// Number of the part among all parts of the frame.
    pub(super) fn part(self) -> usize {
        (self.0 >> 2) as usize
    }

    /// Whether the use needs the earlier contents: the part is sampled, loaded or kept.
    pub(super) fn reads(self) -> bool {
        self.0 & PartUse::READS != 0
    }

    /// Whether the use changes the contents.
    pub(super) fn writes(self) -> bool {
        self.0 & PartUse::WRITES != 0
    }
}

/// All passes' uses, pass by pass.
#[derive(Debug)]
pub(super) struct Linked {
    uses: Vec<PartUse>,
    starts: Vec<u32>,
    /// Whether each part is needed when the frame is done.
    pub(super) needed: Vec<bool>,
}

impl Linked {
    /// The uses of pass number `pass`.
    pub(super) fn uses(&self, pass: usize) -> &[PartUse] {
        &self.uses[self.starts[pass] as usize..self.starts[pass + 1] as usize]
    }
}

pub(super) fn link(frame: &Frame, grids: &Grids) -> Result<Linked, Vec<Diagnostic>> {
    let mut first_part = Vec::with_capacity(frame.images.len() + frame.buffers.len());
    let mut written = Vec::with_capacity(frame.images.len() + frame.buffers.len());
    let mut needed = Vec::with_capacity(written.capacity());
    for (image, number) in frame.images.iter().zip(0_u32..) {
        first_part.push(written.len() as u32);
        let parts = grids.of(ImageIndex(number)).map_or(1, |grid| grid.len() as usize);
        written.resize(written.len() + parts, image.lifetime.has_contents(Resource::Image(ImageIndex(number))));
        needed.resize(written.len(), image.lifetime.outlives_frame());
    }
    for (buffer, number) in frame.buffers.iter().zip(0_u32..) {
        first_part.push(written.len() as u32);
        written.push(buffer.lifetime.has_contents(Resource::Buffer(BufferIndex(number))));
        needed.push(buffer.lifetime.outlives_frame());
    }
    let mut linker = Linker {
        frame,
        grids,
        first_part,
        writer: vec![0; written.len()],
        written,
        uses: Vec::with_capacity(frame.passes.len() * 4),
        errors: Vec::new(),
    };
    let mut starts = Vec::with_capacity(frame.passes.len() + 1);
    starts.push(0);
    for (pass, number) in frame.passes.iter().zip(1_u32..) {
        let first = linker.uses.len();
        pass.visit_accesses(&mut PassLinker { linker: &mut linker, pass });
        linker.commit(pass, number, first);
        starts.push(linker.uses.len() as u32);
    }
    for output in &frame.outputs {
        let (parts, name) = linker.all(output.resource);
        needed[parts.clone()].fill(true);
        if linker.written[parts].contains(&false) {
            linker.errors.push(
                Diagnostic::new(output.span, format!("output `{name}` is never written"))
                    .help("let a pass write it, or take it out of `outputs`"),
            );
        }
    }
    if linker.errors.is_empty() { Ok(Linked { uses: linker.uses, starts, needed }) } else { Err(linker.errors) }
}

/// Links one pass.
struct PassLinker<'l, 'f> {
    linker: &'l mut Linker<'f>,
    pass: &'f Pass,
}

impl VisitAccess for PassLinker<'_, '_> {
    #[inline(always)]
    fn visit(&mut self, access: Access<'_>) {
        if access.frames_ago() > 0 {
            return;
        }
        let (linker, pass) = (&mut *self.linker, self.pass);
        let Linker { frame, grids, .. } = *linker;
        let (number, image, grid) = match access.resource() {
            Resource::Image(index) => (index.0 as usize, Some(&frame.images[index.0 as usize]), grids.of(index)),
            Resource::Buffer(index) => (frame.images.len() + index.0 as usize, None, None),
        };
        let first = linker.first_part[number];
        if let (Access::Sampled(_), None) = (access, grid) {
            // The image itself isn't looked at: a large frame has more of them than a cache holds.
            let (reads, writes) = SAMPLING;
            return linker.access(pass, &access, first, reads, writes);
        }
        access.for_each_effect(pass, image, |Effect { range, reads, writes }| match (image, grid) {
            (Some(image), Some(grid)) => {
                let parts = grid.cover(image.part(range));
                parts.for_each(|part| linker.access(pass, &access, first + part, reads, writes));
            }
            _ => linker.access(pass, &access, first, reads, writes),
        });
    }
}

struct Linker<'f> {
    frame: &'f Frame,
    grids: &'f Grids,
    /// For each image, then each buffer, its first part.
    first_part: Vec<u32>,
    /// Whether each part has contents so far.
    written: Vec<bool>,
    /// The last pass that wrote each part, counted from 1.
    writer: Vec<u32>,
    uses: Vec<PartUse>,
    errors: Vec<Diagnostic>,
}

impl Linker<'_> {
    fn name(&self, resource: Resource) -> &str {
        match resource {
            Resource::Image(image) => &self.frame.images[image.0 as usize].name,
            Resource::Buffer(buffer) => &self.frame.buffers[buffer.0 as usize].name,
        }
    }

    /// All parts of an image or buffer, and its name.
    fn all(&self, resource: Resource) -> (std::ops::Range<usize>, &str) {
        let number = match resource {
            Resource::Image(image) => image.0 as usize,
            Resource::Buffer(buffer) => self.frame.images.len() + buffer.0 as usize,
        };
        let end = self.first_part.get(number + 1).map_or(self.written.len(), |next| *next as usize);
        (self.first_part[number] as usize..end, self.name(resource))
    }

    /// Notes one access. Later passes alone can read its writes ([`Linker::commit`]).
    #[inline]
    fn access(&mut self, pass: &Pass, access: &Access<'_>, part: u32, reads: bool, writes: bool) {
        if reads && !self.written[part as usize] {
            // Reported once for each part.
            self.written[part as usize] = true;
            self.report_unwritten(pass, access, writes);
        }
        self.uses.push(PartUse::new(part, reads, writes));
    }

    /// Reports an access that needs contents where nothing has written any.
    #[cold]
    fn report_unwritten(&mut self, pass: &Pass, access: &Access<'_>, writes: bool) {
        let (name, pass, span) = (self.name(access.resource()), &pass.name, access.span());
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

    /// Makes the parts that a pass wrote current, once all its reads are known.
    fn commit(&mut self, pass: &Pass, number: u32, first: usize) {
        for at in first..self.uses.len() {
            let used = self.uses[at];
            if !used.writes() {
                continue;
            }
            if std::mem::replace(&mut self.writer[used.part()], number) == number {
                let resource = self.first_part.partition_point(|first| *first as usize <= used.part()) - 1;
                let name = match resource.checked_sub(self.frame.images.len()) {
                    None => &self.frame.images[resource].name,
                    Some(buffer) => &self.frame.buffers[buffer].name,
                };
                let message = format!("`{}` writes `{name}` in two ways at once", pass.name);
                self.errors.push(Diagnostic::new(pass.span, message));
            }
            self.written[used.part()] = true;
        }
    }
}
