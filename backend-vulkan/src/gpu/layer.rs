//! Finding the validation layer.
//!
//! Debian 12's own layer misses every hazard of a dynamic rendering attachment; the one that comes with `chromium-common`
//! finds them, but has no manifest, and the loader finds layers through its environment only. A running process can't
//! change its environment soundly, since other threads may be reading it. So the program starts itself anew: `main` calls
//! [`reexecution`] before anything else and runs the command that it gets.

use crate::base::{Cache, Error, path_variable, read_file, replace_file};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, io};

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
    let Some(cache) = Cache::of_user() else { return Ok(None) };
    let folder = cache.layer();
    write_manifest(&folder)
        .map_err(|error| Error::CantWrite { path: folder.display().to_string(), reason: error.to_string() })?;
    Ok(Some(folder))
}

/// `VK_LAYER_PATH`, if it is set.
pub(crate) fn user_layer_path() -> Option<PathBuf> {
    path_variable(LAYER_PATH)
}

/// Writes the manifest whole or not at all: other processes may be reading it.
fn write_manifest(folder: &Path) -> io::Result<()> {
    let path = folder.join("VkLayer_khronos_validation.json");
    let manifest = manifest();
    if read_file(&path, manifest.len() as u64).is_some_and(|found| found == manifest.as_bytes()) {
        return Ok(());
    }
    replace_file(folder, &path, manifest.as_bytes())
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
