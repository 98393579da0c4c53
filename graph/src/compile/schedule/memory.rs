//! How much memory an order keeps alive, and an order that keeps little.

use super::runs::Runs;
use crate::compile::model::{AdaptedFrame, Kind, PhysicalIndex};

/// Bytes of each resource in shared memory, counted in texels: the device's alignment and padding are not known here.
#[derive(Debug)]
pub(super) struct Memory {
    /// The last entry, 0, is that of the resource that stands for none.
    bytes: Vec<u64>,
    /// The bytes of all of them together; `None` if these are more than can be addressed.
    total: Option<u64>,
}

/// The lifetime of each resource in an order.
#[derive(Debug)]
pub(super) struct Lifetimes {
    /// Number of places in the order.
    places: u32,
    /// For each resource the first and the last place that use it.
    of: Vec<[u32; 2]>,
}

impl Lifetimes {
    /// Of `resources` resources, in an order that has `places` and is walked by [`Lifetimes::use_at`].
    pub(super) fn unused(resources: usize, places: u32) -> Lifetimes {
        Lifetimes { places, of: vec![[u32::MAX, 0]; resources] }
    }

    /// In an order of runs.
    pub(super) fn of(runs: &Runs, order: &[u32]) -> Lifetimes {
        let mut lifetimes = Lifetimes::unused(runs.resources(), order.len() as u32);
        for (run, place) in order.iter().zip(0_u32..) {
            runs.accesses(*run).iter().for_each(|access| lifetimes.use_at(access.resource, place));
        }
        lifetimes
    }

    /// Notes a use at a place, behind those that were noted.
    #[inline]
    pub(super) fn use_at(&mut self, resource: PhysicalIndex, place: u32) {
        let [first, last] = &mut self.of[resource as usize];
        (*first, *last) = (place.min(*first), place);
    }

    /// The first place that uses a resource.
    #[inline]
    pub(super) fn first(&self, resource: PhysicalIndex) -> u32 {
        self.of[resource as usize][0]
    }
}

impl Memory {
    pub(super) fn of(adapted: &AdaptedFrame) -> Memory {
        let mut total = Some(0_u64);
        let mut bytes: Vec<u64> = Vec::with_capacity(adapted.resources.len() + 1);
        for (resource, index) in adapted.resources.iter().zip(0..) {
            let here = match &resource.kind {
                _ if !resource.is_transient() => 0,
                Kind::Buffer(buffer) => buffer.bytes,
                Kind::Image(image) => {
                    let made = adapted.made(index, image);
                    let sides = made.extent.iter().map(|side| u64::from(*side));
                    let texels = sides.fold(u64::from(made.layers), u64::saturating_mul);
                    // Each mip level takes a quarter of the one before it: a third together.
                    let texels = if image.mips > 1 { texels.saturating_add(texels / 3) } else { texels };
                    texels.saturating_mul(image.format.texel_bytes()).saturating_mul(u64::from(image.samples))
                }
            };
            total = total.and_then(|total| total.checked_add(here));
            bytes.push(here);
        }
        bytes.push(0);
        Memory { bytes, total }
    }

    /// Bytes of one resource, 0 if it has memory of its own.
    #[inline]
    pub(super) fn bytes(&self, resource: PhysicalIndex) -> u64 {
        self.bytes[resource as usize]
    }

    /// The most bytes that are alive at one place of an order; `u64::MAX` if all resources take more than can be addressed.
    pub(super) fn peak(&self, lifetimes: &Lifetimes) -> u64 {
        if self.total.is_none() {
            return u64::MAX;
        }
        // Differences wrap around, but no sum does: each is at most the total.
        let mut changes = vec![0_u64; lifetimes.places as usize + 1];
        for ([first, last], bytes) in lifetimes.of.iter().zip(&self.bytes) {
            if *first != u32::MAX {
                let begins = &mut changes[*first as usize];
                *begins = begins.wrapping_add(*bytes);
                let ends = &mut changes[*last as usize + 1];
                *ends = ends.wrapping_sub(*bytes);
            }
        }
        let (mut alive, mut peak) = (0_u64, 0);
        for change in changes {
            alive = alive.wrapping_add(change);
            peak = peak.max(alive);
        }
        peak
    }
}

/// For each first number of `pairs`, all below `count`, the second ones: where each list starts, and the lists.
pub(super) fn lists(pairs: &[(u32, u32)], count: u32) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; count as usize + 1];
    pairs.iter().for_each(|(first, _)| starts[*first as usize] += 1);
    let mut end = 0;
    for start in &mut starts {
        end += *start;
        *start = end;
    }
    let mut lists = vec![0; pairs.len()];
    for (first, second) in pairs.iter().rev() {
        starts[*first as usize] -= 1;
        lists[starts[*first as usize] as usize] = *second;
    }
    (starts, lists)
}
