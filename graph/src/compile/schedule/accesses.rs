//! The accesses of all operations to subresources, listed once because scheduling walks them often.

use crate::compile::model::{Adapted, PhysicalIndex, SubresourceIndex, Use};
use crate::vulkan::Layout;

/// An access of an operation to a subresource.
#[derive(Debug, Clone, Copy)]
pub(super) struct Access {
    pub(super) subresource: SubresourceIndex,
    /// The image or buffer of a use, named by the first of its accesses; [`Access::NO_USE`] for the others.
    pub(super) resource: PhysicalIndex,
    pub(super) writes: bool,
    pub(super) layout: Layout,
}

impl Access {
    /// No use begins with this access.
    const NO_USE: PhysicalIndex = PhysicalIndex::MAX;
    /// The access is an effect that nothing shows.
    const EFFECT: PhysicalIndex = PhysicalIndex::MAX - 1;

    /// The image or buffer of the use that begins with this access, if one does.
    #[inline]
    pub(super) fn used(&self) -> Option<PhysicalIndex> {
        (self.resource < Access::EFFECT).then_some(self.resource)
    }

    /// Whether it is an effect that nothing shows.
    #[inline]
    pub(super) fn is_effect(&self) -> bool {
        self.resource == Access::EFFECT
    }
}

/// The accesses of all operations.
#[derive(Debug)]
pub(super) struct Accesses {
    list: Vec<Access>,
    /// For each operation where its accesses begin, and where those of the last one end.
    starts: Vec<u32>,
    /// Number of subresources.
    pub(super) subresources: usize,
}

impl Accesses {
    pub(super) fn of(adapted: &Adapted) -> Accesses {
        if adapted.is_uncut() && !adapted.ops.iter().any(|op| op.side_effect) {
            return Accesses::of_uses(adapted);
        }
        let mut list: Vec<Access> = Vec::with_capacity(adapted.uses.len());
        let mut starts = Vec::with_capacity(adapted.ops.len() + 1);
        for op in &adapted.ops {
            starts.push(list.len() as u32);
            for used in &adapted.uses[op.uses.start as usize..op.uses.end as usize] {
                let mut resource = used.resource;
                adapted.for_each_subresource(used, |subresource| {
                    let resource = std::mem::replace(&mut resource, Access::NO_USE);
                    list.push(Access { subresource, resource, writes: used.writes, layout: used.layout });
                });
            }
            if op.side_effect {
                // Effects that nothing shows are writes of a subresource behind all others.
                let (subresource, resource) = (adapted.subresources, Access::EFFECT);
                list.push(Access { subresource, resource, writes: true, layout: Layout::Undefined });
            }
        }
        starts.push(list.len() as u32);
        Accesses { list, starts, subresources: adapted.subresources as usize + 1 }
    }

    /// Those of operations each of whose uses is one access, as they mostly are.
    fn of_uses(adapted: &Adapted) -> Accesses {
        let access = |used: &Use| {
            let Use { subresource, resource, writes, layout, .. } = *used;
            Access { subresource, resource, writes, layout }
        };
        let starts = adapted.ops.iter().map(|op| op.uses.start).chain([adapted.uses.len() as u32]);
        Accesses {
            list: adapted.uses.iter().map(access).collect(),
            starts: starts.collect(),
            subresources: adapted.subresources as usize + 1,
        }
    }

    /// Those of the operations `ops`, in this order.
    pub(super) fn in_order(&self, ops: &[u32]) -> Accesses {
        let mut list = Vec::with_capacity(self.list.len());
        let mut starts = Vec::with_capacity(self.starts.len());
        for op in ops {
            starts.push(list.len() as u32);
            list.extend_from_slice(self.op(*op));
        }
        starts.push(list.len() as u32);
        Accesses { list, starts, subresources: self.subresources }
    }

    /// Those of one operation.
    #[inline]
    pub(super) fn op(&self, op: u32) -> &[Access] {
        self.between(op, op + 1)
    }

    /// Those from one operation on, up to another one.
    #[inline]
    pub(super) fn between(&self, first: u32, end: u32) -> &[Access] {
        &self.list[self.starts[first as usize] as usize..self.starts[end as usize] as usize]
    }
}
