//! `adapt`: samples, sizes and formats are made to meet. Resolves, copies and second images are inserted, each with its
//! cause; passes that are off forward what they would have replaced.
//!
//! A resolve belongs to a *version* of an image and is shared by all its readers.

mod access;
mod demote;
mod depth_only;
mod forward;
mod resolve;
mod stores;

pub(super) use access::has_samples;

use super::Options;
use super::cull::Live;
use super::model::{Adapted, Negotiated, Op, OpKind, Start, StoreIndex, Use};
use super::parts::{self, Grids};
use crate::base::{Diagnostic, Place, Span};
use crate::device::Profile;
use crate::frame::{Draw, Face, Frame, ImageIndex, Pass, ResolveWay, Resource, Sampled, Work};
use crate::plan::{Inserted, Note, Stage};
use crate::vulkan::{Aspects, Layout, Subresources};
use demote::Demotions;
use forward::Later;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What `adapt` starts from.
#[derive(Clone, Copy)]
pub(super) struct Input<'a> {
    pub(super) frame: &'a Frame,
    pub(super) grids: &'a Grids,
    pub(super) live: &'a Live,
    pub(super) negotiated: &'a Negotiated,
    pub(super) device: &'a Profile,
    pub(super) options: &'a Options,
}

pub(super) fn adapt(input: Input<'_>) -> Result<Adapted, Vec<Diagnostic>> {
    let Input { frame, live, .. } = input;
    let mut adapter = Adapter {
        input,
        store_of: vec![None; frame.images.len()],
        buffer_store_of: vec![None; frame.buffers.len()],
        resolved_of: Vec::with_capacity(frame.images.len()),
        redrawn_of: Vec::with_capacity(frame.images.len()),
        depth_writers: BTreeMap::new(),
        redrawn_times: BTreeMap::new(),
        is_output: vec![false; frame.images.len()],
        inserted_for: BTreeMap::new(),
        known_as: BTreeMap::new(),
        later: Later::default(),
        demotions: Demotions::default(),
        renamed: false,
        images: 0,
        buffers: 0,
        adapted: Adapted::default(),
        drawn: Vec::with_capacity(frame.images.len()),
        errors: Vec::new(),
        scratch: Vec::new(),
        copies: Vec::new(),
    };
    for output in &frame.outputs {
        if let Resource::Image(image) = output.resource {
            adapter.is_output[image.0 as usize] = true;
        }
    }
    if live.passes.iter().any(|pass| matches!(frame.passes[*pass as usize].work, Work::Forward { .. })) {
        adapter.later = Later::of(frame, live);
    }
    adapter.demotions = demote::find(&input, &mut adapter.adapted.notes);
    adapter.adapted.stores.reserve(frame.images.len());
    adapter.adapted.ops.reserve(live.passes.len());
    adapter.adapted.uses.reserve(live.passes.len() * 4);
    for pass in &live.passes {
        adapter.pass(*pass);
    }
    for output in &frame.outputs {
        adapter.output(output);
    }
    if adapter.renamed {
        stores::distinct_names(frame, &mut adapter.adapted.stores);
    }
    access::settle_depth(&mut adapter.adapted);
    if adapter.errors.is_empty() { Ok(adapter.adapted) } else { Err(adapter.errors) }
}

struct Adapter<'a> {
    input: Input<'a>,
    /// The physical image that holds each image's current version. Those of earlier frames stand right behind it.
    store_of: Vec<Option<StoreIndex>>,
    /// The same for buffers.
    buffer_store_of: Vec<Option<StoreIndex>>,
    /// For each physical image what it holds resolved to one sample, and how, if somebody asked for that.
    resolved_of: Vec<Option<(ResolveWay, StoreIndex)>>,
    /// For each physical image what it holds drawn again with one sample, if somebody asked for that.
    redrawn_of: Vec<Option<StoreIndex>>,
    /// For each multisampled depth image the operations that wrote its current version.
    depth_writers: BTreeMap<StoreIndex, Vec<u32>>,
    /// How often each pass is drawn again.
    redrawn_times: BTreeMap<u32, u32>,
    /// Whether each image leaves the frame.
    is_output: Vec<bool>,
    /// How many resolved copies, copies and second images each image has had: they need distinct names.
    inserted_for: BTreeMap<ImageIndex, u32>,
    /// The images that a forwarded physical image holds or is the resolved copy of, as far as they are still used.
    known_as: BTreeMap<StoreIndex, Vec<ImageIndex>>,
    /// What comes later in the frame, if anything is forwarded.
    later: Later,
    /// Full-screen draws that move to single-sampled images.
    demotions: Demotions,
    /// Whether a physical image has a name that isn't its own image's.
    renamed: bool,
    /// Number of physical images and of buffers so far.
    images: u32,
    buffers: u32,
    adapted: Adapted,
    /// For each physical image whether a draw wrote it last.
    drawn: Vec<bool>,
    errors: Vec<Diagnostic>,
    /// Uses of the pass at hand.
    scratch: Vec<Use>,
    /// What the pass at hand reads of images that it also writes: each image, and its copy.
    copies: Vec<(StoreIndex, StoreIndex)>,
}

impl Adapter<'_> {
    fn pass(&mut self, number: u32) {
        let frame = self.input.frame;
        let pass = &frame.passes[number as usize];
        if let Work::Forward { from, to, because } = &pass.work {
            return self.forward(number, pass, *from, *to, because);
        }
        self.copies.clear();
        let mut uses = std::mem::take(&mut self.scratch);
        uses.clear();
        for (entry, sampled) in (0_u32..).zip(&pass.sampled) {
            if let Some(store) = self.sampled(number, pass, sampled) {
                let range = parts::seen(&frame.images[sampled.image.0 as usize], sampled.range);
                let range = self.range(sampled.image, range);
                uses.push(access::sampled(sampled, entry, store, range));
            }
        }
        for (entry, storage) in (0_u32..).zip(&pass.storage) {
            let store = match storage.write {
                true => self.target(number, pass, storage.image, storage.range, storage.span, storage.read),
                false => self.current(storage.image),
            };
            let range = self.range(storage.image, storage.range);
            uses.push(access::storage(storage, entry, store, range));
        }
        for (entry, target) in (0_u32..).zip(&pass.color) {
            let start = match target.clear {
                Some(_) => Start::Clear,
                None if pass.covers_color(target, &frame.images[target.image.0 as usize]) => Start::Discard,
                None => Start::Keep,
            };
            let store = self.target(number, pass, target.image, target.range, target.span, start == Start::Keep);
            let range = self.range(target.image, target.range);
            uses.push(access::color(target, entry, store, range, start));
        }
        if let Some(depth) = &pass.depth {
            let image = &frame.images[depth.image.0 as usize];
            for (plane, clears, writes) in depth.planes(image.format) {
                let start = match clears {
                    true => Start::Clear,
                    false if pass.covers_plane(depth, plane, image) => Start::Discard,
                    false => Start::Keep,
                };
                let store =
                    if writes { self.written(depth.image, start == Start::Keep) } else { self.current(depth.image) };
                self.refuse_depth_feedback(pass, depth.image, depth.range, plane, writes);
                let range = self.range(depth.image, Subresources { aspects: plane, ..depth.range });
                uses.push(access::depth(plane, store, range, start, writes, image.format));
            }
        }
        for (entry, used) in (0_u32..).zip(&pass.buffers) {
            let store = self.buffer(used.buffer, used.frames_ago);
            uses.push(access::buffer(used, entry, store));
        }
        for (entry, used) in (0_u32..).zip(&pass.transfers) {
            if let Some((store, range)) = self.transferred(pass, used) {
                uses.push(access::transfer(&pass.work, used, entry, store, range));
            }
        }
        if pass.alpha_to_coverage && !access::has_samples(&self.adapted, &uses) {
            let text = "alpha_to_coverage is off: its targets have 1 sample".to_owned();
            self.note(&pass.name, text, pass.span);
        }
        let kind = if matches!(pass.work, Work::Draw { .. }) { OpKind::Draw(number) } else { OpKind::Pass(number) };
        self.push(kind, &uses);
        self.scratch = uses;
    }

    fn push(&mut self, kind: OpKind, uses: &[Use]) {
        let start = self.adapted.uses.len() as u32;
        for used in uses {
            if used.writes {
                self.drawn[used.store as usize] = kind.draws();
                self.note_depth_writer(used, kind.draws());
            }
            let store = &self.adapted.stores[used.store as usize];
            let cell = if store.grid(self.input.grids).is_none() { store.first_cell } else { Use::CELLS };
            self.adapted.uses.push(Use { cell, ..*used });
        }
        let own = if kind.inserted().is_none() { kind.pass() } else { None };
        let side_effect = own.is_some_and(|pass| self.input.frame.passes[pass as usize].side_effect);
        self.adapted.ops.push(Op { kind, uses: start..start + uses.len() as u32, side_effect });
    }

    /// Adds an operation from one image to another, whole, which have the same parts.
    fn push_transfer(&mut self, kind: OpKind, source: StoreIndex, target: StoreIndex, range: u32) {
        let stage = access::transfer_stage(&kind);
        let uses = [access::source(source, range, stage), access::target(target, range, stage)];
        self.push(kind, &uses);
    }

    /// The number under which a part of an image is known; [`Use::ALL`] if it is all of it.
    fn range(&mut self, image: ImageIndex, range: Subresources) -> u32 {
        if range == Subresources::WHOLE && self.input.grids.of(image).is_none() {
            return Use::ALL;
        }
        let image = &self.input.frame.images[image.0 as usize];
        let range = parts::resolve(image, range);
        if range == Subresources::all(image.format, image.mips, image.layers) {
            return Use::ALL;
        }
        self.adapted.ranges.push(range);
        self.adapted.ranges.len() as u32 - 1
    }

    fn place(&self, span: Span) -> Option<Place> {
        self.input.frame.sources.place(span)
    }

    fn reason(&self, because: String, span: Span) -> Box<Inserted> {
        Box::new(Inserted { because, at: self.place(span) })
    }

    fn note(&mut self, subject: &Arc<str>, text: String, span: Span) {
        let at = self.place(span);
        self.adapted.notes.push(Note { stage: Stage::Adapt, subject: subject.clone(), text, at });
    }

    /// The physical image that a sampling pass reads.
    fn sampled(&mut self, number: u32, pass: &Pass, sampled: &Sampled) -> Option<StoreIndex> {
        let declared = &self.input.frame.images[sampled.image.0 as usize];
        if sampled.frames_ago > 0 {
            let earlier = self.current(sampled.image) + sampled.frames_ago;
            return self.samples_unresolved(pass, sampled, earlier).then_some(earlier);
        }
        let before = self.current(sampled.image);
        let count = self.samples(before);
        let per_sample = sampled.face == Face::Samples;
        if per_sample && count > 1 {
            return Some(self.version_before(number, pass, sampled, before));
        }
        // A shader that adapts does without samples.
        if per_sample && sampled.texture.is_none() {
            let message = format!("`{}` reads single samples of `{}`, which has one sample", pass.name, declared.name);
            let help = format!(
                "declare it `TEXTURE_{0} {0}` in the shader, which fits any number of samples, or sample it as `sampler2D` \
                 where its sample count is 1 ({1} were asked for)",
                sampled.binding, declared.samples
            );
            self.errors.push(Diagnostic::new(sampled.span, message).help(help));
            return None;
        }
        if count > 1 {
            let because = format!("`{}` samples `{}` and it has {count} samples", pass.name, declared.name);
            if sampled.range.aspects == Aspects::STENCIL {
                self.refuse_stencil(sampled.image, &because, sampled.span);
                return None;
            }
            return self.resolved(sampled.image, sampled.face, because, sampled.span);
        }
        if self.demotions.is_worth_a_note(sampled.image) {
            let text = format!("`{}` samples it as it is: it has 1 sample, so nothing is resolved", pass.name);
            self.note(&declared.name, text, sampled.span);
        }
        Some(self.version_before(number, pass, sampled, before))
    }

    /// Whether a shader can sample an earlier frame, which is never resolved. Reports it if not.
    fn samples_unresolved(&mut self, pass: &Pass, sampled: &Sampled, earlier: StoreIndex) -> bool {
        let count = self.samples(earlier);
        if count == 1 || sampled.face == Face::Samples {
            return true;
        }
        let name = &self.input.frame.images[sampled.image.0 as usize].name;
        let message = format!(
            "`{}` samples an earlier frame of `{name}`, which has {count} samples; only a frame's own images are resolved",
            pass.name
        );
        let help = "let a pass draw it into an image with 1 sample and `lifetime: History`, and sample an earlier frame of that \
            one; or declare it `sampler2DMS` in the shader";
        self.errors.push(Diagnostic::new(sampled.span, message).help(help));
        false
    }

    /// A pass that samples what it also writes reads the version before itself, which `before` holds.
    fn version_before(&mut self, number: u32, pass: &Pass, sampled: &Sampled, before: StoreIndex) -> StoreIndex {
        if let Some((_, copy)) = self.copies.iter().find(|(of, _)| *of == before) {
            return *copy;
        }
        if !self.overwrites(number, pass, sampled) {
            return before;
        }
        self.copied(pass, sampled, before)
    }

    /// A copy of what a pass samples of `before`, in which it writes.
    fn copied(&mut self, pass: &Pass, sampled: &Sampled, before: StoreIndex) -> StoreIndex {
        let image = sampled.image;
        let declared = &self.input.frame.images[image.0 as usize];
        let because = format!("`{}` samples `{}` while it writes it", pass.name, declared.name);
        let why = self.reason(because, sampled.span);
        let samples = self.samples(before);
        let copy = self.second(image, "copy", why.clone(), samples);
        // Whatever the pass samples of the image it then finds in the copy.
        let also = pass.sampled.iter().filter(|other| other.image == image && other.frames_ago == 0);
        let mut copied: Vec<Subresources> = Vec::new();
        for range in also.map(|other| parts::resolve(declared, other.range)) {
            for mip in range.base_mip..range.base_mip + range.mips {
                let level = Subresources { base_mip: mip, mips: 1, ..range };
                if !copied.contains(&level) {
                    copied.push(level);
                    let level = self.range(image, level);
                    self.push_transfer(OpKind::Copy(why.clone()), before, copy, level);
                }
            }
        }
        self.copies.push((before, copy));
        copy
    }

    /// Whether a pass writes what it samples, in the very image that it samples.
    fn overwrites(&self, number: u32, pass: &Pass, sampled: &Sampled) -> bool {
        let image = sampled.image;
        let moves = |range: Subresources, keeps: bool| self.moves_on(number, image, range, keeps);
        let overlaps = |range: Subresources| self.overlap(image, range, sampled.range);
        let color = pass.color.iter().filter(|target| target.image == image && overlaps(target.range)).any(|target| {
            !moves(
                target.range,
                target.clear.is_none() && !pass.covers_color(target, &self.input.frame.images[image.0 as usize]),
            )
        });
        let mut storage = pass.storage.iter().filter(|storage| storage.image == image && storage.write);
        color || storage.any(|storage| overlaps(storage.range) && !moves(storage.range, storage.read))
    }

    fn overlap(&self, image: ImageIndex, a: Subresources, b: Subresources) -> bool {
        parts::overlap(&self.input.frame.images[image.0 as usize], a, b)
    }

    /// Whether a pass that samples an image and writes `range` of it goes on in a second image: it replaces all of it,
    /// and nobody relies on where it lies.
    fn moves_on(&self, number: u32, image: ImageIndex, range: Subresources, keeps: bool) -> bool {
        let declared = &self.input.frame.images[image.0 as usize];
        let all = Subresources::all(declared.format, declared.mips, declared.layers);
        self.demotions.moves(number, image)
            || !keeps && parts::resolve(declared, range) == all && !parts::outlives(&declared.lifetime)
    }

    /// The physical image that a pass writes; a second one if the pass also samples what it replaces.
    fn target(
        &mut self,
        number: u32,
        pass: &Pass,
        image: ImageIndex,
        range: Subresources,
        span: Span,
        keeps: bool,
    ) -> StoreIndex {
        let frame = self.input.frame;
        if self.demotions.moves(number, image) {
            return self.demoted(pass, image, span);
        }
        let wanted = self.input.negotiated.samples(image);
        let samples_it = pass.sampled.iter().any(|sampled| {
            let same = sampled.image == image && sampled.frames_ago == 0 && self.overlap(image, sampled.range, range);
            same && (sampled.face == Face::Samples || wanted == 1)
        });
        let there = self.store_of[image.0 as usize].is_some() && self.current_samples(image) == wanted;
        if samples_it && there && self.moves_on(number, image, range, keeps) {
            let because =
                format!("`{}` samples `{}` while it replaces it", pass.name, frame.images[image.0 as usize].name);
            let why = self.reason(because, span);
            return self.replace(image, "next", why, wanted);
        }
        self.written(image, keeps)
    }

    /// The single-sampled image that a demoted draw goes on in.
    fn demoted(&mut self, pass: &Pass, image: ImageIndex, span: Span) -> StoreIndex {
        let samples_it = pass.sampled.iter().any(|sampled| sampled.image == image && sampled.frames_ago == 0);
        if self.store_of[image.0 as usize].is_some() && self.current_samples(image) == 1 && !samples_it {
            return self.continued(image);
        }
        let name = &self.input.frame.images[image.0 as usize].name;
        let why = self.reason(format!("`{}` covers `{name}` and gains nothing from several samples", pass.name), span);
        self.replace(image, "1 sample", why, 1)
    }

    /// Whether a pass writes the plane of a depth image that it also samples: it can't be given a copy.
    fn refuse_depth_feedback(
        &mut self,
        pass: &Pass,
        image: ImageIndex,
        range: Subresources,
        plane: Aspects,
        writes: bool,
    ) {
        let range = Subresources { aspects: plane, ..range };
        let declared = &self.input.frame.images[image.0 as usize];
        let same = |sampled: &&Sampled| {
            let seen = parts::seen(declared, sampled.range);
            sampled.image == image && sampled.frames_ago == 0 && self.overlap(image, seen, range)
        };
        if writes && let Some(sampled) = pass.sampled.iter().find(same) {
            let name = &self.input.frame.images[image.0 as usize].name;
            let message = format!("`{}` samples the depth `{name}` that it also writes", pass.name);
            self.errors.push(
                Diagnostic::new(sampled.span, message)
                    .help(format!("test it without writing: say `depth: (image: \"{name}\", write: false)`")),
            );
        }
    }
}

/// Layouts in which transfers find their images.
const TRANSFER: [Layout; 2] = [Layout::TransferSrcOptimal, Layout::TransferDstOptimal];

/// Whether a pass copies into images sample by sample: then it reads single samples, too.
fn copies_samples(frame: &Frame, pass: &Pass) -> bool {
    let target = pass.transfers.iter().find(|used| used.write).map(|used| used.resource);
    let Some(Resource::Image(target)) = target.filter(|_| matches!(pass.work, Work::Copy | Work::Custom { .. })) else {
        return false;
    };
    frame.images[target.0 as usize].samples > 1
}

/// Whether a draw is made of objects or other geometry that has edges inside the image, or makes edges by its alpha.
fn has_edges(pass: &Pass) -> bool {
    pass.alpha_to_coverage || matches!(&pass.work, Work::Draw { draw, .. } if *draw != Draw::FullScreen)
}
