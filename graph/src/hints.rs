//! What stands out in a Plan: what a change to the pipeline might spare, each with the bytes that it is about.
//!
//! A hint is no mistake. It says what the Plan says, so that people look there first.

use crate::base::amount::bytes;
use crate::base::{Place, escape};
use crate::dataflow::{Dataflow, Node, NodeKind, UseRole};
use crate::plan::{Cause, Image, ImageId, MovedBytes, Plan, RenderScope, Resource, StepId};
use crate::vulkan::LoadOp;
use serde::Serialize;
use std::cmp::Reverse;
use std::sync::Arc;

/// A hint is told from this share of what the frame moves or holds on: one part in so many.
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

/// A Plan with what hints ask of it.
struct Looked<'p> {
    plan: &'p Plan,
    flow: Dataflow,
    /// The bytes that the frame moves.
    moved: u64,
}

/// What stands out in `plan`, the most bytes first.
#[must_use]
pub fn hints(plan: &Plan) -> Vec<Hint> {
    let looked = Looked { plan, flow: Dataflow::of(plan), moved: plan.moved().sum() };
    let mut found: Vec<Hint> = HintKind::ALL.into_iter().flat_map(|kind| looked.of_kind(kind)).collect();
    found.sort_by_key(|hint| (Reverse(hint.bytes), hint.kind));
    found
}

impl Looked<'_> {
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

    /// Whether so many bytes of what the frame moves are worth a word.
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
        let images = (0..).zip(&self.plan.images).filter(|(_, image)| image.role.placement().is_some());
        let tell = |(id, image): (u32, &Image)| {
            let stored = self.moved_of(ImageId(id), |moved| moved.stored);
            let mut readers = self.flow.nodes.iter().filter(|node| reads_stored(node, ImageId(id)));
            let only = readers.next().filter(|_| readers.next().is_none() && self.matters(stored))?;
            let text = format!("`{}` is stored for one reader, `{}`", escape(&image.name), escape(&only.name));
            Some((text, stored, image.cause.at().cloned()))
        };
        images.filter_map(tell).collect()
    }

    fn shown_smaller(&self) -> Vec<HintWords> {
        let images = (0..).zip(&self.plan.images).filter(|(_, image)| image.mips == 1 && image.layers == 1);
        let tell = |(id, image): (u32, &Image)| {
            let written = self.moved_of(ImageId(id), |moved| moved.stored + moved.resolved);
            let readers: Vec<&Node> = self.flow.nodes.iter().filter(|node| reads_stored(node, ImageId(id))).collect();
            let sizes: Option<Vec<[u32; 2]>> = readers.iter().map(|node| self.drawn(node)).collect();
            let [width, height, _] = image.extent;
            let sizes = sizes.filter(|sizes| !sizes.is_empty() && image.role.placement().is_some())?;
            let halves = sizes.iter().all(|drawn| 2 * drawn[0] <= width + 1 && 2 * drawn[1] <= height + 1);
            let largest = sizes.into_iter().max_by_key(|drawn| u64::from(drawn[0]) * u64::from(drawn[1]))?;
            let text = format!(
                "`{}` has {width}×{height} texels, and is read by passes that draw {}×{} or less",
                escape(&image.name),
                largest[0],
                largest[1]
            );
            (halves && self.matters(written)).then(|| (text, written, image.cause.at().cloned()))
        };
        images.filter_map(tell).collect()
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
            let again = again.filter(|loaded| before.attachments.iter().any(|stored| stored.image == loaded.image));
            let found = again.map(|loaded| {
                let text = format!(
                    "`{}` is stored by the scope of `{}`, and loaded again by the next one, of `{}`",
                    escape(&self.plan.image(loaded.image).name),
                    escape(&first.name),
                    escape(&second.name)
                );
                let moved = self.plan.moved_of_each(&self.plan.steps[step.0 as usize]).into_iter();
                let loads = moved.filter(|(resource, _)| *resource == Resource::Image(loaded.image));
                (text, 2 * loads.map(|(_, moved)| moved.loaded).sum::<u64>(), second.cause.at().cloned())
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

    /// The bytes that the frame moves of an image, of one kind.
    fn moved_of(&self, image: ImageId, kind: impl Fn(MovedBytes) -> u64) -> u64 {
        let each = self.plan.steps.iter().flat_map(|step| self.plan.moved_of_each(step));
        each.filter(|(resource, _)| *resource == Resource::Image(image)).map(|(_, moved)| kind(moved)).sum()
    }

    /// Width and height that a pass draws; `None`: it dispatches, or copies.
    fn drawn(&self, node: &Node) -> Option<[u32; 2]> {
        let scope = self.plan.steps[node.step.0 as usize].work.scope();
        scope.filter(|_| node.kind == NodeKind::Draw).map(|scope| scope.extent)
    }
}

/// The words of a hint, its bytes, and its line.
type HintWords = (String, u64, Option<Place>);

/// Whether work reads what was stored of an image, other than by drawing over it.
fn reads_stored(node: &Node, image: ImageId) -> bool {
    let mut reads = node.uses.iter().filter(|used| used.resource == Resource::Image(image) && used.reads);
    reads.any(|used| ![UseRole::Color, UseRole::Depth].contains(&used.role))
}
