//! Whether a pass can join the rendering scope before it.

use super::step::{Scope, Target, colors_of, plane_of};
use crate::compile::model::{AdaptedFrame, InitialContents, PhysicalIndex, Role, Use};
use crate::frame::{Cadence, TargetShape, allocated_at};
use crate::vulkan::{Aspects, Subresources};

/// Why a pass can't join the scope before it.
pub(super) enum Refusal {
    OtherAttachments,
    Clears(PhysicalIndex),
    Samples(PhysicalIndex),
    Uses(PhysicalIndex),
    Writes(PhysicalIndex),
    Resolved(PhysicalIndex),
    Runs(Cadence),
}

impl Refusal {
    /// A pass needs what the scope before it writes.
    fn needing(used: &Use) -> Refusal {
        if used.role.is_sampled() { Refusal::Samples(used.resource) } else { Refusal::Uses(used.resource) }
    }
}

impl Scope {
    /// Whether an operation can join; if not, why, unless it has nothing in common with the scope. `fixed`: the colours of
    /// pass and scope must be the same.
    pub(super) fn can_join(
        &self,
        adapted: &AdaptedFrame,
        op: u32,
        most_colors: usize,
        fixed: bool,
        local: impl Fn(&Use) -> bool,
        clashes: impl Fn(&Use) -> bool,
    ) -> Result<(), Option<Refusal>> {
        let uses = adapted.uses(op);
        let attached = |used: &Use| self.attaches(adapted, used);
        let reads_locally = uses.iter().any(&local);
        let shares = reads_locally || uses.iter().any(|used| used.role.is_attachment() && attached(used));
        let refuse = |why| Err(Some(why));
        let from_memory = |used: &&Use| !used.role.is_attachment() && !local(used);
        if let Some(used) = uses.iter().filter(from_memory).find(|used| self.overlaps(adapted, used)) {
            return refuse(Refusal::needing(used));
        }
        if let Some(used) =
            self.resolve_targets(adapted).find_map(|resource| uses.iter().find(|used| used.resource == resource))
        {
            return refuse(Refusal::needing(used));
        }
        if !shares {
            return Err(None);
        }
        if let Some(cadence) =
            self.ops.first().map(|first| adapted.cadence(*first)).filter(|it| *it != adapted.cadence(op))
        {
            return refuse(Refusal::Runs(cadence.clone()));
        }
        let same = |ours: Option<Target>, role| match (ours, plane_of(adapted, uses, role)) {
            (Some(a), Some(b)) => a == b,
            _ => true,
        };
        let part = |target: Target| (target.resource, Subresources { aspects: Aspects::empty(), ..target.range });
        let one_part = |role, other: Option<Target>| match (plane_of(adapted, uses, role), other) {
            (Some(a), Some(b)) => part(a) == part(b),
            _ => true,
        };
        let planes = same(self.depth, Role::Depth) && same(self.stencil, Role::Stencil);
        let planes = planes && one_part(Role::Depth, self.stencil) && one_part(Role::Stencil, self.depth);
        let colors = colors_of(adapted, uses);
        let may_differ = (reads_locally || self.local) && !fixed;
        let colors = colors == self.color || (may_differ && self.colors_fit(adapted, uses, most_colors));
        if !colors || !planes || !self.same_area(adapted, uses) {
            return refuse(Refusal::OtherAttachments);
        }
        // A pass that keeps the scope's colour and discards its depth can stay in the scope.
        let goes_on =
            uses.iter().any(|used| used.role.is_color() && used.contents == InitialContents::Keep && attached(used));
        let starts_anew = |used: &Use| match used.contents {
            InitialContents::Keep => false,
            InitialContents::Clear => true,
            InitialContents::Discard => used.role.is_color() || !goes_on,
        };
        for used in uses.iter().filter(|used| !local(used)) {
            if used.role.is_attachment() && starts_anew(used) && attached(used) {
                return refuse(Refusal::Clears(used.resource));
            }
            if clashes(used) {
                return refuse(if used.writes { Refusal::Writes(used.resource) } else { Refusal::needing(used) });
            }
        }
        match self.folded_resolves().next() {
            Some(op) => refuse(Refusal::Resolved(adapted.uses(op)[0].resource)),
            None => Ok(()),
        }
    }

    /// The resolve operations folded into its end.
    pub(crate) fn folded_resolves(&self) -> impl Iterator<Item = u32> + '_ {
        self.resolves.iter().chain([&self.depth_resolve]).flatten().copied()
    }

    /// Where the resolve of an attachment is noted.
    pub(super) fn resolve_of(&mut self, attachment: PhysicalIndex) -> Option<&mut Option<u32>> {
        match self.color.iter().position(|color| color.resource == attachment) {
            Some(location) => self.resolves.get_mut(location),
            None => {
                Some(&mut self.depth_resolve).filter(|_| self.depth.is_some_and(|depth| depth.resource == attachment))
            }
        }
    }

    /// Targets of its folded resolves.
    pub(super) fn resolve_targets<'a>(&'a self, adapted: &'a AdaptedFrame) -> impl Iterator<Item = PhysicalIndex> + 'a {
        self.folded_resolves().filter_map(|op| adapted.uses(op).get(1)).map(|target| target.resource)
    }

    /// All attachments.
    pub(crate) fn targets(&self) -> impl Iterator<Item = Target> + '_ {
        self.color.iter().copied().chain(self.depth).chain(self.stencil)
    }

    /// Whether a use is about exactly one of the attachments.
    pub(super) fn attaches(&self, adapted: &AdaptedFrame, used: &Use) -> bool {
        let target = Target::of(adapted, used);
        self.targets().any(|ours| ours == target)
    }

    /// Whether a use is about some of what is attached.
    pub(super) fn overlaps(&self, adapted: &AdaptedFrame, used: &Use) -> bool {
        let range = adapted.range(used);
        self.targets().any(|ours| ours.resource == used.resource && ours.range.overlaps(range))
    }

    fn same_area(&self, adapted: &AdaptedFrame, uses: &[Use]) -> bool {
        let first = self.targets().next();
        first.is_none_or(|first| {
            let attached = uses.iter().filter(|used| used.role.is_attachment());
            attached.map(|used| Target::of(adapted, used)).all(|target| shape(adapted, target) == shape(adapted, first))
        })
    }
}

/// Properties that the attachments of one scope have in common, as the device makes them.
fn shape(adapted: &AdaptedFrame, target: Target) -> Option<TargetShape> {
    let image = adapted.resources[target.resource as usize].image()?;
    let (mip, layers) = (target.range.base_mip, target.range.layers);
    let (extent, eyes) = (adapted.extent_at(target.resource, image, mip), adapted.eyes(target.resource));
    let allocated = allocated_at(image.extent, adapted.allocated(target.resource), mip);
    Some(TargetShape { extent, allocated, eyes, layers, samples: image.samples })
}
