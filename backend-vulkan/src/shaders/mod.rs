//! Shaders by name: GLSL from folders or shipped with the program, compiled to SPIR-V and reflected. Needs no device.

mod alpha;
mod bindings;
mod capabilities;
mod compile;
mod compilers;
mod eyes;
mod files;
mod layers;
mod library;
mod messages;
mod module;
mod reflect;
mod rotation;
mod text;

pub(crate) use compile::{Failure, IncludedFile, Job, LARGEST_SPIRV, compile};
pub use library::{CompiledCompute, CompiledShader, ShaderLibrary, Spirv};
