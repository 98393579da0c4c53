//! Images: shape, layers, mip levels and samples go together.

use super::Property;
use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Image, SAMPLE_COUNTS, allocated_extent};
use crate::vulkan::{Encoding, Shape};

/// The declaration of an image.
pub(crate) trait Declaration {
    /// Where one of its properties is, and the cause of the property in words: "msaa = 4"; empty if it has none.
    fn at(&self, property: Property) -> (Span, &str);

    /// Whether a frame finds contents in it that the frame didn't write.
    fn is_kept(&self) -> bool;
}

/// A program declares an image in no file.
impl Declaration for Image {
    fn at(&self, _: Property) -> (Span, &str) {
        (self.span, "")
    }

    fn is_kept(&self) -> bool {
        self.lifetime.is_kept()
    }
}

/// What is wrong with an output that is to leave the frame in an encoding, if anything is: its format holds the encoding. `here`: where
/// the encoding is asked for.
pub(crate) fn wrong_encoding(
    image: &Image,
    encoding: Encoding,
    declared: &impl Declaration,
    here: Span,
) -> Option<Diagnostic> {
    let Image { name, format, .. } = image;
    let wrong = || {
        let message = format!("`{name}` can't leave the frame as `{}`: it is {format}", encoding.name());
        let wrong = Diagnostic::new(Code::ENCODING, here, message).label(declared.at(Property::Format).0, "its format");
        wrong.help(encoding.help(name))
    };
    (!encoding.fits(*format)).then(wrong)
}

/// Mip levels from the largest, which has at least one texel, down to a single texel.
pub(crate) const fn most_levels([width, height, depth]: [u32; 3]) -> u32 {
    (width | height | depth).ilog2() + 1
}

/// Reports what can't be together in an image.
pub(crate) fn check(image: &Image, declared: &impl Declaration, errors: &mut Vec<Diagnostic>) {
    let Image { shape, format, extent, allocated, layers, mips, samples, .. } = *image;
    let [width, height, depth] = extent;
    let wrong = |code: Code, at: Property, what: String| {
        let message = format!("`{}` {what}", image.name);
        let (span, because) = declared.at(at);
        Diagnostic::new(code, span, message).remark(because)
    };
    let with = |wrong: Diagnostic, beside: Property, remark: &str| wrong.label(declared.at(beside).0, remark);
    if extent.contains(&0) {
        let what = format!("is {width}×{height}×{depth}; each side has at least 1 texel");
        return errors.push(wrong(Code::SIZE_OUTSIDE, Property::Size, what));
    }
    // A part in use has as many levels as all of the image.
    let [width, height, depth] = allocated_extent(extent, allocated);
    if mips != 1 && !(1..=most_levels([width, height, depth])).contains(&mips) {
        let most = most_levels([width, height, depth]);
        let extent = if depth > 1 { format!("{width}×{height}×{depth}") } else { format!("{width}×{height}") };
        let what = format!("can't have {mips} mip levels: {extent} texels have {most}");
        errors.push(wrong(Code::MIP_LEVELS, Property::Mips, what).help("write `Full`: as many as there are"));
    }
    let [width, height, depth] = extent;
    if shape == Shape::Cube && width != height {
        let what = format!("is a cube, but its sides are {width}×{height}");
        errors.push(wrong(Code::SHAPE, Property::Size, what).help("the sides of a cube are square"));
    }
    if layers == 0 {
        errors.push(wrong(Code::SHAPE, Property::Layers, "has no layers".to_owned()));
    }
    if shape == Shape::Cube && !layers.is_multiple_of(6) {
        let what = format!("is a cube and can't have {layers} layers");
        errors.push(wrong(Code::SHAPE, Property::Layers, what).help("write `6`, or `12` for two cubes, and so on"));
    }
    if shape == Shape::D3 && layers > 1 {
        let what = format!("is three-dimensional and can't have {layers} layers");
        errors.push(with(wrong(Code::SHAPE, Property::Layers, what), Property::Shape, "its shape"));
    }
    if shape == Shape::D3 && format.is_depth() {
        let what = format!("is three-dimensional and can't hold depth ({format})");
        errors.push(with(wrong(Code::SHAPE, Property::Format, what), Property::Shape, "its shape"));
    }
    if shape != Shape::D3 && depth > 1 {
        errors.push(wrong(Code::SIZE_OUTSIDE, Property::Size, "has depth and is not three-dimensional".to_owned()));
    }
    if allocated.is_some_and(|[wide, high]| wide < width || high < height) {
        errors.push(wrong(
            Code::DYNAMIC_SIZE,
            Property::Size,
            format!("is {width}×{height}, and has no room for that"),
        ));
    }
    let bent = [(shape != Shape::D2, Property::Shape, "its shape"), (mips > 1, Property::Mips, "its mip levels")];
    if allocated.is_some() {
        let kept = (declared.is_kept(), Property::Lifetime, "its lifetime");
        if let Some((_, at, remark)) = [bent[0], kept].into_iter().find(|(hinders, ..)| *hinders) {
            let what = "changes its size, so it is two-dimensional, and transient or with history".to_owned();
            errors.push(with(wrong(Code::DYNAMIC_SIZE, Property::Size, what), at, remark));
        }
    }
    if !SAMPLE_COUNTS.contains(&samples) {
        errors.push(wrong(
            Code::SAMPLE_COUNT,
            Property::Samples,
            format!("has {samples} samples; 1, 2, 4, 8 or 16 are possible"),
        ));
    } else if samples > 1
        && let Some((_, at, remark)) = bent.into_iter().find(|(hinders, ..)| *hinders)
    {
        let what = format!("has {samples} samples, so it is two-dimensional and has one mip level");
        errors.push(with(wrong(Code::SAMPLE_COUNT, Property::Samples, what), at, remark));
    }
}
