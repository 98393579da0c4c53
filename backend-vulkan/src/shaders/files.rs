//! Where shader sources are found: folders on disk first, then the texts that are shipped with the program.

use framewright_graph::root::{NoFile, Root};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

/// Larger files are no shaders.
const MAX_SOURCE_BYTES: usize = 1 << 20;

/// Where shaders and what they include are looked for, in this order.
pub(super) struct ShaderFiles {
    /// Folders on disk.
    pub(super) roots: Vec<Root>,
    /// File name and text.
    pub(super) shipped: &'static [(&'static str, &'static str)],
    /// The files on disk that were read so far, links followed.
    pub(super) read: RefCell<BTreeSet<PathBuf>>,
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
        for root in &self.roots {
            let shown = root.folder().join(name).display().to_string();
            let located = root.locate(name);
            self.read.borrow_mut().extend(located.clone());
            let bytes = match located.and_then(|found| root.read(&found, MAX_SOURCE_BYTES)) {
                Ok(bytes) => bytes,
                Err(NoFile::Missing) => continue,
                Err(NoFile::TooLarge { bytes, limit }) => {
                    return Err(format!("{shown} has {bytes} bytes, more than the {limit} of a shader"));
                }
                Err(other) => return Err(format!("{shown} {other}")),
            };
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
        let folders = self.roots.iter().map(|root| root.folder().display().to_string());
        folders.chain((!self.shipped.is_empty()).then(|| "the shipped shaders".to_owned())).collect()
    }

    /// Names of everything that has a file ending in `ending`, sorted.
    pub(super) fn known_shaders(&self, ending: &str) -> Vec<String> {
        let on_disk = self.roots.iter().filter_map(|root| fs::read_dir(root.folder()).ok());
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
