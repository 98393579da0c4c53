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

            /// Bytes that one texel (one sample) takes.
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
    D16_UNORM = 124, 2 bytes, 1 x Unorm, DEPTH;
    X8_D24_UNORM_PACK32 = 125, 4 bytes, 1 x Unorm, DEPTH;
    D32_SFLOAT = 126, 4 bytes, 1 x Sfloat, DEPTH;
    D24_UNORM_S8_UINT = 129, 4 bytes, 1 x Unorm, DEPTH_STENCIL;
    D32_SFLOAT_S8_UINT = 130, 8 bytes, 1 x Sfloat, DEPTH_STENCIL;
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

    /// Bits of each component; of packed formats those of the widest.
    #[must_use]
    pub const fn component_bits(self) -> u32 {
        match self {
            Format::A2B10G10R10_UNORM_PACK32 => 10,
            Format::B10G11R11_UFLOAT_PACK32 => 11,
            Format::X8_D24_UNORM_PACK32 | Format::D24_UNORM_S8_UINT => 24,
            Format::D32_SFLOAT_S8_UINT => 32,
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

    /// Bytes that one texel takes where each plane is stored by itself.
    #[must_use]
    pub const fn least_texel_bytes(self) -> u64 {
        match self {
            Format::D24_UNORM_S8_UINT => 4,
            Format::D32_SFLOAT_S8_UINT => 5,
            other => other.texel_bytes(),
        }
    }

    /// Bytes that a texel of one plane takes in a buffer (Vulkan, "Copying Data Between Buffers and Images"); `None`: these
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
        let color = !self.is_depth() && !other.is_depth();
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
        for format in Format::ALL.iter().filter(|format| !format.is_depth() && format.texel_bytes() > 0) {
            let letters = format.name().split('_').next().unwrap_or_default();
            let count = letters.chars().filter(char::is_ascii_alphabetic).count();
            assert_eq!(format.components() as usize, count, "{format}");
        }
    }
}
