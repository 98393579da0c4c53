//! `usage`: how each image and buffer is made and used. Its usage flags are those that its steps take, and those that follow
//! from its lifetime and from its states before and after the frame.

use super::history_ring::last_of_ring;
use super::model::{Adapted, Kind, MemorySource, PhysicalIndex};
use super::options::Options;
use super::retain::{AttachmentOps, LoadStoreOps};
use super::scope::{Scoped, Step};
use super::sync::AccessTimeline;
use crate::vulkan::states::usage_for;
use crate::vulkan::{BufferUsage, LoadOp, Sharing, StoreOp, Usage};

/// Gives each physical resource its sharing and its usage flags, and each use the layout that it has in its step.
pub(super) fn finish(
    mut adapted: Adapted,
    sharing: &[(PhysicalIndex, Sharing)],
    timeline: &mut AccessTimeline,
    load_store: &LoadStoreOps,
    scoped: &Scoped,
    options: &Options,
) -> Adapted {
    let usages = usages(&adapted, timeline, load_store, scoped, options);
    adapted.resources.iter_mut().zip(usages).for_each(|(resource, usage)| resource.set_usage(usage));
    sharing.iter().for_each(|(resource, sharing)| adapted.resources[*resource as usize].set_sharing(*sharing));
    timeline.swap_layouts(&mut adapted.uses);
    adapted
}

/// For each physical resource its usage flags, as the bits of `VkImageUsageFlags` or `VkBufferUsageFlags`. Outputs and all
/// that outlives the frame can be copied from, initial contents can be copied to, and images that never leave their only
/// scope become transient attachments.
fn usages(
    adapted: &Adapted,
    timeline: &AccessTimeline,
    load_store: &LoadStoreOps,
    scoped: &Scoped,
    options: &Options,
) -> Vec<u32> {
    let stays_in_scope = |at: u32| {
        let [first, last] = timeline.lifetimes[at as usize];
        let in_one_scope = first == last && matches!(scoped.steps.get(first as usize), Some(Step::Scope(_)));
        let stays = |ops: &AttachmentOps| ops.load != LoadOp::Load && ops.store != StoreOp::Store;
        in_one_scope && load_store.of(first).iter().filter(|ops| ops.target.resource == at).all(stays)
    };
    let mut usages = Vec::with_capacity(adapted.resources.len());
    for (resource, at) in adapted.resources.iter().zip(0_u32..) {
        let bits = timeline.usage(resource.subresources());
        usages.push(match &resource.kind {
            Kind::Image(image) => {
                let mut usage = Usage::from_bits_truncate(bits);
                for state in timeline.states[at as usize].iter().flat_map(|states| [states.before, states.after]) {
                    usage |= usage_for(state.layout);
                }
                (usage | of_image(usage, resource.memory, image.mips, options.poison, || stays_in_scope(at))).bits()
            }
            Kind::Buffer(_) => {
                (BufferUsage::from_bits_truncate(bits) | of_buffer(resource.memory, options.poison)).bits()
            }
        });
    }
    share_usages(adapted, &mut usages);
    usages
}

/// The usage that follows from the lifetime of an image, which has `usage` already.
fn of_image(usage: Usage, memory: MemorySource, mips: u32, poison: bool, stays_in_scope: impl Fn() -> bool) -> Usage {
    let attachments_only = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT | Usage::INPUT_ATTACHMENT;
    match memory {
        MemorySource::Transient if poison => Usage::TRANSFER_DST,
        MemorySource::Transient if attachments_only.contains(usage) && stays_in_scope() => Usage::TRANSIENT_ATTACHMENT,
        MemorySource::Transient => Usage::empty(),
        // A file is copied into it, and mip levels are made one from the other.
        MemorySource::Persistent { initial: None, .. } if mips == 1 => Usage::TRANSFER_DST,
        MemorySource::Persistent { .. } | MemorySource::Imported { .. } => Usage::TRANSFER_SRC | Usage::TRANSFER_DST,
        MemorySource::Output => Usage::TRANSFER_SRC,
    }
}

/// The usage that follows from the lifetime of a buffer.
fn of_buffer(memory: MemorySource, poison: bool) -> BufferUsage {
    match memory {
        MemorySource::Transient if poison => BufferUsage::TRANSFER_DST,
        MemorySource::Transient => BufferUsage::empty(),
        MemorySource::Persistent { .. } | MemorySource::Imported { .. } => {
            BufferUsage::TRANSFER_SRC | BufferUsage::TRANSFER_DST
        }
        MemorySource::Output => BufferUsage::TRANSFER_SRC,
    }
}

/// History images rotate from frame to frame, so each gets the usages of all.
fn share_usages(adapted: &Adapted, usages: &mut [u32]) {
    let mut first = 0;
    while first < usages.len() {
        let last = last_of_ring(adapted, first as PhysicalIndex) as usize;
        if last > first {
            let ring = &mut usages[first..=last];
            let all = ring.iter().fold(0, |all, usage| all | usage);
            ring.fill(all);
        }
        first = last + 1;
    }
}
