//! Twin of `shaders/include/sun_shadow.glsl`: the filter by areas, and a plane's depth by what the map's axes are in the world.

use glam::{DMat3, DMat4, DVec3};

/// How much nearer to the sun a place is taken to be than it is, as a share of the depth that a map covers.
pub const DEPTH_ROUNDING: f64 = 1.0 / 32768.0;
/// The last share of a cascade's map at each border, along which the next cascade takes over.
const BLENDING: f64 = 0.08;
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

/// A cascade of the sun's shadows.
#[derive(Clone, Copy)]
pub struct Cascade<'a> {
    /// As in `SunView`.
    pub world_to_clip: DMat4,
    /// Width of a texel of its map, metres.
    pub texel: f64,
    /// The depth of the nearest caster in a texel of its map, reversed.
    pub caster: &'a dyn Fn(i32, i32) -> f64,
}

/// All that tells how much of the sun's light arrives at a place.
#[derive(Clone, Copy)]
pub struct Shadows<'a> {
    /// Unit vector.
    pub to_sun: DVec3,
    /// How far from the camera shadows reach, metres.
    pub reach: f64,
    /// The nearest first.
    pub cascades: &'a [Cascade<'a>],
    /// Width and height of each map, texels.
    pub extent: f64,
    /// Width of the filter, texels of a map.
    pub taps: u32,
}

impl Shadows<'_> {
    /// The share of the sun's light that arrives at `position`, seen from the camera, on a surface with the unit vector `normal`;
    /// places are taken to be nearer to the sun by `nearer`, usually [`DEPTH_ROUNDING`].
    #[must_use]
    pub fn sunlit(&self, position: DVec3, normal: DVec3, nearer: f64) -> f64 {
        let facing = normal.dot(self.to_sun);
        let distance_share = position.length() / self.reach;
        if facing <= 0.0 || distance_share >= 1.0 {
            return 1.0;
        }
        let beside = normal.cross(self.to_sun).length();
        let (mut share, mut rest) = (0.0, 1.0);
        for (index, cascade) in self.cascades.iter().enumerate() {
            let seen = cascade.world_to_clip.transform_point3(position + normal * (beside * cascade.texel));
            let place = [seen.x, seen.y].map(|at| (at + 1.0) / 2.0 * self.extent);
            let margin = f64::from(self.taps) / 2.0 + 1.0;
            let inside = place.iter().flat_map(|at| [*at, self.extent - at]).fold(f64::MAX, f64::min) - margin;
            if inside > 0.0 {
                let last = index + 1 == self.cascades.len();
                let part = if last { 1.0 } else { (inside / (BLENDING * self.extent)).min(1.0) };
                let slope = self.slope(cascade, normal);
                share += rest * part * uncovered(cascade.caster, place, seen.z + nearer, slope, self.taps);
                rest *= 1.0 - part;
            }
        }
        faded(share + rest, distance_share)
    }

    /// How much the depth of a plane changes from texel to texel. A step in clip space is a step in the world. Its depth is
    /// chosen so that the step stays in the plane.
    fn slope(&self, cascade: &Cascade<'_>, normal: DVec3) -> [f64; 2] {
        let to_world = DMat3::from_mat4(cascade.world_to_clip).inverse();
        let along = to_world.transpose() * normal;
        [along.x, along.y].map(|across| -across / along.z * 2.0 / self.extent)
    }
}
