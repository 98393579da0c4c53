//! Materials and textures.

use framewright_graph::vulkan::Filter;
use std::sync::Arc;

/// How a surface looks.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name for people; need not be unique and may hold any character.
    pub name: String,
    /// Linear colour and alpha (not multiplied into the colour), each 0 to 1. Multiplies the texture.
    pub base_color: [f32; 4],
    /// Index into [`crate::scene::Scene::textures`].
    pub base_color_texture: Option<usize>,
    /// Light that the surface gives by itself, linear, strength multiplied in; at least 0, may exceed 1.
    pub emissive: [f32; 3],
    /// How alpha is used.
    pub alpha: AlphaMode,
    /// Whether back faces are drawn too, lit with the normal turned round.
    pub double_sided: bool,
}

/// How a material's alpha is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored: the surface is opaque.
    Opaque,
    /// Fragments below the cut-off are discarded.
    Mask {
        /// The cut-off, at least 0. Above 1 nothing is left.
        cutoff: f32,
    },
    /// Alpha is the surface's opacity.
    Blend,
}

/// A picture on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// Name for people; may hold any character.
    pub name: String,
    /// Texels in a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// `4 · width · height` bytes, top row first: sRGB-encoded red, green, blue, and linear alpha not multiplied in. Textures that
    /// show one picture share them.
    pub rgba8: Arc<[u8]>,
    /// How it is sampled.
    pub sampler: Sampler,
}

/// How a texture is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Beyond the left and right border.
    pub wrap_u: Wrap,
    /// Beyond the top and bottom border.
    pub wrap_v: Wrap,
    /// When a texel covers more than a pixel.
    pub magnify: Filter,
    /// When a pixel covers more than a texel.
    pub minify: Filter,
    /// Between mip levels; `None`: only the largest level is read.
    pub mip: Option<Filter>,
}

impl Default for Sampler {
    /// glTF's: repeated, smooth between texels and levels.
    fn default() -> Sampler {
        Sampler {
            wrap_u: Wrap::Repeat,
            wrap_v: Wrap::Repeat,
            magnify: Filter::Linear,
            minify: Filter::Linear,
            mip: Some(Filter::Linear),
        }
    }
}

/// The address mode beyond a texture's border (`VkSamplerAddressMode`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture again.
    Repeat,
    /// The texture again, every other time mirrored.
    MirroredRepeat,
    /// The border's own texels.
    ClampToEdge,
}
