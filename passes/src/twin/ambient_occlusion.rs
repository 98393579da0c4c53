//! Twin of `shaders/include/ambient_occlusion.glsl` and of the shaders `ambient_occlusion` and `ambient_occlusion_blur`.
//! Sources of the formulas stand there.

use super::g_buffer::from_octahedral;
use glam::{DMat3, DMat4, DVec2, DVec3};
use std::f64::consts::TAU;

const OCCLUDERS: u32 = 16;
const TURNS: f64 = 7.0;
const RISE_OF_RADIUS: f64 = 0.012;
const RISE_OF_DISTANCE: f64 = 0.001;
const NEARLY_TOUCHING: f64 = 0.0001;
const APART: f64 = 0.05;

/// The surfaces in a picture: row by row depth, reversed, 0 where there is none, and the normal, octahedral.
#[derive(Debug, Clone)]
pub struct Surfaces {
    /// Width and height in texels.
    pub extent: [i32; 2],
    /// Depth.
    pub depth: Vec<f64>,
    /// Normals.
    pub normal: Vec<DVec2>,
    /// To clip space from a space whose origin is at the camera.
    pub world_to_clip: DMat4,
}

impl Surfaces {
    fn index(&self, [x, y]: [i32; 2]) -> usize {
        (y * self.extent[0] + x) as usize
    }

    fn place_at(&self, texel: [i32; 2]) -> DVec3 {
        let clip = [0, 1].map(|axis| (f64::from(texel[axis]) + 0.5) / f64::from(self.extent[axis]) * 2.0 - 1.0);
        let depth = self.depth[self.index(texel)];
        self.world_to_clip.inverse().project_point3(DVec3::new(clip[0], clip[1], depth))
    }

    /// The distance of a texel's surface along the camera's axis; infinite where there is none.
    fn away(&self, texel: [i32; 2]) -> f64 {
        let is_there = self.depth[self.index(texel)] > 0.0;
        if is_there { self.world_to_clip.row(3).dot(self.place_at(texel).extend(1.0)) } else { f64::INFINITY }
    }

    /// The share of light from everywhere that reaches a texel's surface past those around it. `radius` in metres.
    #[must_use]
    pub fn openness(&self, texel: [i32; 2], radius: f64, strength: f64) -> f64 {
        let depth = self.depth[self.index(texel)];
        if depth <= 0.0 {
            return 1.0;
        }
        let (here, normal) = (self.place_at(texel), from_octahedral(self.normal[self.index(texel)]));
        let away = self.away(texel);
        let rows = DMat3::from_mat4(self.world_to_clip).transpose();
        let focal = [rows.x_axis.length(), rows.y_axis.length()];
        let occlusion = |i: u32| {
            let out_to = (f64::from(i) + 0.5) / f64::from(OCCLUDERS);
            let angle = TAU * (out_to * TURNS + spiral_turn(texel));
            let beside = [angle.cos(), angle.sin()];
            let there = [0, 1].map(|axis| {
                let reach = radius / away * 0.5 * focal[axis] * f64::from(self.extent[axis]);
                (f64::from(texel[axis]) + 0.5 + beside[axis] * out_to * reach).floor() as i32
            });
            let seen = (0..2).all(|axis| (0..self.extent[axis]).contains(&there[axis]));
            if seen && self.depth[self.index(there)] > 0.0 {
                occlusion_by(self.place_at(there) - here, normal, away, radius)
            } else {
                0.0
            }
        };
        let sum: f64 = (0..OCCLUDERS).map(occlusion).sum();
        (1.0 - strength * sum * 5.0 / f64::from(OCCLUDERS)).clamp(0.0, 1.0)
    }

    /// The mean of `source`, row by row, around a texel, of surfaces at about its distance.
    #[must_use]
    pub fn blurred(&self, source: &[f64], texel: [i32; 2]) -> f64 {
        // What lies beside nothing is infinitely far from it.
        let nearness = |texel| self.away(texel).recip();
        let here = nearness(texel);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (x, y) in (-2..=2).flat_map(|y| (-2..=2).map(move |x| (x, y))) {
            let there = [(texel[0] + x).clamp(0, self.extent[0] - 1), (texel[1] + y).clamp(0, self.extent[1] - 1)];
            let apart = (here - nearness(there)).abs() / nearness(there).max(1e-30);
            let end = |offset: i32| if offset.abs() == 2 { 0.5 } else { 1.0 };
            let weight = end(x) * end(y) * (1.0 - apart / APART).max(0.0);
            sum += weight * source[self.index(there)];
            weights += weight;
        }
        sum / weights
    }
}

/// By how much a texel turns its spiral, 0 to less than 1.
#[must_use]
pub fn spiral_turn([x, y]: [i32; 2]) -> f64 {
    let (x, y) = (x & 3, y & 3);
    let z = x ^ y;
    f64::from((z & 1) << 3 | (y & 1) << 2 | z & 2 | y >> 1) / 16.0
}

/// The weight of an occluder at `towards` from a surface that is `away` from the camera.
#[must_use]
pub fn occlusion_by(towards: DVec3, normal: DVec3, away: f64, radius: f64) -> f64 {
    let squared = towards.length_squared() / (radius * radius);
    let share = (1.0 - squared).max(0.0);
    let rise = towards.dot(normal) / radius - RISE_OF_RADIUS.max(RISE_OF_DISTANCE * away / radius);
    share.powi(3) * rise.max(0.0) / (squared + NEARLY_TOUCHING)
}
