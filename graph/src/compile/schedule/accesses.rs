//! The accesses of all operations to subresources, listed once because scheduling walks them often.

use crate::compile::model::{Adapted, SubresourceIndex};
use crate::vulkan::Layout;

/// An access of an operation to a subresource.
#[derive(Debug, Clone, Copy)]
pub(super) struct Access {
    pub(super) subresource: SubresourceIndex,
    pub(super) writes: bool,
    pub(super) layout: Layout,
}

/// The accesses of all operations.
#[derive(Debug)]
pub(super) struct Accesses {
    list: Vec<Access>,
    /// For each operation where its accesses begin, and where those of the last one end.
    starts: Vec<u32>,
    /// Number of subresources.
    pub(super) subresources: usize,
    /// Whether an operation has an effect that nothing shows.
    pub(super) has_effects: bool,
}

impl Accesses {
    pub(super) fn of(adapted: &Adapted) -> Accesses {
        let mut list: Vec<Access> = Vec::with_capacity(adapted.uses.len());
        let mut starts = Vec::with_capacity(adapted.ops.len() + 1);
        let mut has_effects = false;
        for (op, number) in adapted.ops.iter().zip(0_u32..) {
            starts.push(list.len() as u32);
            for used in adapted.uses(number) {
                let access = |subresource| Access { subresource, writes: used.writes, layout: used.layout };
                adapted.for_each_subresource(used, |subresource| list.push(access(subresource)));
            }
            if op.side_effect {
                // Effects that nothing shows are writes of a subresource behind all others.
                list.push(Access { subresource: adapted.subresources, writes: true, layout: Layout::Undefined });
                has_effects = true;
            }
        }
        starts.push(list.len() as u32);
        Accesses { list, starts, subresources: adapted.subresources as usize + 1, has_effects }
    }

    /// The subresource that an operation's effect writes, if it has one that nothing shows.
    pub(super) fn effect(&self, op: u32) -> Option<SubresourceIndex> {
        let behind_all = self.subresources as u32 - 1;
        self.op(op).last().map(|access| access.subresource).filter(|subresource| *subresource == behind_all)
    }

    /// Those of one operation.
    pub(super) fn op(&self, op: u32) -> &[Access] {
        &self.list[self.starts[op as usize] as usize..self.starts[op as usize + 1] as usize]
    }
}
