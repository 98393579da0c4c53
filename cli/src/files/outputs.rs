//! Writes files, each whole or not at all.

use crate::error::Error;
use crate::files::stream;
use crate::system::{links, platform};
use framewright_graph::base::ReadFiles;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::{fs, io};
use tempfile::NamedTempFile;

/// Makes sure, before any work is done, that each of `written` can be written, and that none of them is a file that was read,
/// or another of them by a different name, or a shader.
///
/// # Errors
/// [`Error::Write`], [`Error::WrittenTwice`], [`Error::ReadAndWritten`].
pub(crate) fn prepare<'a>(written: impl Iterator<Item = &'a Path>, read: &ReadFiles) -> Result<(), Error> {
    let mut seen = Vec::new();
    for path in written {
        if let Some(real) = probe(path)? {
            let shader = is_shader(&real) && real.exists();
            if let Some(what) = read.read_as(&real).or(shader.then_some("a shader by its name")) {
                return Err(Error::ReadAndWritten { what, path: path.to_owned() });
            }
            if seen.contains(&real) {
                return Err(Error::WrittenTwice { path: path.to_owned() });
            }
            seen.push(real);
        }
    }
    Ok(())
}

/// Writes each of `files`, once all of them are sure to be no file that was read. Each is written whole or not at all, and none
/// takes its place before there was room for all.
///
/// # Errors
/// Those of [`prepare`], before anything is written; then [`Error::Write`] and [`Error::InterruptedWriting`].
pub(crate) fn write(files: &[(&Path, &[u8])], read: &ReadFiles) -> Result<(), Error> {
    prepare(files.iter().map(|(path, _)| *path), read)?;
    let filled =
        files.iter().map(|(path, contents)| FileContents::of(path, contents)).collect::<Result<Vec<_>, Error>>()?;
    filled.into_iter().try_for_each(FileContents::finish)
}

/// Whether a file is a shader, or a part of one, by its name. Those of passes that are off aren't read, and would be lost all
/// the same; nothing that is written is called so.
fn is_shader(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ["vert", "frag", "comp", "glsl"].iter().any(|shader| ending == *shader))
}

/// Makes sure that `path` can be written. The answer is the file's one true name; `None` for a stream.
fn probe(path: &Path) -> Result<Option<PathBuf>, Error> {
    let problem = |source| Error::Write { path: path.to_owned(), source };
    match Target::of(path).map_err(problem)? {
        Target::File(file) => {
            temporary(&file).map_err(problem)?;
            let folder = fs::canonicalize(folder_of(&file)).map_err(problem)?;
            Ok(file.file_name().map(|name| folder.join(name)))
        }
        // A pipe is opened only once: closing it would end the file for its reader.
        Target::Pipe(_) => Ok(None),
        Target::Stream(file) => {
            fs::OpenOptions::new().write(true).open(file).map_err(problem)?;
            Ok(None)
        }
    }
}

/// Contents that are about to be written: of a file they lie beside it already, and take its place in one step, so that every
/// reader sees the old contents or the new ones.
enum FileContents<'a> {
    Beside { path: &'a Path, file: PathBuf, beside: NamedTempFile },
    Stream { stream: PathBuf, contents: &'a [u8] },
}

impl<'a> FileContents<'a> {
    fn of(path: &'a Path, contents: &'a [u8]) -> Result<FileContents<'a>, Error> {
        let problem = |source| Error::Write { path: path.to_owned(), source };
        match Target::of(path).map_err(problem)? {
            Target::File(file) => {
                let beside = filled(&file, contents).map_err(problem)?;
                Ok(FileContents::Beside { path, file, beside })
            }
            Target::Stream(stream) | Target::Pipe(stream) => Ok(FileContents::Stream { stream, contents }),
        }
    }

    fn finish(self) -> Result<(), Error> {
        match self {
            FileContents::Beside { path, file, beside } => {
                let problem = |source| Error::Write { path: path.to_owned(), source };
                beside.persist(&file).map_err(|error| problem(error.error))?;
                Ok(())
            }
            FileContents::Stream { stream, contents } => stream::write(&stream, contents),
        }
    }
}

/// Makes a folder, and those that it lies in.
///
/// # Errors
/// [`Error::NoFolder`], [`Error::Write`].
pub(crate) fn make_folder(folder: &Path) -> Result<(), Error> {
    if folder.exists() && !folder.is_dir() {
        return Err(Error::NoFolder { path: folder.to_owned() });
    }
    fs::create_dir_all(folder).map_err(|source| Error::Write { path: folder.to_owned(), source })
}

/// Writes `contents` to a new file, whole or not at all.
///
/// # Errors
/// [`Error::AlreadyExists`], [`Error::Write`].
pub(crate) fn write_new(path: &Path, contents: &[u8]) -> Result<(), Error> {
    let problem = |source: io::Error| match source.kind() {
        io::ErrorKind::AlreadyExists => Error::AlreadyExists { path: path.to_owned() },
        _ => Error::Write { path: path.to_owned(), source },
    };
    if fs::symlink_metadata(path).is_ok() {
        return Err(Error::AlreadyExists { path: path.to_owned() });
    }
    let beside = filled(path, contents).map_err(problem)?;
    beside.persist_noclobber(path).map_err(|error| problem(error.error))?;
    Ok(())
}

/// The kind of thing that a path leads to.
enum Target {
    /// A file, or nothing yet.
    File(PathBuf),
    /// Something that must not be replaced, such as `/dev/null`.
    Stream(PathBuf),
    /// A pipe: it must not be replaced either, and can be opened only once.
    Pipe(PathBuf),
}

impl Target {
    fn of(path: &Path) -> io::Result<Target> {
        match fs::metadata(path) {
            Ok(data) if data.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Ok(data) if platform::is_pipe(&data) => Ok(Target::Pipe(path.to_owned())),
            Ok(data) if !data.is_file() => Ok(Target::Stream(path.to_owned())),
            Ok(data) if data.permissions().readonly() => Err(io::ErrorKind::PermissionDenied.into()),
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            // The link stays, and its target is replaced.
            _ if path.is_symlink() => Ok(Target::File(links::destination(path))),
            _ => Ok(Target::File(path.to_owned())),
        }
    }
}

fn folder_of(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A temporary file beside another one, with contents.
fn filled(beside: &Path, contents: &[u8]) -> io::Result<NamedTempFile> {
    let mut temporary = temporary(beside)?;
    // To the file itself: `tempfile` would add its path to errors.
    let file = temporary.as_file_mut();
    file.write_all(contents)?;
    file.sync_data()?;
    Ok(temporary)
}

fn temporary(beside: &Path) -> io::Result<NamedTempFile> {
    let folder = folder_of(beside);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".framewright-");
    platform::with_usual_rights(&mut builder);
    // Errors of the folder come first. `tempfile` adds the path of its own file to errors, which means nothing to the user:
    // only the kind is kept.
    fs::metadata(folder)?;
    builder.tempfile_in(folder).map_err(|error| error.kind().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write_alone(path: &Path, contents: &[u8]) -> Result<(), Error> {
        FileContents::of(path, contents)?.finish()
    }

    #[test]
    fn a_written_file_replaces_the_old_one_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("plan.json");
        write_alone(&file, b"old").expect("written");
        probe(&file).expect("writable");
        write_alone(&file, b"new").expect("written");
        assert_eq!(fs::read(&file).expect("read"), b"new");
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1);
    }

    #[test]
    fn a_folder_or_a_missing_folder_is_refused_before_any_work() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(matches!(probe(folder.path()), Err(Error::Write { .. })));
        assert!(matches!(probe(&folder.path().join("none/plan.json")), Err(Error::Write { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_that_leads_to_nothing_yet_leads_to_the_new_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let link = folder.path().join("link.json");
        std::os::unix::fs::symlink("new.json", &link).expect("linked");
        write_alone(&link, b"new").expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(folder.path().join("new.json")).expect("read"), b"new");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_device_stays_a_device() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("real.json"), folder.path().join("link.json"));
        fs::write(&file, b"old").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("linked");
        write_alone(&link, b"new").expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).expect("read"), b"new");

        write_alone(Path::new("/dev/null"), b"nothing").expect("written");
        assert!(!fs::metadata("/dev/null").expect("there").is_file());
        let full = write_alone(Path::new("/dev/full"), b"nothing").expect_err("always full");
        assert!(matches!(full, Error::Write { source, .. } if source.kind() == io::ErrorKind::StorageFull));
    }
}
