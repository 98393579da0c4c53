//! Where shader sources are found: folders on disk first, then the texts that are shipped with the program.

use std::fs;
use std::path::PathBuf;

/// Larger files are no shaders.
const MAX_SOURCE_BYTES: u64 = 1 << 20;

/// Where shaders and what they include are looked for, in this order.
pub(super) struct ShaderFiles {
    /// Folders on disk.
    pub(super) folders: Vec<PathBuf>,
    /// File name and text.
    pub(super) shipped: &'static [(&'static str, &'static str)],
}

/// A source text.
pub(super) struct Found {
    /// The name that messages show.
    pub(super) shown: String,
    /// GLSL.
    pub(super) text: String,
}

impl ShaderFiles {
    /// The text of the file `name` (`lit.frag`, `light/sun.glsl`), `None` if there is none.
    ///
    /// # Errors
    /// If the name leads out of the folders, or a file of that name can't be a shader: what is wrong with it, in words.
    pub(super) fn find(&self, name: &str) -> Result<Option<Found>, String> {
        if !stays_inside(name) {
            return Err(format!(
                "`{name}` is no shader file name: plain names and subfolders with `/` only, no `..`, no `\\`"
            ));
        }
        for folder in &self.folders {
            let path = folder.join(name);
            let Ok(metadata) = fs::metadata(&path) else { continue };
            let shown = path.display().to_string();
            if !metadata.is_file() {
                return Err(format!("{shown} is not a regular file"));
            }
            if metadata.len() > MAX_SOURCE_BYTES {
                return Err(format!(
                    "{shown} has {} bytes, more than the {MAX_SOURCE_BYTES} of a shader",
                    metadata.len()
                ));
            }
            let bytes = fs::read(&path).map_err(|error| format!("{shown} can't be read: {error}"))?;
            let text = String::from_utf8(bytes).map_err(|_| format!("{shown} is not UTF-8 text"))?;
            if text.contains('\0') {
                return Err(format!("{shown} contains a zero byte"));
            }
            return Ok(Some(Found { shown: shown.replace('\0', ""), text }));
        }
        let shipped = self.shipped.iter().find(|(shipped, _)| *shipped == name);
        Ok(shipped.map(|(name, text)| Found { shown: format!("shipped:{name}"), text: (*text).to_owned() }))
    }

    /// The places that [`ShaderFiles::find`] looks in, for messages.
    pub(super) fn places(&self) -> Vec<String> {
        let folders = self.folders.iter().map(|folder| {
            let shown = folder.display().to_string();
            if shown.is_empty() { ".".to_owned() } else { shown }
        });
        folders.chain((!self.shipped.is_empty()).then(|| "the shipped shaders".to_owned())).collect()
    }

    /// Names of everything that has a file ending in `ending`, sorted.
    pub(super) fn known_shaders(&self, ending: &str) -> Vec<String> {
        let on_disk = self.folders.iter().filter_map(|folder| {
            let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.clone() };
            fs::read_dir(folder).ok()
        });
        let on_disk = on_disk.flatten().flatten().filter_map(|entry| entry.file_name().into_string().ok());
        let shipped = self.shipped.iter().map(|(name, _)| (*name).to_owned());
        let mut names: Vec<String> =
            on_disk.chain(shipped).filter_map(|file| file.strip_suffix(ending).map(str::to_owned)).collect();
        names.sort();
        names.dedup();
        names
    }
}

/// Whether `name` is a relative path that can't leave the folder it is joined to.
fn stays_inside(name: &str) -> bool {
    !name.contains(['\\', '\0', ':']) && name.split('/').all(|part| !matches!(part, "" | "." | ".."))
}
