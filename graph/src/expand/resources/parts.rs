//! Parts of images: the mip levels, layers and planes that a pass names, against those that there are.

use super::table::Resources;
use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Image, check};
use crate::language::{ImagePart, Selection};
use crate::ron::Spanned;
use crate::vulkan::{Aspects, Shape, Subresources};

/// The part that a pass names; all of the image if it names no more than the image, or after a mistake was reported.
pub(in crate::expand) fn range(
    resources: &Resources<'_>,
    part: &ImagePart,
    errors: &mut Vec<Diagnostic>,
) -> Subresources {
    let Some(image) = resources.image(part.image.index).map(|image| &image.image) else { return Subresources::WHOLE };
    let declared = resources.declared(part.image.index);
    let mips = selected(image, part.mips, image.mips, "mip level", declared.mips.span, errors);
    let layers = selected(image, part.layers, image.layers, "layer", declared.layers.span, errors);
    let aspects = match part.plane {
        Some(plane) if !image.format.aspects().contains(plane.value) => {
            let what = if plane.value == Aspects::DEPTH { "depth" } else { "stencil" };
            let message = format!("`{}` has no {what} plane ({})", image.name, image.format);
            errors.push(Diagnostic::new(Code::PLANE, plane.span, message).label(declared.format.span, "its format"));
            Aspects::empty()
        }
        Some(plane) => plane.value,
        None => Aspects::empty(),
    };
    let ((base_mip, mips), (base_layer, layers)) = (mips, layers);
    Subresources { aspects, base_mip, mips, base_layer, layers }
}

/// First and count of the selected ones of `all`.
fn selected(
    image: &Image,
    selection: Selection,
    all: u32,
    what: &str,
    declared: Span,
    errors: &mut Vec<Diagnostic>,
) -> (u32, u32) {
    let whole = (0, Subresources::REMAINING);
    let (first, span) = match (selection.first, selection.count) {
        (None, None) => return whole,
        (Some(first), _) => (first.value, first.span),
        (None, Some(count)) => (0, count.span),
    };
    let there = match (all, image.shape) {
        (1, Shape::D3) if what == "layer" => "it is three-dimensional and has one layer".to_owned(),
        (1, _) => format!("it has one {what}"),
        _ => format!("it has {all} {what}s, 0 to {}", all - 1),
    };
    let mut out_of_range = |span: Span, which: String| {
        let message = format!("`{}` has no {which}", image.name);
        errors.push(
            Diagnostic::new(Code::NO_SUCH_PART, span, message).remark(there.clone()).label(declared, "declared here"),
        );
        whole
    };
    if first >= all {
        return out_of_range(span, format!("{what} {first}"));
    }
    match selection.count.map(|count: Spanned<u32>| (count.value, count.span)) {
        None => (first, 1),
        Some((Subresources::REMAINING, _)) => (first, all - first),
        Some((count, span)) if count > all - first => {
            let last = u64::from(first) + u64::from(count) - 1;
            out_of_range(span, format!("{what} {last}"))
        }
        Some((count, _)) => (first, count),
    }
}

/// Reports a part of several mip levels of `image`, where one is needed.
pub(in crate::expand) fn several_levels(
    resources: &Resources<'_>,
    part: &ImagePart,
    image: &Image,
    what: &str,
) -> Diagnostic {
    check::transfers::several_levels(image, [place(part), resources.declared(part.image.index).mips.span], what)
}

/// Where the file names a part: the mip level or layer if it says one, else the image.
pub(in crate::expand) fn place(part: &ImagePart) -> Span {
    let number = part.mips.first.or(part.mips.count).or(part.layers.first).or(part.layers.count);
    number.map_or(part.image.span, |number| number.span)
}
