//! The targets of a pass: each can be drawn into, and they have one size, one sample count and as many layers.

use super::Property;
use super::images::Declaration;
use super::transfers::several_levels;
use crate::base::{Code, Diagnostic, Span};
use crate::frame::Image;
use crate::vulkan::{Shape, Subresources};

/// A part of an image that a pass draws into.
pub(crate) struct Target<'t> {
    pub(crate) image: &'t Image,
    pub(crate) range: Subresources,
    /// Where the pass names it.
    pub(crate) span: Span,
    /// The cause of its sample count in words: "msaa = 4".
    pub(crate) samples_because: Option<&'t str>,
}

/// Reports targets of the pass `name` that differ from its first one.
#[inline]
pub(crate) fn agree<'t>(name: &str, targets: impl IntoIterator<Item = Target<'t>>, errors: &mut Vec<Diagnostic>) {
    let mut targets = targets.into_iter();
    let Some(first) = targets.next() else { return };
    let shape = first.image.target_shape(first.range);
    for other in targets {
        if other.image.target_shape(other.range) != shape {
            differ(name, &first, &other, errors);
        }
    }
}

#[cold]
fn differ(name: &str, first: &Target<'_>, other: &Target<'_>, errors: &mut Vec<Diagnostic>) {
    let (one, another) = (first.image, other.image);
    let [shape, other_shape] = [first, other].map(|target| target.image.target_shape(target.range));
    let wrong = |what: &str| {
        let message = format!("pass `{name}` draws into {what}: `{}` and `{}`", one.name, another.name);
        Diagnostic::new(Code::TARGETS_DIFFER, other.span, message)
    };
    if (shape.extent, shape.allocated) != (other_shape.extent, other_shape.allocated) {
        let wrong = wrong("images of different sizes").remark(size_words(other_shape.extent, another));
        let wrong = wrong.label(first.span, size_words(shape.extent, one));
        let whole = (one.extent, one.allocated) != (another.extent, another.allocated);
        let help = format!("let one follow the other: say `size: Like(\"{}\")` of `{}`", one.name, another.name);
        errors.push(if whole { wrong.help(help) } else { wrong.help("draw into the same mip level of both") });
    }
    if shape.samples != other_shape.samples {
        let words = |target: &Target<'_>| samples_words(target.image.samples, target.samples_because);
        let wrong = wrong("images with different sample counts").remark(words(other)).label(first.span, words(first));
        let help = format!("let one follow the other: say `samples: Like(\"{}\")` of `{}`", one.name, another.name);
        errors.push(wrong.help(help));
    }
    if shape.layers != other_shape.layers {
        let layers = |count: u32| if count == 1 { "1 layer".to_owned() } else { format!("{count} layers") };
        let wrong = wrong("different numbers of layers").remark(layers(other_shape.layers));
        errors.push(wrong.label(first.span, layers(shape.layers)));
    }
    if shape.eyes != other_shape.eyes {
        errors.push(wrong("images that hold eyes' parts in different ways").label(first.span, ""));
    }
}

/// What is wrong with drawing into a part of an image, if anything is: it is one mip level of an image that isn't deep. The pass names
/// the image and the part `at` these places.
#[inline]
pub(crate) fn undrawable(
    image: &Image,
    range: Subresources,
    declared: &impl Declaration,
    [here, part]: [Span; 2],
) -> Option<Diagnostic> {
    if image.shape == Shape::D3 {
        let message = format!("`{}` is three-dimensional and can't be drawn into", image.name);
        let wrong =
            Diagnostic::new(Code::TARGET_UNFIT, here, message).label(declared.at(Property::Shape).0, "its shape");
        return Some(wrong.help("let a dispatch store into it"));
    }
    let several = image.part(range).mips > 1;
    several.then(|| several_levels(image, [part, declared.at(Property::Mips).0], "is drawn into"))
}

/// What is wrong with an image that a stand-in forwards or that it forwards to, if anything is: it is flat and has one mip level. `here`:
/// where the stand-in names it.
#[inline]
pub(crate) fn not_forwarded(image: &Image, declared: &impl Declaration, here: Span) -> Option<Diagnostic> {
    let (property, what) = match image {
        Image { shape: Shape::D3, .. } => (Property::Shape, "is three-dimensional".to_owned()),
        Image { mips: 1, .. } => return None,
        Image { mips, .. } => (Property::Mips, format!("has {mips} mip levels")),
    };
    let message = format!("`{}` {what}: a stand-in forwards between flat images with one mip level", image.name);
    let wrong = Diagnostic::new(Code::STAND_IN_UNFIT, here, message).label(declared.at(property).0, "declared here");
    Some(wrong.help("let another pass, whose `when` is the opposite, write what the pass would have written"))
}

/// What is wrong with a depth target, if anything is: its image has no depth.
#[inline]
pub(crate) fn without_depth(image: &Image, declared: &impl Declaration, here: Span) -> Option<Diagnostic> {
    let wrong = || {
        let message = format!("`{}` has no depth ({})", image.name, image.format);
        Diagnostic::new(Code::TARGET_UNFIT, here, message).label(declared.at(Property::Format).0, "its format")
    };
    (!image.format.is_depth()).then(wrong)
}

/// How large an image is, or a mip level of it: "640×360", "640×360 of up to 1280×720".
pub(crate) fn size_words([width, height, _]: [u32; 3], image: &Image) -> String {
    match image.allocated {
        Some([wide, high]) => format!("{width}×{height} of up to {wide}×{high}"),
        None => format!("{width}×{height}"),
    }
}

/// How many samples, and why: "4 samples (msaa = 4)".
pub(crate) fn samples_words(samples: u32, because: Option<&str>) -> String {
    let count = if samples == 1 { "1 sample".to_owned() } else { format!("{samples} samples") };
    match because {
        Some(because) => format!("{count} ({because})"),
        None => count,
    }
}
