//! `raster`, `blend` and `write_mask`: how the primitives of a pass become fragments, and which channels of old colours new ones meet.

use super::values::at;
use crate::base::{Code, Diagnostic};
use crate::fields;
use crate::frame::{Blend, BlendEquation, DepthBias, RasterState};
use crate::language::model::Decided;
use crate::language::scope::{Context, FieldContents, FieldValue, all, combined};
use crate::ron::{FieldTable, Form, Leaf, Shape, Spanned, names};
use crate::vulkan::{BlendFactor, BlendOp, ColorComponents, CullMode, FrontFace, PrimitiveTopology, Real};

fields! {
    /// A raster state: how triangles, lines and points become fragments.
    /// ```ron
    /// (cull_mode: Front, depth_bias: (constant: -1.0, slope: -2.0))
    /// ```
    struct RasterFields<'src> {
        /// The faces that are left out; `Neither` is Vulkan's `NONE`. If nothing is said: of objects those that their material leaves
        /// out, of other draws none.
        cull_mode: Option<Leaf<'src>> => Form::Either(&[
            Form::Choice("a cull mode", || names(CullMode::NAMED)), Form::Expression("a cull mode"),
        ]),
        /// The direction in which the vertices of front faces go round, as the upright picture shows them; `CounterClockwise`
        /// if left out. `Clockwise` turns the faces of objects over.
        front_face: Option<Leaf<'src>> => Form::Either(&[
            Form::Choice("a front face", || names(FrontFace::NAMED)), Form::Expression("a front face"),
        ]),
        /// What the vertices of `Vertices`, `Indirect` and custom passes make; `TriangleList` if left out. Of what a program draws its
        /// [interface file](embedding.md#topologies) may say it.
        topology: Option<Leaf<'src>> => Form::Either(&[
            Form::Choice("a topology", || names(PrimitiveTopology::NAMED)), Form::Expression("a topology"),
        ]),
        /// `true`: an index of all ones ends a strip or a fan, and begins another; such an index is a vertex if left out.
        primitive_restart: Option<Leaf<'src>> => Form::Truth,
        /// What is added to depth; nothing if left out. Depth is reversed: less than 0 moves away.
        depth_bias: Option<Leaf<'src>> => Form::Fields(DepthBiasFields::<'static>::table),
        /// `true`: what lies in front of the near plane or behind the far plane is drawn with the depth of that plane; it is cut off
        /// if left out.
        depth_clamp: Option<Leaf<'src>> => Form::Truth,
        /// How many texels wide lines are; 1 if left out.
        line_width: Option<Leaf<'src>> => Form::Number,
        /// The constant colour of blends: red, green, blue and alpha; 0 each if left out.
        blend_constants: Option<Leaf<'src>> => super::values::COLOR,
    }
}

fields! {
    /// A depth bias: what is added to the depth of fragments.
    /// ```ron
    /// (constant: -1.0, slope: -2.0, clamp: -0.01)
    /// ```
    struct DepthBiasFields<'src> {
        /// How many of the smallest steps of depth are added; 0 if left out.
        constant: Option<Leaf<'src>> => Form::Number,
        /// How often the greatest slope of the triangle's depth, from texel to texel, is added; 0 if left out.
        slope: Option<Leaf<'src>> => Form::Number,
        /// The most that is added, or, below 0, the most that is taken away; no bound if it is 0 or left out.
        clamp: Option<Leaf<'src>> => Form::Number,
    }
}

fields! {
    /// A blend equation: factors of new and old colour, and what becomes of both.
    /// ```ron
    /// (src_color: SrcAlpha, dst_color: OneMinusSrcAlpha, src_alpha: One)
    /// ```
    struct BlendFields<'src> {
        /// The factor of the new colour.
        src_color: Leaf<'src> => FACTOR,
        /// The factor of the old colour.
        dst_color: Leaf<'src> => FACTOR,
        /// The operation on both; `Add` if left out.
        color_op: Option<Leaf<'src>> => OPERATION,
        /// The factor of the new alpha; as `src_color` if left out.
        src_alpha: Option<Leaf<'src>> => FACTOR,
        /// The factor of the old alpha; as `dst_color` if left out.
        dst_alpha: Option<Leaf<'src>> => FACTOR,
        /// The operation on both; as `color_op` if left out.
        alpha_op: Option<Leaf<'src>> => OPERATION,
    }
}

/// The form of `raster`.
pub(crate) const RASTER: Form = Form::Fields(RasterFields::<'static>::table);

/// The form of `blend`.
pub(crate) const BLEND: Form = Form::Either(&[
    Form::Choice("a blend", || names(&BLENDS)),
    Form::Fields(BlendFields::<'static>::table),
    Form::Expression("a blend"),
]);

const FACTOR: Form =
    Form::Either(&[Form::Choice("a blend factor", || names(BlendFactor::NAMED)), Form::Expression("a blend factor")]);

const OPERATION: Form =
    Form::Either(&[Form::Choice("a blend operation", || names(BlendOp::NAMED)), Form::Expression("a blend operation")]);

static BLENDS: [(&str, Blend); 4] = [
    ("Replace", Blend::Replace),
    ("Alpha", Blend::Alpha),
    ("Premultiplied", Blend::Premultiplied),
    ("Additive", Blend::Additive),
];

/// A field that may be left out: `None` if it is there and wrong.
pub(super) type OptionalField<T> = Option<FieldValue<Option<T>>>;

impl Context<'_> {
    /// `raster`.
    pub(crate) fn raster(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Spanned<RasterState>>> {
        let Shape::Parentheses = leaf.shape() else {
            self.reader.expected(leaf, "a raster state: `(cull_mode: Back, depth_bias: (constant: -1.0), …)`");
            return None;
        };
        let fields: RasterFields<'_> = self.reader.read(leaf, "a raster state")?;
        let cull_mode = self.optional_word(fields.cull_mode, "a cull mode", CullMode::NAMED);
        let front_face = self.optional_word(fields.front_face, "a front face", FrontFace::NAMED);
        let topology = self.optional_word(fields.topology, "a topology", PrimitiveTopology::NAMED);
        let depth_bias = optional(fields.depth_bias, |leaf| self.depth_bias(leaf));
        let depth_clamp = optional(fields.depth_clamp, |leaf| self.truth(leaf).map(FieldValue::alone));
        let line_width = optional(fields.line_width, |leaf| self.line_width(leaf));
        let constants = optional(fields.blend_constants, |leaf| self.blend_constants(leaf));
        let restart = optional(fields.primitive_restart, |leaf| self.truth(leaf).map(FieldValue::alone));
        let words = (cull_mode?, front_face?, topology?, restart?);
        let parts = (words, depth_bias?, depth_clamp?, line_width?, constants?);
        let state = combined(
            parts,
            |((cull_mode, front_face, topology, restart), depth_bias, depth_clamp, width, constants)| {
                let usual = RasterState::default();
                RasterState {
                    cull_mode,
                    front_face: front_face.unwrap_or(usual.front_face),
                    topology: topology.unwrap_or(usual.topology),
                    primitive_restart: restart.unwrap_or(usual.primitive_restart),
                    depth_bias,
                    depth_clamp: depth_clamp.unwrap_or(usual.depth_clamp),
                    line_width: width.unwrap_or(usual.line_width),
                    blend_constants: constants.unwrap_or(usual.blend_constants),
                }
            },
        );
        Some(at(leaf, state))
    }

    fn depth_bias(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<DepthBias>> {
        let Shape::Parentheses = leaf.shape() else {
            self.reader.expected(leaf, "a depth bias: `(constant: -1.0, slope: -2.0)`");
            return None;
        };
        let fields: DepthBiasFields<'_> = self.reader.read(leaf, "a depth bias")?;
        let numbers = [fields.constant, fields.slope, fields.clamp].map(|leaf| match leaf {
            Some(leaf) => self.real(leaf, "a depth bias"),
            None => Some(FieldValue::Constant(Real::ZERO)),
        });
        Some(combined(all(numbers)?, |[constant, slope, clamp]| DepthBias { constant, slope, clamp }))
    }

    fn line_width(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Real>> {
        self.number_because(leaf, "a line width")?.checked(self.reader, |number, _| match real(number.value) {
            Some(width) if number.value >= 1.0 => Ok(width),
            _ => Err(refused(&number, "a line width", "write 1 or more")),
        })
    }

    fn blend_constants(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<[Real; 4]>> {
        let parts: [Leaf<'_>; 4] = self.reader.read(leaf, "a colour `(red, green, blue, alpha)`")?;
        let parts = all(parts.map(|part| self.real(part, "a channel of a colour")))?;
        Some(combined(parts, |parts| parts))
    }

    /// A finite number of 32 bits.
    pub(super) fn real(&mut self, leaf: Leaf<'_>, what: &'static str) -> Option<FieldValue<Real>> {
        self.number_because(leaf, what)?.checked(self.reader, move |number, _| {
            real(number.value).ok_or_else(|| refused(&number, what, "32-bit floating point reaches about 3.4e38"))
        })
    }

    /// `blend`: a word, or factors and operations.
    pub(crate) fn blend(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<Spanned<Blend>>> {
        if !matches!(leaf.shape(), Shape::Parentheses) {
            return self.word(leaf, "a blend", &BLENDS).map(FieldValue::spanned);
        }
        let fields: BlendFields<'_> = self.reader.read(leaf, "a blend equation")?;
        let factor = |context: &mut Self, leaf| context.optional_word(leaf, "a blend factor", BlendFactor::NAMED);
        let operation = |context: &mut Self, leaf| context.optional_word(leaf, "a blend operation", BlendOp::NAMED);
        let color = (factor(self, Some(fields.src_color)), factor(self, Some(fields.dst_color)));
        let alpha = (factor(self, fields.src_alpha), factor(self, fields.dst_alpha));
        let operations = (operation(self, fields.color_op), operation(self, fields.alpha_op));
        let parts = (color.0?, color.1?, alpha.0?, alpha.1?, operations.0?, operations.1?);
        let blend = combined(parts, |(src_color, dst_color, src_alpha, dst_alpha, color_op, alpha_op)| {
            let [src_color, dst_color] = [src_color, dst_color].map(|factor| factor.unwrap_or(BlendFactor::One));
            let color_op = color_op.unwrap_or(BlendOp::Add);
            Blend::Equation(BlendEquation {
                src_color,
                dst_color,
                color_op,
                src_alpha: src_alpha.unwrap_or(src_color),
                dst_alpha: dst_alpha.unwrap_or(dst_color),
                alpha_op: alpha_op.unwrap_or(color_op),
            })
        });
        Some(at(leaf, blend))
    }

    /// `write_mask`: a truth for each channel.
    pub(crate) fn write_mask(&mut self, leaf: Leaf<'_>) -> Option<FieldValue<ColorComponents>> {
        let form = "the channels that are written: `(true, true, true, false)`";
        if !matches!(leaf.shape(), Shape::Parentheses) {
            self.reader.expected(leaf, form);
            return None;
        }
        let parts: [Leaf<'_>; 4] = self.reader.read(leaf, form)?;
        let parts = all(parts.map(|part| self.truth(part).map(FieldValue::alone)))?;
        Some(combined(parts, |written| {
            let channels = [ColorComponents::R, ColorComponents::G, ColorComponents::B, ColorComponents::A];
            let written = channels.into_iter().zip(written).filter(|(_, written)| *written);
            written.fold(ColorComponents::empty(), |all, (channel, _)| all | channel)
        }))
    }

    /// One of a few words in a field that may be left out.
    pub(super) fn optional_word<T: Copy + FieldContents>(
        &mut self,
        leaf: Option<Leaf<'_>>,
        what: &'static str,
        choices: &'static [(&'static str, T)],
    ) -> OptionalField<T> {
        optional(leaf, |leaf| self.word(leaf, what, choices).map(FieldValue::alone))
    }
}

/// A field that may be left out.
pub(super) fn optional<'src, T: FieldContents>(
    leaf: Option<Leaf<'src>>,
    read: impl FnOnce(Leaf<'src>) -> Option<FieldValue<T>>,
) -> OptionalField<T> {
    match leaf {
        Some(leaf) => Some(read(leaf)?.map(Some)),
        None => Some(FieldValue::Constant(None)),
    }
}

fn real(number: f64) -> Option<Real> {
    #[allow(clippy::cast_possible_truncation, reason = "the nearest number is meant")]
    let nearest = number as f32;
    Real::try_from(nearest).ok()
}

fn refused(number: &Decided<f64>, what: &str, help: &str) -> Diagnostic {
    let message = format!("{} is no {}", crate::base::shown_number(number.value), what.trim_start_matches("a "));
    Diagnostic::new(Code::NUMBER_OUTSIDE, number.span, message).remark(number.remark()).help(help)
}
