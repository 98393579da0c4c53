//! `place`: transient images get an offset in memory that they share with others that live at other times.

use super::Options;
use super::model::{Adapted, StoreIndex};
use super::pack::{self, Block, Packing};
use super::retain::Retained;
use crate::describe::Diagnostic;
use crate::device::{MemoryNeeds, MemoryProvider, Profile};
use crate::plan::{Heap, Placement, StepId};
use crate::source::Span;
use crate::vocabulary::Usage;

/// Where everything lies.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) heaps: Vec<Heap>,
    /// For each store its place, if it is transient.
    pub(super) placements: Vec<Option<Placement>>,
    /// Bytes if each had memory of its own.
    pub(super) transient_bytes: u64,
    /// Largest total alive at one step.
    pub(super) live_peak_bytes: u64,
    /// Bytes of output images.
    pub(super) output_bytes: u64,
}

pub(super) fn place(
    adapted: &Adapted,
    retained: &Retained,
    device: &Profile,
    memory: &mut dyn MemoryProvider,
    options: &Options,
) -> Result<Placed, Vec<Diagnostic>> {
    let mut placed = Placed {
        heaps: Vec::new(),
        placements: vec![None; adapted.stores.len()],
        transient_bytes: 0,
        live_peak_bytes: 0,
        output_bytes: 0,
    };
    let mut members: Vec<Vec<(StoreIndex, Block)>> = Vec::new();
    for (store, at) in adapted.stores.iter().zip(0_u32..) {
        let (Some(first), Some(last)) = (retained.of(at).first(), retained.of(at).last()) else { continue };
        let needs = memory.image(&store.descriptor);
        if store.output {
            placed.output_bytes = placed.output_bytes.saturating_add(needs.bytes);
            continue;
        }
        let lazily = device.lazily_allocated_memory && store.descriptor.usage.contains(Usage::TRANSIENT_ATTACHMENT);
        let heap = choose_heap(&mut placed.heaps, &needs, lazily);
        members.resize_with(placed.heaps.len(), Vec::new);
        members[heap]
            .push((at, Block { first: first.step, last: last.step, bytes: needs.bytes, alignment: needs.alignment }));
        placed.transient_bytes = placed.transient_bytes.saturating_add(needs.bytes);
        placed.placements[at as usize] = Some(Placement {
            heap: heap as u32,
            offset: 0,
            bytes: needs.bytes,
            alignment: needs.alignment,
            type_bits: needs.type_bits,
            lifetime: [StepId(first.step), StepId(last.step)],
        });
    }
    // Offsets and heights of whatever packing stay below this sum, so none of them overflows.
    let padding = members.iter().flatten().map(|(_, block)| block.alignment).fold(0, u64::saturating_add);
    let most = placed.transient_bytes.saturating_add(padding).saturating_add(placed.output_bytes);
    if most > i64::MAX as u64 {
        let message = "the frame's images take more memory than can be addressed".to_owned();
        return Err(vec![Diagnostic::new(Span::NONE, message).help("make images smaller or fewer")]);
    }
    for (heap, members) in placed.heaps.iter_mut().zip(&members) {
        let blocks: Vec<Block> = members.iter().map(|(_, block)| *block).collect();
        let live_peak = pack::live_peak(&blocks);
        let packing = if options.alias { pack::pack(&blocks, live_peak) } else { side_by_side(&blocks) };
        heap.bytes = packing.height;
        for ((store, _), offset) in members.iter().zip(packing.offsets) {
            if let Some(placement) = &mut placed.placements[*store as usize] {
                placement.offset = offset;
            }
        }
    }
    let all: Vec<Block> = members.iter().flatten().map(|(_, block)| *block).collect();
    placed.live_peak_bytes = pack::live_peak(&all);
    Ok(placed)
}

/// The first heap whose memory types fit, narrowed to those that both accept.
fn choose_heap(heaps: &mut Vec<Heap>, needs: &MemoryNeeds, lazily: bool) -> usize {
    let fits = |heap: &Heap| heap.lazily_allocated == lazily && heap.type_bits & needs.type_bits != 0;
    let at = heaps.iter().position(fits).unwrap_or_else(|| {
        heaps.push(Heap { bytes: 0, alignment: 1, type_bits: needs.type_bits, lazily_allocated: lazily });
        heaps.len() - 1
    });
    heaps[at].type_bits &= needs.type_bits;
    heaps[at].alignment = heaps[at].alignment.max(needs.alignment);
    at
}

/// Nothing shares.
fn side_by_side(blocks: &[Block]) -> Packing {
    let mut packing = Packing { offsets: Vec::with_capacity(blocks.len()), height: 0 };
    for block in blocks {
        let offset = packing.height.checked_next_multiple_of(block.alignment.max(1)).unwrap_or(u64::MAX);
        packing.offsets.push(offset);
        packing.height = offset.saturating_add(block.bytes);
    }
    packing
}
