//! The components of a texel, in each format that random pipelines use.
//!
//! A component is a word: of integer formats its value, of UNORM formats its value in 255ths, of others the bits of a
//! 32-bit float. All that is ever written can be represented exactly, averages of four samples included.

use super::pipeline::{Image, Plane};
use framewright_graph::frame::Blend;
use framewright_graph::vulkan::{Aspects, FillValue, Format, Numeric, ResolveMode};

/// A texel's components.
pub type Words = [u32; 4];

/// Whether shaders read unsigned integers from it.
#[must_use]
pub fn is_uint(format: Format) -> bool {
    matches!(format.numeric(), Numeric::Uint)
}

fn is_unorm(format: Format) -> bool {
    matches!(format.numeric(), Numeric::Unorm)
}

/// Words of which all bits that this format's components hold are set; blending uses fewer, so that sums stay exact.
#[must_use]
pub fn mask(format: Format, blend: Blend) -> u32 {
    let blends = blend != Blend::Replace;
    match format {
        Format::R32_UINT | Format::R32G32B32A32_UINT => u32::MAX,
        // Averages of four multiples of four are whole.
        Format::R8G8B8A8_UNORM => {
            if blends {
                0x04
            } else {
                0xFC
            }
        }
        Format::R16G16B16A16_SFLOAT => {
            if blends {
                0x07
            } else {
                0x3F
            }
        }
        Format::R32_SFLOAT | Format::R32G32B32A32_SFLOAT => {
            if blends {
                0xFFF
            } else {
                0xFFFF
            }
        }
        _ => 0xFF,
    }
}

/// The greatest value that sums may reach.
#[must_use]
pub fn limit(format: Format) -> u64 {
    match format {
        Format::R8G8B8A8_UNORM => 255,
        Format::R16G16B16A16_SFLOAT => 511,
        Format::R32_SFLOAT | Format::R32G32B32A32_SFLOAT => 1 << 20,
        _ => u64::MAX,
    }
}

/// The number that divides whole numbers to make the float that a shader writes.
#[must_use]
pub fn divisor(format: Format) -> f32 {
    if is_unorm(format) { 255.0 } else { 1.0 }
}

/// The factor with which a shader makes a float a whole number again: quarters come from averages, 256ths are depths.
#[must_use]
pub fn scale(format: Format) -> f32 {
    if format.is_depth() {
        65536.0
    } else if is_unorm(format) {
        255.0
    } else {
        4.0
    }
}

/// A format and a texel of it, as one who reads some planes of another sees them.
#[must_use]
pub fn seen(format: Format, plane: Plane, words: Words) -> (Format, Words) {
    match plane {
        Plane::All => (format, words),
        Plane::Depth => (Format::D32_SFLOAT, words),
        Plane::Stencil => (Format::R8_UINT, [words[1], 0, 0, 0]),
    }
}

/// A texel with some planes replaced.
#[must_use]
pub fn merged(plane: Plane, old: Words, new: Words) -> Words {
    match plane {
        Plane::All => new,
        Plane::Depth => [new[0], old[1], old[2], old[3]],
        Plane::Stencil => [old[0], new[1], old[2], old[3]],
    }
}

/// The planes of a format, one by one, as outputs are read.
#[must_use]
pub fn planes(format: Format) -> &'static [Plane] {
    if format.aspects().contains(Aspects::STENCIL) { &[Plane::Depth, Plane::Stencil] } else { &[Plane::All] }
}

/// Components that shaders hash.
#[must_use]
pub fn parts(format: Format) -> u32 {
    if format.is_depth() { 1 } else { format.components() }
}

/// The word of a whole number.
#[must_use]
pub fn word(format: Format, number: u32) -> u32 {
    if format.is_depth() {
        (number as f32 / 256.0).to_bits()
    } else if is_uint(format) || is_unorm(format) {
        number
    } else {
        (number as f32).to_bits()
    }
}

/// The words of whole numbers: of depth with stencil, the second is the stencil.
#[must_use]
pub fn words(format: Format, numbers: Words) -> Words {
    let all = numbers.map(|number| word(format, number));
    if format.aspects().contains(Aspects::STENCIL) { [all[0], numbers[1], 0, 0] } else { all }
}

/// [`plain`] in every component.
#[must_use]
pub fn plain_texel(format: Format, value: u8) -> Words {
    words(format, [u32::from(value) & mask(format, Blend::Replace); 4])
}

/// A small value for clears, fills and first contents: one that the format's shaders may write too.
#[must_use]
pub fn plain(format: Format, value: u8) -> u32 {
    word(format, u32::from(value) & mask(format, Blend::Replace))
}

/// A word as shaders hash it.
#[must_use]
pub fn hashed(format: Format, word: u32) -> u32 {
    if is_uint(format) || (is_unorm(format) && !format.is_depth()) {
        word
    } else {
        (f32::from_bits(word) * scale(format) + 0.5) as u32
    }
}

/// A word as a float, linear.
#[must_use]
pub fn float(format: Format, word: u32) -> f32 {
    if format.is_depth() {
        f32::from_bits(word)
    } else if is_unorm(format) {
        word as f32 / 255.0
    } else if is_uint(format) {
        word as f32
    } else {
        f32::from_bits(word)
    }
}

/// The value that fills a texel with [`plain`].
#[must_use]
pub fn fill(format: Format, value: u8) -> FillValue {
    let word = plain(format, value);
    if format.is_depth() {
        let stencil = if format.aspects().contains(Aspects::STENCIL) { value } else { 0 };
        FillValue::Depth(f32::from_bits(word), stencil)
    } else if is_uint(format) {
        FillValue::Bits([word; 4])
    } else {
        FillValue::Color([float(format, word); 4])
    }
}

/// The sum of two words of a format that isn't an integer's.
#[must_use]
pub fn sum(format: Format, left: u32, right: u32) -> u32 {
    if is_unorm(format) { left + right } else { (f32::from_bits(left) + f32::from_bits(right)).to_bits() }
}

/// One value for all samples of an image: the mean, of integers the first, of depth by the image's resolve mode. Drawing it
/// again leaves the first: geometry covers whole texels, and with one sample shaders run as if for the first.
#[must_use]
pub fn resolved(image: &Image, samples: &[Words]) -> Words {
    let format = image.format;
    let depths = || samples.iter().map(|words| f32::from_bits(words[0]));
    let mode = if format.is_depth() { image.resolve.unwrap_or(ResolveMode::SampleZero) } else { ResolveMode::Average };
    match mode {
        _ if is_uint(format) || samples.len() == 1 => return samples[0],
        ResolveMode::SampleZero => return samples[0],
        ResolveMode::Min => return [depths().fold(f32::INFINITY, f32::min).to_bits(), 0, 0, 0],
        ResolveMode::Max => return [depths().fold(0.0, f32::max).to_bits(), 0, 0, 0],
        ResolveMode::Average => {}
    }
    std::array::from_fn(|component| {
        let words = samples.iter().map(|sample| sample[component]);
        if is_unorm(format) {
            words.sum::<u32>() / samples.len() as u32
        } else {
            (words.map(f32::from_bits).sum::<f32>() / samples.len() as f32).to_bits()
        }
    })
}

/// The bytes of a texel as a copy to a buffer writes them.
#[must_use]
pub fn bytes(format: Format, words: Words) -> Vec<u8> {
    let components = &words[..parts(format) as usize];
    match format {
        Format::R8_UINT | Format::R8G8B8A8_UINT | Format::R8G8B8A8_UNORM => {
            components.iter().map(|word| *word as u8).collect()
        }
        Format::R16G16B16A16_SFLOAT => components.iter().flat_map(|word| half(*word).to_le_bytes()).collect(),
        _ => components.iter().flat_map(|word| word.to_le_bytes()).collect(),
    }
}

/// The bits of a half float with the value of a 32-bit one: not negative, and exactly representable as a normal number.
fn half(word: u32) -> u16 {
    if word == 0 { 0 } else { ((word >> 13) - ((127 - 15) << 10)) as u16 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_have_the_bits_that_ieee_754_gives_them() {
        for (value, bits) in [(0.0_f32, 0), (1.0, 0x3C00), (63.0, 0x53E0), (0.25, 0x3400), (511.75, 0x5FFF)] {
            assert_eq!(half(value.to_bits()), bits, "{value}");
        }
    }

    #[test]
    fn shaders_hash_whole_numbers_of_whatever_a_format_holds() {
        assert_eq!(hashed(Format::D32_SFLOAT, word(Format::D32_SFLOAT, 3)), 3 * 256);
        assert_eq!(hashed(Format::R16G16B16A16_SFLOAT, 1.25_f32.to_bits()), 5);
        assert_eq!(hashed(Format::R8G8B8A8_UNORM, word(Format::R8G8B8A8_UNORM, 200)), 200);
        assert_eq!(hashed(Format::R32_UINT, 7), 7);
    }
}
