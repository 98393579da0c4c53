//! Limits of a scene. A file beyond them is refused with a message, before memory is spent on it.

/// Bytes of a scene file, and of all data that a glTF file names beside itself: 512 MiB.
pub const FILE_BYTES: u64 = 512 << 20;
/// Bytes of a scene in text form: 4 MiB.
pub const TEXT_BYTES: u64 = 4 << 20;
/// Bytes of the JSON of a glTF file: 64 MiB.
pub const JSON_BYTES: usize = 64 << 20;
/// Vertices of all meshes together.
pub const VERTICES: usize = 16 << 20;
/// Indices of all meshes together.
pub const INDICES: usize = 48 << 20;
/// Objects.
pub const OBJECTS: usize = 250_000;
/// Point lights.
pub const POINT_LIGHTS: usize = 4096;
/// Width and height of a texture, texels. Every device that the project runs on has it.
pub const TEXTURE_SIDE: u32 = 8192;
/// Bytes of all textures together, decoded: 1 GiB.
pub const TEXTURE_BYTES: u64 = 1 << 30;
/// Largest coordinate of anything in the world, metres: beyond the moon.
pub const COORDINATE: f64 = 1e9;
/// Largest radiance, intensity or emissive strength.
pub const RADIANCE: f64 = 1e9;
/// Notes about content that isn't drawn; more are counted only.
pub const NOTES: usize = 20;
