//! Files that this crate keeps in the user's cache folder: each is written whole or not at all.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, io};
use tempfile::NamedTempFile;

/// Where this crate keeps what it can make anew, if the user has a home folder.
pub(crate) fn cache_folder() -> Option<PathBuf> {
    let cache = path_variable("XDG_CACHE_HOME").or_else(|| path_variable("HOME").map(|home| home.join(".cache")));
    cache.map(|cache| cache.join("framewright"))
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
