//! The files of a pipeline: found on disk, else among those that are shipped.

use crate::error::Error;
use framewright_graph::base::{FilePath, ReadFiles, Root, Sources, text_of};
use framewright_graph::language::{FoundFile, LARGEST_FILE, PipelineFiles, ShippedFiles};
use framewright_passes::scene::{self, Scene, SceneError};
use framewright_passes::shipped;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

const PIPELINE: &str = "pipeline";
const EXTENSION: &str = "extension";

/// The words by which files are recorded that are read.
const THE_PIPELINE: &str = "the pipeline itself";
const AN_EXTENSION: &str = "an extension of the pipeline";
const THE_SETTINGS: &str = "the settings file itself";

/// Where the files may lie that a pipeline names.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reach {
    /// In the pipeline's own folder, and in folders within it.
    #[default]
    OwnFolder,
    /// In this folder and those within it. The pipeline must lie in it too.
    Within(PathBuf),
    /// Anywhere. For files that are trusted.
    Anywhere,
}

/// How the files of a pipeline are found.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct FileOptions {
    /// Where the files may lie that the pipeline names.
    pub reach: Reach,
    /// Extensions that are applied to the pipeline after those that it names itself: files, or paths of shipped ones.
    pub extensions: Vec<PathBuf>,
}

/// A pipeline file, not yet read as RON.
#[derive(Debug)]
pub struct PipelineFile {
    pub(crate) own: FoundFile,
    pub(crate) files: PipelineFiles,
    pub(crate) extensions: Vec<FoundFile>,
    pub(crate) root: Option<Root>,
    pub(crate) read: ReadFiles,
    /// Whether it is a shipped one, since there is no file of that name.
    pub(crate) shipped: bool,
}

impl PipelineFile {
    /// Finds the file `path`; where there is none, the shipped pipeline of that name. It and all files that it names, now or later, are
    /// recorded in `read`.
    ///
    /// # Errors
    /// If there is neither, it can't be read, or it lies outside of the folder that [`FileOptions::reach`] names.
    pub fn find(path: &Path, options: &FileOptions, read: &ReadFiles) -> Result<PipelineFile, Error> {
        match bytes(PIPELINE, path, read, THE_PIPELINE) {
            Ok(bytes) => {
                let name = name_of(path);
                let root = folder_of(path, &options.reach)?;
                let own = FoundFile { shown: path.to_string_lossy().into_owned(), relative: (&*name).into(), bytes };
                let files = PipelineFiles::beside(of_fragments(&root, read), &name, shipped::PIPELINES);
                Ok(PipelineFile::of(own, files, Some(root), read))
            }
            Err(Error::Unreadable { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
                let (file, text) = carried(PIPELINE, path, shipped::PIPELINES)?;
                let found = |relative| FoundFile { shown: file.to_owned(), relative, bytes: text.as_bytes().to_vec() };
                if options.extensions.is_empty() {
                    let files = PipelineFiles::shipped(shipped::PIPELINES);
                    return Ok(PipelineFile {
                        shipped: true,
                        ..PipelineFile::of(found(file.into()), files, None, read)
                    });
                }
                // Extensions of the user's own bring files of their own: the working directory takes the place of the folder.
                let root = limited(path, Root::new(".".into()), &options.reach)?;
                let files = PipelineFiles::of_shipped(of_fragments(&root, read), shipped::PIPELINES);
                let own = found(FilePath::Shipped(file.into()));
                Ok(PipelineFile { shipped: true, ..PipelineFile::of(own, files, Some(root), read) })
            }
            Err(error) => Err(error),
        }
        .and_then(|file| file.extended(&options.extensions))
    }

    /// A pipeline that the program carries within itself, which messages call `name`. The files that it names are shipped ones, and so
    /// are those of its extensions, which count as files beside it. Files that are read, now or later, are recorded in `read`.
    ///
    /// # Errors
    /// If an extension can't be read.
    pub fn carried(name: &str, text: &str, options: &FileOptions, read: &ReadFiles) -> Result<PipelineFile, Error> {
        let own = FoundFile { shown: name.to_owned(), relative: name.into(), bytes: text.as_bytes().to_vec() };
        let file = PipelineFile::of(own, PipelineFiles::shipped(shipped::PIPELINES), None, read);
        file.extended(&options.extensions)
    }

    /// Records in `read` the files that [`PipelineFile::find`] and [`PipelineFile::read`] are going to read, before any is read: the
    /// pipeline, its extensions and settings files.
    pub fn expect(path: &Path, options: &FileOptions, settings: &[PathBuf], read: &ReadFiles) {
        read.expect(THE_PIPELINE, path);
        options.extensions.iter().for_each(|file| read.expect(AN_EXTENSION, file));
        settings.iter().for_each(|file| read.expect(THE_SETTINGS, file));
    }

    fn of(own: FoundFile, files: PipelineFiles, root: Option<Root>, read: &ReadFiles) -> PipelineFile {
        PipelineFile { own, files, extensions: Vec::new(), root, read: read.clone(), shipped: false }
    }

    fn extended(mut self, paths: &[PathBuf]) -> Result<PipelineFile, Error> {
        for path in paths {
            let found = extension(path, &self.read, || match self.root {
                Some(_) => self.files.which(path),
                None => name_of(path).as_str().into(),
            })?;
            self.extensions.push(found);
        }
        Ok(self)
    }

    /// The folder of the files that it names; `None`: it is shipped, and so are they.
    #[must_use]
    pub fn root(&self) -> Option<&Root> {
        self.root.as_ref()
    }
}

/// The folder that the files which a pipeline or a Plan at `path` names come from: its own, or within the one that `reach` names.
///
/// # Errors
/// If it lies outside of that, or one of the folders can't be read.
pub fn folder_of(path: &Path, reach: &Reach) -> Result<Root, Error> {
    limited(path, Root::new(path.parent().unwrap_or(Path::new("")).to_owned()), reach)
}

/// Reads a scene; where there is no file `path`, the shipped one of that name.
///
/// # Errors
/// If there is neither, or the file is no scene.
pub fn load_scene(path: impl AsRef<Path>) -> Result<Scene, Error> {
    Ok(find_scene(path.as_ref(), &ReadFiles::default())?.0)
}

/// Does the same, and says whether the scene is a shipped one. All files that are read or looked for are recorded in `read`.
///
/// # Errors
/// Those of [`load_scene`].
pub fn find_scene(path: &Path, read: &ReadFiles) -> Result<(Scene, bool), Error> {
    // One that is missing may come.
    expect_scene(path, read);
    let is_missing = matches!(path.try_exists(), Ok(false));
    let scene = if is_missing {
        let (file, text) = carried("scene", path, shipped::SCENES)?;
        let mut sources = Sources::default();
        scene::text::read(&mut sources, file, file, text.to_owned())
            .map_err(|mistakes| SceneError::Text { sources, mistakes })
    } else {
        scene::load_recorded(path, read)
    };
    Ok((scene.map_err(|problem| Error::Scene(Box::new(problem)))?, is_missing))
}

/// Records in `read` the scene that is going to be read, before it is.
pub fn expect_scene(path: &Path, read: &ReadFiles) {
    read.expect("the scene itself", path);
}

fn of_fragments(root: &Root, read: &ReadFiles) -> Root {
    root.clone().recorded(read, "a fragment of the pipeline")
}

fn limited(pipeline: &Path, own: Root, reach: &Reach) -> Result<Root, Error> {
    let chosen = match reach {
        Reach::OwnFolder => return Ok(own),
        Reach::Anywhere => return Ok(own.allow_outside()),
        Reach::Within(chosen) => chosen,
    };
    let real = |folder: &Path| {
        let problem = |source| Error::Unreadable { what: "folder", path: folder.to_owned(), source };
        std::fs::canonicalize(folder).map_err(problem)
    };
    if !real(own.folder())?.starts_with(real(chosen)?) {
        return Err(Error::OutsideRoot { pipeline: pipeline.to_owned(), root: chosen.clone() });
    }
    Ok(own.within(chosen.clone()))
}

/// The name of a file in its folder.
fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// Reads an extension; where there is no such file, the shipped one of that path. Files that it names are counted from it: so its
/// path is counted from the pipeline's folder, as `relative` says.
fn extension(path: &Path, read: &ReadFiles, relative: impl FnOnce() -> FilePath) -> Result<FoundFile, Error> {
    let shown = path.to_string_lossy().into_owned();
    match bytes(EXTENSION, path, read, AN_EXTENSION) {
        Ok(bytes) => Ok(FoundFile { shown, relative: relative(), bytes }),
        Err(Error::Unreadable { what, source, .. }) if source.kind() == io::ErrorKind::NotFound => {
            let carried = shipped::PIPELINES.iter().find(|(file, _)| Path::new(file) == path);
            let (file, text) = carried.ok_or(Error::Unreadable { what, path: path.to_owned(), source })?;
            let relative = FilePath::Shipped((*file).into());
            Ok(FoundFile { shown: relative.to_string(), relative, bytes: text.as_bytes().to_vec() })
        }
        Err(error) => Err(error),
    }
}

fn bytes(what: &'static str, path: &Path, read: &ReadFiles, recorded: &'static str) -> Result<Vec<u8>, Error> {
    let problem = |source| Error::Unreadable { what, path: path.to_owned(), source };
    let limit = LARGEST_FILE as u64;
    let mut bytes = Vec::new();
    read.open(recorded, path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes)).map_err(problem)?;
    if bytes.len() as u64 > limit {
        return Err(Error::TooLarge { what, path: path.to_owned(), limit });
    }
    Ok(bytes)
}

/// The text of a settings file.
pub(crate) fn settings(path: &Path, read: &ReadFiles) -> Result<String, Error> {
    const WHAT: &str = "settings file";
    let bytes = bytes(WHAT, path, read, THE_SETTINGS)?;
    let text = text_of(&bytes).map_err(|why| Error::NotText { what: WHAT, path: path.to_owned(), why })?;
    Ok(text.to_owned())
}

/// File name and text of the shipped file that `path` asks for.
fn carried(what: &'static str, path: &Path, files: ShippedFiles) -> Result<(&'static str, &'static str), Error> {
    let missing = || Error::Missing { what, path: path.to_owned(), shipped: shipped::names(files).collect() };
    shipped::find(files, path).ok_or_else(missing)
}
