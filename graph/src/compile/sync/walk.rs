//! The walk through the steps: the accesses of each step to each subresource.

use super::final_states;
use super::subresource::{SubresourceAccess, SubresourceState};
use super::timeline::AccessTimeline;
use crate::compile::model::{AdaptedFrame, Role, SubresourceIndex, Use};
use crate::compile::queues::Queues;
use crate::compile::retain::{AttachmentOps, LoadStoreOps};
use crate::compile::scope::{ScopedSteps, Step, Target};
use crate::vulkan::{AccessKind, Accesses, Layout, LoadOp, Stages};

/// `timeline`: the accesses of all steps with the barriers between them, and those that final states take, before a step
/// behind all others.
pub(in crate::compile) fn timeline(
    adapted: &AdaptedFrame,
    scoped: &ScopedSteps,
    load_store: &LoadStoreOps,
    queues: Queues,
) -> AccessTimeline {
    let mut walk = Walk {
        adapted,
        timeline: AccessTimeline {
            subresources: vec![SubresourceState::UNUSED; adapted.subresources as usize],
            barriers: Vec::with_capacity(adapted.uses.len() + adapted.uses.len() / 4),
            lifetimes: Vec::new(),
            queues,
            states: Vec::new(),
            layouts: Vec::new(),
        },
        accesses: Vec::new(),
        mixed: false,
    };
    for (step, number) in scoped.steps.iter().zip(0..) {
        walk.step(step, number, load_store);
    }
    let Walk { mut timeline, .. } = walk;
    timeline.find_lifetimes(adapted);
    timeline.states = final_states::states(adapted, &mut timeline, scoped.steps.len() as u32);
    timeline
}

struct Walk<'w> {
    adapted: &'w AdaptedFrame,
    timeline: AccessTimeline,
    /// Accesses of the current step.
    accesses: Vec<SubresourceAccess>,
    /// Whether the current step uses a subresource in several layouts.
    mixed: bool,
}

impl Walk<'_> {
    fn step(&mut self, step: &Step, number: u32, load_store: &LoadStoreOps) {
        if let Step::Single(op) = step
            && self.single(*op, number)
        {
            return;
        }
        let adapted = self.adapted;
        self.accesses.clear();
        self.mixed = false;
        for op in step.ops() {
            for used in adapted.uses(*op) {
                match used.role.is_input() {
                    true => self.read_locally(used, load_store.of(number)),
                    false => self.used(used),
                }
            }
        }
        if let Step::Scope(scope) = step {
            for attachment in load_store.of(number) {
                let (stages, accesses) = attachment.load_access();
                self.also(attachment.target, stages, accesses);
                if let Some((stages, accesses)) = attachment.store_access() {
                    self.also(attachment.target, stages, accesses);
                }
            }
            for op in scope.folded_resolves() {
                let [source, target] = adapted.uses(op) else { continue };
                self.resolved(source, AccessKind::ColorAttachment.accesses(true, false));
                self.resolved(target, AccessKind::ColorAttachment.accesses(false, true));
            }
        }
        if !self.timeline.queues.is_one() {
            let changes = self.timeline.queues.changes(number);
            self.accesses.extend(changes.iter().map(|(_, change)| SubresourceAccess::of_change(change)));
        }
        self.timeline.add(&self.accesses, number, true);
        if self.mixed {
            self.join_uses(step);
        }
    }

    /// Adds a step that isn't drawn, on the only queue, if each of its uses is all that it does to one subresource. Returns
    /// whether it did. Most steps are such: then there is nothing to join.
    fn single(&mut self, op: u32, number: u32) -> bool {
        let Walk { adapted, timeline, .. } = self;
        let uses = adapted.uses(op);
        let mut is_joined = !timeline.queues.is_one();
        for used in uses {
            is_joined |= match timeline.subresources.get_mut(used.subresource as usize) {
                // A number from another step may be the same. Then this step only takes longer.
                Some(subresource) => std::mem::replace(&mut subresource.access, number) == number,
                None => true,
            };
        }
        if is_joined {
            return false;
        }
        uses.iter().for_each(|used| timeline.add_one(&access(used, used.subresource), number));
        true
    }

    fn used(&mut self, used: &Use) {
        let Walk { adapted, .. } = *self;
        let all = access(used, 0);
        adapted.for_each_subresource(used, |subresource| self.accessed(SubresourceAccess { subresource, ..all }));
    }

    /// A local read waits only for contents that its scope loads. The scope's own draws are made visible within the scope.
    fn read_locally(&mut self, used: &Use, attachments: &[AttachmentOps]) {
        let target = Target::of(self.adapted, used);
        let loads = attachments.iter().any(|ops| ops.target == target && ops.load == LoadOp::Load);
        let (stages, accesses) = if loads { (used.stages, used.accesses) } else { Default::default() };
        self.used(&Use { stages, accesses, ..*used });
    }

    /// The source or target of a folded resolve.
    fn resolved(&mut self, used: &Use, accesses: Accesses) {
        let Some(image) = self.adapted.resources[used.resource as usize].image() else { return };
        let (layout, role) = match image.format.is_depth() {
            true => (Layout::DepthStencilAttachmentOptimal, Role::Depth),
            false => (Layout::ColorAttachmentOptimal, Role::Color),
        };
        let resolve_targets = Use { stages: Stages::COLOR_ATTACHMENT_OUTPUT, accesses, layout, role, ..*used };
        self.used(&resolve_targets);
    }

    /// Adds the accesses of load and store operations to those of the passes.
    fn also(&mut self, target: Target, stages: Stages, accesses: Accesses) {
        let Walk { adapted, timeline, accesses: known, .. } = self;
        adapted.resources[target.resource as usize].for_each_in(target.range, |subresource| {
            let at = timeline.subresources[subresource as usize].access as usize;
            if let Some(access) = known.get_mut(at).filter(|access| access.subresource == subresource) {
                access.stages |= stages;
                access.accesses |= accesses;
            }
        });
    }

    /// Joins the accesses of one step to one subresource. The first one says whether contents are kept.
    fn accessed(&mut self, new: SubresourceAccess) {
        let subresource = &mut self.timeline.subresources[new.subresource as usize];
        // The index of an earlier step finds no access, or that of another subresource.
        let known =
            self.accesses.get_mut(subresource.access as usize).filter(|known| known.subresource == new.subresource);
        let Some(known) = known else {
            subresource.access = self.accesses.len() as u32;
            return self.accesses.push(new);
        };
        known.stages |= new.stages;
        known.accesses |= new.accesses;
        known.usage |= new.usage;
        if known.layout != new.layout {
            self.mixed = true;
            known.layout = join_layouts(known.layout, new.layout);
        }
    }

    /// Notes the uses of a step that are in another layout, because of the step's other uses, than they ask for.
    fn join_uses(&mut self, step: &Step) {
        let Walk { adapted, timeline: AccessTimeline { subresources, layouts, .. }, .. } = self;
        for op in step.ops() {
            for at in adapted.ops[*op as usize].uses.clone() {
                let used = &adapted.uses[at as usize];
                let mut layout = used.layout;
                adapted.for_each_subresource(used, |subresource| layout = subresources[subresource as usize].layout);
                if layout != used.layout {
                    layouts.push((at, layout));
                }
            }
        }
    }
}

/// The access of a use to a subresource.
#[inline]
fn access(used: &Use, subresource: SubresourceIndex) -> SubresourceAccess {
    SubresourceAccess {
        subresource,
        resource: used.resource,
        stages: used.stages,
        accesses: used.accesses,
        layout: used.layout,
        keeps: used.reads,
        usage: usage_bits(used),
    }
}

/// The layout in which one step can use a subresource that it uses in two.
fn join_layouts(a: Layout, b: Layout) -> Layout {
    let attached = |read_only, attachment| (a, b) == (read_only, attachment) || (a, b) == (attachment, read_only);
    let planes = [
        (Layout::DepthStencilReadOnlyOptimal, Layout::DepthStencilAttachmentOptimal),
        (Layout::DepthReadOnlyOptimal, Layout::DepthAttachmentOptimal),
        (Layout::StencilReadOnlyOptimal, Layout::StencilAttachmentOptimal),
    ];
    if attached(Layout::RenderingLocalReadKhr, Layout::ColorAttachmentOptimal) {
        return Layout::RenderingLocalReadKhr;
    }
    planes.into_iter().find(|(read, write)| attached(*read, *write)).map_or(Layout::General, |(_, write)| write)
}

/// The usage that a use needs, as the bits of `VkImageUsageFlags` or `VkBufferUsageFlags`.
fn usage_bits(used: &Use) -> u32 {
    // Buffers have no layout.
    if used.layout != Layout::Undefined {
        return used.usage().bits();
    }
    used.accesses.buffer_usage().bits()
}
