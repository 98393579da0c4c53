//! History rings: physical resources that rotate. In the next frame each takes the place of the next one.
//!
//! The members of a ring have neighbouring indices, the youngest first. A resource that doesn't rotate is a ring of one.
//! What a member holds at the start of a frame, and who puts it there, stands in `docs/architecture.md`.

use super::model::{AdaptedFrame, MemorySource, PhysicalIndex};

/// The oldest member of the ring that `member` is in.
#[inline]
pub(super) fn last_of_ring(adapted: &AdaptedFrame, member: PhysicalIndex) -> PhysicalIndex {
    let mut last = member;
    while let MemorySource::Persistent { becomes, .. } = adapted.resources[last as usize].memory
        && becomes > last
    {
        last += 1;
    }
    last
}

/// The members that were `member` in earlier frames: how many frames ago, and which one. It was itself a whole turn ago.
pub(super) fn earlier(adapted: &AdaptedFrame, member: PhysicalIndex) -> impl Iterator<Item = (u32, PhysicalIndex)> {
    let last = last_of_ring(adapted, member);
    let same_ring = |first: &PhysicalIndex| last_of_ring(adapted, *first) == last;
    let first = (0..=member).rev().take_while(same_ring).last().unwrap_or(member);
    let length = last - first + 1;
    (1..=length).map(move |ago| (ago, first + (member - first + length - ago) % length))
}
