//! A scene as plain data.

mod bounds;
mod camera;
mod light;
mod material;
mod mesh;
mod movement;
mod object;
mod scene;

pub use bounds::Bounds;
pub use camera::{Camera, NamedCamera};
pub use light::{PointLight, Sky, Sun};
pub use material::{AlphaMode, Material, Sampler, Texture, Wrap};
pub use mesh::Mesh;
pub use movement::{FRAME_SECONDS, Movement};
pub use object::Object;
pub use scene::Scene;
