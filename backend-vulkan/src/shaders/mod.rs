//! Shaders by name: GLSL from folders or shipped with the program, compiled to SPIR-V and reflected. Needs no device.

mod bindings;
mod block_layout;
#[cfg(feature = "shader-compiler")]
mod by_shaderc;
mod capabilities;
mod colors;
mod compile;
mod compilers;
mod coverage;
mod extensions;
mod eyes;
mod files;
mod indexing;
mod layers;
mod library;
mod macros;
mod mentioned_names;
mod messages;
mod module;
mod needs;
mod precompiled_shaders;
mod reflect;
mod rotation;
mod spirv_cache;
mod stages;
mod text;
mod validator;
mod varyings;

pub use library::{CompiledCompute, CompiledShader, ShaderLibrary};
pub use precompiled_shaders::PrecompiledShaders;
pub use stages::Spirv;

pub(crate) use compile::compile;
