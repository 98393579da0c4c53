//! Usage flags of each image and buffer: those that its steps take, and those that follow from its lifetime and from its
//! states before and after the frame.

use super::model::{Adapted, Home, Kind};
use super::options::Options;
use super::outlive::{States, cells, last_of_cycle};
use super::parts::Grids;
use super::retain::Retained;
use super::scope::{Scoped, Step};
use super::synchronise::Walked;
use crate::vulkan::states::usage_for;
use crate::vulkan::{BufferUsage, LoadOp, StoreOp, Usage};

/// Sets usages. Outputs and all that outlives the frame can be copied from, initial contents can be copied to, and images that
/// never leave their only scope become transient attachments.
pub(super) fn note(
    grids: &Grids,
    adapted: &mut Adapted,
    walked: &Walked,
    states: &[Option<States>],
    retained: &Retained,
    scoped: &Scoped,
    options: &Options,
) {
    let attachments_only = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT | Usage::INPUT_ATTACHMENT;
    for at in 0..adapted.stores.len() {
        let store = &adapted.stores[at];
        let bits = walked.usage(cells(grids, store));
        let [first, last] = walked.lifetimes[at];
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
                for state in states[at].iter().flat_map(|states| [states.before, states.after]) {
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
    share_usages(adapted);
}

/// History images rotate from frame to frame, so each gets the usages of all.
fn share_usages(adapted: &mut Adapted) {
    let mut first = 0;
    while let Some(store) = adapted.stores.get(first as usize) {
        let last = if let Home::Persistent { .. } = store.home { last_of_cycle(adapted, first) } else { first };
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
