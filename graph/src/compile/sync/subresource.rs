//! What is known of each subresource while the steps are walked, and the barriers before its accesses.

use crate::compile::access_chain::stands_beside_reads;
use crate::compile::model::{PhysicalIndex, SubresourceIndex};
use crate::compile::queues::LayoutChange;
use crate::compile::steps::NEVER;
use crate::plan::Hazard;
use crate::vulkan::{Accesses, Layout, Stages};

/// The accesses to a subresource since its last barrier: one write, or reads in one layout. The next access that can't stand beside them
/// gets a barrier of its own, which waits for these alone: they waited for all older accesses. So, unlike an
/// [`AccessChain`](crate::compile::access_chain::AccessChain), it forgets what stands before the last barrier.
#[derive(Debug, Clone, Copy)]
pub(super) struct SubresourceState {
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
    /// Usage bits of all steps, of an image or a buffer.
    pub(super) usage: u32,
    /// The barrier before the first access.
    pub(super) first_barrier: u32,
    /// The barrier after the accesses that the first one serves.
    pub(super) second_barrier: u32,
    /// The barrier before the last access.
    pub(super) barrier: u32,
    /// The first step that accesses it.
    pub(super) first: u32,
    /// The last step that accesses it.
    pub(super) last: u32,
    /// Which access of that step it is.
    pub(super) access: u32,
    pub(super) layout: Layout,
}

impl SubresourceState {
    pub(super) const UNUSED: SubresourceState = SubresourceState {
        stages: Stages::empty(),
        accesses: Accesses::empty(),
        usage: 0,
        first_barrier: NEVER,
        second_barrier: NEVER,
        barrier: NEVER,
        first: NEVER,
        last: NEVER,
        access: NEVER,
        layout: Layout::Undefined,
    };

    pub(super) fn is_used(&self) -> bool {
        self.last != NEVER
    }

    pub(super) fn writes(&self) -> bool {
        !self.accesses.writes().is_empty()
    }

    /// Whether an access reads it in the same layout.
    pub(super) fn has_layout_for_read(&self, access: &SubresourceAccess) -> bool {
        self.is_used() && stands_beside_reads(access.writes(), access.layout, self.layout)
    }

    /// The hazard that an access after this one must be kept from.
    pub(super) fn hazard(&self, access: &SubresourceAccess) -> Hazard {
        match (self.writes(), access.writes()) {
            _ if !self.is_used() => Hazard::FirstUse,
            (true, false) => Hazard::ReadAfterWrite,
            (true, true) => Hazard::WriteAfterWrite,
            (false, true) => Hazard::WriteAfterRead,
            (false, false) => Hazard::LayoutChange,
        }
    }
}

/// All accesses of one step to one subresource.
#[derive(Debug, Clone, Copy)]
pub(super) struct SubresourceAccess {
    pub(super) subresource: SubresourceIndex,
    pub(super) resource: PhysicalIndex,
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
    pub(super) layout: Layout,
    /// Whether it needs the contents from before.
    pub(super) keeps: bool,
    pub(super) usage: u32,
}

impl SubresourceAccess {
    /// A change of layout alone.
    pub(super) fn of_change(change: &LayoutChange) -> SubresourceAccess {
        let LayoutChange { subresource, resource, layout } = *change;
        let (stages, accesses) = (Stages::empty(), Accesses::empty());
        SubresourceAccess { subresource, resource, stages, accesses, layout, keeps: true, usage: 0 }
    }

    pub(super) fn writes(&self) -> bool {
        !self.accesses.writes().is_empty()
    }
}

/// A barrier of one subresource.
#[derive(Debug, Clone, Copy)]
pub(in crate::compile) struct SubresourceBarrier {
    pub(in crate::compile) subresource: SubresourceIndex,
    pub(in crate::compile) resource: PhysicalIndex,
    /// The step before which it must stand; `NEVER` if it is not needed after all.
    pub(in crate::compile) step: u32,
    /// The step behind which it must stand; `NEVER` if none of this frame.
    pub(in crate::compile) after: u32,
    pub(in crate::compile) src_stages: Stages,
    pub(in crate::compile) src_accesses: Accesses,
    pub(in crate::compile) dst_stages: Stages,
    pub(in crate::compile) dst_accesses: Accesses,
    pub(in crate::compile) old_layout: Layout,
    pub(in crate::compile) new_layout: Layout,
    pub(in crate::compile) hazard: Hazard,
    /// Whether it keeps contents from before the frame.
    pub(in crate::compile) keeps: bool,
}

impl SubresourceBarrier {
    /// A barrier before an access. `after`: the stages and writes that it waits for, and the step that they end with.
    pub(super) fn before(
        access: &SubresourceAccess,
        step: u32,
        ((src_stages, src_accesses), after): ((Stages, Accesses), u32),
        old_layout: Layout,
        hazard: Hazard,
    ) -> SubresourceBarrier {
        SubresourceBarrier {
            subresource: access.subresource,
            resource: access.resource,
            step,
            after,
            src_stages,
            src_accesses,
            dst_stages: access.stages,
            dst_accesses: access.accesses,
            old_layout,
            new_layout: access.layout,
            hazard,
            keeps: access.keeps,
        }
    }

    /// Lets it stand before these accesses too.
    pub(super) fn widen(&mut self, stages: Stages, accesses: Accesses) {
        self.dst_stages |= stages;
        self.dst_accesses |= accesses;
    }
}
