//! Frustum culling: an object may be visible unless its box is wholly beyond a side of the frustum, before the near plane or
//! behind the far plane.
//!
//! The corners of an object's box are taken to clip space, where a picture's four sides, the near and the far plane are planes:
//! a box is beyond one if all of its corners are (U. Assarsson, T. Möller, "Optimized view frustum culling algorithms for
//! bounding boxes", Journal of Graphics Tools 5 (1), 2000). Nothing is divided, so a box may reach behind the camera. Without a
//! far plane no box is beyond it. A box that is beyond none may still be out of sight: it is drawn.

use super::frame_data::world_to_clip;
use crate::scene::{Bounds, Camera, Scene};
use glam::{DMat4, DVec4};

/// The largest rounding error of vertices in clip space, which the device computes in 32 bits, as a share of the sum of all
/// terms: two products of a matrix and a vector, at most six roundings each.
const ROUNDING: f64 = 16.0 * f32::EPSILON as f64;

/// By object of the scene, whether a camera may see it in a picture of which `aspect` is width over height.
#[must_use]
pub fn in_sight(scene: &Scene, camera: &Camera, aspect: f64) -> Vec<bool> {
    within(scene, camera, world_to_clip(camera, aspect))
}

/// By object, whether it may be visible in a picture whose clip space `world_to_clip` leads to, jitter included.
pub(super) fn within(scene: &Scene, camera: &Camera, world_to_clip: DMat4) -> Vec<bool> {
    let eye = camera.position();
    let visible = |bounds: Bounds, mut to_world: DMat4| {
        to_world.w_axis = (to_world.w_axis.truncate() - eye).extend(1.0);
        may_be_visible(bounds, to_world, world_to_clip)
    };
    scene.objects.iter().map(|it| visible(scene.meshes[it.mesh].bounds, it.transform)).collect()
}

/// Whether a box isn't wholly beyond one of the planes.
fn may_be_visible(bounds: Bounds, to_world: DMat4, world_to_clip: DMat4) -> bool {
    let (min, max) = (bounds.min, bounds.max);
    let added = absolute(world_to_clip) * (absolute(to_world) * min.abs().max(max.abs()).extend(1.0));
    let slack = added * ROUNDING;
    let to_clip = world_to_clip * to_world;
    let corners: [DVec4; 8] = bounds.corners().map(|corner| to_clip * corner.extend(1.0));
    let beyond =
        |axis: usize, side: f64| corners.iter().all(|corner| side * corner[axis] - corner.w > slack[axis] + slack.w);
    let beyond_far = corners.iter().all(|corner| corner.z < -slack.z);
    !(beyond(0, 1.0) || beyond(0, -1.0) || beyond(1, 1.0) || beyond(1, -1.0) || beyond(2, 1.0) || beyond_far)
}

fn absolute(matrix: DMat4) -> DMat4 {
    DMat4::from_cols_array(&matrix.to_cols_array().map(f64::abs))
}
