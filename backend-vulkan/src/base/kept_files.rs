//! The files of a cache's folder: what they hold, when they were used, and how much room they take.

use super::cache::files_in;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The last use of a file is known to this precision.
const PRECISION: Duration = Duration::from_secs(3600);

/// A number that tells contents from others, in all processes of one build.
pub(crate) fn digest(of: &(impl Hash + ?Sized)) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

/// Notes that a file was used, unless that was noted a short time ago.
pub(crate) fn used_now(path: &Path) {
    let now = SystemTime::now();
    let last = fs::metadata(path).and_then(|file| file.modified());
    // A time in the future comes of a wrong clock.
    if last.is_ok_and(|last| now.duration_since(last).map_or(true, |ago| ago > PRECISION)) {
        // Without this it only looks as if it had not been used.
        let _ = File::options().append(true).open(path).and_then(|file| file.set_modified(now));
    }
}

fn sum(files: &[(PathBuf, fs::Metadata)]) -> u64 {
    files.iter().fold(0, |sum, (_, file)| sum.saturating_add(file.len()))
}

/// The bytes of all files in a folder.
pub(crate) fn bytes_in(folder: &Path) -> u64 {
    sum(&files_in(folder).unwrap_or_default())
}

/// Removes the files that were used least recently until all take at most `bytes`. Returns the bytes of the others.
pub(crate) fn shrink(folder: &Path, bytes: u64) -> u64 {
    let mut files = files_in(folder).unwrap_or_default();
    files.sort_by_cached_key(|(_, file)| file.modified().ok());
    let mut left = sum(&files);
    for (path, file) in files {
        if left <= bytes {
            break;
        }
        // If another process removed it, that one counts it.
        if fs::remove_file(path).is_ok() {
            left -= file.len();
        }
    }
    left
}
