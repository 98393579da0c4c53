//! Parts of images and buffers, as passes name them: mip levels, layers, planes, earlier frames.

use super::values::{self, optional};
use crate::base::Code;
use crate::fields;
use crate::frame::{Eye, Resource};
use crate::language::model::{BufferPart, BufferRef, Decided, ImagePart, ImageRef, Part, ResourceRef, Selection};
use crate::language::scope::{Context, FieldContents, FieldValue, FieldValueTuple, combined};
use crate::ron::{FieldTable, Form, Leaf, Shape, Spanned, Table, Word, WordContents, Words, names};
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
        /// Depth or stencil; all planes of the image if left out.
        plane: Option<Leaf<'src>> => PLANE,
        /// How many frames back; only for images and buffers with history, and only to read.
        previous: Option<Leaf<'src>> => PREVIOUS,
    }
}

/// The name of an image.
pub(crate) const WHOLE_IMAGE: Form = Form::Reference("an image");

/// The name of a buffer.
pub(crate) const WHOLE_BUFFER: Form = Form::Reference("a buffer");

/// The name of an image or buffer.
pub(crate) const WHOLE_RESOURCE: Form = Form::Reference("an image or buffer");

/// The name of an image, or of one eye's part of it.
pub(crate) const EYE_IMAGE: Form = Form::Words(&EYES);

static EYES: Words = Words {
    name: "EyeImage",
    what: "an image",
    or: &[WHOLE_IMAGE],
    all: &[Word::new(
        "Eye",
        &[WordContents::Values(&[EYE, WHOLE_IMAGE])],
        &["Eye(Left, \"image\")", "Eye(Right, \"image\")"],
        "The image of one eye, where each eye has an image of its own.",
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

/// The fields of a part besides the image's name.
#[derive(Clone, Copy, Default)]
pub(crate) struct PartSelection<'src> {
    pub(crate) mip: Option<Leaf<'src>>,
    pub(crate) mips: Option<Leaf<'src>>,
    pub(crate) layer: Option<Leaf<'src>>,
    pub(crate) layers: Option<Leaf<'src>>,
    pub(crate) plane: Option<Leaf<'src>>,
    pub(crate) previous: Option<Leaf<'src>>,
}

const PLANES: [(&str, Aspects); 2] = [("Depth", Aspects::DEPTH), ("Stencil", Aspects::STENCIL)];

/// A part of an image, or of a buffer.
pub(crate) enum AnyPart {
    Image(FieldValue<ImagePart>),
    Buffer(FieldValue<BufferPart>),
}

impl AnyPart {
    /// The part, of an image or a buffer.
    pub(crate) fn part(self) -> FieldValue<Part> {
        match self {
            AnyPart::Image(part) => part.map(Part::Image),
            AnyPart::Buffer(part) => part.map(Part::Buffer),
        }
    }
}

impl Context<'_> {
    /// `"name"` or `(image: "name", mip: 1, …)` or `(buffer: "name", …)`.
    pub(crate) fn part(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Part>> {
        match leaf.shape() {
            Shape::Text => Some(self.resource(leaf)?.map(|ResourceRef { resource, span }| match resource {
                Resource::Image(index) => Part::Image(ImagePart::whole(ImageRef { index, span })),
                Resource::Buffer(index) => Part::Buffer(BufferPart::whole(BufferRef { index, span })),
            })),
            Shape::Word(..) => Some(self.selected_image(leaf, PartSelection::default())?.map(Part::Image)),
            Shape::Parentheses => self.part_by_fields(leaf).map(AnyPart::part),
            _ => {
                self.reader.expected(
                    leaf,
                    "an image or buffer: `\"name\"`, `(image: \"name\", mip: 1)` or `(buffer: \"name\")`",
                );
                None
            }
        }
    }

    fn part_by_fields(&mut self, leaf: Leaf<'_>) -> Option<AnyPart> {
        let fields: PartFields<'_> = self.reader.read(leaf, "a part of an image or buffer")?;
        let PartFields { image, buffer, mip, mips, layer, layers, plane, previous } = fields;
        let selected = PartSelection { mip, mips, layer, layers, plane, previous };
        self.part_of_either(leaf, image, buffer, selected)
    }

    /// The part of `image` or of `buffer`, one of which has to be there.
    pub(crate) fn part_of_either(
        &mut self,
        whole: Leaf<'_>,
        image: Option<Leaf<'_>>,
        buffer: Option<Leaf<'_>>,
        selected: PartSelection<'_>,
    ) -> Option<AnyPart> {
        match (image, buffer) {
            (Some(image), None) => self.selected_image(image, selected).map(AnyPart::Image),
            (None, Some(buffer)) => {
                let PartSelection { mip, mips, layer, layers, plane, previous } = selected;
                for foreign in [mip, mips, layer, layers, plane].into_iter().flatten() {
                    self.reader.wrong(
                        Code::IMAGE_OR_BUFFER,
                        foreign,
                        "a buffer has no mip levels, layers and planes",
                        "",
                    );
                }
                self.named_buffer(buffer, previous).map(AnyPart::Buffer)
            }
            (Some(_), Some(buffer)) => {
                self.reader.wrong(
                    Code::IMAGE_OR_BUFFER,
                    buffer,
                    "an image and a buffer can't be named in one place",
                    "",
                );
                None
            }
            (None, None) => {
                self.reader.wrong(
                    Code::IMAGE_OR_BUFFER,
                    whole,
                    "this names neither an image nor a buffer",
                    "add `image: \"…\"` or `buffer: \"…\"`",
                );
                None
            }
        }
    }

    /// `"name"` or `(image: "name", mip: 1, …)`.
    pub(crate) fn image_part(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<ImagePart>> {
        if let Shape::Parentheses = leaf.shape() {
            return match self.part_by_fields(leaf)? {
                AnyPart::Image(part) => Some(part),
                AnyPart::Buffer(_) => {
                    self.reader.wrong(Code::WRONG_KIND, leaf, "an image is needed here", "");
                    None
                }
            };
        }
        self.selected_image(leaf, PartSelection::default())
    }

    /// `"name"` or `(buffer: "name", previous: 1)`.
    pub(crate) fn buffer_part(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<BufferPart>> {
        if let Shape::Parentheses = leaf.shape() {
            return match self.part_by_fields(leaf)? {
                AnyPart::Buffer(part) => Some(part),
                AnyPart::Image(_) => {
                    self.reader.wrong(Code::WRONG_KIND, leaf, "a buffer is needed here", "");
                    None
                }
            };
        }
        self.named_buffer(leaf, None)
    }

    fn named_buffer(&mut self, buffer: Leaf<'_>, previous: Option<Leaf<'_>>) -> Option<FieldValue<BufferPart>> {
        let buffer = self.buffer(buffer);
        let previous = self.frames_back(previous);
        Some(combined((buffer?, previous?), |(buffer, previous)| BufferPart { buffer, previous }))
    }

    /// The part of the image that `name` names.
    pub(crate) fn selected_image(
        &mut self,
        name: Leaf<'_>,
        selected: PartSelection<'_>,
    ) -> Option<FieldValue<ImagePart>> {
        let image = match name.shape() {
            Shape::Word(..) => self.eyes_image(name),
            _ => self.image(name).map(|image| (image, None)),
        };
        let mips = self.selection(selected.mip, selected.mips, "mip level", "number of mip levels");
        let layers = self.selection(selected.layer, selected.layers, "layer", "number of layers");
        let plane = values::optional_choice(self.reader, selected.plane, "a plane", &PLANES);
        let previous = self.frames_back(selected.previous);
        let ((image, eye), plane) = (image?, plane?);
        Some(combined((image, mips?, layers?, previous?), move |(image, mips, layers, previous)| ImagePart {
            image,
            mips,
            layers,
            plane,
            previous,
            eye,
        }))
    }

    /// `Eye(Left, "name")`.
    fn eyes_image(&mut self, leaf: Leaf<'_>) -> Option<(FieldValue<ImageRef>, Option<Spanned<Eye>>)> {
        let (_, rest) = self.reader.one_of(leaf, &EYES)?;
        let [eye, name]: [Leaf<'_>; 2] = self.reader.inside(leaf, rest, "Eye(Left, \"image\")")?;
        let image = self.image(name);
        let chosen = self.reader.choice(eye, "an eye", &EYE_NAMES)?;
        Some((image?, Some(eye.spanned(chosen))))
    }

    fn frames_back(&mut self, leaf: Option<Leaf<'_>>) -> Option<Option<FieldValue<Spanned<u32>>>> {
        optional(leaf, |leaf| self.whole_at(leaf, "number of frames to look back", 1..=MOST_FRAMES))
    }

    fn selection(
        &mut self,
        first: Option<Leaf<'_>>,
        count: Option<Leaf<'_>>,
        one: &'static str,
        several: &'static str,
    ) -> Option<FieldValue<Selection>> {
        let first = optional(first, |leaf| self.whole_at(leaf, one, 0..=MOST_PARTS));
        let count = optional(count, |leaf| match leaf.shape() {
            Shape::Word("Rest", None) => Some(FieldValue::Constant(leaf.spanned(Subresources::REMAINING))),
            Shape::Number | Shape::Text => self.whole_at(leaf, several, 1..=MOST_PARTS),
            _ => {
                self.reader.expected(leaf, "a whole number, an expression in quotes or `Rest`");
                None
            }
        });
        Some(combined((first?, count?), |(first, count)| Selection { first, count }))
    }

    /// The value that `make` makes of the image in `Like("image")`.
    pub(crate) fn like<T: FieldContents>(
        &mut self,
        leaf: Leaf<'_>,
        rest: Option<Leaf<'_>>,
        make: fn(ImageRef) -> T,
    ) -> Option<FieldValue<Decided<T>>> {
        let [image]: [Leaf<'_>; 1] = self.reader.inside(leaf, rest, "Like(\"image\")")?;
        let span = leaf.span();
        let image = self.image(image)?;
        if let FieldValue::Constant(image) = image {
            return Some(FieldValue::Constant(Decided::said(span, make(image))));
        }
        Some(FieldValue::computed(move |evaluator| {
            let others = std::mem::take(&mut evaluator.chosen);
            let image = image.evaluate(evaluator);
            let by = std::mem::replace(&mut evaluator.chosen, others);
            Some(Decided { by, ..Decided::said(span, make(image?)) })
        }))
    }
}
