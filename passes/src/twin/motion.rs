//! Twin of `shaders/include/motion.glsl`: motion vectors since the frame before.

use crate::scene::Camera;
use glam::{DMat3, DMat4, DVec2, DVec3};

/// Marks a place that wasn't in the picture.
pub const NOWHERE: f64 = 2.0;

/// Where a camera sees a place of the world, 0 to 1 from the picture's upper left corner; `None` behind it. `aspect` is the
/// picture's width over its height.
#[must_use]
pub fn place_in_picture(camera: &Camera, aspect: f64, place: DVec3) -> Option<DVec2> {
    let camera_to_world = camera.transform;
    seen_along(camera, aspect, camera_to_world.inverse().transform_point3(place))
}

/// Where a camera sees what lies infinitely far away in a direction of the world.
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

/// Where something was less where it is: from where a point of an object's mesh is seen now and was seen in the frame before.
#[must_use]
pub fn motion(now: DVec2, before: Option<DVec2>) -> DVec2 {
    before.map_or(DVec2::splat(NOWHERE), |before| (before - now).clamp(DVec2::splat(-NOWHERE), DVec2::splat(NOWHERE)))
}

/// Where a point of a thing is in the frame before, from where it is in the world now and the thing's transforms.
#[must_use]
pub fn place_before(place: DVec3, now: DMat4, before: DMat4) -> DVec3 {
    before.transform_point3(now.inverse().transform_point3(place))
}
