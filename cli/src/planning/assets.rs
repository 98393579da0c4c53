//! The files that a Plan names, shaders and pictures, and the process that compiles shaders.

use super::helper;
use crate::command_line::args::PipelineArguments;
use crate::error::Error;
use framewright_graph::base::{ReadFiles, Root};
use framewright_passes::draw;
use framewright_passes::shipped::SHADERS;
use framewright_passes::texture_files::TextureFiles;
use framewright_vulkan::{Helper, ShaderLibrary};
use std::path::PathBuf;

/// Where the shaders and pictures that a Plan names come from.
pub(crate) struct Assets {
    /// Shaders of the folder, then shipped ones.
    pub(crate) shaders: ShaderLibrary,
    /// The process that compiles them.
    pub(crate) helper: Helper,
    /// Pictures of the folder.
    pub(crate) textures: TextureFiles,
}

impl Assets {
    /// Those of a folder; `None`: shipped ones alone. All files that are read, now or later, are recorded in `read`.
    ///
    /// # Errors
    /// If the system doesn't tell where this program lies.
    pub(crate) fn of(root: Option<&Root>, arguments: &PipelineArguments, read: &ReadFiles) -> Result<Assets, Error> {
        let recorded = |what| root.map(|root| root.clone().recorded(read, what));
        let helper = helper::with(&arguments.limits, arguments.caching)?;
        let folder = recorded("the shader itself").into_iter().collect();
        Ok(Assets {
            shaders: ShaderLibrary::new(folder, SHADERS, draw::interface).with_helper(&helper),
            helper,
            textures: TextureFiles::new(
                recorded("the texture itself").unwrap_or_else(|| Root::new(PathBuf::default())),
            ),
        })
    }
}
