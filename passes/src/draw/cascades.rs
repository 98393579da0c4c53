//! Cascaded shadow maps of the sun that don't shimmer.
//!
//! The camera's frustum is cut into slices by distance (F. Zhang, H. Sun, L. Xu, K. L. Lee, "Parallel-split shadow maps for
//! large-scale virtual environments", VRCIA 2006), and each slice put into a sphere, whose size depends on neither the
//! camera's place nor its direction. The square around the sphere moves by whole texels (M. Valient, "Stable rendering of
//! cascaded shadow maps", ShaderX6, 2008). So a texel covers the same place of the scene as long as it is covered at all.

use super::block::Block;
use crate::facts::splits::{Splits, through};
use crate::scene::{Bounds, Camera, Object, Scene};
use framewright_graph::frame::{Cascade, Draw};
use framewright_graph::plan::{Plan, ViewId};
use glam::{DMat4, DVec3, DVec4, Vec3};
use std::collections::BTreeMap;

/// The sun's view of a cascade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunView {
    /// From the shaders' world space (the scene's axes, the camera as origin) to clip space, depth reversed: all casters lie
    /// between 1, towards the sun, and 0.
    pub world_to_clip: DMat4,
    /// Width of a texel of its map, metres.
    pub texel: f64,
    /// How far from the camera shadows reach, metres.
    pub reach: f64,
}

/// A cascade, and the width and height of its map in texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CascadeMap {
    pub(super) cascade: Cascade,
    pub(super) texels: u32,
}

/// The cascades that a Plan draws for a view, or for an eye of it, the nearest first. Their draw lists have no meaning.
pub(super) fn of_plan(plan: &Plan, view: Option<ViewId>) -> Vec<CascadeMap> {
    let mut maps = BTreeMap::new();
    let between = |of: ViewId| plan.views.get(of.0 as usize).and_then(|view| view.eye).map_or(of, |eye| eye.of);
    for step in &plan.steps {
        let Some(scope) = step.work.scope() else { continue };
        for pass in scope.passes.iter().filter(|pass| pass.view.map(between) == view) {
            if let Some(cascade) = pass.draw.and_then(Draw::cascade) {
                let texels = scope.extent[0].min(scope.extent[1]);
                maps.entry(cascade.index).or_insert(CascadeMap { cascade, texels });
            }
        }
    }
    maps.into_values().collect()
}

/// Whether an object's box lies in the sun's view of a cascade, or between it and the sun.
#[must_use]
pub fn may_cast(scene: &Scene, camera: &Camera, sun: &SunView, object: &Object) -> bool {
    let corners = scene.meshes[object.mesh].bounds.transformed(object.transform).corners();
    let to_clip = |corner: DVec3| (sun.world_to_clip * (corner - camera.position()).extend(1.0)).truncate();
    let Bounds { min, max } = Bounds::around(corners.map(to_clip));
    (0..2).all(|axis| min[axis] <= 1.0 && max[axis] >= -1.0)
}

/// Texels at each border of a map that a filter may reach into.
const MARGIN: f64 = 6.0;

/// How the sun sees a cascade of a camera's picture, of which `aspect` is width over height. Its map has `texels` in width
/// and height, at least 16.
#[must_use]
pub fn sun_view(scene: &Scene, camera: &Camera, aspect: f64, cascade: Cascade, texels: u32) -> SunView {
    let texels = f64::from(texels.max(16));
    let eye = camera.position();
    let (middle, radius) = sphere_around(scene);
    let reach = cascade
        .reach
        .map_or_else(|| through(middle.distance(eye) + radius, camera.near), |reach| f32::from(reach).into());
    // Beyond the far plane nothing is seen; the corners of its picture are farther off than its middle.
    let reach = camera.far.map_or(reach, |far| reach.min(f64::from(far) * corner_distance(camera, aspect)));
    let splits = Splits { near: camera.near.into(), reach, of: cascade.of, logarithmic: cascade.logarithmic };
    let [near, far] = [0, 1].map(|end| splits.border(cascade.index + end));
    let (ahead, slice) = sphere_of_slice(camera, aspect, near, far);
    let to_sun = -Vec3::from(scene.sun.direction).as_dvec3();
    let to_sun = to_sun.try_normalize().unwrap_or(DVec3::Y);
    let (right, up) = to_sun.any_orthonormal_pair();
    let forward = -camera.transform.z_axis.truncate();
    // No more is covered than the whole scene.
    let (centre, slice) = if slice < radius { (eye + forward * ahead, slice) } else { (middle, radius) };
    let texel = 2.0 * slice / (texels - 2.0 * MARGIN);
    let [x, y] = [right, up].map(|axis| (axis.dot(centre) / texel).round() * texel);

    let half = texel * texels * 0.5;
    let lowest = to_sun.dot(middle) - radius;
    let row = |axis: DVec3, at: f64, scale: f64| (axis * scale).extend((axis.dot(eye) - at) * scale);
    let rows =
        [row(right, x, half.recip()), row(up, y, -half.recip()), row(to_sun, lowest, (2.0 * radius).recip()), DVec4::W];
    let world_to_clip = DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
    SunView { world_to_clip, texel, reach }
}

/// A sphere around everything: middle and radius. Somewhat larger, so that nothing ends up beyond it by rounding.
fn sphere_around(scene: &Scene) -> (DVec3, f64) {
    let around = scene.bounds().map_or((DVec3::ZERO, 0.0), |bounds| (bounds.center(), bounds.radius()));
    // Nothing is seen of a scene without size: any radius will do.
    (around.0, if around.1 > 0.0 { around.1 * 1.001 } else { 1.0 })
}

/// How far the corners of the picture at distance 1 are from the camera.
fn corner_distance(camera: &Camera, aspect: f64) -> f64 {
    let up = (f64::from(camera.vertical_fov) * 0.5).tan();
    (1.0 + up * up * (1.0 + aspect * aspect)).sqrt()
}

/// The smallest sphere around the frustum between two distances: the distance of its middle from the camera, and its radius.
fn sphere_of_slice(camera: &Camera, aspect: f64, near: f64, far: f64) -> (f64, f64) {
    let up = (f64::from(camera.vertical_fov) * 0.5).tan();
    // The squared distance of a corner from the axis, at distance 1.
    let squared = up * up * (1.0 + aspect * aspect);
    let ahead = (0.5 * (near + far) * (1.0 + squared)).min(far);
    (ahead, ((far - ahead).powi(2) + squared * far * far).sqrt())
}

/// The block `cascades` of `shaders/include/scene.glsl`, the nearest cascade first.
pub(super) fn cascades_block(cascades: &[SunView]) -> Vec<u8> {
    let mut block = Block::default();
    for number in 0..Cascade::MOST as usize {
        let sun = cascades.get(number);
        block.mat4(sun.map_or(DMat4::ZERO, |sun| sun.world_to_clip).as_mat4());
        block.float(sun.map_or(0.0, |sun| sun.texel) as f32);
        block.align();
    }
    block.uint(u32::try_from(cascades.len()).unwrap_or(u32::MAX).min(Cascade::MOST.into()));
    block.float(cascades.first().map_or(0.0, |sun| sun.reach) as f32);
    block.bytes()
}
