//! Parts of images and buffers, as passes name them: mip levels, layers, planes, earlier frames.

use super::values;
use crate::fields;
use crate::frame::{Eye, Resource};
use crate::language::model::{BufferPart, BufferRef, ImagePart, ImageRef, Part, Selection};
use crate::language::scope::Scope;
use crate::ron::{Described, Form, Leaf, Reader, Shape, Spanned, Table, Takes, Word, Words, names};
use crate::vulkan::{Aspects, Subresources};

/// An image or buffer can be read at most this many frames back.
pub(crate) const MOST_FRAMES: i64 = 64;

/// Larger numbers of mip levels and layers stand in no image.
const MOST_PARTS: i64 = 65535;

fields! {
    /// A part: some of an image, or a buffer.
    /// ```ron
    /// (image: "image", mip: 1, layer: 0, layers: Rest)
    /// ```
    struct PartFields<'src> {
        /// Which image.
        image: Option<Leaf<'src>> => EYE_IMAGE,
        /// Or which buffer.
        buffer: Option<Leaf<'src>> => WHOLE_BUFFER,
        /// The first mip level, from 0.
        mip: Option<Leaf<'src>> => FIRST,
        /// How many mip levels; one if `mip` stands alone, all if neither stands there.
        mips: Option<Leaf<'src>> => COUNT,
        /// The first layer, from 0.
        layer: Option<Leaf<'src>> => FIRST,
        /// How many layers; one if `layer` stands alone, all if neither stands there.
        layers: Option<Leaf<'src>> => COUNT,
        /// Depth or stencil; all that the image has if left out.
        plane: Option<Leaf<'src>> => PLANE,
        /// Of how many frames before this one; only of what has history, and only read.
        previous: Option<Leaf<'src>> => PREVIOUS,
    }
}

/// The name of an image.
pub(crate) const WHOLE_IMAGE: Form = Form::Reference("an image");

/// The name of a buffer.
pub(crate) const WHOLE_BUFFER: Form = Form::Reference("a buffer");

/// The name of an image or buffer.
pub(crate) const WHOLE_RESOURCE: Form = Form::Reference("an image or buffer");

/// The name of an image, or one eye's of it.
pub(crate) const EYE_IMAGE: Form = Form::Words(&EYES);

static EYES: Words = Words {
    name: "EyeImage",
    what: "an image",
    or: &[WHOLE_IMAGE],
    all: &[Word::new(
        "Eye",
        &[Takes::Values(&[EYE, WHOLE_IMAGE])],
        &["Eye(Left, \"image\")", "Eye(Right, \"image\")"],
        "That of one eye, of an image that each eye has of its own.",
    )],
};

const EYE: Form = Form::Choice("an eye", || names(&EYE_NAMES));

const EYE_NAMES: [(&str, Eye); 2] = [("Left", Eye::Left), ("Right", Eye::Right)];

/// An image or a part of it.
pub(crate) const IMAGE: Form = Form::Either(&[EYE_IMAGE, PART]);

/// A buffer, of this frame or an earlier one.
pub(crate) const BUFFER: Form = Form::Either(&[WHOLE_BUFFER, PART]);

/// An image, a part of one, or a buffer.
pub(crate) const ANY: Form = Form::Either(&[WHOLE_RESOURCE, EYE_IMAGE, PART]);

const PART: Form = Form::Fields(part);

/// The fields of a part.
pub(crate) fn part() -> Table {
    PartFields::table()
}

/// The first mip level or layer.
pub(crate) const FIRST: Form = Form::Whole(0, MOST_PARTS);

/// How many mip levels or layers.
pub(crate) const COUNT: Form = Form::Words(&COUNTS);

static COUNTS: Words = Words {
    name: "Count",
    what: "a number of mip levels or layers",
    or: &[Form::Whole(1, MOST_PARTS)],
    all: &[Word::alone("Rest", "All from the first on.")],
};

/// Depth or stencil.
pub(crate) const PLANE: Form = Form::Choice("a plane", || names(&PLANES));

/// How many frames to look back.
pub(crate) const PREVIOUS: Form = Form::Whole(1, MOST_FRAMES);

/// What is said about a part besides the image's name.
#[derive(Clone, Copy, Default)]
pub(crate) struct Selected<'src> {
    pub(crate) mip: Option<Leaf<'src>>,
    pub(crate) mips: Option<Leaf<'src>>,
    pub(crate) layer: Option<Leaf<'src>>,
    pub(crate) layers: Option<Leaf<'src>>,
    pub(crate) plane: Option<Leaf<'src>>,
    pub(crate) previous: Option<Leaf<'src>>,
}

const PLANES: [(&str, Aspects); 2] = [("Depth", Aspects::DEPTH), ("Stencil", Aspects::STENCIL)];

/// `"name"` or `(image: "name", mip: 1, …)` or `(buffer: "name", …)`.
pub(crate) fn any<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Part> {
    match leaf.shape() {
        Shape::Text => Some(match scope.resource(reader, leaf)?.resource {
            Resource::Image(index) => Part::Image(ImagePart::whole(ImageRef { index, span: leaf.span() })),
            Resource::Buffer(index) => Part::Buffer(whole_buffer(BufferRef { index, span: leaf.span() })),
        }),
        Shape::Word(..) => image_part(reader, scope, leaf, Selected::default()).map(Part::Image),
        Shape::Parentheses => {
            let fields: PartFields<'_> = reader.read(leaf, "a part of an image or buffer")?;
            let PartFields { image, buffer, mip, mips, layer, layers, plane, previous } = fields;
            let selected = Selected { mip, mips, layer, layers, plane, previous };
            one_of(reader, scope, leaf, image, buffer, selected)
        }
        _ => {
            reader
                .expected(leaf, "an image or buffer: `\"name\"`, `(image: \"name\", mip: 1)` or `(buffer: \"name\")`");
            None
        }
    }
}

/// All of a buffer.
pub(crate) const fn whole_buffer(buffer: BufferRef) -> BufferPart {
    BufferPart { buffer, previous: None }
}

/// The part of whichever of `image` and `buffer` is there.
pub(crate) fn one_of<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    whole: Leaf<'src>,
    image: Option<Leaf<'src>>,
    buffer: Option<Leaf<'src>>,
    selected: Selected<'src>,
) -> Option<Part> {
    match (image, buffer) {
        (Some(image), None) => image_part(reader, scope, image, selected).map(Part::Image),
        (None, Some(buffer)) => {
            let Selected { mip, mips, layer, layers, plane, previous } = selected;
            for foreign in [mip, mips, layer, layers, plane].into_iter().flatten() {
                reader.wrong(foreign, "a buffer has no mip levels, layers and planes", "");
            }
            buffer_part(reader, scope, buffer, previous).map(Part::Buffer)
        }
        (Some(_), Some(buffer)) => {
            reader.wrong(buffer, "an image and a buffer can't be named in one place", "");
            None
        }
        (None, None) => {
            reader.wrong(whole, "this names neither an image nor a buffer", "add `image: \"…\"` or `buffer: \"…\"`");
            None
        }
    }
}

/// `"name"` or `(image: "name", mip: 1, …)`.
pub(crate) fn image<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<ImagePart> {
    if let Shape::Parentheses = leaf.shape() {
        return match any(reader, scope, leaf)? {
            Part::Image(part) => Some(part),
            Part::Buffer(_) => {
                reader.wrong(leaf, "an image is needed here", "");
                None
            }
        };
    }
    image_part(reader, scope, leaf, Selected::default())
}

/// `"name"` or `(buffer: "name", previous: 1)`.
pub(crate) fn buffer<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<BufferPart> {
    if let Shape::Parentheses = leaf.shape() {
        return match any(reader, scope, leaf)? {
            Part::Buffer(part) => Some(part),
            Part::Image(_) => {
                reader.wrong(leaf, "a buffer is needed here", "");
                None
            }
        };
    }
    buffer_part(reader, scope, leaf, None)
}

fn buffer_part<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    buffer: Leaf<'src>,
    previous: Option<Leaf<'src>>,
) -> Option<BufferPart> {
    let buffer = scope.buffer(reader, buffer);
    let previous = frames(reader, scope, previous);
    Some(BufferPart { buffer: buffer?, previous: previous? })
}

/// The part of the image that `name` names.
pub(crate) fn image_part<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    name: Leaf<'src>,
    selected: Selected<'src>,
) -> Option<ImagePart> {
    let image = match name.shape() {
        Shape::Word(..) => one_eyes(reader, scope, name),
        _ => scope.image(reader, name).map(|image| (image, None)),
    };
    let mips = selection(reader, scope, selected.mip, selected.mips, "mip level", "number of mip levels");
    let layers = selection(reader, scope, selected.layer, selected.layers, "layer", "number of layers");
    let plane = match selected.plane {
        Some(plane) => values::choice(reader, plane, "a plane", &PLANES).map(|value| Some(plane.spanned(value))),
        None => Some(None),
    };
    let previous = frames(reader, scope, selected.previous);
    let (image, eye) = image?;
    Some(ImagePart { image, mips: mips?, layers: layers?, plane: plane?, previous: previous?, eye })
}

/// `Eye(Left, "name")`.
fn one_eyes<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
) -> Option<(ImageRef, Option<Spanned<Eye>>)> {
    let (_, rest) = reader.one_of(leaf, &EYES)?;
    let [eye, name]: [Leaf<'_>; 2] = reader.inside(leaf, rest, "Eye(Left, \"image\")")?;
    let image = scope.image(reader, name);
    let chosen = values::choice(reader, eye, "an eye", &EYE_NAMES)?;
    Some((image?, Some(eye.spanned(chosen))))
}

fn frames<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Option<Leaf<'src>>,
) -> Option<Option<crate::ron::Spanned<u32>>> {
    let Some(leaf) = leaf else { return Some(None) };
    let frames = values::whole(reader, scope, leaf, "number of frames to look back", 1..=MOST_FRAMES)?;
    Some(Some(leaf.spanned(frames)))
}

fn selection<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    first: Option<Leaf<'src>>,
    count: Option<Leaf<'src>>,
    one: &str,
    several: &str,
) -> Option<Selection> {
    let first = first.map(|leaf| (leaf, values::whole(reader, scope, leaf, one, 0..=MOST_PARTS)));
    let count = match count {
        Some(leaf) if matches!(leaf.shape(), Shape::Word("Rest", None)) => Some((leaf, Some(Subresources::REMAINING))),
        Some(leaf) if matches!(leaf.shape(), Shape::Number | Shape::Text) => {
            Some((leaf, values::whole(reader, scope, leaf, several, 1..=MOST_PARTS)))
        }
        Some(leaf) => {
            reader.expected(leaf, "a whole number, an expression in quotes or `Rest`");
            return None;
        }
        None => None,
    };
    let spanned = |part: Option<(Leaf<'src>, Option<u32>)>| match part {
        Some((leaf, value)) => value.map(|value| Some(leaf.spanned(value))),
        None => Some(None),
    };
    Some(Selection { first: spanned(first)?, count: spanned(count)? })
}

/// `("image")`, what stands behind `Like`.
pub(crate) fn like<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    rest: Option<Leaf<'src>>,
) -> Option<ImageRef> {
    let [image]: [Leaf<'_>; 1] = reader.inside(leaf, rest, "Like(\"image\")")?;
    scope.image(reader, image)
}
