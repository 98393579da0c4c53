//! Twin of `shaders/fxaa.frag`.

use super::exposure::luminance;
use super::radiance::guard_radiance;

/// Below this neither difference nor share of the brightest is an edge.
const LEAST_CONTRAST: f64 = 1.0 / 24.0;
const LEAST_SHARE: f64 = 1.0 / 8.0;
/// The largest difference of equal bends.
const EVEN: f64 = 1e-4;
/// How far the ends of an edge are looked for, in texels.
const REACH: i32 = 16;

/// The filtered texel: red, green and blue. `texel(x, y)` is the picture, 0 to 1 in linear values, also beyond the edges;
/// `subpixel`, 0 to 1, how much is done against details smaller than a pixel.
#[must_use]
pub fn fxaa(texel: impl Fn(i32, i32) -> [f64; 3], [x, y]: [i32; 2], subpixel: f64) -> [f64; 3] {
    let brightness = |x, y| luminance(texel(x, y).map(|channel| guard_radiance(channel).min(1.0))).sqrt();
    let around = |dx: i32, dy: i32| brightness(x + dx, y + dy);
    let middle = around(0, 0);
    let [north, south, west, east] = [around(0, -1), around(0, 1), around(-1, 0), around(1, 0)];
    let plus = [middle, north, south, west, east];
    let brightest = plus.into_iter().fold(0.0, f64::max);
    let contrast = brightest - plus.into_iter().fold(1.0, f64::min);
    if contrast < LEAST_CONTRAST.max(LEAST_SHARE * brightest) {
        return texel(x, y);
    }
    let bend = |a: f64, b: f64, c: f64| (a + c - 2.0 * b).abs();
    let [north_west, north_east, south_west, south_east] = [around(-1, -1), around(1, -1), around(-1, 1), around(1, 1)];
    let down =
        bend(north_west, west, south_west) + 2.0 * bend(north, middle, south) + bend(north_east, east, south_east);
    let across =
        bend(north_west, north, north_east) + 2.0 * bend(west, middle, east) + bend(south_west, south, south_east);
    let along_rows = down + EVEN >= across;
    let (along, before, after) = if along_rows { ([1, 0], north, south) } else { ([0, 1], west, east) };
    let towards_before = (before - middle).abs() >= (after - middle).abs();
    let (sign, other) = if towards_before { (-1, before) } else { (1, after) };
    let beyond = [sign * along[1], sign * along[0]];
    let (edge, step_height) = (0.5 * (middle + other), (other - middle).abs());
    let [back, forth] = [-1, 1].map(|way| {
        let (mut steps, mut change) = (0, 0.0_f64);
        while steps < REACH && change.abs() < 0.25 * step_height {
            steps += 1;
            let (dx, dy) = (way * steps * along[0], way * steps * along[1]);
            change = 0.5 * (around(dx, dy) + around(dx + beyond[0], dy + beyond[1])) - edge;
        }
        (steps, change)
    });
    let (steps, change) = if back.0 <= forth.0 { back } else { forth };
    let cuts = (change < 0.0) != (middle < edge);
    let cut_off = if cuts { 0.5 - f64::from(steps) / f64::from(back.0 + forth.0) } else { 0.0 };
    let mean = (2.0 * (north + south + west + east) + north_west + north_east + south_west + south_east) / 12.0;
    let apart = ((mean - middle).abs() / contrast).min(1.0);
    let alone = apart * apart * (3.0 - 2.0 * apart);
    let mixed = cut_off.max(alone * alone * subpixel.clamp(0.0, 1.0));
    let (own, next) = (texel(x, y), texel(x + beyond[0], y + beyond[1]));
    [0, 1, 2].map(|channel| own[channel] * (1.0 - mixed) + next[channel] * mixed)
}
