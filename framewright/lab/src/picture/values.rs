//! The numbers of an image's texels.

use super::texel;
use framewright_graph::vulkan::Format;
use framewright_passes::srgb;
use half::f16;

/// Red, green, blue and alpha of one texel: light of sRGB formats is decoded, depth and single components are in the first, and
/// integers are as they are. A component that the format lacks is 0, alpha 1.
pub fn values(format: Format, texel: &[u8]) -> [f32; 4] {
    use Format as F;
    let half = |at: usize| f16::from_ne_bytes([texel[at], texel[at + 1]]).to_f32();
    let word = |at: usize| u32::from_ne_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]]);
    let float = |at: usize| f32::from_bits(word(at));
    let unorm = |byte: u8| f32::from(byte) / 255.0;
    let light = |byte: u8| srgb::decode(f64::from(unorm(byte))) as f32;
    let share = |shift: u32, bits: u32| {
        let most = (1_u32 << bits) - 1;
        ((word(0) >> shift) & most) as f32 / most as f32
    };
    let small = |shift: u32, bits: u32| f16::from_bits(texel::cut(word(0), shift, bits)).to_f32();
    match format {
        F::R8G8B8A8_SRGB => [light(texel[0]), light(texel[1]), light(texel[2]), unorm(texel[3])],
        F::B8G8R8A8_SRGB => [light(texel[2]), light(texel[1]), light(texel[0]), unorm(texel[3])],
        F::B8G8R8A8_UNORM => [2, 1, 0, 3].map(|at| unorm(texel[at])),
        F::A2B10G10R10_UNORM_PACK32 => [share(0, 10), share(10, 10), share(20, 10), share(30, 2)],
        F::A2R10G10B10_UNORM_PACK32 => [share(20, 10), share(10, 10), share(0, 10), share(30, 2)],
        F::E5B9G9R9_UFLOAT_PACK32 => {
            let [red, green, blue] = texel::shared_exponent(word(0));
            [red, green, blue, 1.0]
        }
        F::R16_SFLOAT => [half(0), 0.0, 0.0, 1.0],
        F::R16G16_SFLOAT => [half(0), half(2), 0.0, 1.0],
        F::R16G16B16A16_SFLOAT => [0, 2, 4, 6].map(half),
        F::R32_SFLOAT => [float(0), 0.0, 0.0, 1.0],
        F::R32G32_SFLOAT => [float(0), float(4), 0.0, 1.0],
        F::R32G32B32A32_SFLOAT => [0, 4, 8, 12].map(float),
        F::B10G11R11_UFLOAT_PACK32 => [small(0, 11), small(11, 11), small(22, 10), 1.0],
        F::D16_UNORM | F::X8_D24_UNORM_PACK32 | F::D32_SFLOAT | F::D24_UNORM_S8_UINT | F::D32_SFLOAT_S8_UINT => {
            [texel::depth(format, texel), 0.0, 0.0, 1.0]
        }
        // All others have components of one size, in order.
        _ => {
            let mut values = [0.0, 0.0, 0.0, 1.0];
            for (component, value) in values.iter_mut().enumerate().take(format.components() as usize) {
                *value = texel::component(format, texel, component);
            }
            values
        }
    }
}

/// The number of a format's components that an image of it has values in: depth alone of depth and stencil.
pub fn components(format: Format) -> usize {
    if format.is_depth() { 1 } else { format.components() as usize }
}

/// Whether values may lie beyond 0 to 1, or mean something else than light.
pub fn is_light(format: Format) -> bool {
    !format.is_depth() && !format.is_integer()
}

/// A linear value through the curve of sRGB, as a byte.
pub fn srgb_byte(linear: f32) -> u8 {
    texel::encode(linear)
}

/// Bytes of one texel, as it is read back.
pub fn texel_bytes(format: Format) -> usize {
    texel::bytes(format)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_and_the_same_grey_comes_out_of_every_format() {
        let half = 0x3800_u16.to_ne_bytes();
        let float = 0.5_f32.to_ne_bytes();
        assert_eq!(values(Format::R16G16B16A16_SFLOAT, &half.repeat(4)), [0.5; 4]);
        assert_eq!(values(Format::R32G32_SFLOAT, &float.repeat(2)), [0.5, 0.5, 0.0, 1.0]);
        assert_eq!(values(Format::D32_SFLOAT, &float), [0.5, 0.0, 0.0, 1.0]);
        let small = ((14 << 6) | (14 << 17) | (14_u32 << 27)).to_ne_bytes();
        assert_eq!(values(Format::B10G11R11_UFLOAT_PACK32, &small), [0.5, 0.5, 0.5, 1.0]);
        let near = |format, texel: &[u8]| (values(format, texel)[0] - 0.5).abs() < 0.003;
        assert!(near(Format::R8G8B8A8_SRGB, &[188; 4]) && near(Format::B8G8R8A8_UNORM, &[128; 4]));
        assert!(near(Format::R16G16B16A16_UNORM, &[0xff, 0x7f].repeat(4)));
        assert!(near(Format::A2B10G10R10_UNORM_PACK32, &512_u32.to_ne_bytes()));
        assert!(near(Format::A2R10G10B10_UNORM_PACK32, &(512_u32 << 20).to_ne_bytes()));
        assert!(near(Format::E5B9G9R9_UFLOAT_PACK32, &(15_u32 << 27 | 256).to_ne_bytes()));
        assert_eq!(values(Format::R8_UINT, &[7]), [7.0, 0.0, 0.0, 1.0]);
        assert!(near(Format::R16_UNORM, &[0xff, 0x7f]) && near(Format::R16G16_SNORM, &[0xff, 0x3f, 0, 0]));
        assert_eq!(values(Format::R8G8_SNORM, &[0x80, 0x7f]), [-1.0, 1.0, 0.0, 1.0]);
        assert_eq!(values(Format::R16G16_SINT, &[0xfd, 0xff, 4, 0]), [-3.0, 4.0, 0.0, 1.0]);
        assert_eq!(values(Format::R32G32_UINT, &[0, 1, 0, 0, 2, 0, 0, 0]), [256.0, 2.0, 0.0, 1.0]);
        for format in Format::ALL.iter().filter(|format| !format.is_compressed()) {
            let all = values(*format, &[0x3f; 16][..texel_bytes(*format)]);
            assert!((1..=4).contains(&components(*format)) && all[0].is_finite(), "{format}");
        }
    }
}
