//! Whether a Plan's lists are well formed: images, heaps, outputs, barriers, sums.

use super::Findings;
use super::scopes::impossible;
use super::touches;
use super::violation::{Rule, Violation};
use crate::plan::names::vulkan;
use crate::plan::{
    Image, ImageBarrier, ImageId, Placement, Plan, Resource, Role, Step, StepId, Subresources, Totals, Work,
};
use crate::vocabulary::{Accesses, Layout, Stages, Usage};
use std::collections::HashSet;

/// Most steps that two walks can be numbered with.
const MOST_STEPS: usize = 1 << 30;

/// Reports what is malformed; whether the steps can be followed all the same.
pub(super) fn check(plan: &Plan, found: &mut Findings) -> bool {
    let before = found.violations.len();
    if plan.format_version != crate::plan::FORMAT_VERSION {
        found.structure(None, None, format!("format version {} is not known", plan.format_version));
    }
    if plan.steps.is_empty() {
        found.structure(None, None, "has no steps");
    }
    if plan.steps.len() > MOST_STEPS {
        found.structure(None, None, format!("{} steps are too many to number", plan.steps.len()));
    }
    let mut names = HashSet::new();
    for image in &plan.images {
        check_image(plan, image, found);
        if !names.insert(&*image.name) {
            found.structure(None, Some(image.id), "has the name of another image");
        }
    }
    check_ranges(plan, found);
    // Indices into images and sums of offsets rest on everything up to here.
    if found.violations.len() > before {
        return false;
    }
    check_outputs(plan, found);
    check_pass_names(plan, found);
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        check_barriers(plan, id, step, found);
    }
    check_totals(plan, found);
    true
}

fn check_image(plan: &Plan, image: &Image, found: &mut Findings) {
    let mut wrong = |what: &str| found.structure(None, Some(image.id), what);
    let largest = image.extent.into_iter().max().unwrap_or(0);
    if image.extent.contains(&0) || image.layers == 0 || image.mips == 0 {
        wrong("is empty");
    } else if image.mips > largest.ilog2() + 1 {
        wrong("has more mip levels than its size allows");
    }
    if !image.samples.is_power_of_two() || image.samples > 64 {
        wrong("has a sample count that is not 1, 2, 4, 8, 16, 32 or 64");
    }
    if image.samples > 1 && (image.mips > 1 || image.extent[2] > 1) {
        wrong("is multisampled and has mip levels or depth");
    }
    if Usage::from_bits(image.usage.bits()).is_none() {
        wrong("has a usage that is not known");
    }
    let attachment = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT | Usage::TRANSIENT_ATTACHMENT;
    if image.usage.contains(Usage::TRANSIENT_ATTACHMENT) && !attachment.contains(image.usage) {
        wrong("is a TRANSIENT_ATTACHMENT and more than an attachment");
    }
    match &image.role {
        Role::Transient(placement) => check_placement(plan, image, placement, found),
        Role::External { after, .. } | Role::Persistent { after, .. } if after.layout == Layout::Undefined => {
            wrong("is promised in layout UNDEFINED");
        }
        Role::External { .. } | Role::Persistent { .. } => {}
    }
}

fn check_placement(plan: &Plan, image: &Image, placement: &Placement, found: &mut Findings) {
    let heap = &plan.heaps[placement.heap as usize];
    let mut wrong = |what: String| {
        found.violations.push(Violation {
            rule: Rule::Structure { what },
            step: None,
            other: None,
            image: Some(image.name.clone()),
            range: None,
            bytes: Some([placement.offset, placement.offset.saturating_add(placement.bytes)]),
        });
    };
    if placement.bytes == 0 {
        wrong("takes no memory".to_owned());
    }
    if placement.offset.checked_add(placement.bytes).is_none_or(|end| end > heap.bytes) {
        wrong(format!("reaches beyond heap {}, which has {} bytes", placement.heap, heap.bytes));
    }
    if !placement.alignment.is_power_of_two() || !placement.offset.is_multiple_of(placement.alignment) {
        wrong(format!("its offset is not aligned to {} bytes", placement.alignment));
    }
    if placement.alignment > heap.alignment || !heap.alignment.is_power_of_two() {
        let [heap, image] = [heap.alignment, placement.alignment];
        wrong(format!("needs an alignment of {image} bytes in a heap aligned to {heap}"));
    }
    if heap.type_bits == 0 || heap.type_bits & !placement.type_bits != 0 {
        wrong(format!("accepts the memory types {:#b}, its heap may be of {:#b}", placement.type_bits, heap.type_bits));
    }
    if heap.lazily_allocated && !image.usage.contains(Usage::TRANSIENT_ATTACHMENT) {
        wrong("lies in lazily allocated memory and is not a TRANSIENT_ATTACHMENT".to_owned());
    }
    if placement.lifetime[0] > placement.lifetime[1] {
        wrong("its lifetime ends before it begins".to_owned());
    }
}

/// Whether every range that a step names lies within its image.
fn check_ranges(plan: &Plan, found: &mut Findings) {
    let mut touches = Vec::new();
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        touches::list(step, &mut touches);
        let touched = touches.iter().map(|touch| (touch.image, touch.range));
        let barriers = step.image_barriers.iter().map(|barrier| (barrier.image, barrier.range));
        let attachments = match &step.work {
            Work::Render(scope) => scope.color.iter().chain(&scope.depth).chain(&scope.stencil).collect(),
            _ => Vec::new(),
        };
        let attached = attachments.iter().map(|attachment| (attachment.image, attachment.range));
        for (image, range) in barriers.chain(attached).chain(touched) {
            if !fits(plan.image(image), range) {
                found.structure(Some(id), Some(image), format!("has no part {range}"));
            }
        }
    }
}

fn fits(image: &Image, range: Subresources) -> bool {
    let within = |base: u32, count: u32, all: u32| count > 0 && base.checked_add(count).is_some_and(|end| end <= all);
    !range.aspects.is_empty()
        && image.format.aspects().contains(range.aspects)
        && within(range.base_mip, range.mips, image.mips)
        && within(range.base_layer, range.layers, image.layers)
}

/// Whether two ranges of one image share anything.
pub(super) fn overlap(one: Subresources, other: Subresources) -> bool {
    let meet = |base: u32, count: u32, other_base: u32, other_count: u32| {
        base < other_base.saturating_add(other_count) && other_base < base.saturating_add(count)
    };
    one.aspects.intersects(other.aspects)
        && meet(one.base_mip, one.mips, other.base_mip, other.mips)
        && meet(one.base_layer, one.layers, other.base_layer, other.layers)
}

fn check_outputs(plan: &Plan, found: &mut Findings) {
    let mut listed = HashSet::new();
    for output in &plan.outputs {
        let Resource::Image(id) = *output else { continue };
        if matches!(plan.image(id).role, Role::Transient(_)) {
            found.structure(None, Some(id), "is listed as an output and is transient");
        }
        if !listed.insert(id) {
            found.structure(None, Some(id), "is listed as an output twice");
        }
    }
}

fn check_pass_names(plan: &Plan, found: &mut Findings) {
    let mut names = HashSet::new();
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        for pass in super::work::passes(&step.work) {
            if !names.insert(&*pass.name) {
                found.structure(Some(id), None, "a pass has the name of another pass");
            }
        }
    }
}

fn check_barriers(plan: &Plan, id: StepId, step: &Step, found: &mut Findings) {
    for barrier in &step.memory_barriers {
        for (stages, accesses) in
            [(barrier.src_stages, barrier.src_accesses), (barrier.dst_stages, barrier.dst_accesses)]
        {
            check_scope(id, None, stages, accesses, found);
        }
    }
    for barrier in &step.image_barriers {
        let image = Some(barrier.image);
        check_scope(id, image, barrier.src_stages, barrier.src_accesses, found);
        check_scope(id, image, barrier.dst_stages, barrier.dst_accesses, found);
        check_image_barrier(plan, id, barrier, found);
    }
    check_disjoint(id, &step.image_barriers, found);
}

fn check_image_barrier(plan: &Plan, id: StepId, barrier: &ImageBarrier, found: &mut Findings) {
    let image = plan.image(barrier.image);
    if barrier.new_layout == Layout::Undefined {
        found.structure(Some(id), Some(barrier.image), "a barrier can't make a layout UNDEFINED");
    }
    if !image.usage.contains(needed_usage(barrier.new_layout)) {
        let what = format!("a barrier brings it to {}, for which it has no usage", vulkan(&barrier.new_layout));
        found.structure(Some(id), Some(barrier.image), what);
    }
}

/// The usage without which a layout can't be had.
fn needed_usage(layout: Layout) -> Usage {
    match layout {
        Layout::ColorAttachmentOptimal => Usage::COLOR_ATTACHMENT,
        Layout::DepthStencilAttachmentOptimal
        | Layout::DepthStencilReadOnlyOptimal
        | Layout::DepthAttachmentOptimal
        | Layout::DepthReadOnlyOptimal
        | Layout::StencilAttachmentOptimal
        | Layout::StencilReadOnlyOptimal => Usage::DEPTH_STENCIL_ATTACHMENT,
        Layout::RenderingLocalReadKhr => Usage::INPUT_ATTACHMENT,
        Layout::ShaderReadOnlyOptimal => Usage::SAMPLED,
        Layout::TransferSrcOptimal => Usage::TRANSFER_SRC,
        Layout::TransferDstOptimal => Usage::TRANSFER_DST,
        Layout::Undefined | Layout::General | Layout::PresentSrcKhr => Usage::empty(),
    }
}

/// Barriers of one call aren't ordered, so no two may concern the same part.
fn check_disjoint(id: StepId, barriers: &[ImageBarrier], found: &mut Findings) {
    let mut sorted: Vec<&ImageBarrier> = barriers.iter().collect();
    sorted.sort_by_key(|barrier| barrier.image);
    for same in sorted.chunk_by(|one, other| one.image == other.image) {
        let mut pairs =
            same.iter().enumerate().flat_map(|(at, one)| same[at + 1..].iter().map(move |other| (one, other)));
        if pairs.any(|(one, other)| overlap(one.range, other.range)) {
            found.structure(Some(id), Some(same[0].image), "two barriers of one call concern the same part");
        }
    }
}

/// Whether flags are known, and each access belongs to one of the stages.
pub(super) fn check_scope(
    id: StepId,
    image: Option<ImageId>,
    stages: Stages,
    accesses: Accesses,
    found: &mut Findings,
) {
    let unknown = Stages::from_bits(stages.bits()).is_none() || Accesses::from_bits(accesses.bits()).is_none();
    if unknown {
        found.structure(Some(id), image, "names stages or accesses that are not known");
    }
    let impossible = impossible(stages, accesses);
    if !unknown && !impossible.is_empty() {
        let what = format!("{} doesn't happen in {}", vulkan(&impossible), vulkan(&stages));
        found.structure(Some(id), image, what);
    }
}

fn check_totals(plan: &Plan, found: &mut Findings) {
    let placements = || {
        plan.images.iter().filter_map(|image| match &image.role {
            Role::Transient(placement) => Some(placement),
            Role::External { .. } | Role::Persistent { .. } => None,
        })
    };
    let stated = plan.totals;
    let counted = Totals {
        transient_bytes: placements().map(|placement| placement.bytes).fold(0, u64::saturating_add),
        placed_bytes: plan.heaps.iter().map(|heap| heap.bytes).fold(0, u64::saturating_add),
        live_peak_bytes: live_peak(plan.steps.len(), placements()),
        // What an output takes is known only to whoever made it.
        kept_bytes: stated.kept_bytes,
        ..Totals::count(&plan.steps)
    };
    for ((field, stated), (_, counted)) in fields(&stated).into_iter().zip(fields(&counted)) {
        if stated != counted {
            let rule = Rule::Total { field, stated, counted };
            found.violations.push(Violation { rule, step: None, other: None, image: None, range: None, bytes: None });
        }
    }
}

fn fields(totals: &Totals) -> [(&'static str, u64); 14] {
    [
        ("passes", totals.passes.into()),
        ("inserted_passes", totals.inserted_passes.into()),
        ("scopes", totals.scopes.into()),
        ("resolves", totals.resolves.into()),
        ("folded_resolves", totals.folded_resolves.into()),
        ("copies", totals.copies.into()),
        ("fills", totals.fills.into()),
        ("waits", totals.waits.into()),
        ("barrier_calls", totals.barrier_calls.into()),
        ("image_barriers", totals.image_barriers.into()),
        ("memory_barriers", totals.memory_barriers.into()),
        ("transient_bytes", totals.transient_bytes),
        ("placed_bytes", totals.placed_bytes),
        ("live_peak_bytes", totals.live_peak_bytes),
    ]
}

/// The largest total of images alive at one step.
fn live_peak<'p>(steps: usize, placements: impl Iterator<Item = &'p Placement>) -> u64 {
    let mut begun = vec![0_u64; steps];
    let mut ended = vec![0_u64; steps];
    for placement in placements {
        let [first, last] = placement.lifetime.map(|step| step.0 as usize);
        begun[first] = begun[first].saturating_add(placement.bytes);
        ended[last] = ended[last].saturating_add(placement.bytes);
    }
    let mut live = 0_u64;
    let mut peak = 0;
    for (begun, ended) in begun.into_iter().zip(ended) {
        live = live.saturating_add(begun);
        peak = peak.max(live);
        live = live.saturating_sub(ended);
    }
    peak
}
