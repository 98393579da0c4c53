//! The cache: a folder of files that can be made anew. Each is written whole or not at all.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;
use std::{env, fs, io};
use tempfile::NamedTempFile;

/// A folder of files that can be made anew: compiled shaders, findings about drivers, a manifest of the validation layer.
///
/// Any number of processes may use it at once, and programs of several versions. A file that is damaged, or that another
/// version wrote, counts as none. Where the folder can't be written, nothing is kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cache {
    folder: PathBuf,
}

/// One kind of files in a [`Cache`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CachedFiles {
    /// The name of their folder in the cache.
    pub kind: &'static str,
    /// Number of files.
    pub files: u64,
    /// Bytes of all of them.
    pub bytes: u64,
}

/// The kinds of files, by the names of their folders. The cache's folder may hold others, which aren't touched.
const KINDS: [&str; 3] = [SPIRV, SELF_TESTS, LAYER];
const SPIRV: &str = "spirv";
const SELF_TESTS: &str = "self-tests";
const LAYER: &str = "vulkan-layer";

impl Cache {
    /// The cache of the user: `$XDG_CACHE_HOME/framewright`, or `~/.cache/framewright`. `None` if the user has no home folder.
    #[must_use]
    pub fn of_user() -> Option<Cache> {
        let cache = path_variable("XDG_CACHE_HOME").or_else(|| path_variable("HOME").map(|home| home.join(".cache")));
        cache.map(|cache| Cache::in_folder(cache.join("framewright")))
    }

    /// A cache in this folder, which is made when something is kept.
    #[must_use]
    pub fn in_folder(folder: impl Into<PathBuf>) -> Cache {
        Cache { folder: folder.into() }
    }

    /// Its folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The files of each kind that it holds.
    ///
    /// # Errors
    /// If a folder can't be listed.
    pub fn files(&self) -> io::Result<Vec<CachedFiles>> {
        let counted = |kind: &'static str| {
            let (mut files, mut bytes) = (0, 0);
            for (_, entry) in files_in(&self.folder.join(kind))? {
                (files, bytes) = (files + 1, bytes + entry.len());
            }
            Ok(CachedFiles { kind, files, bytes })
        };
        KINDS.into_iter().map(counted).collect()
    }

    /// Removes all files of these kinds.
    ///
    /// # Errors
    /// If a file can't be removed.
    pub fn clear(&self) -> io::Result<()> {
        KINDS.into_iter().try_for_each(|kind| absent_is_fine(fs::remove_dir_all(self.folder.join(kind))).map(|_| ()))
    }

    /// The folder of compiled shaders.
    pub(crate) fn spirv(&self) -> PathBuf {
        self.folder.join(SPIRV)
    }

    /// The folder of what self-tests of drivers found.
    pub(crate) fn self_tests(&self) -> PathBuf {
        self.folder.join(SELF_TESTS)
    }

    /// The folder of the validation layer's manifest.
    pub(crate) fn layer(&self) -> PathBuf {
        self.folder.join(LAYER)
    }
}

/// The files in a folder. One that is removed meanwhile is left out; a folder that isn't there holds none.
pub(crate) fn files_in(folder: &Path) -> io::Result<Vec<(PathBuf, fs::Metadata)>> {
    let Some(entries) = absent_is_fine(fs::read_dir(folder))? else { return Ok(Vec::new()) };
    let mut files = Vec::new();
    for entry in entries {
        let entry = entry?;
        if let Some(metadata) = absent_is_fine(entry.metadata())?.filter(fs::Metadata::is_file) {
            files.push((entry.path(), metadata));
        }
    }
    Ok(files)
}

fn absent_is_fine<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        result => result.map(Some),
    }
}

/// The identity of a program: another build has another one.
pub(crate) fn identity_of(program: &Path) -> String {
    let metadata = fs::metadata(program).ok();
    let written = metadata.as_ref().and_then(|it| it.modified().ok());
    let written = written.and_then(|it| it.duration_since(UNIX_EPOCH).ok()).map_or(0, |it| it.as_nanos());
    let (path, bytes, version) = (program.display(), metadata.map_or(0, |it| it.len()), env!("CARGO_PKG_VERSION"));
    format!("framewright {version}; {path}, {bytes} bytes, written {written}")
}

/// An environment variable that names a path, if it is set and not empty.
pub(crate) fn path_variable(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// Writes a file of a folder whole or not at all, and the folder if there is none.
pub(crate) fn replace_file(folder: &Path, path: &Path, contents: &[u8]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut unfinished = NamedTempFile::new_in(folder)?;
    unfinished.write_all(contents)?;
    unfinished.persist(path).map_err(|error| error.error)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[test]
    fn threads_that_write_one_file_at_once_all_write_it_whole_and_leave_nothing_beside_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path().join("made");
        let file = folder.join("kept.json");
        let contents = |number: u8| vec![number; 100_000];
        thread::scope(|scope| {
            for number in 0..8 {
                let (folder, file) = (&folder, &file);
                scope.spawn(move || {
                    for _ in 0..50 {
                        replace_file(folder, file, &contents(number)).expect("written");
                    }
                });
            }
        });
        let found = fs::read(&file).expect("a file");
        assert_eq!(found, contents(found[0]));
        assert_eq!(fs::read_dir(&folder).expect("listed").count(), 1);
    }
}
