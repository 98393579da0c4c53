//! The whole scene.

use super::bounds::Bounds;
use super::camera::{Camera, NamedCamera};
use super::light::{PointLight, Sky, Sun};
use super::material::{AlphaMode, Material, Texture};
use super::mesh::Mesh;
use super::movement::Movement;
use super::object::Object;
use framewright_graph::frame::DrawList;

/// Everything that a frame is drawn from. Every index in it is valid and every number finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Triangle meshes.
    pub meshes: Vec<Mesh>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Base colour textures.
    pub textures: Vec<Texture>,
    /// Objects to draw, in the file's order.
    pub objects: Vec<Object>,
    /// The one light that is infinitely far away.
    pub sun: Sun,
    /// Light that arrives from everywhere alike, linear.
    pub ambient: [f32; 3],
    /// Lights with a position.
    pub point_lights: Vec<PointLight>,
    /// The background.
    pub sky: Sky,
    /// What all light of the file was multiplied by: 1 where its own numbers stand here.
    pub exposure: f64,
    /// From where it is seen by views that ask for no camera.
    pub camera: Camera,
    /// Cameras that views may ask for.
    pub cameras: Vec<NamedCamera>,
    /// Content of the file that isn't drawn, each a sentence without final stop ("mesh 2: vertex colours are ignored").
    /// Names in it are escaped.
    pub notes: Vec<String>,
    /// Mistakes in the file that were passed over, each with what was left out or changed because of it, for people: a file without any
    /// is drawn as it says.
    pub mistakes: Vec<String>,
}

impl Scene {
    /// The camera of that name, or without a name the default one; `None` if the scene has no such camera.
    #[must_use]
    pub fn camera_named(&self, name: Option<&str>) -> Option<&Camera> {
        match name {
            None => Some(&self.camera),
            Some(name) => self.cameras.iter().find(|camera| camera.name == name).map(|found| &found.camera),
        }
    }

    /// The box around all objects, in the world; `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        self.objects
            .iter()
            .map(|object| self.meshes[object.mesh].bounds.transformed(object.transform))
            .reduce(Bounds::union)
    }

    /// A length that is typical of the scene, metres: the geometric mean of the radius of the box around all objects and of the
    /// median radius of the boxes around each. A floor that is far wider than what stands on it makes it only somewhat larger.
    /// Objects that can't be seen, without area or smaller than a millionth of all, don't count. 1 if there is nothing to measure.
    #[must_use]
    pub fn size(&self) -> f64 {
        let around = self.bounds().map_or(0.0, Bounds::radius);
        let radius = |object: &Object| self.meshes[object.mesh].bounds.transformed(object.transform).radius();
        let seen = self
            .objects
            .iter()
            .filter(|object| radius(object) > around * 1e-6 && self.meshes[object.mesh].has_area(object.transform));
        let mut radii: Vec<f64> = seen.map(radius).collect();
        let middle = radii.len() / 2;
        if radii.is_empty() {
            return 1.0;
        }
        let (_, median, _) = radii.select_nth_unstable_by(middle, f64::total_cmp);
        let size = (*median * around).sqrt();
        if size > 0.0 { size } else { 1.0 }
    }

    /// Nearer than this to a point light, metres, a surface gets no more of its light. A share of the scene's size.
    #[must_use]
    pub fn nearest_to_light(&self) -> f64 {
        self.size() / 512.0
    }

    /// The draw list of an object. Objects that fade by leaving out fragments are in the one with alpha-masked objects.
    #[must_use]
    pub fn draw_list(&self, object: &Object) -> DrawList {
        match self.materials[object.material].alpha {
            AlphaMode::Blend => DrawList::Transparent,
            AlphaMode::Opaque if !object.fades() => DrawList::Opaque,
            AlphaMode::Opaque | AlphaMode::Mask { .. } => DrawList::Masked,
        }
    }

    /// How many objects are in a draw list.
    #[must_use]
    pub fn count(&self, list: DrawList) -> usize {
        self.objects.iter().filter(|object| self.draw_list(object) == list).count()
    }

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

    /// The scene as it stands at a frame, in which nothing moves any more.
    #[must_use]
    pub fn still_at(&self, frame: u64) -> Scene {
        let mut scene = self.at(frame);
        let cameras = scene.cameras.iter_mut().map(|camera| &mut camera.camera.movement);
        let objects = scene.objects.iter_mut().map(|object| &mut object.movement);
        objects.chain(cameras).chain([&mut scene.camera.movement]).for_each(|movement| *movement = Movement::default());
        scene
    }

    /// The scene without vertices, texels and names: places of things, and materials, which still name textures.
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
            exposure: self.exposure,
            camera: self.camera,
            cameras: self.cameras.clone(),
            notes: Vec::new(),
            mistakes: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::text;
    use framewright_graph::base::Sources;

    fn passing() -> Scene {
        let file = include_str!("../../../scenes/passing.ron");
        text::read(&mut Sources::default(), "passing.ron", "passing.ron", file.to_owned()).expect("a scene")
    }

    #[test]
    fn a_scene_that_is_held_still_stands_where_it_was_at_that_frame_ever_after() {
        let moving = passing();
        assert!(moving.moves());
        for frame in [0, 1, 29] {
            let (still, then) = (moving.still_at(frame), moving.at(frame));
            assert!(!still.moves());
            for later in [0, 1, 100] {
                assert_eq!(still.at(later), still, "{frame}, then {later}");
                assert_eq!(still.still_at(later), still, "{frame}, then {later}");
            }
            let places = |scene: &Scene| scene.objects.iter().map(|object| object.transform).collect::<Vec<_>>();
            assert_eq!(places(&still), places(&then));
            // Where an object was at the frame before is where it is.
            assert!(still.objects.iter().all(|object| object.transform_at(1) == object.transform));
            assert_eq!(still.camera.transform, then.camera.transform);
            // Nothing else of it is another.
            assert_eq!((&still.meshes, &still.materials, &still.sky), (&moving.meshes, &moving.materials, &moving.sky));
        }
        let camera = |frame| moving.still_at(frame).camera.transform;
        assert!(camera(0) != camera(29) && moving.still_at(0).objects != moving.still_at(29).objects);
    }
}
