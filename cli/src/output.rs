//! Files that are written: whole or not at all.

use crate::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Makes sure, before any work is done, that `path` can be written.
///
/// # Errors
/// [`Error::Write`] with what stands in the way.
pub(crate) fn probe(path: &Path) -> Result<(), Error> {
    let problem = |source| Error::Write { path: path.to_owned(), source };
    match Target::of(path).map_err(problem)? {
        Target::File(file) => temporary(&file).map(drop).map_err(problem),
        Target::Stream(file) => fs::OpenOptions::new().write(true).open(file).map(drop).map_err(problem),
    }
}

/// Writes `contents` to `path`: a file beside it is filled and takes its place in one step, so that whoever looks sees the
/// old contents or the new ones.
///
/// # Errors
/// [`Error::Write`] with what stands in the way.
pub(crate) fn write(path: &Path, contents: &[u8]) -> Result<(), Error> {
    let problem = |source| Error::Write { path: path.to_owned(), source };
    match Target::of(path).map_err(problem)? {
        Target::File(file) => {
            let mut beside = temporary(&file).map_err(problem)?;
            beside.write_all(contents).and_then(|()| beside.as_file().sync_data()).map_err(problem)?;
            beside.persist(&file).map_err(|error| problem(error.error))?;
            Ok(())
        }
        Target::Stream(file) => {
            let open = fs::OpenOptions::new().write(true).open(file);
            open.and_then(|mut stream| stream.write_all(contents)).map_err(problem)
        }
    }
}

/// What a path leads to.
enum Target {
    /// A file, or nothing yet.
    File(PathBuf),
    /// Something that must not be replaced, such as `/dev/null` or a named pipe.
    Stream(PathBuf),
}

impl Target {
    fn of(path: &Path) -> io::Result<Target> {
        // A link stays; what it leads to is replaced.
        let real = if path.is_symlink() { fs::canonicalize(path)? } else { path.to_owned() };
        match fs::metadata(&real) {
            Ok(data) if data.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Ok(data) if !data.is_file() => Ok(Target::Stream(real)),
            Ok(data) if data.permissions().readonly() => Err(io::ErrorKind::PermissionDenied.into()),
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(Target::File(real)),
        }
    }
}

fn temporary(beside: &Path) -> io::Result<tempfile::NamedTempFile> {
    let folder = match beside.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".framewright-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    // First whatever the folder itself has to say: `tempfile` adds the path of its own file to errors, which the user has
    // never heard of, so of those only the kind is kept.
    fs::metadata(folder)?;
    builder.tempfile_in(folder).map_err(|error| error.kind().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_file_replaces_the_old_one_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("plan.json");
        write(&file, b"old").expect("written");
        probe(&file).expect("writable");
        write(&file, b"new").expect("written");
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
    fn a_link_stays_a_link_and_a_device_stays_a_device() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("real.json"), folder.path().join("link.json"));
        fs::write(&file, b"old").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("linked");
        write(&link, b"new").expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).expect("read"), b"new");

        write(Path::new("/dev/null"), b"nothing").expect("written");
        assert!(!fs::metadata("/dev/null").expect("there").is_file());
        let full = write(Path::new("/dev/full"), b"nothing").expect_err("always full");
        assert!(matches!(full, Error::Write { source, .. } if source.kind() == io::ErrorKind::StorageFull));
    }
}
