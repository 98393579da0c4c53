//! Twin of `shaders/include/motion.glsl`: motion vectors since the frame before.

use crate::scene::Camera;
use glam::{DMat3, DMat4, DVec2, DVec3};

/// Marks a place that wasn't in the picture.
pub const NOWHERE: f64 = 2.0;

/// The picture coordinates of a place of the world, 0 to 1 from the upper left corner; `None` behind the camera. `aspect` is the
/// picture's width over its height.
#[must_use]
pub fn place_in_picture(camera: &Camera, aspect: f64, place: DVec3) -> Option<DVec2> {
    let camera_to_world = camera.transform;
    seen_along(camera, aspect, camera_to_world.inverse().transform_point3(place))
}

/// The picture coordinates of everything infinitely far away in a direction of the world.
#[must_use]
pub fn direction_in_picture(camera: &Camera, aspect: f64, direction: DVec3) -> Option<DVec2> {
    seen_along(camera, aspect, DMat3::from_mat4(camera.transform).inverse() * direction)
}

fn seen_along(camera: &Camera, aspect: f64, at: DVec3) -> Option<DVec2> {
    let half_height = (f64::from(camera.vertical_fov) * 0.5).tan();
    let ahead = -at.z;
    (ahead > 0.0).then(|| {
        let scaled = DVec2::new(at.x / aspect, -at.y) / (half_height * ahead);
        0.5 * scaled + 0.5
    })
}

/// The old picture coordinates less the new ones, of a point of an object's mesh.
#[must_use]
pub fn motion(now: DVec2, before: Option<DVec2>) -> DVec2 {
    before.map_or(DVec2::splat(NOWHERE), |before| (before - now).clamp(DVec2::splat(-NOWHERE), DVec2::splat(NOWHERE)))
}

/// The place of a thing's point in the frame before, from where it is in the world now and the thing's transforms.
#[must_use]
pub fn place_before(place: DVec3, now: DMat4, before: DMat4) -> DVec3 {
    before.transform_point3(now.inverse().transform_point3(place))
}
