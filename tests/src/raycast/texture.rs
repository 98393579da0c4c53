//! Texels, in 64 bits.

use framewright_graph::vulkan::Filter;
use framewright_passes::scene::{Texture, Wrap};
use glam::DVec2;

/// Taps on a side, at most, with which a texture shown reduced is averaged.
const MOST_TAPS: f64 = 16.0;

/// The texture at `uv`, linear, for a pixel that covers `texels` texels along the longer side of its footprint.
///
/// Below one texel, or without mip levels, as the sampler's filter for enlarging says. Above, the mean over a tent of that
/// half width both ways: about what a linear filter within and between mip levels gives, which knows no long and narrow
/// footprints either.
#[must_use]
pub fn sample(texture: &Texture, uv: DVec2, texels: f64) -> [f64; 4] {
    let place = uv * DVec2::new(texture.width.into(), texture.height.into());
    if texels <= 1.0 || texture.sampler.mip.is_none() {
        return enlarged(texture, place);
    }
    let taps = (2.0 * texels).ceil().min(MOST_TAPS) as u32;
    let steps = || (0..taps).map(|tap| (2.0 * f64::from(tap) + 1.0) / f64::from(taps) - 1.0);
    let (mut sum, mut weights) = ([0.0; 4], 0.0);
    for (dx, dy) in steps().flat_map(|dy| steps().map(move |dx| (dx, dy))) {
        let weight = (1.0 - dx.abs()) * (1.0 - dy.abs());
        let tap = enlarged(texture, place + DVec2::new(dx, dy) * texels);
        sum = std::array::from_fn(|i| sum[i] + weight * tap[i]);
        weights += weight;
    }
    sum.map(|channel| channel / weights)
}

/// The largest level at `place`, counted in texels, by the sampler's filter for enlarging.
fn enlarged(texture: &Texture, place: DVec2) -> [f64; 4] {
    match texture.sampler.magnify {
        Filter::Nearest => texel(texture, place.x.floor(), place.y.floor()),
        Filter::Linear => {
            let corner = (place - 0.5).floor();
            let share = place - 0.5 - corner;
            let mut sum = [0.0; 4];
            for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                let weight =
                    (dx * share.x + (1.0 - dx) * (1.0 - share.x)) * (dy * share.y + (1.0 - dy) * (1.0 - share.y));
                let texel = texel(texture, corner.x + dx, corner.y + dy);
                sum = std::array::from_fn(|i| sum[i] + weight * texel[i]);
            }
            sum
        }
    }
}

/// One texel, counted from the upper left one, linear.
fn texel(texture: &Texture, x: f64, y: f64) -> [f64; 4] {
    let column = wrap(x, texture.width, texture.sampler.wrap_u);
    let row = wrap(y, texture.height, texture.sampler.wrap_v);
    let at = 4 * (row * texture.width as usize + column);
    let share = |channel: usize| f64::from(texture.rgba8[at + channel]) / 255.0;
    [decode(share(0)), decode(share(1)), decode(share(2)), share(3)]
}

/// A whole number brought to 0…size − 1.
fn wrap(at: f64, size: u32, wrap: Wrap) -> usize {
    let size = f64::from(size);
    let inside = match wrap {
        Wrap::Repeat => at.rem_euclid(size),
        Wrap::MirroredRepeat => {
            let twice = at.rem_euclid(2.0 * size);
            if twice < size { twice } else { 2.0 * size - 1.0 - twice }
        }
        Wrap::ClampToEdge => at.clamp(0.0, size - 1.0),
    };
    inside as usize
}

/// sRGB's transfer function (IEC 61966-2-1): the linear value of an encoded one, both 0…1.
#[must_use]
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Inverse of [`decode`].
#[must_use]
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}
