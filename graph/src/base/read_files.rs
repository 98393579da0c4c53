//! The files that a program has read, so that it writes over none of them, and sees that they change.

use std::collections::HashMap;
use std::fs::{File, Metadata};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;
use std::{fs, io};

/// A record of files that were read or looked for. Clones share it.
///
/// A file is told by its identity on disk, not by its name: links and hard links to it lead to the same file. Only regular
/// files count as read, since writing to a device or a pipe loses nothing.
#[derive(Debug, Clone, Default)]
pub struct ReadFiles {
    records: Arc<Mutex<Records>>,
}

#[derive(Debug, Default)]
struct Records {
    /// The kinds of files that were read.
    read: HashMap<FileIdentity, &'static str>,
    /// Every path that was read or looked for, and what was there then.
    paths: HashMap<PathBuf, Option<Stamp>>,
}

/// A file's state on disk. A file that was written to has another one, and so has a file that took its place.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Stamp {
    bytes: u64,
    written: Option<SystemTime>,
    /// Device and inode, and when anything about it changed last, such as who may read it: seconds and nanoseconds.
    #[cfg(unix)]
    inode: (u64, u64, i64, i64),
}

/// One file on disk, by whatever name it was found.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct FileIdentity(Identity);

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
    /// Those of opening it; if it is no regular file: nobody may write to a pipe, and a device may have no end.
    pub fn open(&self, what: &'static str, path: &Path) -> io::Result<File> {
        let opened = || -> io::Result<(File, Metadata)> {
            // Opening a pipe waits for somebody who writes to it.
            regular(&fs::metadata(path)?)?;
            let file = File::open(path)?;
            let metadata = file.metadata()?;
            regular(&metadata)?;
            Ok((file, metadata))
        };
        let (file, metadata) = opened().inspect_err(|_| self.seek(path))?;
        self.record(what, path, &metadata);
        Ok(file)
    }

    /// Records a file that is going to be read, if there is one. The kind of its first record stays.
    pub fn expect(&self, what: &'static str, path: &Path) {
        match fs::metadata(path) {
            Ok(metadata) => self.record(what, path, &metadata),
            Err(_) => self.seek(path),
        }
    }

    /// Records that a file was looked for at `path`, whether or not one is there.
    pub(crate) fn seek(&self, path: &Path) {
        self.lock().paths.entry(path.to_owned()).or_insert_with(|| Stamp::at(path));
    }

    /// A record of the same paths, with what is there now.
    #[must_use]
    pub fn now(&self) -> ReadFiles {
        let records = self.lock();
        let paths = records.paths.keys().map(|path| (path.clone(), Stamp::at(path))).collect();
        ReadFiles { records: Arc::new(Mutex::new(Records { read: records.read.clone(), paths })) }
    }

    /// Whether a file that was read is another one by now, or is gone, or one that was missing is there.
    #[must_use]
    pub fn changed(&self) -> bool {
        self.lock().paths.iter().any(|(path, stamp)| Stamp::at(path) != *stamp)
    }

    /// Those files, and those that are gone or there by now, by their paths.
    #[must_use]
    pub fn changes(&self) -> Vec<PathBuf> {
        let records = self.lock();
        let changed = records.paths.iter().filter(|(path, stamp)| Stamp::at(path) != **stamp);
        let mut changed: Vec<PathBuf> = changed.map(|(path, _)| path.clone()).collect();
        changed.sort_unstable();
        changed
    }

    /// The kind that the file at `path` was read as; `None` if it was not read, or there is none.
    #[must_use]
    pub fn read_as(&self, path: &Path) -> Option<&'static str> {
        let metadata = fs::metadata(path).ok()?;
        let records = self.lock();
        identities(path, &metadata).find_map(|identity| records.read.get(&identity).copied())
    }

    fn record(&self, what: &'static str, path: &Path, metadata: &Metadata) {
        let mut records = self.lock();
        // What is no regular file now may be one later.
        let stamp = metadata.is_file().then(|| Stamp::of(metadata));
        if stamp.is_some() {
            for identity in identities(path, metadata) {
                records.read.entry(identity).or_insert(what);
            }
        }
        records.paths.entry(path.to_owned()).or_insert(stamp);
    }

    fn lock(&self) -> MutexGuard<'_, Records> {
        self.records.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Stamp {
    fn of(metadata: &Metadata) -> Stamp {
        #[cfg(unix)]
        let inode = {
            use std::os::unix::fs::MetadataExt;
            (metadata.dev(), metadata.ino(), metadata.ctime(), metadata.ctime_nsec())
        };
        Stamp {
            bytes: metadata.len(),
            written: metadata.modified().ok(),
            #[cfg(unix)]
            inode,
        }
    }

    /// `None`: no file is there.
    fn at(path: &Path) -> Option<Stamp> {
        fs::metadata(path).ok().filter(Metadata::is_file).map(|metadata| Stamp::of(&metadata))
    }
}

impl FileIdentity {
    /// The identity of the file at `path`; `None`: there is none.
    #[must_use]
    pub fn of(path: &Path) -> Option<FileIdentity> {
        // The last one is the same for all names of the file.
        identities(path, &fs::metadata(path).ok()?).last()
    }
}

/// What reading a folder gives.
fn is_a_folder() -> io::Error {
    const EISDIR: i32 = 21;
    if cfg!(unix) { io::Error::from_raw_os_error(EISDIR) } else { io::ErrorKind::IsADirectory.into() }
}

/// Makes sure that it is a regular file.
fn regular(metadata: &Metadata) -> io::Result<()> {
    match metadata {
        file if file.is_file() => Ok(()),
        folder if folder.is_dir() => Err(is_a_folder()),
        _ => Err(io::Error::new(io::ErrorKind::InvalidInput, "it is a pipe or a device, not a regular file")),
    }
}

fn identities(path: &Path, metadata: &Metadata) -> impl Iterator<Item = FileIdentity> {
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
    fs::canonicalize(path).ok().map(Identity::Path).into_iter().chain(inode).map(FileIdentity)
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
            files.open("the scene", Path::new("/dev/null")).expect_err("a device");
            assert_eq!(files.read_as(Path::new("/dev/null")), None);
        }
    }

    #[test]
    fn files_that_are_written_replaced_removed_or_made_have_changed() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let begun = |read: &[&str], sought: &[&str]| {
            fs::write(at("file"), "a").expect("written");
            let files = ReadFiles::default();
            read.iter().for_each(|name| drop(files.open("a file", &at(name)).expect("opened")));
            sought.iter().for_each(|name| drop(files.open("a file", &at(name)).expect_err("none is there")));
            assert!(!files.changed());
            files
        };
        let files = begun(&["file"], &["missing"]);
        fs::write(at("file"), "longer").expect("written");
        assert!(files.changed(), "written");
        assert!(!files.now().changed());
        let files = begun(&["file"], &[]);
        fs::write(at("other"), "a").expect("written");
        fs::rename(at("other"), at("file")).expect("moved");
        assert!(files.changed(), "replaced");
        let files = begun(&["file"], &[]);
        fs::remove_file(at("file")).expect("removed");
        assert!(files.changed(), "removed");
        fs::write(at("file"), "a").expect("written");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let files = begun(&["file"], &[]);
            fs::set_permissions(at("file"), fs::Permissions::from_mode(0o600)).expect("set");
            fs::set_permissions(at("file"), fs::Permissions::from_mode(0o644)).expect("set");
            assert!(files.changed(), "who may read it");
        }
        let files = begun(&["file"], &["missing"]);
        fs::create_dir(at("missing")).expect("made");
        assert!(!files.changed(), "a folder is no file");
        fs::remove_dir(at("missing")).expect("removed");
        fs::write(at("missing"), "").expect("written");
        assert!(files.changed(), "made");
        assert_eq!(files.changes(), [at("missing")]);
    }

    /// What isn't there, a folder, a pipe and a device.
    #[cfg(unix)]
    /// Makes something at a path.
    type Make = fn(&Path);

    fn no_files() -> Vec<(&'static str, Make)> {
        let pipe = |path: &Path| {
            let made = std::process::Command::new("mkfifo").arg(path).status().expect("mkfifo");
            assert!(made.success());
        };
        let device = |path: &Path| std::os::unix::fs::symlink("/dev/zero", path).expect("linked");
        vec![
            ("missing", |_| ()),
            ("a folder", |path| fs::create_dir(path).expect("made")),
            ("a pipe", pipe),
            ("a device", device),
        ]
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_is_refused_at_once_and_seen_when_it_becomes_one() {
        for (what, make) in no_files() {
            for expected in [false, true] {
                let folder = tempfile::tempdir().expect("a folder");
                let path = folder.path().join("file");
                make(&path);
                let files = ReadFiles::default();
                // As a server does it: all files are recorded before one is read.
                if expected {
                    files.expect("a file", &path);
                } else {
                    files.open("a file", &path).expect_err(what);
                }
                assert!(!files.changed() && files.read_as(&path).is_none(), "{what}");
                match fs::symlink_metadata(&path) {
                    Ok(metadata) if metadata.is_dir() => fs::remove_dir(&path).expect("removed"),
                    Ok(_) => fs::remove_file(&path).expect("removed"),
                    Err(_) => {}
                }
                fs::write(&path, "a").expect("written");
                assert!(files.changed(), "{what}, {expected}");
                files.open("a file", &path).expect("a file by now");
            }
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_file_has_one_identity_by_all_its_names() {
        let folder = tempfile::tempdir().expect("a folder");
        let [file, link, hard, other] = ["file", "link", "hard", "other"].map(|name| folder.path().join(name));
        fs::write(&file, "a").expect("written");
        fs::write(&other, "a").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("linked");
        fs::hard_link(&file, &hard).expect("linked");
        let identity = |path: &Path| FileIdentity::of(path).expect("a file");
        assert!(identity(&file) == identity(&link) && identity(&file) == identity(&hard));
        assert_ne!(identity(&file), identity(&other));
        assert_eq!(FileIdentity::of(&folder.path().join("missing")), None);
    }
}
