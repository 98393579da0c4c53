//! How things move: rigidly and steadily, by the number of the frame, so that each frame can be drawn again.

use glam::{DMat3, DMat4, DQuat, DVec3};

/// Seconds from one frame to the next.
pub const FRAME_SECONDS: f64 = 1.0 / 60.0;

/// A steady movement. The default is none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Movement {
    /// Metres a second along the world's axes.
    pub velocity: DVec3,
    /// The axis through the thing's own place, in the world's space; its length is the speed, radians a second.
    pub spin: DVec3,
}

impl Movement {
    /// Whether nothing moves.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Movement::default()
    }

    /// The place at a frame of a thing with this transform; at frame 0 the transform itself.
    #[must_use]
    pub fn at(&self, frame: u64, transform: DMat4) -> DMat4 {
        let seconds = frame as f64 * FRAME_SECONDS;
        if seconds == 0.0 || self.is_none() {
            return transform;
        }
        let turned = DMat3::from_quat(DQuat::from_scaled_axis(self.spin * seconds)) * DMat3::from_mat4(transform);
        let place = transform.w_axis.truncate() + self.velocity * seconds;
        let [x, y, z] = [turned.x_axis, turned.y_axis, turned.z_axis].map(|axis| axis.extend(0.0));
        DMat4::from_cols(x, y, z, place.extend(1.0))
    }
}
