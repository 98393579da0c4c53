//! Single things in words.

pub(super) use crate::base::amount::bytes;

use crate::base::Place;
use crate::base::amount::largest;
use crate::frame::DrawList;
use crate::plan::names::ShownText;
use crate::plan::{Binding, BindingKind, Cause, Fill, Hazard, ImageId, MovedBytes, Plan, Side, Step, StepId};
use crate::vulkan::{AddressMode, Aspects, FillValue, Filter, Format, Numeric, Sampler, name_of};
use std::collections::BTreeMap;

/// The hazard of a barrier in words: the user, its work, and the step before.
pub(super) fn hazard(who: &str, hazard: Hazard, after: Option<StepId>) -> String {
    let after = after.map_or("the frame before".to_owned(), |StepId(step)| format!("step {step}"));
    match hazard {
        Hazard::FirstUse => format!("first use, after {after}"),
        Hazard::ReadAfterWrite => format!("{who} reads what {after} wrote"),
        Hazard::WriteAfterRead => format!("{who} writes what {after} read"),
        Hazard::WriteAfterWrite => format!("{who} writes what {after} wrote"),
        Hazard::LayoutChange => format!("{who} reads what {after} read in another way"),
        Hazard::Export => format!("promised state, after {after}"),
        Hazard::Ownership => format!("another queue takes it over after {after}"),
    }
}

/// The change that would make a barrier needless.
pub(super) fn needless_if(hazard: Hazard) -> &'static str {
    match hazard {
        Hazard::FirstUse => "goes with the image: each needs one before its first use in a frame",
        Hazard::ReadAfterWrite => "goes if the reader reads something else, or its own pixel in the writer's scope",
        Hazard::WriteAfterRead | Hazard::WriteAfterWrite => "goes if the write goes to an image or buffer of its own",
        Hazard::LayoutChange => "goes if all readers read it in the same way",
        Hazard::Export => "goes if the state that the last use leaves it in is the promised one",
        Hazard::Ownership => "goes if both steps run on one queue",
    }
}

pub(super) fn words_of_list(list: DrawList) -> &'static str {
    match list {
        DrawList::Opaque => "opaque",
        DrawList::Masked => "masked",
        DrawList::Transparent => "transparent",
    }
}

/// A sampler in words, without its usual values.
fn words_of(sampler: &Sampler) -> String {
    let mut words = name_of(&sampler.filter);
    if sampler.mips == Filter::Linear {
        words += ", between mip levels too";
    }
    if sampler.address != AddressMode::default() {
        words += &format!(", {}", name_of(&sampler.address));
    }
    if let Some(compare) = &sampler.compare {
        words += &format!(", compared by {}", name_of(compare));
    }
    if let Some(border) = &sampler.border {
        words += &format!(", border {}", name_of(border));
    }
    if sampler.reduces() {
        words += &format!(", reduced to {}", name_of(&sampler.reduction));
    }
    if sampler.anisotropy > 1 {
        words += &format!(", anisotropy {}", sampler.anisotropy);
    }
    if !sampler.lod_bias.is_zero() {
        words += &format!(", level bias {}", f32::from(sampler.lod_bias));
    }
    match (f32::from(sampler.min_lod), sampler.max_lod.map(f32::from)) {
        (least, Some(greatest)) => words += &format!(", levels {least} to {greatest}"),
        (least, None) if least > 0.0 => words += &format!(", levels from {least} on"),
        (_, None) => {}
    }
    words
}

/// How an image is bound.
pub(crate) fn bound(binding: &Binding) -> String {
    match binding.kind {
        BindingKind::Sampled(sampler) => {
            let declared = binding.texture.map_or_else(String::new, |texture| format!(" as {texture}"));
            format!("sampled{declared}, {}", words_of(&sampler))
        }
        BindingKind::Storage => "storage".to_owned(),
        BindingKind::InputAttachment => "read at its own position".to_owned(),
    }
}

/// The value of a fill, as the planes that it fills hold it.
pub(crate) fn fill_value(plan: &Plan, Fill { value, target, .. }: &Fill) -> String {
    match target {
        Side::Image { image, range, .. } => held(value, Some((plan.image(*image).format, range.aspects))),
        Side::Buffer { .. } => held(value, None),
    }
}

/// A value of planes of a format, or (`None`) of a buffer.
pub(super) fn held(value: &FillValue, by: Option<(Format, Aspects)>) -> String {
    let planes = by.map_or(Aspects::COLOR, |(_, planes)| planes);
    let signed = by.is_some_and(|(format, _)| format.numeric() == Numeric::Sint);
    match value {
        FillValue::Color([red, green, blue, alpha]) => format!("({red}, {green}, {blue}, {alpha})"),
        FillValue::Bits(bits) if signed => {
            let [red, green, blue, alpha] = bits.map(u32::cast_signed);
            format!("({red}, {green}, {blue}, {alpha})")
        }
        FillValue::Bits([red, green, blue, alpha]) => format!("({red}, {green}, {blue}, {alpha})"),
        FillValue::Depth(_, stencil) if planes == Aspects::STENCIL => format!("stencil {stencil}"),
        FillValue::Depth(depth, _) if planes == Aspects::DEPTH => format!("depth {depth}"),
        FillValue::Depth(depth, stencil) => format!("depth {depth}, stencil {stencil}"),
    }
}

pub(super) fn count(number: u32, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

pub(super) fn samples(samples: u32) -> String {
    count(samples, "sample", "samples")
}

/// The bytes that are moved, if there are any.
pub(super) fn moved(moved: MovedBytes) -> Option<String> {
    let MovedBytes { loaded, stored, resolved, copied } = moved;
    let shares = [("loaded", loaded), ("stored", stored), ("resolved", resolved), ("copied", copied)];
    let shares = shares.iter().filter(|(_, amount)| *amount > 0);
    let shares: Vec<String> = shares.map(|(word, amount)| format!("{} {word}", bytes(*amount))).collect();
    (!shares.is_empty()).then(|| format!("moves {}", shares.join(", ")))
}

/// The images that stay on the chip in some of a Plan's steps, if there are any.
pub(super) fn on_chip(plan: &Plan, steps: &[Step]) -> Option<String> {
    let mut images: BTreeMap<ImageId, u64> = BTreeMap::new();
    for (image, amount) in steps.iter().flat_map(|step| plan.on_chip_of_each(step)) {
        let sum = images.entry(image).or_default();
        *sum = sum.saturating_add(amount);
    }
    let sum = images.values().copied().fold(0, u64::saturating_add);
    let names = images.iter().map(|(image, amount)| (ShownText(&plan.image(*image).name).to_string(), *amount));
    let names: Vec<(String, u64)> = names.collect();
    let largest = largest(names.iter().map(|(name, amount)| (&**name, *amount)).collect());
    (!images.is_empty()).then(|| format!("keeps {} on the chip, neither loaded nor stored: {largest}", bytes(sum)))
}

/// Width × height, and depth if there is any.
pub(crate) fn size([width, height, depth]: [u32; 3]) -> String {
    if depth == 1 { format!("{width}×{height}") } else { format!("{width}×{height}×{depth}") }
}

/// Where something was written, or why it was inserted.
pub(super) fn cause(cause: &Cause) -> String {
    match cause {
        Cause::Written(at) => place(at),
        Cause::Inserted(why) => format!(": {}{}", ShownText(&why.because), place(&why.at)),
    }
}

pub(super) fn place(at: &Option<Place>) -> String {
    at.as_ref().map_or_else(String::new, |place| format!(" ({}:{})", ShownText(&place.file), place.line))
}
