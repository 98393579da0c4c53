//! Shaders by name: GLSL from folders or shipped with the program, compiled to SPIR-V, and SPIR-V of other compilers; both are
//! reflected. Needs no device.

mod bindings;
mod block_layout;
#[cfg(feature = "shader-compiler")]
mod by_shaderc;
mod capabilities;
mod colors;
mod compile;
mod compilers;
mod coverage;
mod distances;
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
mod module_capabilities;
mod module_checks;
mod module_file;
mod module_words;
mod needs;
mod place_names;
mod precompiled_shaders;
mod program_resources;
mod reflect;
mod rotation;
mod sampler_pairs;
mod set_layouts;
mod spirv_cache;
mod stage_sources;
mod stages;
mod text;
mod validator;
mod varyings;

pub use library::{CompiledCompute, CompiledShader, ShaderLibrary};
pub use precompiled_shaders::PrecompiledShaders;
pub use set_layouts::SetLayouts;
pub use stages::Spirv;

pub(crate) use compile::compile;
