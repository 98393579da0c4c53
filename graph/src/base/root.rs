//! The folder that a pipeline's files lie in, and the way to them: by default never out of it, by no link either.
//!
//! The only place of this library that reads files from disk.

use super::{ReadFiles, is_of_machine};
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::{fs, io};

/// The folder of the files that a pipeline names: shaders, pictures, other pipelines and fragments. Paths are counted
/// from this folder. They must not leave a second folder, which is the same one unless [`Root::within`] sets another.
///
/// The target of a path is found before it is opened; nothing is promised if links change in between.
#[derive(Debug, Clone)]
pub struct Root {
    folder: PathBuf,
    within: PathBuf,
    outside: bool,
    /// The record of files that are read, and the kind that they are recorded as.
    record: (ReadFiles, &'static str),
}

/// Why a file isn't read: the end of a sentence that began with its path. Text from outside is not yet escaped.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoFile {
    /// There is none.
    #[error("is not there")]
    Missing,
    /// It is written in a way that no path is.
    #[error("is no path of a file: names are divided by `/`, without `\\` and `:`")]
    NoPath,
    /// It lies outside the folder that mustn't be left.
    #[error("leads out of `{}`", within.display())]
    Outside {
        /// That folder.
        within: PathBuf,
    },
    /// It is a folder, a device or a pipe.
    #[error("is not a regular file")]
    NotRegular,
    /// It is too large.
    #[error("has {bytes} bytes, more than the {limit} that are allowed")]
    TooLarge {
        /// How many it has.
        bytes: u64,
        /// How many it may have.
        limit: u64,
    },
    /// The user has no right to read it.
    #[error("can't be read: {reason}")]
    Denied {
        /// The system's words.
        reason: String,
    },
    /// The machine doesn't let it be read, such as where too many files are open.
    #[error("can't be read: {reason}")]
    Machine {
        /// The system's words.
        reason: String,
    },
    /// The system can't read it for another reason.
    #[error("can't be read: {reason}")]
    Unreadable {
        /// The system's words.
        reason: String,
    },
}

impl NoFile {
    /// Whether nothing is wrong with the file: the machine doesn't let it be read.
    #[must_use]
    pub fn is_of_machine(&self) -> bool {
        matches!(self, NoFile::Denied { .. } | NoFile::Machine { .. })
    }
}

impl From<io::Error> for NoFile {
    fn from(error: io::Error) -> NoFile {
        match error.kind() {
            io::ErrorKind::NotFound => NoFile::Missing,
            // It has become one since it was looked at.
            io::ErrorKind::IsADirectory => NoFile::NotRegular,
            io::ErrorKind::PermissionDenied => NoFile::Denied { reason: error.to_string() },
            _ if is_of_machine(&error) => NoFile::Machine { reason: error.to_string() },
            _ => NoFile::Unreadable { reason: error.to_string() },
        }
    }
}

impl From<PathBuf> for Root {
    fn from(folder: PathBuf) -> Root {
        Root::new(folder)
    }
}

impl Root {
    /// Files in `folder` and in folders within it. An empty path is the working directory.
    #[must_use]
    pub fn new(folder: PathBuf) -> Root {
        let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
        Root { within: folder.clone(), folder, outside: false, record: (ReadFiles::default(), "a file") }
    }

    /// Paths are still counted from the same folder, but may lead to anywhere in `within`.
    #[must_use]
    pub fn within(self, within: PathBuf) -> Root {
        Root { within, ..self }
    }

    /// Files may lie anywhere, and paths may be absolute.
    #[must_use]
    pub fn allow_outside(self) -> Root {
        Root { outside: true, ..self }
    }

    /// Files that are read from here are recorded in `files` as `what`, such as `a texture`.
    #[must_use]
    pub fn recorded(self, files: &ReadFiles, what: &'static str) -> Root {
        Root { record: (files.clone(), what), ..self }
    }

    /// The folder that paths are counted from, as it was given.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Where `path` leads to, links followed: a regular file.
    ///
    /// # Errors
    /// [`NoFile`] says why it is not to be read.
    pub fn locate(&self, path: &str) -> Result<PathBuf, NoFile> {
        let outside = || NoFile::Outside { within: self.within.clone() };
        let within = self.within.canonicalize()?;
        let stays = |path: &Path| self.outside || path.starts_with(&within);
        let named = normal(&self.folder.canonicalize()?.join(path));
        if Path::new(path).is_absolute() && !self.outside || !stays(&named) {
            return Err(outside());
        }
        // A link may lead elsewhere later.
        self.record.0.seek(&named);
        let found = named.canonicalize()?;
        if !stays(&found) {
            return Err(outside());
        }
        if fs::metadata(&found)?.is_file() { Ok(found) } else { Err(NoFile::NotRegular) }
    }

    /// Opens the file that [`locate`](Root::locate) found, and records it.
    ///
    /// # Errors
    /// Those of the system.
    pub fn open(&self, found: &Path) -> io::Result<File> {
        let (files, what) = &self.record;
        files.open(what, found)
    }

    /// The contents of the file that [`locate`](Root::locate) found: at most `limit` bytes.
    ///
    /// # Errors
    /// [`NoFile`] says why it is not to be read.
    pub fn read(&self, found: &Path, limit: usize) -> Result<Vec<u8>, NoFile> {
        let (file, limit) = (self.open(found)?, limit as u64);
        let bytes = file.metadata()?.len();
        if bytes > limit {
            return Err(NoFile::TooLarge { bytes, limit });
        }
        let mut contents = Vec::new();
        // It may have grown since, and some systems' own files tell no size.
        file.take(limit.saturating_add(1)).read_to_end(&mut contents)?;
        match contents.len() as u64 {
            bytes if bytes > limit => Err(NoFile::TooLarge { bytes, limit }),
            _ => Ok(contents),
        }
    }

    /// The path of a file that the user names, counted from the folder, as it stands in Plans.
    ///
    /// # Errors
    /// [`NoFile`] if there is none.
    pub fn relative(&self, file: &Path) -> Result<String, NoFile> {
        // Only the folder is resolved: the result names the link itself, and paths in its file are counted from there.
        let name = file.file_name().ok_or(NoFile::NotRegular)?;
        let beside = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let (folder, file) = (self.folder.canonicalize()?, beside.canonicalize()?.join(name));
        let shared = folder.components().zip(file.components()).take_while(|(one, other)| one == other).count();
        let up = folder.components().skip(shared).map(|_| "..".to_owned());
        let down = file.components().skip(shared).map(|part| part.as_os_str().to_string_lossy().into_owned());
        Ok(up.chain(down).collect::<Vec<_>>().join("/"))
    }
}

/// The path without `.` and `..`, links not asked.
fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => drop(normal.pop()),
            component => normal.push(component),
        }
    }
    normal
}
