//! `place`: transient images get an offset in memory that they share with others that live at other times.

use super::Options;
use super::model::{Adapted, Kind, StoreIndex};
use super::pack::{self, Block, Packing};
use super::synchronise::NEVER;
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
    /// Bytes of what outlives the frame.
    pub(super) kept_bytes: u64,
}

/// A heap with what shares it.
struct Members {
    /// Images don't share memory with buffers: rows of texels and bytes may need a distance (`bufferImageGranularity`).
    images: bool,
    list: Vec<(StoreIndex, Block)>,
}

/// `spans` are longer than lifetimes where steps of several queues run side by side.
pub(super) fn place(
    adapted: &Adapted,
    lifetimes: &[[u32; 2]],
    spans: Option<&[[u32; 2]]>,
    device: &Profile,
    memory: &mut dyn MemoryProvider,
    options: &Options,
) -> Result<Placed, Vec<Diagnostic>> {
    let mut placed = Placed {
        heaps: Vec::new(),
        placements: Vec::with_capacity(adapted.stores.len()),
        transient_bytes: 0,
        live_peak_bytes: 0,
        kept_bytes: 0,
    };
    let mut members: Vec<Members> = Vec::new();
    let (overlaps, spans) = (spans.is_some(), spans.unwrap_or(lifetimes));
    for (((store, [first, last]), span), at) in adapted.stores.iter().zip(lifetimes).zip(spans).zip(0_u32..) {
        if *first == NEVER && store.is_transient() {
            placed.placements.push(None);
            continue;
        }
        let (needs, lazily) = match &store.kind {
            Kind::Image(image) => {
                let transient = image.usage.contains(Usage::TRANSIENT_ATTACHMENT);
                (memory.image(image), device.lazily_allocated_memory && transient)
            }
            Kind::Buffer(buffer) => (memory.buffer(buffer), false),
        };
        if !store.is_transient() {
            placed.kept_bytes = placed.kept_bytes.saturating_add(needs.bytes);
            placed.placements.push(None);
            continue;
        }
        let most = adapted.stores.len() - at as usize;
        let heap = choose_heap(&mut placed.heaps, &mut members, &needs, lazily, store.image().is_some(), most);
        let block = Block { first: span[0], last: span[1], bytes: needs.bytes, alignment: needs.alignment };
        members[heap].list.push((at, block));
        placed.transient_bytes = placed.transient_bytes.saturating_add(needs.bytes);
        placed.placements.push(Some(Placement {
            heap: heap as u32,
            offset: 0,
            bytes: needs.bytes,
            alignment: needs.alignment,
            type_bits: needs.type_bits,
            lifetime: [StepId(*first), StepId(*last)],
        }));
    }
    // Offsets and heights of whatever packing stay below this sum, so none of them overflows.
    let blocks = members.iter().flat_map(|members| &members.list);
    let padding = blocks.map(|(_, block)| block.alignment).fold(0, u64::saturating_add);
    let most = placed.transient_bytes.saturating_add(padding).saturating_add(placed.kept_bytes);
    if most > i64::MAX as u64 {
        let message = "the frame's images and buffers take more memory than can be addressed".to_owned();
        return Err(vec![Diagnostic::new(Span::NONE, message).help("make them smaller or fewer")]);
    }
    for (heap, members) in placed.heaps.iter_mut().zip(&mut members) {
        let in_order = |(_, block): &(StoreIndex, Block)| block.first;
        if !members.list.is_sorted_by_key(in_order) {
            members.list.sort_by_key(in_order);
        }
        let blocks: Vec<Block> = members.list.iter().map(|(_, block)| *block).collect();
        let live_peak = pack::live_peak(&blocks);
        let packing = if options.alias { pack::pack(&blocks, live_peak) } else { side_by_side(&blocks) };
        heap.bytes = packing.height;
        for ((store, _), offset) in members.list.iter().zip(packing.offsets) {
            if let Some(placement) = &mut placed.placements[*store as usize] {
                placement.offset = offset;
            }
        }
        placed.live_peak_bytes = live_peak;
    }
    if members.len() > 1 || overlaps {
        let alive = |(store, block): &(StoreIndex, Block)| {
            let [first, last] = lifetimes[*store as usize];
            Block { first, last, ..*block }
        };
        let all: Vec<Block> = members.iter().flat_map(|members| &members.list).map(alive).collect();
        placed.live_peak_bytes = pack::live_peak(&all);
    }
    Ok(placed)
}

/// The first heap whose memory types fit, narrowed to those that both accept; a new one for `most` members.
fn choose_heap(
    heaps: &mut Vec<Heap>,
    members: &mut Vec<Members>,
    needs: &MemoryNeeds,
    lazily: bool,
    images: bool,
    most: usize,
) -> usize {
    let fits = |(heap, members): (&Heap, &Members)| {
        members.images == images && heap.lazily_allocated == lazily && heap.type_bits & needs.type_bits != 0
    };
    let at = heaps.iter().zip(members.iter()).position(fits).unwrap_or_else(|| {
        heaps.push(Heap { bytes: 0, alignment: 1, type_bits: needs.type_bits, lazily_allocated: lazily });
        members.push(Members { images, list: Vec::with_capacity(most) });
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
