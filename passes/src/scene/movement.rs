//! How things move: rigidly and steadily, by the number of the frame, so that each frame can be drawn again.

use super::{Camera, Mesh, Object, Scene};
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

    /// Where a thing with this transform is at a frame; at frame 0 it is where it was.
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

impl Object {
    /// Where it is at a frame: [`Object::transform`] then.
    #[must_use]
    pub fn transform_at(&self, frame: u64) -> DMat4 {
        self.movement.at(frame, self.transform)
    }
}

impl Camera {
    /// The camera at a frame.
    #[must_use]
    pub fn at(&self, frame: u64) -> Camera {
        Camera { transform: self.movement.at(frame, self.transform), ..*self }
    }
}

impl Scene {
    /// Whether an object moves, or a camera.
    #[must_use]
    pub fn moves(&self) -> bool {
        let objects = self.objects.iter().map(|object| object.movement);
        let cameras = self.cameras.iter().map(|camera| camera.camera.movement);
        objects.chain(cameras).chain([self.camera.movement]).any(|movement| !movement.is_none())
    }

    /// The scene as it is at a frame.
    #[must_use]
    pub fn at(&self, frame: u64) -> Scene {
        let mut scene = self.clone();
        for object in &mut scene.objects {
            object.transform = object.transform_at(frame);
        }
        scene.camera = scene.camera.at(frame);
        for camera in &mut scene.cameras {
            camera.camera = camera.camera.at(frame);
        }
        scene
    }

    /// Where things are and how they look from afar: the scene without vertices, texels and names. Its materials still name
    /// textures.
    #[must_use]
    pub(crate) fn outline(&self) -> Scene {
        let empty = |mesh: &Mesh| Mesh {
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            indices: Vec::new(),
            bounds: mesh.bounds,
        };
        Scene {
            meshes: self.meshes.iter().map(empty).collect(),
            materials: self.materials.clone(),
            textures: Vec::new(),
            objects: self.objects.iter().map(|object| Object { name: String::new(), ..object.clone() }).collect(),
            sun: self.sun,
            ambient: self.ambient,
            point_lights: self.point_lights.clone(),
            sky: self.sky,
            camera: self.camera,
            cameras: self.cameras.clone(),
            notes: Vec::new(),
        }
    }
}
