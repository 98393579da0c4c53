//! `usage`: how each image and buffer is made and used. Usage flags come from its steps, from its lifetime,
//! and from its states before and after the frame.

use super::history_ring::last_of_ring;
use super::model::{AdaptedFrame, Kind, MemorySource, PhysicalIndex};
use super::options::Options;
use super::retain::{AttachmentOps, LoadStoreOps};
use super::scope::{ScopedSteps, Step};
use super::sync::AccessTimeline;
use crate::vulkan::{BufferUsage, LoadOp, Sharing, StoreOp, Usage};

/// Gives each physical resource its sharing and its usage flags, and each use the layout that it has in its step.
pub(super) fn finish(
    mut adapted: AdaptedFrame,
    sharing: &[(PhysicalIndex, Sharing)],
    timeline: &AccessTimeline,
    load_store: &LoadStoreOps,
    scoped: &ScopedSteps,
    options: &Options,
) -> AdaptedFrame {
    for at in 0..adapted.resources.len() as PhysicalIndex {
        let bits = usage(&adapted, at, timeline, load_store, scoped, options);
        adapted.resources[at as usize].set_usage(bits);
    }
    share_usages(&mut adapted);
    sharing.iter().for_each(|(resource, sharing)| adapted.resources[*resource as usize].set_sharing(*sharing));
    timeline.give_layouts(&mut adapted.uses);
    adapted
}

/// The usage flags of a physical resource, as the bits of `VkImageUsageFlags` or `VkBufferUsageFlags`. Outputs and all that
/// outlives the frame can be copied from, initial contents can be copied to, and images that never leave their only scope
/// become transient attachments.
fn usage(
    adapted: &AdaptedFrame,
    at: PhysicalIndex,
    timeline: &AccessTimeline,
    load_store: &LoadStoreOps,
    scoped: &ScopedSteps,
    options: &Options,
) -> u32 {
    let stays_in_scope = || {
        let [first, last] = timeline.lifetimes[at as usize];
        let in_one_scope = first == last && matches!(scoped.steps.get(first as usize), Some(Step::Scope(_)));
        let stays = |ops: &AttachmentOps| ops.load != LoadOp::Load && ops.store != StoreOp::Store;
        in_one_scope && load_store.of(first).iter().filter(|ops| ops.target.resource == at).all(stays)
    };
    let resource = &adapted.resources[at as usize];
    let bits = timeline.usage(resource.subresources());
    match &resource.kind {
        Kind::Image(image) => {
            let mut usage = Usage::from_bits_truncate(bits);
            if let Some(states) = &timeline.states[at as usize] {
                usage |= states.before.layout.usage() | states.after.layout.usage();
            }
            (usage | of_image(usage, resource.memory, image.mips, options, stays_in_scope)).bits()
        }
        Kind::Buffer(_) => (BufferUsage::from_bits_truncate(bits) | of_buffer(resource.memory, options)).bits(),
    }
}

/// The usage that follows from the lifetime of an image, which has `usage` already.
fn of_image(
    usage: Usage,
    memory: MemorySource,
    mips: u32,
    options: &Options,
    stays_in_scope: impl Fn() -> bool,
) -> Usage {
    let attachments_only = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT | Usage::INPUT_ATTACHMENT;
    match memory {
        MemorySource::Transient if options.readable => Usage::TRANSFER_SRC | Usage::TRANSFER_DST,
        MemorySource::Transient if options.poison => Usage::TRANSFER_DST,
        MemorySource::Transient if attachments_only.contains(usage) && stays_in_scope() => Usage::TRANSIENT_ATTACHMENT,
        MemorySource::Transient => Usage::empty(),
        // A file is copied into it, and mip levels are made one from the other.
        MemorySource::Persistent { initial: None, .. } if mips == 1 => Usage::TRANSFER_DST,
        MemorySource::Persistent { .. } | MemorySource::Imported { .. } => Usage::TRANSFER_SRC | Usage::TRANSFER_DST,
        MemorySource::Output if options.poison => Usage::TRANSFER_SRC | Usage::TRANSFER_DST,
        MemorySource::Output => Usage::TRANSFER_SRC,
    }
}

/// The usage that follows from the lifetime of a buffer.
fn of_buffer(memory: MemorySource, options: &Options) -> BufferUsage {
    match memory {
        MemorySource::Transient if options.readable => BufferUsage::TRANSFER_SRC | BufferUsage::TRANSFER_DST,
        MemorySource::Transient if options.poison => BufferUsage::TRANSFER_DST,
        MemorySource::Transient => BufferUsage::empty(),
        MemorySource::Persistent { .. } | MemorySource::Imported { .. } => {
            BufferUsage::TRANSFER_SRC | BufferUsage::TRANSFER_DST
        }
        MemorySource::Output => BufferUsage::TRANSFER_SRC,
    }
}

/// History images and buffers rotate from frame to frame, so each gets the usages of all.
fn share_usages(adapted: &mut AdaptedFrame) {
    let mut first = 0;
    while (first as usize) < adapted.resources.len() {
        let last = last_of_ring(adapted, first);
        if last > first {
            let ring = &mut adapted.resources[first as usize..=last as usize];
            let all = ring.iter().fold(0, |all, resource| all | resource.usage());
            ring.iter_mut().for_each(|resource| resource.set_usage(all));
        }
        first = last + 1;
    }
}
