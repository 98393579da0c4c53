//! Whether a Plan's lists are well formed: images, buffers, heaps, outputs.

use super::findings::{Findings, name, role};
use super::frames::{self, Frames};
use super::layouts;
use super::names::Names;
use super::part_in_use::{self, made_extent};
use super::violation::{Rule, Violation};
use crate::frame::format_problem;
use crate::plan::names::ShownText;
use crate::plan::{Buffer, ChosenFormat, FirstContents, Image, Placement, Plan, Resource, Role};
use crate::vulkan::{Accesses, Aspects, BufferUsage, FillValue, Format, Layout, Numeric, Shape, Stages, State, Usage};
use std::collections::HashSet;

/// Most steps that all frames together can be numbered with.
const MOST_STEPS: usize = 1 << 26;

/// Reports malformed parts of the Plan; returns how the steps can be followed all the same, `None` if they can't.
pub(super) fn check(plan: &Plan, found: &mut Findings) -> Option<Frames> {
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
    for view in plan.views.iter().filter(|view| view.jitter.as_ref().is_some_and(|jitter| !jitter.is_sound())) {
        let name = ShownText(&view.name);
        found.structure(
            None,
            None,
            format!("view `{name}` is shifted by no texel, never, or by more than half of one"),
        );
    }
    for (view, eye) in plan.views.iter().filter_map(|view| Some((view, view.eye?))) {
        let of = plan.views.get(eye.of.0 as usize);
        if of.is_none_or(|of| of.eye.is_some()) {
            let name = ShownText(&view.name);
            found.structure(None, None, format!("view `{name}` is an eye of no view, or of another eye's"));
        }
    }
    let buffers = plan.images.len() as u32;
    let mut names = Names::new(plan.images.len() + plan.buffers.len());
    for (image, index) in plan.images.iter().zip(0..) {
        check_image(plan, image, found);
        if !names.insert(&image.name) {
            found.structure(None, Some(index), "has the name of another image");
        }
    }
    for (buffer, index) in plan.buffers.iter().zip(buffers..) {
        check_buffer(plan, buffer, index, found);
        if !names.insert(&buffer.name) {
            found.structure(None, Some(index), "has the name of another image or buffer");
        }
    }
    check_heaps(plan, found);
    let frames = frames::circles(plan, found)?;
    // Indices into images and sums of offsets rest on everything up to here.
    if found.violations.len() > before {
        return None;
    }
    check_outputs(plan, found);
    Some(frames)
}

fn check_image(plan: &Plan, image: &Image, found: &mut Findings) {
    let mut wrong = |what: &str| found.structure(None, Some(image.id.0), what);
    let largest = made_extent(image, 0).into_iter().max().unwrap_or(0);
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
    let fits = match image.shape {
        Shape::D2 => image.extent[2] <= 1,
        Shape::D3 => image.layers <= 1,
        Shape::Cube => image.layers.is_multiple_of(6) && image.extent[0] == image.extent[1] && image.extent[2] <= 1,
    };
    if !fits || image.shape == Shape::Cube && image.samples > 1 {
        wrong("has a size, layers or samples that its shape can't have");
    }
    if let Some(allocated) = image.allocated {
        part_in_use::check(image, allocated, found);
    }
    let mut wrong = |what: &str| found.structure(None, Some(image.id.0), what);
    if Usage::from_bits(image.usage.bits()).is_none() {
        wrong("has a usage that is not known");
    }
    let attachment = Usage::COLOR_ATTACHMENT
        | Usage::DEPTH_STENCIL_ATTACHMENT
        | Usage::TRANSIENT_ATTACHMENT
        | Usage::INPUT_ATTACHMENT;
    let outlives = !matches!(image.role, Role::Transient(_));
    if image.usage.contains(Usage::TRANSIENT_ATTACHMENT) && (outlives || !attachment.contains(image.usage)) {
        wrong("is a TRANSIENT_ATTACHMENT and more than an attachment, or outlives the frame");
    }
    if image.format.is_compressed() && !may_be_compressed(plan, image) {
        wrong("is compressed, and more than sampled, or filled by the frame");
    }
    if let Some(ChosenFormat { usual, .. }) = &image.chosen
        && (*usual == image.format || usual.aspects() != image.format.aspects())
    {
        wrong("is in a format that can't have been chosen in place of its usual one");
    }
    match &image.role {
        Role::Transient(placement) => {
            let lazy = image.usage.contains(Usage::TRANSIENT_ATTACHMENT);
            check_placement(plan, image.id.0, placement, lazy, found);
        }
        Role::External { before, after, .. } => check_image_states(image, [before, after], found),
        Role::Persistent { before, after, initial, .. } => {
            let fits = match initial {
                FirstContents::Value(value) => fill_fits(image, value),
                FirstContents::File(file) => format_problem(file, image.format).is_none(),
            };
            if !fits {
                wrong("has initial contents of another kind than its format");
            }
            if is_of_file(image) && !may_be_of_file(image) {
                wrong("comes from a file and has samples, layers or uses that such an image can't have");
            }
            check_image_states(image, [before, after], found);
        }
    }
}

/// Whether an image's contents are a file's.
pub(super) fn is_of_file(image: &Image) -> bool {
    matches!(image.role, Role::Persistent { initial: FirstContents::File(_), .. })
}

/// Whether an image's contents are those of a texture file, which holds all of its levels and layers.
fn is_stored(image: &Image) -> bool {
    matches!(&image.role, Role::Persistent { initial: FirstContents::File(file), .. } if file.stored)
}

/// Whether an image in a compressed format is one that something outside of the frame fills, and that is only sampled.
fn may_be_compressed(plan: &Plan, image: &Image) -> bool {
    let read = Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let is_output = plan.outputs.iter().any(|output| output.resource == Resource::Image(image.id));
    let from_outside = matches!(image.role, Role::External { .. }) && !is_output || is_stored(image);
    from_outside && read.contains(image.usage) && image.samples == 1
}

/// Whether an image has the form of one that a file fills, and is only read.
fn may_be_of_file(image: &Image) -> bool {
    let read = Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let stays = matches!(image.role, Role::Persistent { becomes, .. } if becomes == image.id.0);
    let flat = image.layers == 1 && image.shape != Shape::Cube;
    read.contains(image.usage) && image.samples == 1 && (flat || is_stored(image)) && stays
}

/// Whether an image of this format can be set to a value.
pub(super) fn fill_fits(image: &Image, value: &FillValue) -> bool {
    match value {
        FillValue::Color(color) => {
            !image.format.is_depth() && !image.format.is_integer() && color.iter().all(|value| value.is_finite())
        }
        FillValue::Bits(bits) => {
            let number = |bits: u32| match image.format.numeric() {
                Numeric::Sint => i64::from(bits.cast_signed()),
                _ => i64::from(bits),
            };
            let count = image.format.components() as usize;
            image.format.is_integer() && bits.iter().take(count).all(|bits| is_component(image.format, number(*bits)))
        }
        FillValue::Depth(depth, _) => image.format.is_depth() && (0.0..=1.0).contains(depth),
    }
}

/// Whether a plane of this format can be cleared to a value.
pub(super) fn clear_fits(format: Format, plane: Aspects, clear: [f64; 4]) -> bool {
    let whole = |number: f64| number.fract() == 0.0 && number.abs() <= 4_294_967_295.0;
    #[allow(clippy::cast_possible_truncation, reason = "whole, and of 33 bits at most")]
    let component = |number: f64| whole(number) && is_component(format, number as i64);
    let finite = clear.iter().all(|number| number.is_finite());
    finite
        && match plane {
            Aspects::COLOR if format.is_integer() => {
                clear.iter().take(format.components() as usize).all(|number| component(*number))
            }
            Aspects::DEPTH => (0.0..=1.0).contains(&clear[0]),
            Aspects::STENCIL => whole(clear[0]) && (0.0..=255.0).contains(&clear[0]),
            _ => clear.iter().all(|number| number.abs() <= f64::from(f32::MAX)),
        }
}

/// Whether a component of an integer format can be this number.
fn is_component(format: Format, number: i64) -> bool {
    let bits = format.texel_bytes() * 8 / u64::from(format.components());
    match format.numeric() {
        Numeric::Sint => (-(1_i64 << (bits - 1))..1_i64 << (bits - 1)).contains(&number),
        _ => (0..1_i64 << bits).contains(&number),
    }
}

fn check_buffer(plan: &Plan, buffer: &Buffer, index: u32, found: &mut Findings) {
    let mut wrong = |what: &str| found.structure(None, Some(index), what);
    if buffer.bytes == 0 {
        wrong("is empty");
    }
    if BufferUsage::from_bits(buffer.usage.bits()).is_none() {
        wrong("has a usage that is not known");
    }
    match &buffer.role {
        Role::Transient(placement) => {
            if placement.bytes < buffer.bytes {
                wrong("takes less memory than it has bytes");
            }
            check_placement(plan, index, placement, false, found);
        }
        Role::External { before, after, .. } => check_buffer_states(index, [before, after], found),
        Role::Persistent { before, after, initial, .. } => {
            if !matches!(initial, FirstContents::Value(FillValue::Bits(_))) {
                wrong("has initial contents that are no bits");
            }
            check_buffer_states(index, [before, after], found);
        }
    }
}

fn check_image_states(image: &Image, states: [&State; 2], found: &mut Findings) {
    if states[1].layout == Layout::Undefined {
        found.structure(None, Some(image.id.0), "is promised in layout UNDEFINED");
    }
    for state in states {
        if let Some(problem) = layouts::problem(image, image.format.aspects(), state.layout) {
            found.structure(None, Some(image.id.0), format!("comes or goes in {problem}"));
        }
    }
    check_states(image.id.0, states, found);
}

fn check_buffer_states(resource: u32, states: [&State; 2], found: &mut Findings) {
    if states.iter().any(|state| state.layout != Layout::Undefined) {
        found.structure(None, Some(resource), "is a buffer and has a layout");
    }
    check_states(resource, states, found);
}

fn check_states(resource: u32, states: [&State; 2], found: &mut Findings) {
    for state in states {
        let known =
            Stages::from_bits(state.stages.bits()).is_some() && Accesses::from_bits(state.accesses.bits()).is_some();
        if !known || !super::scopes::impossible(state.stages, state.accesses).is_empty() {
            found.structure(None, Some(resource), "has a state of stages and accesses that don't go together");
        }
    }
}

fn check_placement(plan: &Plan, resource: u32, placement: &Placement, lazy: bool, found: &mut Findings) {
    let heap = &plan.heaps[placement.heap as usize];
    let mut wrong = |what: String| {
        found.violations.push(Violation {
            rule: Rule::Structure { what },
            step: None,
            other: None,
            resource: Some(name(plan, resource).clone()),
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
        let [heap, own] = [heap.alignment, placement.alignment];
        wrong(format!("needs an alignment of {own} bytes in a heap aligned to {heap}"));
    }
    if heap.type_bits == 0 || heap.type_bits & !placement.type_bits != 0 {
        wrong(format!("accepts the memory types {:#b}, its heap may be of {:#b}", placement.type_bits, heap.type_bits));
    }
    if heap.lazily_allocated && !lazy {
        wrong("lies in lazily allocated memory and is not a TRANSIENT_ATTACHMENT".to_owned());
    }
    if placement.lifetime[0] > placement.lifetime[1] {
        wrong("its lifetime ends before it begins".to_owned());
    }
}

/// Images and buffers side by side in one block would have to keep a distance that no placement states.
fn check_heaps(plan: &Plan, found: &mut Findings) {
    let mut holds_images = vec![false; plan.heaps.len()];
    for image in &plan.images {
        if let Role::Transient(placement) = &image.role {
            holds_images[placement.heap as usize] = true;
        }
    }
    for (buffer, index) in plan.buffers.iter().zip(plan.images.len() as u32..) {
        if let Role::Transient(placement) = &buffer.role
            && holds_images[placement.heap as usize]
        {
            found.structure(None, Some(index), format!("lies in heap {} among images", placement.heap));
        }
    }
}

fn check_outputs(plan: &Plan, found: &mut Findings) {
    let mut listed = HashSet::new();
    let mut names = Names::new(plan.outputs.len());
    for output in &plan.outputs {
        let resource = match output.resource {
            Resource::Image(image) => image.0,
            Resource::Buffer(buffer) => plan.images.len() as u32 + buffer.0,
        };
        if matches!(role(plan, resource), Role::Transient(_)) {
            found.structure(None, Some(resource), "is listed as an output and is transient");
        }
        if !listed.insert(resource) {
            found.structure(None, Some(resource), "is listed as an output twice");
        }
        if !names.insert(&output.name) {
            found.structure(None, Some(resource), "is an output with the name of another one");
        }
        if let Some(encoding) = output.encoding {
            let format = plan.images.get(resource as usize).map(|image| image.format);
            if !format.is_some_and(|format| encoding.fits(format)) {
                let what = format!("can't be encoded as {}: that takes {}", encoding.name(), encoding.formats());
                found.structure(None, Some(resource), what);
            }
        }
    }
}
