//! The files that a Plan names, shaders and pictures, and the process that compiles shaders.

use crate::command_line::args::PipelineArguments;
use crate::error::Error;
use crate::files::inputs::{self, FileRole};
use crate::system::Exit;
use framewright_graph::base::{ReadFiles, Root, Sources};
use framewright_graph::shader::{self, DrawInterfaces};
use framewright_passes::draw;
use framewright_passes::texture_files::TextureFiles;
use framewright_vulkan::{Helper, PrecompiledShaders, ShaderLibrary};

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
    /// If the interface that the command line names is wrong.
    pub(crate) fn of(
        root: Option<&Root>,
        arguments: &PipelineArguments,
        helper: Helper,
        read: &ReadFiles,
    ) -> Result<Assets, Error> {
        let draws = draws(arguments, read)?;
        let shaders =
            framewright::shaders(root, &[], draws, Some(&helper), read).with_precompiled(precompiled(arguments));
        Ok(Assets { shaders, helper, textures: framewright::textures(root, read) })
    }
}

/// The folder of shaders that the command line names, to which those are added that are compiled.
pub(crate) fn precompiled(arguments: &PipelineArguments) -> Option<PrecompiledShaders> {
    arguments.precompiled.as_ref().map(|folder| PrecompiledShaders::in_folder(folder).adding())
}

/// What draws bring along: those of the program whose interface the command line names, or of a scene.
///
/// # Errors
/// If the interface is wrong.
pub(crate) fn draws(arguments: &PipelineArguments, read: &ReadFiles) -> Result<DrawInterfaces, Error> {
    let Some(path) = arguments.interface.as_deref() else { return Ok(draw::interfaces()) };
    let text = inputs::text(FileRole::INTERFACE, path, shader::LARGEST_INTERFACE, read)?;
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let mut sources = Sources::default();
    DrawInterfaces::read(&mut sources, &path.to_string_lossy(), &name, text)
        .map_err(|mistakes| Error::mistakes(sources, mistakes, Exit::Found))
}
