//! Shaders by name: GLSL from folders or shipped with the program, compiled to SPIR-V and reflected. Needs no device.

mod alpha;
mod bindings;
mod compile;
mod eyes;
mod files;
mod layers;
mod library;
mod module;
mod reflect;
mod rotation;

pub use library::{CompiledCompute, CompiledShader, ShaderLibrary, Spirv};
