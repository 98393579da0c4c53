//! The accesses of all operations to subresources, listed once because scheduling walks them often.

use crate::compile::model::{AdaptedFrame, PhysicalIndex, SubresourceIndex, Use};
use crate::vulkan::Layout;

/// An access of an operation to a subresource.
#[derive(Debug, Clone, Copy)]
pub(super) struct Access {
    pub(super) subresource: SubresourceIndex,
    /// The image or buffer of a use, named by the first of its accesses. The others, and effects that nothing shows, name
    /// [`Accesses::no_resource`].
    pub(super) resource: PhysicalIndex,
    pub(super) writes: bool,
    pub(super) layout: Layout,
    /// Whether the access is an effect that nothing shows.
    pub(super) is_effect: bool,
}

/// The accesses of all operations.
#[derive(Debug)]
pub(super) struct Accesses {
    list: Vec<Access>,
    /// For each operation where its accesses begin, and where those of the last one end.
    starts: Vec<u32>,
    /// Number of subresources, with one behind all of them that effects write.
    pub(super) subresources: usize,
    /// Stands for no resource. It is one behind all of them, and has no bytes.
    pub(super) no_resource: PhysicalIndex,
    /// Whether any access is an effect that nothing shows.
    pub(super) has_effects: bool,
}

impl Accesses {
    pub(super) fn of(adapted: &AdaptedFrame) -> Accesses {
        let has_effects = adapted.ops.iter().any(|op| op.side_effect);
        if adapted.is_uncut() && !has_effects {
            return Accesses::of_uses(adapted);
        }
        let no_resource = adapted.resources.len() as PhysicalIndex;
        let mut list: Vec<Access> = Vec::with_capacity(adapted.uses.len());
        let mut starts = Vec::with_capacity(adapted.ops.len() + 1);
        for op in &adapted.ops {
            starts.push(list.len() as u32);
            for used in &adapted.uses[op.uses.start as usize..op.uses.end as usize] {
                let mut resource = used.resource;
                adapted.for_each_subresource(used, |subresource| {
                    let resource = std::mem::replace(&mut resource, no_resource);
                    let Use { writes, layout, .. } = *used;
                    list.push(Access { subresource, resource, writes, layout, is_effect: false });
                });
            }
            if op.side_effect {
                // Effects that nothing shows are writes of a subresource behind all others.
                let (subresource, resource, layout) = (adapted.subresources, no_resource, Layout::Undefined);
                list.push(Access { subresource, resource, writes: true, layout, is_effect: true });
            }
        }
        starts.push(list.len() as u32);
        Accesses { list, starts, subresources: adapted.subresources as usize + 1, no_resource, has_effects }
    }

    /// Those of operations each of whose uses is one access, as they mostly are.
    fn of_uses(adapted: &AdaptedFrame) -> Accesses {
        let access = |used: &Use| {
            let Use { subresource, resource, writes, layout, .. } = *used;
            Access { subresource, resource, writes, layout, is_effect: false }
        };
        let starts = adapted.ops.iter().map(|op| op.uses.start).chain([adapted.uses.len() as u32]);
        Accesses {
            list: adapted.uses.iter().map(access).collect(),
            starts: starts.collect(),
            subresources: adapted.subresources as usize + 1,
            no_resource: adapted.resources.len() as PhysicalIndex,
            has_effects: false,
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
        Accesses { list, starts, ..*self }
    }

    /// Number of operations.
    pub(super) fn ops(&self) -> u32 {
        self.starts.len() as u32 - 1
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
