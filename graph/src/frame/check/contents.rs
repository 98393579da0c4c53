//! Nothing is read before it is written, and the first draw into a target clears or covers it.
//!
//! Order in the frame gives meaning: a pass reads the versions that stand before itself, even of images it also writes.

use crate::base::Span;
use crate::frame::tracked::Parts;
use crate::frame::{Access, Pass, Resource};
use crate::vulkan::Subresources;

/// A part has no contents.
pub(crate) const NOTHING: u32 = u32::MAX;
/// A part has contents from before the first pass.
pub(crate) const BEFORE: u32 = 0;

/// What is written while passes are followed in their order.
pub(crate) struct Contents<'p> {
    parts: &'p Parts<'p>,
    /// The last pass that wrote each part, counted from 1; [`NOTHING`], [`BEFORE`]. A part that was reported as unwritten counts as
    /// written before: one report is enough.
    pub(crate) writers: Vec<u32>,
    /// The parts that the current pass writes.
    written: Vec<u32>,
}

/// Contents that are needed, and that nothing has written.
pub(crate) struct Unwritten<'a> {
    /// The image or buffer.
    pub(crate) of: Resource,
    /// The part that is needed, with planes named.
    pub(crate) needed: Subresources,
    /// The first plane, mip level and layer of it that holds nothing.
    pub(crate) missing: Subresources,
    /// Whether nothing of the image or buffer holds anything.
    pub(crate) is_blank: bool,
    /// Who needs it; `None`: an output.
    pub(crate) access: Option<&'a Access<'a>>,
    /// Whether the access writes too: then it may leave parts untouched.
    pub(crate) writes: bool,
    /// Where it is named.
    pub(crate) span: Span,
}

/// Is told what passes find.
pub(crate) trait Reader {
    /// A pass needs what another one wrote; its number, or [`BEFORE`].
    fn reads(&mut self, _writer: u32) {}

    /// Contents are needed that nothing has written.
    fn unwritten(&mut self, unwritten: Unwritten<'_>);

    /// A pass writes a part in two ways.
    fn writes_twice(&mut self, _of: Resource) {}
}

impl<F: FnMut(Unwritten<'_>)> Reader for F {
    fn unwritten(&mut self, unwritten: Unwritten<'_>) {
        self(unwritten);
    }
}

impl<'p> Contents<'p> {
    /// Before the first pass, where nothing has contents.
    pub(crate) fn new(parts: &'p Parts<'p>) -> Contents<'p> {
        Contents { parts, writers: vec![NOTHING; parts.len()], written: Vec::with_capacity(8) }
    }

    /// Lets an image or buffer have contents from before the first pass.
    pub(crate) fn begin(&mut self, of: Resource) {
        self.writers[self.parts.of(of)].fill(BEFORE);
    }

    /// Follows one pass. Later passes alone can read its writes, so these are noted once all its reads are known.
    #[inline]
    pub(crate) fn pass(&mut self, pass: &Pass, number: u32, reader: &mut impl Reader) {
        let parts = self.parts;
        parts.for_each_access(pass, |access, part, reads, writes| {
            if reads {
                if self.writers[part as usize] == NOTHING {
                    self.report(pass, access, part, reader);
                }
                reader.reads(self.writers[part as usize]);
            }
            if writes {
                self.written.push(part);
            }
        });
        for part in &self.written {
            if std::mem::replace(&mut self.writers[*part as usize], number) == number {
                reader.writes_twice(parts.owner(*part));
            }
        }
        self.written.clear();
    }

    /// Notes what a pass writes.
    pub(crate) fn write(&mut self, pass: &Pass, number: u32) {
        self.parts.for_each_access(pass, |_, part, _, writes| {
            if writes {
                self.writers[part as usize] = number;
            }
        });
    }

    /// Whether any of a part of an image, or a buffer, holds something.
    pub(crate) fn holds_any(&self, of: Resource, range: Subresources) -> bool {
        let parts = self.parts.cover(of, self.parts.part(of, range));
        parts.into_iter().any(|part| self.writers[part as usize] != NOTHING)
    }

    /// After all passes: what one of them reads of earlier frames, each frame writes anew.
    pub(crate) fn earlier(&mut self, pass: &Pass, reader: &mut impl Reader) {
        for access in pass.accesses().filter(|access| access.frames_ago() > 0) {
            let of = access.resource();
            access.for_each_effect(pass, self.parts.image(of), |effect| {
                let unwritten = self.unwritten(of, effect.range);
                unwritten.into_iter().for_each(|found| {
                    reader.unwritten(Unwritten { span: access.span(), access: Some(&access), ..found })
                });
            });
        }
    }

    /// After all passes: an output was written.
    pub(crate) fn output(&mut self, of: Resource, span: Span, reader: &mut impl Reader) {
        if let Some(found) = self.unwritten(of, Subresources::WHOLE) {
            reader.unwritten(Unwritten { span, ..found });
        }
    }

    /// Reports that an access of `pass` needs contents of `part` where nothing has written any.
    #[cold]
    fn report(&mut self, pass: &Pass, access: &Access<'_>, part: u32, reader: &mut impl Reader) {
        let (parts, of) = (self.parts, access.resource());
        access.for_each_effect(pass, parts.image(of), |effect| {
            if effect.reads
                && parts.cover(of, parts.part(of, effect.range)).contains(&part)
                && let Some(found) = self.unwritten(of, effect.range)
            {
                let (span, writes) = (access.span(), effect.writes);
                reader.unwritten(Unwritten { span, writes, access: Some(access), ..found });
            }
        });
    }

    /// What of a part of an image, or a buffer, is unwritten, if anything is; from now on it counts as written.
    fn unwritten(&mut self, of: Resource, range: Subresources) -> Option<Unwritten<'static>> {
        let needed = self.parts.part(of, range);
        let covered = self.parts.cover(of, needed);
        let unwritten = covered.iter().filter(|part| self.writers[**part as usize] == NOTHING);
        let ranges = unwritten.map(|part| self.parts.range(of, *part));
        let missing = ranges.min_by_key(|range| (range.base_mip, range.aspects.bits(), range.base_layer))?;
        let is_blank = self.writers[self.parts.of(of)].iter().all(|writer| *writer == NOTHING);
        for part in covered {
            let writer = &mut self.writers[part as usize];
            *writer = if *writer == NOTHING { BEFORE } else { *writer };
        }
        let missing = Subresources { mips: 1, layers: 1, ..missing };
        Some(Unwritten { of, needed, missing, is_blank, access: None, writes: false, span: Span::NONE })
    }
}
