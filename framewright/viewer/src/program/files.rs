//! Saved frames: pages that open from disk, written whole or not at all.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use tempfile::NamedTempFile;

/// Writes a page, in place of what was there.
pub(super) fn write(path: &Path, page: &str) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    beside(folder, page)?.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Writes the page of a device that was lost into `folder`, which is made, by a name that no file has.
pub(super) fn write_lost(folder: &Path, page: &str) -> io::Result<PathBuf> {
    std::fs::create_dir_all(folder)?;
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let stem = format!("framewright-lost-{seconds}-{}", std::process::id());
    let mut written = beside(folder, page)?;
    for number in 1_u32.. {
        let path = folder.join(if number == 1 { format!("{stem}.html") } else { format!("{stem}-{number}.html") });
        match written.persist_noclobber(&path) {
            Ok(_) => return Ok(path),
            Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => written = error.file,
            Err(error) => return Err(error.error),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

fn beside(folder: &Path, page: &str) -> io::Result<NamedTempFile> {
    let mut file = NamedTempFile::new_in(folder)?;
    file.write_all(page.as_bytes())?;
    file.as_file().sync_all()?;
    Ok(file)
}
