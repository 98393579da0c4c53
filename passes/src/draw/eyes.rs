//! Two eyes: their places and frusta.

use crate::scene::Camera;
use framewright_graph::frame::Eye;
use glam::{DMat3, DMat4, DVec3};

/// The eyes of a viewer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eyes {
    /// The left one.
    pub left: EyeSight,
    /// The right one.
    pub right: EyeSight,
}

/// The place and the frustum of an eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EyeSight {
    /// How far it is from between the eyes, metres along the camera's axes: to the right, up, and back.
    pub place: DVec3,
    /// The tangents of the angles from straight ahead to the frustum's left, right, upper and lower side, as runtimes of
    /// headsets tell them; each pair adds up to more than 0. `None`: as the camera sees.
    pub tangents: Option<[f64; 4]>,
}

/// Metres between the pupils of grown people, in the mean: N. A. Dodgson, "Variation and extrema of human interpupillary
/// distance", Proceedings of SPIE 5291, 2004.
const SEPARATION: f64 = 0.063;

impl Default for Eyes {
    fn default() -> Eyes {
        Eyes::apart(SEPARATION)
    }
}

impl Eyes {
    /// Eyes at a distance in metres that look straight ahead as the camera does.
    #[must_use]
    pub fn apart(separation: f64) -> Eyes {
        let at = |x| EyeSight { place: DVec3::new(x, 0.0, 0.0), tangents: None };
        Eyes { left: at(-0.5 * separation), right: at(0.5 * separation) }
    }

    /// Eyes at a distance in metres from each other, whose pictures coincide on a screen at another distance in metres:
    /// each looks straight ahead through a window that is off its middle, and never inwards.
    #[must_use]
    pub fn converging(separation: f64, distance: f64, camera: &Camera, aspect: f64) -> Eyes {
        let up = half_height(camera);
        let across = up * aspect;
        let at = |x: f64| {
            let shift = x / distance;
            EyeSight { place: DVec3::new(x, 0.0, 0.0), tangents: Some([across + shift, across - shift, up, up]) }
        };
        Eyes { left: at(-0.5 * separation), right: at(0.5 * separation) }
    }

    /// The sight of one eye.
    #[must_use]
    pub const fn of(&self, eye: Eye) -> EyeSight {
        match eye {
            Eye::Left => self.left,
            Eye::Right => self.right,
        }
    }

    /// A camera behind both eyes that sees all that either sees, from `camera`'s near plane on, and stands as it does. `aspect` is
    /// width over height of an eye's picture.
    #[must_use]
    pub fn around(&self, camera: &Camera, aspect: f64) -> Camera {
        let both = [self.left, self.right];
        let tangents = both.map(|eye| eye.tangents_of(camera, aspect));
        let most = |sides: [usize; 2]| tangents.iter().flat_map(|it| sides.map(|side| it[side])).fold(0.0, f64::max);
        // Its picture has the same ratio of width to height.
        let up = most([2, 3]).max(most([0, 1]) / aspect);
        let across = up * aspect;
        let off = |axis: usize| both.iter().map(|eye| eye.place[axis].abs()).fold(0.0, f64::max);
        // Rays of that slope through the eyes meet so far behind, and further by what rounding may take away.
        let back = both.iter().map(|eye| eye.place.z).fold(0.0, f64::max) + (off(0) / across).max(off(1) / up);
        let back = back * (1.0 + 1e-6);
        let mut behind = Camera { vertical_fov: (2.0 * up.atan()) as f32, ..*camera };
        behind.vertical_fov = behind.vertical_fov.next_up().next_up();
        let moved = camera.position() + DMat3::from_mat4(camera.transform) * DVec3::new(0.0, 0.0, back);
        behind.transform.w_axis = moved.extend(1.0);
        // An eye ahead of the camera has its far plane so much farther off.
        let ahead = both.iter().map(|eye| -eye.place.z).fold(0.0, f64::max);
        behind.far = camera.far.map(|far| ((f64::from(far) + back + ahead) as f32).next_up());
        behind
    }
}

impl EyeSight {
    /// Its place, seen from between the eyes, metres along the axes of the world.
    pub(super) fn offset(&self, camera: &Camera) -> DVec3 {
        DMat3::from_mat4(camera.transform) * self.place
    }

    /// The matrix from the shaders' world space, whose origin is between the eyes, to this eye's clip space, if `world_to_clip` does
    /// so from between the eyes.
    pub(super) fn world_to_clip(&self, camera: &Camera, aspect: f64, world_to_clip: DMat4) -> DMat4 {
        self.window(camera, aspect) * world_to_clip * DMat4::from_translation(-self.offset(camera))
    }

    /// The tangents of its frustum.
    fn tangents_of(&self, camera: &Camera, aspect: f64) -> [f64; 4] {
        let up = half_height(camera);
        self.tangents.unwrap_or([up * aspect, up * aspect, up, up])
    }

    /// Takes the clip space of `camera` to that of the part of it that this eye sees.
    fn window(&self, camera: &Camera, aspect: f64) -> DMat4 {
        let [left, right, up, down] = self.tangents_of(camera, aspect);
        let half = half_height(camera);
        // Clip space is from −1 to 1 of what the camera sees, to the right and down.
        let scale = |half: f64, before: f64, after: f64| 2.0 * half / (before + after);
        let shift = |before: f64, after: f64| (before - after) / (before + after);
        // Before the division by w everything in it is w times as large.
        DMat4::from_cols_array_2d(&[
            [scale(half * aspect, left, right), 0.0, 0.0, 0.0],
            [0.0, scale(half, up, down), 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [shift(left, right), shift(up, down), 0.0, 1.0],
        ])
    }
}

/// The tangent of half the angle that a camera sees from top to bottom.
fn half_height(camera: &Camera) -> f64 {
    (f64::from(camera.vertical_fov) * 0.5).tan()
}
