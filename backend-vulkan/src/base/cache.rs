//! The cache: a folder of files that can be made anew. Each is written whole or not at all.

use super::platform;
use std::ffi::OsStr;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;
use std::{env, fs, io};

/// A folder of files that can be made anew: compiled shaders, pipelines as drivers keep them, and findings about drivers.
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
const KINDS: [&str; 3] = [SPIRV, PIPELINES, SELF_TESTS];
const SPIRV: &str = "spirv";
const PIPELINES: &str = "pipelines";
const SELF_TESTS: &str = "self-tests";

/// Beginning of the names of files that are being written.
const UNFINISHED: &str = ".tmp";

impl Cache {
    /// The cache of the user: `$XDG_CACHE_HOME/framewright`, or `~/.cache/framewright`, on Windows `%LOCALAPPDATA%\framewright`. `None`
    /// if the user has no home folder.
    /// Relative paths don't count.
    #[must_use]
    pub fn of_user() -> Option<Cache> {
        let absolute = |variable: &str| path_variable(variable).filter(|path| path.is_absolute());
        let cache = absolute("XDG_CACHE_HOME").or_else(|| platform::caches_of_user(absolute));
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
                (files, bytes) = (files + 1, u64::saturating_add(bytes, entry.len()));
            }
            Ok(CachedFiles { kind, files, bytes })
        };
        KINDS.into_iter().map(counted).collect()
    }

    /// Removes the files of each kind, and says how many it removed. Other processes may write at the same time.
    ///
    /// # Errors
    /// The first file or folder that can't be listed or removed; other kinds are cleared nonetheless.
    pub fn clear(&self) -> io::Result<Vec<CachedFiles>> {
        let mut first = Ok(());
        let removed = KINDS.map(|kind| {
            let mut removed = CachedFiles { kind, files: 0, bytes: 0 };
            first = std::mem::replace(&mut first, Ok(())).and(clear(&self.folder.join(kind), &mut removed));
            removed
        });
        first.map(|()| removed.into())
    }

    /// The folder of compiled shaders.
    pub(crate) fn spirv(&self) -> PathBuf {
        self.folder.join(SPIRV)
    }

    /// The folder of what drivers keep of pipelines.
    pub(crate) fn pipelines(&self) -> PathBuf {
        self.folder.join(PIPELINES)
    }

    /// The folder of what self-tests of drivers found.
    pub(crate) fn self_tests(&self) -> PathBuf {
        self.folder.join(SELF_TESTS)
    }

    /// The folder of the validation layer's manifest, which is no cached file: the loader looks for it.
    pub(crate) fn layer(&self) -> PathBuf {
        self.folder.join("vulkan-layer")
    }
}

/// Removes the files in a folder, and counts them; then the folder, unless something else is in it.
fn clear(folder: &Path, removed: &mut CachedFiles) -> io::Result<()> {
    let files = match files_in(folder) {
        Ok(files) => files,
        // Something else has the folder's name, so that nothing is kept.
        Err(error) => match fs::symlink_metadata(folder) {
            Ok(other) if !other.is_dir() => vec![(folder.to_owned(), other)],
            _ => return Err(error),
        },
    };
    for (path, file) in files {
        if absent_is_fine(fs::remove_file(path))?.is_some() {
            (removed.files, removed.bytes) = (removed.files + 1, removed.bytes.saturating_add(file.len()));
        }
    }
    // It stays if others write there meanwhile.
    let _ = fs::remove_dir(folder);
    Ok(())
}

/// Reads a file of the cache. `None` if it isn't a plain file of at most `most` bytes that this user alone may write: others
/// could have put anything there.
pub(crate) fn read_file(path: &Path, most: u64) -> Option<Vec<u8>> {
    let mut options = fs::File::options();
    options.read(true);
    platform::at_once(&mut options);
    let file = options.open(path).ok()?;
    let metadata = file.metadata().ok()?;
    if !metadata.is_file() || metadata.len() > most || !platform::is_own(&metadata) {
        return None;
    }
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

/// The files in a folder that have names like ours. One that is removed meanwhile is left out; a folder that isn't there holds
/// none.
pub(super) fn files_in(folder: &Path) -> io::Result<Vec<(PathBuf, fs::Metadata)>> {
    let Some(entries) = absent_is_fine(fs::read_dir(folder))? else { return Ok(Vec::new()) };
    let mut files = Vec::new();
    for entry in entries {
        let entry = entry?;
        if !is_name_of_ours(&entry.file_name()) {
            continue;
        }
        if let Some(metadata) = absent_is_fine(entry.metadata())?.filter(fs::Metadata::is_file) {
            files.push((entry.path(), metadata));
        }
    }
    Ok(files)
}

/// Whether a file is called as those of the cache are: a number of 64 bits, or a file that isn't finished.
fn is_name_of_ours(name: &OsStr) -> bool {
    let Some(name) = name.to_str() else { return false };
    let number = name.strip_suffix(".json").unwrap_or(name);
    name.starts_with(UNFINISHED) || number.len() == 16 && number.bytes().all(|byte| byte.is_ascii_hexdigit())
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
    make_folder(folder)?;
    let mut unfinished = tempfile::Builder::new().prefix(UNFINISHED).tempfile_in(folder)?;
    unfinished.write_all(contents)?;
    unfinished.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Makes a folder that is this user's alone, unless there is one.
fn make_folder(folder: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    platform::private(&mut builder);
    builder.create(folder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[cfg(unix)]
    #[test]
    fn only_plain_files_of_this_user_are_read_up_to_a_size() {
        use nix::sys::stat::Mode;
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        replace_file(folder.path(), &path("plain"), b"words").expect("written");
        assert_eq!(read_file(&path("plain"), 5).as_deref(), Some(&b"words"[..]));
        assert_eq!(read_file(&path("plain"), 4), None);
        nix::unistd::mkfifo(&path("pipe"), Mode::S_IRWXU).expect("a pipe");
        symlink(path("plain"), path("link")).expect("a link");
        symlink("/dev/zero", path("device")).expect("a link");
        fs::create_dir(path("folder")).expect("a folder");
        for other in ["pipe", "link", "device", "folder", "nothing"] {
            assert_eq!(read_file(&path(other), 5), None, "{other}");
        }
        for mode in [0o620, 0o602] {
            fs::set_permissions(path("plain"), fs::Permissions::from_mode(mode)).expect("set");
            assert_eq!(read_file(&path("plain"), 5), None, "{mode:o}");
        }
    }

    #[test]
    fn what_others_keep_in_the_folder_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = Cache::in_folder(folder.path());
        let file = |name: &str| cache.spirv().join(name);
        for name in ["0123456789abcdef", ".tmpXyz", "mine", "0123456789abcdeg", "0123456789abcde"] {
            replace_file(&cache.spirv(), &file(name), b"123").expect("written");
        }
        // A file in place of a folder keeps everything else from being kept.
        replace_file(folder.path(), &cache.self_tests(), b"12345").expect("written");
        assert!(cache.files().is_err());
        let counts = |files: Vec<CachedFiles>| files.iter().map(|it| (it.files, it.bytes)).collect::<Vec<_>>();
        assert_eq!(counts(cache.clear().expect("cleared")), [(2, 6), (0, 0), (1, 5)]);
        assert_eq!(counts(cache.files().expect("listed")), [(0, 0); 3]);
        assert_eq!(fs::read_dir(cache.spirv()).expect("listed").count(), 3);
    }

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
