//! Raster state of a pass: how its primitives become fragments.

use super::Blend;
use crate::device::Limit;
use crate::vulkan::{BlendFactor, BlendOp, CullMode, FrontFace, PrimitiveTopology, Real};
use serde::{Deserialize, Serialize};

/// How the primitives of a pass become fragments (`VkPipelineRasterizationStateCreateInfo`). A field that is left out in text says
/// nothing special.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RasterState {
    /// The faces that are left out; `None`: what draws the pass says so, and leaves out none if it says nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cull_mode: Option<CullMode>,
    /// The direction of front faces. Objects that are mirrored have the other one.
    #[serde(skip_serializing_if = "is_usual")]
    pub front_face: FrontFace,
    /// What vertices make.
    #[serde(skip_serializing_if = "is_usual")]
    pub topology: PrimitiveTopology,
    /// Whether an index of all ones ends a strip or a fan, and begins another (`primitiveRestartEnable`).
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub primitive_restart: bool,
    /// What is added to depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_bias: Option<DepthBias>,
    /// Whether depth in front of the near plane and behind the far plane is moved onto the plane, and nothing is cut off there.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub depth_clamp: bool,
    /// How many texels wide lines are.
    #[serde(skip_serializing_if = "is_one")]
    pub line_width: Real,
    /// Red, green, blue and alpha for blends with constants.
    #[serde(skip_serializing_if = "are_zero")]
    pub blend_constants: [Real; 4],
}

impl Default for RasterState {
    fn default() -> RasterState {
        RasterState {
            cull_mode: None,
            front_face: FrontFace::CounterClockwise,
            topology: PrimitiveTopology::TriangleList,
            primitive_restart: false,
            depth_bias: None,
            depth_clamp: false,
            line_width: Real::ONE,
            blend_constants: [Real::ZERO; 4],
        }
    }
}

/// Something that has a usual value.
trait UsualValue: PartialEq {
    const USUAL: Self;
}

impl UsualValue for FrontFace {
    const USUAL: FrontFace = FrontFace::CounterClockwise;
}

impl UsualValue for PrimitiveTopology {
    const USUAL: PrimitiveTopology = PrimitiveTopology::TriangleList;
}

fn is_usual<T: UsualValue>(value: &T) -> bool {
    *value == T::USUAL
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands a field over so")]
fn is_one(number: &Real) -> bool {
    *number == Real::ONE
}

fn are_zero(numbers: &[Real; 4]) -> bool {
    numbers.iter().all(|number| number.is_zero())
}

/// What is added to the depth of fragments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthBias {
    /// Steps of depth that are added to all (`depthBiasConstantFactor`).
    pub constant: Real,
    /// How often the slope of depth is added (`depthBiasSlopeFactor`).
    pub slope: Real,
    /// The bound of what is added, from above or, if it is below 0, from below; 0: there is none (`depthBiasClamp`).
    pub clamp: Real,
}

impl RasterState {
    /// Whether it says nothing.
    #[must_use]
    pub fn is_usual(&self) -> bool {
        *self == RasterState::default()
    }

    /// The state without what is set while commands are recorded: two such states need one pipeline.
    #[must_use]
    pub fn of_pipeline(self) -> RasterState {
        let RasterState { cull_mode, front_face, .. } = RasterState::default();
        RasterState { cull_mode, front_face, ..self }
    }

    /// Whether it may leave out triangles by their faces.
    #[must_use]
    pub fn culls(&self) -> bool {
        self.topology.has_faces() && !matches!(self.cull_mode, None | Some(CullMode::None))
    }

    /// Whether no primitive becomes fragments.
    #[must_use]
    pub fn draws_nothing(&self) -> bool {
        self.topology.has_faces() && self.cull_mode == Some(CullMode::FrontAndBack)
    }

    /// The features that it needs, by Vulkan's names, each with what needs it.
    pub fn features(&self) -> impl Iterator<Item = (&'static str, &'static str)> + use<> {
        let bounded = self.depth_bias.is_some_and(|bias| !bias.clamp.is_zero());
        [
            (bounded, "depthBiasClamp", "a bound of the depth bias"),
            (self.depth_clamp, "depthClamp", "depth that is clamped"),
            (self.line_width != Real::ONE, "wideLines", "a line width other than 1"),
            (self.topology == PrimitiveTopology::PointList, "largePoints", "points of a size"),
        ]
        .into_iter()
        .filter_map(|(needed, feature, what)| needed.then_some((feature, what)))
    }

    /// The limits that it needs, each with its value, and what has that value.
    pub fn limits(&self) -> impl Iterator<Item = (Limit, f32, &'static str)> + use<> {
        [(Limit::LineWidth, f32::from(self.line_width), "the line width")].into_iter()
    }
}

/// How new colour and alpha meet old ones (`VkPipelineColorBlendAttachmentState`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlendEquation {
    /// The factor of the new colour.
    pub src_color: BlendFactor,
    /// The factor of the old colour.
    pub dst_color: BlendFactor,
    /// What is made of both.
    pub color_op: BlendOp,
    /// The factor of the new alpha.
    pub src_alpha: BlendFactor,
    /// The factor of the old alpha.
    pub dst_alpha: BlendFactor,
    /// What is made of both.
    pub alpha_op: BlendOp,
}

impl Blend {
    /// Factors and operations; `None`: new replaces old, and no blending is switched on. Alpha blends like colour, with its own new
    /// value taken whole.
    #[must_use]
    pub const fn equation(self) -> Option<BlendEquation> {
        use BlendFactor::{One, OneMinusSrcAlpha, SrcAlpha};
        let [src_color, dst_color, src_alpha, dst_alpha] = match self {
            Blend::Replace => return None,
            Blend::Alpha => [SrcAlpha, OneMinusSrcAlpha, One, OneMinusSrcAlpha],
            Blend::Premultiplied => [One, OneMinusSrcAlpha, One, OneMinusSrcAlpha],
            Blend::Additive => [One, One, One, One],
            Blend::Equation(equation) => return Some(equation),
        };
        let (color_op, alpha_op) = (BlendOp::Add, BlendOp::Add);
        Some(BlendEquation { src_color, dst_color, color_op, src_alpha, dst_alpha, alpha_op })
    }

    /// Whether it takes the shader's second colour.
    #[must_use]
    pub fn takes_second_source(self) -> bool {
        self.equation().is_some_and(|it| {
            [it.src_color, it.dst_color, it.src_alpha, it.dst_alpha].into_iter().any(BlendFactor::is_of_second_source)
        })
    }

    /// The feature that it needs, by Vulkan's name, with what needs it.
    #[must_use]
    pub fn feature(self) -> Option<(&'static str, &'static str)> {
        self.takes_second_source().then_some(("dualSrcBlend", "a blend with the shader's second colour"))
    }
}

impl std::fmt::Display for Blend {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        use crate::vulkan::name_of;
        let named = match self {
            Blend::Replace => "replace",
            Blend::Alpha => "alpha",
            Blend::Premultiplied => "premultiplied",
            Blend::Additive => "additive",
            Blend::Equation(BlendEquation { src_color, dst_color, color_op, src_alpha, dst_alpha, alpha_op }) => {
                let side = |src, op, dst| format!("{} × new {} {} × old", name_of(src), name_of(op), name_of(dst));
                let color = side(src_color, color_op, dst_color);
                let alpha = side(src_alpha, alpha_op, dst_alpha);
                return if (src_color, dst_color, color_op) == (src_alpha, dst_alpha, alpha_op) {
                    write!(f, "by {color}")
                } else {
                    write!(f, "by {color}, alpha by {alpha}")
                };
            }
        };
        f.write_str(named)
    }
}

/// The state in words, without what is usual: `cull mode FRONT, depth bias 1 + 2 × slope`.
impl std::fmt::Display for RasterState {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        use crate::vulkan::name_of;
        let mut words: Vec<String> = Vec::new();
        words.extend(self.cull_mode.iter().map(|mode| format!("cull mode {}", name_of(mode))));
        words.extend((!is_usual(&self.front_face)).then(|| format!("front face {}", name_of(&self.front_face))));
        words.extend((!is_usual(&self.topology)).then(|| format!("topology {}", name_of(&self.topology))));
        words.extend(self.primitive_restart.then(|| "primitive restart".to_owned()));
        words.extend(self.depth_bias.iter().map(|bias| {
            let [constant, slope, clamp] = [bias.constant, bias.slope, bias.clamp].map(f32::from);
            let bound = if bias.clamp.is_zero() { String::new() } else { format!(" up to {clamp}") };
            format!("depth bias {constant} + {slope} × slope{bound}")
        }));
        words.extend(self.depth_clamp.then(|| "depth clamp".to_owned()));
        words.extend((!is_one(&self.line_width)).then(|| format!("line width {}", f32::from(self.line_width))));
        if !are_zero(&self.blend_constants) {
            let [red, green, blue, alpha] = self.blend_constants.map(f32::from);
            words.push(format!("blend constants ({red}, {green}, {blue}, {alpha})"));
        }
        f.write_str(&words.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_lines_have_no_faces_to_be_culled() {
        let all = RasterState { cull_mode: Some(CullMode::FrontAndBack), ..RasterState::default() };
        assert!(all.culls() && all.draws_nothing());
        let lines = RasterState { topology: PrimitiveTopology::LineStrip, ..all };
        assert!(!lines.culls() && !lines.draws_nothing());
    }
}
