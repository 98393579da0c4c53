//! The files that a program has read, so that it writes over none of them.

use std::collections::HashMap;
use std::fs::{File, Metadata};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::{fs, io};

/// A record of files that were read. Clones share it.
///
/// A file is told by its identity on disk, not by its name: links and hard links to it lead to the same file. Only regular
/// files are recorded, since writing to a device or a pipe loses nothing.
#[derive(Debug, Clone, Default)]
pub struct ReadFiles {
    files: Arc<Mutex<HashMap<Identity, &'static str>>>,
}

/// One file on disk.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
enum Identity {
    /// Its path without links. The file may have been replaced by another since it was read.
    Path(PathBuf),
    /// Device and inode, which all hard links share.
    #[cfg(unix)]
    Inode(u64, u64),
}

impl ReadFiles {
    /// Opens a file for reading and records it as `what`, such as `a texture`.
    ///
    /// # Errors
    /// Those of opening it.
    pub fn open(&self, what: &'static str, path: &Path) -> io::Result<File> {
        let file = File::open(path)?;
        self.record(what, path, &file.metadata()?);
        Ok(file)
    }

    /// Records a file that is going to be read, if there is one. The kind of its first record stays.
    pub fn expect(&self, what: &'static str, path: &Path) {
        if let Ok(metadata) = fs::metadata(path) {
            self.record(what, path, &metadata);
        }
    }

    /// The kind that the file at `path` was read as; `None` if it was not read, or there is none.
    #[must_use]
    pub fn read_as(&self, path: &Path) -> Option<&'static str> {
        let metadata = fs::metadata(path).ok()?;
        let files = self.lock();
        identities(path, &metadata).find_map(|identity| files.get(&identity).copied())
    }

    fn record(&self, what: &'static str, path: &Path, metadata: &Metadata) {
        if metadata.is_file() {
            let mut files = self.lock();
            for identity in identities(path, metadata) {
                files.entry(identity).or_insert(what);
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<Identity, &'static str>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn identities(path: &Path, metadata: &Metadata) -> impl Iterator<Item = Identity> {
    #[cfg(unix)]
    let inode = {
        use std::os::unix::fs::MetadataExt;
        Some(Identity::Inode(metadata.dev(), metadata.ino()))
    };
    #[cfg(not(unix))]
    let inode = {
        let _ = metadata;
        None
    };
    fs::canonicalize(path).ok().map(Identity::Path).into_iter().chain(inode)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_known_by_every_name_that_leads_to_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let [read, other] = ["read", "other"].map(|name| folder.path().join(name));
        fs::write(&read, "a").expect("written");
        fs::write(&other, "a").expect("written");
        let files = ReadFiles::default();
        files.clone().open("the scene", &read).expect("opened");
        files.expect("the report", &folder.path().join("missing"));
        assert_eq!(files.read_as(&read), Some("the scene"));
        assert_eq!(files.read_as(&folder.path().join(".").join("read")), Some("the scene"));
        assert_eq!(files.read_as(&other), None);
        assert_eq!(files.read_as(&folder.path().join("missing")), None);
        #[cfg(unix)]
        {
            let [link, hard] = ["link", "hard"].map(|name| folder.path().join(name));
            std::os::unix::fs::symlink(&read, &link).expect("linked");
            fs::hard_link(&read, &hard).expect("linked");
            assert_eq!(files.read_as(&link), Some("the scene"));
            assert_eq!(files.read_as(&hard), Some("the scene"));
            // A device is read and written by the same name.
            files.open("the scene", Path::new("/dev/null")).expect("opened");
            assert_eq!(files.read_as(Path::new("/dev/null")), None);
        }
    }
}
