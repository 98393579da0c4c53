//! `color` and `depth`: the targets of a pass, with their clears, blends and tests.

use super::parts::{self, PartSelection};
use super::raster;
use super::values::{self, at, optional};
use crate::base::{Code, Diagnostic};
use crate::fields;
use crate::frame::{Blend, StencilState};
use crate::language::model::{Color, Depth};
use crate::language::scope::{Context, FieldValue, all, combined};
use crate::ron::{FieldTable, Form, Leaf, Shape, Spanned, names};
use crate::vulkan::{ColorComponents, CompareOp, StencilOp};

fields! {
    /// A colour target: an image that a pass draws colour into.
    /// ```ron
    /// (image: "image", mip: 0, clear: (0.0, 0.0, 0.0, 1.0))
    /// ```
    struct ColorTargetFields<'src> {
        /// Which image.
        image: Leaf<'src> => parts::EYE_IMAGE,
        /// The mip level, from 0; it must be named if there are several.
        mip: Option<Leaf<'src>> => parts::FIRST,
        /// The first layer, from 0.
        layer: Option<Leaf<'src>> => parts::FIRST,
        /// How many layers; one if `layer` stands alone, all if neither stands there.
        layers: Option<Leaf<'src>> => parts::COUNT,
        /// The clear value: red, green, blue and alpha, in linear values; not cleared if left out. The image's format must hold it:
        /// whole numbers where it holds integers.
        clear: Option<Leaf<'src>> => values::COLOR,
        /// The blend of new colour with old; `Replace` if left out.
        blend: Option<Leaf<'src>> => raster::BLEND,
        /// The channels that are written, red, green, blue and alpha; all if left out. The others keep what they held.
        write_mask: Option<Leaf<'src>> => Form::Tuple(&[Form::Truth, Form::Truth, Form::Truth, Form::Truth]),
    }
}

fields! {
    /// A depth target: an image that a pass draws depth and stencil into.
    /// ```ron
    /// (image: "depth", clear: 0.0, stencil: (clear: 0, reference: 1, pass: Replace))
    /// ```
    struct DepthTargetFields<'src> {
        /// Which image.
        image: Leaf<'src> => parts::EYE_IMAGE,
        /// The mip level, from 0; it must be named if there are several.
        mip: Option<Leaf<'src>> => parts::FIRST,
        /// The first layer, from 0.
        layer: Option<Leaf<'src>> => parts::FIRST,
        /// How many layers; one if `layer` stands alone, all if neither stands there.
        layers: Option<Leaf<'src>> => parts::COUNT,
        /// The clear value, 0 to 1; not cleared if left out. Depth is reversed: 0 is infinitely far, 1 is nearest.
        clear: Option<Leaf<'src>> => Form::Number,
        /// The test that fragments have to pass; `GreaterOrEqual` if left out.
        test: Option<Leaf<'src>> => TEST,
        /// Whether fragments that pass write their depth; true if left out.
        write: Option<Leaf<'src>> => Form::Truth,
        /// The stencil state; nothing happens to stencil if left out.
        stencil: Option<Leaf<'src>> => Form::Fields(StencilFields::<'static>::table),
    }
}

fields! {
    /// A stencil state: the clear, test and writes of stencil in a pass.
    /// ```ron
    /// (test: Equal, reference: 1)
    /// ```
    struct StencilFields<'src> {
        /// The clear value; not cleared if left out.
        clear: Option<Leaf<'src>> => BYTE,
        /// The test that fragments have to pass; `Always` if left out.
        test: Option<Leaf<'src>> => TEST,
        /// The value that the test compares with and that `Replace` writes; 0 if left out.
        reference: Option<Leaf<'src>> => BYTE,
        /// The operation of fragments that pass; `Keep` if left out.
        pass: Option<Leaf<'src>> => Form::Choice("a stencil operation", || names(&OPERATIONS)),
    }
}

/// The form of `color`: a list of targets.
pub(crate) const COLOR: Form =
    Form::List(&Form::Either(&[parts::EYE_IMAGE, Form::Fields(ColorTargetFields::<'static>::table)]));

/// The form of `depth`: a target.
pub(crate) const DEPTH: Form = Form::Either(&[parts::EYE_IMAGE, Form::Fields(DepthTargetFields::<'static>::table)]);

pub(crate) const TEST: Form = Form::Choice("a comparison", || names(&TESTS));

const BYTE: Form = Form::Whole(0, 255);

pub(crate) static TESTS: [(&str, CompareOp); 8] = [
    ("Never", CompareOp::Never),
    ("Less", CompareOp::Less),
    ("Equal", CompareOp::Equal),
    ("LessOrEqual", CompareOp::LessOrEqual),
    ("Greater", CompareOp::Greater),
    ("NotEqual", CompareOp::NotEqual),
    ("GreaterOrEqual", CompareOp::GreaterOrEqual),
    ("Always", CompareOp::Always),
];

const OPERATIONS: [(&str, StencilOp); 6] = [
    ("Keep", StencilOp::Keep),
    ("Zero", StencilOp::Zero),
    ("Replace", StencilOp::Replace),
    ("IncrementAndClamp", StencilOp::IncrementAndClamp),
    ("DecrementAndClamp", StencilOp::DecrementAndClamp),
    ("Invert", StencilOp::Invert),
];

impl Context<'_> {
    /// The list of colour targets.
    pub(crate) fn color_targets(&mut self, leaf: Leaf<'_>) -> Option<Vec<FieldValue<Color>>> {
        let entries = self.reader.list(leaf, "`color`")?;
        let targets: Vec<Option<FieldValue<Color>>> =
            entries.into_iter().map(|entry| self.color_target(entry)).collect();
        targets.into_iter().collect()
    }

    fn color_target(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Color>> {
        let replace = leaf.spanned(Blend::Replace);
        match leaf.shape() {
            Shape::Text | Shape::Word(..) => {
                let write_mask = ColorComponents::RGBA;
                Some(self.image_part(leaf)?.map(move |part| Color { part, clear: None, blend: replace, write_mask }))
            }
            Shape::Parentheses => {
                let fields: ColorTargetFields<'_> = self.reader.read(leaf, "a colour target")?;
                let (mip, layer, layers) = (fields.mip, fields.layer, fields.layers);
                let part =
                    self.selected_image(fields.image, PartSelection { mip, layer, layers, ..PartSelection::default() });
                let clear = optional(fields.clear, |clear| self.clear_color(clear));
                let blend = match fields.blend {
                    Some(leaf) => self.blend(leaf),
                    None => Some(FieldValue::Constant(replace)),
                };
                let write_mask = match fields.write_mask {
                    Some(leaf) => self.write_mask(leaf),
                    None => Some(FieldValue::Constant(ColorComponents::RGBA)),
                };
                let parts = (part?, clear?, blend?, write_mask?);
                Some(combined(parts, |(part, clear, blend, write_mask)| Color { part, clear, blend, write_mask }))
            }
            _ => {
                self.reader.expected(
                    leaf,
                    "a colour target: `\"image\"` or `(image: \"image\", clear: (r, g, b, a), blend: …)`",
                );
                None
            }
        }
    }

    /// The depth target.
    pub(crate) fn depth_target(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Depth>> {
        let test = CompareOp::GreaterOrEqual;
        match leaf.shape() {
            Shape::Text | Shape::Word(..) => Some(self.image_part(leaf)?.map(move |part| Depth {
                part,
                clear: None,
                test,
                write: true,
                stencil: None,
            })),
            Shape::Parentheses => {
                let fields: DepthTargetFields<'_> = self.reader.read(leaf, "a depth target")?;
                let (mip, layer, layers) = (fields.mip, fields.layer, fields.layers);
                let part =
                    self.selected_image(fields.image, PartSelection { mip, layer, layers, ..PartSelection::default() });
                let clear = optional(fields.clear, |clear| self.clear_depth(clear));
                let test = fields.test.map_or(Some(test), |test| self.reader.choice(test, "a depth test", &TESTS));
                let write = fields
                    .write
                    .map_or(Some(FieldValue::Constant(true)), |write| self.truth(write).map(FieldValue::alone));
                let stencil = optional(fields.stencil, |leaf| self.stencil(leaf));
                let test = test?;
                Some(combined((part?, clear?, write?, stencil?), move |(part, clear, write, stencil)| Depth {
                    part,
                    clear,
                    test,
                    write,
                    stencil,
                }))
            }
            _ => {
                self.reader.expected(
                    leaf,
                    "a depth target: `\"image\"` or `(image: \"image\", clear: 0.0, test: …, write: …)`",
                );
                None
            }
        }
    }

    /// The stencil state.
    fn stencil(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Spanned<StencilState>>> {
        let Shape::Parentheses = leaf.shape() else {
            self.reader.expected(leaf, "a stencil state: `(clear: 0, test: Equal, reference: 1, pass: Replace)`");
            return None;
        };
        let fields: StencilFields<'_> = self.reader.read(leaf, "a stencil state")?;
        let byte = |context: &mut Self, leaf| context.whole::<u8>(leaf, "stencil value", 0..=255);
        let clear = optional(fields.clear, |clear| byte(self, clear));
        let test =
            fields.test.map_or(Some(CompareOp::Always), |test| self.reader.choice(test, "a stencil test", &TESTS));
        let reference = fields.reference.map_or(Some(FieldValue::Constant(0)), |reference| byte(self, reference));
        let pass = fields
            .pass
            .map_or(Some(StencilOp::Keep), |pass| self.reader.choice(pass, "a stencil operation", &OPERATIONS));
        let (test, pass) = (test?, pass?);
        let state =
            combined((clear?, reference?), move |(clear, reference)| StencilState { clear, test, reference, pass });
        Some(at(leaf, state))
    }

    fn clear_color(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<[Spanned<f64>; 4]>> {
        if !matches!(leaf.shape(), Shape::Parentheses) {
            self.reader.expected(leaf, "a colour `(red, green, blue, alpha)`");
            return None;
        }
        let parts: [Leaf<'_>; 4] = self.reader.read(leaf, "a colour `(red, green, blue, alpha)`")?;
        let parts = all(parts.map(|part| self.color_component(part)))?;
        Some(combined(parts, |parts| parts))
    }

    fn color_component(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Spanned<f64>>> {
        let number = self.number_because(leaf, "a channel of a colour")?.checked(self.reader, move |number, _| {
            #[allow(clippy::cast_possible_truncation, reason = "no format holds more")]
            let fits = (number.value as f32).is_finite();
            if fits {
                return Ok(number.value);
            }
            let wrong = format!("{} is too large for a colour", crate::base::shown_number(number.value));
            let wrong = Diagnostic::new(Code::FILL_UNFIT, number.span, wrong).remark(number.remark());
            Err(wrong.help("32-bit floating point reaches about 3.4e38"))
        })?;
        Some(at(leaf, number))
    }

    fn clear_depth(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<f64>> {
        self.number_because(leaf, "depth")?.checked(self.reader, move |depth, _| {
            if !(0.0..=1.0).contains(&depth.value) {
                let help = "write a depth from 0 to 1: 0 is infinitely far, 1 is nearest";
                let wrong = format!("depth lies from 0 to 1, found {}", crate::base::shown_number(depth.value));
                return Err(Diagnostic::new(Code::FILL_UNFIT, depth.span, wrong).remark(depth.remark()).help(help));
            }
            Ok(depth.value)
        })
    }
}
