//! Sizes of images: a number of texels, or a share of the size of a view or another image.

use super::parts;
use super::values::optional;
use crate::base::{Code, Diagnostic, shown_number};
use crate::fields;
use crate::language::model::{Decided, LARGEST_SIZE, Size};
use crate::language::scope::{Context, FieldValue, FieldValueTuple, all, combined, within_view};
use crate::ron::{FieldTable, Form, Leaf, Shape, Word, WordContents, Words};

fields! {
    /// A factor that may change from frame to frame.
    struct DynamicFields<'src> {
        /// The factor, above 0; sides are rounded down, and at least 2 where there is room for that.
        by: Leaf<'src> => Form::Number,
        /// The greatest factor. Changing it takes other memory, changing `by` doesn't.
        up_to: Leaf<'src> => Form::Number,
        /// The image whose size is meant; the size of the view if left out.
        of: Option<Leaf<'src>> => parts::WHOLE_IMAGE,
    }
}

/// The form of `size`.
pub(crate) const SIZE: Form = Form::Words(&SIZES);

static SIZES: Words = Words {
    name: "Size",
    what: "a size",
    or: &[],
    all: &[
        Word::alone("Output", "The view's; without views the frame's."),
        Word::new(
            "Scaled",
            &[WordContents::Values(&[Form::Number]), WordContents::Values(&[Form::Number, parts::WHOLE_IMAGE])],
            &["Scaled(0.5)", "Scaled(0.5, \"image\")"],
            "The view's or another image's, times a number above 0; rounded down, at least 1.",
        ),
        Word::new(
            "Dynamic",
            &[WordContents::Fields(DynamicFields::<'static>::table)],
            &["Dynamic(by: 0.5, up_to: 1.0)"],
            "As `Scaled`, but the factor may be another one in each frame: the image has room for the greatest.",
        ),
        Word::new(
            "Fixed",
            &[WordContents::Values(&[EXTENT, EXTENT])],
            &["Fixed(640, 480)"],
            "This many texels wide and high.",
        ),
        Word::new(
            "Like",
            &[WordContents::Values(&[parts::WHOLE_IMAGE])],
            &["Like(\"image\")"],
            "The size of another image.",
        ),
    ],
};

/// One side of an image.
pub(crate) const EXTENT: Form = Form::Whole(1, LARGEST_SIZE as i64);

impl Context<'_> {
    /// A size, and the cause of its factor.
    pub(crate) fn size(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<Size>>> {
        let (word, rest) = self.reader.one_of(leaf, &SIZES)?;
        match word {
            "Output" => self.reader.bare(word, rest).map(|()| FieldValue::said(leaf, Size::Output)),
            "Like" => self.like(leaf, rest, Size::Like),
            "Fixed" => {
                let span = leaf.span();
                Some(combined(self.fixed(leaf, rest)?, move |extent| Decided::said(span, Size::Fixed(extent))))
            }
            "Dynamic" => {
                let fields = self.reader.inside::<DynamicFields<'_>>(leaf, rest, "Dynamic(by: …, up_to: …)")?;
                let of = optional(fields.of, |of| self.image(of));
                let (by, up_to) = (self.scale(fields.by), self.scale(fields.up_to));
                let by = by?;
                let said = by.is_constant();
                let factors = combined((by, up_to?), |factors| factors);
                let factors = factors.checked_as(self.reader, said, move |(by, up_to), view| {
                    if by.value > up_to.value {
                        let message = format!("the factor {} is more than there is room for", shown_number(by.value));
                        let wrong = Diagnostic::new(Code::DYNAMIC_SIZE, by.span, message)
                            .remark(within_view(view, by.remark()));
                        return Err(wrong.label(up_to.span, format!("at most {}", shown_number(up_to.value))));
                    }
                    Ok((by, up_to))
                });
                Some(combined((factors?, of?), |((by, up_to), of)| {
                    by.map(|by| Size::Dynamic { by, up_to: up_to.value, of })
                }))
            }
            _ => {
                let (by, of) = match rest.and_then(Leaf::tuple) {
                    Some([by, of]) => (by, Some(of)),
                    None => {
                        let [by]: [Leaf<'_>; 1] =
                            self.reader.inside(leaf, rest, "Scaled(0.5)` or `Scaled(0.5, \"image\")")?;
                        (by, None)
                    }
                };
                let of = optional(of, |of| self.image(of));
                let by = self.scale(by);
                Some(combined((by?, of?), |(by, of)| by.map(|by| Size::Scaled { by, of })))
            }
        }
    }

    /// Width and height of `Fixed(width, height)`.
    pub(crate) fn fixed(&mut self, leaf: Leaf<'_>, rest: Option<Leaf<'_>>) -> Option<[FieldValue<u32>; 2]> {
        let sides: [Leaf<'_>; 2] = self.reader.inside(leaf, rest, "Fixed(width, height)")?;
        all(sides.map(|side| self.extent(side)))
    }

    /// One side of an image, in texels.
    fn extent(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<u32>> {
        if let Shape::Text = leaf.shape() {
            return self.whole(leaf, "size", 1..=i64::from(LARGEST_SIZE));
        }
        let extent = self.reader.integer(leaf)?;
        match u32::try_from(extent) {
            Ok(extent @ 1..=LARGEST_SIZE) => Some(FieldValue::Constant(extent)),
            _ => {
                self.reader.wrong(
                    Code::SIZE_OUTSIDE,
                    leaf,
                    format!("{extent} is no size: 1 to {LARGEST_SIZE} texels are allowed"),
                    "",
                );
                None
            }
        }
    }

    /// A factor above 0, and its cause.
    pub(crate) fn scale(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Decided<f64>>> {
        if let Some(parameter) = self.setting(leaf)
            && let Some(least) = parameter.least().filter(|least| *least <= 0.0)
        {
            let message = format!("a scale is greater than 0, but this setting allows {}", shown_number(least));
            self.reader.wrong(Code::SETTING_TOO_WIDE, leaf, message, "let the setting begin above 0");
            return None;
        }
        self.number_because(leaf, "a scale")?.checked(self.reader, move |by, view| {
            if by.value > 0.0 {
                return Ok(by);
            }
            let wrong = format!("a scale is greater than 0, found {}", shown_number(by.value));
            let help = "write a number above 0: `1` is the same size, `0.5` half the width and half the height";
            Err(Diagnostic::new(Code::SCALE, by.span, wrong).remark(within_view(view, by.remark())).help(help))
        })
    }
}
