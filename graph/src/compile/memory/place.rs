//! `place`: each transient image and buffer gets an offset in memory, which others that live at other times share.

use super::intervals::Intervals;
use super::pack::{Block, MeasuredBlocks, Packing};
use crate::base::{Code, Diagnostic, Span};
use crate::compile::model::{AdaptedFrame, Kind, PhysicalIndex};
use crate::compile::options::Options;
use crate::compile::steps::NEVER;
use crate::device::{ImageDescriptor, MemoryNeeds, MemoryProvider, Profile};
use crate::plan::{Heap, Placement, StepId};
use crate::vulkan::{Format, Usage};

/// The heaps, and each resource's place.
#[derive(Debug)]
pub(in crate::compile) struct PlacedResources {
    pub(in crate::compile) heaps: Vec<Heap>,
    /// For each physical resource its place, if it is transient.
    pub(in crate::compile) placements: Vec<Option<Placement>>,
    /// Bytes if each had memory of its own.
    pub(in crate::compile) transient_bytes: u64,
    /// Largest total alive at one step.
    pub(in crate::compile) live_peak_bytes: u64,
    /// Bytes of the resources that outlive the frame.
    pub(in crate::compile) kept_bytes: u64,
    /// The images whose format the pipeline chose, rising, with the bytes that it takes beyond the usual format.
    pub(in crate::compile) chosen: Vec<(PhysicalIndex, i64)>,
}

/// All transient resources that are used, in the order of the first steps of `spans`, then by index.
pub(in crate::compile) fn by_first_step(adapted: &AdaptedFrame, spans: &[[u32; 2]]) -> Vec<PhysicalIndex> {
    let mut order: Vec<PhysicalIndex> = Vec::with_capacity(spans.len());
    let (mut last, mut is_sorted) = (0, true);
    for (([first, _], resource), at) in spans.iter().zip(&adapted.resources).zip(0_u32..) {
        if *first != NEVER && resource.is_transient() {
            is_sorted &= std::mem::replace(&mut last, *first) <= *first;
            order.push(at);
        }
    }
    if is_sorted {
        return order;
    }
    let first = |resource: &PhysicalIndex| spans[*resource as usize][0];
    // For each step the resources that begin there, as linked lists.
    let mut heads = vec![NEVER; order.iter().map(first).max().map_or(0, |last| last as usize + 1)];
    let mut next = vec![NEVER; spans.len()];
    for resource in order.iter().rev() {
        next[*resource as usize] = std::mem::replace(&mut heads[first(resource) as usize], *resource);
    }
    order.clear();
    for head in heads {
        let mut resource = head;
        while resource != NEVER {
            order.push(resource);
            resource = next[resource as usize];
        }
    }
    order
}

/// The resources of a heap.
struct Members {
    /// Images don't share memory with buffers: they may need a distance (`bufferImageGranularity`).
    images: bool,
    count: usize,
    /// In the order of their first steps.
    blocks: Vec<Block>,
}

/// When resources are used.
#[derive(Debug, Clone, Copy)]
pub(in crate::compile) struct Times<'t> {
    /// For each physical resource the first and the last step that use it.
    pub(in crate::compile) lifetimes: &'t [[u32; 2]],
    /// How long each takes its memory, if steps of several queues run side by side.
    pub(in crate::compile) spans: Option<&'t [[u32; 2]]>,
    /// Transient resources, in the order of the first steps of spans.
    pub(in crate::compile) order: &'t [PhysicalIndex],
    /// For each step one more than the last step that its accesses wait for, if memory may be spent on fewer barrier calls.
    pub(in crate::compile) waits: Option<&'t [u32]>,
}

/// Finds a place for each transient resource.
pub(in crate::compile) fn place(
    adapted: &AdaptedFrame,
    Times { lifetimes, spans, order, waits }: Times<'_>,
    device: &Profile,
    memory: &mut dyn MemoryProvider,
    options: &Options,
) -> Result<PlacedResources, Vec<Diagnostic>> {
    let mut placed = PlacedResources {
        heaps: Vec::new(),
        placements: Vec::with_capacity(adapted.resources.len()),
        transient_bytes: 0,
        live_peak_bytes: 0,
        kept_bytes: 0,
        chosen: Vec::new(),
    };
    let mut members: Vec<Members> = Vec::new();
    let mut padding = 0_u64;
    let (overlaps, spans) = (spans.is_some(), spans.unwrap_or(lifetimes));
    // Images often follow others of the same descriptor.
    let mut last_needs: Option<(ImageDescriptor, MemoryNeeds)> = None;
    for ((resource, at), [first, last]) in adapted.resources.iter().zip(0..).zip(lifetimes) {
        if *first == NEVER && resource.is_transient() {
            placed.placements.push(None);
            continue;
        }
        let (needs, lazily) = match &resource.kind {
            Kind::Image(image) => {
                let made = adapted.made(at, image);
                let transient = image.usage.contains(Usage::TRANSIENT_ATTACHMENT);
                let needs = match last_needs {
                    Some((of, needs)) if of == made => needs,
                    _ => last_needs.insert((made, memory.image(&made))).1,
                };
                if let Some(usual) = resource.usual {
                    let usual = usual_needs(&made, usual, device, memory);
                    placed.chosen.push((at, needs.bytes.cast_signed().saturating_sub(usual.bytes.cast_signed())));
                }
                (needs, device.lazily_allocated_memory && transient)
            }
            Kind::Buffer(buffer) => (memory.buffer(buffer), false),
        };
        if !resource.is_transient() {
            placed.kept_bytes = placed.kept_bytes.saturating_add(needs.bytes);
            placed.placements.push(None);
            continue;
        }
        let heap = choose_heap(&mut placed.heaps, &mut members, &needs, lazily, resource.image().is_some());
        placed.transient_bytes = placed.transient_bytes.saturating_add(needs.bytes);
        padding = padding.saturating_add(needs.alignment);
        placed.placements.push(Some(Placement {
            heap: heap as u32,
            offset: 0,
            bytes: needs.bytes,
            alignment: needs.alignment,
            type_bits: needs.type_bits,
            lifetime: [StepId(*first), StepId(*last)],
        }));
    }
    // A packing begins with the live peak and grows by each block once at most. So its offsets and its height stay below twice this
    // sum, and none of them overflows.
    let most = placed.transient_bytes.saturating_add(padding).saturating_add(placed.kept_bytes);
    if most > i64::MAX as u64 {
        let message = "the frame's images and buffers take more memory than can be addressed".to_owned();
        return Err(vec![
            Diagnostic::new(Code::TOO_MUCH_MEMORY, Span::NONE, message).help("make them smaller or fewer"),
        ]);
    }
    members.iter_mut().for_each(|members| members.blocks.reserve_exact(members.count));
    let block = |placement: &Placement, [first, last]: [u32; 2]| {
        let Placement { bytes, alignment, .. } = *placement;
        Block { first, last, bytes, alignment }
    };
    for resource in order {
        if let Some(placement) = &placed.placements[*resource as usize] {
            members[placement.heap as usize].blocks.push(block(placement, spans[*resource as usize]));
        }
    }
    let measured: Vec<MeasuredBlocks<'_>> = members.iter().map(|members| MeasuredBlocks::of(&members.blocks)).collect();
    let alive = |resource: &PhysicalIndex| {
        let placement = placed.placements[*resource as usize].as_ref()?;
        Some(block(placement, lifetimes[*resource as usize]))
    };
    let apart = members.len() > 1 || overlaps;
    let all: Vec<Block> = if apart { order.iter().filter_map(alive).collect() } else { Vec::new() };
    let together = apart.then(|| MeasuredBlocks::of(&all));
    let together = together.as_ref().or(measured.last());
    placed.live_peak_bytes = together.map_or(0, MeasuredBlocks::live_peak);
    let packings = if options.alias {
        let waits = waits.filter(|_| !overlaps);
        waits
            .and_then(|waits| pack_by_intervals(waits, &members, together?))
            .unwrap_or_else(|| measured.iter().map(MeasuredBlocks::pack).collect())
    } else {
        members.iter().map(|members| side_by_side(&members.blocks)).collect()
    };
    let mut offsets = Vec::with_capacity(packings.len());
    for (heap, packing) in placed.heaps.iter_mut().zip(packings) {
        heap.bytes = packing.height;
        offsets.push(packing.offsets.into_iter());
    }
    for resource in order {
        if let Some(placement) = &mut placed.placements[*resource as usize] {
            placement.offset = offsets[placement.heap as usize].next().unwrap_or_default();
        }
    }
    Ok(placed)
}

/// Packings in which memory changes hands only where intervals between barrier calls begin; `None` if this saves no call, or
/// takes too much memory. `together`: the blocks of all heaps.
fn pack_by_intervals(waits: &[u32], members: &[Members], together: &MeasuredBlocks<'_>) -> Option<Vec<Packing>> {
    let intervals = Intervals::of(waits, &together.changes, together.live_peak())?;
    let pack = |members: &Members| MeasuredBlocks::of(&intervals.widen(&members.blocks)).pack();
    let packings: Vec<Packing> = members.iter().map(pack).collect();
    (packings.iter().map(|packing| packing.height).sum::<u64>() <= intervals.most_bytes).then_some(packings)
}

/// The memory needs of an image in the format `usual`: estimated if the device can't create it.
fn usual_needs(
    image: &ImageDescriptor,
    usual: Format,
    device: &Profile,
    memory: &mut dyn MemoryProvider,
) -> MemoryNeeds {
    let descriptor = ImageDescriptor { format: usual, ..*image };
    let support = device.format(usual);
    let made =
        support.is_some_and(|support| support.usage.contains(image.usage) && support.samples.contains(&image.samples));
    if made { memory.image(&descriptor) } else { device.memory.image(&descriptor) }
}

/// The first heap whose memory types fit, narrowed to those that both accept; else a new heap.
fn choose_heap(
    heaps: &mut Vec<Heap>,
    members: &mut Vec<Members>,
    needs: &MemoryNeeds,
    lazily: bool,
    images: bool,
) -> usize {
    let fits = |(heap, members): (&Heap, &Members)| {
        members.images == images && heap.lazily_allocated == lazily && heap.type_bits & needs.type_bits != 0
    };
    let at = heaps.iter().zip(members.iter()).position(fits).unwrap_or_else(|| {
        heaps.push(Heap { bytes: 0, alignment: 1, type_bits: needs.type_bits, lazily_allocated: lazily });
        members.push(Members { images, count: 0, blocks: Vec::new() });
        heaps.len() - 1
    });
    members[at].count += 1;
    heaps[at].type_bits &= needs.type_bits;
    heaps[at].alignment = heaps[at].alignment.max(needs.alignment);
    at
}

/// Memory of its own for each block.
fn side_by_side(blocks: &[Block]) -> Packing {
    let mut packing = Packing { offsets: Vec::with_capacity(blocks.len()), height: 0 };
    for block in blocks {
        let offset = packing.height.next_multiple_of(block.alignment.max(1));
        packing.offsets.push(offset);
        packing.height = offset + block.bytes;
    }
    packing
}
