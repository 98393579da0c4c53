//! `adapt`: samples, sizes and formats are made to meet. Resolves, copies and second images are inserted, each with its
//! cause; passes that are off forward what they would have replaced.
//!
//! A resolve belongs to a *version* of an image and is shared by all its readers.

mod forward;

use super::cull::Live;
use super::link::covers;
use super::model::{Adapted, Op, OpKind, Role, Samples, Start, Store, StoreIndex, Use};
use crate::describe::Diagnostic;
use crate::device::{ImageDescriptor, Profile};
use crate::frame::{Draw, Frame, ImageIndex, Pass, Resource, Sampled, Work};
use crate::plan::{Cause, Note, Sharing, Stage};
use crate::source::{Place, Span};
use crate::vocabulary::{Aspects, ResolveMode, Usage};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

pub(super) fn adapt(
    frame: &Frame,
    live: &Live,
    samples: &Samples,
    device: &Profile,
) -> Result<Adapted, Vec<Diagnostic>> {
    let mut is_output = vec![false; frame.images.len()];
    for output in &frame.outputs {
        let Resource::Image(image) = output.resource else { continue };
        is_output[image.0 as usize] = true;
    }
    let mut adapter = Adapter {
        frame,
        live,
        samples,
        device,
        store_of: vec![None; frame.images.len()],
        resolved_of: vec![None; frame.images.len()],
        image_of: Vec::new(),
        known_as: BTreeMap::new(),
        is_output,
        resolves_of: vec![0; frame.images.len()],
        of_geometry: geometry_targets(frame, live),
        named: false,
        adapted: Adapted::default(),
        errors: Vec::new(),
        scratch: Vec::new(),
        copies: Vec::new(),
    };
    adapter.adapted.ops.reserve(live.passes.len());
    adapter.adapted.uses.reserve(live.passes.len() * 4);
    for pass in &live.passes {
        adapter.pass(*pass);
    }
    for output in &frame.outputs {
        let Resource::Image(image) = output.resource else { continue };
        adapter.output(image, output.span);
    }
    if adapter.named {
        distinct_names(&mut adapter.adapted.stores);
    }
    if adapter.errors.is_empty() { Ok(adapter.adapted) } else { Err(adapter.errors) }
}

/// For each image, whether objects are drawn into it.
fn geometry_targets(frame: &Frame, live: &Live) -> Vec<bool> {
    let mut targets = vec![false; frame.images.len()];
    for pass in live.passes.iter().map(|pass| &frame.passes[*pass as usize]) {
        if matches!(pass.work, Work::Draw { draw: Draw::Objects(_), .. }) {
            pass.color.iter().for_each(|target| targets[target.image.0 as usize] = true);
        }
    }
    targets
}

/// Numbers physical images of one name, as an image gets that others are forwarded to; the last one keeps the name.
fn distinct_names(stores: &mut [Store]) {
    let mut used: HashMap<Arc<str>, u32> = HashMap::with_capacity(stores.len());
    for store in stores.iter_mut().rev() {
        let name = store.name.clone();
        while let Some(number) = used.get_mut(&store.name) {
            // Counting goes on where it stopped: many images may have one name.
            *number += 1;
            store.name = format!("{name} ({number})").into();
        }
        used.insert(store.name.clone(), 1);
    }
}

struct Adapter<'a> {
    frame: &'a Frame,
    live: &'a Live,
    samples: &'a Samples,
    device: &'a Profile,
    /// The physical image that holds each image's current version.
    store_of: Vec<Option<StoreIndex>>,
    /// The single-sample copy of each image's current version, if there is one.
    resolved_of: Vec<Option<StoreIndex>>,
    /// The image that each physical image was made for.
    image_of: Vec<usize>,
    /// The images that a forwarded physical image holds or is the resolved copy of, as far as they are still used.
    known_as: BTreeMap<StoreIndex, Vec<usize>>,
    /// Whether each image leaves the frame.
    is_output: Vec<bool>,
    /// How many resolved copies, copies and second images each image has had: they need distinct names.
    resolves_of: Vec<u32>,
    /// Images that geometry is drawn into, where more samples would have meant a resolve; until that was said.
    of_geometry: Vec<bool>,
    /// Whether a physical image has a name that isn't its own image's.
    named: bool,
    adapted: Adapted,
    errors: Vec<Diagnostic>,
    /// Uses of the pass at hand.
    scratch: Vec<Use>,
    /// What it reads of images that it also writes: each image, and its copy.
    copies: Vec<(StoreIndex, StoreIndex)>,
}

impl Adapter<'_> {
    fn pass(&mut self, number: u32) {
        let frame = self.frame;
        let pass = &frame.passes[number as usize];
        if let Work::Forward { from, to, because } = &pass.work {
            return self.forward(number, pass, *from, *to, because);
        }
        self.copies.clear();
        let mut uses = std::mem::take(&mut self.scratch);
        uses.clear();
        for (entry, sampled) in (0_u32..).zip(&pass.sampled) {
            if let Some(store) = self.sampled(pass, sampled) {
                uses.push(Use { store, role: Role::Sampled { entry, stages: sampled.stages } });
            }
        }
        for (entry, storage) in (0_u32..).zip(&pass.storage) {
            let store = match storage.write {
                true => self.target(pass, storage.image, storage.span, storage.read),
                false => self.current(storage.image),
            };
            let role = Role::Storage { entry, stages: storage.stages, read: storage.read, write: storage.write };
            uses.push(Use { store, role });
        }
        for (entry, target) in (0_u32..).zip(&pass.color) {
            let start = match target.clear {
                Some(value) => Start::Clear(value),
                None if covers(pass, target) => Start::Discard,
                None => Start::Keep,
            };
            let store = self.target(pass, target.image, target.span, start == Start::Keep);
            uses.push(Use { store, role: Role::Color { entry, start, blends: target.blend != Default::default() } });
        }
        if let Some(depth) = &pass.depth {
            let start = depth.clear.map_or(Start::Keep, |value| Start::Clear([value, 0.0, 0.0, 0.0]));
            let store = if depth.write || depth.clear.is_some() {
                self.written(depth.image, start == Start::Keep)
            } else {
                self.current(depth.image)
            };
            self.refuse_depth_feedback(pass, depth.image, depth.write || depth.clear.is_some());
            uses.push(Use { store, role: Role::Depth { start, write: depth.write } });
        }
        let kind =
            if matches!(pass.work, Work::Dispatch { .. }) { OpKind::Dispatch(number) } else { OpKind::Draw(number) };
        self.push(kind, &uses);
        self.scratch = uses;
    }

    fn push(&mut self, kind: OpKind, uses: &[Use]) {
        let start = self.adapted.uses.len() as u32;
        self.adapted.uses.extend_from_slice(uses);
        self.adapted.ops.push(Op { kind, uses: start..start + uses.len() as u32 });
    }

    fn place(&self, span: Span) -> Option<Place> {
        self.frame.sources.place(span)
    }

    fn note(&mut self, subject: &Arc<str>, text: String, span: Span) {
        let at = self.place(span);
        self.adapted.notes.push(Note { stage: Stage::Adapt, subject: subject.clone(), text, at });
    }

    /// The physical image with the current version; there is one, since `link` saw a version.
    fn current(&mut self, image: ImageIndex) -> StoreIndex {
        match self.store_of[image.0 as usize] {
            Some(store) => store,
            None => self.first_store(image),
        }
    }

    /// The physical image that takes the next version.
    fn written(&mut self, image: ImageIndex, keeps: bool) -> StoreIndex {
        debug_assert!(!keeps || self.store_of[image.0 as usize].is_some(), "link saw a version to keep");
        self.resolved_of[image.0 as usize] = None;
        self.current(image)
    }

    fn first_store(&mut self, image: ImageIndex) -> StoreIndex {
        let declared = &self.frame.images[image.0 as usize];
        let cause = Cause::Written(self.place(declared.span));
        self.new_store(image, declared.name.clone(), cause, self.samples.of(image))
    }

    /// Adds a physical image and makes it the image's current one.
    fn new_store(&mut self, image: ImageIndex, name: Arc<str>, cause: Cause, samples: u32) -> StoreIndex {
        let store = self.add_store(image, name, cause, samples);
        self.store_of[image.0 as usize] = Some(store);
        store
    }

    fn add_store(&mut self, image: ImageIndex, name: Arc<str>, cause: Cause, samples: u32) -> StoreIndex {
        let declared = &self.frame.images[image.0 as usize];
        let descriptor = ImageDescriptor {
            format: declared.format,
            shape: declared.shape,
            extent: declared.extent,
            mips: declared.mips,
            layers: declared.layers,
            samples,
            usage: Usage::empty(),
            sharing: Sharing::Exclusive,
        };
        self.adapted.stores.push(Store { name, cause, descriptor, output: false });
        self.image_of.push(image.0 as usize);
        self.adapted.stores.len() as StoreIndex - 1
    }

    /// The physical image that a sampling pass reads.
    fn sampled(&mut self, pass: &Pass, sampled: &Sampled) -> Option<StoreIndex> {
        let declared = &self.frame.images[sampled.image.0 as usize];
        let count = self.samples.of(sampled.image);
        if sampled.per_sample {
            if count == 1 {
                let message =
                    format!("`{}` reads single samples of `{}`, which has one sample", pass.name, declared.name);
                let help = format!(
                    "sample it as `sampler2D` where its sample count is 1 ({} were asked for)",
                    declared.samples
                );
                self.errors.push(Diagnostic::new(sampled.span, message).help(help));
                return None;
            }
            return self.version_before(pass, sampled);
        }
        if count > 1 {
            let because = format!("`{}` samples `{}` and it has {count} samples", pass.name, declared.name);
            return self.resolved(sampled.image, because, sampled.span);
        }
        if std::mem::take(&mut self.of_geometry[sampled.image.0 as usize]) {
            let text = format!("`{}` samples it as it is: it has 1 sample, so nothing is resolved", pass.name);
            self.note(&declared.name, text, sampled.span);
        }
        self.version_before(pass, sampled)
    }

    /// A pass that samples an image it also writes reads the version before itself.
    fn version_before(&mut self, pass: &Pass, sampled: &Sampled) -> Option<StoreIndex> {
        let image = sampled.image;
        let declared = &self.frame.images[image.0 as usize];
        let before = self.current(image);
        if let Some((_, copy)) = self.copies.iter().find(|(of, _)| *of == before) {
            return Some(*copy);
        }
        let kept =
            pass.color.iter().any(|target| target.image == image && target.clear.is_none() && !covers(pass, target))
                || pass.storage.iter().any(|storage| storage.image == image && storage.write && storage.read);
        if !kept {
            return Some(before);
        }
        let because = format!("`{}` samples `{}` while it draws into it", pass.name, declared.name);
        let at = self.place(sampled.span);
        let cause = Cause::Inserted { because: because.clone(), at: at.clone() };
        let name = self.next_name(image, "copy");
        let copy = self.add_store(image, name, cause, self.samples.of(image));
        let uses = [Use { store: before, role: Role::Source }, Use { store: copy, role: Role::Target }];
        self.push(OpKind::Copy { because, at }, &uses);
        self.copies.push((before, copy));
        Some(copy)
    }

    /// The physical image that a pass writes; a second one if the pass also samples what it replaces.
    fn target(&mut self, pass: &Pass, image: ImageIndex, span: Span, keeps: bool) -> StoreIndex {
        let samples_it = pass
            .sampled
            .iter()
            .any(|sampled| sampled.image == image && (sampled.per_sample || self.samples.of(image) == 1));
        if samples_it && !keeps && self.store_of[image.0 as usize].is_some() {
            let declared = &self.frame.images[image.0 as usize];
            let because = format!("`{}` samples `{}` while it replaces it", pass.name, declared.name);
            let cause = Cause::Inserted { because, at: self.place(span) };
            let name = self.next_name(image, "next");
            self.resolved_of[image.0 as usize] = None;
            return self.new_store(image, name, cause, self.samples.of(image));
        }
        self.written(image, keeps)
    }

    fn refuse_depth_feedback(&mut self, pass: &Pass, image: ImageIndex, writes: bool) {
        if writes && let Some(sampled) = pass.sampled.iter().find(|sampled| sampled.image == image) {
            let name = &self.frame.images[image.0 as usize].name;
            let message = format!("`{}` samples the depth `{name}` that it also writes", pass.name);
            self.errors.push(Diagnostic::new(sampled.span, message).help("test it without writing: `write: false`"));
        }
    }

    fn next_name(&mut self, image: ImageIndex, what: &str) -> Arc<str> {
        let count = &mut self.resolves_of[image.0 as usize];
        *count += 1;
        self.named = true;
        let name = &self.frame.images[image.0 as usize].name;
        if *count == 1 { format!("{name} ({what})").into() } else { format!("{name} ({what} {count})").into() }
    }

    /// The single-sample copy of an image's current version, for a pass that reads it.
    fn resolved(&mut self, image: ImageIndex, because: String, span: Span) -> Option<StoreIndex> {
        let declared = &self.frame.images[image.0 as usize];
        if declared.format.is_depth() {
            let message = format!("{because}; passes can't read resolved depth yet");
            let help = format!("sample it as `sampler2DMS`, or give `{}` 1 sample", declared.name);
            self.errors.push(Diagnostic::new(span, message).help(help));
            return None;
        }
        Some(self.single_sample(image, because, span))
    }

    /// The single-sample copy of an image's current version: colour is averaged, integers and depth are sample zero.
    fn single_sample(&mut self, image: ImageIndex, because: String, span: Span) -> StoreIndex {
        if let Some(resolved) = self.resolved_of[image.0 as usize] {
            return resolved;
        }
        let declared = &self.frame.images[image.0 as usize];
        let averaged = !declared.format.is_integer() && !declared.format.is_depth();
        let mode = if averaged { ResolveMode::Average } else { ResolveMode::SampleZero };
        let source = self.current(image);
        let at = self.place(span);
        let cause = Cause::Inserted { because: because.clone(), at: at.clone() };
        let name = self.next_name(image, "resolved");
        let target = self.add_store(image, name, cause, 1);
        let uses = [Use { store: source, role: Role::Source }, Use { store: target, role: Role::Target }];
        self.push(OpKind::Resolve { mode, because, at }, &uses);
        self.resolved_of[image.0 as usize] = Some(target);
        target
    }

    /// Whether a draw wrote an image's current version: then its rendering scope can carry a resolve.
    fn drawn_last(&mut self, image: ImageIndex) -> bool {
        let store = self.current(image);
        let writes = |op: &&Op| {
            let uses = &self.adapted.uses[op.uses.start as usize..op.uses.end as usize];
            uses.iter().any(|used| used.store == store && used.role.writes())
        };
        let last = self.adapted.ops.iter().rev().find(writes);
        last.is_some_and(|op| matches!(op.kind, OpKind::Draw(_)))
    }

    fn output(&mut self, image: ImageIndex, span: Span) {
        let declared = &self.frame.images[image.0 as usize];
        let count = self.samples.of(image);
        if count > 1 && declared.format.aspects().contains(Aspects::STENCIL) {
            let message =
                format!("`{}` is an output with {count} samples, and stencil can't be resolved", declared.name);
            let help = format!("choose a depth format without stencil, or give `{}` 1 sample", declared.name);
            self.errors.push(Diagnostic::new(span, message).help(help));
            return;
        }
        if count > 1 && declared.format.is_depth() && !self.drawn_last(image) {
            let message = format!("`{}` is an output with {count} samples that were not drawn into it", declared.name);
            let help =
                format!("depth is resolved where it is drawn: draw into `{}`, or give it 1 sample", declared.name);
            self.errors.push(Diagnostic::new(span, message).help(help));
            return;
        }
        let store = if count > 1 {
            let because = format!("`{}` is an output and has {count} samples", declared.name);
            self.single_sample(image, because, span)
        } else {
            self.current(image)
        };
        self.adapted.stores[store as usize].output = true;
        self.adapted.outputs.push(store);
    }
}
