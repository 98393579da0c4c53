//! Where a scene is seen from.

use crate::scene::Bounds;
use glam::{DMat4, DVec3, DVec4, Mat4, Vec3};

/// A perspective camera without a far plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// From the camera's space to the world's: a rotation and a shift. The camera looks along its −z, its y is up.
    pub transform: Mat4,
    /// Angle between the picture's lower and upper border, radians, more than 0 and less than π.
    pub vertical_fov: f32,
    /// Distance of the near plane in metres, more than 0.
    pub near: f32,
}

impl Camera {
    /// A camera at `position` that looks at `target`, with `up` (any length, not along the view) upwards in the picture.
    /// `None` where these leave the direction open or aren't finite.
    #[must_use]
    pub fn look_at(position: DVec3, target: DVec3, up: DVec3, vertical_fov: f32, near: f32) -> Option<Camera> {
        let back = (position - target).try_normalize()?;
        let right = up.cross(back).try_normalize()?;
        let columns = [right, back.cross(right), back].map(|axis| axis.extend(0.0));
        let transform = DMat4::from_cols(columns[0], columns[1], columns[2], position.extend(1.0)).as_mat4();
        transform.is_finite().then_some(Camera { transform, vertical_fov, near })
    }

    /// Frames a box: seen from the front right, somewhat above, with a little air around it. An empty box is seen from
    /// 1 m away.
    #[must_use]
    pub fn framing(bounds: Bounds) -> Camera {
        let radius = if bounds.radius() > 0.0 { bounds.radius() } else { 0.5 };
        let half = FRAMING_FOV * 0.5;
        let distance = radius * FRAMING_AIR / half.sin();
        let center = bounds.center().as_dvec3();
        let from = DVec3::new(0.6, 0.42, 1.0).normalize();
        let columns = Camera::look_at(center + from * distance, center, DVec3::Y, FRAMING_FOV as f32, 1.0);
        let transform = columns.map_or(Mat4::from_translation(center.as_vec3()), |camera| camera.transform);
        Camera {
            transform,
            vertical_fov: FRAMING_FOV as f32,
            near: ((distance - radius) * 0.1).max(f64::from(f32::MIN_POSITIVE)) as f32,
        }
    }

    /// Where the camera stands, in the world.
    #[must_use]
    pub fn position(&self) -> Vec3 {
        self.transform.w_axis.truncate()
    }

    /// From the world's space to the camera's.
    #[must_use]
    pub fn view(&self) -> Mat4 {
        self.transform.as_dmat4().inverse().as_mat4()
    }

    /// From the camera's space to Vulkan's clip space: y down, depth reversed (1 on the near plane, 0 infinitely far).
    /// `aspect` is width over height.
    #[must_use]
    pub fn projection(&self, aspect: f64) -> Mat4 {
        let focal = 1.0 / (f64::from(self.vertical_fov) * 0.5).tan();
        DMat4::from_cols(
            DVec4::new(focal / aspect, 0.0, 0.0, 0.0),
            DVec4::new(0.0, -focal, 0.0, 0.0),
            DVec4::new(0.0, 0.0, 0.0, -1.0),
            DVec4::new(0.0, 0.0, f64::from(self.near), 0.0),
        )
        .as_mat4()
    }
}

/// Vertical field of view of a camera that was framed automatically: 40°.
const FRAMING_FOV: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// How much further away than needed a framed camera stands.
const FRAMING_AIR: f64 = 1.0;
