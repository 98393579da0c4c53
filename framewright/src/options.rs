//! What a renderer is made with, and keeps.

use crate::files::FileOptions;
use framewright_graph::base::Root;
use framewright_graph::compile;
use framewright_graph::shader::DrawInterfaces;
use framewright_passes::draw;
use framewright_vulkan::{ExecutorOptions, Helper, PrecompiledShaders, SetLayouts, ShaderCompilers};
use std::path::PathBuf;
use std::sync::Arc;

/// What a [`Renderer`](crate::Renderer) is made with, and keeps. Begin with the default, and set fields.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RendererOptions {
    /// How the files of the pipeline are found.
    pub files: FileOptions,
    /// Settings files, of which later ones are stronger.
    pub settings: Vec<PathBuf>,
    /// Folders of shaders beside that of the pipeline, which is looked in first.
    pub shaders: Vec<Root>,
    /// SPIR-V of the program's own, by the names of files that no folder has: a pipeline says `FullScreen("post.spv")`.
    pub spirv: Vec<(Arc<str>, Arc<[u8]>)>,
    /// Commands that compile HLSL, Slang and WGSL. [`ShaderCompilers::of_environment`] has those that the user names.
    pub shader_compilers: ShaderCompilers,
    /// What the program's draws bring along; by default what [`SceneDrawSource`](crate::SceneDrawSource) does.
    pub draws: DrawInterfaces,
    /// Layouts of sets that the program makes and binds itself, which [`RendererOptions::draws`] tells.
    pub set_layouts: SetLayouts,
    /// The process that compiles shaders; `None`: this one, without limits. See [`crate::vulkan::helper`].
    pub helper: Option<Helper>,
    /// Shaders that were compiled ahead. A program without the feature `shader-compiler` needs them, or a helper that has it.
    pub precompiled: Option<PrecompiledShaders>,
    /// How Plans are made.
    pub compile: compile::Options,
    /// How they are executed.
    pub executor: ExecutorOptions,
}

impl Default for RendererOptions {
    fn default() -> Self {
        RendererOptions {
            files: FileOptions::default(),
            settings: Vec::new(),
            shaders: Vec::new(),
            spirv: Vec::new(),
            shader_compilers: ShaderCompilers::default(),
            draws: draw::interfaces(),
            set_layouts: SetLayouts::default(),
            helper: None,
            precompiled: None,
            compile: compile::Options::default(),
            executor: ExecutorOptions::default(),
        }
    }
}
