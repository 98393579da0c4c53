//! How sampled images are looked up.

use super::raster::words;
use super::{CompareOp, Filter, Format, Numeric, Real};
use serde::{Deserialize, Serialize};

/// The texels of a sampled image beyond its edges (`VkSamplerAddressMode`), on every axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum AddressMode {
    /// The texels at the edge.
    #[default]
    ClampToEdge,
    /// The image again.
    Repeat,
    /// The image mirrored.
    MirroredRepeat,
    /// A colour.
    ClampToBorder,
    /// The image mirrored once, and then the texels at its edge.
    MirrorClampToEdge,
}

words! {
    /// The colour of texels beyond the edges (`VkBorderColor`).
    BorderColor {
        /// 0 each.
        FloatTransparentBlack,
        /// 0 each, of integers.
        IntTransparentBlack,
        /// 0, and alpha 1.
        FloatOpaqueBlack,
        /// 0, and alpha 1, of integers.
        IntOpaqueBlack,
        /// 1 each.
        FloatOpaqueWhite,
        /// 1 each, of integers.
        IntOpaqueWhite,
    }
}

impl BorderColor {
    /// Whether it is one of integers.
    #[must_use]
    pub const fn is_of_integers(self) -> bool {
        use BorderColor::{IntOpaqueBlack, IntOpaqueWhite, IntTransparentBlack};
        matches!(self, IntTransparentBlack | IntOpaqueBlack | IntOpaqueWhite)
    }

    /// Whether texels of a format can have it.
    #[must_use]
    pub const fn fits(self, format: Format) -> bool {
        self.is_of_integers() == matches!(format.numeric(), Numeric::Uint | Numeric::Sint)
    }

    /// 0 each, for a format.
    #[must_use]
    pub const fn transparent(format: Format) -> BorderColor {
        match format.numeric() {
            Numeric::Uint | Numeric::Sint => BorderColor::IntTransparentBlack,
            _ => BorderColor::FloatTransparentBlack,
        }
    }
}

/// What a linear filter makes of the texels around (`VkSamplerReductionMode`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum SamplerReductionMode {
    /// Their weighted mean.
    #[default]
    WeightedAverage,
    /// The least of each channel.
    Min,
    /// The greatest of each channel.
    Max,
}

impl SamplerReductionMode {
    /// All of them, by the word that files have for each.
    pub(crate) const NAMED: &'static [(&'static str, SamplerReductionMode)] = &[
        ("WeightedAverage", SamplerReductionMode::WeightedAverage),
        ("Min", SamplerReductionMode::Min),
        ("Max", SamplerReductionMode::Max),
    ];

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands a field over so")]
    fn is_mean(&self) -> bool {
        *self == SamplerReductionMode::WeightedAverage
    }
}

/// How a sampled image is looked up (`VkSamplerCreateInfo`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sampler {
    /// Filter between texels, enlarged and reduced.
    pub filter: Filter,
    /// Filter between mip levels.
    pub mips: Filter,
    /// The texels beyond the edges.
    pub address: AddressMode,
    /// How a depth that the shader gives is compared with those that are sampled; `None`: the shader is given those.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compare: Option<CompareOp>,
    /// The colour beyond the edges, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub border: Option<BorderColor>,
    /// What a linear filter makes of the texels around.
    #[serde(default, skip_serializing_if = "SamplerReductionMode::is_mean")]
    pub reduction: SamplerReductionMode,
    /// Up to how many samples along the direction in which the image is seen at a slant; 1: none beside the filter's.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub anisotropy: u32,
    /// What is added to the mip level.
    #[serde(default, skip_serializing_if = "Real::is_zero")]
    pub lod_bias: Real,
    /// The least mip level, from the first one that is sampled.
    #[serde(default, skip_serializing_if = "Real::is_zero")]
    pub min_lod: Real,
    /// The greatest mip level; `None`: the last.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_lod: Option<Real>,
}

const fn one() -> u32 {
    1
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde hands a field over so")]
const fn is_one(number: &u32) -> bool {
    *number == 1
}

impl Sampler {
    /// A sampler that ends at the image's edges and takes the nearest mip level.
    #[must_use]
    pub const fn new(filter: Filter) -> Sampler {
        Sampler {
            filter,
            mips: Filter::Nearest,
            address: AddressMode::ClampToEdge,
            compare: None,
            border: None,
            reduction: SamplerReductionMode::WeightedAverage,
            anisotropy: 1,
            lod_bias: Real::ZERO,
            min_lod: Real::ZERO,
            max_lod: None,
        }
    }

    /// The same, for a shader that compares depths, or doesn't.
    #[must_use]
    pub const fn comparing(self, compares: bool) -> Sampler {
        Sampler { compare: if compares { self.compare } else { None }, ..self }
    }

    /// Whether it takes means of texels, which not every format allows.
    #[must_use]
    pub const fn is_linear(&self) -> bool {
        matches!(self.filter, Filter::Linear) || matches!(self.mips, Filter::Linear)
    }

    /// Whether it takes the least or the greatest of texels, which not every format allows.
    #[must_use]
    pub const fn reduces(&self) -> bool {
        matches!(self.reduction, SamplerReductionMode::Min | SamplerReductionMode::Max)
    }

    /// Whether it may take texels beyond those that a shader's own bounds on places leave out.
    #[must_use]
    pub fn reaches_out(&self) -> bool {
        self.address != AddressMode::ClampToEdge
            || self.anisotropy > 1
            || !self.lod_bias.is_zero()
            || !self.min_lod.is_zero()
    }

    /// The features that it needs, by Vulkan's names, each with what needs it.
    pub fn features(&self) -> impl Iterator<Item = (&'static str, &'static str)> + use<> {
        [
            (self.reduces(), "samplerFilterMinmax", "the least or greatest of texels"),
            (self.anisotropy > 1, "samplerAnisotropy", "anisotropy"),
            (
                self.address == AddressMode::MirrorClampToEdge,
                "samplerMirrorClampToEdge",
                "an image that is mirrored once",
            ),
        ]
        .into_iter()
        .filter_map(|(needed, feature, what)| needed.then_some((feature, what)))
    }

    /// Why no device has such a sampler for an image of a format, in words.
    #[must_use]
    pub fn mistake(&self, format: Format) -> Option<&'static str> {
        let [least, greatest] = [Some(self.min_lod), self.max_lod].map(|lod| lod.map(f32::from));
        // Vulkan's VK_LOD_CLAMP_NONE, which stands for no bound.
        let greatest = greatest.or(Some(1000.0));
        match () {
            () if self.border.is_some_and(|border| !border.fits(format)) => Some(
                "its border is of another kind than its texels: integers need an integer border, others a float border",
            ),
            () if (self.address == AddressMode::ClampToBorder) != self.border.is_some() => {
                Some("it has a border colour without the address mode `Border`, or that mode without a border colour")
            }
            () if self.reduces() && self.compare.is_some() => {
                Some("it compares and reduces: only one of both is possible")
            }
            () if self.anisotropy > 1 && self.filter == Filter::Nearest => {
                Some("it is anisotropic, and its filter isn't linear")
            }
            () if greatest.is_some_and(|greatest| least.is_some_and(|least| least > greatest)) => {
                Some("its least level of detail lies above its greatest")
            }
            () if least.is_some_and(|least| least < 0.0) => Some("its least level of detail lies below 0"),
            () => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_are_of_the_kind_of_the_image() {
        for (_, border) in BorderColor::NAMED {
            assert_eq!(border.fits(Format::R8_UINT), border.is_of_integers());
            assert_eq!(border.fits(Format::D32_SFLOAT), !border.is_of_integers());
        }
        assert!(BorderColor::transparent(Format::R8_SINT).fits(Format::R8_SINT));
    }
}
