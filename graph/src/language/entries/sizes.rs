//! Sizes of images: a number of texels, or a share of the size of a view or another image.

use super::parts;
use super::values::Decided;
use crate::base::{Diagnostic, shown_number};
use crate::fields;
use crate::language::model::{LARGEST_SIZE, SettingKind, Size};
use crate::language::scope::{Context, Quoted};
use crate::ron::{Described, Form, Leaf, Shape, Takes, Word, Words};

fields! {
    /// A factor that may change from frame to frame.
    struct DynamicFields<'src> {
        /// The factor, above 0; sides are rounded down, and at least 2 where there is room for that.
        by: Leaf<'src> => Form::Number,
        /// The greatest factor. Changing it takes other memory, changing `by` doesn't.
        up_to: Leaf<'src> => Form::Number,
        /// Of which image; of the view if left out.
        of: Option<Leaf<'src>> => parts::WHOLE_IMAGE,
    }
}

/// What `size` takes.
pub(crate) const SIZE: Form = Form::Words(&SIZES);

static SIZES: Words = Words {
    name: "Size",
    what: "a size",
    or: &[],
    all: &[
        Word::alone("Output", "The view's; without views the frame's."),
        Word::new(
            "Scaled",
            &[Takes::Values(&[Form::Number]), Takes::Values(&[Form::Number, parts::WHOLE_IMAGE])],
            &["Scaled(0.5)", "Scaled(0.5, \"image\")"],
            "The view's or another image's, times a number above 0; rounded down, at least 1.",
        ),
        Word::new(
            "Dynamic",
            &[Takes::Fields(DynamicFields::<'static>::table)],
            &["Dynamic(by: 0.5, up_to: 1.0)"],
            "As `Scaled`, but the factor may be another one in each frame: the image has room for the greatest.",
        ),
        Word::new("Fixed", &[Takes::Values(&[EXTENT, EXTENT])], &["Fixed(640, 480)"], "So many texels wide and high."),
        Word::new("Like", &[Takes::Values(&[parts::WHOLE_IMAGE])], &["Like(\"image\")"], "That of another image."),
    ],
};

/// One side of an image.
pub(crate) const EXTENT: Form = Form::Whole(1, LARGEST_SIZE as i64);

impl Context<'_, '_> {
    /// A size, and what decides its factor.
    pub(crate) fn size(&mut self, leaf: Leaf<'_>) -> Option<Decided<Size>> {
        let (word, rest) = self.reader.one_of(leaf, &SIZES)?;
        match word {
            "Output" => self.reader.bare(word, rest).map(|()| (Size::Output, None)),
            "Like" => self.like(leaf, rest).map(|of| (Size::Like(of), None)),
            "Fixed" => {
                let [width, height]: [Leaf<'_>; 2] = self.reader.inside(leaf, rest, "Fixed(width, height)")?;
                let (width, height) = (self.extent(width), self.extent(height));
                Some((Size::Fixed([width?, height?]), None))
            }
            "Dynamic" => {
                let fields = self.reader.inside::<DynamicFields<'_>>(leaf, rest, "Dynamic(by: …, up_to: …)")?;
                let of = fields.of.map(|of| self.image(of));
                let (by, up_to) = (self.scale(fields.by), self.scale(fields.up_to));
                let ((by, because), (up_to, _)) = (by?, up_to?);
                if by > up_to {
                    let message = format!("the factor {} is more than there is room for", shown_number(by));
                    let wrong = Diagnostic::new(fields.by.span(), message);
                    let remark = self.scope.within_view(because.as_deref().unwrap_or_default());
                    let most = format!("at most {}", shown_number(up_to));
                    self.fault(fields.by, wrong.remark(remark).label(fields.up_to.span(), most));
                    return None;
                }
                match of {
                    Some(of) => Some((Size::Dynamic { by, up_to, of: Some(of?) }, because)),
                    None => Some((Size::Dynamic { by, up_to, of: None }, because)),
                }
            }
            _ => {
                let both = rest.and_then(Leaf::tuple);
                let (by, of) = match both {
                    Some([by, of]) => (by, Some(self.image(of))),
                    None => {
                        let [by]: [Leaf<'_>; 1] =
                            self.reader.inside(leaf, rest, "Scaled(0.5)` or `Scaled(0.5, \"image\")")?;
                        (by, None)
                    }
                };
                let (by, because) = self.scale(by)?;
                match of {
                    Some(of) => Some((Size::Scaled { by, of: Some(of?) }, because)),
                    None => Some((Size::Scaled { by, of: None }, because)),
                }
            }
        }
    }

    /// One side of an image, in texels.
    pub(crate) fn extent(&mut self, leaf: Leaf<'_>) -> Option<u32> {
        if let Shape::Text = leaf.shape() {
            return self.whole(leaf, "size", 1..=i64::from(LARGEST_SIZE));
        }
        let extent = self.reader.integer(leaf)?;
        match u32::try_from(extent) {
            Ok(extent @ 1..=LARGEST_SIZE) => Some(extent),
            _ => {
                self.reader.wrong(leaf, format!("{extent} is no size: 1 to {LARGEST_SIZE} texels are allowed"), "");
                None
            }
        }
    }

    /// A factor above 0, and what decides it.
    pub(crate) fn scale(&mut self, leaf: Leaf<'_>) -> Option<Decided<f64>> {
        if let Shape::Text = leaf.shape()
            && self.scope.symbols.settings
            && let Quoted::Parameter(parameter, _) =
                self.quoted(leaf, SettingKind::is_number, "a number", Some("a number"))?
            && let Some(least) = parameter.least().filter(|least| *least <= 0.0)
        {
            let message = format!("a scale is greater than 0, but this setting allows {}", shown_number(least));
            self.reader.wrong(leaf, message, "let the setting begin above 0");
            return None;
        }
        let (by, because) = self.number_because(leaf, "a scale")?;
        if by <= 0.0 {
            let wrong = format!("a scale is greater than 0, found {}", shown_number(by));
            let because = self.scope.within_view(because.as_deref().unwrap_or_default());
            let help = "write a number above 0: `1` is the same size, `0.5` half the width and half the height";
            self.fault(leaf, Diagnostic::new(leaf.span(), wrong).remark(because).help(help));
            return None;
        }
        Some((by, because))
    }
}
