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
//! 1: there is no division by π. Mirrored light comes on top; shaders decide it.
//!
//! A file may have lights in a unit of its own, such as lux. They are multiplied when it is read: see [`Scene::exposure`].

mod defaults;
mod exposure;
#[cfg(feature = "gltf")]
pub mod gltf;
pub mod limits;
mod load;
mod model;
mod pattern;
mod shapes;
pub mod text;

pub use load::{SceneError, load, load_recorded};
pub use model::{
    AlphaMode, Bounds, Camera, FRAME_SECONDS, Material, Mesh, Movement, NamedCamera, Object, PointLight, Sampler,
    Scene, Sky, Sun, Texture, Wrap,
};
