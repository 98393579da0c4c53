//! A pipeline that was read, and where its shaders and pictures come from.

use crate::error::Error;
use crate::files::{self, PipelineFile};
use framewright_graph::base::{FilePath, ReadFiles, Root, Sources};
use framewright_graph::frame::{TextureFile, TextureInfo, TextureProblem, Textures};
use framewright_graph::language::{self, Document, Files, Found, PipelineFiles, SettingsFile, Unread};
use framewright_graph::shader::DrawInterfaces;
use framewright_passes::shipped::SHADERS;
use framewright_passes::texture_files::TextureFiles;
use framewright_vulkan::{Helper, ShaderLibrary};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

/// A pipeline that was read.
#[derive(Debug)]
#[non_exhaustive]
pub struct Pipeline {
    /// Its entries, with values not yet chosen.
    pub document: Document,
    /// The texts that it was read from.
    pub sources: Arc<Sources>,
    /// Pictures of its folder.
    pub textures: TextureFiles,
    /// The paths of those that it names.
    pub pictures: BTreeSet<Arc<str>>,
}

/// The files that a pipeline names: of its language, and pictures.
struct NamedFiles {
    files: PipelineFiles,
    textures: TextureFiles,
    /// The paths of pictures that are named.
    pictures: BTreeSet<Arc<str>>,
}

impl Files for NamedFiles {
    fn read(&mut self, from: &FilePath, path: &str) -> Result<Found, Unread> {
        self.files.read(from, path)
    }

    fn picture(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        self.pictures.insert(file.path.clone());
        self.textures.info(file)
    }
}

impl PipelineFile {
    /// Reads it, its extensions, and the files that it names.
    ///
    /// # Errors
    /// [`Error::Mistakes`] with all mistakes that don't depend on settings, scene or device.
    pub fn read(self) -> Result<Pipeline, Error> {
        let textures = textures(self.root(), &self.read);
        let mut named = NamedFiles { files: self.files, textures, pictures: BTreeSet::new() };
        let mut sources = Sources::default();
        let read = language::read_extended(&mut sources, &mut named, self.own, self.extensions);
        match read {
            Ok(document) => {
                let NamedFiles { textures, pictures, .. } = named;
                Ok(Pipeline { document, sources: Arc::new(sources), textures, pictures })
            }
            Err(diagnostics) => {
                let mistakes = crate::Mistakes { sources, diagnostics };
                Err(Error::Mistakes { mistakes: Box::new(mistakes) })
            }
        }
    }
}

impl Pipeline {
    /// Reads settings files for it, one after the other.
    pub(crate) fn read_settings(&mut self, paths: &[PathBuf], read: &ReadFiles) -> Result<Vec<SettingsFile>, Error> {
        let mut sources = Sources::clone(&self.sources);
        let (mut settings, mut mistakes) = (Vec::with_capacity(paths.len()), Vec::new());
        for path in paths {
            let text = files::settings(path, read)?;
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
            match self.document.read_settings(&mut sources, &path.to_string_lossy(), &name, text) {
                Ok(file) => settings.push(file),
                Err(diagnostics) => mistakes.extend(diagnostics),
            }
        }
        if !mistakes.is_empty() {
            return Err(Error::mistakes(&sources, mistakes));
        }
        self.sources = Arc::new(sources);
        Ok(settings)
    }
}

/// Shaders of a pipeline's folder, then of `more` folders, then shipped ones. Files that are read are recorded in `read`.
#[must_use]
pub fn shaders(
    root: Option<&Root>,
    more: &[Root],
    draws: DrawInterfaces,
    helper: Option<&Helper>,
    read: &ReadFiles,
) -> ShaderLibrary {
    let folders = root.into_iter().chain(more).map(|root| root.clone().recorded(read, "the shader itself"));
    let library = ShaderLibrary::new(folders.collect(), SHADERS, draws);
    match helper {
        Some(helper) => library.with_helper(helper),
        None => library,
    }
}

/// Pictures of a pipeline's folder. Files that are read are recorded in `read`.
#[must_use]
pub fn textures(root: Option<&Root>, read: &ReadFiles) -> TextureFiles {
    let recorded = root.map(|root| root.clone().recorded(read, "the texture itself"));
    TextureFiles::new(recorded.unwrap_or_else(|| Root::new(PathBuf::default())))
}
