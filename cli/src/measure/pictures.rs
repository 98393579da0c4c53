//! Pictures of results that are joined. Each gets a name by its contents: so no folder's pictures take the place of another's,
//! and the same picture has the same name wherever it comes from.

use crate::error::Error;
use crate::files::{inputs, outputs};
use framewright_graph::base::ReadFiles;
use framewright_lab::Digest;
use framewright_lab::results::{Outcome, Results, RowFigures};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of pictures in that of joined results.
const FOLDER: &str = "pictures";

/// Where each picture is, by its new name.
#[derive(Debug, Default)]
pub(crate) struct Pictures {
    sources: BTreeMap<String, PathBuf>,
}

impl Pictures {
    /// Gives the pictures that results in a folder name their new names.
    ///
    /// # Errors
    /// If one can't be read, or a link in its path leads out of the folder.
    pub(crate) fn rename(&mut self, folder: &Path, results: &mut Results, read: &ReadFiles) -> Result<(), Error> {
        // Many rows share a reference.
        let mut known: BTreeMap<String, String> = BTreeMap::new();
        for row in &mut results.rows {
            let Outcome::Measured(measured) = &mut row.outcome else { continue };
            let RowFigures { picture, reference, heat_map, flicker_map, .. } = &mut **measured;
            for path in [picture, reference, heat_map, flicker_map].into_iter().flatten() {
                let name = match known.get(path) {
                    Some(name) => name.clone(),
                    None => {
                        let name = self.find(folder, path, read)?;
                        known.insert(path.clone(), name.clone());
                        name
                    }
                };
                *path = name;
            }
        }
        Ok(())
    }

    /// The new name of a picture in a folder.
    fn find(&mut self, folder: &Path, path: &str, read: &ReadFiles) -> Result<String, Error> {
        let source = folder.join(path);
        let real = |path: &Path| {
            fs::canonicalize(path).map_err(|error| Error::Read { what: "picture", path: source.clone(), source: error })
        };
        if !real(&source)?.starts_with(real(folder)?) {
            let source = source.clone();
            return Err(Error::OutsideResults { path: source, folder: folder.to_owned() });
        }
        let digest = Digest::of_bytes([&*inputs::measured_picture(&source, read)?]);
        let ending = Path::new(path).extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let name = format!("{FOLDER}/{digest}.{ending}");
        self.sources.entry(name.clone()).or_insert(source);
        Ok(name)
    }

    /// Copies all to a folder under their new names, each whole or not at all.
    ///
    /// # Errors
    /// If one can't be read or written.
    pub(crate) fn copy(&self, folder: &Path, read: &ReadFiles) -> Result<(), Error> {
        if !self.sources.is_empty() {
            outputs::make_folder(&folder.join(FOLDER))?;
        }
        for (name, source) in &self.sources {
            let bytes = inputs::measured_picture(source, read)?;
            outputs::write(&[(&folder.join(name), &bytes)], read)?;
        }
        Ok(())
    }
}
