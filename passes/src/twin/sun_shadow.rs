//! Twin of the filter in `shaders/include/sun_shadow.glsl`, by areas.

/// The last share of the reach, along which shadows fade.
const FADING: f64 = 0.1;

/// The share of a square `taps` texels wide around a place that no caster covers: `caster(x, y)` is the depth of the nearest
/// one in a texel of the map, reversed, and covers what has less depth. The surface has `depth` at the place and rises by `slope` a
/// texel, from there on towards the sun only.
#[must_use]
pub fn uncovered(caster: impl Fn(i32, i32) -> f64, place: [f64; 2], depth: f64, slope: [f64; 2], taps: u32) -> f64 {
    let side = f64::from(taps);
    let [left, upper] = place.map(|at| at - side / 2.0);
    let within = |first: f64, texel: i32| {
        let (begin, end) = (f64::from(texel).max(first), f64::from(texel + 1).min(first + side));
        (end - begin).max(0.0)
    };
    let texels = |first: f64| first.floor() as i32..=(first + side).floor() as i32;
    let surface = |x: i32, y: i32| {
        let rise = slope[0] * (f64::from(x) + 0.5 - place[0]) + slope[1] * (f64::from(y) + 0.5 - place[1]);
        depth + rise.max(0.0)
    };
    let areas = texels(upper).flat_map(|y| texels(left).map(move |x| (x, y)));
    let lit = areas.filter(|(x, y)| caster(*x, *y) <= surface(*x, *y));
    lit.map(|(x, y)| within(left, x) * within(upper, y)).sum::<f64>() / (side * side)
}

/// The share of the sun's light that arrives at a share of the reach of shadows, 0 to 1, if this much of the filter is
/// uncovered.
#[must_use]
pub fn faded(uncovered: f64, distance_share: f64) -> f64 {
    let shadow = ((1.0 - distance_share) / FADING).clamp(0.0, 1.0);
    1.0 - shadow * (1.0 - uncovered)
}
