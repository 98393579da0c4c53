//! The cameras of a scene.

use super::bounds::Bounds;
use super::movement::Movement;
use glam::{DMat4, DVec3, DVec4, Mat4};

/// A perspective camera, with a far plane or without.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// From the camera's space to the world's: a rotation and a shift. The camera looks along its −z, its y is up.
    pub transform: DMat4,
    /// Angle between the picture's lower and upper border, radians, more than 0 and less than π.
    pub vertical_fov: f32,
    /// Distance of the near plane in metres, more than 0.
    pub near: f32,
    /// Distance of the far plane in metres, more than `near`: nothing beyond it is drawn but the sky. `None`: it is infinitely
    /// far.
    pub far: Option<f32>,
    /// How it moves from where `transform` says that it is at frame 0.
    pub movement: Movement,
}

/// A camera that a view asks for by its name.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedCamera {
    /// Its name. It may hold any character, and in files of others need not be unique: the first of a name counts.
    pub name: String,
    /// The camera.
    pub camera: Camera,
}

impl Camera {
    /// A camera at `position` that looks at `target`, with `up` (any length, not along the view) upwards in the picture,
    /// without a far plane. `None` where these leave the direction open or aren't finite.
    #[must_use]
    pub fn look_at(position: DVec3, target: DVec3, up: DVec3, vertical_fov: f32, near: f32) -> Option<Camera> {
        Camera::facing(position, target - position, up, vertical_fov, near)
    }

    /// A camera at `position` that looks along `forward` (any length), with `up` upwards in the picture; see
    /// [`Camera::look_at`].
    #[must_use]
    pub fn facing(position: DVec3, forward: DVec3, up: DVec3, vertical_fov: f32, near: f32) -> Option<Camera> {
        let back = (-forward).try_normalize()?;
        let right = up.try_normalize()?.cross(back);
        let right = if right.length() > 1e-6 { right.normalize() } else { return None };
        let axes = [right, back.cross(right), back].map(|axis| axis.extend(0.0));
        let transform = DMat4::from_cols(axes[0], axes[1], axes[2], position.extend(1.0));
        transform.is_finite().then_some(Camera {
            transform,
            vertical_fov,
            near,
            far: None,
            movement: Movement::default(),
        })
    }

    /// Frames a box: seen from the front right, somewhat above. The sphere around the box touches the picture's upper and
    /// lower border where the picture is at least as wide as high. A box without size is seen from about 1 m away.
    #[must_use]
    pub fn framing(bounds: Bounds) -> Camera {
        let radius = if bounds.radius() > 0.0 { bounds.radius() } else { 0.5 };
        let distance = radius / (FRAMING_FOV * 0.5).sin();
        let target = bounds.center();
        let back = DVec3::new(0.6, 0.42, 1.0).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let axes = [right, back.cross(right), back].map(|axis| axis.extend(0.0));
        let position = (target + back * distance).extend(1.0);
        Camera {
            transform: DMat4::from_cols(axes[0], axes[1], axes[2], position),
            vertical_fov: FRAMING_FOV as f32,
            near: (radius * FRAMING_NEAR).max(f64::from(f32::MIN_POSITIVE)) as f32,
            far: None,
            movement: Movement::default(),
        }
    }

    /// The camera's place in the world.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.transform.w_axis.truncate()
    }

    /// From the world's space to the camera's.
    #[must_use]
    pub fn view(&self) -> DMat4 {
        self.transform.inverse()
    }

    /// From the camera's space to Vulkan's clip space: y down, depth reversed (1 on the near plane, 0 on the far
    /// plane, or infinitely far if there is none).
    /// `aspect` is width over height.
    #[must_use]
    pub fn projection(&self, aspect: f64) -> Mat4 {
        let focal = 1.0 / (f64::from(self.vertical_fov) * 0.5).tan();
        // Depth at a distance is offset / distance - slope.
        let near = f64::from(self.near);
        let slope = self.far.map_or(0.0, |far| near / (f64::from(far) - near));
        DMat4::from_cols(
            DVec4::new(focal / aspect, 0.0, 0.0, 0.0),
            DVec4::new(0.0, -focal, 0.0, 0.0),
            DVec4::new(0.0, 0.0, slope, -1.0),
            DVec4::new(0.0, 0.0, near + near * slope, 0.0),
        )
        .as_mat4()
    }

    /// The camera at a frame.
    #[must_use]
    pub fn at(&self, frame: u64) -> Camera {
        Camera { transform: self.movement.at(frame, self.transform), ..*self }
    }
}

/// Vertical field of view of a camera that was framed automatically: 40°.
const FRAMING_FOV: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// Its near distance, as a share of the radius of what it frames. Depth is reversed floating point, so a small one costs
/// no precision.
const FRAMING_NEAR: f64 = 0.01;
