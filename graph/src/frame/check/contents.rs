//! Nothing is read before it is written, and the first draw into a target clears or covers it.
//!
//! Order in the frame gives meaning: a pass reads the versions that stand before itself, even of images it also writes.

use crate::base::Span;
use crate::frame::tracked_parts::Parts;
use crate::frame::{Access, Pass, Resource};
use crate::vulkan::Subresources;

/// In place of a writer's number: nothing has written the part.
pub(crate) const NOTHING: u32 = u32::MAX;
/// In place of a writer's number: the part has contents from before the first pass.
pub(crate) const BEFORE: u32 = 0;

/// What is written while passes are followed in their order.
pub(crate) struct Contents<'p> {
    parts: &'p Parts<'p>,
    /// The last pass that wrote each part, counted from 1; [`NOTHING`], [`BEFORE`]. A part that was found unwritten counts as written
    /// before: one mistake is enough.
    pub(crate) writers: Vec<u32>,
    /// Whether each pass, counted from 1, wrote what a later one reads; the entry before them stands for contents from before.
    pub(crate) needed: Vec<bool>,
    /// Passes, counted from 1, that write something in two ways at once.
    pub(crate) twice: Vec<(u32, Resource)>,
    /// The parts that the current pass writes.
    written: Vec<u32>,
}

/// Contents that are needed, and that nothing has written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MissingContents {
    /// The image or buffer.
    pub(crate) of: Resource,
    /// The part that is needed, with planes named.
    pub(crate) needed: Subresources,
    /// The first plane, mip level and layer of it that holds nothing.
    pub(crate) missing: Subresources,
    /// Whether nothing of the image or buffer holds anything.
    pub(crate) is_blank: bool,
    pub(crate) demand: Demand,
    /// Whether the access writes too: then it may leave parts untouched.
    pub(crate) writes: bool,
    /// Where it is named.
    pub(crate) span: Span,
}

/// Who needs contents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Demand {
    /// A pass that reads them.
    Read,
    /// A pass that reads what an earlier frame left.
    Earlier,
    /// A draw that adds to colour, or leaves some of it untouched.
    Color,
    /// A draw that tests depth or stencil, or leaves some of it untouched.
    Depth,
    /// An output.
    Output,
}

impl<'p> Contents<'p> {
    /// Before the first of some passes, where nothing has contents.
    pub(crate) fn new(parts: &'p Parts<'p>, passes: usize) -> Contents<'p> {
        let (writers, needed) = (vec![NOTHING; parts.len()], vec![false; passes + 1]);
        Contents { parts, writers, needed, twice: Vec::new(), written: Vec::with_capacity(8) }
    }

    /// Lets an image or buffer have contents from before the first pass.
    pub(crate) fn begin(&mut self, of: Resource) {
        self.writers[self.parts.of(of)].fill(BEFORE);
    }

    /// Follows one pass, and returns what it needs and nothing has written. Later passes alone can read its writes, so these are noted
    /// once all its reads are known.
    #[inline]
    pub(crate) fn pass(&mut self, pass: &Pass, number: u32) -> Vec<MissingContents> {
        let (parts, mut found) = (self.parts, Vec::new());
        parts.for_each_access(pass, |access, part, reads, writes| {
            if reads {
                if self.writers[part as usize] == NOTHING {
                    self.unwritten_by(pass, access, part, &mut found);
                }
                self.needed[self.writers[part as usize] as usize] = true;
            }
            if writes {
                self.written.push(part);
            }
        });
        for part in &self.written {
            if std::mem::replace(&mut self.writers[*part as usize], number) == number {
                self.twice.push((number, parts.owner(*part)));
            }
        }
        self.written.clear();
        found
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

    /// What a pass reads of earlier frames and no pass of this frame writes; after all passes.
    pub(crate) fn earlier(&mut self, pass: &Pass) -> Vec<MissingContents> {
        let mut found = Vec::new();
        pass.visit_accesses(&mut |access: Access<'_>| {
            if access.frames_ago() > 0 {
                access.for_each_effect(pass, self.parts.image(access.resource()), |effect| {
                    let unwritten = self.unwritten(access.resource(), effect.range, access.span());
                    found.extend(unwritten.map(|it| MissingContents { demand: Demand::Earlier, ..it }));
                });
            }
        });
        found
    }

    /// What of an output, named at `span`, no pass writes; after all passes.
    pub(crate) fn output(&mut self, of: Resource, span: Span) -> Option<MissingContents> {
        self.unwritten(of, Subresources::WHOLE, span).map(|it| MissingContents { demand: Demand::Output, ..it })
    }

    /// Finds what an access of `pass` needs of the part number `part` and beside it.
    #[cold]
    fn unwritten_by(&mut self, pass: &Pass, access: &Access<'_>, part: u32, found: &mut Vec<MissingContents>) {
        let (parts, of) = (self.parts, access.resource());
        let demand = match access {
            Access::Color(_) => Demand::Color,
            Access::Depth(_) => Demand::Depth,
            _ => Demand::Read,
        };
        access.for_each_effect(pass, parts.image(of), |effect| {
            if effect.reads && parts.cover(of, parts.part(of, effect.range)).contains(&part) {
                let unwritten = self.unwritten(of, effect.range, access.span());
                found.extend(unwritten.map(|it| MissingContents { demand, writes: effect.writes, ..it }));
            }
        });
    }

    /// What of a part of an image, or of a buffer, is unwritten, if anything is; from now on it counts as written.
    fn unwritten(&mut self, of: Resource, range: Subresources, span: Span) -> Option<MissingContents> {
        let needed = self.parts.part(of, range);
        let is_blank = self.writers[self.parts.of(of)].iter().all(|writer| *writer == NOTHING);
        let mut covered = self.parts.cover(of, needed);
        covered.retain(|part| self.writers[*part as usize] == NOTHING);
        covered.iter().for_each(|part| self.writers[*part as usize] = BEFORE);
        let missing = covered.into_iter().map(|part| self.parts.range(of, part));
        let missing = missing.min_by_key(|range| (range.base_mip, range.aspects.bits(), range.base_layer))?;
        let missing = Subresources { mips: 1, layers: 1, ..missing };
        Some(MissingContents { of, needed, missing, is_blank, demand: Demand::Read, writes: false, span })
    }
}
