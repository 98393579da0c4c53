//! Words of Vulkan for how triangles, lines and points become fragments, and how their colours meet old ones.

use bitflags::bitflags;
use serde::{Deserialize, Serialize};

bitflags! {
    /// Channels of a colour (`VkColorComponentFlagBits`).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct ColorComponents: u8 {
        /// Red.
        const R = 0x1;
        /// Green.
        const G = 0x2;
        /// Blue.
        const B = 0x4;
        /// Alpha.
        const A = 0x8;
    }
}

impl ColorComponents {
    /// Red, green, blue and alpha.
    pub const RGBA: ColorComponents = ColorComponents::all();

    /// The first `components` channels, in the order red, green, blue, alpha: those of a format with as many components.
    #[must_use]
    pub const fn first(components: u32) -> ColorComponents {
        match components {
            0 => ColorComponents::empty(),
            1 => ColorComponents::R,
            2 => ColorComponents::R.union(ColorComponents::G),
            3 => ColorComponents::R.union(ColorComponents::G).union(ColorComponents::B),
            _ => ColorComponents::RGBA,
        }
    }
}

impl Default for ColorComponents {
    /// All of them.
    fn default() -> ColorComponents {
        ColorComponents::RGBA
    }
}

/// Declares an enumeration of Vulkan's with its words: for each value Vulkan's name in files.
macro_rules! words {
    ($(#[$about:meta])* $name:ident { $($(#[doc = $doc:literal])* $value:ident,)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "SCREAMING_SNAKE_CASE")]
        pub enum $name {
            $($(#[doc = $doc])* $value,)*
        }

        impl $name {
            /// All of them, by the word that files have for each.
            pub(crate) const NAMED: &'static [(&'static str, $name)] = &[$((stringify!($value), $name::$value),)*];
        }
    };
}

pub(super) use words;

/// The faces of triangles that are left out (`VkCullModeFlagBits`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum CullMode {
    /// None.
    None,
    /// Front faces.
    Front,
    /// Back faces.
    Back,
    /// Both: no triangle is drawn.
    FrontAndBack,
}

impl CullMode {
    /// All of them, by the word that files have for each. `None` leaves a field out there.
    pub(crate) const NAMED: &'static [(&'static str, CullMode)] = &[
        ("Neither", CullMode::None),
        ("Front", CullMode::Front),
        ("Back", CullMode::Back),
        ("FrontAndBack", CullMode::FrontAndBack),
    ];
}

words! {
    /// The direction in which the vertices of a front face go round (`VkFrontFace`).
    FrontFace {
        /// Counter-clockwise.
        CounterClockwise,
        /// Clockwise.
        Clockwise,
    }
}

words! {
    /// What vertices make (`VkPrimitiveTopology`).
    PrimitiveTopology {
        /// A point each; the vertex shader says its size.
        PointList,
        /// A line of each two.
        LineList,
        /// A line from each to the next.
        LineStrip,
        /// A triangle of each three.
        TriangleList,
        /// A triangle of each with the two before it.
        TriangleStrip,
        /// A triangle of each with the one before it and the first.
        TriangleFan,
    }
}

impl FrontFace {
    /// The other one.
    #[must_use]
    pub const fn turned_over(self) -> FrontFace {
        match self {
            FrontFace::CounterClockwise => FrontFace::Clockwise,
            FrontFace::Clockwise => FrontFace::CounterClockwise,
        }
    }
}

impl PrimitiveTopology {
    /// Whether its primitives share vertices, so that an index can begin them anew.
    #[must_use]
    pub const fn is_joined(self) -> bool {
        match self {
            PrimitiveTopology::LineStrip | PrimitiveTopology::TriangleStrip | PrimitiveTopology::TriangleFan => true,
            PrimitiveTopology::PointList | PrimitiveTopology::LineList | PrimitiveTopology::TriangleList => false,
        }
    }

    /// Whether its primitives have faces.
    #[must_use]
    pub const fn has_faces(self) -> bool {
        match self {
            PrimitiveTopology::TriangleList | PrimitiveTopology::TriangleStrip | PrimitiveTopology::TriangleFan => true,
            PrimitiveTopology::PointList | PrimitiveTopology::LineList | PrimitiveTopology::LineStrip => false,
        }
    }
}

words! {
    /// A factor of a blend (`VkBlendFactor`).
    BlendFactor {
        /// 0.
        Zero,
        /// 1.
        One,
        /// The new colour.
        SrcColor,
        /// 1 − the new colour.
        OneMinusSrcColor,
        /// The old colour.
        DstColor,
        /// 1 − the old colour.
        OneMinusDstColor,
        /// The new alpha.
        SrcAlpha,
        /// 1 − the new alpha.
        OneMinusSrcAlpha,
        /// The old alpha.
        DstAlpha,
        /// 1 − the old alpha.
        OneMinusDstAlpha,
        /// The pass's constant colour.
        ConstantColor,
        /// 1 − the pass's constant colour.
        OneMinusConstantColor,
        /// The pass's constant alpha.
        ConstantAlpha,
        /// 1 − the pass's constant alpha.
        OneMinusConstantAlpha,
        /// The lesser of the new alpha and 1 − the old alpha; for alpha 1.
        SrcAlphaSaturate,
        /// The shader's second colour.
        Src1Color,
        /// 1 − the shader's second colour.
        OneMinusSrc1Color,
        /// The shader's second alpha.
        Src1Alpha,
        /// 1 − the shader's second alpha.
        OneMinusSrc1Alpha,
    }
}

impl BlendFactor {
    /// Whether it is one of the shader's second colour.
    #[must_use]
    pub const fn is_of_second_source(self) -> bool {
        use BlendFactor::{OneMinusSrc1Alpha, OneMinusSrc1Color, Src1Alpha, Src1Color};
        matches!(self, Src1Color | OneMinusSrc1Color | Src1Alpha | OneMinusSrc1Alpha)
    }
}

words! {
    /// What a blend makes of the new value times its factor and the old value times its factor (`VkBlendOp`).
    BlendOp {
        /// New + old.
        Add,
        /// New − old.
        Subtract,
        /// Old − new.
        ReverseSubtract,
        /// The lesser of both, without factors.
        Min,
        /// The greater of both, without factors.
        Max,
    }
}
