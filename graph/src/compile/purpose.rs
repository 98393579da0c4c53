//! What each image and buffer is made for: exactly the uses that the steps make of it, and what follows from its part in the
//! frame and from the states in which it is found and left.

use super::Options;
use super::history_ring::last_of_ring;
use super::model::{Adapted, Home, Kind};
use super::parts::Grids;
use super::retain::Retained;
use super::scope::{Scoped, Step};
use super::sync::Timeline;
use crate::vulkan::states::usage_for;
use crate::vulkan::{BufferUsage, LoadOp, StoreOp, Usage};

/// Notes usages: what outlives the frame can be copied from, what has initial contents can be copied to; images that never
/// leave their one scope become transient attachments.
pub(super) fn note(
    grids: &Grids,
    adapted: &mut Adapted,
    timeline: &Timeline,
    retained: &Retained,
    scoped: &Scoped,
    options: &Options,
) {
    let attachments_only = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT | Usage::INPUT_ATTACHMENT;
    for at in 0..adapted.stores.len() {
        let store = &adapted.stores[at];
        let bits = timeline.usage(store.cells(grids));
        let [first, last] = timeline.lifetimes[at];
        let in_one_scope = first == last && matches!(scoped.steps.get(first as usize), Some(Step::Scope(_)));
        let stays = in_one_scope
            && retained
                .of(first)
                .iter()
                .filter(|ops| ops.target.store == at as u32)
                .all(|ops| ops.load != LoadOp::Load && ops.store != StoreOp::Store);
        let store = &mut adapted.stores[at];
        let home = store.home;
        match &mut store.kind {
            Kind::Image(image) => {
                image.usage = Usage::from_bits_truncate(bits);
                for state in timeline.states[at].iter().flat_map(|states| [states.before, states.after]) {
                    image.usage |= usage_for(state.layout);
                }
                match home {
                    Home::Transient if options.poison => image.usage |= Usage::TRANSFER_DST,
                    Home::Transient if stays && attachments_only.contains(image.usage) => {
                        image.usage |= Usage::TRANSIENT_ATTACHMENT;
                    }
                    Home::Transient => {}
                    // A file is copied into it, and mip levels are made one from the other.
                    Home::Persistent { initial: None, .. } if image.mips == 1 => image.usage |= Usage::TRANSFER_DST,
                    Home::Persistent { .. } => image.usage |= Usage::TRANSFER_SRC | Usage::TRANSFER_DST,
                    Home::Imported { .. } => image.usage |= Usage::TRANSFER_SRC | Usage::TRANSFER_DST,
                    Home::Output => image.usage |= Usage::TRANSFER_SRC,
                }
            }
            Kind::Buffer(buffer) => {
                buffer.usage = BufferUsage::from_bits_truncate(bits);
                match home {
                    Home::Transient if options.poison => buffer.usage |= BufferUsage::TRANSFER_DST,
                    Home::Transient => {}
                    Home::Persistent { .. } | Home::Imported { .. } => {
                        buffer.usage |= BufferUsage::TRANSFER_SRC | BufferUsage::TRANSFER_DST;
                    }
                    Home::Output => buffer.usage |= BufferUsage::TRANSFER_SRC,
                }
            }
        }
    }
    share_purpose(adapted);
}

/// What becomes each other from frame to frame is the same images in other roles, made for all of these.
fn share_purpose(adapted: &mut Adapted) {
    let mut first = 0;
    while let Some(store) = adapted.stores.get(first as usize) {
        let last = if let Home::Persistent { .. } = store.home { last_of_ring(adapted, first) } else { first };
        if last > first {
            let cycle = &mut adapted.stores[first as usize..=last as usize];
            let (mut images, mut buffers) = (Usage::empty(), BufferUsage::empty());
            for store in &*cycle {
                match &store.kind {
                    Kind::Image(image) => images |= image.usage,
                    Kind::Buffer(buffer) => buffers |= buffer.usage,
                }
            }
            for store in cycle {
                match &mut store.kind {
                    Kind::Image(image) => image.usage = images,
                    Kind::Buffer(buffer) => buffer.usage = buffers,
                }
            }
        }
        first = last + 1;
    }
}
