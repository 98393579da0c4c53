//! Compressed formats: blocks of texels that are stored together (Vulkan, "Compressed Image Formats").

use super::Format::{self, *};
use super::Numeric;

/// Width and height of the blocks of ASTC formats, in the order of Vulkan's numbers.
const ASTC_BLOCKS: [[u32; 2]; 14] = [
    [4, 4],
    [5, 4],
    [5, 5],
    [6, 5],
    [6, 6],
    [8, 5],
    [8, 6],
    [8, 8],
    [10, 5],
    [10, 6],
    [10, 8],
    [10, 10],
    [12, 10],
    [12, 12],
];

impl Format {
    /// Width and height in texels of what is stored together: 1 × 1, or a block of a compressed format. It takes
    /// [`Format::texel_bytes`].
    #[must_use]
    pub const fn block(self) -> [u32; 2] {
        match self.vulkan() {
            131..=156 => [4, 4],
            astc @ 157..=184 => ASTC_BLOCKS[(astc as usize - 157) / 2],
            _ => [1, 1],
        }
    }

    /// Whether texels are stored in blocks. Images of such formats are only sampled, and filled from outside of the frame.
    #[must_use]
    pub const fn is_compressed(self) -> bool {
        matches!(self.vulkan(), 131..=184)
    }

    /// Vulkan's name of the feature that a device has to have switched on for it; `None`: it needs none.
    #[must_use]
    pub const fn feature(self) -> Option<&'static str> {
        match self.vulkan() {
            131..=146 => Some("textureCompressionBC"),
            147..=156 => Some("textureCompressionETC2"),
            157..=184 => Some("textureCompressionASTC_LDR"),
            _ => None,
        }
    }

    /// The uncompressed format that holds the values of a compressed one, and that every device can sample; `None`: it isn't
    /// compressed.
    #[must_use]
    pub const fn decoded(self) -> Option<Format> {
        if !self.is_compressed() {
            return None;
        }
        Some(match (self, self.numeric()) {
            (BC4_UNORM_BLOCK, _) => R8_UNORM,
            (BC4_SNORM_BLOCK, _) => R8_SNORM,
            (BC5_UNORM_BLOCK, _) => R8G8_UNORM,
            (BC5_SNORM_BLOCK, _) => R8G8_SNORM,
            // Half precision holds 11 bits, and can be filtered everywhere.
            (EAC_R11_UNORM_BLOCK | EAC_R11_SNORM_BLOCK, _) => R16_SFLOAT,
            (EAC_R11G11_UNORM_BLOCK | EAC_R11G11_SNORM_BLOCK, _) => R16G16_SFLOAT,
            (BC6H_UFLOAT_BLOCK | BC6H_SFLOAT_BLOCK, _) => R16G16B16A16_SFLOAT,
            (_, Numeric::Srgb) => R8G8B8A8_SRGB,
            _ => R8G8B8A8_UNORM,
        })
    }

    /// Bytes of the texels of one layer of this width, height and depth, one sample each. Blocks at the edges are whole.
    #[must_use]
    pub fn bytes(self, [width, height, depth]: [u32; 3]) -> u64 {
        let [wide, high] = self.block();
        let sides = [width.div_ceil(wide), height.div_ceil(high), depth];
        sides.into_iter().fold(self.texel_bytes(), |bytes, side| bytes.saturating_mul(side.into()))
    }

    /// The format of the same texels whose colours are encoded with the sRGB curve, or with `is_srgb` false are linear; itself if there
    /// is none.
    #[must_use]
    pub fn with_srgb(self, is_srgb: bool) -> Format {
        let [from, to] = if is_srgb { ["_UNORM", "_SRGB"] } else { ["_SRGB", "_UNORM"] };
        Format::from_name(&self.name().replace(from, to)).unwrap_or(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_and_sizes_are_those_of_the_names() {
        for format in Format::ALL {
            let name = format.name();
            assert_eq!(format.is_compressed(), name.ends_with("_BLOCK"), "{name}");
            let said = name.strip_prefix("ASTC_").and_then(|rest| rest.split('_').next()).map(|block| {
                let mut sides = block.split('x').map(|side| side.parse().expect("a number"));
                [sides.next().expect("a width"), sides.next().expect("a height")]
            });
            let usual = if format.is_compressed() { [4, 4] } else { [1, 1] };
            assert_eq!(format.block(), said.unwrap_or(usual), "{name}");
            assert_eq!(format.bytes([format.block()[0], format.block()[1], 1]), format.texel_bytes());
            assert_eq!(format.feature().is_some(), format.is_compressed(), "{name}");
            assert!(format.decoded().is_none_or(|decoded| !decoded.is_compressed()), "{name}");
        }
        assert_eq!(BC1_RGBA_UNORM_BLOCK.bytes([5, 1, 1]), 16);
        assert_eq!(ASTC_6x5_UNORM_BLOCK.bytes([7, 6, 3]), 16 * 4 * 3);
        assert_eq!(R8G8B8A8_UNORM.bytes([5, 3, 2]), 120);
        assert_eq!(R32G32B32A32_SFLOAT.bytes([u32::MAX; 3]), u64::MAX);
    }

    #[test]
    fn a_format_has_its_other_encoding() {
        for format in Format::ALL {
            let [linear, srgb] = [false, true].map(|is_srgb| format.with_srgb(is_srgb));
            assert!([linear, srgb].contains(format), "{format}");
            assert_ne!(linear.numeric(), Numeric::Srgb, "{format}");
            let named = format.name().replace("SRGB", "UNORM");
            assert_eq!(linear.name(), named, "{format}");
            assert_eq!((linear.texel_bytes(), linear.block()), (srgb.texel_bytes(), srgb.block()), "{format}");
        }
    }
}
