//! Reads files: the user's own from disk, else the shipped ones that the binary carries.

use crate::command_line::args;
use crate::error::Error;
use crate::files::shipped;
use crate::picture::Light;
use crate::system::text;
use framewright_graph::base::{FilePath, ReadFiles, Root, Sources};
use framewright_graph::language::{Found, LARGEST_FILE, PipelineFiles, Shipped};
use framewright_passes::scene::{self, Scene, SceneError};
use std::io;
use std::io::Read;
use std::path::Path;

/// A picture's file has at most this many bytes: those of the largest picture without compression.
const LARGEST_PICTURE: usize = 1 << 32;

/// The role of a file that the command line names.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FileRole {
    /// Its name in messages.
    pub(crate) name: &'static str,
    /// The words by which it is recorded when it is read.
    pub(crate) recorded: &'static str,
}

impl FileRole {
    /// The pipeline.
    pub(crate) const PIPELINE: FileRole = FileRole { name: "pipeline", recorded: "the pipeline itself" };
    /// An extension of the pipeline.
    pub(crate) const EXTENSION: FileRole = FileRole { name: "extension", recorded: "an extension of the pipeline" };
    /// A settings file.
    pub(crate) const SETTINGS: FileRole = FileRole { name: "settings file", recorded: "the settings file itself" };
    /// A device profile.
    pub(crate) const PROFILE: FileRole = FileRole { name: "device profile", recorded: "the device profile itself" };
    /// A scene.
    pub(crate) const SCENE: FileRole = FileRole { name: "scene", recorded: "the scene itself" };
    /// A Plan.
    pub(crate) const PLAN: FileRole = FileRole { name: "Plan", recorded: "a Plan that is read" };
    /// The interfaces of another program's draws.
    pub(crate) const INTERFACE: FileRole = FileRole { name: "interface", recorded: "the interface itself" };
    /// A budget.
    pub(crate) const BUDGET: FileRole = FileRole { name: "budget", recorded: "the budget itself" };
    /// A picture.
    const PICTURE: FileRole = FileRole { name: "picture", recorded: "a picture that is compared" };
    /// The results of a sweep.
    pub(crate) const RESULTS: FileRole =
        FileRole { name: "file of results", recorded: "a file of results that is read" };
    /// A picture of the results of a sweep.
    const MEASURED_PICTURE: FileRole = FileRole { name: "picture", recorded: "a picture of results that are read" };
    /// Any of the files that `schema` takes.
    pub(crate) const ANY: FileRole = FileRole { name: "file", recorded: "the file itself" };
}

/// A pipeline file, not yet read as RON.
#[derive(Debug)]
pub(crate) struct PipelineFile {
    /// Name to show: as the user gave it.
    pub(crate) shown: String,
    /// Its path, counted from its own folder.
    pub(crate) path: FilePath,
    /// The folder of the files that it names; `None`: the binary carries it, and them.
    pub(crate) root: Option<Root>,
    /// Its contents.
    pub(crate) bytes: Vec<u8>,
}

/// Reads a pipeline file; where there is none, a shipped one of that name, and says so.
///
/// # Errors
/// If there is neither, it can't be read, or it lies outside the folder that `--root` names.
pub(crate) fn pipeline(arguments: &args::PipelineArguments, read: &ReadFiles) -> Result<PipelineFile, Error> {
    const ROLE: FileRole = FileRole::PIPELINE;
    let path = &arguments.file;
    match bytes(ROLE, path, LARGEST_FILE, read) {
        Ok(bytes) => Ok(PipelineFile {
            shown: path.to_string_lossy().into_owned(),
            path: (&*path.file_name().unwrap_or(path.as_os_str()).to_string_lossy()).into(),
            root: Some(root(arguments)?),
            bytes,
        }),
        Err(Error::Read { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
            let (file, text) = carried(ROLE.name, path, shipped::PIPELINES)?;
            let (shown, bytes) = (file.to_owned(), text.as_bytes().to_vec());
            if arguments.extend.is_empty() {
                return Ok(PipelineFile { path: file.into(), shown, root: None, bytes });
            }
            // Extensions of the user's own bring files of their own: the working directory takes the place of the folder.
            let path = FilePath::Shipped(file.into());
            Ok(PipelineFile { shown, path, root: Some(limited(arguments, Root::new(".".into()))?), bytes })
        }
        Err(error) => Err(error),
    }
}

/// Records the files that the command line names beside a pipeline, before any is read.
pub(crate) fn expect(arguments: &args::PipelineArguments, read: &ReadFiles) {
    let settings = arguments.settings.iter().map(|file| (FileRole::SETTINGS, file));
    let extensions = arguments.extend.iter().map(|file| (FileRole::EXTENSION, file));
    let interface = arguments.interface.iter().map(|file| (FileRole::INTERFACE, file));
    let pipeline = std::iter::once((FileRole::PIPELINE, &arguments.file));
    for (what, file) in pipeline.chain(settings).chain(extensions).chain(interface) {
        read.expect(what.recorded, file);
    }
}

/// The folder that the files which a pipeline or a Plan names come from: its own, or within the one that the user names.
///
/// # Errors
/// If it lies outside of the folder that `--root` names, or one of the folders can't be read.
pub(crate) fn root(arguments: &args::PipelineArguments) -> Result<Root, Error> {
    limited(arguments, Root::new(arguments.file.parent().unwrap_or(Path::new("")).to_owned()))
}

fn limited(arguments: &args::PipelineArguments, own: Root) -> Result<Root, Error> {
    if arguments.allow_outside {
        return Ok(own.allow_outside());
    }
    let Some(chosen) = &arguments.root else { return Ok(own) };
    let real = |folder: &Path| {
        let problem = |source| Error::Read { what: "folder", path: folder.to_owned(), source };
        std::fs::canonicalize(folder).map_err(problem)
    };
    if !real(own.folder())?.starts_with(real(chosen)?) {
        return Err(Error::OutsideRoot { pipeline: arguments.file.clone(), root: chosen.clone() });
    }
    Ok(own.within(chosen.clone()))
}

/// Reads an extension that the user names; where there is no such file, the shipped one of that path. Files that it names
/// are counted from it: so its path is counted from the pipeline's folder, as `files` count.
///
/// # Errors
/// If there is neither, or it can't be read.
pub(crate) fn extension(path: &Path, files: &mut PipelineFiles, read: &ReadFiles) -> Result<Found, Error> {
    const ROLE: FileRole = FileRole::EXTENSION;
    let shown = path.to_string_lossy().into_owned();
    match bytes(ROLE, path, LARGEST_FILE, read) {
        Ok(bytes) => Ok(Found { shown, relative: files.which(path), bytes }),
        Err(Error::Read { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
            let carried = shipped::PIPELINES.iter().find(|(file, _)| Path::new(file) == path);
            let (file, text) = carried.ok_or(Error::Read { what: ROLE.name, path: path.to_owned(), source })?;
            let relative = FilePath::Shipped((*file).into());
            Ok(Found { shown: relative.to_string(), relative, bytes: text.as_bytes().to_vec() })
        }
        Err(error) => Err(error),
    }
}

/// Reads a scene; where there is no such file, a shipped one of that name, and says so. Says too what the file holds that
/// isn't drawn.
///
/// # Errors
/// If there is neither, or the file is no scene.
pub(crate) fn scene(path: &Path, read: &ReadFiles) -> Result<Scene, Error> {
    let scene = match path.try_exists() {
        Ok(false) => {
            let (file, text) = carried("scene", path, shipped::SCENES)?;
            let mut sources = Sources::default();
            scene::text::read(&mut sources, file, file, text.to_owned())
                .map_err(|mistakes| SceneError::Text { sources, mistakes })
        }
        _ => scene::load_recorded(path, read),
    };
    let scene = scene.map_err(|problem| Error::Scene(Box::new(problem)))?;
    for note in &scene.notes {
        text::say(&format!("note: {}: {}", text::path(path), text::escape(note)));
    }
    Ok(scene)
}

/// Reads a picture.
///
/// # Errors
/// If it can't be read, or is no picture.
pub(crate) fn picture(path: &Path, read: &ReadFiles) -> Result<Light, Error> {
    let file = bytes(FileRole::PICTURE, path, LARGEST_PICTURE, read)?;
    Light::decode(&file).map_err(|problem| Error::NoLight { path: path.to_owned(), problem })
}

/// Reads the bytes of a picture that belongs to results.
///
/// # Errors
/// If it can't be read, or is too large.
pub(crate) fn measured_picture(path: &Path, read: &ReadFiles) -> Result<Vec<u8>, Error> {
    bytes(FileRole::MEASURED_PICTURE, path, LARGEST_PICTURE, read)
}

/// Reads a text file of at most `limit` bytes.
///
/// # Errors
/// If it can't be read, is too large or isn't text.
pub(crate) fn text(what: FileRole, path: &Path, limit: usize, read: &ReadFiles) -> Result<String, Error> {
    String::from_utf8(bytes(what, path, limit, read)?).map_err(|error| Error::NotText {
        what: what.name,
        path: path.to_owned(),
        at: error.utf8_error().valid_up_to(),
    })
}

fn bytes(what: FileRole, path: &Path, limit: usize, read: &ReadFiles) -> Result<Vec<u8>, Error> {
    let FileRole { name: what, recorded } = what;
    let problem = |source| Error::Read { what, path: path.to_owned(), source };
    let mut bytes = Vec::new();
    read.open(recorded, path).and_then(|file| file.take(limit as u64 + 1).read_to_end(&mut bytes)).map_err(problem)?;
    if bytes.len() > limit {
        return Err(Error::TooLarge { what, path: path.to_owned(), limit: limit as u64 });
    }
    Ok(bytes)
}

/// File name and text of the shipped file that `path` asks for.
fn carried(what: &'static str, path: &Path, files: Shipped) -> Result<(&'static str, &'static str), Error> {
    let missing = || Error::Missing { what, path: path.to_owned(), shipped: shipped::names(files).collect() };
    let found = shipped::find(files, path).ok_or_else(missing)?;
    text::say(&format!("note: there is no file `{}` here; this is the shipped {what} of that name", text::path(path)));
    Ok(found)
}
