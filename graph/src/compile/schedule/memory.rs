//! How much memory an order keeps alive, and an order that keeps little.

use super::runs::Runs;
use crate::compile::model::{Adapted, Kind, PhysicalIndex};

/// Bytes of each resource in shared memory, counted in texels: the device's alignment and padding are not known here.
#[derive(Debug)]
pub(super) struct Memory {
    bytes: Vec<u64>,
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
    /// In an order of runs.
    pub(super) fn of(adapted: &Adapted, runs: &Runs, order: &[u32]) -> Lifetimes {
        let mut of = vec![[u32::MAX, 0]; adapted.resources.len()];
        for (run, place) in order.iter().zip(0_u32..) {
            runs.for_each_use(adapted, *run, |used| {
                let [first, last] = &mut of[used.resource as usize];
                (*first, *last) = (place.min(*first), place);
            });
        }
        Lifetimes { places: order.len() as u32, of }
    }
}

impl Memory {
    pub(super) fn of(adapted: &Adapted) -> Memory {
        let bytes = adapted.resources.iter().zip(0..).map(|(resource, index)| match &resource.kind {
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
        });
        Memory { bytes: bytes.collect() }
    }

    /// Bytes of one resource, 0 if it has memory of its own.
    pub(super) fn bytes(&self, resource: PhysicalIndex) -> u64 {
        self.bytes[resource as usize]
    }

    /// The most bytes that are alive at one place of an order.
    pub(super) fn peak(&self, lifetimes: &Lifetimes) -> u64 {
        let mut changes = vec![0_i128; lifetimes.places as usize + 1];
        for ([first, last], bytes) in lifetimes.of.iter().zip(&self.bytes) {
            if *first != u32::MAX {
                changes[*first as usize] += i128::from(*bytes);
                changes[*last as usize + 1] -= i128::from(*bytes);
            }
        }
        let (mut alive, mut peak) = (0, 0);
        for change in changes {
            alive += change;
            peak = peak.max(alive);
        }
        u64::try_from(peak).unwrap_or(u64::MAX)
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
