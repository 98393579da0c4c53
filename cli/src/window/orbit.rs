//! A camera that the mouse moves around what it looks at.

use framewright_passes::scene::{Camera, Scene};
use glam::DVec3;

/// How far the camera turns while the mouse crosses a pixel, in radians.
const TURN: f64 = 0.005;
/// By how much a step of the mouse wheel changes the distance.
const STEP: f64 = 1.1;
/// The camera stays this far from the vertical, in radians.
const LEAST_TILT: f64 = 0.01;

/// A camera around a point. Before the mouse moves it, it is the scene's own, which may move by itself.
pub(super) struct Orbit {
    own: Camera,
    /// `None`: the scene's own.
    moved: Option<CameraMove>,
    /// The point that it looks at to begin with.
    target: DVec3,
}

/// Where the mouse has moved the camera.
#[derive(Debug, Clone, Copy)]
struct CameraMove {
    target: DVec3,
    distance: f64,
    /// Around the vertical, from +z towards +x.
    yaw: f64,
    /// Above the horizon.
    pitch: f64,
}

impl Orbit {
    /// The scene's camera, around the point straight ahead that is as far away as the middle of the scene.
    pub(super) fn new(scene: &Scene) -> Orbit {
        let own = scene.camera;
        let middle = scene.bounds().map_or(DVec3::ZERO, |bounds| bounds.center());
        let ahead = -own.transform.z_axis.truncate();
        let distance = (middle - own.position()).dot(ahead).max(f64::from(own.near) * 10.0);
        Orbit { own, moved: None, target: own.position() + ahead * distance }
    }

    /// Goes on with another scene: where the mouse has moved the camera to, it stays.
    pub(super) fn follow(&mut self, scene: &Scene) {
        *self = Orbit { moved: self.moved, ..Orbit::new(scene) };
    }

    /// The camera.
    pub(super) fn camera(&self) -> Camera {
        self.moved.and_then(|moved| moved.camera(&self.own)).unwrap_or(self.own)
    }

    /// Turns the camera by a move of the mouse, in pixels.
    pub(super) fn turn(&mut self, [x, y]: [f64; 2]) {
        let moved = self.begin();
        moved.yaw -= x * TURN;
        let most = std::f64::consts::FRAC_PI_2 - LEAST_TILT;
        moved.pitch = (moved.pitch + y * TURN).clamp(-most, most);
    }

    /// Shifts the camera and what it looks at by a move of the mouse, in shares of the picture's height.
    pub(super) fn shift(&mut self, [x, y]: [f64; 2]) {
        let camera = self.camera();
        let axes = [camera.transform.x_axis, camera.transform.y_axis].map(|axis| axis.truncate());
        let height = 2.0 * (f64::from(camera.vertical_fov) / 2.0).tan();
        let moved = self.begin();
        moved.target += (axes[1] * y - axes[0] * x) * height * moved.distance;
    }

    /// Goes nearer by steps of the mouse wheel, or farther away by negative ones.
    pub(super) fn approach(&mut self, steps: f64) {
        let moved = self.begin();
        let distance = moved.distance * STEP.powf(-steps);
        if distance.is_normal() {
            moved.distance = distance;
        }
    }

    /// Goes back to the scene's own camera.
    pub(super) fn reset(&mut self) {
        self.moved = None;
    }

    fn begin(&mut self) -> &mut CameraMove {
        let (position, target) = (self.own.position(), self.target);
        self.moved.get_or_insert_with(|| {
            let back = position - target;
            let distance = back.length();
            let pitch = (back.y / distance).clamp(-1.0, 1.0).asin();
            CameraMove { target, distance, yaw: back.x.atan2(back.z), pitch }
        })
    }
}

impl CameraMove {
    /// `None` where the numbers have left what a camera can be.
    fn camera(&self, own: &Camera) -> Option<Camera> {
        let back = DVec3::new(self.yaw.sin() * self.pitch.cos(), self.pitch.sin(), self.yaw.cos() * self.pitch.cos());
        let position = self.target + back * self.distance;
        let moved = Camera::look_at(position, self.target, DVec3::Y, own.vertical_fov, own.near)?;
        Some(Camera { far: own.far, ..moved })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        framewright::load_scene("spheres_and_cubes").expect("it is shipped")
    }

    #[test]
    fn the_scenes_own_camera_stays_until_the_mouse_moves_and_comes_back() {
        let scene = scene();
        let mut orbit = Orbit::new(&scene);
        assert_eq!(orbit.camera(), scene.camera);
        orbit.turn([30.0, -20.0]);
        assert_ne!(orbit.camera(), scene.camera);
        orbit.reset();
        assert_eq!(orbit.camera(), scene.camera);
    }

    #[test]
    fn a_turn_keeps_the_distance_and_a_turn_back_the_place() {
        let scene = scene();
        let mut orbit = Orbit::new(&scene);
        let (begin, target) = (scene.camera.position(), orbit.target);
        orbit.turn([300.0, 150.0]);
        let away = orbit.camera().position();
        assert!((away.distance(target) - begin.distance(target)).abs() < 1e-9);
        assert!(away.distance(begin) > 0.1);
        orbit.turn([-300.0, -150.0]);
        assert!(orbit.camera().position().distance(begin) < 1e-6);
        // Not even a very long way leads over the top, or to where nothing is.
        for _ in 0..100 {
            orbit.turn([1e4, 1e4]);
            orbit.approach(100.0);
            orbit.shift([1e3, -1e3]);
            assert!(orbit.camera().transform.is_finite());
        }
    }
}
