//! The state of `adapt`, and how operations are added.

use super::access;
use super::demote::Demotions;
use super::last_accesses::LastAccesses;
use crate::base::{Diagnostic, Place, Span};
use crate::compile::cull::LivePasses;
use crate::compile::model::{AdaptedFrame, Negotiated, Op, OpKind, PhysicalIndex, SubresourceIndex, Use};
use crate::compile::options::Options;
use crate::compile::parts::Grids;
use crate::device::Profile;
use crate::frame::{Frame, ImageIndex, ResolveWay};
use crate::plan::{InsertionCause, Note, NoteKind};
use crate::vulkan::Subresources;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// The frame, and what the stages before found out.
#[derive(Clone, Copy)]
pub(crate) struct Input<'a> {
    pub(crate) frame: &'a Frame,
    pub(crate) grids: &'a Grids,
    pub(crate) live: &'a LivePasses,
    pub(crate) negotiated: &'a Negotiated,
    pub(crate) device: &'a Profile,
    pub(crate) options: &'a Options,
}

/// The adapted part of the frame so far, and which physical image and buffer holds each current version.
pub(super) struct Adapter<'a> {
    pub(super) input: Input<'a>,
    /// The physical image that holds each image's current version. Those of earlier frames stand right behind it.
    pub(super) resource_of: Vec<Option<PhysicalIndex>>,
    /// The same for buffers.
    pub(super) buffer_resource_of: Vec<Option<PhysicalIndex>>,
    /// The version that each physical resource holds.
    pub(super) versions: Vec<Version>,
    /// For each multisampled depth image the operations that wrote its current version.
    pub(super) depth_writers: BTreeMap<PhysicalIndex, Vec<u32>>,
    /// How often each pass is drawn again.
    pub(super) redrawn_times: BTreeMap<u32, u32>,
    /// Whether each image is an output, if any is forwarded.
    pub(super) is_output: Vec<bool>,
    /// How many resolved copies, copies and second images each image has had: they need distinct names.
    pub(super) inserted_for: BTreeMap<ImageIndex, u32>,
    /// The images that a forwarded physical image holds or is the resolved copy of, as far as they are still used.
    pub(super) known_as: BTreeMap<PhysicalIndex, Vec<ImageIndex>>,
    /// The last accesses of images, if any is forwarded.
    pub(super) last_accesses: LastAccesses,
    /// Full-screen draws that move to single-sampled images.
    pub(super) demotions: Demotions,
    /// Whether any physical image has another name than its image.
    pub(super) renamed: bool,
    /// Number of physical images so far.
    pub(super) images: u32,
    pub(super) adapted: AdaptedFrame,
    pub(super) notes: Vec<Note>,
    pub(super) errors: Vec<Diagnostic>,
    /// Behind the uses of all operations so far.
    pub(super) first_use: usize,
    /// The uses of the current pass, if an operation was inserted after it had some; else empty, and they are
    /// `adapted.uses[first_use..]`.
    held_uses: Vec<Use>,
    /// Whether the current pass samples an image that is also its colour target or storage image that it writes. Depth that it
    /// samples and writes is refused.
    pub(super) feeds_back: bool,
    /// Images that the current pass reads and writes: each one, and the copy that it reads.
    pub(super) copies: Vec<(PhysicalIndex, PhysicalIndex)>,
}

/// The version that a physical resource holds, with all that each use asks of the resource.
pub(super) struct Version {
    /// Samples of the image; 1 of a buffer.
    pub(super) samples: u32,
    /// The only subresource, or [`Use::SEVERAL`].
    pub(super) subresource: SubresourceIndex,
    /// Its resolved copy of one sample and the way of resolving, if a pass asked for one.
    pub(super) resolved: Option<(ResolveWay, PhysicalIndex)>,
    /// Its depth-only copy of one sample, if a pass asked for one.
    pub(super) redrawn: Option<PhysicalIndex>,
    /// Whether a draw wrote it last, if the frame has multisampled images.
    pub(super) drawn: bool,
}

impl<'a> Adapter<'a> {
    pub(super) fn new(input: Input<'a>) -> Adapter<'a> {
        let frame = input.frame;
        Adapter {
            input,
            resource_of: vec![None; frame.images.len()],
            buffer_resource_of: vec![None; frame.buffers.len()],
            versions: Vec::with_capacity(frame.images.len()),
            depth_writers: BTreeMap::new(),
            redrawn_times: BTreeMap::new(),
            is_output: Vec::new(),
            inserted_for: BTreeMap::new(),
            known_as: BTreeMap::new(),
            last_accesses: LastAccesses::default(),
            demotions: Demotions::default(),
            renamed: false,
            images: 0,
            adapted: AdaptedFrame::default(),
            notes: Vec::new(),
            errors: Vec::new(),
            first_use: 0,
            held_uses: Vec::new(),
            feeds_back: false,
            copies: Vec::new(),
        }
    }

    /// Adds a use of the current pass.
    #[inline]
    pub(super) fn add_use(&mut self, used: Use) {
        let used = self.of_parts(used);
        if self.held_uses.is_empty() { self.adapted.uses.push(used) } else { self.held_uses.push(used) }
    }

    /// The uses of the current pass so far.
    pub(super) fn uses_of_pass(&self) -> &[Use] {
        if self.held_uses.is_empty() { &self.adapted.uses[self.first_use..] } else { &self.held_uses }
    }

    /// The same, to be changed.
    pub(super) fn uses_of_pass_mut(&mut self) -> &mut [Use] {
        if self.held_uses.is_empty() { &mut self.adapted.uses[self.first_use..] } else { &mut self.held_uses }
    }

    /// Adds the current pass as an operation.
    pub(super) fn push_pass(&mut self, kind: OpKind, side_effect: bool) {
        self.adapted.uses.append(&mut self.held_uses);
        self.push_op(kind, side_effect);
    }

    /// Inserts an operation before the current pass, behind all operations so far.
    pub(super) fn push(&mut self, kind: OpKind, uses: &[Use]) {
        self.held_uses.extend(self.adapted.uses.drain(self.first_use..));
        for used in uses {
            let used = self.of_parts(*used);
            self.adapted.uses.push(used);
        }
        self.push_op(kind, false);
    }

    fn of_parts(&self, used: Use) -> Use {
        Use { subresource: self.versions[used.resource as usize].subresource, ..used }
    }

    /// Adds an operation that has all uses from `first_use` on.
    #[inline]
    fn push_op(&mut self, kind: OpKind, side_effect: bool) {
        let end = self.adapted.uses.len();
        let start = std::mem::replace(&mut self.first_use, end);
        if self.input.negotiated.multisampled {
            self.note_writers(start..end, kind.draws());
        }
        self.adapted.ops.push(Op { kind, uses: start as u32..end as u32, side_effect });
    }

    /// Notes that these uses wrote images. Multisampled ones may be resolved.
    fn note_writers(&mut self, uses: Range<usize>, draws: bool) {
        for at in uses {
            let used = self.adapted.uses[at];
            if used.writes {
                self.versions[used.resource as usize].drawn = draws;
                self.note_depth_writer(&used, draws);
            }
        }
    }

    /// Adds an operation from one image to another, whole, which have the same parts.
    pub(super) fn push_transfer(&mut self, kind: OpKind, source: PhysicalIndex, target: PhysicalIndex, range: u32) {
        let stage = access::transfer_stage(&kind);
        let uses = [access::source(source, range, stage), access::target(target, range, stage)];
        self.push(kind, &uses);
    }

    /// The number under which a part of an image is known; [`Use::ALL`] if it is all of it.
    #[inline]
    pub(super) fn range(&mut self, image: ImageIndex, range: Subresources) -> u32 {
        if self.is_all(image, range) { Use::ALL } else { self.part(image, range) }
    }

    /// The same for the part that a pass samples.
    #[inline]
    pub(super) fn sampled_range(&mut self, image: ImageIndex, range: Subresources) -> u32 {
        if self.is_all(image, range) {
            return Use::ALL;
        }
        let range = self.input.frame.images[image.0 as usize].sampled_part(range);
        self.part(image, range)
    }

    /// Whether a range is all of an image that is one part, so of one plane.
    fn is_all(&self, image: ImageIndex, range: Subresources) -> bool {
        let is_all = range.is_whole() && self.input.grids.of(image).is_none();
        debug_assert!(
            !is_all || self.input.frame.images[image.0 as usize].format.aspects().bits().count_ones() == 1,
            "images of several planes are cut"
        );
        is_all
    }

    fn part(&mut self, image: ImageIndex, range: Subresources) -> u32 {
        let image = &self.input.frame.images[image.0 as usize];
        let range = image.part(range);
        if range == image.whole() {
            return Use::ALL;
        }
        self.adapted.ranges.push(range);
        self.adapted.ranges.len() as u32 - 1
    }

    pub(super) fn place(&self, span: Span) -> Option<Place> {
        self.input.frame.sources.place(span)
    }

    pub(super) fn reason(&self, because: String, span: Span) -> Box<InsertionCause> {
        Box::new(InsertionCause { because, at: self.place(span) })
    }

    pub(super) fn note(&mut self, kind: NoteKind, subject: &Arc<str>, text: String, span: Span) {
        let at = self.place(span);
        self.notes.push(Note::new(kind, subject.clone(), text, at));
    }
}
