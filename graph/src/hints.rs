//! What stands out in a Plan: what a change to the pipeline might spare, each with the bytes that it is about.
//!
//! A hint is no mistake. It says what the Plan says, so that people look there first.

use crate::base::amount::bytes;
use crate::base::{Place, escape};
use crate::dataflow::{Dataflow, Node, NodeKind, Use, UseRole};
use crate::plan::{Attachment, Cause, Image, Plan, RenderScope, Resource, StepId};
use crate::vulkan::{LoadOp, StoreOp};
use serde::Serialize;
use std::cmp::Reverse;
use std::sync::Arc;

/// A hint concerns at least this part of the bytes that the frame moves: one in 20.
const SHARE: u64 = 20;

/// Something that stands out.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Hint {
    /// Its kind.
    pub kind: HintKind,
    /// The kind's code.
    pub code: &'static str,
    /// It in words. Names from files stand between backticks, with control characters escaped.
    pub text: String,
    /// The bytes that it is about, in each frame or of memory.
    pub bytes: u64,
    /// The line that it is about.
    pub at: Option<Place>,
}

/// The kinds of hints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum HintKind {
    /// One image or buffer takes half of all transient memory, or more.
    LargestShare,
    /// An attachment is stored, and one pass alone reads it.
    OneReader,
    /// All that read an image draw at half of its size or less.
    ShownSmaller,
    /// A scope stores an attachment, and the next scope loads it.
    LoadedAgain,
    /// A resolve is a step of its own: no scope carries it.
    ResolvedApart,
}

impl HintKind {
    /// All kinds.
    pub const ALL: [HintKind; 5] = [
        HintKind::LargestShare,
        HintKind::OneReader,
        HintKind::ShownSmaller,
        HintKind::LoadedAgain,
        HintKind::ResolvedApart,
    ];

    /// The code of the kind. It stays what it is.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            HintKind::LargestShare => "H01",
            HintKind::OneReader => "H02",
            HintKind::ShownSmaller => "H03",
            HintKind::LoadedAgain => "H04",
            HintKind::ResolvedApart => "H05",
        }
    }
}

/// A Plan with the figures that hints are made of.
struct Figures<'p> {
    plan: &'p Plan,
    flow: Dataflow,
    /// The bytes that the frame moves.
    moved: u64,
    /// By image.
    images: Vec<ImageFigures>,
}

/// What a frame does with an image.
#[derive(Clone, Default)]
struct ImageFigures {
    /// The bytes that scopes store of it.
    stored: u64,
    /// The bytes that resolves write into it.
    resolved: u64,
    /// Indices of the nodes that read what was stored, other than by drawing over it.
    readers: Vec<usize>,
}

/// What stands out in `plan`, the most bytes first.
#[must_use]
pub fn hints(plan: &Plan) -> Vec<Hint> {
    let figures = Figures::of(plan);
    let mut found: Vec<Hint> = HintKind::ALL.into_iter().flat_map(|kind| figures.of_kind(kind)).collect();
    found.sort_by_key(|hint| (Reverse(hint.bytes), hint.kind));
    found
}

impl<'p> Figures<'p> {
    fn of(plan: &'p Plan) -> Figures<'p> {
        let flow = Dataflow::of(plan);
        let mut images = vec![ImageFigures::default(); plan.images.len()];
        let figures = |images: &mut [ImageFigures], resource, add: &dyn Fn(&mut ImageFigures)| match resource {
            Resource::Image(image) => images.get_mut(image.0 as usize).map_or((), add),
            Resource::Buffer(_) => {}
        };
        for (resource, moved) in plan.steps.iter().flat_map(|step| plan.moved_of_each(step)) {
            figures(&mut images, resource, &|image| {
                image.stored = image.stored.saturating_add(moved.stored);
                image.resolved = image.resolved.saturating_add(moved.resolved);
            });
        }
        for (index, node) in flow.nodes.iter().enumerate() {
            let by_drawing = |used: &Use| [UseRole::Color, UseRole::Depth].contains(&used.role);
            for used in node.uses.iter().filter(|used| used.reads && !by_drawing(used)) {
                figures(&mut images, used.resource, &|image| {
                    // A pass may read several parts.
                    if image.readers.last() != Some(&index) {
                        image.readers.push(index);
                    }
                });
            }
        }
        Figures { plan, moved: plan.moved().sum(), flow, images }
    }

    fn of_kind(&self, kind: HintKind) -> Vec<Hint> {
        let found = match kind {
            HintKind::LargestShare => self.largest_share(),
            HintKind::OneReader => self.one_reader(),
            HintKind::ShownSmaller => self.shown_smaller(),
            HintKind::LoadedAgain => self.loaded_again(),
            HintKind::ResolvedApart => self.resolved_apart(),
        };
        let hint = |(text, bytes, at)| Hint { kind, code: kind.code(), text, bytes, at };
        found.into_iter().map(hint).collect()
    }

    /// Whether these bytes are enough of what the frame moves.
    fn matters(&self, bytes: u64) -> bool {
        bytes > 0 && bytes.saturating_mul(SHARE) >= self.moved
    }

    fn largest_share(&self) -> Vec<HintWords> {
        let images = self.plan.images.iter().map(|image| (&image.name, &image.role, &image.cause));
        let buffers = self.plan.buffers.iter().map(|buffer| (&buffer.name, &buffer.role, &buffer.cause));
        let placed = images
            .chain(buffers)
            .filter_map(|(name, role, cause)| role.placement().map(|placement| (placement.bytes, name, cause)));
        let all = self.plan.totals.transient_bytes;
        let placed: Vec<_> = placed.collect();
        let largest = placed.iter().max_by_key(|(bytes, ..)| *bytes).filter(|_| placed.len() > 2);
        let tell = |(taken, name, cause): &(u64, &Arc<str>, &Cause)| {
            let text = format!("`{}` is {} of {} of transient memory", escape(name), bytes(*taken), bytes(all));
            (text, *taken, cause.at().cloned())
        };
        largest.filter(|(taken, ..)| taken.saturating_mul(2) >= all).map(tell).into_iter().collect()
    }

    fn one_reader(&self) -> Vec<HintWords> {
        let tell = |(image, figures): (&Image, &ImageFigures)| {
            let [only] = figures.readers[..] else { return None };
            let text = format!(
                "`{}` is stored for one reader, `{}`",
                escape(&image.name),
                escape(&self.flow.nodes[only].name)
            );
            self.matters(figures.stored).then(|| (text, figures.stored, image.cause.at().cloned()))
        };
        self.transient().filter_map(tell).collect()
    }

    fn shown_smaller(&self) -> Vec<HintWords> {
        let tell = |(image, figures): (&Image, &ImageFigures)| {
            let written = figures.stored.saturating_add(figures.resolved);
            let sizes: Vec<[u32; 2]> =
                figures.readers.iter().map(|reader| self.drawn(&self.flow.nodes[*reader])).collect::<Option<_>>()?;
            let [width, height, _] = image.extent;
            let is_half = |drawn: u32, side: u32| u64::from(drawn) * 2 <= u64::from(side) + 1;
            let halves = sizes.iter().all(|drawn| is_half(drawn[0], width) && is_half(drawn[1], height));
            let largest = sizes.into_iter().max_by_key(|drawn| u64::from(drawn[0]) * u64::from(drawn[1]))?;
            let text = format!(
                "`{}` has {width}×{height} texels, and is read by passes that draw {}×{} or less",
                escape(&image.name),
                largest[0],
                largest[1]
            );
            (halves && self.matters(written)).then(|| (text, written, image.cause.at().cloned()))
        };
        self.transient().filter(|(image, _)| image.mips == 1 && image.layers == 1).filter_map(tell).collect()
    }

    fn loaded_again(&self) -> Vec<HintWords> {
        let scopes: Vec<(StepId, &RenderScope)> =
            (0..).map(StepId).zip(&self.plan.steps).filter_map(|(at, step)| Some((at, step.work.scope()?))).collect();
        let tell = |pair: &[(StepId, &RenderScope)]| -> Vec<HintWords> {
            let [(_, before), (step, after)] = pair else { return Vec::new() };
            let [Some(first), Some(second)] = [before, after].map(|scope| scope.passes.first()) else {
                return Vec::new();
            };
            let again = after.attachments.iter().filter(|attachment| attachment.load == LoadOp::Load);
            let stores = |stored: &Attachment| stored.store == StoreOp::Store;
            let again = again.filter(|loaded| {
                let same = |stored: &&Attachment| (stored.image, stored.range) == (loaded.image, loaded.range);
                before.attachments.iter().find(same).is_some_and(stores)
            });
            let found = again.map(|loaded| {
                let text = format!(
                    "`{}` is stored by the scope of `{}`, and loaded again by the next one, of `{}`",
                    escape(&self.plan.image(loaded.image).name),
                    escape(&first.name),
                    escape(&second.name)
                );
                let moved = self.plan.moved_of_each(&self.plan.steps[step.0 as usize]).into_iter();
                let loads = moved.filter(|(resource, _)| *resource == Resource::Image(loaded.image));
                let loaded = loads.fold(0_u64, |sum, (_, moved)| sum.saturating_add(moved.loaded));
                (text, loaded.saturating_mul(2), second.cause.at().cloned())
            });
            found.collect()
        };
        scopes.windows(2).flat_map(tell).filter(|(_, taken, _)| self.matters(*taken)).collect()
    }

    fn resolved_apart(&self) -> Vec<HintWords> {
        let apart = self.flow.nodes.iter().filter(|node| node.kind == NodeKind::Resolve);
        let tell = |node: &Node| {
            let taken = self.plan.moved_by(&self.plan.steps[node.step.0 as usize]).sum();
            let text = format!("`{}` is a step of its own: no rendering scope carries it", escape(&node.name));
            (text, taken, node.at.clone())
        };
        apart.map(tell).collect()
    }

    /// Images that live within the frame.
    fn transient(&self) -> impl Iterator<Item = (&Image, &ImageFigures)> {
        let all = self.plan.images.iter().zip(&self.images);
        all.filter(|(image, _)| image.role.placement().is_some())
    }

    /// Width and height that a pass draws; `None`: it dispatches, or copies.
    fn drawn(&self, node: &Node) -> Option<[u32; 2]> {
        let scope = self.plan.steps[node.step.0 as usize].work.scope();
        scope.filter(|_| node.kind == NodeKind::Draw).map(|scope| scope.extent)
    }
}

/// The words of a hint, its bytes, and its line.
type HintWords = (String, u64, Option<Place>);
