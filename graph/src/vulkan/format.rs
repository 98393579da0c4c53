//! Texel formats by Vulkan's names, and properties that follow from a name alone.

use super::{Aspects, Component};
use serde::{Deserialize, Serialize};

/// How a component's bits are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Numeric {
    /// Floating point.
    Sfloat,
    /// Unsigned floating point.
    Ufloat,
    /// 0…1 in equal steps.
    Unorm,
    /// 0…1, encoded with the sRGB curve.
    Srgb,
    /// −1…1 in equal steps.
    Snorm,
    /// Unsigned integers.
    Uint,
    /// Signed integers.
    Sint,
}

macro_rules! formats {
    ($($name:ident = $vulkan:literal, $bytes:literal bytes, $components:literal x $numeric:ident, $aspects:expr;)*) => {
        /// A texel format (`VkFormat`, without its prefix).
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[allow(non_camel_case_types, reason = "the names are Vulkan's")]
        pub enum Format { $(#[doc = concat!("`VK_FORMAT_", stringify!($name), "`")] $name,)* }

        impl Format {
            /// Every format that a Plan can hold.
            pub const ALL: &[Format] = &[$(Format::$name,)*];

            /// Vulkan's name, without `VK_FORMAT_`.
            #[must_use]
            pub const fn name(self) -> &'static str { match self { $(Format::$name => stringify!($name),)* } }

            /// The value of the `VkFormat` enumerant.
            #[must_use]
            pub const fn vulkan(self) -> i32 { match self { $(Format::$name => $vulkan,)* } }

            /// Bytes that one texel (one sample) takes; of a compressed format a [block](Format::block).
            #[must_use]
            pub const fn texel_bytes(self) -> u64 { match self { $(Format::$name => $bytes,)* } }

            /// Number of components.
            #[must_use]
            pub const fn components(self) -> u32 { match self { $(Format::$name => $components,)* } }

            /// How components are read (for depth-stencil formats: the depth).
            #[must_use]
            pub const fn numeric(self) -> Numeric { match self { $(Format::$name => Numeric::$numeric,)* } }

            /// The planes it has.
            #[must_use]
            pub const fn aspects(self) -> Aspects { match self { $(Format::$name => $aspects,)* } }
        }
    };
}

const COLOR: Aspects = Aspects::COLOR;
const DEPTH: Aspects = Aspects::DEPTH;
const DEPTH_STENCIL: Aspects = Aspects::DEPTH.union(Aspects::STENCIL);

formats! {
    R8_UNORM = 9, 1 bytes, 1 x Unorm, COLOR;
    R8_SNORM = 10, 1 bytes, 1 x Snorm, COLOR;
    R8_UINT = 13, 1 bytes, 1 x Uint, COLOR;
    R8_SINT = 14, 1 bytes, 1 x Sint, COLOR;
    R8G8_UNORM = 16, 2 bytes, 2 x Unorm, COLOR;
    R8G8_SNORM = 17, 2 bytes, 2 x Snorm, COLOR;
    R8G8_UINT = 20, 2 bytes, 2 x Uint, COLOR;
    R8G8_SINT = 21, 2 bytes, 2 x Sint, COLOR;
    R8G8B8A8_UNORM = 37, 4 bytes, 4 x Unorm, COLOR;
    R8G8B8A8_SNORM = 38, 4 bytes, 4 x Snorm, COLOR;
    R8G8B8A8_UINT = 41, 4 bytes, 4 x Uint, COLOR;
    R8G8B8A8_SINT = 42, 4 bytes, 4 x Sint, COLOR;
    R8G8B8A8_SRGB = 43, 4 bytes, 4 x Srgb, COLOR;
    B8G8R8A8_UNORM = 44, 4 bytes, 4 x Unorm, COLOR;
    B8G8R8A8_SRGB = 50, 4 bytes, 4 x Srgb, COLOR;
    A2R10G10B10_UNORM_PACK32 = 58, 4 bytes, 4 x Unorm, COLOR;
    A2B10G10R10_UNORM_PACK32 = 64, 4 bytes, 4 x Unorm, COLOR;
    R16_UNORM = 70, 2 bytes, 1 x Unorm, COLOR;
    R16_SNORM = 71, 2 bytes, 1 x Snorm, COLOR;
    R16_UINT = 74, 2 bytes, 1 x Uint, COLOR;
    R16_SINT = 75, 2 bytes, 1 x Sint, COLOR;
    R16_SFLOAT = 76, 2 bytes, 1 x Sfloat, COLOR;
    R16G16_UNORM = 77, 4 bytes, 2 x Unorm, COLOR;
    R16G16_SNORM = 78, 4 bytes, 2 x Snorm, COLOR;
    R16G16_UINT = 81, 4 bytes, 2 x Uint, COLOR;
    R16G16_SINT = 82, 4 bytes, 2 x Sint, COLOR;
    R16G16_SFLOAT = 83, 4 bytes, 2 x Sfloat, COLOR;
    R16G16B16A16_UNORM = 91, 8 bytes, 4 x Unorm, COLOR;
    R16G16B16A16_SNORM = 92, 8 bytes, 4 x Snorm, COLOR;
    R16G16B16A16_UINT = 95, 8 bytes, 4 x Uint, COLOR;
    R16G16B16A16_SINT = 96, 8 bytes, 4 x Sint, COLOR;
    R16G16B16A16_SFLOAT = 97, 8 bytes, 4 x Sfloat, COLOR;
    R32_UINT = 98, 4 bytes, 1 x Uint, COLOR;
    R32_SINT = 99, 4 bytes, 1 x Sint, COLOR;
    R32_SFLOAT = 100, 4 bytes, 1 x Sfloat, COLOR;
    R32G32_UINT = 101, 8 bytes, 2 x Uint, COLOR;
    R32G32_SINT = 102, 8 bytes, 2 x Sint, COLOR;
    R32G32_SFLOAT = 103, 8 bytes, 2 x Sfloat, COLOR;
    R32G32B32A32_UINT = 107, 16 bytes, 4 x Uint, COLOR;
    R32G32B32A32_SINT = 108, 16 bytes, 4 x Sint, COLOR;
    R32G32B32A32_SFLOAT = 109, 16 bytes, 4 x Sfloat, COLOR;
    B10G11R11_UFLOAT_PACK32 = 122, 4 bytes, 3 x Ufloat, COLOR;
    E5B9G9R9_UFLOAT_PACK32 = 123, 4 bytes, 3 x Ufloat, COLOR;
    D16_UNORM = 124, 2 bytes, 1 x Unorm, DEPTH;
    X8_D24_UNORM_PACK32 = 125, 4 bytes, 1 x Unorm, DEPTH;
    D32_SFLOAT = 126, 4 bytes, 1 x Sfloat, DEPTH;
    D24_UNORM_S8_UINT = 129, 4 bytes, 1 x Unorm, DEPTH_STENCIL;
    D32_SFLOAT_S8_UINT = 130, 8 bytes, 1 x Sfloat, DEPTH_STENCIL;
    BC1_RGB_UNORM_BLOCK = 131, 8 bytes, 3 x Unorm, COLOR;
    BC1_RGB_SRGB_BLOCK = 132, 8 bytes, 3 x Srgb, COLOR;
    BC1_RGBA_UNORM_BLOCK = 133, 8 bytes, 4 x Unorm, COLOR;
    BC1_RGBA_SRGB_BLOCK = 134, 8 bytes, 4 x Srgb, COLOR;
    BC2_UNORM_BLOCK = 135, 16 bytes, 4 x Unorm, COLOR;
    BC2_SRGB_BLOCK = 136, 16 bytes, 4 x Srgb, COLOR;
    BC3_UNORM_BLOCK = 137, 16 bytes, 4 x Unorm, COLOR;
    BC3_SRGB_BLOCK = 138, 16 bytes, 4 x Srgb, COLOR;
    BC4_UNORM_BLOCK = 139, 8 bytes, 1 x Unorm, COLOR;
    BC4_SNORM_BLOCK = 140, 8 bytes, 1 x Snorm, COLOR;
    BC5_UNORM_BLOCK = 141, 16 bytes, 2 x Unorm, COLOR;
    BC5_SNORM_BLOCK = 142, 16 bytes, 2 x Snorm, COLOR;
    BC6H_UFLOAT_BLOCK = 143, 16 bytes, 3 x Ufloat, COLOR;
    BC6H_SFLOAT_BLOCK = 144, 16 bytes, 3 x Sfloat, COLOR;
    BC7_UNORM_BLOCK = 145, 16 bytes, 4 x Unorm, COLOR;
    BC7_SRGB_BLOCK = 146, 16 bytes, 4 x Srgb, COLOR;
    ETC2_R8G8B8_UNORM_BLOCK = 147, 8 bytes, 3 x Unorm, COLOR;
    ETC2_R8G8B8_SRGB_BLOCK = 148, 8 bytes, 3 x Srgb, COLOR;
    ETC2_R8G8B8A1_UNORM_BLOCK = 149, 8 bytes, 4 x Unorm, COLOR;
    ETC2_R8G8B8A1_SRGB_BLOCK = 150, 8 bytes, 4 x Srgb, COLOR;
    ETC2_R8G8B8A8_UNORM_BLOCK = 151, 16 bytes, 4 x Unorm, COLOR;
    ETC2_R8G8B8A8_SRGB_BLOCK = 152, 16 bytes, 4 x Srgb, COLOR;
    EAC_R11_UNORM_BLOCK = 153, 8 bytes, 1 x Unorm, COLOR;
    EAC_R11_SNORM_BLOCK = 154, 8 bytes, 1 x Snorm, COLOR;
    EAC_R11G11_UNORM_BLOCK = 155, 16 bytes, 2 x Unorm, COLOR;
    EAC_R11G11_SNORM_BLOCK = 156, 16 bytes, 2 x Snorm, COLOR;
    ASTC_4x4_UNORM_BLOCK = 157, 16 bytes, 4 x Unorm, COLOR;
    ASTC_4x4_SRGB_BLOCK = 158, 16 bytes, 4 x Srgb, COLOR;
    ASTC_5x4_UNORM_BLOCK = 159, 16 bytes, 4 x Unorm, COLOR;
    ASTC_5x4_SRGB_BLOCK = 160, 16 bytes, 4 x Srgb, COLOR;
    ASTC_5x5_UNORM_BLOCK = 161, 16 bytes, 4 x Unorm, COLOR;
    ASTC_5x5_SRGB_BLOCK = 162, 16 bytes, 4 x Srgb, COLOR;
    ASTC_6x5_UNORM_BLOCK = 163, 16 bytes, 4 x Unorm, COLOR;
    ASTC_6x5_SRGB_BLOCK = 164, 16 bytes, 4 x Srgb, COLOR;
    ASTC_6x6_UNORM_BLOCK = 165, 16 bytes, 4 x Unorm, COLOR;
    ASTC_6x6_SRGB_BLOCK = 166, 16 bytes, 4 x Srgb, COLOR;
    ASTC_8x5_UNORM_BLOCK = 167, 16 bytes, 4 x Unorm, COLOR;
    ASTC_8x5_SRGB_BLOCK = 168, 16 bytes, 4 x Srgb, COLOR;
    ASTC_8x6_UNORM_BLOCK = 169, 16 bytes, 4 x Unorm, COLOR;
    ASTC_8x6_SRGB_BLOCK = 170, 16 bytes, 4 x Srgb, COLOR;
    ASTC_8x8_UNORM_BLOCK = 171, 16 bytes, 4 x Unorm, COLOR;
    ASTC_8x8_SRGB_BLOCK = 172, 16 bytes, 4 x Srgb, COLOR;
    ASTC_10x5_UNORM_BLOCK = 173, 16 bytes, 4 x Unorm, COLOR;
    ASTC_10x5_SRGB_BLOCK = 174, 16 bytes, 4 x Srgb, COLOR;
    ASTC_10x6_UNORM_BLOCK = 175, 16 bytes, 4 x Unorm, COLOR;
    ASTC_10x6_SRGB_BLOCK = 176, 16 bytes, 4 x Srgb, COLOR;
    ASTC_10x8_UNORM_BLOCK = 177, 16 bytes, 4 x Unorm, COLOR;
    ASTC_10x8_SRGB_BLOCK = 178, 16 bytes, 4 x Srgb, COLOR;
    ASTC_10x10_UNORM_BLOCK = 179, 16 bytes, 4 x Unorm, COLOR;
    ASTC_10x10_SRGB_BLOCK = 180, 16 bytes, 4 x Srgb, COLOR;
    ASTC_12x10_UNORM_BLOCK = 181, 16 bytes, 4 x Unorm, COLOR;
    ASTC_12x10_SRGB_BLOCK = 182, 16 bytes, 4 x Srgb, COLOR;
    ASTC_12x12_UNORM_BLOCK = 183, 16 bytes, 4 x Unorm, COLOR;
    ASTC_12x12_SRGB_BLOCK = 184, 16 bytes, 4 x Srgb, COLOR;
}

impl Format {
    /// Whether it holds depth.
    #[must_use]
    pub const fn is_depth(self) -> bool {
        self.aspects().contains(Aspects::DEPTH)
    }

    /// Whether components are integers: such images can't be filtered, blended or averaged.
    #[must_use]
    pub const fn is_integer(self) -> bool {
        matches!(self.numeric(), Numeric::Uint | Numeric::Sint)
    }

    /// Bits of each component; of packed formats those of the widest, of compressed ones those of what they decode to.
    #[must_use]
    pub const fn component_bits(self) -> u32 {
        match self {
            Format::A2R10G10B10_UNORM_PACK32 | Format::A2B10G10R10_UNORM_PACK32 => 10,
            Format::B10G11R11_UFLOAT_PACK32 => 11,
            // The exponent is shared.
            Format::E5B9G9R9_UFLOAT_PACK32 => 14,
            Format::X8_D24_UNORM_PACK32 | Format::D24_UNORM_S8_UINT => 24,
            Format::D32_SFLOAT_S8_UINT => 32,
            Format::BC6H_UFLOAT_BLOCK | Format::BC6H_SFLOAT_BLOCK => 16,
            Format::EAC_R11_UNORM_BLOCK | Format::EAC_R11_SNORM_BLOCK => 11,
            Format::EAC_R11G11_UNORM_BLOCK | Format::EAC_R11G11_SNORM_BLOCK => 11,
            compressed if compressed.is_compressed() => 8,
            other => other.texel_bytes() as u32 * 8 / other.components(),
        }
    }

    /// The least and the greatest number that a component holds: 0 is red, or depth.
    #[must_use]
    pub fn component_range(self, component: usize) -> [f64; 2] {
        let bits = self.component_bits().cast_signed();
        match self.numeric() {
            Numeric::Unorm | Numeric::Srgb => [0.0, 1.0],
            Numeric::Snorm => [-1.0, 1.0],
            Numeric::Uint => [0.0, 2_f64.powi(bits) - 1.0],
            Numeric::Sint => [-2_f64.powi(bits - 1), 2_f64.powi(bits - 1) - 1.0],
            // Vulkan, "16-Bit Floating-Point Numbers" and "Unsigned 11-Bit" and "10-Bit Floating-Point Numbers".
            Numeric::Sfloat if bits == 16 => [-65504.0, 65504.0],
            Numeric::Sfloat => [f32::MIN.into(), f32::MAX.into()],
            Numeric::Ufloat if self == Format::E5B9G9R9_UFLOAT_PACK32 => [0.0, 65408.0],
            Numeric::Ufloat if bits == 16 => [0.0, 65504.0],
            Numeric::Ufloat => [0.0, if component == 2 { 64512.0 } else { 65024.0 }],
        }
    }

    /// The first of these components that the format doesn't hold: it lies outside of the range, or is no whole number and must
    /// be one. Components that the format doesn't have are judged alike.
    #[must_use]
    pub fn lacks(self, components: [f64; 4]) -> Option<usize> {
        let single = |number: f64| {
            #[allow(clippy::cast_possible_truncation, reason = "no format holds more than 32 bits of floating point")]
            let single = number as f32;
            f64::from(single)
        };
        let holds = |(at, number): (usize, f64)| {
            let [least, most] = self.component_range(at);
            match self.is_integer() {
                true => number.fract() == 0.0 && (least..=most).contains(&number),
                false => (least..=most).contains(&single(number)),
            }
        };
        components.into_iter().enumerate().position(|component| !holds(component))
    }

    /// Words of 32 bits as the integers that they are in this format.
    #[must_use]
    pub fn integers(self, words: [u32; 4]) -> [f64; 4] {
        words.map(|word| if self.numeric() == Numeric::Sint { word.cast_signed().into() } else { word.into() })
    }

    /// Bytes that texels of this width and height take where each plane is stored by itself.
    #[must_use]
    pub fn least_bytes(self, [width, height]: [u32; 2]) -> u64 {
        let texels = u64::from(width) * u64::from(height);
        match self {
            Format::D24_UNORM_S8_UINT => 4 * texels,
            Format::D32_SFLOAT_S8_UINT => 5 * texels,
            other => other.bytes([width, height, 1]),
        }
    }

    /// Bytes that a texel, or block, of one plane takes in a buffer (Vulkan, "Copying Data Between Buffers and Images"); `None`: these
    /// are several planes.
    #[must_use]
    pub fn plane_bytes(self, plane: Aspects) -> Option<u64> {
        match plane {
            _ if plane == Aspects::STENCIL => Some(1),
            _ if plane == Aspects::DEPTH && self == Format::D16_UNORM => Some(2),
            _ if plane == Aspects::DEPTH => Some(4),
            _ => (plane == COLOR).then(|| self.texel_bytes()),
        }
    }

    /// Whether a copy may take texels over into an image of another format, bit for bit.
    #[must_use]
    pub fn copies_to(self, other: Format) -> bool {
        let color = !self.is_depth() && !other.is_depth() && self.block() == other.block();
        self == other || color && self.texel_bytes() == other.texel_bytes()
    }

    /// Whether a blit may convert texels into those of another format.
    #[must_use]
    pub fn blits_to(self, other: Format) -> bool {
        let color = !self.is_depth() && !other.is_depth();
        self == other || color && Component::of(self) == Component::of(other)
    }

    /// The format with Vulkan's name `name`.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Format> {
        Format::ALL.iter().copied().find(|format| format.name() == name)
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::Format::{self, *};

    #[test]
    fn a_blit_keeps_the_kind_of_components() {
        for (from, to, blits) in [
            (R16_UNORM, R8G8B8A8_SNORM, true),
            (R32_UINT, R8_UINT, true),
            (R16_SINT, R32G32_SINT, true),
            (R32_UINT, R32_SINT, false),
            (R8_SINT, R8_SNORM, false),
            (D32_SFLOAT, R32_SFLOAT, false),
            (D32_SFLOAT, D32_SFLOAT, true),
        ] {
            assert_eq!((from.blits_to(to), to.blits_to(from)), (blits, blits), "{from} and {to}");
        }
    }

    #[test]
    fn formats_are_listed_by_vulkans_numbers_each_once() {
        assert!(Format::ALL.is_sorted_by_key(|format| format.vulkan()));
        for format in Format::ALL.iter().filter(|format| !format.is_depth() && !format.is_compressed()) {
            let letters = format.name().split('_').next().unwrap_or_default();
            let count = letters.chars().filter(|letter| "RGBA".contains(*letter)).count();
            assert_eq!(format.components() as usize, count, "{format}");
        }
    }
}
