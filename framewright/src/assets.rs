//! The files that a Plan names.

use crate::error::Error;
use crate::options::RendererOptions;
use framewright_graph::base::{ReadFiles, Root};
use framewright_graph::plan::Plan;
use framewright_passes::shipped::SHADERS;
use framewright_passes::texture_files::TextureFiles;
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderLibrary};
use std::path::PathBuf;

/// The files that a Plan names: shaders and pictures.
pub struct Assets {
    /// Shaders of the folder, then of the folders of [`RendererOptions::shaders`], then shipped ones.
    pub shaders: ShaderLibrary,
    /// Pictures of the folder.
    pub textures: TextureFiles,
}

impl Assets {
    /// Those of the folder `root`; `None`: shipped ones alone. All files that are read, now or later, are recorded in `read`.
    #[must_use]
    pub fn new(root: Option<&Root>, options: &RendererOptions, read: &ReadFiles) -> Assets {
        let folders = root.into_iter().chain(&options.shaders);
        let folders = folders.map(|root| root.clone().recorded(read, "the shader itself"));
        let shaders = ShaderLibrary::new(folders.collect(), SHADERS, options.draws.clone())
            .with_spirv(options.spirv.clone())
            .with_compilers(options.shader_compilers.clone())
            .with_set_layouts(options.set_layouts.clone());
        let shaders = match &options.helper {
            Some(helper) => shaders.with_helper(helper),
            None => shaders,
        };
        let pictures = root.map(|root| root.clone().recorded(read, "the texture itself"));
        Assets {
            shaders: shaders.with_precompiled(options.precompiled.clone()),
            textures: TextureFiles::new(pictures.unwrap_or_else(|| Root::new(PathBuf::default()))),
        }
    }

    /// An executor of `plan`.
    ///
    /// # Errors
    /// Those of [`Executor::with_textures`].
    pub fn executor(&mut self, device: &Device, plan: &Plan, options: &ExecutorOptions) -> Result<Executor, Error> {
        Ok(Executor::with_textures(device, plan, &mut self.shaders, &mut self.textures, options)?)
    }
}
