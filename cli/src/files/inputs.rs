//! Reads files: the user's own from disk, else the shipped ones that the binary carries.

use crate::command_line::args;
use crate::error::Error;
use crate::system::text;
use framewright::{FileOptions, PipelineFile, Reach};
use framewright_graph::base::{ReadFiles, text_of};
use framewright_graph::language::ShippedFiles;
use framewright_lab::Error as LabError;
use framewright_lab::picture::Light;
use framewright_passes::scene::Scene;
use framewright_passes::shipped;
use std::io::Read;
use std::path::Path;

/// A picture's file has at most this many bytes: those of the largest picture without compression, and some.
const LARGEST_PICTURE: usize = (1 << 30) + (1 << 24);

/// The role of a file that the command line names.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FileRole {
    /// Its name in messages.
    pub(crate) name: &'static str,
    /// The words by which it is recorded when it is read.
    pub(crate) recorded: &'static str,
}

impl FileRole {
    /// A device profile.
    pub(crate) const PROFILE: FileRole = FileRole { name: "device profile", recorded: "the device profile itself" };
    /// A Plan.
    pub(crate) const PLAN: FileRole = FileRole { name: "Plan", recorded: "a Plan that is read" };
    /// The interfaces of another program's draws.
    pub(crate) const INTERFACE: FileRole = FileRole { name: "interface", recorded: "the interface itself" };
    /// A budget.
    pub(crate) const BUDGET: FileRole = FileRole { name: "budget", recorded: "the budget itself" };
    /// What `run` found out.
    pub(crate) const REPORT: FileRole = FileRole { name: "report", recorded: "a report that is read" };
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

/// How the files are found that a pipeline and the command line name.
pub(crate) fn options(arguments: &args::PipelineArguments) -> FileOptions {
    let reach = match &arguments.root {
        _ if arguments.allow_outside => Reach::Anywhere,
        Some(root) => Reach::Within(root.clone()),
        None => Reach::OwnFolder,
    };
    let mut options = FileOptions::default();
    (options.reach, options.extensions) = (reach, arguments.extend.clone());
    options
}

/// Records the files that the command line names beside a pipeline, before any is read.
pub(crate) fn expect(arguments: &args::PipelineArguments, read: &ReadFiles) {
    PipelineFile::expect(&arguments.file, &options(arguments), &arguments.settings, read);
    arguments.interface.iter().for_each(|file| read.expect(FileRole::INTERFACE.recorded, file));
}

/// Reads a scene; where there is no such file, a shipped one of that name, and says so. Says too what the file holds that
/// isn't drawn, and which mistakes in it were passed over.
///
/// # Errors
/// If there is neither, or the file is no scene; if it has a mistake and is read strictly.
pub(crate) fn scene(path: &Path, strict: bool, read: &ReadFiles) -> Result<Scene, Error> {
    let (scene, is_shipped) = framewright::find_scene(path, read)?;
    if is_shipped {
        say_shipped("scene", path);
    }
    if strict && !scene.mistakes.is_empty() {
        return Err(Error::SceneMistakes { path: path.to_owned(), mistakes: scene.mistakes });
    }
    for note in scene.mistakes.iter().chain(&scene.notes) {
        text::say(&format!("note: {}: {}", text::path(path), text::escape(note)));
    }
    Ok(scene)
}

/// A picture's file whose size is known.
pub(crate) struct PictureFile<'p> {
    path: &'p Path,
    bytes: Vec<u8>,
    /// Width and height in pixels.
    pub(crate) extent: [usize; 2],
}

/// Reads a picture's file, and looks at its header.
///
/// # Errors
/// If it can't be read, or is no picture.
pub(crate) fn picture<'p>(path: &'p Path, read: &ReadFiles) -> Result<PictureFile<'p>, Error> {
    let bytes = bytes(FileRole::PICTURE, path, LARGEST_PICTURE, read)?;
    let extent = Light::extent_of(&bytes).map_err(|problem| LabError::NoLight { path: path.to_owned(), problem })?;
    Ok(PictureFile { path, bytes, extent })
}

impl PictureFile<'_> {
    /// Decodes it.
    ///
    /// # Errors
    /// If it is damaged.
    pub(crate) fn decoded(self) -> Result<Light, Error> {
        let no_light = |problem| LabError::NoLight { path: self.path.to_owned(), problem };
        Ok(Light::decode(&self.bytes).map_err(no_light)?)
    }
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
    let bytes = bytes(what, path, limit, read)?;
    let text = text_of(&bytes).map_err(|why| Error::NotText { what: what.name, path: path.to_owned(), why })?;
    Ok(text.to_owned())
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

/// Makes sure that there are a pipeline and a scene of these names, as files or shipped, whatever they hold.
///
/// # Errors
/// If one is missing.
pub(crate) fn are_there(pipeline: &Path, scene: &Path) -> Result<(), Error> {
    let named = [("pipeline", pipeline, shipped::PIPELINES), ("scene", scene, shipped::SCENES)];
    for (what, path, files) in named {
        if matches!(path.try_exists(), Ok(false)) && shipped::find(files, path).is_none() {
            return Err(missing(what, path, files));
        }
    }
    Ok(())
}

fn missing(what: &'static str, path: &Path, files: ShippedFiles) -> Error {
    Error::Missing { what, path: path.to_owned(), shipped: shipped::names(files).collect() }
}

/// Says that a shipped file takes the place of one that isn't here.
pub(crate) fn say_shipped(what: &str, path: &Path) {
    text::say(&format!("note: there is no file `{}` here; this is the shipped {what} of that name", text::path(path)));
}
