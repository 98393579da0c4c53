//! `color` and `depth`: what a pass draws into, and how.

use super::parts::{self, Selected};
use super::values::{self, choice};
use crate::base::Diagnostic;
use crate::fields;
use crate::frame::{Blend, StencilState};
use crate::language::model::{Color, Depth};
use crate::language::scope::Scope;
use crate::ron::{Described, Form, Leaf, Reader, Shape, Spanned, names};
use crate::vulkan::{CompareOp, StencilOp};

fields! {
    /// A colour target: what a pass draws colour into.
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
        /// What it is cleared to first: red, green, blue and alpha, in linear values.
        clear: Option<Leaf<'src>> => values::COLOR,
        /// How new colour meets old; `Replace` if left out.
        blend: Option<Leaf<'src>> => Form::Choice("a blend", || names(&BLENDS)),
    }
}

fields! {
    /// A depth target: what a pass draws depth and stencil into.
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
        /// What it is cleared to first, 0 to 1. Depth is reversed: 0 is infinitely far, 1 is nearest.
        clear: Option<Leaf<'src>> => Form::Number,
        /// Which fragments pass; `GreaterOrEqual` if left out.
        test: Option<Leaf<'src>> => TEST,
        /// Whether those that pass write their depth; they do if it is left out.
        write: Option<Leaf<'src>> => Form::Truth,
        /// What happens to stencil; nothing if left out.
        stencil: Option<Leaf<'src>> => Form::Fields(StencilFields::<'static>::table),
    }
}

fields! {
    /// A stencil state: what a pass does to stencil.
    /// ```ron
    /// (test: Equal, reference: 1)
    /// ```
    struct StencilFields<'src> {
        /// What it is cleared to first.
        clear: Option<Leaf<'src>> => BYTE,
        /// Which fragments pass; `Always` if left out.
        test: Option<Leaf<'src>> => TEST,
        /// What they are compared with, and what `Replace` writes; 0 if left out.
        reference: Option<Leaf<'src>> => BYTE,
        /// What those that pass do; `Keep` if left out.
        pass: Option<Leaf<'src>> => Form::Choice("a stencil operation", || names(&OPERATIONS)),
    }
}

/// What `color` takes.
pub(crate) const COLOR: Form =
    Form::List(&Form::Either(&[parts::EYE_IMAGE, Form::Fields(ColorTargetFields::<'static>::table)]));

/// What `depth` takes.
pub(crate) const DEPTH: Form = Form::Either(&[parts::EYE_IMAGE, Form::Fields(DepthTargetFields::<'static>::table)]);

const TEST: Form = Form::Choice("a comparison", || names(&TESTS));

const BYTE: Form = Form::Whole(0, 255);

const BLENDS: [(&str, Blend); 4] = [
    ("Replace", Blend::Replace),
    ("Alpha", Blend::Alpha),
    ("Premultiplied", Blend::Premultiplied),
    ("Additive", Blend::Additive),
];

const TESTS: [(&str, CompareOp); 8] = [
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

/// The list of colour targets.
pub(crate) fn color<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Vec<Color>> {
    let entries = reader.list(leaf, "`color`")?;
    let targets: Vec<Option<Color>> = entries.into_iter().map(|entry| color_target(reader, scope, entry)).collect();
    targets.into_iter().collect()
}

fn color_target<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Color> {
    let replace = leaf.spanned(Blend::Replace);
    match leaf.shape() {
        Shape::Text | Shape::Word(..) => {
            Some(Color { part: parts::image(reader, scope, leaf)?, clear: None, blend: replace })
        }
        Shape::Parentheses => {
            let fields: ColorTargetFields<'_> = reader.read(leaf, "a colour target")?;
            let (mip, layer, layers) = (fields.mip, fields.layer, fields.layers);
            let part =
                parts::image_part(reader, scope, fields.image, Selected { mip, layer, layers, ..Selected::default() });
            let clear = match fields.clear {
                Some(clear) => clear_color(reader, scope, clear).map(Some),
                None => Some(None),
            };
            let blend = match fields.blend {
                Some(blend) => choice(reader, blend, "a blend", &BLENDS).map(|value| blend.spanned(value)),
                None => Some(replace),
            };
            Some(Color { part: part?, clear: clear?, blend: blend? })
        }
        _ => {
            reader
                .expected(leaf, "a colour target: `\"image\"` or `(image: \"image\", clear: (r, g, b, a), blend: …)`");
            None
        }
    }
}

/// The depth target.
pub(crate) fn depth<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Depth> {
    let (test, write) = (CompareOp::GreaterOrEqual, true);
    match leaf.shape() {
        Shape::Text | Shape::Word(..) => {
            let part = parts::image(reader, scope, leaf)?;
            Some(Depth { part, clear: None, test, write, stencil: None })
        }
        Shape::Parentheses => {
            let fields: DepthTargetFields<'_> = reader.read(leaf, "a depth target")?;
            let (mip, layer, layers) = (fields.mip, fields.layer, fields.layers);
            let part =
                parts::image_part(reader, scope, fields.image, Selected { mip, layer, layers, ..Selected::default() });
            let clear = match fields.clear {
                Some(clear) => clear_depth(reader, scope, clear).map(Some),
                None => Some(None),
            };
            let test = match fields.test {
                Some(test) => choice(reader, test, "a depth test", &TESTS),
                None => Some(test),
            };
            let write = match fields.write {
                Some(write) => values::truth(reader, scope, write),
                None => Some(write),
            };
            let stencil = match fields.stencil {
                Some(leaf) => stencil(reader, scope, leaf).map(Some),
                None => Some(None),
            };
            Some(Depth { part: part?, clear: clear?, test: test?, write: write?, stencil: stencil? })
        }
        _ => {
            reader.expected(leaf, "a depth target: `\"image\"` or `(image: \"image\", clear: 0.0, test: …, write: …)`");
            None
        }
    }
}

/// What happens to the stencil plane.
fn stencil<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Spanned<StencilState>> {
    let Shape::Parentheses = leaf.shape() else {
        reader.expected(leaf, "a stencil state: `(clear: 0, test: Equal, reference: 1, pass: Replace)`");
        return None;
    };
    let fields: StencilFields<'_> = reader.read(leaf, "a stencil state")?;
    let byte = |reader: &mut Reader, leaf| values::whole::<u8>(reader, scope, leaf, "stencil value", 0..=255);
    let clear = match fields.clear {
        Some(clear) => byte(reader, clear).map(Some),
        None => Some(None),
    };
    let test = match fields.test {
        Some(test) => choice(reader, test, "a stencil test", &TESTS),
        None => Some(CompareOp::Always),
    };
    let reference = match fields.reference {
        Some(reference) => byte(reader, reference),
        None => Some(0),
    };
    let pass = match fields.pass {
        Some(pass) => choice(reader, pass, "a stencil operation", &OPERATIONS),
        None => Some(StencilOp::Keep),
    };
    let state = StencilState { clear: clear?, test: test?, reference: reference?, pass: pass? };
    Some(leaf.spanned(state))
}

fn clear_color<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<[f32; 4]> {
    if !matches!(leaf.shape(), Shape::Parentheses) {
        reader.expected(leaf, "a colour `(red, green, blue, alpha)`");
        return None;
    }
    let parts: [Leaf<'_>; 4] = reader.read(leaf, "a colour `(red, green, blue, alpha)`")?;
    let parts = parts.map(|part| component(reader, scope, part));
    Some([parts[0]?, parts[1]?, parts[2]?, parts[3]?])
}

fn component<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<f32> {
    let (number, because) = values::number_because(reader, scope, leaf, "a channel of a colour")?;
    #[allow(clippy::cast_possible_truncation, reason = "a colour is stored in single precision")]
    let component = number as f32;
    if component.is_finite() {
        return Some(component);
    }
    let wrong = format!("{} is too large for a colour", crate::base::shown_number(number));
    let wrong = Diagnostic::new(leaf.span(), wrong).remark(because.as_deref().unwrap_or_default());
    scope.fault(reader, leaf, wrong.help("32-bit floating point reaches about 3.4e38"));
    None
}

fn clear_depth<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<f32> {
    let (depth, because) = values::number_because(reader, scope, leaf, "depth")?;
    if !(0.0..=1.0).contains(&depth) {
        let help = "write a depth from 0 to 1: 0 is infinitely far, 1 is nearest";
        let wrong = format!("depth lies from 0 to 1, found {}", crate::base::shown_number(depth));
        let wrong = Diagnostic::new(leaf.span(), wrong).remark(because.as_deref().unwrap_or_default());
        scope.fault(reader, leaf, wrong.help(help));
        return None;
    }
    #[allow(clippy::cast_possible_truncation, reason = "depth is stored in single precision")]
    Some(depth as f32)
}
