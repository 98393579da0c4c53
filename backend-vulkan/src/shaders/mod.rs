//! Shaders by name: GLSL from folders or shipped with the program, compiled to SPIR-V, files in HLSL, Slang and WGSL, compiled by the
//! same compiler or by commands, and SPIR-V of other compilers; all are reflected. Needs no device.

mod addresses;
mod bindings;
mod block_layout;
mod by_command;
#[cfg(feature = "shader-compiler")]
mod by_shaderc;
mod capabilities;
mod colors;
mod compile;
mod compiler_words;
mod compilers;
mod constants;
#[cfg(test)]
mod corpus;
mod coverage;
mod distances;
mod extensions;
mod eye_values;
mod eyes;
mod eyes_of_modules;
mod file_stages;
mod files;
mod foreign_files;
mod hlsl_words;
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
mod module_lines;
mod module_words;
mod needs;
mod newer_version;
mod place_names;
mod precompiled_shaders;
mod program_resources;
mod program_supply;
mod push_constants;
mod reflect;
mod registers;
mod rotation;
mod sampler_pairs;
mod set_layouts;
mod shader_compilers;
mod spirv_cache;
mod stage_sources;
mod stages;
mod text;
mod validator;
mod varyings;
mod view_semantics;

pub use library::{CompiledCompute, CompiledShader, ShaderLibrary};
pub use precompiled_shaders::PrecompiledShaders;
pub use set_layouts::SetLayouts;
pub use shader_compilers::{BadCompiler, ShaderCompilers};
pub use stages::Spirv;

pub(crate) use compile::compile;
