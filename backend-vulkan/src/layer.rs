//! Finding the validation layer.
//!
//! Debian 12's own layer misses every hazard of a dynamic rendering attachment; the one that comes with `chromium-common`
//! finds them, but has no manifest, and the loader finds layers through its environment only. A running process can't
//! change its environment soundly, since other threads may be reading it. So the program starts itself anew: `main` calls
//! [`reexecution`] before anything else and runs the command that it gets.

use crate::error::Error;
use std::env;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::NamedTempFile;

/// The current layer, as `chromium-common` installs it.
const CURRENT_LAYER: &str = "/usr/lib/chromium/libVkLayer_khronos_validation.so";

/// Where the loader looks for layers, instead of the system's folders.
const LAYER_PATH: &str = "VK_LAYER_PATH";

/// This program with the same arguments, in an environment that leads the loader to the current validation layer.
///
/// `None` if there is nothing to change: `VK_LAYER_PATH` is set (the user's own choice, or this function's work), the
/// layer isn't installed, or there is no home folder to keep its manifest in. Then the layer that the loader finds is used.
///
/// # Errors
/// [`Error::CantWrite`] if the manifest can't be written.
pub fn reexecution() -> Result<Option<Command>, Error> {
    let Some(folder) = manifest_folder()? else { return Ok(None) };
    let Ok(program) = env::current_exe() else { return Ok(None) };
    let mut command = Command::new(program);
    command.args(env::args_os().skip(1)).env(LAYER_PATH, folder);
    Ok(Some(command))
}

/// The folder that `VK_LAYER_PATH` must name to lead the loader to the current layer; `None` as [`reexecution`] says.
///
/// # Errors
/// [`Error::CantWrite`] if the manifest can't be written.
pub fn manifest_folder() -> Result<Option<PathBuf>, Error> {
    if user_layer_path().is_some() || !Path::new(CURRENT_LAYER).exists() {
        return Ok(None);
    }
    let Some(cache) = cache_folder() else { return Ok(None) };
    let folder = cache.join("vulkan-layer");
    write_manifest(&folder)
        .map_err(|error| Error::CantWrite { path: folder.display().to_string(), reason: error.to_string() })?;
    Ok(Some(folder))
}

/// Where this crate keeps what it can make anew, if the user has a home folder.
pub(crate) fn cache_folder() -> Option<PathBuf> {
    let cache = set("XDG_CACHE_HOME").or_else(|| set("HOME").map(|home| home.join(".cache")));
    cache.map(|cache| cache.join("framewright"))
}

/// `VK_LAYER_PATH`, if it is set.
pub(crate) fn user_layer_path() -> Option<PathBuf> {
    set(LAYER_PATH)
}

fn set(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// Writes the manifest whole or not at all: other processes may be reading it.
fn write_manifest(folder: &Path) -> io::Result<()> {
    let path = folder.join("VkLayer_khronos_validation.json");
    let manifest = manifest();
    if fs::read_to_string(&path).is_ok_and(|found| found == manifest) {
        return Ok(());
    }
    replace(folder, &path, manifest.as_bytes())
}

/// Writes a file of a folder whole or not at all, and the folder if there is none.
pub(crate) fn replace(folder: &Path, path: &Path, contents: &[u8]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut unfinished = NamedTempFile::new_in(folder)?;
    unfinished.write_all(contents)?;
    unfinished.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// The extensions are those that this crate asks for; the version is one that every loader of Vulkan 1.3 takes.
fn manifest() -> String {
    format!(
        r#"{{
  "file_format_version": "1.2.0",
  "layer": {{
    "name": "VK_LAYER_KHRONOS_validation",
    "type": "GLOBAL",
    "library_path": "{CURRENT_LAYER}",
    "api_version": "1.4.300",
    "implementation_version": "1",
    "description": "Khronos validation layer from chromium-common",
    "instance_extensions": [
      {{ "name": "VK_EXT_debug_report", "spec_version": "9" }},
      {{ "name": "VK_EXT_debug_utils", "spec_version": "1" }},
      {{ "name": "VK_EXT_validation_features", "spec_version": "2" }},
      {{ "name": "VK_EXT_layer_settings", "spec_version": "2" }}
    ]
  }}
}}
"#
    )
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
                        replace(folder, file, &contents(number)).expect("written");
                    }
                });
            }
        });
        let found = fs::read(&file).expect("a file");
        assert_eq!(found, contents(found[0]));
        assert_eq!(fs::read_dir(&folder).expect("listed").count(), 1);
    }
}
