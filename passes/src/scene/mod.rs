//! A scene as plain data: meshes, materials, textures, objects, lights, a sky and a camera.
//!
//! Space is glTF's: right-handed, y up, metres; front faces are counter-clockwise seen from outside. Colours are linear
//! with Rec. 709 primaries unless said otherwise.
//!
//! Light has no absolute unit; one rule ties everything to the picture. The radiance that leaves a surface of base
//! colour `c` with unit normal `n` is
//!
//! ```text
//! emissive + c · (ambient + sun.color · max(n · −sun.direction, 0) + Σ color · intensity · falloff(d) · max(n · l, 0))
//! ```
//!
//! with `d` and `l` the distance and direction to each point light; so a white surface that faces a sun of colour 1 gives
//! 1: there is no division by π. What a surface mirrors comes on top and is the shader's own.

mod bounds;
mod camera;
mod defaults;
mod facts;
pub mod gltf;
mod light;
pub mod limits;
mod load;
mod material;
mod mesh;
mod movement;
mod notes;
mod pattern;
mod peak;
mod shapes;
pub mod text;

pub use bounds::Bounds;
pub use camera::{Camera, NamedCamera};
pub use facts::Found;
pub use light::{PointLight, Sky, Sun};
pub use material::{AlphaMode, Material, Sampler, Texture, Wrap};
pub use mesh::Mesh;
pub use movement::{FRAME_SECONDS, Movement};

use glam::{DMat3, DMat4, Mat3};
pub use load::{SceneError, load, load_recorded};
use notes::Notes;

/// Everything that a frame is drawn from. Every index in it is valid and every number finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Triangle meshes.
    pub meshes: Vec<Mesh>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Base colour textures.
    pub textures: Vec<Texture>,
    /// What is drawn, in the file's order.
    pub objects: Vec<Object>,
    /// The one light that is infinitely far away.
    pub sun: Sun,
    /// Light that arrives from everywhere alike, linear.
    pub ambient: [f32; 3],
    /// Lights with a position.
    pub point_lights: Vec<PointLight>,
    /// What is seen where no object is.
    pub sky: Sky,
    /// From where it is seen by views that ask for no camera.
    pub camera: Camera,
    /// Cameras that views may ask for.
    pub cameras: Vec<NamedCamera>,
    /// What the file holds that isn't drawn, each a sentence without final stop ("mesh 2: vertex colours are ignored").
    /// Names in it are escaped.
    pub notes: Vec<String>,
}

/// A mesh with a material, somewhere.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Name for people; need not be unique and may hold any character.
    pub name: String,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// From the mesh's space to the world's; affine (its last row is 0 0 0 1).
    pub transform: DMat4,
    /// How much of it is seen, −1 to 1, where 1 is all of it. At 0.3 three tenths of its pixels are drawn, in a fixed
    /// pattern; at −0.3 exactly the others. So what changes for something else fades into it without showing what is behind
    /// both. What is transparent fades by its opacity instead.
    pub cross_fade: f32,
    /// How it moves from where `transform` says that it is at frame 0.
    pub movement: Movement,
}

impl Object {
    /// Whether the transform turns the mesh inside out (an odd number of negative scales): its front faces are then
    /// clockwise.
    #[must_use]
    pub fn mirrored(&self) -> bool {
        DMat3::from_mat4(self.transform).determinant() < 0.0
    }

    /// Whether less than all of it is seen.
    #[must_use]
    pub fn fades(&self) -> bool {
        self.cross_fade < 1.0
    }

    /// The share of it that is seen, 0 to 1.
    #[must_use]
    pub fn shown_share(&self) -> f64 {
        let share = f64::from(self.cross_fade);
        if share < 0.0 { 1.0 + share } else { share }
    }

    /// Takes normals from the mesh's space to the world's, up to their length: the matrix of cofactors, which is the
    /// inverse transpose times the determinant, with the determinant's sign taken out so that normals of mirrored objects
    /// still point outwards. Unlike the inverse it exists for flattened objects (a scale of 0) too.
    #[must_use]
    pub fn normal_matrix(&self) -> Mat3 {
        let m = DMat3::from_mat4(self.transform);
        let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        let largest = cofactors.to_cols_array().iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
        let scale = if largest > 0.0 { sign / largest } else { sign };
        (cofactors * scale).as_mat3()
    }
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
}
